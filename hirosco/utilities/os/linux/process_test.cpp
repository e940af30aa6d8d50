// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <utility>
#include <vector>

#include "hirosco/utilities/os/processor_set.hpp"
#include "hirosco/utilities/os/thread.hpp"
#include "hirosco/utilities/os/wait_set.hpp"
#include "hirosco/utilities/sanitizer.hpp"

namespace hirosco {
namespace {

[[nodiscard]] ProcessStart shell(std::string command) {
  return {.executable = "/bin/sh", .arguments = {"-c", std::move(command)}};
}

[[nodiscard]] ExitStatus end_of(Process& process) {
  WaitSet set;
  EXPECT_TRUE(set.add(process.handle().get()));
  EXPECT_EQ(set.wait(std::nullopt)->size(), 1U);
  return process.poll()->value();
}

struct Pipe {
  FileDescriptor read_end;
  FileDescriptor write_end;
  Pipe() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
    read_end.reset(ends[0]);
    write_end.reset(ends[1]);
  }
  /// All that is written until the last writer is gone.
  [[nodiscard]] std::string rest() {
    write_end.reset();
    std::string text;
    std::array<char, 256> part{};
    ssize_t got = 0;
    while ((got = ::read(read_end.get(), part.data(), part.size())) > 0)
      text.append(part.data(), static_cast<std::size_t>(got));
    return text;
  }
};

/// PIDFD_SIGNAL_PROCESS_GROUP; signal 0 ends nobody.
[[nodiscard]] bool knows_groups_by_handle(const Process& process) {
  return ::syscall(SYS_pidfd_send_signal, process.handle().get(), 0, nullptr, 1U << 2) == 0 || errno != EINVAL;
}

TEST(Process, TellsItsExitCode) {
  auto process = Process::spawn(shell("exit 7"));
  ASSERT_TRUE(process) << process.error().text;
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Exited, 7}));
  EXPECT_EQ(process->poll()->value(), (ExitStatus{ExitStatus::Kind::Exited, 7})) << "the answer is repeated";
  EXPECT_FALSE(process->poll()->value().success());
}

/// Whether a child that has ended is still there.
[[nodiscard]] bool is_to_be_collected(int pid) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0;
}

/// In a process of its own, on one processor; 0: all is as it should be, 9: no real time for this user.
int end_with_realtime() {
  if (!pin_to_cpu(*ProcessorSet::of_this_thread().last()) || !begin_collecting()) return 1;
  if (!set_fifo_priority(1)) return 9;
  std::vector<int> ended;
  for (int i = 0; i < 100; ++i) {
    auto process = Process::spawn(shell("exit 7"));
    if (!process || end_of(*process) != ExitStatus{ExitStatus::Kind::Exited, 7}) return 2;
    // Nobody without real time has had this processor since: whoever was to collect it did not.
    if (!is_to_be_collected(process->pid())) return 3;
    if (collect(process->pid()) != Collection::UnderWay) return 4;
    if (process->poll()->value().value != 7) return 5;
    ended.push_back(process->pid());
  }
  if (!set_ordinary_scheduling()) return 6;
  for (const int pid : ended)
    while (is_to_be_collected(pid)) ::sched_yield();
  return collect(ended.front()) == Collection::UnderWay ? 0 : 7;
}

TEST(Process, IsCollectedByAnotherThreadWhereWhoAsksHasRealTime) {
  const pid_t user = ::fork();
  if (user == 0) ::_exit(end_with_realtime());
  int status = 0;
  ASSERT_EQ(::waitpid(user, &status, 0), user);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), realtime_permitted() ? 0 : 9);
}

