// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "robotics/dynamics/dynamics.hpp"
#include "subsystems/robot_gripper/robot_gripper.hpp"

/// What a gripper is told by its URDF file and its descriptor, and how it tries itself.
namespace hirosco {

using robot_gripper::Finger;
using robot_gripper::Fingers;

namespace {

constexpr std::string_view device_name = "GRIPPER";
/// Names of the joints that drive fingers, with commas between them; none: all that the file has.
constexpr std::string_view fingers_setting = "FINGERS";
/// At which end of their ranges the fingers are closed: lower, or upper.
constexpr std::string_view closed_setting = "CLOSED";

constexpr double still_m_s = 0.002;
constexpr double displacement_m = 0.0005;

}  // namespace

Result<Step> RobotGripper::software_init() {
  publish_all();
  use_device(device_name, device_, {robotics::urdf::model_setting, fingers_setting, closed_setting});
  for (EventPort* event :
       std::initializer_list<EventPort*>{&motion_done_, &held_told_, &lost_told_, &released_, &nothing_met_,
                                         &position_exceeded_, &speed_exceeded_, &force_exceeded_})
    use_event(*event);
  HIROSCO_TRY(read_model());
  bind_functions();
  return done;
}

void RobotGripper::publish_all() {
  publish("CUR_VALUES", current_);
  publish("GAP", gap_values_);
  publish("ROTOR_INERTIA", rotor_inertia_);
  publish("FULL_WIDTH", full_width_m_);
  publish("EMPTY_WIDTH", empty_width_m_);
  publish("LOST_DISTANCE", lost_distance_m_);
  publish("WIDTH_TOLERANCE", width_tolerance_m_);
  publish("FOLLOWING_LIMIT", following_limit_m_);
  publish("FORCE_TOLERANCE", force_tolerance_);
  publish("FELT_FORCE", felt_force_n_);
  publish("MOVE_FORCE", move_force_n_);
  publish("FORCE_HARD", force_hard_);
  publish("SPEED_LIMIT", speed_limit_);
  publish("BANDWIDTH", bandwidth_rad_s_);
  publish("ACCELERATION", acceleration_);
  publish("JERK", jerk_);
  publish("ACTIVE", active_);
}

Result<> RobotGripper::read_model() {
  HIROSCO_TRY_LET(const std::string fingers,
                  descriptor::setting_of_all(own_descriptor(), device_name, fingers_setting));
  HIROSCO_TRY_LET(const std::string closed, descriptor::setting_of_all(own_descriptor(), device_name, closed_setting));
  if (!closed.empty() && closed != "lower" && closed != "upper")
    return refuse(ErrorCode::InvalidArgument,
                  fmt::format("CLOSED of GRIPPER is '{}', and fingers are closed at 'lower' or 'upper'", closed));
  closed_is_upper_ = closed == "upper";
  auto named = robotics::urdf::read_named(own_descriptor(), device_name);
  if (!named) return (not_read_ = std::move(named.error())).error();
  model_ = std::move(named->model);
  return find_fingers(robotics::urdf::listed_names(fingers));
}

std::unexpected<Error> RobotGripper::refuse(ErrorCode code, std::string why) {
  not_read_ = {code, std::move(why)};
  return not_read_.error();
}

/// In the order of the file, whatever the order of the names. What a finger must have is asked for by name.
Result<> RobotGripper::find_fingers(std::vector<std::string> wanted) {
  const bool all = wanted.empty();
  finger_joints_.clear();
  for (std::size_t i = 0; i < model_->joints().size(); ++i) {
    const auto& joint = model_->joints()[i];
    if (!all && std::erase(wanted, joint.name) == 0) continue;
    const auto& limits = joint.limits;
    if (!limits.lower || !limits.upper || !(*limits.upper > *limits.lower) || !limits.effort || !(*limits.effort > 0) ||
        !limits.velocity || !(*limits.velocity > 0))
      return refuse(
          ErrorCode::InvalidArgument,
          fmt::format("finger joint '{}' has no range, effort and velocity above 0, and all are kept", joint.name));
    finger_joints_.push_back(i);
  }
  if (!wanted.empty())
    return refuse(ErrorCode::NotFound,
                  fmt::format("FINGERS of GRIPPER: the file has no joint '{}' that moves by itself", wanted.front()));
  if (finger_joints_.size() > robot_gripper::max_fingers)
    return fail(ErrorCode::OutOfRange, "more joints than fingers are driven by: setting FINGERS of GRIPPER names them",
                static_cast<std::int64_t>(finger_joints_.size()));
  return ok();
}

/// Masses are those of the file with all joints in the middle of their ranges.
Result<Fingers> RobotGripper::fingers_now() {
  robotics::Dynamics dynamics{*model_, robotics::Base::Fixed};
  robotics::State state;
  state.q = state.qd = robotics::JointVector::Zero(model_->joint_count());
  for (const std::size_t joint : finger_joints_) {
    const auto& limits = model_->joints()[joint].limits;
    state.q[static_cast<Eigen::Index>(joint)] = (*limits.lower + *limits.upper) / 2;
  }
  dynamics.update(state);
  robotics::MassMatrix mass;
  dynamics.mass_matrix(mass);
  const auto rotor = rotor_inertia_.load();
  links_moved_ = Joints::zeros(finger_joints_.size());
  std::vector<Finger> fingers;
  double travel_m = 0;
  for (std::size_t i = 0; i < finger_joints_.size(); ++i) {
    const std::size_t joint = finger_joints_[i];
    const auto row = static_cast<Eigen::Index>(joint);
    const auto& its = model_->joints()[joint];
    const double lower = *its.limits.lower, upper = *its.limits.upper;
    fingers.push_back({.closed = closed_is_upper_ ? upper : lower,
                       .open = closed_is_upper_ ? lower : upper,
                       .effort = *its.limits.effort,
                       .velocity = *its.limits.velocity,
                       .moved = mass(row, row) + rotor[i],
                       .friction = its.friction});
    if (!(fingers.back().moved > 0))
      return refuse(ErrorCode::InvalidArgument,
                    fmt::format("finger joint '{}' moves nothing that has mass: ROTOR_INERTIA", its.name));
    links_moved_[i] = mass(row, row);
    if (its.kind != robotics::JointKind::Prismatic) travel_m = HUGE_VAL;
    for (const auto& body : model_->bodies())
      if (&body != &model_->bodies().front() && body.coordinate == static_cast<int>(joint))
        travel_m += std::abs(body.multiplier) * (upper - lower);
  }
  const double said_m = full_width_m_.load();
  if (!(said_m > 0) && !std::isfinite(travel_m))
    return fail(ErrorCode::InvalidArgument, "FULL_WIDTH is 0, and fingers that turn do not tell how far they open");
  return Fingers{fingers, said_m > 0 ? said_m : travel_m};
}

Result<> RobotGripper::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(check_lengths());
  cycle_s_ = seconds(configuration.sampling);
  HIROSCO_TRY_LET(fingers_, fingers_now());
  HIROSCO_TRY(take_values());
  held_ = {};
  watch_.arm();
  forget_motion();
  return ok();
}

