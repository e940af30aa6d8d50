// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

/// Which described joint moves a link, and where the link stands in that joint's frame.
struct Standing {
  std::optional<std::size_t> joint;
  Pose pose;
};

[[nodiscard]] JointDescription described(const Joint& joint) {
  JointDescription result;
  result.name = joint.name;
  result.kind = joint.type == JointType::Prismatic ? JointKind::Prismatic : JointKind::Revolute;
  result.axis = joint.axis;
  result.damping = joint.damping;
  result.friction = joint.friction;
  result.limits = joint.limits;
  return result;
}

}  // namespace

ModelDescription describe(const Robot& robot) {
  ModelDescription description;
  // Joints that move keep the order of the file.
  std::vector<std::size_t> index(robot.joints.size(), 0);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    if (robot.joints[i].type == JointType::Fixed) continue;
    index[i] = description.joints.size();
    description.joints.push_back(described(robot.joints[i]));
  }
  std::vector<std::vector<std::size_t>> below(robot.links.size());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) below[robot.joints[i].parent].push_back(i);
  std::vector<Standing> standing(robot.links.size());
  std::vector<std::size_t> reached{robot.root};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::size_t link = reached[next];
    const Standing here = standing[link];
    if (const auto& inertia = robot.links[link].inertia) {
      Inertia& body = here.joint ? description.joints[*here.joint].moved : description.base;
      body = body + moved(here.pose, *inertia);
    }
    for (const std::size_t i : below[link]) {
      const Joint& joint = robot.joints[i];
      reached.push_back(joint.child);
      const Pose origin = here.pose * joint.origin;
      if (joint.type == JointType::Fixed) {
        standing[joint.child] = {here.joint, origin};
        continue;
      }
      JointDescription& moving = description.joints[index[i]];
      moving.parent = here.joint;
      moving.placement = origin;
      if (joint.mimic) moving.mimic = Mimic{index[joint.mimic->joint], joint.mimic->multiplier, joint.mimic->offset};
      standing[joint.child] = {index[i], {}};
    }
  }
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    description.frames.push_back({robot.links[i].name, standing[i].joint, standing[i].pose});
  return description;
}

std::vector<std::string> tips(const Robot& robot) {
  std::vector<bool> carries(robot.links.size(), false);
  for (const Joint& joint : robot.joints) carries[joint.parent] = true;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    if (!carries[i]) names.push_back(robot.links[i].name);
  return names;
}

}  // namespace hirosco::robotics::urdf
