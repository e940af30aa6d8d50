// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// How much of one processor a process takes, from the processor time that it has had: by the process itself for its warning, and by
/// who ends it for taking too much, so that both mean the same number.
class ProcessorShare {
 public:
  /// One busy cycle is none of a second.
  static constexpr Duration window = std::chrono::seconds{1};

  /// `had`: since its start, of all its threads. Percent of one processor over the window that has just ended; empty while none has.
  /// Realtime: bounded. Thread: one at a time.
  [[nodiscard]] std::optional<std::uint32_t> look(Duration had, TimePoint now) noexcept {
    if (!std::exchange(begun_, true)) {
      had_ = had;
      since_ = now;
    }
    const Duration passed = now - since_;
    if (passed < window) return std::nullopt;
    constexpr int whole = 100;
    const Duration used = had - std::exchange(had_, had);
    since_ = now;
    return static_cast<std::uint32_t>(std::max<std::int64_t>(used * whole / passed, 0));
  }

 private:
  bool begun_{false};
  Duration had_{};
  TimePoint since_{};
};

}  // namespace hirosco
