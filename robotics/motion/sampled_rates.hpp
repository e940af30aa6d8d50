// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/result.hpp"

/// How fast a law may answer that commands once in a cycle (docs/adr/0193).
namespace hirosco::robotics {

/// From a measurement to the torque that it leads to: one cycle on the way there, one on the way back. The torque is held for a cycle, half of which counts besides.
inline constexpr double delay_cycles = 2;

/// The fastest poles that are taken, of a law whose poles of a joint coincide; of a spring its square, of what it moves. Three such poles become unstable at twice
/// that: what is moved may be less than half of what the on-board model says, and seven times as much.  Realtime: wait-free.
[[nodiscard]] constexpr double fastest_rad_s(double cycle_s) noexcept { return 0.2 / ((delay_cycles + 0.5) * cycle_s); }

/// The strongest damper, of what it moves: a sixth of what leaves it stable, as joints that carry each other feel it several times.  Realtime: wait-free.
[[nodiscard]] constexpr double strongest_damper_per_s(double fastest_rad_s) noexcept { return 1.25 * fastest_rad_s; }

/// With a longer cycle there is no law of joints.
inline constexpr double longest_cycle_s = 0.004;
/// Three poles that coincide are off by 0.27 / w^2 at the most, times what nobody declared by what is moved, and by 1 / (3 w^2) where nothing is learnt: slower than this an ordinary
/// load (2 N m on 0.1 kg m2) is farther off than any law learns from, and no goal is reached any more.
inline constexpr double slowest_rad_s = fastest_rad_s(longest_cycle_s);

/// In configure() of whoever moves joints.
[[nodiscard]] inline Result<> check_cycle(double cycle_s) noexcept {
  if (cycle_s > longest_cycle_s)
    return fail(ErrorCode::OutOfRange, "sampling_us is too long for any law of these joints: at most, us",
                static_cast<std::int64_t>(1e6 * longest_cycle_s + 0.5));
  return ok();
}

}  // namespace hirosco::robotics
