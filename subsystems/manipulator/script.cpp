// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/script.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hirosco::manipulator {
namespace {

constexpr double contour_from_y_m = -0.020;
constexpr double contour_to_y_m = 0.095;
constexpr double clearance_m = 0.005;      // of the finger before and after
constexpr double spring_stretch_m = 0.030;
constexpr double ramp_s = 0.25;            // to full speed along the contour, and from it to rest

double minimum_jerk(double s) noexcept { return s * s * s * (10 + s * (6 * s - 15)); }

/// Share of a way at constant speed with equal ramps at both ends.
double trapezoid(double past_s, double duration_s) noexcept {
  const double ramp = std::min(ramp_s, duration_s / 2);
  const double speed = 1 / (duration_s - ramp);
  if (past_s < ramp) return speed * past_s * past_s / (2 * ramp);
  const double left_s = duration_s - past_s;
  if (left_s < ramp) return 1 - speed * left_s * left_s / (2 * ramp);
  return speed * (past_s - ramp / 2);
}

}  // namespace

double distance_to_spring(std::size_t spring, const Joints& tip_m) noexcept {
  const Joints& end = springs[spring - 1].slack_end_m;
  return std::hypot(tip_m[0] - end[0], tip_m[1] - end[1]);
}

Joints pressed_finger(const Surroundings& surroundings, double y_m, double depth_m) noexcept {
  const double across = y_m - surroundings.bump_y_m;
  double x = surroundings.rail_x_m;
  double slope = 0;
  if (std::abs(across) < surroundings.bump_half_width_m) {
    const double wave = std::numbers::pi / surroundings.bump_half_width_m;
    const double half = surroundings.bump_height_m / 2;
    x -= half * (1 + std::cos(wave * across));
    slope = half * wave * std::sin(wave * across);
  }
  const double out_m = (surroundings.finger_radius_m - depth_m) / std::hypot(1.0, slope);
  return {x - out_m, y_m + slope * out_m};
}

void Script::start(Id id, const Joints& tip_m, const Joints& home_m, const Settings& settings) noexcept {
  settings_ = settings;
  end_m_ = tip_m;
  legs_ = leg_ = 0;
  past_s_ = 0;
  const Surroundings& around = settings.surroundings;
  if (id == Id::Contour) {
    straight(pressed_finger(around, contour_from_y_m, -clearance_m), 2);
    straight(pressed_finger(around, contour_from_y_m, settings.over_press_m), 1);
    along_contour(contour_from_y_m, contour_to_y_m);
    straight(pressed_finger(around, contour_to_y_m, -clearance_m), 1);
  } else {
    const SpringPlace& spring = springs[0];
    const Joints way{spring.slack_end_m[0] - spring.anchor_m[0], spring.slack_end_m[1] - spring.anchor_m[1]};
    const double share = spring_stretch_m / std::hypot(way[0], way[1]);
    const Joints stretched{spring.slack_end_m[0] + share * way[0], spring.slack_end_m[1] + share * way[1]};
    straight(spring.slack_end_m, 2, Deed::Hook);
    straight(stretched, 2);
    straight(stretched, 1);
    straight(spring.slack_end_m, 2, Deed::Release);
  }
  straight(home_m, 2);
}

void Script::straight(const Joints& to_m, double duration_s, Deed deed) noexcept {
  plan_[legs_++] = {Leg::Path::Straight, end_m_, to_m, duration_s, deed};
  end_m_ = to_m;
}

void Script::along_contour(double from_y_m, double to_y_m) noexcept {
  const double duration_s = std::abs(to_y_m - from_y_m) / settings_.speed_m_s + ramp_s;
  plan_[legs_++] = {Leg::Path::AlongContour, {0, from_y_m}, {0, to_y_m}, duration_s, Deed::None};
  end_m_ = pressed_finger(settings_.surroundings, to_y_m, settings_.over_press_m);
}

Joints Script::on(const Leg& leg, double past_s) const noexcept {
  const bool straight = leg.path == Leg::Path::Straight;
  const double share = straight ? minimum_jerk(past_s / leg.duration_s) : trapezoid(past_s, leg.duration_s);
  const Joints at{leg.from_m[0] + share * (leg.to_m[0] - leg.from_m[0]),
                  leg.from_m[1] + share * (leg.to_m[1] - leg.from_m[1])};
  return straight ? at : pressed_finger(settings_.surroundings, at[1], settings_.over_press_m);
}

Joints Script::advance(double span_s) noexcept {
  if (done()) return end_m_;
  const Leg& leg = plan_[leg_];
  past_s_ = std::min(past_s_ + span_s, leg.duration_s);
  const Joints at = on(leg, past_s_);
  if (past_s_ >= leg.duration_s && leg.deed == Deed::None) {
    ++leg_;
    past_s_ = 0;
  }
  return at;
}

Script::Deed Script::deed() const noexcept {
  if (done() || past_s_ < plan_[leg_].duration_s) return Deed::None;
  return plan_[leg_].deed;
}

void Script::deed_done() noexcept {
  if (deed() == Deed::None) return;
  ++leg_;
  past_s_ = 0;
}

}  // namespace hirosco::manipulator
