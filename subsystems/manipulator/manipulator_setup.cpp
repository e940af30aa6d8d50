// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "subsystems/manipulator/manipulator.hpp"

/// What an arm is told by its descriptor: how many joints it has, how far each moves, where home is.
namespace hirosco {

namespace {

constexpr double home_duration_s = 3.0;

}  // namespace

using manipulator::Joints;
static_assert(manipulator::max_joints + 1 <= max_function_arguments, "MOVE_TO names each joint, and the time");

Result<Step> Manipulator::software_init() {
  publish("CUR_VALUES", current_);
  publish("DES_POSITION", desired_position_);
  publish("DES_VELOCITY", desired_velocity_);
  publish("KP", kp_);
  publish("KD", kd_);
  publish("TORQUE_LIMIT", torque_limit_);
  publish("TORQUE_HARD", torque_hard_);
  publish("TEMP_LIMITS", temperature_limits_);
  publish("POS_SCALE", position_scale_);
  publish("CLUTCH", clutch_values_);
  publish("TRAJ", trajectory_values_);
  publish("ACTIVE", active_);
  publish("GOAL_TOLERANCE", goal_tolerance_);
  publish("GAINS", gain_values_);
  // One handle leads at a time: that of the set which the configuration requires.
  for (const auto& set : descriptor::required_sets(own_descriptor())) require_link(set, handle_);
  use_device("ROBOT", robot_);
  use_event(motion_done_);
  use_event(temperature_warning_);
  use_event(temperature_critical_);
  use_event(temperature_maximum_);
  use_event(torque_limit_exceeded_);
  use_event(torque_hard_exceeded_);
  HIROSCO_TRY(take_joints_of_the_descriptor());
  bind_functions();
  declare();
  return done;
}

void Manipulator::bind_functions() {
  on_function("MOVE_TO", [this](const FunctionValues& values, Call call) -> Outcome {
    return move(Joints::of(std::span{values}.first(joints())), values[joints()], call);
  });
  on_function("HOME", [this](Call call) {
    const double shortest_s =
        manipulator::shortest_duration_s(desired_position_.load(), home_rad_, manipulator::path_limits);
    return move(home_rad_, std::max(home_duration_s, shortest_s), call);
  });
  on_function("HOLD", [this]() -> Outcome {
    if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (!moving_) return refused(Trouble::actuators_inhibited);
    stop_motion(pus::FailureCode::Aborted);
    return ok();
  });
  on_function("SET_GAINS", [this](double kp, double kd, Call call) { return set_gains(kp, kd, call); });
  on_function("SET_TORQUE_LIMIT", [this](double limit_n_m) { return set_torque_limit(limit_n_m); });
  on_function("SET_TEMP_LIMITS", [this](double warning_c, double critical_c, double maximum_c) -> Outcome {
    if (!(warning_c < critical_c && critical_c < maximum_c)) return refused(Trouble::limits_not_ordered);
    temperature_limits_.store(
        {static_cast<float>(warning_c), static_cast<float>(critical_c), static_cast<float>(maximum_c)});
    return ok();
  });
}

/// As many joints as DES_POSITION has elements, whose initial value is home; MOVE_TO says how far each moves.
Result<> Manipulator::take_joints_of_the_descriptor() {
  home_rad_ = Joints::zeros(desired_position_.load().size());
  lowest_rad_ = highest_rad_ = home_rad_;
  const auto& parameters = own_descriptor().parameters;
  const auto position = std::ranges::find(parameters, "DES_POSITION", [](const auto& p) { return p.field.name; });
  if (position == parameters.end() || joints() == 0) return ok();  // that is told already
  for (std::size_t i = 0; i < std::min(joints(), position->init.size()); ++i)
    if (const auto* home = std::get_if<Number>(&position->init[i])) home_rad_[i] = home->real();
  const descriptor::Function* move_to = own_descriptor().find_function("MOVE_TO");
  if (move_to == nullptr) return fail(ErrorCode::Mismatch, "an arm has the function MOVE_TO");
  std::size_t numbers = 0;
  for (const auto& argument : move_to->arguments)
    for (std::size_t i = 0; i < argument.field.count; ++i, ++numbers) {
      if (numbers >= joints()) continue;
      lowest_rad_[numbers] = argument.field.minimum.value_or(-HUGE_VAL).real();
      highest_rad_[numbers] = argument.field.maximum.value_or(HUGE_VAL).real();
    }
  if (numbers != joints() + 1)
    return fail(ErrorCode::Mismatch, "MOVE_TO takes a number for each element of DES_POSITION, and the duration",
                static_cast<std::int64_t>(numbers));
  return ok();
}

/// What is a number for each joint is so everywhere.
Result<> Manipulator::check_lengths() noexcept {
  const auto current = current_.load();
  const auto clutch = clutch_values_.load();
  const manipulator::RobotInput& in = robot_.input();
  struct Length {
    std::size_t of;
    const char* text;
  };
  const std::array lengths{
      Length{desired_velocity_.load().size(), "DES_VELOCITY has another length than DES_POSITION"},
      Length{current.position_rad.size(), "CUR_VALUES.POSITION has another length than DES_POSITION"},
      Length{current.velocity_rad_per_s.size(), "CUR_VALUES.VELOCITY has another length than DES_POSITION"},
      Length{current.torque_n_m.size(), "CUR_VALUES.TORQUE has another length than DES_POSITION"},
      Length{current.temperature_deg_c.size(), "CUR_VALUES.TEMPERATURE has another length than DES_POSITION"},
      Length{clutch.robot_rad.size(), "CLUTCH.ROBOT has another length than DES_POSITION"},
      Length{clutch.handle_rad.size(), "CLUTCH.HANDLE has another length than DES_POSITION"},
      Length{trajectory_values_.load().target_rad.size(), "TRAJ.TARGET has another length than DES_POSITION"},
      Length{in.motor_position_rad.size(), "ROBOT's MOTOR_POSITION has another length than DES_POSITION"},
      Length{in.motor_velocity_rad_per_s.size(), "ROBOT's MOTOR_VELOCITY has another length than DES_POSITION"},
      Length{in.position_rad.size(), "ROBOT's POSITION has another length than DES_POSITION"},
      Length{in.velocity_rad_per_s.size(), "ROBOT's VELOCITY has another length than DES_POSITION"},
      Length{in.torque_n_m.size(), "ROBOT's TORQUE has another length than DES_POSITION"},
      Length{in.temperature_deg_c.size(), "ROBOT's TEMPERATURE has another length than DES_POSITION"},
      Length{robot_.output().torque_n_m.size(), "ROBOT's output TORQUE has another length than DES_POSITION"},
      Length{coupled_ ? handle_.value().position_rad.size() : joints(),
             "the required set's POSITION has another length than DES_POSITION"},
  };
  for (const Length& length : lengths)
    if (length.of != joints()) return fail(ErrorCode::Mismatch, length.text, static_cast<std::int64_t>(length.of));
  return ok();
}

}  // namespace hirosco
