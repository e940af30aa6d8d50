// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How fast a law may answer that commands once in a cycle (docs/adr/0193).
namespace hirosco::robotics {

/// From a measurement to the torque that it leads to: one cycle on the way there, one on the way back. The torque is held for a cycle, half of which counts besides.
inline constexpr double delay_cycles = 2;

/// The fastest poles that are taken, of a law whose poles of a joint coincide; of a spring its square, of what it moves. Three such poles become unstable at twice
/// that: what is moved may be less than half of what the on-board model says, and seven times as much.  Realtime: wait-free.
[[nodiscard]] constexpr double fastest_rad_s(double cycle_s) noexcept { return 0.2 / ((delay_cycles + 0.5) * cycle_s); }

/// The strongest damper, of what it moves: a sixth of what leaves it stable, as joints that carry each other feel it several times.  Realtime: wait-free.
[[nodiscard]] constexpr double strongest_damper_per_s(double fastest_rad_s) noexcept { return 1.25 * fastest_rad_s; }

/// Slower than this a law does not learn a load or dry friction as fast as somebody waits for a goal: who cannot have it flies no joints.
inline constexpr double slowest_rad_s = 10;
/// With a longer cycle there is no law.
inline constexpr double longest_cycle_s = 0.2 / ((delay_cycles + 0.5) * slowest_rad_s);

}  // namespace hirosco::robotics
