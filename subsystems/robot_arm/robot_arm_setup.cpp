// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "robotics/shapes/collision.hpp"
#include "subsystems/robot_arm/control/bounds.hpp"
#include "subsystems/robot_arm/robot_arm.hpp"

/// What an arm is told by its URDF file and its descriptor, and how it tries itself.
namespace hirosco {

using robot_arm::JointVector;

namespace {

constexpr std::string_view device_name = "ARM";
/// Of the filter of what acts from outside.
constexpr double observer_gain_per_s = 50;

constexpr double rest_rad_s = 0.02;
constexpr double past_end = 0.05;
constexpr double displacement = 0.01;

}  // namespace

Result<Step> RobotArm::software_init() {
  publish_all();
  using namespace robotics::urdf;
  use_device(device_name, device_, {model_setting, tip_setting, fixed_setting});
  for (EventPort* event : std::initializer_list<EventPort*>{&motion_done_, &position_exceeded_, &speed_exceeded_,
                                                            &torque_exceeded_, &torque_hard_exceeded_,
                                                            &following_exceeded_, &contact_, &retracted_, &too_near_})
    use_event(*event);
  HIROSCO_TRY(read_model());
  bind_functions();
  return done;
}

void RobotArm::publish_all() {
  publish("CUR_VALUES", current_);
  publish("DES_POSITION", desired_position_);
  publish("DES_VELOCITY", desired_velocity_);
  publish("EXTERNAL_TORQUE", external_torque_);
  publish("TOOL", tool_values_);
  publish("TOOL_PLACE", tool_place_m_);
  publish("MOTION", motion_values_);
  publish("PAYLOAD", payload_values_);
  publish("CONTACT_WATCH", contact_values_);
  publish("GRAVITY", gravity_m_s2_);
  publish("ROTOR_INERTIA", rotor_inertia_);
  publish("BANDWIDTH", bandwidth_rad_s_);
  publish("ACCELERATION", acceleration_);
  publish("JERK", jerk_);
  publish("GOAL_TOLERANCE", goal_tolerance_);
  publish("TORQUE_LIMIT", torque_limit_);
  publish("TORQUE_HARD", torque_hard_);
  publish("SPEED_LIMIT", speed_limit_);
  publish("FOLLOWING_LIMIT", following_limit_);
  publish("CLEARANCE_LIMIT", clearance_limit_m_);
  publish("CLEARANCE", clearance_m_);
  publish("KEPT_OUT", keep_out_);
  publish("LAW", law_values_);
  publish("JOINT_STIFFNESS", joint_stiffness_);
  publish("FLOAT_DAMPING", float_damping_);
  publish("RETRACT_DISTANCE", retract_distance_);
  publish("ACTIVE", active_);
}

Result<> RobotArm::read_model() {
  auto named = robotics::urdf::read_named(own_descriptor(), device_name);
  if (!named) return (not_read_ = std::move(named.error())).error();
  const auto tip = robotics::urdf::named_tip(own_descriptor(), device_name, *named);
  if (!tip) return (not_read_ = tip.error()).error();
  tip_ = *tip;
  model_ = std::move(named->model);
  HIROSCO_TRY(read_shapes(named->file, named->text));
  return take_bounds();
}

/// Meshes beside the file, too. Of what is wrong in them the first is told; what is not seen, to whoever reads standard error.
Result<> RobotArm::read_shapes(const std::filesystem::path& file, std::string_view text) {
  auto reading = robotics::read_collision_shapes(file, text, descriptor::file_system());
  const auto said = [](const descriptor::Diagnostic& its) {
    return fmt::format("{}:{}:{}: {}: {}", its.file.filename().string(), its.at.line, its.at.column, its.code,
                       its.message);
  };
  for (const auto& warning : reading.warnings) fmt::print(stderr, "{}\n", said(warning));
  if (!reading.value) {
    not_read_ = {ErrorCode::Malformed, said(reading.problems.front()),
                 static_cast<std::int64_t>(reading.problems.size())};
    return not_read_.error();
  }
  clearance_.emplace(*model_, reading.value->hulls);
  return ok();
}

/// Limits of the URDF file; those that a joint must have are asked for by name.
Result<> RobotArm::take_bounds() {
  auto bounds = robot_arm::bounds_of(*model_);
  if (!bounds) {
    not_read_ = {ErrorCode::InvalidArgument, std::move(bounds.error())};
    return not_read_.error();
  }
  bounds_ = std::move(*bounds);
  return ok();
}

Result<> RobotArm::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(check_lengths());
  cycle_s_ = seconds(configuration.sampling);
  for (auto& bounds : bounds_) {
    bounds.motion.acceleration = acceleration_.load();
    bounds.motion.jerk = jerk_.load();
  }
  const int joints = model_->joint_count();
  dynamics_.emplace(*model_, robotics::Base::Fixed);
  laws_.emplace(*model_, tip_, cycle_s_);
  observer_.emplace(joints, cycle_s_, observer_gain_per_s);
  setpoints_.emplace(*model_, tip_, bounds_, cycle_s_);
  static_cast<void>(keep_out(keep_out_.load()));
  const auto place = tool_place_m_.load();
  setpoints_->set_tool({robotics::Matrix3::Identity(), {place[0], place[1], place[2]}});
  laws_->set_tool({place[0], place[1], place[2]});
  watch_.arm();
  forget_motion();
  retracting_ = false;
  jog_left_s_ = 0;
  return ok();
}

