// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/sandbox.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/capability.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace hirosco {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr const char* built_without = "it is built with a sanitizer, which needs what a sandbox refuses";
#elif !defined(__x86_64__)
constexpr const char* built_without = "its calls are known for x86-64 only";
#else
constexpr const char* built_without = nullptr;
#endif

// --- files ---------------------------------------------------------------------------------------------------------------

/// Rights on files that newer headers name; struct and numbers are the kernel's.
constexpr std::uint64_t right_truncate = 1ULL << 14;
constexpr std::uint64_t right_device_control = 1ULL << 15;
constexpr std::uint64_t scope_local_socket = 1ULL << 0, scope_signal = 1ULL << 1;
constexpr std::uint64_t right_bind = 1ULL << 0, right_connect = 1ULL << 1;
constexpr int rule_of_port = 2;
struct PortRule {
  std::uint64_t rights{0};
  std::uint64_t port{0};
};
struct Rules {
  std::uint64_t files{0};
  std::uint64_t network{0};
  std::uint64_t scoped{0};
};

constexpr std::uint64_t to_read = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t all_of_first_version = (1ULL << 13) - 1;
constexpr std::uint64_t of_plain_files = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                         LANDLOCK_ACCESS_FS_READ_FILE | right_truncate | right_device_control;

[[nodiscard]] long rules_version() noexcept {
  return ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
}

[[nodiscard]] Rules rules_of(long version, const SandboxSockets& sockets) noexcept {
  Rules rules;
  rules.files = all_of_first_version;
  if (version >= 2) rules.files |= LANDLOCK_ACCESS_FS_REFER;
  if (version >= 3) rules.files |= right_truncate;
  if (version >= 4 && !sockets.streams) rules.network = right_bind | right_connect;
  if (version >= 5) rules.files |= right_device_control;
  if (version >= 6) rules.scoped = scope_local_socket | scope_signal;
  return rules;
}

/// The length of the structure as that version knows it.
[[nodiscard]] std::size_t octets_of(long version) noexcept {
  return version >= 6 ? sizeof(Rules) : version >= 4 ? offsetof(Rules, scoped) : offsetof(Rules, network);
}

/// Async-signal-safe.
[[nodiscard]] bool permit_path(int rules, const char* path, std::uint64_t rights) noexcept {
  const int place = ::open(path, O_PATH | O_CLOEXEC);
  if (place < 0) return errno == ENOENT || errno == EACCES || errno == ENOTDIR;
  struct stat status{};
  landlock_path_beneath_attr rule{};
  rule.allowed_access = ::fstat(place, &status) == 0 && S_ISDIR(status.st_mode) ? rights : rights & of_plain_files;
  rule.parent_fd = place;
  const bool added = ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
  ::close(place);
  return added;
}

/// Async-signal-safe.
[[nodiscard]] bool permit_paths(int rules, const std::vector<std::string>& paths, std::uint64_t rights) noexcept {
  for (const std::string& path : paths)
    if (!permit_path(rules, path.c_str(), rights)) return false;
  return true;
}

/// Async-signal-safe.
[[nodiscard]] bool permit_ports(int rules, const Rules& known, const SandboxSockets& sockets) noexcept {
  if (known.network == 0) return true;
  const auto permit = [&](std::uint64_t rights, std::uint16_t port) {
    const PortRule rule{.rights = rights, .port = port};
    return ::syscall(SYS_landlock_add_rule, rules, rule_of_port, &rule, 0) == 0;
  };
  for (const std::uint16_t port : sockets.ports)
    if (!permit(right_connect, port)) return false;
  return !sockets.own_port || permit(right_bind, 0);
}

