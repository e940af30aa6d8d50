// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/lead.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::robot_arm {
namespace {

/// Beyond the end of a range somebody who stands there may be measured, rad or m; the setpoint goes to the end.
constexpr double past_range = 0.01;
/// Likewise of a velocity, as a share of it.
constexpr double past_velocity = 1.1;

[[nodiscard]] const char* words_of(Lead::Why why) noexcept {
  switch (why) {
    case Lead::Why::Lost: return "nothing comes from whoever leads, cycles";
    case Lead::Why::LetGo: return "whoever leads does not: ACTIVE is 0";
    case Lead::Why::NoNumber: return "it is led to what is no number, joint";
    case Lead::Why::OutOfRange: return "it is led out of the range of joint";
    case Lead::Why::TooFar: return "it is led too far from its setpoint, joint";
    case Lead::Why::TooFast: return "it is led faster than it may go, joint";
  }
  return "";
}

}  // namespace

bool Lead::declared(const descriptor::SubsystemDescriptor& subsystem, std::string_view set) {
  return std::ranges::any_of(subsystem.configurations, [&](const descriptor::Configuration& each) {
    return std::ranges::find(each.requires_, set, &descriptor::Requires::name) != each.requires_.end();
  });
}

Result<> Lead::begin(const descriptor::Configuration& configuration, double cycle_s) {
  const auto wants = [&](std::string_view set) {
    return std::ranges::find(configuration.requires_, set, &descriptor::Requires::name) !=
           configuration.requires_.end();
  };
  phase_ = Phase::Off;
  by_ = wants(positions_set) ? By::Positions : wants(speeds_set) ? By::Speeds : By::Nobody;
  following_.reset();
  if (by_ == By::Nobody) return ok();
  if (wants(positions_set) && wants(speeds_set))
    return fail(ErrorCode::Mismatch, "JOINT_POSITIONS and JOINT_SPEEDS lead: one in a configuration");
  const std::size_t joints = known_.joints();
  if (by_ == By::Positions && positions_.value().position.size() != joints)
    return fail(ErrorCode::Mismatch, "POSITION of JOINT_POSITIONS has another length than the robot has joints",
                static_cast<std::int64_t>(positions_.value().position.size()));
  const std::size_t speeds =
      by_ == By::Positions ? positions_.value().velocity.size() : speeds_.value().velocity.size();
  if (speeds != joints)
    return fail(ErrorCode::Mismatch, "VELOCITY of whoever leads has another length than the robot has joints",
                static_cast<std::int64_t>(speeds));
  following_.emplace(known_.bounds(), cycle_s);
  return ok();
}

std::optional<Lead::NotLed> Lead::follow(Setpoints& setpoints) noexcept {
  if (by_ == By::Nobody) return NotLed{"nobody leads in this configuration"};
  if (const auto end = unfit(limits_.load().begin, setpoints.now()))
    return NotLed{words_of(end->why),
                  end->joint != 0 ? std::int64_t{end->joint} : static_cast<std::int64_t>(end->value)};
  following_->begin(setpoints.now().position);
  setpoints.take(following_->now());
  phase_ = Phase::Follows;
  return std::nullopt;
}

// --- in each cycle -------------------------------------------------------------------------------------------------------

void Lead::tell(const Setpoints& setpoints) noexcept {
  // HOLD, or whatever else brought the arm to rest, has ended it.
  if (setpoints.kind() != Setpoints::Kind::Follow) phase_ = Phase::Off;
  if (by_ == By::Nobody) return;
  told_.store({static_cast<std::uint8_t>(phase_), port().age_cycles(), apart(setpoints.now())});
}

std::optional<Lead::End> Lead::advance(Setpoints& setpoints) noexcept {
  if (phase_ == Phase::Off) return std::nullopt;
  std::optional<End> end;
  if (phase_ == Phase::Follows) end = unfit(limits_.load().distance, setpoints.now());
  if (end) phase_ = Phase::Stops;
  following_->keep_power(setpoints.power());
  setpoints.take(next());
  if (phase_ == Phase::Stops && following_->at_rest()) {
    setpoints.rest(following_->now().position);
    phase_ = Phase::Off;
  }
  return end;
}

const LinkInputPort& Lead::port() const noexcept {
  if (by_ == By::Positions) return positions_;
  return speeds_;
}

const Setpoint& Lead::next() noexcept {
  if (phase_ == Phase::Stops) return following_->slow_down();
  if (by_ == By::Speeds) return following_->go_with(vector_of(speeds_.value().velocity));
  return following_->go_to(vector_of(positions_.value().position), vector_of(positions_.value().velocity));
}

double Lead::apart(const Setpoint& now) const noexcept {
  if (by_ != By::Positions) return 0;
  return robot_arm::apart(vector_of(positions_.value().position), now.position);
}

std::optional<Lead::End> Lead::unfit(double most_apart, const Setpoint& now) const noexcept {
  if (!port().valid()) return End{.why = Why::Lost, .value = static_cast<double>(port().age_cycles())};
  const std::uint8_t active = by_ == By::Positions ? positions_.value().active : speeds_.value().active;
  if (active == 0) return End{.why = Why::LetGo};
  for (std::size_t joint = 0; joint < known_.joints(); ++joint)
    if (const auto end = unfit_joint(joint, most_apart, now)) return end;
  return std::nullopt;
}

/// Written so that what is no number is unfit first.
std::optional<Lead::End> Lead::unfit_joint(std::size_t joint, double most_apart, const Setpoint& now) const noexcept {
  const JointBounds& its = known_.bounds()[joint];
  const auto number = static_cast<std::uint8_t>(joint + 1);
  const double velocity = by_ == By::Positions ? positions_.value().velocity[joint] : speeds_.value().velocity[joint];
  if (!std::isfinite(velocity)) return End{.why = Why::NoNumber, .joint = number};
  if (by_ == By::Positions) {
    const double place = positions_.value().position[joint];
    const double here = now.position[static_cast<Eigen::Index>(joint)];
    if (!std::isfinite(place)) return End{.why = Why::NoNumber, .joint = number};
    if (place < its.lowest - past_range) return End{Why::OutOfRange, number, place, its.lowest};
    if (place > its.highest + past_range) return End{Why::OutOfRange, number, place, its.highest};
    if (std::abs(place - here) > most_apart) return End{Why::TooFar, number, std::abs(place - here), most_apart};
  }
  const double most = past_velocity * its.motion.velocity;
  if (std::abs(velocity) > most) return End{Why::TooFast, number, std::abs(velocity), most};
  return std::nullopt;
}

}  // namespace hirosco::robot_arm
