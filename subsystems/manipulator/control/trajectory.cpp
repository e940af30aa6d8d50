// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/trajectory.hpp"

namespace hirosco::manipulator {

double shortest_duration_s(const Joints& from_rad, const Joints& to_rad, const MotionLimits& limits) noexcept {
  // Of s^3 (10 - 15 s + 6 s^2): its largest rate, at half time, and its largest second derivative.
  constexpr double peak_rate = 1.875, peak_acceleration = 5.7735026918962576;
  const double way = largest_difference(to_rad, from_rad);
  return std::max(peak_rate * way / limits.speed_rad_s,
                  std::sqrt(peak_acceleration * way / limits.acceleration_rad_s2));
}

void Trajectory::start(const Joints& from_rad, const Joints& to_rad, double duration_s) noexcept {
  from_ = from_rad;
  to_ = to_rad;
  duration_s_ = std::max(duration_s, 0.0);
  past_s_ = 0;
}

Joints Trajectory::advance(double span_s) noexcept {
  past_s_ = std::min(past_s_ + span_s, duration_s_);
  return position_rad();
}

double Trajectory::progress() const noexcept { return duration_s_ > 0 ? past_s_ / duration_s_ : 1; }

Joints Trajectory::position_rad() const noexcept {
  if (done()) return to_;  // exactly, not by way of the sum below
  const double share = minimum_jerk(progress());
  Joints position = from_;
  for (std::size_t i = 0; i < position.size(); ++i) position[i] = from_[i] + share * (to_[i] - from_[i]);
  return position;
}

Arrival::Verdict Arrival::judge(const Joints& measured_rad, const Joints& goal_rad, double tolerance_rad,
                                double span_s) noexcept {
  bool there = true;
  for (std::size_t i = 0; i < goal_rad.size(); ++i)
    there = there && std::abs(measured_rad[i] - goal_rad[i]) <= tolerance_rad;
  if (there) return Verdict::There;
  waited_s_ += span_s;
  return waited_s_ < patience_s ? Verdict::UnderWay : Verdict::Missed;
}

}  // namespace hirosco::manipulator