/// 0, or the system's error number; also where the system knows no rules of files.  Async-signal-safe.
[[nodiscard]] int restrict_files(const Sandbox& sandbox) noexcept {
  const long version = rules_version();
  if (version < 1) return 0;
  const Rules known = rules_of(version, sandbox.sockets);
  const int rules = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &known, octets_of(version), 0));
  if (rules < 0) return errno;
  constexpr std::uint64_t to_execute = LANDLOCK_ACCESS_FS_EXECUTE | to_read;
  // Devices are controlled by nobody but who may write them.
  const std::uint64_t to_write = known.files & ~std::uint64_t{LANDLOCK_ACCESS_FS_EXECUTE};
  // /proc/self is of this process: another one that has the same number later is outside.
  const bool done = permit_paths(rules, sandbox.readable, to_read) &&
                    permit_paths(rules, sandbox.executable, to_execute) &&
                    permit_paths(rules, sandbox.writable, to_write) && permit_path(rules, "/proc/self", to_read) &&
                    permit_ports(rules, known, sandbox.sockets) && ::syscall(SYS_landlock_restrict_self, rules, 0) == 0;
  const int error = done ? 0 : errno;
  ::close(rules);
  return error;
}

// --- system calls ----------------------------------------------------------------------------------------------------------

struct Call {
  std::uint32_t number;
  const char* name;
};
/// Other processes, the kernel, its clock, its tables of files: nothing of it is a subsystem's matter.
constexpr std::array refused_calls{
    Call{SYS_ptrace, "ptrace"},
    Call{SYS_process_vm_readv, "process_vm_readv"},
    Call{SYS_process_vm_writev, "process_vm_writev"},
    Call{SYS_pidfd_getfd, "pidfd_getfd"},
    Call{SYS_process_madvise, "process_madvise"},
    Call{SYS_kcmp, "kcmp"},
    Call{SYS_bpf, "bpf"},
    Call{SYS_perf_event_open, "perf_event_open"},
    Call{SYS_userfaultfd, "userfaultfd"},
    Call{SYS_io_uring_setup, "io_uring_setup"},
    Call{SYS_mount, "mount"},
    Call{SYS_umount2, "umount2"},
    Call{SYS_pivot_root, "pivot_root"},
    Call{SYS_chroot, "chroot"},
    Call{SYS_setns, "setns"},
    Call{SYS_unshare, "unshare"},
    Call{SYS_open_by_handle_at, "open_by_handle_at"},
    Call{SYS_kexec_load, "kexec_load"},
    Call{SYS_init_module, "init_module"},
    Call{SYS_finit_module, "finit_module"},
    Call{SYS_delete_module, "delete_module"},
    Call{SYS_reboot, "reboot"},
    Call{SYS_swapon, "swapon"},
    Call{SYS_swapoff, "swapoff"},
    Call{SYS_settimeofday, "settimeofday"},
    Call{SYS_clock_settime, "clock_settime"},
    Call{SYS_clock_adjtime, "clock_adjtime"},
    Call{SYS_adjtimex, "adjtimex"},
    Call{SYS_sethostname, "sethostname"},
    Call{SYS_add_key, "add_key"},
    Call{SYS_keyctl, "keyctl"},
    Call{SYS_request_key, "request_key"},
    Call{SYS_syslog, "syslog"},
    Call{SYS_acct, "acct"},
    Call{SYS_quotactl, "quotactl"},
    Call{SYS_ioprio_set, "ioprio_set"},
    Call{SYS_migrate_pages, "migrate_pages"},
    Call{SYS_move_pages, "move_pages"},
#if defined(__x86_64__)
    Call{SYS_fork, "fork"},
    Call{SYS_vfork, "vfork"},
    Call{SYS_iopl, "iopl"},
    Call{SYS_ioperm, "ioperm"},
    Call{SYS_setrlimit, "setrlimit"},
#endif
};
/// How a thread is scheduled is its own matter, and asked for with 0 in place of its number. With one user's rights, or root's, another's
/// priority could be taken, the supervisor's among them (docs/adr/0146).
constexpr std::array own_calls{
    Call{SYS_sched_setscheduler, "sched_setscheduler of another thread"},
    Call{SYS_sched_setparam, "sched_setparam of another thread"},
    Call{SYS_sched_setattr, "sched_setattr of another thread"},
    Call{SYS_sched_setaffinity, "sched_setaffinity of another thread"},
};

