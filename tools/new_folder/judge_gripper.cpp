// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "robotics/dynamics/dynamics.hpp"
#include "tools/new_folder/robot.hpp"

namespace hirosco::tools {

namespace {

constexpr std::size_t most_fingers = 4;

[[nodiscard]] bool drives(const std::vector<std::string>& fingers, const robotics::Model::Joint& joint) {
  return std::ranges::find(fingers, joint.name) != fingers.end();
}

/// How far links of fingers are from each other with all of them at one end of their ranges.
[[nodiscard]] double spread_m(const robotics::urdf::Robot& robot, const robotics::Model& whole,
                              const std::vector<std::string>& fingers, bool upper) {
  robotics::Dynamics dynamics{whole, robotics::Base::Fixed};
  robotics::State state;
  state.q = state.qd = robotics::JointVector::Zero(whole.joint_count());
  for (std::size_t i = 0; i < whole.joints().size(); ++i)
    if (const auto& joint = whole.joints()[i]; drives(fingers, joint))
      state.q[static_cast<Eigen::Index>(i)] = upper ? *joint.limits.upper : *joint.limits.lower;
  dynamics.update(state);
  std::vector<robotics::Vector3> places;
  for (const auto& joint : robot.joints) {
    const std::string& leader = joint.mimic ? robot.joints[joint.mimic->joint].name : joint.name;
    if (std::ranges::find(fingers, leader) == fingers.end()) continue;
    if (const auto frame = whole.find_frame(robot.links[joint.child].name))
      places.push_back(dynamics.frame_pose(*frame).position);
  }
  double spread = 0;
  for (const auto& one : places)
    for (const auto& other : places) spread += (one - other).norm();
  return spread;
}

}  // namespace

std::optional<NewGripper> judge_gripper(
    const robotics::urdf::Robot& robot, const robotics::Model& whole, const std::vector<std::string>& fingers,
    const std::function<void(std::string_view joint, std::string message, std::string hint)>& problem) {
  bool good = true;
  for (const std::string& name : fingers) {
    const auto found = std::ranges::find(whole.joints(), name, &robotics::Model::Joint::name);
    const bool slides = found != whole.joints().end() && found->kind == robotics::JointKind::Prismatic;
    good = good && slides;
    if (found == whole.joints().end())
      problem(name, fmt::format("--gripper: the robot has no joint '{}' that moves by itself", name),
              "name the joints that drive fingers; what mimics them goes with them");
    else if (!slides)
      problem(name, fmt::format("--gripper: joint '{}' turns", name),
              "how far fingers that turn open no URDF file says: their descriptor is written by hand "
              "(docs/guide/your_robot.md)");
  }
  NewGripper made;
  for (const auto& joint : whole.joints())
    if (drives(fingers, joint)) made.joints.push_back(joint);
  if (good && (made.joints.size() > most_fingers || made.joints.size() == whole.joints().size())) {
    problem("", fmt::format("--gripper names {} joints of {}", made.joints.size(), whole.joints().size()),
            "a gripper has 1 to 4 of them, and an arm at least one");
    good = false;
  }
  if (!good) return std::nullopt;
  const auto first = std::ranges::find(robot.joints, made.joints.front().name, &robotics::urdf::Joint::name);
  made.carrier = robot.links[first->parent].name;
  for (std::size_t i = 0; i < whole.joints().size(); ++i) {
    const auto& joint = whole.joints()[i];
    if (!drives(fingers, joint)) continue;
    for (const auto& body : whole.bodies().subspan(1))
      if (body.coordinate == static_cast<int>(i))
        made.full_width_m += std::abs(body.multiplier) * (*joint.limits.upper - *joint.limits.lower);
  }
  made.closed_is_upper = spread_m(robot, whole, fingers, true) < spread_m(robot, whole, fingers, false);
  made.most_force_n = made.most_speed_m_s = HUGE_VAL;
  for (const auto& joint : made.joints) {
    const double way = (*joint.limits.upper - *joint.limits.lower) / made.full_width_m;
    const auto all = static_cast<double>(made.joints.size());
    made.most_force_n = std::min(made.most_force_n, *joint.limits.effort * all * way);
    made.most_speed_m_s = std::min(made.most_speed_m_s, *joint.limits.velocity / way);
  }
  return made;
}

}  // namespace hirosco::tools
