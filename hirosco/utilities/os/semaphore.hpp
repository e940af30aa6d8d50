// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Counting semaphore. post() happens before the wait it lets through.
/// Realtime: post() and try_wait() are bounded, the waits block. Thread: any; destroyed only when no call is under way.
class Semaphore {
 public:
  explicit Semaphore(std::uint32_t initial = 0) noexcept;
  ~Semaphore();  // NOLINT(performance-trivially-destructible): trivial in one of the backends only
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  void post() noexcept;
  void wait() noexcept;
  [[nodiscard]] bool try_wait() noexcept;
  /// False when `deadline` passed first; changes of the calendar clock do not move it.
  [[nodiscard]] bool wait_until(TimePoint deadline) noexcept;

 private:
  /// The backend's own object, so that this header needs none of its headers.
  struct alignas(16) Storage {
    std::array<std::byte, 128> octets;
  };
  Storage storage_;
};

}  // namespace hirosco