[[nodiscard]] const char* name_of_call(std::uint32_t number) noexcept {
  for (const Call& call : refused_calls)
    if (call.number == number) return call.name;
  for (const Call& call : own_calls)
    if (call.number == number) return call.name;
  switch (number) {
    case SYS_clone: return "clone of a process";
    case SYS_socket: return "socket of this kind";
    case SYS_socketpair: return "socketpair";
    case SYS_listen: return "listen";
    case SYS_sendto:
    case SYS_sendmsg:
    case SYS_sendmmsg: return "a send that connects";
    case SYS_prlimit64: return "prlimit64 of another process, or of its priority";
    case SYS_setpriority: return "setpriority of others";
    default: return "";
  }
}

constexpr std::uint16_t bpf_load = BPF_LD | BPF_W | BPF_ABS, bpf_equal = BPF_JMP | BPF_JEQ | BPF_K,
                        bpf_any_of = BPF_JMP | BPF_JSET | BPF_K, bpf_and = BPF_ALU | BPF_AND | BPF_K,
                        bpf_at_least = BPF_JMP | BPF_JGE | BPF_K, bpf_answer = BPF_RET | BPF_K;
constexpr std::uint32_t number_at = offsetof(seccomp_data, nr), machine_at = offsetof(seccomp_data, arch);
/// The lower half of an argument, which is all of a number of 32 bits; the upper one stands behind it.
constexpr std::uint32_t argument_at(std::size_t which) noexcept {
  return static_cast<std::uint32_t>(offsetof(seccomp_data, args) + which * sizeof(std::uint64_t));
}
constexpr std::uint32_t half_octets = sizeof(std::uint32_t);
constexpr std::size_t fixed_instructions = 128;

struct Filter {
  std::array<sock_filter, 2 * refused_calls.size() + 5 * own_calls.size() + fixed_instructions> code{};
  std::uint16_t length{0};
  constexpr void add(std::uint16_t what, std::uint32_t value, std::uint8_t yes = 0, std::uint8_t no = 0) noexcept {
    code[length++] = sock_filter{what, yes, no, value};
  }
  /// What follows is of this call alone, and answers in each case; until end_of_call().
  constexpr void begin_call(std::uint32_t number) noexcept {
    add(bpf_equal, number);
    begun = length;
  }
  constexpr void end_of_call() noexcept { code[begun - 1U].jf = static_cast<std::uint8_t>(length - begun); }
  std::uint16_t begun{0};
};

/// Of this protocol, or of that which its type means by itself: others are no UDP and no TCP, and under no rules of Landlock.
constexpr void permit_socket(Filter& made, std::uint32_t domain, std::uint32_t type, std::uint32_t protocol) noexcept {
  constexpr std::uint32_t without_flags = 0xF;
  made.add(bpf_load, argument_at(0));
  made.add(bpf_equal, domain, 0, 7);
  made.add(bpf_load, argument_at(1));
  made.add(bpf_and, without_flags);
  made.add(bpf_equal, type, 0, 4);
  made.add(bpf_load, argument_at(2));
  made.add(bpf_equal, 0, 1, 0);
  made.add(bpf_equal, protocol, 0, 1);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
}

