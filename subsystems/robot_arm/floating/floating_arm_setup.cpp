// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "subsystems/robot_arm/control/bounds.hpp"
#include "subsystems/robot_arm/floating/floating_arm.hpp"

/// What an arm on a base that floats is told by its URDF file and its descriptor.
namespace hirosco {
namespace {

constexpr std::string_view device_name = "ARM";
constexpr std::string_view hold_configuration = "ATTITUDE_HOLD";

}  // namespace

Result<Step> FloatingArm::software_init() {
  publish_all();
  use_device(device_name, device_, {robotics::urdf::model_setting, robotics::urdf::tip_setting});
  require_link("POSE", pose_);
  for (EventPort* event : std::initializer_list<EventPort*>{&motion_done_, &conditioning_low_, &base_held_,
                                                            &limit_exceeded_, &hard_exceeded_})
    use_event(*event);
  HIROSCO_TRY(read_model());
  bind_functions();
  return done;
}

void FloatingArm::publish_all() {
  publish("CUR", current_);
  publish("TOOL", tool_values_);
  publish("ERR", error_values_);
  publish("BASE_PRED", base_values_);
  publish("SIGMA_MIN", conditioning_);
  publish("PHASE", phase_values_);
  publish("PROGRESS", progress_);
  publish("LIMITS", limits_);
  publish("TOOL_SPEED", tool_speed_m_s_);
  publish("GOAL_TOLERANCE", goal_tolerance_m_);
  publish("DES_VELOCITY", desired_velocity_);
  publish("ACTIVE", active_);
}

Result<> FloatingArm::read_model() {
  auto named = robotics::urdf::read_named(own_descriptor(), device_name);
  if (!named) return (not_read_ = std::move(named.error())).error();
  const auto tip = robotics::urdf::named_tip(own_descriptor(), device_name, *named);
  if (!tip) return (not_read_ = tip.error()).error();
  tip_ = *tip;
  model_ = std::move(named->model);
  return take_bounds();
}

Result<> FloatingArm::take_bounds() {
  auto bounds = robot_arm::bounds_of(*model_);
  if (!bounds) {
    not_read_ = {ErrorCode::InvalidArgument, std::move(bounds.error())};
    return not_read_.error();
  }
  bounds_ = std::move(*bounds);
  return ok();
}

/// Who requires the pose of the base tracks by it, and by the name of the configuration leaves the base unturned.
Result<> FloatingArm::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(check_lengths());
  cycle_s_ = seconds(configuration.sampling);
  using robot_arm::ToolLaw;
  law_ = configuration.requires_.empty()            ? ToolLaw::FixedBase
         : configuration.name == hold_configuration ? ToolLaw::AttitudeHold
                                                    : ToolLaw::InertialTrack;
  floating_.emplace(*model_, tip_);
  watch_.arm();
  motion_.reset();
  base_.stand_still();
  measured_.position = measured_.velocity = measured_.torque = robot_arm::JointVector::Zero(model_->joint_count());
  wanted_rates_ = joints_goal_ = joints_from_ = measured_.position;
  phase_ = Phase::Holds;
  moving_ = braked_ = false;
  progress_.store(0);
  return ok();
}

/// What is a number for each joint has as many as the URDF file has joints.
Result<> FloatingArm::check_lengths() noexcept {
  const auto current = current_.load();
  const descriptor::Function* move = own_descriptor().find_function("MOVE_JOINT");
  std::size_t arguments = 0;
  if (move != nullptr)
    for (const auto& argument : move->arguments) arguments += argument.field.count;
  const std::size_t joints = bounds_.size();
  for (const std::size_t length :
       {current.position.size(), current.velocity.size(), current.torque.size(), desired_velocity_.load().size(),
        device_.input().position.size(), device_.input().velocity.size(), device_.input().torque.size(),
        device_.output().torque.size(), arguments == 0 ? 0 : arguments - 1})
    if (length != joints)
      return fail(ErrorCode::Mismatch,
                  "an array of CUR, DES_VELOCITY, MOVE_JOINT or ARM is not as long as the robot has joints",
                  static_cast<std::int64_t>(length));
  return ok();
}

}  // namespace hirosco
