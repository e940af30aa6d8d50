// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

/// How a law of the tool, which knows of no joint, keeps off the ends of their ranges (docs/adr/0174).
/// Realtime: wait-free. Thread: any.
namespace hirosco::robot_arm {

/// rad or m before an end of a range: no law of the tool drives a joint farther, so that what it overshoots is left of the range.
inline constexpr double kept_from_end = 0.01;
/// From this share of its range before that on, 0.3 rad or m at most, a joint that goes there counts for less, and others do it.
inline constexpr double avoided_share = 0.05, most_avoided = 0.3;
/// How fast a joint may go there: a speed that is at rest after this time, if it falls as what is left does. Velocities are followed in an eighth
/// of it. Where they are followed slower, with a payload, this time is longer: four times that in which they are, with which a joint that falls behind does not go beyond.
inline constexpr double stopped_in_s = 0.2, times_followed = 4;

/// How much a joint counts for that goes that way: 1, exactly, but near the end to which it goes; 0: there.
[[nodiscard]] double weight_near_end(const JointBounds& bounds, double position, double rate) noexcept;

/// A joint, from 0, where it is, and the end of its range to which it goes.
struct EndAhead {
  std::size_t joint{0};
  double position{0};
  double end{0};
};
/// Who would go to an end of its range faster than it can be brought to rest before it: the fastest for what is left. Nobody, mostly. `per_s`: how
/// fast velocities are followed.
[[nodiscard]] std::optional<EndAhead> end_ahead(const JointVector& position, const JointVector& rates, Bounds bounds,
                                                double per_s = followed_per_s) noexcept;

}  // namespace hirosco::robot_arm
