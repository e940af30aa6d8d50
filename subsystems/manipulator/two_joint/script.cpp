// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/two_joint/script.hpp"

namespace hirosco::manipulator::two_joint {
namespace {

constexpr double contour_from_y_m = -0.020;
constexpr double contour_to_y_m = 0.095;
constexpr double clearance_m = 0.005;      // of the finger before and after
constexpr double spring_stretch_m = 0.030;
constexpr std::uint8_t nothing = 0, vertical_spring = 1;  // what the tool holds

}  // namespace

void Script::start(Id id, const Joints& from_rad, const Joints& home_rad, const Settings& settings) noexcept {
  settings_ = settings;
  home_rad_ = home_rad;
  end_m_ = tip(geometry_, from_rad);
  legs_.clear();
  const Surroundings& around = settings.surroundings;
  if (id == Id::Contour) {
    straight(pressed_finger(around, contour_from_y_m, -clearance_m), 2);
    straight(pressed_finger(around, contour_from_y_m, settings.over_press_m), 1);
    along_contour(contour_from_y_m, contour_to_y_m);
    straight(pressed_finger(around, contour_to_y_m, -clearance_m), 1);
  } else {
    const SpringPlace& spring = springs[vertical_spring - 1];
    const Point way{spring.slack_end_m[0] - spring.anchor_m[0], spring.slack_end_m[1] - spring.anchor_m[1]};
    const double share = spring_stretch_m / std::sqrt(way[0] * way[0] + way[1] * way[1]);
    const Point stretched{spring.slack_end_m[0] + share * way[0], spring.slack_end_m[1] + share * way[1]};
    straight(spring.slack_end_m, 2, vertical_spring);
    straight(stretched, 2);
    straight(stretched, 1);
    straight(spring.slack_end_m, 2, nothing);
  }
  straight(tip(geometry_, home_rad), 2);
}

void Script::straight(const Point& to_m, double duration_s, std::optional<std::uint8_t> tool) noexcept {
  add({Way::Path::Straight, end_m_, to_m}, {Legs::Pace::MinimumJerk, duration_s, tool});
  end_m_ = to_m;
}

void Script::along_contour(double from_y_m, double to_y_m) noexcept {
  const double duration_s = std::abs(to_y_m - from_y_m) / settings_.speed_m_s + Legs::ramp_s;
  add({Way::Path::AlongContour, {0, from_y_m}, {0, to_y_m}}, {Legs::Pace::Even, duration_s, {}});
  end_m_ = pressed_finger(settings_.surroundings, to_y_m, settings_.over_press_m);
}

void Script::add(const Way& way, const Legs::Leg& leg) noexcept {
  ways_[legs_.size()] = way;
  legs_.add(leg);
}

Point Script::advance_tip(double span_s) noexcept {
  if (done()) return end_m_;
  const auto [leg, share] = legs_.advance(span_s);
  const Way& way = ways_[leg];
  const Point at{way.from_m[0] + share * (way.to_m[0] - way.from_m[0]),
                 way.from_m[1] + share * (way.to_m[1] - way.from_m[1])};
  if (way.path == Way::Path::Straight) return at;
  return pressed_finger(settings_.surroundings, at[1], settings_.over_press_m);
}

}  // namespace hirosco::manipulator::two_joint
