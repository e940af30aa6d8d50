// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <linux/falloc.h>
#include <netinet/in.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "hirosco/subsystem/pages/pages.hpp"

/// A real subsystem that turns on its supervisor when it is sent SIGUSR2 (hazard SF13). It tries to change every page that
/// it may only read, by everything that the system offers for memory it was handed, and writes what came of each attempt to
/// a report. Then it puts a page of its own making, which permits for ever, where the cycle looks for its permission, and
/// hears and says nothing any more. Linked beside its main() for tests only.
namespace {

constexpr int channel_number = 3, permit_number = 5;  // as the supervisor's launcher hands them over
constexpr std::size_t page_octets = 4096;

struct Region {
  void* at;
  std::size_t octets;
  std::string name;
};

/// Memory that several processes share and this one may only read.
std::vector<Region> read_only_regions() {
  std::vector<Region> found;
  std::FILE* const maps = std::fopen("/proc/self/maps", "re");
  std::array<char, 512> line;
  while (maps != nullptr && std::fgets(line.data(), static_cast<int>(line.size()), maps) != nullptr) {
    std::uintptr_t begin = 0, end = 0;
    std::array<char, 5> access{};
    std::array<char, 256> name{};
    if (std::sscanf(line.data(), "%" SCNxPTR "-%" SCNxPTR " %4s %*s %*s %*s /memfd:%255s", &begin, &end, access.data(),
                    name.data()) == 4 &&
        std::strcmp(access.data(), "r--s") == 0)
      found.push_back({reinterpret_cast<void*>(begin), end - begin, name.data()});
  }
  if (maps != nullptr) std::fclose(maps);
  return found;
}

/// In memory of its own, where the test looks for it: its sandbox lets it write no file.
class Report {
 public:
  explicit Report(const char* name) : file_{::fdopen(::memfd_create(name, MFD_CLOEXEC), "w")} {}
  ~Report() {
    if (file_ != nullptr) std::fflush(file_);  // stays open: whoever reads it does so by way of the descriptor
  }
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;
  void tried(const std::string& what, int done) const {
    if (file_ != nullptr) std::fprintf(file_, "%s: %s\n", what.c_str(), done != 0 ? "DONE" : "refused");
  }