TEST(Process, TellsItsEndToWhoHasRealTimeThoughNoThreadIsToBeHad) {
  if (built_with_sanitizer) return;  // which ends a process that has no memory
  const pid_t user = ::fork();
  if (user == 0) {
    if (!set_fifo_priority(1)) ::_exit(9);
    auto process = Process::spawn(shell("exit 7"));
    const rlimit none{.rlim_cur = 0, .rlim_max = 0};
    if (::setrlimit(RLIMIT_AS, &none) != 0) ::_exit(1);
    // The C library may have kept room for some.
    for (const std::size_t stack : {std::size_t{0}, std::size_t{1} << 20, std::size_t{1} << 16})
      while (auto thread = Thread::start(
                 "rests",
                 [] {
                   for (;;) ::pause();
                 },
                 stack))
        thread->leave_behind();
    pollfd end{process->handle().get(), POLLIN, 0};
    ::poll(&end, 1, -1);
    const auto told = process->poll();
    ::_exit(told && *told && (*told)->value == 7 && collect(process->pid()) == Collection::NotNow ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(user, &status, 0), user);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), realtime_permitted() ? 0 : 9);
}

TEST(Process, IsRefusedWhatIsBeyondItsLimits) {
  ProcessStart start = shell("ulimit -n; ulimit -d; ulimit -n 65 2>/dev/null; ulimit -Hn");
  Pipe pipe;
  start.inherited = {{pipe.write_end.get(), STDOUT_FILENO}};
  start.limits = {.memory_octets = 64 << 20, .descriptors = 64};
  auto process = Process::spawn(start);
  ASSERT_TRUE(process) << process.error().text;
  const std::string said = pipe.rest();
  EXPECT_TRUE(said.starts_with("64\n65536\n")) << said;
  EXPECT_TRUE(end_of(*process).success());
}

TEST(Process, RunsUntilASignalEndsIt) {
  auto process = Process::spawn(shell("kill -STOP $$; exit 0"));
  ASSERT_TRUE(process);
  EXPECT_EQ(process->poll()->has_value(), false);
  EXPECT_TRUE(process->send_signal(SIGKILL));
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Signalled, SIGKILL}));
  EXPECT_EQ(process->send_signal(SIGKILL).error().code, ErrorCode::NotFound);
}

TEST(Process, TakesWhomItHasStartedWithItWhenItIsKilledSo) {
  // Whoever still has the pipe holds it open: its end is that of all of them.
  Pipe pipe;
  ProcessStart start = shell("sleep 1000 & echo started; wait");
  start.inherited = {{pipe.write_end.get(), STDOUT_FILENO}};
  auto process = Process::spawn(start);
  ASSERT_TRUE(process) << process.error().text;
  std::array<char, 8> text{};
  ASSERT_EQ(::read(pipe.read_end.get(), text.data(), text.size()), 8);
  process->kill_with_its_own();
  EXPECT_EQ(pipe.rest(), "");
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Signalled, SIGKILL}));
  process->kill_with_its_own();  // nobody is there any more
}

TEST(Process, TakesWhomItHasLeftBehindWhenItHasEndedByItself) {
  Pipe pipe;
  ProcessStart start = shell("sleep 1000 & echo started");
  start.inherited = {{pipe.write_end.get(), STDOUT_FILENO}};
  auto process = Process::spawn(start);
  ASSERT_TRUE(process) << process.error().text;
  std::array<char, 8> text{};
  ASSERT_EQ(::read(pipe.read_end.get(), text.data(), text.size()), 8);
  EXPECT_TRUE(end_of(*process).success());
  process->kill_with_its_own();
  if (!knows_groups_by_handle(*process)) {
    ::kill(-process->pid(), SIGKILL);  // its number is the group's as long as that lives
    GTEST_SKIP() << "this system knows groups by their numbers alone";
  }
  EXPECT_EQ(pipe.rest(), "");
}

TEST(Process, OfWhomNoNumberIsKnownNobodyElseIsEnded) {
  auto process = Process::spawn(shell("sleep 1000"));
  ASSERT_TRUE(process) << process.error().text;
  FileDescriptor handle{::fcntl(process->handle().get(), F_DUPFD_CLOEXEC, 0)};
  auto nameless = Process::adopt(-1, std::move(handle));
  ASSERT_TRUE(nameless) << nameless.error().text;
  nameless->kill_with_its_own();
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Signalled, SIGKILL}));
}

