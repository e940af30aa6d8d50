// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/os/own_user.hpp"

#include <dirent.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <string_view>

#include "hirosco/utilities/os/linux/rights.hpp"
#include "hirosco/utilities/os/process_usage.hpp"

namespace hirosco {
namespace {

struct Right {
  int number;
  const char* name;
};
constexpr Right limits_of_others{CAP_SYS_RESOURCE, "CAP_SYS_RESOURCE"};
/// To become a user, to end it, to take its priority, to give it a folder.
constexpr std::array rights_over_users{Right{CAP_SETUID, "CAP_SETUID"}, Right{CAP_SETGID, "CAP_SETGID"},
                                       Right{CAP_KILL, "CAP_KILL"}, Right{CAP_SYS_NICE, "CAP_SYS_NICE"},
                                       Right{CAP_CHOWN, "CAP_CHOWN"}};
/// What of them nobody needs but keeper and supervisor: real time is had by who has no limit of it.
constexpr std::array laid_down{CAP_SETUID, CAP_SETGID, CAP_KILL, CAP_CHOWN, CAP_SYS_RESOURCE};

/// Whether the numbers mean users here: in a name space of users only some do.
[[nodiscard]] bool are_mapped(const char* map, std::uint32_t first, std::uint32_t last) {
  std::ifstream lines{map};
  if (!lines) return true;
  for (std::uint64_t inside = 0, outside = 0, count = 0; lines >> inside >> outside >> count;)
    if (inside <= first && last < inside + count) return true;
  return false;
}

[[nodiscard]] std::string all_of_file(const std::string& file) {
  std::ifstream stream{file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

}  // namespace

std::vector<std::string> lacking_for_own_users(std::uint32_t first, std::uint32_t last) {
  std::vector<std::string> lacking;
  for (const Right& right : rights_over_users)
    if (!rights::has(right.number)) lacking.emplace_back(right.name);
  // Where it is limited the limit of who is fenced is taken, by which he takes nothing back (docs/adr/0146).
  rlimit limit{};
  const bool limited = ::getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_max > 0;
  if (limited && !rights::has(limits_of_others.number)) lacking.emplace_back(limits_of_others.name);
  if (!are_mapped("/proc/self/uid_map", first, last) || !are_mapped("/proc/self/gid_map", first, last))
    lacking.emplace_back("a name space that has these numbers");
  return lacking;
}

int become_user(std::uint32_t number) noexcept {
  const std::uint64_t kept = rights::left_to_subsystems() & rights::held().permitted;
  // By number: those of the C library would ask threads that are not in this process.
  if (::prctl(PR_SET_KEEPCAPS, 1, 0, 0, 0) != 0 || ::syscall(SYS_setgroups, 0, nullptr) != 0 ||
      ::syscall(SYS_setresgid, number, number, number) != 0 || ::syscall(SYS_setresuid, number, number, number) != 0)
    return errno;
  const auto low = static_cast<std::uint32_t>(kept), high = static_cast<std::uint32_t>(kept >> 32);
  __user_cap_header_struct about{_LINUX_CAPABILITY_VERSION_3, 0};
  const std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> wanted{{{low, low, low}, {high, high, high}}};
  if (::syscall(SYS_capset, &about, wanted.data()) != 0) return errno;
  // What is not ambient goes with exec.
  if (::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0) != 0) return errno;
  for (int right = 0; right <= CAP_LAST_CAP; ++right)
    if ((kept & rights::one(right)) != 0 && ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_RAISE, right, 0, 0) != 0)
      return errno;
  return 0;
}

void lay_down_rights_over_users() noexcept {
  for (const int right : laid_down) static_cast<void>(::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_LOWER, right, 0, 0));
}

std::string process_of_users(std::uint32_t first, std::uint32_t last) {
  DIR* const processes = ::opendir("/proc");
  if (processes == nullptr) return {};
  std::string found;
  while (const dirent* const entry = ::readdir(processes)) {
    const std::string_view name{entry->d_name};
    if (!found.empty() || name.find_first_not_of("0123456789") != std::string_view::npos) continue;
    const std::string status = all_of_file("/proc/" + std::string{name} + "/status");
    const std::uint32_t user = number_in_status(status, "Uid");
    if (status.empty() || user < first || user > last) continue;
    std::string program = all_of_file("/proc/" + std::string{name} + "/comm");
    if (!program.empty() && program.back() == '\n') program.pop_back();
    found = program + " (" + std::string{name} + ")";
  }
  ::closedir(processes);
  return found;
}

}  // namespace hirosco