/// Those that may be written in Pre-Operational after CONFIGURE as well as before.
Result<> RobotGripper::take_values() noexcept {
  const auto rotor = rotor_inertia_.load();
  std::array<Finger, robot_gripper::max_fingers> fingers;
  for (std::size_t i = 0; i < fingers_.count(); ++i) {
    fingers[i] = fingers_[i];
    fingers[i].moved = links_moved_[i] + rotor[i];
    if (!(fingers[i].moved > 0))
      return fail(ErrorCode::InvalidArgument, "moves nothing that has mass: ROTOR_INERTIA of finger joint",
                  static_cast<std::int64_t>(i + 1));
  }
  fingers_ = {std::span{fingers}.first(fingers_.count()), fingers_.full_width_m()};
  opening_ = {acceleration_.load(), jerk_.load(), cycle_s_};
  grip_ = {fingers_,
           {.bandwidth_rad_s = bandwidth_rad_s_.load(),
            .width_force_n = std::min(move_force_n_.load(), fingers_.most_force_n()),
            .acceleration_m_s2 = acceleration_.load(),
            .cycle_s = cycle_s_}};
  grip_.set_tolerance(force_tolerance_.load());
  return ok();
}

/// What is a number for each joint has as many as there are finger joints.
Result<> RobotGripper::check_lengths() noexcept {
  struct Length {
    std::size_t of;
    const char* text;
  };
  const auto current = current_.load();
  for (const Length& length :
       {Length{current.position.size(), "CUR_VALUES.POSITION has another length than there are finger joints"},
        Length{current.velocity.size(), "CUR_VALUES.VELOCITY has another length than there are finger joints"},
        Length{current.torque.size(), "CUR_VALUES.TORQUE has another length than there are finger joints"},
        Length{rotor_inertia_.load().size(), "ROTOR_INERTIA has another length than there are finger joints"},
        Length{device_.input().position.size(), "GRIPPER's POSITION has another length than there are finger joints"},
        Length{device_.input().velocity.size(), "GRIPPER's VELOCITY has another length than there are finger joints"},
        Length{device_.input().torque.size(), "GRIPPER's TORQUE has another length than there are finger joints"},
        Length{device_.output().torque.size(),
               "GRIPPER's output TORQUE has another length than there are finger joints"}})
    if (length.of != finger_joints_.size())
      return fail(ErrorCode::Mismatch, length.text, static_cast<std::int64_t>(length.of));
  return ok();
}

