// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "hirosco/utilities/os/wait_set.hpp"

namespace hirosco {
namespace {

[[nodiscard]] Duration now_monotonic() noexcept {
  timespec value{};
  (void)clock_gettime(CLOCK_MONOTONIC, &value);
  return std::chrono::seconds{value.tv_sec} + Duration{value.tv_nsec};
}

}  // namespace

bool wait_readable(int descriptor, Duration timeout) noexcept {
  const Duration end = now_monotonic() + std::max(timeout, Duration{0});
  for (;;) {
    const Duration left = std::max(end - now_monotonic(), Duration{0});
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec rest{static_cast<time_t>(whole.count()), static_cast<long>((left - whole).count())};
    pollfd entry{descriptor, POLLIN, 0};
    const int ready = ::ppoll(&entry, 1, &rest, nullptr);
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

}  // namespace hirosco
