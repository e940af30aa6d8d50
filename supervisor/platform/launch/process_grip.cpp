// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <dirent.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <string>
#include <string_view>

#include "supervisor/platform/launch/system_launcher.hpp"

namespace hirosco::supervisor {
namespace {

/// How the cycle's thread is called (hirosco/subsystem/process/run.cpp).
constexpr std::string_view cycle_name = "cycle";

/// What the system tells of one thread in /proc/PID/task/TID/stat.
struct ThreadStatus {
  std::string_view name;
  bool runs{false};  ///< or could
  bool realtime{false};
  Duration had{};
};

[[nodiscard]] std::optional<ThreadStatus> read_status(std::string_view line) noexcept {
  // "TID (NAME) STATE ..."; the name may hold anything.
  const auto begin = line.find('('), end = line.rfind(')');
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin || line.size() < end + 4)
    return std::nullopt;
  ThreadStatus status;
  status.name = line.substr(begin + 1, end - begin - 1);
  status.runs = line[end + 2] == 'R';
  line.remove_prefix(end + 3);
  std::int64_t ticks = 0;
  constexpr int user = 14, system = 15, priority = 40;
  for (int field = 4; field <= priority && !line.empty(); ++field) {
    line.remove_prefix(1);
    std::int64_t number = 0;
    const auto read = std::from_chars(line.data(), line.data() + line.size(), number);
    line.remove_prefix(static_cast<std::size_t>(read.ptr - line.data()));
    if (field == user || field == system) ticks += number;
    if (field == priority) status.realtime = number > 0;
  }
  static const std::int64_t ticks_per_s = ::sysconf(_SC_CLK_TCK);
  status.had = Duration{std::chrono::seconds{1}} * ticks / ticks_per_s;
  return status;
}

/// Works on a process by its handles, so never on another one that got its number later. Takes nothing from the heap.
class LinuxGrip final : public ProcessGrip {
 public:
  explicit LinuxGrip(Process process) : process_{std::move(process)} {
    if (::clock_getcpuclockid(process_.pid(), &clock_) != 0) clock_ = CLOCK_MONOTONIC_COARSE;
    tasks_.reset(
        ::open(("/proc/" + std::to_string(process_.pid()) + "/task").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  }
  void take_realtime() noexcept override {
    // Before they are taken: none of its threads takes it again meanwhile.
    let_have_realtime(false);
    // Or the others would not have the processor until its grace is over.
    if (!take(Cycle::LosesToo)) kill();
  }
  void take_loops_realtime() noexcept override { static_cast<void>(take(Cycle::Keeps)); }
  void give_realtime() noexcept override {
    let_have_realtime(true);
    for (std::size_t i = 0; i < taken_count_; ++i) {
      const Thread& thread = taken_[i];
      const int now = ::sched_getscheduler(thread.id);
      // It may have ended since, or have been given priority anew.
      if (!status_of(thread.id) || now < 0 || (now & ~SCHED_RESET_ON_FORK) != SCHED_OTHER) continue;
      sched_param parameters{};
      parameters.sched_priority = thread.priority;
      static_cast<void>(::sched_setscheduler(thread.id, thread.policy, &parameters));
    }
    taken_count_ = 0;
  }
  LoopTime loop_time() noexcept override {
    LoopTime time;
    each_thread([&](int thread) {
      const auto status = status_of(thread);
      const bool service = thread == process_.pid();
      if (!status || (!service && status->cycle)) return;
      if (service) time.service = status->had;
      if (service) time.runnable = status->runs;
      if (status->realtime) time.realtime += status->had;
    });
    return time;
  }
  Duration processor_time() noexcept override {
    timespec time{};
    if (clock_ == CLOCK_MONOTONIC_COARSE || ::clock_gettime(clock_, &time) != 0) return {};
    return std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
  }
  void kill() noexcept override { process_.kill_with_its_own(); }

 private:
  enum class Cycle { LosesToo, Keeps };
  struct Thread {
    int id{0};
    int policy{0};
    int priority{0};
  };
  struct Status {
    bool cycle{false};
    bool runs{false};
    bool realtime{false};
    Duration had{};
  };
  [[nodiscard]] bool runs() noexcept { return process_.send_signal(0).has_value(); }

  void each_thread(auto&& with) noexcept {
    if (::lseek(tasks_.get(), 0, SEEK_SET) != 0) return;
    alignas(dirent64) std::array<char, 2048> entries;
    for (;;) {
      const auto octets = ::getdents64(tasks_.get(), entries.data(), entries.size());
      if (octets <= 0) return;
      for (std::ptrdiff_t at = 0; at < octets;) {
        const auto* entry = reinterpret_cast<const dirent64*>(entries.data() + at);
        at += entry->d_reclen;
        int thread = 0;
        const std::string_view name{entry->d_name};
        std::from_chars(name.data(), name.data() + name.size(), thread);
        if (thread > 0) with(thread);
      }
    }
  }

  [[nodiscard]] std::optional<Status> status_of(int thread) noexcept {
    std::array<char, 32> path{};
    const auto end = std::to_chars(path.data(), path.data() + 16, thread).ptr;
    std::ranges::copy(std::string_view{"/stat"}, end);
    const FileDescriptor file{::openat(tasks_.get(), path.data(), O_RDONLY | O_CLOEXEC)};
    std::array<char, 512> text;
    const auto octets = file ? ::read(file.get(), text.data(), text.size()) : 0;
    if (octets <= 0) return std::nullopt;
    const auto status = read_status({text.data(), static_cast<std::size_t>(octets)});
    if (!status) return std::nullopt;
    return Status{status->name == cycle_name, status->runs, status->realtime, status->had};
  }

  /// What a process may have stays its upper limit, which who is not privileged could not raise again; its sandbox keeps it from going there
  /// by itself (docs/adr/0146).
  void let_have_realtime(bool it) noexcept {
    rlimit limit{};
    if (!runs() || ::prlimit(process_.pid(), RLIMIT_RTPRIO, nullptr, &limit) != 0) return;
    limit.rlim_cur = it ? limit.rlim_max : 0;
    static_cast<void>(::prlimit(process_.pid(), RLIMIT_RTPRIO, &limit, nullptr));
  }

  /// False: the system refused it.
  [[nodiscard]] bool take(Cycle cycle) noexcept {
    if (!runs()) return true;
    bool taken = true;
    each_thread([&](int thread) {
      if (cycle == Cycle::Keeps && thread != process_.pid()) {
        const auto status = status_of(thread);
        if (!status || status->cycle) return;
      }
      const int policy = std::max(::sched_getscheduler(thread), 0);
      sched_param before{};
      static_cast<void>(::sched_getparam(thread, &before));
      const sched_param ordinary{};
      // What the thread has of this flag an ordinary user may not take away.
      const int kept = policy & SCHED_RESET_ON_FORK;
      if (::sched_setscheduler(thread, SCHED_OTHER | kept, &ordinary) != 0) taken = taken && errno == ESRCH;
      else if (before.sched_priority > 0 && taken_count_ < taken_.size())
        taken_[taken_count_++] = {thread, policy, before.sched_priority};
    });
    return taken;
  }

  Process process_;
  FileDescriptor tasks_;
  clockid_t clock_{};
  std::array<Thread, 32> taken_{};  ///< who had more than that has it back with its next configuration only
  std::size_t taken_count_{0};
};

}  // namespace

Result<std::shared_ptr<ProcessGrip>> grip_of(const Process& process) {
  FileDescriptor handle{::fcntl(process.handle().get(), F_DUPFD_CLOEXEC, 0)};
  if (!handle) return fail(ErrorCode::SystemFailure, "hold of a process", errno);
  HIROSCO_TRY_LET(Process second, Process::adopt(process.pid(), std::move(handle)));
  return std::make_shared<LinuxGrip>(std::move(second));
}

}  // namespace hirosco::supervisor
