// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <sys/select.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "hirosco/utilities/os/wait_set.hpp"

// pselect(): the only wait of POSIX.1-2008 for a descriptor that is finer than a millisecond.
namespace hirosco {
namespace {

[[nodiscard]] Duration now_monotonic() noexcept {
  timespec value{};
  (void)clock_gettime(CLOCK_MONOTONIC, &value);
  return std::chrono::seconds{value.tv_sec} + Duration{value.tv_nsec};
}

}  // namespace

bool wait_readable(int descriptor, Duration timeout) noexcept {
  if (descriptor < 0 || descriptor >= FD_SETSIZE)
    return false;  // as one that is never ready: it has no place in the set
  const Duration end = now_monotonic() + std::max(timeout, Duration{0});
  for (;;) {
    const Duration left = std::max(end - now_monotonic(), Duration{0});
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec rest{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
    fd_set set;
    FD_ZERO(&set);
    FD_SET(descriptor, &set);
    const int ready = ::pselect(descriptor + 1, &set, nullptr, nullptr, &rest, nullptr);
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

}  // namespace hirosco
