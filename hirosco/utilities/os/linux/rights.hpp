// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/capability.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdint>

/// Capabilities of this process, as the system counts them. All of it is async-signal-safe.
namespace hirosco::rights {

struct Sets {
  std::uint64_t effective{0}, permitted{0};
};
/// None where the system does not say.
[[nodiscard]] inline Sets held() noexcept {
  __user_cap_header_struct about{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> has{};
  if (::syscall(SYS_capget, &about, has.data()) != 0) return {};
  return {std::uint64_t{has[1].effective} << 32 | has[0].effective,
          std::uint64_t{has[1].permitted} << 32 | has[0].permitted};
}

[[nodiscard]] constexpr std::uint64_t one(int right) noexcept { return std::uint64_t{1} << right; }
[[nodiscard]] inline bool has(int right) noexcept { return (held().effective & one(right)) != 0; }

/// Whether a limit says which priorities of real time there are for it: then root's right to all of them is given up.
[[nodiscard]] inline bool priority_is_limited() noexcept {
  rlimit limit{};
  return ::getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur > 0;
}

/// Of who starts it, what a subsystem keeps: memory that is never taken to disk, and real time where no limit says which.
[[nodiscard]] inline std::uint64_t left_to_subsystems() noexcept {
  return one(CAP_IPC_LOCK) | (priority_is_limited() ? 0 : one(CAP_SYS_NICE));
}

}  // namespace hirosco::rights
