// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/urdf_fingers.hpp"

#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "robotics/dynamics/dynamics.hpp"

namespace hirosco::robot_gripper {

Result<> UrdfFingers::read(const descriptor::SubsystemDescriptor& subsystem) {
  HIROSCO_TRY_LET(const std::string fingers, descriptor::setting_of_all(subsystem, device, fingers_setting));
  HIROSCO_TRY_LET(const std::string closed, descriptor::setting_of_all(subsystem, device, closed_setting));
  if (!closed.empty() && closed != "lower" && closed != "upper")
    return refuse(ErrorCode::InvalidArgument,
                  fmt::format("CLOSED of GRIPPER is '{}', and fingers are closed at 'lower' or 'upper'", closed));
  closed_is_upper_ = closed == "upper";
  auto named = robotics::urdf::read_named(subsystem, device);
  if (!named) return (not_read_ = std::move(named.error())).error();
  model_ = std::move(named->model);
  return find(robotics::urdf::listed_names(fingers));
}

std::unexpected<Error> UrdfFingers::refuse(ErrorCode code, std::string why) {
  not_read_ = {code, std::move(why)};
  return not_read_.error();
}

/// In the order of the file, whatever the order of the names. What a finger must have is asked for by name.
Result<> UrdfFingers::find(std::vector<std::string> wanted) {
  const bool all = wanted.empty();
  joints_.clear();
  for (std::size_t i = 0; i < model_->joints().size(); ++i) {
    const auto& joint = model_->joints()[i];
    if (!all && std::erase(wanted, joint.name) == 0) continue;
    const auto& limits = joint.limits;
    if (!limits.lower || !limits.upper || !(*limits.upper > *limits.lower) || !limits.effort || !(*limits.effort > 0) ||
        !limits.velocity || !(*limits.velocity > 0))
      return refuse(
          ErrorCode::InvalidArgument,
          fmt::format("finger joint '{}' has no range, effort and velocity above 0, and all are kept", joint.name));
    joints_.push_back(i);
  }
  if (!wanted.empty())
    return refuse(ErrorCode::NotFound,
                  fmt::format("FINGERS of GRIPPER: the file has no joint '{}' that moves by itself", wanted.front()));
  if (joints_.size() > max_fingers)
    return fail(ErrorCode::OutOfRange, "more joints than fingers are driven by: setting FINGERS of GRIPPER names them",
                static_cast<std::int64_t>(joints_.size()));
  return ok();
}

/// Masses are those of the file with all joints in the middle of their ranges.
Result<> UrdfFingers::reckon(const Joints& rotor_inertia, double full_width_m) {
  robotics::Dynamics dynamics{*model_, robotics::Base::Fixed};
  robotics::State state;
  state.q = state.qd = robotics::JointVector::Zero(model_->joint_count());
  for (const std::size_t joint : joints_) {
    const auto& limits = model_->joints()[joint].limits;
    state.q[static_cast<Eigen::Index>(joint)] = (*limits.lower + *limits.upper) / 2;
  }
  dynamics.update(state);
  robotics::MassMatrix mass;
  dynamics.mass_matrix(mass);
  links_moved_ = Joints::zeros(joints_.size());
  std::vector<Finger> fingers;
  double travel_m = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const std::size_t joint = joints_[i];
    const auto row = static_cast<Eigen::Index>(joint);
    const auto& its = model_->joints()[joint];
    const double lower = *its.limits.lower, upper = *its.limits.upper;
    fingers.push_back({.closed = closed_is_upper_ ? upper : lower,
                       .open = closed_is_upper_ ? lower : upper,
                       .effort = *its.limits.effort,
                       .velocity = *its.limits.velocity,
                       .moved = mass(row, row) + rotor_inertia[i],
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
  if (!(full_width_m > 0) && !std::isfinite(travel_m))
    return fail(ErrorCode::InvalidArgument, "FULL_WIDTH is 0, and fingers that turn do not tell how far they open");
  fingers_ = {fingers, full_width_m > 0 ? full_width_m : travel_m};
  return ok();
}

Result<> UrdfFingers::take_rotors(const Joints& rotor_inertia) noexcept {
  std::array<Finger, max_fingers> fingers;
  for (std::size_t i = 0; i < fingers_.count(); ++i) {
    fingers[i] = fingers_[i];
    fingers[i].moved = links_moved_[i] + rotor_inertia[i];
    if (!(fingers[i].moved > 0))
      return fail(ErrorCode::InvalidArgument, "moves nothing that has mass: ROTOR_INERTIA of finger joint",
                  static_cast<std::int64_t>(i + 1));
  }
  fingers_ = {std::span{fingers}.first(fingers_.count()), fingers_.full_width_m()};
  return ok();
}

}  // namespace hirosco::robot_gripper