 private:
  std::FILE* file_;
};

bool maps_writable(int descriptor) {
  void* const at = ::mmap(nullptr, page_octets, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (at == MAP_FAILED) return false;
  ::munmap(at, page_octets);
  return true;
}

bool becomes_writable(int descriptor) {
  void* const at = ::mmap(nullptr, page_octets, PROT_READ, MAP_SHARED, descriptor, 0);
  return at != MAP_FAILED && ::mprotect(at, page_octets, PROT_READ | PROT_WRITE) == 0;
}

void attack_descriptor(const Report& report, const std::string& name, int descriptor) {
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  report.tried(name + " write", ::pwrite(descriptor, &ones, sizeof ones, 0) == sizeof ones);
  report.tried(name + " map writable", maps_writable(descriptor));
  report.tried(name + " map, then mprotect", becomes_writable(descriptor));
  const int again = ::open(("/proc/self/fd/" + std::to_string(descriptor)).c_str(), O_RDWR | O_CLOEXEC);
  if (again >= 0) {
    report.tried(name + " write when opened again", ::pwrite(again, &ones, sizeof ones, 0) == sizeof ones);
    report.tried(name + " map writable when opened again", maps_writable(again));
    ::close(again);
  }
  report.tried(name + " shrink", ::ftruncate(descriptor, 0) == 0);
  report.tried(name + " grow", ::ftruncate(descriptor, 2 * page_octets) == 0);
  report.tried(name + " punch",
               ::fallocate(descriptor, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, page_octets) == 0);
  report.tried(name + " seal", ::fcntl(descriptor, F_ADD_SEALS, F_SEAL_WRITE) == 0);
}

void attack_mapping(const Report& report, const Region& region) {
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  const int memory = ::open("/proc/self/mem", O_RDWR | O_CLOEXEC);
  report.tried(
      region.name + " write by way of /proc/self/mem",
      ::pwrite(memory, &ones, sizeof ones, static_cast<off_t>(reinterpret_cast<std::uintptr_t>(region.at))) > 0);
  ::close(memory);
  report.tried(region.name + " madvise remove", ::madvise(region.at, region.octets, MADV_REMOVE) == 0);
  const bool writable = ::mprotect(region.at, region.octets, PROT_READ | PROT_WRITE) == 0;
  report.tried(region.name + " mprotect", writable);
  if (writable) static_cast<void>(::mprotect(region.at, region.octets, PROT_READ));
}

/// Who guards it is scheduled as it was, and runs before it (docs/adr/0146).
void attack_scheduling(const Report& report) {
  constexpr int keepers_priority = 91;
  const pid_t supervisor = ::getppid();
  sched_param as{};
  static_cast<void>(::sched_getparam(supervisor, &as));
  cpu_set_t anywhere;
  static_cast<void>(::sched_getaffinity(supervisor, sizeof anywhere, &anywhere));
  rlimit limit{};
  ::getrlimit(RLIMIT_CORE, &limit);
  rlimit priority{};
  ::getrlimit(RLIMIT_RTPRIO, &priority);
  report.tried("others: scheduling", ::sched_setscheduler(supervisor, SCHED_OTHER, &as) == 0);
  report.tried("others: affinity", ::sched_setaffinity(supervisor, sizeof anywhere, &anywhere) == 0);
  report.tried("others: nice", ::setpriority(PRIO_PROCESS, static_cast<id_t>(supervisor), 19) == 0);
  report.tried("others: limits", ::prlimit(supervisor, RLIMIT_CORE, &limit, nullptr) == 0);
  report.tried("others: a limit of priority", ::setrlimit(RLIMIT_RTPRIO, &priority) == 0);
  as.sched_priority = keepers_priority;
  report.tried("others: before the keeper", ::sched_setscheduler(0, SCHED_FIFO, &as) == 0);
}

/// A stop that nobody carries out: signals to who guards it, by each way that there is, also by a file or a terminal that is given to it.
void attack_by_signals(const Report& report) {
  const pid_t supervisor = ::getppid();
  siginfo_t queued{};
  queued.si_code = SI_QUEUE;
  report.tried("others: signal", ::kill(supervisor, 0) == 0);
  report.tried("others: signal to all", ::kill(-1, 0) == 0);
  report.tried("others: signal to a thread", ::syscall(SYS_tgkill, supervisor, supervisor, 0) == 0);
  report.tried("others: signal to a thread by its number", ::syscall(SYS_tkill, supervisor, 0) == 0);
  report.tried("others: queued signal", ::syscall(SYS_rt_sigqueueinfo, supervisor, 0, &queued) == 0);
  const int handle = static_cast<int>(::syscall(SYS_pidfd_open, supervisor, 0));
  report.tried("others: signal by a handle", ::syscall(SYS_pidfd_send_signal, handle, 0, nullptr, 0) == 0);
  if (handle >= 0) ::close(handle);
  report.tried("others: signal by a file's owner", ::fcntl(STDIN_FILENO, F_SETOWN, supervisor) == 0);
  report.tried("others: its group", ::setpgid(0, ::getpgid(supervisor)) == 0);
  char typed = 3;  // Ctrl-C
  pid_t front = ::getpgrp();
  report.tried("others: typed at its terminal", ::ioctl(STDIN_FILENO, TIOCSTI, &typed) == 0);
  report.tried("others: its terminal's turn", ::ioctl(STDIN_FILENO, TIOCSPGRP, &front) == 0);
}

sockaddr_in in_this_computer(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

/// Behind each name of a device.
std::string suffix_of_flight() {
  const char* const instance = std::getenv("HIROSCO_INSTANCE");
  return instance == nullptr || *instance == '\0' ? "" : std::string{"."} + instance;
}

/// Where it may make files.
std::string own_folder() { return "/dev/shm/hirosco/manipulator-robot" + suffix_of_flight(); }

void attack_segment(const Report& report, const std::string& what, const std::string& segment) {
  const std::string here = own_folder() + "/mine";
  const int file = ::open(segment.c_str(), O_RDWR | O_CLOEXEC);
  report.tried(what + ": open " + segment, file >= 0);
  report.tried(what + ": cut short when opened " + segment, file >= 0 && ::ftruncate(file, 0) == 0);
  if (file >= 0) ::close(file);
  report.tried(what + ": link " + segment, ::link(segment.c_str(), here.c_str()) == 0);
  report.tried(what + ": cut short " + segment, ::truncate(segment.c_str(), 0) == 0);
  report.tried(what + ": shut " + segment, ::chmod(segment.c_str(), 0) == 0);
  report.tried(what + ": move " + segment, ::rename(segment.c_str(), here.c_str()) == 0);
  report.tried(what + ": remove " + segment, ::unlink(segment.c_str()) == 0);
}

/// The frames of another's device: who cuts them short ends everybody who maps them, that member and its device (docs/adr/0169).
void attack_frames(const Report& report) {
  attack_segment(report, "frames", "/dev/shm/hirosco/joystick-handle" + suffix_of_flight() + "/frames");
  report.tried("frames: a folder beside its own", ::mkdir("/dev/shm/hirosco/mine", 0700) == 0);
  // What is its own it reaches.
  const int own = ::open((own_folder() + "/frames").c_str(), O_RDWR | O_CLOEXEC);
  report.tried("own frames", own >= 0);
  if (own >= 0) ::close(own);
}

/// The second inhibits, which would let its robot go on, and the ground's port, by which it would let itself go (docs/adr/0150).
void attack_inhibits(const Report& report) {
  for (const char* const device : {"manipulator-robot", "joystick-handle"})
    attack_segment(report, "inhibits", std::string{"/dev/shm/hirosco."} + device + "-enable" + suffix_of_flight());
  constexpr std::uint16_t telecommands = 10025;
  const sockaddr_in there = in_this_computer(telecommands);
  const auto* const to = reinterpret_cast<const sockaddr*>(&there);
  const int stream = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  report.tried("inhibits: connect to the ground's telecommand port", ::connect(stream, to, sizeof there) == 0);
  const int datagrams = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  report.tried("inhibits: send a datagram", ::sendto(datagrams, "x", 1, 0, to, sizeof there) == 1);
  report.tried("inhibits: a UNIX socket", ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0) >= 0);
}

/// What its sandbox is to refuse (docs/adr/0081).
void attack_others(const Report& report) {
  const std::string supervisor = "/proc/" + std::to_string(::getppid());
  const auto opens = [&](const std::string& path, int how) {
    const int file = ::open(path.c_str(), how | O_CLOEXEC, 0600);
    if (file >= 0) ::close(file);
    report.tried("others: open " + path, file >= 0);
  };
  opens(supervisor + "/mem", O_RDWR);
  opens(supervisor + "/maps", O_RDONLY);
  opens("/dev/kmsg", O_RDONLY);
  opens("/dev/mem", O_RDWR);
  opens("/etc/passwd", O_RDONLY);
  opens("hostile.made", O_RDWR | O_CREAT);
  std::uint64_t octets = 0;
  iovec here{&octets, sizeof octets};
  report.tried("others: ptrace", ::ptrace(PTRACE_SEIZE, ::getppid(), nullptr, nullptr) == 0);
  report.tried("others: process_vm_readv", ::process_vm_readv(::getppid(), &here, 1, &here, 1, 0) > 0);
  attack_by_signals(report);
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  report.tried("others: fork", child > 0);
  report.tried("others: raw socket", ::socket(AF_PACKET, SOCK_RAW, 0) >= 0);
  rlimit more{};
  ::getrlimit(RLIMIT_NOFILE, &more);
  more.rlim_cur = ++more.rlim_max;
  report.tried("others: more descriptors", ::setrlimit(RLIMIT_NOFILE, &more) == 0);
  attack_scheduling(report);
}

/// A page that permits under its present epoch for ever, in place of the true one from one access to the next.
hirosco::PermitPage* put_look_alike(const Region& permit) {
  const int own = ::memfd_create("look-alike", MFD_CLOEXEC);
  if (own < 0 || ::ftruncate(own, static_cast<off_t>(permit.octets)) != 0) return nullptr;
  void* const copy = ::mmap(nullptr, permit.octets, PROT_READ | PROT_WRITE, MAP_SHARED, own, 0);
  if (copy == MAP_FAILED) return nullptr;
  std::memcpy(copy, permit.at, permit.octets);
  if (::mmap(permit.at, permit.octets, PROT_READ, MAP_SHARED | MAP_FIXED, own, 0) == MAP_FAILED) return nullptr;
  return std::launder(static_cast<hirosco::PermitPage*>(copy));
}

std::atomic<bool>& is_deaf() {
  static std::atomic<bool> deaf{false};
  return deaf;
}

/// The channel stays open, and nobody reads it or answers: what stands in its place never has anything to read.
void turn_deaf() {
  const int silence = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (silence < 0) return;
  static_cast<void>(::dup(channel_number));
  is_deaf() = true;
  static_cast<void>(::dup2(silence, channel_number));
}

void* turn(void* argument) {
  const int permit = *static_cast<int*>(argument);
  sigset_t wanted;
  sigemptyset(&wanted);
  sigaddset(&wanted, SIGUSR2);
  int number = 0;
  ::sigwait(&wanted, &number);
  hirosco::PermitPage* look_alike = nullptr;
  {
    const Report report{"hostile-report"};
    attack_others(report);
    attack_inhibits(report);
    attack_frames(report);
    attack_descriptor(report, "hirosco-permit", permit);
    const auto regions = read_only_regions();
    for (const Region& region : regions) attack_mapping(report, region);
    for (const Region& region : regions)
      if (region.name == "hirosco-permit") look_alike = put_look_alike(region);
    report.tried("look-alike", look_alike != nullptr);
    ::close(permit);
    turn_deaf();
  }
  static_cast<void>(::memfd_create("hostile-done", MFD_CLOEXEC));
  while (look_alike != nullptr) {
    look_alike->heartbeat.fetch_add(1, std::memory_order_release);
    const timespec pause{0, 1'000'000};
    ::nanosleep(&pause, nullptr);
  }
  return nullptr;
}

struct Hostile {
  Hostile() : permit{::fcntl(permit_number, F_DUPFD_CLOEXEC, 16)} {
    // Blocked before there is another thread: the one that waits for it gets it.
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGUSR2);
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
    pthread_t thread;
    ::pthread_create(&thread, nullptr, turn, &permit);
  }
  int permit;
} hostile;

}  // namespace

// In place of the C library's, for all that is linked here: whoever is deaf hears nothing and believes that it was heard.
extern "C" ssize_t recvmsg(int socket, msghdr* message, int flags) {
  if (!is_deaf() || socket != channel_number) return ::syscall(SYS_recvmsg, socket, message, flags);
  errno = EAGAIN;
  return -1;
}
extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  if (!is_deaf() || socket != channel_number) return ::syscall(SYS_sendmsg, socket, message, flags);
  return 1;
}
extern "C" int sendmmsg(int socket, mmsghdr* messages, unsigned int count, int flags) {
  if (!is_deaf() || socket != channel_number)
    return static_cast<int>(::syscall(SYS_sendmmsg, socket, messages, count, flags));
  return static_cast<int>(count);
}
