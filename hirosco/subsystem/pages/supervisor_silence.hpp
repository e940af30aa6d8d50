// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#pragma once

#include <chrono>
#include <cstdint>

#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// Without a sign of life of the supervisor on its permit page for this long a subsystem makes itself safe (hazard SF8). Its cycle counts own cycles,
/// at least this many, its service loop the time that it has watched: with both parts of the machine stopped for a while nobody has been silent.
/// For no longer the keeper goes on telling devices what the guard of a dead supervisor had told them.
inline constexpr Duration supervisor_silence_limit = std::chrono::seconds{2};
/// Of the time between two looks of the service loop no more counts. They are 10 ms apart at most while nothing holds it up.
inline constexpr Duration most_silence_a_look = std::chrono::milliseconds{200};
[[nodiscard]] constexpr std::uint32_t supervisor_silence_cycles(Duration period) noexcept {
  const auto cycles = period > Duration{0} ? (supervisor_silence_limit + period - Duration{1}) / period : 1;
  return static_cast<std::uint32_t>(cycles > 1 ? cycles : 1);
}

}  // namespace hirosco
