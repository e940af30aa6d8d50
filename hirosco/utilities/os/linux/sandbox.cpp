// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/sandbox.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/utilities/os/linux/rights.hpp"
#include "hirosco/utilities/os/linux/sandbox_calls.hpp"

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
  // A right that this is not about, as to list what is no folder, would be none at all.
  const bool added =
      rule.allowed_access == 0 || ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
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
                    permit_paths(rules, sandbox.listable, LANDLOCK_ACCESS_FS_READ_DIR) &&
                    permit_paths(rules, sandbox.executable, to_execute) &&
                    permit_paths(rules, sandbox.writable, to_write) && permit_path(rules, "/proc/self", to_read) &&
                    permit_ports(rules, known, sandbox.sockets) && ::syscall(SYS_landlock_restrict_self, rules, 0) == 0;
  const int error = done ? 0 : errno;
  ::close(rules);
  return error;
}

// --- rights -----------------------------------------------------------------------------------------------------------------

void give_up_rights() noexcept {
  constexpr int highest = 63;
  const std::uint64_t left = rights::left_to_subsystems();
  for (int right = 0; right <= highest; ++right)
    if ((left & rights::one(right)) == 0) static_cast<void>(::prctl(PR_CAPBSET_DROP, right, 0, 0, 0));
}

}  // namespace

bool sandbox_is_unwanted() noexcept {
  const char* const wish = std::getenv("HIROSCO_SANDBOX");
  return wish != nullptr && std::string_view{wish} == "off";
}

bool sandbox_is_off() noexcept { return built_without != nullptr || sandbox_is_unwanted(); }

std::vector<std::string> isolation_lacks() {
  std::vector<std::string> lacks;
  if (sandbox_is_off()) {
    lacks.emplace_back("everything is open: ")
        .append(built_without != nullptr ? built_without : "HIROSCO_SANDBOX is off");
    return lacks;
  }
  const long rules_known = rules_version();
  if (rules_known < 1) lacks.emplace_back("files are open to all (no Landlock)");
  else if (rules_known < 4)
    lacks.emplace_back("whoever has a device by TCP reaches every port (Landlock before version 4)");
  const std::uint32_t trap = SECCOMP_RET_TRAP;
  if (::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &trap) != 0)
    lacks.emplace_back("every system call is open (no seccomp filters)");
  // Root without this right cannot give who it starts a limit that it has not itself.
  if (::geteuid() == 0 && !rights::priority_is_limited() && !rights::has(CAP_SYS_RESOURCE))
    lacks.emplace_back("every real-time priority is open (root without CAP_SYS_RESOURCE)");
  return lacks;
}

int PreparedSandbox::enter() const noexcept {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return errno;
  give_up_rights();
  if (const int error = restrict_files(sandbox_); error != 0) return error;
  return refuse_calls(sandbox_);
}

}  // namespace hirosco