// --- self test -----------------------------------------------------------------------------------------------------------

/// The sensors at rest, then a small deviation to each side, which the law has to answer against. What is held stays held: nothing is put out.
Result<Step> RobotGripper::self_test(const Cycle& cycle) noexcept {
  if (cycle.first) {
    tried_ = 0;
    HIROSCO_TRY(check_sensors());
  }
  const auto checked = check_law(tried_ == 0 ? 1.0 : -1.0);
  engage();
  if (!checked) return fail(checked.error());
  return ++tried_ < 2 ? again : done;
}

Result<> RobotGripper::check_sensors() noexcept {
  if (!device_.alive()) return fail(ErrorCode::Unavailable, "the gripper says nothing");
  // Written so that what is no number fails.
  if (!(std::abs(speed_m_s_) < still_m_s)) return fail(ErrorCode::Internal, "it moves though nothing drives it");
  for (std::size_t i = 0; i < fingers_.count(); ++i) {
    const Finger& its = fingers_[i];
    const double past = 0.05 * (its.highest() - its.lowest());
    if (!(measured_.position[i] > its.lowest() - past && measured_.position[i] < its.highest() + past))
      return fail(ErrorCode::Internal, "measured outside of its range, joint", static_cast<std::int64_t>(i + 1));
    if (!(std::abs(measured_.torque[i]) < force_hard_.load() * its.effort))
      return fail(ErrorCode::Internal, "its load at rest is above its limit, joint", static_cast<std::int64_t>(i + 1));
  }
  return ok();
}

Result<> RobotGripper::check_law(double side) noexcept {
  const auto answer_n = [&](double deviation_m) {
    opening_.rest(width_m_ + deviation_m);
    grip_.keep();
    control();
    return -fingers_.force(device_.output().torque);
  };
  const double at_rest_n = answer_n(0);
  if (!(side * (answer_n(side * displacement_m) - at_rest_n) > 0))
    return fail(ErrorCode::Internal, "driven away from its setpoint");
  return ok();
}

}  // namespace hirosco
