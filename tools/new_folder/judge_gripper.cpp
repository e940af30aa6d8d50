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

/// Which link carries a joint, on the way up past joints that are fingers, too.
class Hand {
 public:
  Hand(const robotics::urdf::Robot& robot, const std::vector<std::string>& fingers)
      : robot_{robot}, own_{robotics::urdf::led_by(robot, fingers)}, above_(robot.links.size(), robot.joints.size()) {
    for (std::size_t i = 0; i < robot.joints.size(); ++i) above_[robot.joints[i].child] = i;
  }
  /// Fingers, and what mimics them.
  [[nodiscard]] const std::vector<std::size_t>& joints() const { return own_; }
  [[nodiscard]] std::size_t carrier_of(std::size_t joint) const {
    std::size_t carrier = robot_.joints[joint].parent;
    for (std::size_t at = above_[carrier]; at < robot_.joints.size(); at = above_[robot_.joints[at].parent])
      if (std::ranges::find(own_, at) != own_.end()) carrier = robot_.joints[at].parent;
    return carrier;
  }
  /// The joint that moves it; as many as there are: the base has it.
  [[nodiscard]] std::size_t mover_of(std::size_t link) const {
    std::size_t at = above_[link];
    while (at < robot_.joints.size() && robot_.joints[at].type == robotics::urdf::JointType::Fixed)
      at = above_[robot_.joints[at].parent];
    return at;
  }

 private:
  const robotics::urdf::Robot& robot_;
  std::vector<std::size_t> own_;
  std::vector<std::size_t> above_;
};

}  // namespace

std::optional<NewGripper> judge_gripper(
    const robotics::urdf::Robot& robot, const robotics::Model& whole, const std::vector<std::string>& fingers,
    const std::string& tip,
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
  const Hand hand{robot, fingers};
  const auto first = static_cast<std::size_t>(
      std::ranges::find(robot.joints, made.joints.front().name, &robotics::urdf::Joint::name) - robot.joints.begin());
  const std::size_t carrier = hand.carrier_of(first);
  made.carrier = robot.links[carrier].name;
  // In the arm's model they stand at 0 for good, and its gripper moves them without asking it.
  if (const auto carried = robotics::urdf::carried_by(robot, hand.joints(), tip.empty() ? made.carrier : tip)) {
    problem(robot.joints[carried->by].name,
            fmt::format("--gripper: joint '{}' carries {}", robot.joints[carried->by].name, carried->what),
            "a finger carries neither the tool of the arm nor joints that are not named as fingers, or its gripper "
            "would move the arm: name the joints that slide behind the tool, and with --tip a link that carries them");
    return std::nullopt;
  }
  for (const std::size_t joint : hand.joints()) {
    const std::size_t other = hand.carrier_of(joint);
    if (hand.mover_of(other) == hand.mover_of(carrier)) continue;
    problem(robot.joints[joint].name,
            fmt::format("--gripper: joint '{}' slides at link '{}', and '{}' at '{}', which moves otherwise",
                        robot.joints[joint].name, robot.links[other].name, robot.joints[first].name, made.carrier),
            "fingers of one gripper hang on one link, or on links that are fixed to it: name those of one hand");
    return std::nullopt;
  }
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
