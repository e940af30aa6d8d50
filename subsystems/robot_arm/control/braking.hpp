// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/motion/point_to_point.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/line.hpp"

/// How an arm that is braked on its way slows the time of that down, and where it rests then: reckoned in a few steps of that time, in each of which it goes on as
/// fast as where it begins and is slowed as little as where that is least. So it never rests farther on, and not much before.
/// Realtime: bounded, no allocation. Thread: any.
namespace hirosco::robot_arm {

/// Of the accelerations, while it brakes on its way: what is left of them is for what a cycle changes of that way.
inline constexpr double braking_share = 0.95;

/// Where somebody is on his way, in the time of that, and with which pace that goes.
struct OnWay {
  double at_s{0};
  double pace{1};
};

/// How much of a path is behind him, 0 to 1; all of one that has no length.
[[nodiscard]] double progress_on(const robotics::PointToPoint& path, const OnWay& on) noexcept;

/// How fast the time of a path may go slower in that time, 1/s: where the joints are braked on it already, by what is left of their accelerations.
[[nodiscard]] double slowing(const robotics::PointToPoint& path, Bounds bounds, const OnWay& on,
                             double span_s) noexcept;

/// The time of the path, or of a line that can be followed, in which who is there rests.
[[nodiscard]] double rest_on(const robotics::PointToPoint& path, Bounds bounds, OnWay on, double cycle_s) noexcept;
[[nodiscard]] double rest_on(const Line& line, Bounds bounds, OnWay on) noexcept;

}  // namespace hirosco::robot_arm
