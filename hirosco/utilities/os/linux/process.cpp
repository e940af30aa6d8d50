// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <string_view>

#include "hirosco/utilities/os/own_user.hpp"

namespace hirosco {
namespace {

constexpr int exit_code_not_started = 127;
/// An executable on a disk that hangs holds up nobody for longer. Well below what the supervisor's loop may stand still for.
constexpr int longest_start_ms = 300;

/// All the child needs, prepared before fork(): between fork() and exec() only async-signal-safe calls are allowed,
/// since another thread may have held the heap's lock.
struct Plan {
  std::vector<char*> arguments;
  std::vector<char*> environment;
  char** environment_used{environ};
  std::vector<ProcessStart::Inherited> inherited;
  std::vector<int> parked;  ///< room for the child's temporary numbers
  int first_free{3};  ///< above every number wanted
  const char* executable{};
  int image{-1};
  const char* directory{};
  sigset_t blocked{};
  ProcessLimits limits;
  const PreparedSandbox* sandbox{nullptr};
  std::optional<std::uint32_t> user;
  bool over_users{false};
  int report{-1};  ///< the child writes errno here when it fails
};

void add_texts(std::vector<char*>& texts, const std::vector<std::string>& values) {
  // exec() takes char* for the sake of C and does not write.
  for (const std::string& value : values) texts.push_back(const_cast<char*>(value.c_str()));
}

[[nodiscard]] Plan plan_of(const ProcessStart& start) {
  Plan plan;
  plan.arguments.push_back(const_cast<char*>(start.executable.c_str()));
  add_texts(plan.arguments, start.arguments);
  plan.arguments.push_back(nullptr);
  if (start.environment) {
    add_texts(plan.environment, *start.environment);
    plan.environment.push_back(nullptr);
    plan.environment_used = plan.environment.data();
  }
  plan.inherited = start.inherited;
  plan.parked.resize(start.inherited.size(), -1);
  for (const auto& entry : start.inherited) plan.first_free = std::max(plan.first_free, entry.number + 1);
  sigemptyset(&plan.blocked);
  for (const int number : start.blocked) sigaddset(&plan.blocked, number);
  plan.executable = start.executable.c_str();
  plan.image = start.image.value_or(-1);
  plan.limits = start.limits;
  plan.sandbox = start.sandbox;
  plan.user = start.user;
  plan.over_users = start.over_users;
  if (!start.working_directory.empty()) plan.directory = start.working_directory.c_str();
  return plan;
}

[[noreturn]] void give_up(int report, int error) noexcept {
  (void)!::write(report, &error, sizeof error);
  ::_exit(exit_code_not_started);
}

/// Parks every source above all targets first: a target may be the number of another's source.
void place_descriptors(Plan& plan) noexcept {
  const int report = ::fcntl(plan.report, F_DUPFD_CLOEXEC, plan.first_free);
  if (report < 0) give_up(plan.report, errno);
  plan.report = report;
  const int image = plan.image;
  if (image >= 0 && (plan.image = ::fcntl(image, F_DUPFD_CLOEXEC, plan.first_free)) < 0) give_up(report, errno);
  for (std::size_t i = 0; i < plan.inherited.size(); ++i) {
    plan.parked[i] = ::fcntl(plan.inherited[i].ours, F_DUPFD_CLOEXEC, plan.first_free);
    if (plan.parked[i] < 0) give_up(report, errno);
  }
  if (::close_range(3, ~0U, CLOSE_RANGE_CLOEXEC) != 0) give_up(report, errno);
  for (std::size_t i = 0; i < plan.inherited.size(); ++i) {
    if (::dup2(plan.parked[i], plan.inherited[i].number) < 0) give_up(report, errno);
    // One that stays open: by it an interpreter finds its script.
    if (image >= 0 && plan.inherited[i].ours == image) plan.image = plan.inherited[i].number;
  }
}

void reset_signals(const sigset_t& blocked) noexcept {
  for (int number = 1; number < NSIG; ++number) {
    struct sigaction action{};
    action.sa_handler = SIG_DFL;
    (void)::sigaction(number, &action, nullptr);
  }
  (void)::sigprocmask(SIG_SETMASK, &blocked, nullptr);
}

/// Neither can be raised again by who is not privileged.
void set_limit(const Plan& plan, int resource, const std::optional<std::uint64_t>& most) noexcept {
  if (!most) return;
  const rlimit limit{.rlim_cur = *most, .rlim_max = *most};
  if (::setrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0) give_up(plan.report, errno);
}

/// Who may not raise a limit lets it have what there is.
void set_priority_limit(const Plan& plan) noexcept {
  if (!plan.limits.realtime_priority) return;
  rlimit limit{.rlim_cur = *plan.limits.realtime_priority, .rlim_max = *plan.limits.realtime_priority};
  if (::setrlimit(RLIMIT_RTPRIO, &limit) == 0) return;
  rlimit ours{};
  if (::getrlimit(RLIMIT_RTPRIO, &ours) != 0) give_up(plan.report, errno);
  limit.rlim_cur = limit.rlim_max = std::min<rlim_t>(ours.rlim_max, limit.rlim_max);
  if (::setrlimit(RLIMIT_RTPRIO, &limit) != 0) give_up(plan.report, errno);
}

/// Everybody may say it of himself, and nobody takes it back who is not privileged. Without /proc it is as it was.
void offer_to_go_first() noexcept {
  const int place = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (place < 0) return;
  constexpr std::string_view half = "500";
  (void)!::write(place, half.data(), half.size());
  ::close(place);
}

[[noreturn]] void run_child(Plan& plan) noexcept {
  (void)::setpgid(0, 0);
  place_descriptors(plan);
  const sched_param ordinary{};
  (void)::sched_setscheduler(0, SCHED_OTHER, &ordinary);
  if (plan.directory != nullptr && ::chdir(plan.directory) != 0) give_up(plan.report, errno);
  reset_signals(plan.blocked);
  if (plan.limits.goes_first) offer_to_go_first();
  if (plan.limits.processors && !plan.limits.processors->take()) give_up(plan.report, EINVAL);
  set_priority_limit(plan);  // by it a sandbox knows what it has to keep
  if (plan.sandbox != nullptr)
    if (const int error = plan.sandbox->enter(); error != 0) give_up(plan.report, error);
  // Last: until then all of ours are still open, and a sandbox opens two more.
  set_limit(plan, RLIMIT_DATA, plan.limits.memory_octets);
  set_limit(plan, RLIMIT_NOFILE, plan.limits.descriptors);
  // Behind all that our rights are needed for: files of its sandbox, priority and limits.
  if (plan.user)
    if (const int error = become_user(*plan.user); error != 0) give_up(plan.report, error);
  if (!plan.over_users) lay_down_rights_over_users();
  if (plan.image >= 0)
    ::syscall(SYS_execveat, plan.image, "", plan.arguments.data(), plan.environment_used, AT_EMPTY_PATH);
  else ::execve(plan.executable, plan.arguments.data(), plan.environment_used);
  give_up(plan.report, errno);
}

/// 0 once the child runs its executable (which closes the pipe), or when it takes so long that it counts as started: should it fail
/// then, its end tells. Otherwise the child's errno.
[[nodiscard]] int reported_error(int read_end) noexcept {
  int error = 0;
  ssize_t got = 0;
  pollfd report{read_end, POLLIN, 0};
  if (::poll(&report, 1, longest_start_ms) == 0) return 0;
  do {
    got = ::read(read_end, &error, sizeof error);
  } while (got < 0 && errno == EINTR);
  return got == static_cast<ssize_t>(sizeof error) ? error : 0;
}

[[nodiscard]] ErrorCode failure_of(int error) noexcept {
  switch (error) {
    case ENOENT:
    case ESRCH: return ErrorCode::NotFound;
    case EACCES:
    case EPERM: return ErrorCode::NotPermitted;
    case EAGAIN:
    case ENOMEM:
    case EMFILE: return ErrorCode::ResourceExhausted;
    default: return ErrorCode::SystemFailure;
  }
}

[[nodiscard]] Result<> check(const ProcessStart& start) noexcept {
  if (start.executable.empty()) return fail(ErrorCode::InvalidArgument, "executable to start");
  for (const auto& entry : start.inherited) {
    constexpr int highest = 1000;
    if (entry.ours < 0 || entry.number < 0 || entry.number > highest)
      return fail(ErrorCode::InvalidArgument, "inherited descriptor", entry.number);
    if (std::ranges::count(start.inherited, entry.number, &ProcessStart::Inherited::number) != 1)
      return fail(ErrorCode::AlreadyExists, "inherited descriptor", entry.number);
  }
  return ok();
}

}  // namespace

Result<Process> Process::spawn(const ProcessStart& start) {
  HIROSCO_TRY(check(start));
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return fail(ErrorCode::SystemFailure, "pipe to a new process", errno);
  const FileDescriptor read_end{ends[0]};
  FileDescriptor write_end{ends[1]};
  Plan plan = plan_of(start);
  plan.report = write_end.get();

  // No handler of ours may run in the child before reset_signals().
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  (void)::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t pid = ::fork();
  if (pid == 0) run_child(plan);
  const int fork_error = errno;
  (void)::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (pid < 0) return fail(failure_of(fork_error), "new process", fork_error);

  // In both processes, so that whoever comes first finds the group.
  (void)::setpgid(pid, pid);
  write_end.reset();
  if (const int error = reported_error(read_end.get()); error != 0) {
    (void)collect(pid);
    return fail(failure_of(error), "start executable", error);
  }
  // Safe against reuse of the pid: the child is not reaped before we say so.
  auto process = adopt(pid);
  if (!process) {
    (void)::kill(pid, SIGKILL);
    (void)collect(pid);
  }
  return process;
}

Result<Process> Process::adopt(int pid) noexcept {
  // By number: glibc 2.36 declares these two without C linkage.
  FileDescriptor handle{static_cast<int>(::syscall(SYS_pidfd_open, pid, 0))};
  if (!handle) return fail(failure_of(errno), "handle of a process", errno);
  return adopt(pid, std::move(handle));
}

Result<Process> Process::adopt(int pid, FileDescriptor handle) noexcept {
  if (!handle) return fail(ErrorCode::InvalidArgument, "handle of a process");
  (void)::fcntl(handle.get(), F_SETFD, FD_CLOEXEC);
  return Process{pid, std::move(handle)};
}

Result<std::optional<ExitStatus>> Process::poll() noexcept {
  if (ended_) return ended_;
  siginfo_t info{};
  int outcome = 0;
  do {
    outcome = ::waitid(P_PIDFD, static_cast<id_t>(handle_.get()), &info, WEXITED | WNOHANG | WNOWAIT);
  } while (outcome != 0 && errno == EINTR);
  if (outcome == 0) {
    if (info.si_pid == 0) return std::nullopt;
    (void)collect(pid_);
    ended_ =
        ExitStatus{info.si_code == CLD_EXITED ? ExitStatus::Kind::Exited : ExitStatus::Kind::Signalled, info.si_status};
    return ended_;
  }
  if (errno != ECHILD) return fail(ErrorCode::SystemFailure, "state of a process", errno);
  pollfd look{handle_.get(), POLLIN, 0};
  if (::poll(&look, 1, 0) > 0) ended_ = ExitStatus{ExitStatus::Kind::Unknown, 0};
  return ended_;
}

Result<> Process::send_signal(int signal) noexcept {
  if (ended_) return fail(ErrorCode::NotFound, "process has ended", pid_);
  if (::syscall(SYS_pidfd_send_signal, handle_.get(), signal, nullptr, 0) != 0)
    return fail(failure_of(errno), "signal to a process", errno);
  return ok();
}

/// By its handle, which names the group of this process and of no other one even when it has ended and its number is somebody else's.
void Process::kill_with_its_own() noexcept {
  // PIDFD_SIGNAL_PROCESS_GROUP of Linux 6.9, which older headers do not have.
  constexpr unsigned to_its_group = 1U << 2;
  if (::syscall(SYS_pidfd_send_signal, handle_.get(), SIGKILL, nullptr, to_its_group) != 0 && errno == EINVAL) {
    // An older system knows a group by its number alone: nobody else has it while its process has not ended. Of whom no number is known
    // there is none, and -1 would be everybody.
    pollfd look{handle_.get(), POLLIN, 0};
    if (pid_ > 1 && !ended_ && ::poll(&look, 1, 0) == 0) (void)::kill(-pid_, SIGKILL);
  }
  static_cast<void>(send_signal(SIGKILL));
}

void hurry_end(ProcessThreads& threads) noexcept {
  const sched_param lowest{.sched_priority = ::sched_get_priority_min(SCHED_FIFO)};
  threads.each([&](int thread) {
    const int policy = ::sched_getscheduler(thread) & ~SCHED_RESET_ON_FORK;
    if (policy != SCHED_BATCH) (void)::sched_setscheduler(thread, SCHED_FIFO, &lowest);
  });
}

}  // namespace hirosco
