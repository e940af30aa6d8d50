// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <Eigen/Geometry>

#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

void stand_at(Joint& joint, double position) {
  const Pose gone = joint.type == JointType::Prismatic
                        ? Pose{Matrix3::Identity(), position * joint.axis}
                        : Pose{Eigen::AngleAxisd{position, joint.axis}.toRotationMatrix(), Vector3::Zero()};
  joint.origin = joint.origin * gone;
  joint.type = JointType::Fixed;
  joint.mimic.reset();
}

}  // namespace

std::optional<std::string> fix(Robot& robot, std::span<const std::string> names) {
  for (const std::string& name : names) {
    const auto found = std::ranges::find(robot.joints, name, &Joint::name);
    if (found == robot.joints.end() || found->type == JointType::Fixed || found->mimic) return name;
  }
  for (const std::string& name : names) {
    const auto index =
        static_cast<std::size_t>(std::ranges::find(robot.joints, name, &Joint::name) - robot.joints.begin());
    // What follows it stands where it would follow it to.
    for (Joint& joint : robot.joints)
      if (joint.mimic && joint.mimic->joint == index) stand_at(joint, joint.mimic->offset);
    if (robot.joints[index].type != JointType::Fixed) stand_at(robot.joints[index], 0);
  }
  return std::nullopt;
}

}  // namespace hirosco::robotics::urdf
