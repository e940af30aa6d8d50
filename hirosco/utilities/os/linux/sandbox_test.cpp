// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/sandbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/utilities/os/process.hpp"
#include "hirosco/utilities/os/thread.hpp"

namespace hirosco {
namespace {

constexpr int could_not_enter = 99;
/// Of root in a container that was not given it, and of nobody else.
constexpr const char* priorities_open = "every real-time priority is open (root without CAP_SYS_RESOURCE)";

/// What a process in a sandbox returns; 128 and more: the signal that ended it.
int inside(const Sandbox& sandbox, const std::function<int()>& work) {
  const PreparedSandbox prepared{sandbox};
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::_exit(prepared.enter() == 0 ? work() : could_not_enter);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// How a process ends by a call that the filter refuses and that it does not have named.
constexpr int by_filter = 128 + SIGSYS;

struct SandboxTest : testing::Test {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("sandbox." + std::to_string(::getpid()));
  void SetUp() override {
    // Where it may lack anything else, `testing/with_sandbox` does not come here.
    for (const std::string& lack : isolation_lacks()) ASSERT_EQ(lack, priorities_open);
    std::filesystem::create_directories(folder / "own");
    for (const char* name : {"secret", "own/data"}) {
      const FileDescriptor file{::open((folder / name).c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600)};
      EXPECT_TRUE(file);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  static int refused(const Sandbox& sandbox, const std::function<long()>& call) {
    return inside(sandbox, [&] { return static_cast<int>(call() & 0x3F); });
  }
  static int refused(const std::function<long()>& call) { return refused({}, call); }
  static bool opens(const std::string& path, int how) {
    const FileDescriptor file{::open(path.c_str(), how | O_CLOEXEC, 0600)};
    return static_cast<bool>(file);
  }
};

TEST_F(SandboxTest, OpensTheFilesThatItNamesAndNoOthersNorDevices) {
  const std::string own = folder / "own", secret = folder / "secret",
                    supervisor = "/proc/" + std::to_string(::getpid());
  const int wrong = inside({.readable = {}, .executable = {}, .writable = {own, "/dev/null"}}, [&] {
    if (!opens(own + "/data", O_RDWR) || !opens(own + "/new", O_RDWR | O_CREAT) || !opens("/dev/null", O_RDWR))
      return 1;
    if (!opens("/proc/self/status", O_RDONLY)) return 2;
    if (opens(secret, O_RDONLY)) return 3;
    if (opens(secret + "2", O_WRONLY | O_CREAT)) return 4;
    if (opens("/etc/passwd", O_RDONLY) || opens("/dev/kmsg", O_RDONLY) || opens("/dev/zero", O_RDWR)) return 5;
    if (opens(supervisor + "/mem", O_RDWR) || opens(supervisor + "/status", O_RDONLY)) return 6;
    if (opens("/proc/self/mem", O_RDWR)) return 7;
    return 0;
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(inside({.readable = {own}, .executable = {}, .writable = {}},
                   [&] { return opens(own + "/data", O_RDONLY) && !opens(own + "/data", O_RDWR) ? 0 : 1; }),
            0)
      << "what may be read may not be written";
}

TEST_F(SandboxTest, ReachesNoOtherProcessAndStartsNone) {
  const int wrong = inside({}, [] {
    name_refused_calls("test");
    std::array<char, 8> there{};
    iovec local{there.data(), there.size()}, remote{there.data(), there.size()};
    if (::ptrace(PTRACE_ATTACH, ::getppid(), nullptr, nullptr) == 0 || errno != EPERM) return 1;
    if (::process_vm_readv(::getppid(), &local, 1, &remote, 1, 0) >= 0 || errno != EPERM) return 2;
    if (::kill(::getppid(), 0) == 0) return 3;
    if (::fork() >= 0 || errno != EPERM) return 4;
    if (::vfork() >= 0) return 5;
    if (::socket(AF_PACKET, SOCK_RAW, 0) >= 0 || ::socket(AF_NETLINK, SOCK_RAW, 0) >= 0) return 6;
    ::execl("/bin/sh", "sh", "-c", "exit 7", nullptr);
    return errno == EACCES ? 0 : 8;
  });
  EXPECT_EQ(wrong, 0);
}

TEST_F(SandboxTest, ToldSoACallThatItRefusesFailsWithoutASignalOfWhichNobodyWouldHear) {
  Sandbox sandbox;
  sandbox.refusal = CallRefusal::Error;
  EXPECT_EQ(inside(sandbox, [] { return ::fork() < 0 && errno == EPERM ? 0 : 1; }), 0);
  EXPECT_EQ(inside(sandbox, [] { return ::socket(AF_INET, SOCK_STREAM, 0) < 0 && errno == EPERM ? 0 : 1; }), 0);
  EXPECT_EQ(inside({}, [] { return ::fork() < 0 ? 0 : 1; }), by_filter);
}

TEST_F(SandboxTest, ListsAFolderWithoutOpeningWhatIsInIt) {
  Sandbox sandbox;
  sandbox.listable = {folder / "own", folder / "secret"};
  const int wrong = inside(sandbox, [&] {
    std::error_code failed;
    if (std::filesystem::directory_iterator{folder / "own", failed} == std::filesystem::directory_iterator{}) return 1;
    if (opens(folder / "own/data", O_RDONLY)) return 2;
    if (opens(folder / "secret", O_RDONLY)) return 3;
    return std::filesystem::directory_iterator{folder, failed} == std::filesystem::directory_iterator{} ? 0 : 4;
  });
  EXPECT_EQ(wrong, 0);
}

/// By the filter alone: not every kernel has rules for signals.
TEST_F(SandboxTest, SignalsItsOwnThreadsAndNobodyElse) {
  const pid_t other = ::getpid();
  const int wrong = inside({}, [&] {
    name_refused_calls("test");
    const pid_t self = ::getpid();
    sigval nothing{};
    ::signal(SIGUSR1, SIG_IGN);
    if (::kill(self, SIGUSR1) != 0 || ::raise(SIGUSR1) != 0 || ::sigqueue(self, SIGUSR1, nothing) != 0) return 1;
    bool own = false;
    auto thread = Thread::start("signalled", [&] { own = ::pthread_kill(::pthread_self(), SIGUSR1) == 0; });
    if (!thread) return 2;
    thread->join();
    if (!own) return 3;
    for (const pid_t whom : {other, 0, -1, -self, -other})
      if (::kill(whom, 0) == 0 || errno != EPERM) return 4;
    return ::sigqueue(other, 0, nothing) == 0 || errno != EPERM ? 5 : 0;
  });
  EXPECT_EQ(wrong, 0);
  siginfo_t queued{};
  queued.si_code = SI_QUEUE;
  EXPECT_EQ(refused([&] { return ::kill(other, 0); }), by_filter);
  EXPECT_EQ(refused([&] { return ::syscall(SYS_tgkill, other, other, 0); }), by_filter);
  EXPECT_EQ(refused([&] { return ::syscall(SYS_tkill, other, 0); }), by_filter);
  EXPECT_EQ(refused([&] { return ::syscall(SYS_rt_sigqueueinfo, other, 0, &queued); }), by_filter);
  EXPECT_EQ(refused([&] { return ::syscall(SYS_rt_tgsigqueueinfo, other, other, 0, &queued); }), by_filter);
  EXPECT_EQ(refused([&] { return ::syscall(SYS_pidfd_send_signal, 3, 0, nullptr, 0); }), by_filter);
}

/// Whoever owns a file gets the signal that it asks for, and whoever sits at a terminal what is typed there.
TEST_F(SandboxTest, GivesNoFileToAnotherToSignalAndTypesForNobody) {
  const pid_t other = ::getpid();
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
  const FileDescriptor reads{pipe[0]}, writes{pipe[1]};
  const f_owner_ex owner{F_OWNER_PID, other};
  int whom = other;
  EXPECT_EQ(refused([&] { return ::fcntl(reads.get(), F_SETOWN, other); }), by_filter);
  EXPECT_EQ(refused([&] { return ::fcntl(reads.get(), F_SETOWN_EX, &owner); }), by_filter);
  EXPECT_EQ(refused([&] { return ::setpgid(0, ::getpgid(other)); }), by_filter) << "is stopped with it, and stops it";
  EXPECT_EQ(refused([&] { return ::setsid(); }), by_filter);
  for (const int request :
       {FIOSETOWN, SIOCSPGRP, TIOCSTI, TIOCSPGRP, TIOCSCTTY, static_cast<int>(TIOCSIG), TIOCLINUX}) {
    const auto number = static_cast<unsigned long>(request);
    EXPECT_EQ(refused([&] { return ::ioctl(reads.get(), number, &whom); }), by_filter) << request;
  }
  int waiting = -1;
  EXPECT_EQ(inside({}, [&] { return ::ioctl(reads.get(), FIONREAD, &waiting) == 0 && waiting == 0 ? 0 : 1; }), 0);
  EXPECT_EQ(inside({}, [&] { return ::fcntl(reads.get(), F_GETFL) == O_RDONLY ? 0 : 1; }), 0);
  EXPECT_EQ(inside({}, [&] { return ::fcntl(reads.get(), F_SETOWN, ::getpid()); }), 0) << "its own signals";
}

/// By the filter alone: what the rules of files do not know of before their third version, or never.
TEST_F(SandboxTest, CutsNoFileShortThatItMayReadNorChangesWhoMayOpenOne) {
  const std::string own = folder / "own", data = own + "/data";
  const Sandbox may_write{.readable = {}, .executable = {}, .writable = {own}};
  const FileDescriptor file{::open(data.c_str(), O_RDWR | O_CLOEXEC)};
  ASSERT_EQ(::ftruncate(file.get(), 7), 0);
  const timespec now[2]{{0, UTIME_NOW}, {0, UTIME_NOW}};
  const std::vector<std::pair<const char*, std::function<long()>>> calls{
      {"truncate", [&] { return ::truncate(data.c_str(), 0); }},
      {"read and truncate", [&] { return ::open(data.c_str(), O_RDONLY | O_TRUNC | O_CLOEXEC); }},
      {"neither read nor write", [&] { return ::open(data.c_str(), O_ACCMODE | O_CLOEXEC); }},
      {"neither, and truncate", [&] { return ::open(data.c_str(), O_ACCMODE | O_TRUNC | O_CLOEXEC); }},
      {"by an older call", [&] { return ::syscall(SYS_open, data.c_str(), O_RDONLY | O_TRUNC); }},
      {"mode", [&] { return ::chmod(data.c_str(), 0); }},
      {"mode of an open one", [&] { return ::fchmod(file.get(), 0); }},
      {"owner", [&] { return ::chown(data.c_str(), ::getuid(), ::getgid()); }},
      {"times", [&] { return ::utimensat(AT_FDCWD, data.c_str(), now, 0); }},
      {"lease", [&] { return ::fcntl(file.get(), F_SETLEASE, F_WRLCK); }},
      {"memory under a number", [&] { return ::shmget(4711, 4096, IPC_CREAT | 0600); }},
      {"a queue", [&] { return ::syscall(SYS_mq_unlink, "nobody"); }},
  };
  Sandbox with_queues;
  with_queues.queues = true;
  for (const auto& [what, call] : calls) EXPECT_EQ(refused(may_write, call), by_filter) << what;
  struct stat status{};
  ASSERT_EQ(::fstat(file.get(), &status), 0);
  EXPECT_EQ(status.st_size, 7);
  EXPECT_EQ(inside(may_write, [&] { return opens(data, O_WRONLY | O_TRUNC) ? 0 : 1; }), 0) << "what it may write";
  EXPECT_EQ(inside(with_queues, [] { return ::syscall(SYS_mq_unlink, "nobody") != 0 && errno == ENOENT ? 0 : 1; }), 0);
}

TEST_F(SandboxTest, SchedulesItsOwnThreadsAndLimitsItselfButNobodyElse) {
  const int wrong = inside({}, [] {
    name_refused_calls("test");
    const pid_t other = ::getppid();
    const sched_param ordinary{};
    cpu_set_t all;
    CPU_ZERO(&all);
    CPU_SET(0, &all);
    rlimit limit{};
    if (::sched_setscheduler(0, SCHED_OTHER, &ordinary) != 0 || ::sched_setaffinity(0, sizeof all, &all) != 0) return 1;
    if (::getrlimit(RLIMIT_CORE, &limit) != 0 || ::setrlimit(RLIMIT_CORE, &limit) != 0) return 2;
    if (::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0)) != 0) return 3;
    if (::sched_setscheduler(other, SCHED_OTHER, &ordinary) == 0 || errno != EPERM) return 4;
    if (::sched_setparam(other, &ordinary) == 0 || ::sched_setaffinity(other, sizeof all, &all) == 0) return 5;
    if (::prlimit(other, RLIMIT_CORE, &limit, nullptr) == 0 || ::prlimit(other, RLIMIT_CORE, nullptr, &limit) == 0)
      return 6;
    if (::setpriority(PRIO_PROCESS, static_cast<id_t>(other), 19) == 0 || ::setpriority(PRIO_USER, 0, 19) == 0)
      return 7;
    if (::getrlimit(RLIMIT_RTPRIO, &limit) != 0) return 8;
    return ::setrlimit(RLIMIT_RTPRIO, &limit) == 0 ? 9 : 0;
  });
  EXPECT_EQ(wrong, 0);
}

TEST_F(SandboxTest, AStartedProcessTakesNoPriorityAboveItsLimitOrItIsToldThatThereIsNone) {
  const PreparedSandbox prepared{
      {.readable = {"/etc"}, .executable = {"/bin", "/usr", "/lib", "/lib64"}, .writable = {"/dev/null"}}};
  const auto takes = [&](std::uint64_t limit, const char* priority) {
    ProcessStart start{.executable = "/usr/bin/chrt", .arguments = {"-f", priority, "/bin/true"}};
    start.limits.realtime_priority = limit;
    start.sandbox = &prepared;
    auto process = Process::spawn(start);
    int status = -1;
    if (process) ::waitpid(process->pid(), &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  };
  const bool open = !isolation_lacks().empty();
  EXPECT_EQ(takes(5, "5"), realtime_permitted());
  EXPECT_EQ(takes(5, "6"), open);
  EXPECT_EQ(takes(5, "91"), open);
}

TEST_F(SandboxTest, ARefusedCallEndsWhoDoesNotNameIt) {
  EXPECT_EQ(inside({}, [] { return static_cast<int>(::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr)); }), by_filter);
}

TEST_F(SandboxTest, KeepsWhatACycleNeeds) {
  const bool realtime = realtime_permitted();
  const int wrong = inside({.readable = {}, .executable = {}, .writable = {"/dev/shm"}}, [&] {
    const std::string name = "/hirosco-sandbox." + std::to_string(::getpid());
    const FileDescriptor shared{::shm_open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)};
    if (!shared || ::shm_unlink(name.c_str()) != 0) return 1;
    const FileDescriptor link{::memfd_create("link", MFD_CLOEXEC | MFD_ALLOW_SEALING)};
    if (!link || ::ftruncate(link.get(), 4096) != 0) return 2;
    bool fifo = !realtime;
    auto cycle = Thread::start("cycle", [&] { fifo = fifo || set_fifo_priority(1).has_value(); });
    if (!cycle) return 3;
    cycle->join();
    if (!fifo) return 4;
    return 0;
  });
  EXPECT_EQ(wrong, 0);
}

/// Port of a listener at 127.0.0.1.
std::uint16_t listen_here(FileDescriptor& listener) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  listener.reset(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listener.get(), 4) != 0 ||
      ::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    return 0;
  return ntohs(address.sin_port);
}

sockaddr_in at_port(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

bool makes(int domain, int type, int protocol = 0) {
  const FileDescriptor socket{::socket(domain, type | SOCK_CLOEXEC, protocol)};
  return static_cast<bool>(socket);
}

bool connects_to(std::uint16_t port) {
  const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const sockaddr_in there = at_port(port);
  return socket && ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0;
}

/// Data with the first segment: neither connect() nor a rule of Landlock is asked.
bool sends_at_once_to(std::uint16_t port) {
  const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const sockaddr_in there = at_port(port);
  return socket &&
         ::sendto(socket.get(), "x", 1, MSG_FASTOPEN, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 1;
}

bool binds_to(std::uint16_t port) {
  const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const sockaddr_in here = at_port(port);
  return socket && ::bind(socket.get(), reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0;
}

TEST_F(SandboxTest, MakesNoSocketsUnlessItNamesThem) {
  const int wrong = inside({}, [] {
    name_refused_calls("test");
    for (const int domain : {AF_UNIX, AF_INET, AF_INET6, AF_PACKET, AF_NETLINK, AF_VSOCK})
      for (const int type : {SOCK_STREAM, SOCK_DGRAM, SOCK_SEQPACKET, SOCK_RAW})
        if (makes(domain, type)) return 1;
    std::array<int, 2> pair{};
    return ::socketpair(AF_UNIX, SOCK_DGRAM, 0, pair.data()) == 0 ? 2 : 0;
  });
  EXPECT_EQ(wrong, 0);
}

TEST_F(SandboxTest, MakesTheSocketsThatItNamesAndNoOthers) {
  const auto made = [](SandboxSockets sockets) {
    Sandbox sandbox;
    sandbox.sockets = std::move(sockets);
    return inside(sandbox, [] {
      name_refused_calls("test");
      int kinds = makes(AF_UNIX, SOCK_DGRAM) ? 1 : 0;
      if (makes(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK) && makes(AF_INET6, SOCK_DGRAM, IPPROTO_UDP)) kinds |= 2;
      if (makes(AF_INET, SOCK_STREAM | SOCK_NONBLOCK) && makes(AF_INET6, SOCK_STREAM, IPPROTO_TCP)) kinds |= 4;
      constexpr int of_many_ways = 262;  // TCP by several ways at once, which Landlock's rules are not for
      if (makes(AF_INET, SOCK_STREAM, of_many_ways) || makes(AF_INET, SOCK_RAW, IPPROTO_UDP)) kinds |= 8;
      if (makes(AF_INET, SOCK_DGRAM, IPPROTO_ICMP) || makes(AF_NETLINK, SOCK_DGRAM)) kinds |= 8;
      return kinds;
    });
  };
  EXPECT_EQ(made({.local = true}), 1);
  EXPECT_EQ(made({.datagrams = true}), 2);
  EXPECT_EQ(made({.ports = {4000}}), 4);
  EXPECT_EQ(made({.local = true, .datagrams = true, .streams = true}), 7);
}

TEST_F(SandboxTest, ConnectsToThePortsThatItNamesAndListensAtNone) {
  FileDescriptor own, others;
  const std::uint16_t port = listen_here(own), other = listen_here(others);
  ASSERT_NE(port, 0);
  ASSERT_NE(other, 0);
  Sandbox sandbox;
  sandbox.sockets.ports = {port};
  const auto tried = [&] {
    name_refused_calls("test");
    return (connects_to(port) ? 1 : 0) + (connects_to(other) ? 2 : 0) + (sends_at_once_to(other) ? 4 : 0) +
           (binds_to(0) ? 8 : 0);
  };
  EXPECT_EQ(inside(sandbox, tried), 1);
  sandbox.sockets.own_port = true;
  EXPECT_EQ(inside(sandbox, tried), 1 + 8) << "its own end in the network of its device";
  const int heard = inside(sandbox, [&] {
    name_refused_calls("test");
    const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    return (::listen(socket.get(), 1) == 0 ? 1 : 0) + (binds_to(static_cast<std::uint16_t>(other + 1)) ? 2 : 0);
  });
  EXPECT_EQ(heard, 0);
  sandbox.sockets = {.streams = true};
  EXPECT_EQ(inside(sandbox, tried), 15) << "the ground link, whose clients nobody knows";
}

TEST_F(SandboxTest, AConnectedDeviceOfItsOwnIsSentToAsBefore) {
  FileDescriptor own;
  Sandbox sandbox;
  sandbox.sockets.ports = {listen_here(own)};
  const int wrong = inside(sandbox, [&] {
    name_refused_calls("test");
    const FileDescriptor socket{::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)};
    const sockaddr_in there = at_port(sandbox.sockets.ports[0]);
    if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) return 1;
    return ::send(socket.get(), "frame", 5, MSG_NOSIGNAL) == 5 ? 0 : 2;
  });
  EXPECT_EQ(wrong, 0);
}

TEST_F(SandboxTest, AStartedProcessIsInIt) {
  const Sandbox sandbox{
      .readable = {"/etc"}, .executable = {"/bin", "/usr", "/lib", "/lib64"}, .writable = {"/dev/null"}};
  const PreparedSandbox prepared{sandbox};
  std::vector<FileDescriptor> ours;  // more than it may have
  for (int i = 0; i < 80; ++i) ours.emplace_back(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  ProcessStart start{.executable = "/bin/sh",
                     .arguments = {"-c", "exec 2>/dev/null; read x < " + (folder / "secret").string() +
                                             " && exit 1; ulimit -n 100000 && exit 2; exit 7"}};
  start.limits.descriptors = 64;
  start.sandbox = &prepared;
  auto process = Process::spawn(start);
  ASSERT_TRUE(process) << process.error().text << " " << process.error().value;
  int status = 0;
  ::waitpid(process->pid(), &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

}  // namespace
}  // namespace hirosco
