// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/urdf_arm.hpp"

#include <fmt/format.h>

#include <utility>

#include "subsystems/robot_arm/control/bounds.hpp"

namespace hirosco::robot_arm {

Result<UrdfArm::Source> UrdfArm::read(const descriptor::SubsystemDescriptor& subsystem) {
  auto named = robotics::urdf::read_named(subsystem, device);
  if (!named) return (not_read_ = std::move(named.error())).error();
  const auto tip = robotics::urdf::named_tip(subsystem, device, *named);
  if (!tip) return (not_read_ = tip.error()).error();
  // What is somebody else's stands at 0 in the model: whatever it carried would be controlled for a place where it is not.
  if (const auto carried = robotics::urdf::carried_by(named->robot, named->led, named->model.frame(*tip).name)) {
    not_read_ = {
        ErrorCode::InvalidArgument,
        fmt::format("{} of {}: joint '{}' carries {}, which is the arm's: name joints behind the tip alone",
                    robotics::urdf::fixed_setting, device, named->robot.joints[carried->by].name, carried->what)};
    return not_read_.error();
  }
  tip_ = *tip;
  model_ = std::move(named->model);
  return Source{std::move(named->file), std::move(named->text), std::move(named->standing)};
}

Result<> UrdfArm::take_bounds() {
  auto bounds = bounds_of(*model_);
  if (!bounds) {
    not_read_ = {ErrorCode::InvalidArgument, std::move(bounds.error())};
    return not_read_.error();
  }
  bounds_ = std::move(*bounds);
  return ok();
}

void UrdfArm::limit_motions(double acceleration, double jerk) noexcept {
  for (auto& bounds : bounds_) {
    bounds.motion.acceleration = acceleration;
    bounds.motion.jerk = jerk;
  }
}

void UrdfArm::limit_motions_by_velocity(double span_s, double ramp_share) noexcept {
  for (auto& bounds : bounds_) {
    bounds.motion.acceleration = bounds.motion.velocity / span_s;
    bounds.motion.jerk = bounds.motion.acceleration / (ramp_share * span_s);
  }
}

}  // namespace hirosco::robot_arm