/// The number of the call is loaded, before and after.
constexpr void filter_sockets(Filter& made, const SandboxSockets& sockets) noexcept {
  constexpr std::uint32_t refused = SECCOMP_RET_TRAP;
  const bool connects = sockets.streams || !sockets.ports.empty();
  made.begin_call(SYS_socket);
  for (const std::uint32_t domain : {std::uint32_t{AF_INET}, std::uint32_t{AF_INET6}}) {
    if (sockets.datagrams) permit_socket(made, domain, SOCK_DGRAM, IPPROTO_UDP);
    if (connects) permit_socket(made, domain, SOCK_STREAM, IPPROTO_TCP);
  }
  made.add(bpf_load, argument_at(0));
  if (sockets.local) made.add(bpf_equal, AF_UNIX, 1, 0);
  made.add(bpf_answer, refused);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  made.end_of_call();
  // One that is connected sends elsewhere all the same where it is told an address.
  if (!sockets.local) {
    made.begin_call(SYS_socketpair);
    made.add(bpf_answer, refused);
    made.end_of_call();
  }
  if (sockets.streams) return;
  made.begin_call(SYS_listen);
  made.add(bpf_answer, refused);
  made.end_of_call();
  if (!connects) return;
  // Opens a connection past Landlock.
  struct Sending {
    std::uint32_t number, flags_at;
  };
  for (const auto& [number, flags_at] : {Sending{SYS_sendto, argument_at(3)}, Sending{SYS_sendmsg, argument_at(2)},
                                         Sending{SYS_sendmmsg, argument_at(3)}}) {
    made.begin_call(number);
    made.add(bpf_load, flags_at);
    made.add(bpf_any_of, MSG_FASTOPEN, 0, 1);
    made.add(bpf_answer, refused);
    made.add(bpf_answer, SECCOMP_RET_ALLOW);
    made.end_of_call();
  }
}

/// Refused calls raise SIGSYS, which names them (name_refused_calls()).
[[nodiscard]] Filter call_filter(const SandboxSockets& sockets) noexcept {
  constexpr std::uint32_t refused = SECCOMP_RET_TRAP;
  constexpr std::uint32_t foreign_numbers = 0x40000000;  // of another way to call the same kernel
  Filter made;
  made.add(bpf_load, machine_at);
  made.add(bpf_equal, AUDIT_ARCH_X86_64, 1, 0);
  made.add(bpf_answer, SECCOMP_RET_KILL_PROCESS);
  made.add(bpf_load, number_at);
  made.add(bpf_at_least, foreign_numbers, 0, 1);
  made.add(bpf_answer, SECCOMP_RET_KILL_PROCESS);
  for (const Call& call : refused_calls) {
    made.add(bpf_equal, call.number, 0, 1);
    made.add(bpf_answer, refused);
  }
  for (const Call& call : own_calls) {
    made.add(bpf_equal, call.number, 0, 4);
    made.add(bpf_load, argument_at(0));
    made.add(bpf_equal, 0, 1, 0);
    made.add(bpf_answer, refused);
    made.add(bpf_answer, SECCOMP_RET_ALLOW);
  }
  // Limits of its own, but for the priority that it may take: the guard takes that away.
  made.add(bpf_equal, SYS_prlimit64, 0, 10);
  made.add(bpf_load, argument_at(0));
  made.add(bpf_equal, 0, 0, 6);
  made.add(bpf_load, argument_at(1));
  made.add(bpf_equal, RLIMIT_RTPRIO, 0, 5);
  made.add(bpf_load, argument_at(2));  // whether it changes anything
  made.add(bpf_equal, 0, 0, 2);
  made.add(bpf_load, argument_at(2) + half_octets);
  made.add(bpf_equal, 0, 1, 0);
  made.add(bpf_answer, refused);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  made.add(bpf_equal, SYS_setpriority, 0, 6);
  made.add(bpf_load, argument_at(0));
  made.add(bpf_equal, PRIO_PROCESS, 0, 2);
  made.add(bpf_load, argument_at(1));
  made.add(bpf_equal, 0, 1, 0);
  made.add(bpf_answer, refused);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  filter_sockets(made, sockets);
  // Its flags lie in memory, where no filter looks: the C library takes clone() instead.
  made.add(bpf_equal, SYS_clone3, 0, 1);
  made.add(bpf_answer, SECCOMP_RET_ERRNO | ENOSYS);
  made.add(bpf_equal, SYS_clone, 0, 3);
  made.add(bpf_load, argument_at(0));
  made.add(bpf_any_of, CLONE_THREAD, 1, 0);
  made.add(bpf_answer, refused);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  return made;
}

/// Whether a limit says which priorities of real time there are for it: then root's right to all of them is given up.
[[nodiscard]] bool priority_is_limited() noexcept {
  rlimit limit{};
  return ::getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur > 0;
}

