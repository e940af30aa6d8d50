// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/linux/sandbox_calls.hpp"

#include <asm/sockios.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace hirosco {
namespace {

struct Call {
  std::uint32_t number;
  const char* name;
};
/// fchmodat2, setxattrat, removexattrat, file_setattr: newer than the headers of Debian 12, and refused by whichever kernel knows them.
constexpr std::array<std::uint32_t, 4> calls_of_later_kernels{452, 463, 466, 469};
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
    Call{SYS_pidfd_send_signal, "pidfd_send_signal"},
    // A process that sits in the group of another is stopped with it by their terminal, and stops it.
    Call{SYS_setpgid, "setpgid"},
    Call{SYS_setsid, "setsid"},
    // Whoever maps a file that somebody cuts short dies; rules of files know nothing of it before their version 3.
    Call{SYS_truncate, "truncate of a file by its path"},
    // What the rules of files are not about: who may open what, when it was written, what else stands with it.
    Call{SYS_fchmod, "fchmod"},
    Call{SYS_fchmodat, "fchmodat"},
    Call{calls_of_later_kernels[0], "fchmodat2"},
    Call{SYS_fchown, "fchown"},
    Call{SYS_fchownat, "fchownat"},
    Call{SYS_utimensat, "utimensat"},
    Call{SYS_setxattr, "setxattr"},
    Call{SYS_lsetxattr, "lsetxattr"},
    Call{SYS_fsetxattr, "fsetxattr"},
    Call{SYS_removexattr, "removexattr"},
    Call{SYS_lremovexattr, "lremovexattr"},
    Call{SYS_fremovexattr, "fremovexattr"},
    Call{calls_of_later_kernels[1], "setxattrat"},
    Call{calls_of_later_kernels[2], "removexattrat"},
    Call{calls_of_later_kernels[3], "file_setattr"},
    // Memory, queues and locks under a number: of every process of the user.
    Call{SYS_shmget, "shmget"},
    Call{SYS_shmat, "shmat"},
    Call{SYS_shmctl, "shmctl"},
    Call{SYS_semget, "semget"},
    Call{SYS_semctl, "semctl"},
    Call{SYS_msgget, "msgget"},
    Call{SYS_msgctl, "msgctl"},
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
    Call{SYS_chmod, "chmod"},
    Call{SYS_chown, "chown"},
    Call{SYS_lchown, "lchown"},
    Call{SYS_utime, "utime"},
    Call{SYS_utimes, "utimes"},
    Call{SYS_futimesat, "futimesat"},
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

/// Whom a signal goes to is their first argument: a process, or by the third the thread of that number, which of one's own is the first alone.
constexpr std::array signal_calls{
    Call{SYS_kill, "kill of another process"},
    Call{SYS_tgkill, "tgkill of another process"},
    Call{SYS_tkill, "tkill of another than the first thread"},
    Call{SYS_rt_sigqueueinfo, "rt_sigqueueinfo to another process"},
    Call{SYS_rt_tgsigqueueinfo, "rt_tgsigqueueinfo to another process"},
};
/// Who gets the signal that a file is set to, and who waits until this process lets a file be opened.
constexpr std::array<std::uint32_t, 3> of_others_by_fcntl{F_SETOWN_EX, F_SETLEASE, F_NOTIFY};
constexpr std::array<std::uint32_t, 2> owners_by_ioctl{FIOSETOWN, SIOCSPGRP};
/// Of a terminal: to type for whoever sits there, his Ctrl-C among it, and to take the turn to read, or the terminal.
constexpr std::array<std::uint32_t, 5> terminals_by_ioctl{TIOCSTI, TIOCSPGRP, TIOCSCTTY, TIOCSIG, TIOCLINUX};

[[nodiscard]] const char* name_of_call(std::uint32_t number) noexcept {
  for (const Call& call : refused_calls)
    if (call.number == number) return call.name;
  for (const Call& call : own_calls)
    if (call.number == number) return call.name;
  for (const Call& call : signal_calls)
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
    case SYS_fcntl: return "fcntl of who gets signals, or a lease";
    case SYS_ioctl: return "ioctl of who gets signals, or of a terminal";
    case SYS_open:
    case SYS_openat: return "open that cuts a file short unwritten, or is neither to read nor to write";
    case SYS_mq_open:
    case SYS_mq_unlink: return "message queues";
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
constexpr std::size_t fixed_instructions = 256;

struct Filter {
  std::array<sock_filter,
             2 * refused_calls.size() + 5 * own_calls.size() + 5 * signal_calls.size() + fixed_instructions>
      code{};
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
  constexpr void refuse_without_signal() noexcept {
    for (sock_filter& instruction : code)
      if (instruction.code == bpf_answer && instruction.k == SECCOMP_RET_TRAP)
        instruction.k = SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(EPERM);
  }
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

/// The number of the call is loaded, before and after. By its numbers alone the kernel cannot tell whose a process is where all are of one
/// user: a member that stops guard and supervisor by a signal would keep every stop from being carried out.
void filter_signals(Filter& made) noexcept {
  constexpr std::uint32_t refused = SECCOMP_RET_TRAP;
  const auto self = static_cast<std::uint32_t>(::getpid());
  for (const Call& call : signal_calls) {
    made.begin_call(call.number);
    made.add(bpf_load, argument_at(0));
    made.add(bpf_equal, self, 1, 0);
    made.add(bpf_answer, refused);
    made.add(bpf_answer, SECCOMP_RET_ALLOW);
    made.end_of_call();
  }
  const auto refuse = [&](std::span<const std::uint32_t> requests) {
    for (const std::uint32_t request : requests) {
      made.add(bpf_equal, request, 0, 1);
      made.add(bpf_answer, refused);
    }
  };
  made.begin_call(SYS_fcntl);
  made.add(bpf_load, argument_at(1));
  refuse(of_others_by_fcntl);
  made.add(bpf_equal, F_SETOWN, 0, 3);
  made.add(bpf_load, argument_at(2));
  made.add(bpf_equal, self, 1, 0);
  made.add(bpf_answer, refused);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  made.end_of_call();
  made.begin_call(SYS_ioctl);
  made.add(bpf_load, argument_at(1));
  refuse(owners_by_ioctl);
  refuse(terminals_by_ioctl);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  made.end_of_call();
}

/// The number of the call is loaded, before and after. Rules of files ask what a file is opened for: one that is opened to read may be cut
/// short all the same, and one for neither (3) is asked for nothing, though devices can be controlled by it.
constexpr void filter_opening(Filter& made, bool queues) noexcept {
  constexpr std::uint32_t refused = SECCOMP_RET_TRAP;
  struct Opening {
    std::uint32_t number, flags_at;
  };
  for (const auto& [number, flags_at] : {
           Opening{SYS_openat, argument_at(2)},
#if defined(__x86_64__)
           Opening{SYS_open, argument_at(1)},
#endif
       }) {
    made.begin_call(number);
    made.add(bpf_load, flags_at);
    made.add(bpf_and, O_ACCMODE | O_TRUNC);
    for (const int way : {O_RDONLY | O_TRUNC, O_ACCMODE, O_ACCMODE | O_TRUNC}) {
      made.add(bpf_equal, static_cast<std::uint32_t>(way), 0, 1);
      made.add(bpf_answer, refused);
    }
    made.add(bpf_answer, SECCOMP_RET_ALLOW);
    made.end_of_call();
  }
  // Its flags lie in memory.
  made.add(bpf_equal, SYS_openat2, 0, 1);
  made.add(bpf_answer, SECCOMP_RET_ERRNO | ENOSYS);
  if (queues) return;
  for (const std::uint32_t number : {std::uint32_t{SYS_mq_open}, std::uint32_t{SYS_mq_unlink}}) {
    made.add(bpf_equal, number, 0, 1);
    made.add(bpf_answer, refused);
  }
}

/// Refused calls raise SIGSYS, which names them (name_refused_calls()), or fail without.
[[nodiscard]] Filter call_filter(const Sandbox& sandbox) noexcept {
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
  filter_sockets(made, sandbox.sockets);
  filter_signals(made);
  filter_opening(made, sandbox.queues);
  // Its flags lie in memory, where no filter looks: the C library takes clone() instead.
  made.add(bpf_equal, SYS_clone3, 0, 1);
  made.add(bpf_answer, SECCOMP_RET_ERRNO | ENOSYS);
  made.add(bpf_equal, SYS_clone, 0, 3);
  made.add(bpf_load, argument_at(0));
  made.add(bpf_any_of, CLONE_THREAD, 1, 0);
  made.add(bpf_answer, refused);
  made.add(bpf_answer, SECCOMP_RET_ALLOW);
  if (sandbox.refusal == CallRefusal::Error) made.refuse_without_signal();
  return made;
}

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

int refuse_calls(const Sandbox& sandbox) noexcept {
  const Filter calls = call_filter(sandbox);
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
