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

[[nodiscard]] bool among(std::span<const std::size_t> joints, std::size_t joint) {
  return std::ranges::find(joints, joint) != joints.end();
}

}  // namespace

std::vector<std::size_t> led_by(const Robot& robot, std::span<const std::string> names) {
  std::vector<std::size_t> led;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const std::string& leader = joint.mimic ? robot.joints[joint.mimic->joint].name : joint.name;
    if (std::ranges::find(names, leader) != names.end()) led.push_back(i);
  }
  return led;
}

std::optional<Carried> carried_by(const Robot& robot, std::span<const std::size_t> standing, std::string_view link) {
  std::vector<std::size_t> above(robot.links.size(), robot.joints.size());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) above[robot.joints[i].child] = i;
  // The robot is a tree: each way up ends at its root.
  const auto carrier_of = [&](std::size_t from) -> std::optional<std::size_t> {
    for (std::size_t joint = above[from]; joint < robot.joints.size(); joint = above[robot.joints[joint].parent])
      if (among(standing, joint)) return joint;
    return std::nullopt;
  };
  const auto named = std::ranges::find(robot.links, link, &Link::name);
  if (named != robot.links.end())
    if (const auto by = carrier_of(static_cast<std::size_t>(named - robot.links.begin())))
      return Carried{*by, "link '" + named->name + "'"};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    if (joint.type == JointType::Fixed || among(standing, i)) continue;
    if (const auto by = carrier_of(joint.parent)) return Carried{*by, "joint '" + joint.name + "'"};
  }
  return std::nullopt;
}

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
