// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>

#include "hirosco/utilities/os/mutex.hpp"
#include "hirosco/utilities/os/process_threads.hpp"
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
    // Of one that has just been seen alive it may be done with real time, too.
    if (has_ended()) return;
    threads_ = ProcessThreads::of(process_.pid());
    known_[0] = {process_.pid(), threads_.open(process_.pid(), "stat"), {}};
    known_count_ = known_[0].status ? 1 : 0;
  }
  void find_threads() noexcept override {
    // Not those that the guard lists, who may be in the midst of them.
    ProcessThreads threads = ProcessThreads::of(process_.pid());
    // Whose number it was when it was opened, nobody else has as long as it has not ended. What is known stays where no descriptor is left.
    if (!threads || has_ended()) return;
    std::array<Known, most_known> found{};
    std::size_t count = 0;
    threads.each([&](int thread) {
      if (count == most_known) return;
      Known each{thread, {}, {}};
      if (!knows(thread)) {
        each.status = threads.open(thread, "stat");
        // What it had before it was known is of no window that anybody measures.
        const auto status = status_of(each);
        if (!status) return;
        each.had_before = thread == process_.pid() ? Duration{} : status->had;
      }
      found[count++] = std::move(each);
    });
    const LockGuard lock{mutex_};
    for (Known& each : std::span{found}.first(count))
      if (Known* const before = known(each.id); !each.status && before != nullptr) std::swap(each, *before);
    std::swap(known_, found);  // those of before are closed behind the lock
    known_count_ = count;
  }
  void take_realtime() noexcept override {
    // Before they are taken: none of its threads takes it again meanwhile.
    let_have_realtime(false);
    // Or the others would not have the processor until its grace is over.
    if (!take(Cycle::LosesToo)) kill();
  }
  void take_loops_realtime() noexcept override { static_cast<void>(take(Cycle::Keeps)); }
  void give_realtime() noexcept override {
    if (!runs()) return;
    let_have_realtime(true);
    for (std::size_t i = 0; i < taken_count_; ++i) {
      const Thread& thread = taken_[i];
      const int now = ::sched_getscheduler(thread.id);
      // It may have ended since, or have been given priority anew.
      if (::tgkill(process_.pid(), thread.id, 0) != 0 || now < 0 || (now & ~SCHED_RESET_ON_FORK) != SCHED_OTHER)
        continue;
      sched_param parameters{};
      parameters.sched_priority = thread.priority;
      static_cast<void>(::sched_setscheduler(thread.id, thread.policy, &parameters));
    }
    taken_count_ = 0;
  }
  LoopTime loop_time() noexcept override {
    LoopTime time;
    const LockGuard lock{mutex_};
    for (const Known& each : std::span{known_}.first(known_count_)) {
      const auto status = status_of(each);
      const bool service = each.id == process_.pid();
      if (!status || (!service && status->cycle)) continue;
      if (service) time.service = status->had;
      if (service) time.runnable = status->runs;
      if (status->realtime) time.realtime += status->had - each.had_before;
    }
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
  /// What is told of it is read by what was opened before: whoever has real time opens nothing here (docs/adr/0240).
  struct Known {
    int id{0};
    FileDescriptor status{};
    Duration had_before{};  ///< it was known
  };
  struct Status {
    bool cycle{false};
    bool runs{false};
    bool realtime{false};
    Duration had{};
  };
  [[nodiscard]] bool runs() noexcept { return process_.send_signal(0).has_value(); }
  [[nodiscard]] bool has_ended() const noexcept {
    pollfd end{process_.handle().get(), POLLIN, 0};
    return ::poll(&end, 1, 0) != 0;
  }

  [[nodiscard]] Known* known(int thread) noexcept HIROSCO_REQUIRES(mutex_) {
    const auto all = std::span{known_}.first(known_count_);
    const auto found = std::ranges::find(all, thread, &Known::id);
    return found != all.end() ? &*found : nullptr;
  }
  /// Its number may be of another one since.
  [[nodiscard]] bool knows(int thread) noexcept {
    const LockGuard lock{mutex_};
    const Known* const found = known(thread);
    return found != nullptr && status_of(*found);
  }

  [[nodiscard]] static std::optional<Status> status_of(const Known& thread) noexcept {
    std::array<char, 512> text;
    const auto octets = thread.status ? ::pread(thread.status.get(), text.data(), text.size(), 0) : 0;
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
    const LockGuard lock{mutex_};
    // Those that are known before all are listed: listing may wait for somebody who has just begun to look and whom one of them displaces.
    bool taken = take_from(process_.pid());
    const auto all = std::span{known_}.first(known_count_);
    const auto is_taken_from = [&](const Known& thread) {
      const auto status = cycle == Cycle::Keeps ? status_of(thread) : Status{};
      return status && !status->cycle;
    };
    for (const Known& thread : all)
      if (is_taken_from(thread)) taken = take_from(thread.id) && taken;
    // One that nobody knows yet may be the cycle.
    if (cycle == Cycle::LosesToo) threads_.each([&](int thread) { taken = take_from(thread) && taken; });
    return taken;
  }

  /// False: the system refused it.
  [[nodiscard]] bool take_from(int thread) noexcept {
    const int policy = std::max(::sched_getscheduler(thread), 0);
    sched_param before{};
    static_cast<void>(::sched_getparam(thread, &before));
    if (before.sched_priority == 0) return true;
    const sched_param ordinary{};
    // What the thread has of this flag an ordinary user may not take away.
    const int kept = policy & SCHED_RESET_ON_FORK;
    if (::sched_setscheduler(thread, SCHED_OTHER | kept, &ordinary) != 0) return errno == ESRCH;
    if (taken_count_ < taken_.size()) taken_[taken_count_++] = {thread, policy, before.sched_priority};
    return true;
  }

  Process process_;
  Mutex mutex_;
  ProcessThreads threads_ HIROSCO_GUARDED_BY(mutex_);  ///< as they are, for who takes from them
  static constexpr std::size_t most_known = 64;
  std::array<Known, most_known> known_ HIROSCO_GUARDED_BY(mutex_){};  ///< as they were found last
  std::size_t known_count_ HIROSCO_GUARDED_BY(mutex_){0};
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
