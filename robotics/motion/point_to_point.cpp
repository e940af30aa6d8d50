// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/motion/point_to_point.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robotics {
namespace {

/// Shorter than any sensor tells: it limits nothing.
constexpr double no_way = 1e-12;

}  // namespace

Result<> PointToPoint::check(const JointVector& from, const JointVector& to,
                             std::span<const MotionLimits> limits) noexcept {
  if (from.size() != to.size() || static_cast<std::size_t>(from.size()) != limits.size())
    return fail(ErrorCode::InvalidArgument, "numbers of joints differ", to.size());
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const MotionLimits& its = limits[static_cast<std::size_t>(i)];
    const auto usable = [](double limit) { return limit > 0 && std::isfinite(limit); };
    if (!std::isfinite(from[i]) || !std::isfinite(to[i]))
      return fail(ErrorCode::InvalidArgument, "a place is no number", i);
    if (!usable(its.velocity) || !usable(its.acceleration) || !usable(its.jerk))
      return fail(ErrorCode::InvalidArgument, "a limit is not above 0", i);
  }
  return ok();
}

Result<PointToPoint> PointToPoint::plan(const JointVector& from, const JointVector& to,
                                        std::span<const MotionLimits> limits) noexcept {
  HIROSCO_TRY(check(from, to, limits));
  PointToPoint plan;
  plan.joints_ = from.size();
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    Curve& curve = plan.curves_[static_cast<std::size_t>(i)];
    curve = quickest(std::abs(to[i] - from[i]), limits[static_cast<std::size_t>(i)]);
    curve.start = from[i];
    curve.way = to[i] - from[i];
    plan.duration_s_ = std::max(plan.duration_s_, curve.duration());
  }
  return plan;
}

Result<PointToPoint> PointToPoint::plan_straight(const JointVector& from, const JointVector& to,
                                                 std::span<const MotionLimits> limits) noexcept {
  HIROSCO_TRY(check(from, to, limits));
  PointToPoint plan;
  plan.joints_ = from.size();
  // Of the share of the way that is done, from 0 to 1.
  MotionLimits shared{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const double way = std::abs(to[i] - from[i]);
    if (way < no_way) continue;
    const MotionLimits& its = limits[static_cast<std::size_t>(i)];
    shared.velocity = std::min(shared.velocity, its.velocity / way);
    shared.acceleration = std::min(shared.acceleration, its.acceleration / way);
    shared.jerk = std::min(shared.jerk, its.jerk / way);
  }
  const Curve whole = shared.velocity < HUGE_VAL ? quickest(1, shared) : Curve{};
  plan.duration_s_ = whole.duration();
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    Curve& curve = plan.curves_[static_cast<std::size_t>(i)];
    curve = whole;
    curve.start = from[i];
    curve.way = to[i] - from[i];
    curve.jerk = whole.jerk * std::abs(curve.way);
  }
  return plan;
}

PointToPoint::Curve PointToPoint::quickest(double way, const MotionLimits& limits) noexcept {
  const auto& [v, a, j] = limits;
  Curve curve;
  curve.jerk = j;
  if (way == 0) return curve;
  // With the whole velocity: is the whole acceleration reached on the way to it?
  if (v * j >= a * a) {
    curve.ramp = a / j;
    curve.steady = v / a - curve.ramp;
  } else curve.ramp = std::sqrt(v / j);
  curve.coast = way / v - (2 * curve.ramp + curve.steady);
  if (curve.coast >= 0) return curve;
  // Too short for it; for the whole acceleration, too?
  curve.coast = 0;
  if (way * j * j >= 2 * a * a * a) {
    curve.ramp = a / j;
    const double half = curve.ramp / 2;
    curve.steady = std::sqrt(half * half + way / a) - 3 * half;
    return curve;
  }
  // Not std::cbrt, whose last digit depends on the processor (docs/adr/0139).
  curve.ramp = std::pow(way / (2 * j), 1.0 / 3);
  curve.steady = 0;
  return curve;
}

PointToPoint::Point PointToPoint::first_half(const Curve& curve, double t_s) noexcept {
  const auto piece = [](const Point& from, double jerk, double t) {
    return Point{from.position + t * (from.velocity + t * (from.acceleration / 2 + t * jerk / 6)),
                 from.velocity + t * (from.acceleration + t * jerk / 2), from.acceleration + t * jerk};
  };
  Point at = piece({}, curve.jerk, std::min(t_s, curve.ramp));
  if (t_s > curve.ramp) at = piece(at, 0, std::min(t_s - curve.ramp, curve.steady));
  if (t_s > curve.ramp + curve.steady)
    at = piece(at, -curve.jerk, std::min(t_s - curve.ramp - curve.steady, curve.ramp));
  if (const double up = 2 * curve.ramp + curve.steady; t_s > up) at = piece({at.position, at.velocity, 0}, 0, t_s - up);
  return at;
}

void PointToPoint::at(double t_s, Sample& sample) const noexcept {
  sample.position.resize(joints_);
  sample.velocity.setZero(joints_);
  sample.acceleration.setZero(joints_);
  for (Eigen::Index i = 0; i < joints_; ++i) {
    const Curve& curve = curves_[static_cast<std::size_t>(i)];
    const double duration = curve.duration();
    if (t_s <= 0 || t_s >= duration_s_ || duration == 0) {
      sample.position[i] = t_s <= 0 ? curve.start : curve.start + curve.way;
      continue;
    }
    // Slower by so much as there is time: velocity shrinks by it, acceleration by its square, jerk by its cube.
    const double pace = duration / duration_s_;
    const double t = std::min(t_s * pace, duration);
    const bool second = t > duration / 2;
    const Point at = first_half(curve, second ? duration - t : t);
    const double sign = curve.way < 0 ? -1 : 1;
    sample.position[i] = second ? curve.start + curve.way - sign * at.position : curve.start + sign * at.position;
    sample.velocity[i] = sign * pace * at.velocity;
    sample.acceleration[i] = (second ? -sign : sign) * pace * pace * at.acceleration;
  }
}

}  // namespace hirosco::robotics