/// Root's right that stays: memory that is never taken to disk.
void give_up_rights() noexcept {
  constexpr int highest = 63;
  const bool limited = priority_is_limited();
  for (int right = 0; right <= highest; ++right)
    if (right != CAP_IPC_LOCK && (limited || right != CAP_SYS_NICE))
      static_cast<void>(::prctl(PR_CAPBSET_DROP, right, 0, 0, 0));
}

/// Root without this right cannot give who it starts a limit that it has not itself.
[[nodiscard]] bool may_raise_limits() noexcept {
  __user_cap_header_struct about{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> has{};
  return ::syscall(SYS_capget, &about, has.data()) == 0 && (has[0].effective & (1U << CAP_SYS_RESOURCE)) != 0;
}

// --- naming ------------------------------------------------------------------------------------------------------------

std::atomic<const char*>& named_program() noexcept {
  static std::atomic<const char*> name{"hirosco"};
  return name;
}

void write_refusal(std::string_view text) noexcept {
  static_cast<void>(!::write(STDERR_FILENO, text.data(), text.size()));
}

void tell_refused(int, siginfo_t* info, void* context) {
  static std::atomic<int> said{0};
  constexpr int most = 10;
  const int before = errno;
  if (said.fetch_add(1, std::memory_order_relaxed) < most) {
    std::array<char, 128> line{};
    std::size_t length = 0;
    const auto put = [&](std::string_view text) {
      for (const char c : text)
        if (length < line.size() - 1) line[length++] = c;
    };
    std::array<char, 12> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), info->si_syscall).ptr;
    put(named_program().load(std::memory_order_relaxed));
    put(": the sandbox refuses system call ");
    put({digits.data(), static_cast<std::size_t>(end - digits.data())});
    put(" ");
    put(name_of_call(static_cast<std::uint32_t>(info->si_syscall)));
    line[length++] = '\n';
    write_refusal({line.data(), length});
  }
#if defined(__x86_64__)
  static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RAX] = -EPERM;
#else
  static_cast<void>(context);
#endif
  errno = before;
}

}  // namespace

bool sandbox_is_off() noexcept {
  const char* const wish = std::getenv("HIROSCO_SANDBOX");
  return built_without != nullptr || (wish != nullptr && std::string_view{wish} == "off");
}

std::vector<std::string> isolation_lacks() {
  if (sandbox_is_off())
    return {std::string{"everything is open: "} +
            (built_without != nullptr ? built_without : "HIROSCO_SANDBOX is off")};
  std::vector<std::string> lacks;
  const long rules_known = rules_version();
  if (rules_known < 1) lacks.emplace_back("files are open to all (no Landlock)");
  else if (rules_known < 4)
    lacks.emplace_back("whoever has a device by TCP reaches every port (Landlock before version 4)");
  if (rules_known >= 1 && rules_known < 6) lacks.emplace_back("signals reach others (Landlock before version 6)");
  const std::uint32_t trap = SECCOMP_RET_TRAP;
  if (::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &trap) != 0)
    lacks.emplace_back("every system call is open (no seccomp filters)");
  if (::geteuid() == 0 && !priority_is_limited() && !may_raise_limits())
    lacks.emplace_back("every real-time priority is open (root without CAP_SYS_RESOURCE)");
  return lacks;
}

int PreparedSandbox::enter() const noexcept {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return errno;
  give_up_rights();
  if (const int error = restrict_files(sandbox_); error != 0) return error;
  const Filter calls = call_filter(sandbox_.sockets);
  sock_fprog program{};
  program.len = calls.length;
  program.filter = const_cast<sock_filter*>(calls.code.data());  // the kernel reads it
  return ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0 || errno == EINVAL ? 0 : errno;
}

void name_refused_calls(const char* program) noexcept {
  named_program().store(program, std::memory_order_relaxed);
  struct sigaction action{};
  action.sa_sigaction = tell_refused;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  static_cast<void>(::sigaction(SIGSYS, &action, nullptr));
}

}  // namespace hirosco
