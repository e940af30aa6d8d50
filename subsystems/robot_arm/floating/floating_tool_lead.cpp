// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_tool_lead.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/floating/floating_jog.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {
namespace {

/// Beyond its limit a velocity may be measured, as a share of it.
constexpr double past_velocity = 1.1;
/// From the length of 1 a quaternion may be off.
constexpr double past_length = 0.01;
/// What is left is closed with it, 1/s: at TOOL_SPEED no faster than it may slow down.
constexpr double closing_per_s = 2;

[[nodiscard]] const char* words_of(Lead::Why why) noexcept {
  switch (why) {
    case Lead::Why::Lost: return "nothing comes from whoever leads its tool, cycles";
    case Lead::Why::LetGo: return "whoever leads its tool does not: ACTIVE is 0";
    case Lead::Why::NoNumber: return "its tool is led to what is no pose";
    case Lead::Why::OutOfRange:
    case Lead::Why::TooFar: return "its tool is led too far from where it is to be, mm or mrad";
    case Lead::Why::TooFast: return "its tool is led faster than it may go, mm/s or mrad/s";
  }
  return "";
}

/// Towards what is left of a way, no faster than it can be brought to rest there with half of the acceleration.
[[nodiscard]] Vector3 closing(const Vector3& left, double acceleration) noexcept {
  const double distance = left.norm();
  if (!(distance > 0)) return Vector3::Zero();
  return std::min(closing_per_s * distance, std::sqrt(acceleration * distance)) / distance * left;
}
[[nodiscard]] Vector3 no_more_than(const Vector3& wanted, double most) noexcept {
  const double length = wanted.norm();
  return length > most ? Vector3{most / length * wanted} : wanted;
}
[[nodiscard]] Vector3 place_of(const std::array<double, 3>& numbers) noexcept {
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

void FloatingToolLead::begin(const descriptor::Configuration& configuration, double cycle_s) noexcept {
  cycle_s_ = cycle_s;
  phase_ = Phase::Off;
  leads_ =
      std::ranges::find(configuration.requires_, set, &descriptor::Requires::name) != configuration.requires_.end();
}

std::optional<Lead::NotLed> FloatingToolLead::follow(const robotics::Pose& goal) noexcept {
  const ToolLeadLimits limits = limits_.load();
  if (const auto end = unfit(goal, limits.begin_m, limits.begin_rad)) {
    const bool is_lost = end->why == Lead::Why::Lost;
    return Lead::NotLed{words_of(end->why), std::llround(is_lost ? end->value : 1e3 * end->value)};
  }
  turning_ = moving_ = Vector3::Zero();
  phase_ = Phase::Follows;
  return std::nullopt;
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

void FloatingToolLead::tell(const robotics::Pose& goal, bool goes) noexcept {
  if (!goes) phase_ = Phase::Off;
  if (!leads_) return;
  const Way there = way(goal);
  told_.store({static_cast<std::uint8_t>(phase_), pose_.age_cycles(), there.left_m.norm(), there.left_rad.norm()});
}

std::optional<Lead::End> FloatingToolLead::advance(const robotics::Pose& goal) noexcept {
  if (phase_ == Phase::Off) return std::nullopt;
  std::optional<Lead::End> end;
  const ToolLeadLimits limits = limits_.load();
  if (phase_ == Phase::Follows) end = unfit(goal, limits.distance_m, limits.distance_rad);
  if (end) phase_ = Phase::Stops;
  Vector3 turning = Vector3::Zero(), moving = Vector3::Zero();
  if (phase_ == Phase::Follows) {
    const Way there = way(goal);
    turning = no_more_than(there.turning_rad_s + closing(there.left_rad, FloatingJog::tool_rad_s2), most_turning_rad_s);
    moving = no_more_than(there.velocity_m_s + closing(there.left_m, FloatingJog::tool_m_s2),
                          parameters_.tool_speed_m_s.load());
  }
  turning_ = towards(turning_, turning, FloatingJog::tool_rad_s2 * cycle_s_);
  moving_ = towards(moving_, moving, FloatingJog::tool_m_s2 * cycle_s_);
  if (phase_ == Phase::Stops && turning_.isZero(0) && moving_.isZero(0)) phase_ = Phase::Off;
  return end;
}

FloatingToolLead::Way FloatingToolLead::way(const robotics::Pose& goal) const noexcept {
  const LedTool& led = pose_.value();
  const auto& wxyz = led.orientation_wxyz;
  const robotics::Quaternion orientation{wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
  return {.left_m = place_of(led.position_m) - goal.position,
          .left_rad = rotation_between(goal.rotation, orientation.normalized().toRotationMatrix()),
          .velocity_m_s = place_of(led.velocity_m_s),
          .turning_rad_s = place_of(led.turning_rad_s)};
}

/// Written so that what is no number is unfit first.
std::optional<Lead::End> FloatingToolLead::unfit(const robotics::Pose& goal, double most_m,
                                                 double most_rad) const noexcept {
  using Why = Lead::Why;
  if (!pose_.valid()) return Lead::End{.why = Why::Lost, .value = static_cast<double>(pose_.age_cycles())};
  const LedTool& led = pose_.value();
  if (led.active == 0) return Lead::End{.why = Why::LetGo};
  double squares = 0;
  for (const double number : led.orientation_wxyz) squares += number * number;
  const double length = std::sqrt(squares);
  if (!(std::abs(length - 1) < past_length)) return Lead::End{.why = Why::NoNumber, .value = length, .limit = 1};
  const Way there = way(goal);
  for (const Vector3* part : {&there.left_m, &there.left_rad, &there.velocity_m_s, &there.turning_rad_s})
    if (!part->allFinite()) return Lead::End{.why = Why::NoNumber};
  const double fastest_m_s = past_velocity * parameters_.tool_speed_m_s.load();
  constexpr double fastest_rad_s = past_velocity * most_turning_rad_s;
  const auto beyond = [](Why why, double value, double limit) {
    return value > limit ? std::optional{Lead::End{.why = why, .value = value, .limit = limit}} : std::nullopt;
  };
  if (const auto end = beyond(Why::TooFast, there.velocity_m_s.norm(), fastest_m_s)) return end;
  if (const auto end = beyond(Why::TooFast, there.turning_rad_s.norm(), fastest_rad_s)) return end;
  if (const auto end = beyond(Why::TooFar, there.left_m.norm(), most_m)) return end;
  return beyond(Why::TooFar, there.left_rad.norm(), most_rad);
}

}  // namespace hirosco::robot_arm