/// What is a number for each joint has as many as the URDF file has joints.
Result<> RobotArm::check_lengths() noexcept {
  const auto current = current_.load();
  const auto arguments_of = [&](std::string_view name) -> std::size_t {
    const descriptor::Function* function = own_descriptor().find_function(name);
    std::size_t numbers = 0;
    if (function != nullptr)
      for (const auto& argument : function->arguments) numbers += argument.field.count;
    return numbers;
  };
  struct Length {
    std::size_t of;
    std::size_t wanted;
    const char* text;
  };
  const std::size_t joints = bounds_.size();
  const bool by_joint = own_descriptor().find_function("IMPEDANCE_J") != nullptr;
  const std::array lengths{
      Length{current.position.size(), joints, "CUR_VALUES.POSITION has another length than the robot has joints"},
      Length{current.velocity.size(), joints, "CUR_VALUES.VELOCITY has another length than the robot has joints"},
      Length{current.torque.size(), joints, "CUR_VALUES.TORQUE has another length than the robot has joints"},
      Length{desired_position_.load().size(), joints, "DES_POSITION has another length than the robot has joints"},
      Length{desired_velocity_.load().size(), joints, "DES_VELOCITY has another length than the robot has joints"},
      Length{rotor_inertia_.load().size(), joints, "ROTOR_INERTIA has another length than the robot has joints"},
      Length{joint_stiffness_.load().size(), joints, "JOINT_STIFFNESS has another length than the robot has joints"},
      Length{external_torque_.load().size(), joints, "EXTERNAL_TORQUE has another length than the robot has joints"},
      Length{device_.input().position.size(), joints, "ARM's POSITION has another length than the robot has joints"},
      Length{device_.input().velocity.size(), joints, "ARM's VELOCITY has another length than the robot has joints"},
      Length{device_.input().torque.size(), joints, "ARM's TORQUE has another length than the robot has joints"},
      Length{device_.output().torque.size(), joints,
             "ARM's output TORQUE has another length than the robot has joints"},
      Length{arguments_of("MOVE_J"), joints + 1, "MOVE_J takes a number for each joint, and SPEED"},
      Length{arguments_of("JOG_J"), joints + 1, "JOG_J takes a number for each joint, and SECONDS"},
      Length{by_joint ? arguments_of("IMPEDANCE_J") : joints + 1, joints + 1,
             "IMPEDANCE_J takes a number for each joint, and DAMPING"},
      Length{arguments_of("MOVE_L"), 9, "MOVE_L takes POSITION[3], ORIENTATION[4], SPEED, TURNING"},
      Length{arguments_of("JOG_L"), 7, "JOG_L takes LINEAR[3], ANGULAR[3], SECONDS"},
  };
  for (const Length& length : lengths)
    if (length.of != length.wanted) return fail(ErrorCode::Mismatch, length.text, static_cast<std::int64_t>(length.of));
  return ok();
}

// --- self test ---------------------------------------------------------------------------------------------------------

/// The sensors at rest, then a small deviation of each joint to each side, which the law has to answer against.
Result<Step> RobotArm::self_test(const Cycle& cycle) noexcept {
  if (cycle.first) {
    tried_ = 0;
    HIROSCO_TRY(check_sensors());
  }
  const auto checked = check_law(tried_ / 2, tried_ % 2 == 0 ? 1.0 : -1.0);
  engage();
  if (!checked) return fail(checked.error());
  return ++tried_ < 2 * bounds_.size() ? again : done;
}

Result<> RobotArm::check_sensors() noexcept {
  if (!device_.alive()) return fail(ErrorCode::Unavailable, "the arm says nothing");
  for (std::size_t joint = 0; joint < bounds_.size(); ++joint) {
    const auto i = static_cast<Eigen::Index>(joint);
    const auto number = static_cast<std::int64_t>(joint + 1);
    // Written so that what is no number fails.
    if (!(std::abs(measured_.velocity[i]) < rest_rad_s))
      return fail(ErrorCode::Internal, "it moves though nothing drives it, joint", number);
    if (!(measured_.position[i] > bounds_[joint].lowest - past_end &&
          measured_.position[i] < bounds_[joint].highest + past_end))
      return fail(ErrorCode::Internal, "measured outside of its range, joint", number);
    if (!(std::abs(measured_.torque[i]) < torque_limit_.load() * bounds_[joint].effort))
      return fail(ErrorCode::Internal, "its load at rest is above its limit, joint", number);
  }
  return ok();
}

Result<> RobotArm::check_law(std::size_t joint, double side) noexcept {
  const auto i = static_cast<Eigen::Index>(joint);
  setpoints_->rest(measured_.position);
  const auto answer = [&](double deviation) {
    laws_->reset();
    JointVector deviated = measured_.position;
    deviated[i] += deviation;
    setpoints_->rest(deviated);
    control();
    return device_.output().torque[joint];
  };
  const double at_rest = answer(0);
  if (!(side * (answer(side * displacement) - at_rest) > 0))
    return fail(ErrorCode::Internal, "driven away from its setpoint, joint", static_cast<std::int64_t>(joint + 1));
  return ok();
}

}  // namespace hirosco