/// A process that is no leader of a group has none of its own: who shares its group with it goes on.
TEST(Process, ThatIsInTheGroupOfAnotherIsEndedAlone) {
  const pid_t child = ::fork();
  if (child == 0)
    for (;;) ::pause();
  auto process = Process::adopt(child);
  ASSERT_TRUE(process) << process.error().text;
  process->kill_with_its_own();  // we are in that group, too
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Signalled, SIGKILL}));
}

TEST(Process, AnExecutableThatDoesNotExistIsAnErrorAtOnce) {
  const auto process = Process::spawn({.executable = "/nonexistent/executable"});
  ASSERT_FALSE(process);
  EXPECT_EQ(process.error().code, ErrorCode::NotFound);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "no zombie stays";
  EXPECT_EQ(Process::spawn({.executable = "/"}).error().code, ErrorCode::NotPermitted);
  EXPECT_FALSE(Process::spawn({}));
}

TEST(Process, ExecutesTheImageThatItIsGivenWhateverHasThePathByThen) {
  const FileDescriptor image{::open("/bin/sh", O_RDONLY | O_CLOEXEC)};
  Pipe pipe;
  ProcessStart start = shell("echo $0; exit 7");
  start.executable = "/nonexistent/executable";
  start.image = image.get();
  start.inherited = {{pipe.write_end.get(), STDOUT_FILENO}};
  auto process = Process::spawn(start);
  ASSERT_TRUE(process) << process.error().text;
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Exited, 7}));
  EXPECT_EQ(pipe.rest(), "/nonexistent/executable\n");
  const FileDescriptor text{::open("/etc/passwd", O_RDONLY | O_CLOEXEC)};
  start.image = text.get();
  EXPECT_EQ(Process::spawn(start).error().code, ErrorCode::NotPermitted);
  start.image = 1'000'000;
  EXPECT_FALSE(Process::spawn(start)) << "no such descriptor";
}

/// A lease holds up whoever opens the file, as a disk that hangs does.
TEST(Process, AnExecutableThatItsDiskHoldsUpHoldsUpNobodyAndRunsOnceItIsThere) {
  std::string folder = (std::filesystem::temp_directory_path() / "hirosco-lease-XXXXXX").string();
  ASSERT_NE(::mkdtemp(folder.data()), nullptr);
  const std::string program = folder + "/program";
  std::filesystem::copy_file("/bin/true", program);
  const auto before = std::signal(SIGIO, SIG_IGN);
  {
    const FileDescriptor file{::open(program.c_str(), O_RDONLY | O_CLOEXEC)};
    ASSERT_EQ(::fcntl(file.get(), F_SETLEASE, F_WRLCK), 0);
    auto process = Process::spawn({.executable = program});
    ASSERT_TRUE(process);
    EXPECT_FALSE(process->poll()->has_value()) << "it counts as started";
    ASSERT_EQ(::fcntl(file.get(), F_SETLEASE, F_UNLCK), 0);
    EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Exited, 0}));
  }
  static_cast<void>(std::signal(SIGIO, before));
  std::filesystem::remove_all(folder);
}

TEST(Process, HasTheInheritedDescriptorsAndNoOthers) {
  Pipe first;
  Pipe second;
  Pipe list;
  // The targets are chosen to be the numbers of each other's sources.
  const int a = first.write_end.get();
  const int b = second.write_end.get();
  ProcessStart start = shell("printf one >&" + std::to_string(b) + "; printf two >&" + std::to_string(a) +
                             "; cd /proc/self/fd; echo * >&40");
  start.inherited = {{a, b}, {b, a}, {list.write_end.get(), 40}};
  start.executable = "/bin/bash";
  ASSERT_TRUE(std::filesystem::exists(start.executable)) << "other shells know one-digit descriptors only";
  // A descriptor that somebody forgot to close on exec.
  const FileDescriptor stray{::fcntl(0, F_DUPFD, 50)};
  ASSERT_TRUE(stray);
  auto process = Process::spawn(start);
  ASSERT_TRUE(process);
  EXPECT_TRUE(end_of(*process).success());
  EXPECT_EQ(first.rest(), "one");
  EXPECT_EQ(second.rest(), "two");
  const std::string numbers = " " + list.rest();
  EXPECT_EQ(numbers.find(" " + std::to_string(stray.get())), std::string::npos) << numbers;
  EXPECT_NE(numbers.find(" 40"), std::string::npos) << numbers;
}

