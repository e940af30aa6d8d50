// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "robotics/urdf/robot.hpp"
#include "subsystems/robot_arm/control/bounds.hpp"
#include "subsystems/robot_arm/floating/floating_arm.hpp"

/// What an arm on a base that floats is told by its URDF file and its descriptor.
namespace hirosco {
namespace {

constexpr std::string_view device_name = "ARM";
constexpr std::string_view model_setting = "MODEL_FILE";
constexpr std::string_view tip_setting = "TIP";
constexpr std::string_view hold_configuration = "ATTITUDE_HOLD";

}  // namespace

Result<Step> FloatingArm::software_init() {
  publish_all();
  use_device(device_name, device_, {model_setting, tip_setting});
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
  HIROSCO_TRY_LET(const std::string named, descriptor::setting_of_all(own_descriptor(), device_name, model_setting));
  HIROSCO_TRY_LET(std::string tip, descriptor::setting_of_all(own_descriptor(), device_name, tip_setting));
  if (named.empty()) return fail(ErrorCode::NotFound, "no configuration names a URDF file: setting MODEL_FILE of ARM");
  const auto file = descriptor::file_of(own_descriptor(), named);
  const auto reading = robotics::urdf::read(file, descriptor::file_system());
  if (!reading.value) {
    const auto& first = reading.problems.front();
    problem_ = fmt::format("{}:{}:{}: {}: {}", file.filename().string(), first.at.line, first.at.column, first.code,
                           first.message);
    return fail(ErrorCode::Malformed, problem_.c_str(), static_cast<std::int64_t>(reading.problems.size()));
  }
  auto made = robotics::Model::make(robotics::urdf::describe(*reading.value));
  if (!made) return fail(made.error());
  model_ = std::move(*made);
  const auto tips = robotics::urdf::tips(*reading.value);
  if (tip.empty()) {
    if (tips.size() != 1)
      return fail(ErrorCode::InvalidArgument, "the robot has several ends: setting TIP of ARM names the link",
                  static_cast<std::int64_t>(tips.size()));
    tip = tips.front();
  }
  const auto found = model_->find_frame(tip);
  if (!found) {
    problem_ = fmt::format("TIP of ARM: the robot has no link '{}'", tip);
    return fail(ErrorCode::NotFound, problem_.c_str());
  }
  tip_ = *found;
  return take_bounds();
}

Result<> FloatingArm::take_bounds() {
  auto bounds = robot_arm::bounds_of(*model_);
  if (!bounds) {
    problem_ = std::move(bounds.error());
    return fail(ErrorCode::InvalidArgument, problem_.c_str());
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
  base_position_.setZero();
  base_orientation_.setIdentity();
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
