// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/braking.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// A step, of the time in which the joints would come to rest if each was braked by itself; it takes up to three times as long, where the way itself brakes or turns.
constexpr double brake_parts = 16;
constexpr int most_brake_parts = 64;
constexpr double no_motion = 1e-9;

/// rad/s or m/s of each joint, at full pace.
[[nodiscard]] double longest_brake_s(const JointVector& velocity, double pace, Bounds bounds) noexcept {
  double longest_s = 0;
  for (std::size_t joint = 0; joint < bounds.size(); ++joint)
    longest_s = std::max(longest_s, pace * std::abs(velocity[static_cast<Eigen::Index>(joint)]) /
                                        (braking_share * bounds[joint].motion.acceleration));
  return longest_s;
}

}  // namespace

double progress_on(const robotics::PointToPoint& path, const OnWay& on) noexcept {
  return path.duration_s() > 0 ? std::clamp(on.at_s / path.duration_s(), 0.0, 1.0) : 1.0;
}

double slowing(const robotics::PointToPoint& path, Bounds bounds, const OnWay& on, double span_s) noexcept {
  double most = on.pace / span_s;
  robotics::PointToPoint::Sample sample;
  for (const double ahead_s : {0.0, on.pace * span_s}) {
    path.at(on.at_s + ahead_s, sample);
    for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
      const auto i = static_cast<Eigen::Index>(joint);
      const double speed = std::abs(sample.velocity[i]);
      const double braked = sample.velocity[i] * sample.acceleration[i] < 0 ? std::abs(sample.acceleration[i]) : 0;
      const double left = braking_share * bounds[joint].motion.acceleration - on.pace * on.pace * braked;
      if (speed > 0) most = std::min(most, std::max(0.0, left) / speed);
    }
  }
  return most;
}

double rest_on(const robotics::PointToPoint& path, Bounds bounds, OnWay on, double cycle_s) noexcept {
  robotics::PointToPoint::Sample sample;
  path.at(on.at_s, sample);
  const double longest_s = longest_brake_s(sample.velocity, on.pace, bounds),
               span_s = std::max(longest_s / brake_parts, cycle_s);
  for (int i = 0; i < most_brake_parts && on.pace > 0 && on.at_s < path.duration_s(); ++i) {
    const double slower = slowing(path, bounds, on, span_s);
    on.at_s += on.pace * span_s;
    on.pace = std::max(0.0, on.pace - std::min(slower, slowing(path, bounds, on, span_s)) * span_s);
  }
  return std::min(on.at_s + on.pace * longest_s, path.duration_s());
}

/// As LineMotion goes along it: its pace falls within `Line::ramp_s`, no faster than the joints' accelerations let it, and not above that of the survey.
double rest_on(const Line& line, Bounds bounds, OnWay on) noexcept {
  const double end_s = line.path().duration_s();
  JointVector before = line.onward(on.at_s);
  const double longest_s = std::max(on.pace * Line::ramp_s, longest_brake_s(before, on.pace, bounds));
  const double span_s = longest_s / brake_parts;
  for (int i = 0; i < most_brake_parts && on.pace > 0 && on.at_s < end_s; ++i) {
    on.at_s += on.pace * span_s;
    const JointVector onward = line.onward(on.at_s);
    double slowed = std::max(0.0, on.pace - span_s / Line::ramp_s);
    for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
      const auto k = static_cast<Eigen::Index>(joint);
      if (std::abs(onward[k]) < no_motion) continue;
      const double least = on.pace * std::abs(before[k]) - braking_share * bounds[joint].motion.acceleration * span_s;
      slowed = std::max(slowed, least / std::abs(onward[k]));
    }
    on.pace = std::min({on.pace, slowed, line.pace(on.at_s)});
    before = onward;
  }
  return std::min(on.at_s + on.pace * longest_s, end_s);
}

}  // namespace hirosco::robot_arm