TEST(Process, IsInAGroupOfItsOwnWithDefaultSignals) {
  (void)std::signal(SIGPIPE, SIG_IGN);
  Pipe pipe;
  ProcessStart start = shell("read line < /proc/self/stat; set -- $line; echo $$ $5 >&9; trap - PIPE; kill -PIPE $$");
  start.inherited = {{pipe.write_end.get(), 9}};
  auto process = Process::spawn(start);
  ASSERT_TRUE(process);
  EXPECT_EQ(end_of(*process), (ExitStatus{ExitStatus::Kind::Signalled, SIGPIPE}));
  const std::string pid = std::to_string(process->pid());
  EXPECT_EQ(pipe.rest(), pid + " " + pid + "\n");
  (void)std::signal(SIGPIPE, SIG_DFL);
}

TEST(Process, GetsItsEnvironmentAndDirectory) {
  Pipe pipe;
  ProcessStart start = shell("echo \"$HIROSCO_TEST:$HOME:$PWD\" >&9");
  start.inherited = {{pipe.write_end.get(), 9}};
  start.environment = {{"HIROSCO_TEST=value"}};
  start.working_directory = "/";
  auto process = Process::spawn(start);
  ASSERT_TRUE(process);
  EXPECT_EQ(pipe.rest(), "value::/\n");
  EXPECT_TRUE(end_of(*process).success());
  start.working_directory = "/nonexistent";
  EXPECT_EQ(Process::spawn(start).error().code, ErrorCode::NotFound);
}

TEST(Process, RefusesDescriptorsWithoutMeaning) {
  ProcessStart start = shell("true");
  start.inherited = {{-1, 9}};
  EXPECT_EQ(Process::spawn(start).error().code, ErrorCode::InvalidArgument);
  start.inherited = {{0, 9}, {1, 9}};
  EXPECT_EQ(Process::spawn(start).error().code, ErrorCode::AlreadyExists);
  start.inherited = {{0, 1 << 20}};
  EXPECT_EQ(Process::spawn(start).error().code, ErrorCode::InvalidArgument);
}

TEST(Process, OneThatIsHurriedComesBeforeOrdinaryOnesAndNobodyMindsOneThatIsGone) {
  auto process = Process::spawn({.executable = "/bin/sleep", .arguments = {"60"}}).value();
  ProcessThreads threads = ProcessThreads::of(process.pid());
  hurry_end(threads);
  EXPECT_EQ(::sched_getscheduler(process.pid()), realtime_permitted() ? SCHED_FIFO : SCHED_OTHER);
  ASSERT_TRUE(process.send_signal(SIGKILL));
  static_cast<void>(end_of(process));
  hurry_end(threads);
}

TEST(Process, AnAdoptedProcessOfOthersEndsAsUnknown) {
  Pipe pipe;
  // The grandchild is not ours: its parent ends at once and init takes it over.
  ProcessStart start = shell("(echo; read line) <&8 >&9 & echo $! >&9");
  Pipe hold;
  start.inherited = {{pipe.write_end.get(), 9}, {hold.read_end.get(), 8}};
  auto parent = Process::spawn(start);
  ASSERT_TRUE(parent);
  EXPECT_TRUE(end_of(*parent).success());
  std::array<char, 64> text{};
  std::string said;
  while (std::count(said.begin(), said.end(), '\n') < 2) {
    const ssize_t got = ::read(pipe.read_end.get(), text.data(), text.size());
    ASSERT_GT(got, 0);
    said.append(text.data(), static_cast<std::size_t>(got));
  }
  auto adopted = Process::adopt(std::stoi(said));
  ASSERT_TRUE(adopted) << adopted.error().text;
  EXPECT_FALSE(adopted->poll()->has_value());
  hold.write_end.reset();
  EXPECT_EQ(end_of(*adopted).kind, ExitStatus::Kind::Unknown);
}

}  // namespace
}  // namespace hirosco
