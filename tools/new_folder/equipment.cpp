// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/equipment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "robotics/dynamics/dynamics.hpp"
#include "tools/new_folder/postures.hpp"
#include "tools/new_folder/robot.hpp"

namespace hirosco::tools {

namespace {

using robotics::JointVector;

/// Of joints that turn, rad/s, and that slide, m/s; of a joint's velocity, of which homing permits a quarter.
constexpr double usual_turning = 0.1, usual_sliding = 0.02, share_of_velocity = 0.2;
/// How far a mark is, and how far it is looked for: seconds at that speed.
constexpr double mark_s = 1, looked_for_s = 4;
/// What it takes to come to rest behind it, and what the subsystem comes to a speed in.
constexpr double rests_s = 0.2, changes_speed_s = 0.25;
/// Of what the law needs: springs that know the rotor alone swing; of an effort, at least and at most.
constexpr double spare = 3, least_share = 0.1, most_share = 0.7;

/// LIMIT of CONTACT_WATCH, and how much earlier than any joint the wrist is to feel.
constexpr double contact_share = 0.3, earlier = 3;
/// What the tests of the subsystem have, and no less than what tells something from noise; the lever of its moment.
constexpr double most_range_n = 100, least_range_n = 0.5, lever_m = 0.1;

/// Of the tests of a folder: when the first thing is tried, and how long each takes.
constexpr double begins_s = 2, pushed_s = 0.5, afterwards_s = 2;

[[nodiscard]] std::string rounded_text(double value) { return fmt::format("{:.4g}", value); }

[[nodiscard]] JointVector vector_of(const std::vector<double>& numbers) {
  JointVector made;
  made.resize(static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) made[static_cast<Eigen::Index>(i)] = numbers[i];
  return made;
}

[[nodiscard]] double speed_of(const robotics::Model::Joint& joint) {
  const double usual = joint.kind == robotics::JointKind::Prismatic ? usual_sliding : usual_turning;
  return std::min(usual, share_of_velocity * *joint.limits.velocity);
}

/// 1, 2 or 5 of a power of ten, and above it by rounding at most.
[[nodiscard]] double rounded_down(double value) {
  value *= 1 + 1e-9;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0})
    if (step * power <= value) return step * power;
  return power;
}

/// Joined by blanks, as descriptors have them, or by commas, as devices do.
template <class Part>
[[nodiscard]] std::string each(const std::vector<MarkSearch>& marks, const Part& part, const char* between = " ") {
  std::vector<std::string> said;
  for (const MarkSearch& mark : marks) said.push_back(part(mark));
  return fmt::format("{}", fmt::join(said, between));
}

/// Of all joints of the world in the order of the file; whoever is the gripper's counts from its zero.
[[nodiscard]] std::string marks_of_world(const NewRobot& robot) {
  std::vector<std::string> said;
  for (const std::string& name : robot.world_joints) {
    const auto& joints = robot.model.joints();
    const auto found = std::ranges::find(joints, name, &robotics::Model::Joint::name);
    said.push_back(
        found == joints.end() ? "0" : rounded_text(robot.marks[static_cast<std::size_t>(found - joints.begin())].mark));
  }
  return fmt::format("{}", fmt::join(said, ","));
}

/// How long MOVE_J of the README takes with half of the velocities, from wherever the marks are.
[[nodiscard]] double goal_s(const NewRobot& robot) {
  double most = 0;
  for (std::size_t i = 0; i < robot.goal.size(); ++i) {
    const double way = std::abs(robot.goal[i] - robot.posture[i]) + (mark_s + rests_s) * std::abs(robot.marks[i].speed);
    most = std::max(most, way / (0.5 * *robot.model.joints()[i].limits.velocity));
  }
  return most + 3;
}

/// What its test does until it is unplugged, what that tells, and when.
struct Tries {
  std::string lines, told;
  double until_s{begins_s};
};
[[nodiscard]] Tries tries_of(const NewRobot& robot, const Equipment& equipment, const NewName& name) {
  Tries made;
  const auto at = [&](const std::string& what, double takes_s) {
    made.lines += fmt::format("--at \"{:g} {}\" ", made.until_s, what);
    made.until_s += takes_s;
  };
  if (equipment.homing) {
    const auto joints = static_cast<double>(robot.goal.size());
    at(fmt::format("tc {} HOME", name.upper), std::ceil(joints * (mark_s + 2 * changes_speed_s)) + 1);
    at("tc SUPERVISOR SET_MODE operation", 3);
    at(fmt::format("tc {} MOVE_J {} 0.5", name.upper, fmt::join(robot.goal, ",")), std::ceil(goal_s(robot)));
    made.told += "commissioned: mode homing.*mode operation.*MOTION_DONE.*";
  } else {
    made.told += "commissioned: mode operation.*";
  }
  if (equipment.wrist_sensor) {
    at(fmt::format("{} push 0 0 -{}", name.lower, rounded_text(0.5 * robot.wrist_range_n)), pushed_s);
    at(fmt::format("{} push 0 0 0", name.lower), pushed_s);
    made.told += "WRIST_CONTACT.*";
  }
  return made;
}

}  // namespace

std::vector<MarkSearch> find_marks(const robotics::Model& model, std::span<const robotics::LinkHull> hulls,
                                   const std::vector<double>& posture) {
  SelfClearance itself{model, hulls};
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  robotics::State state;
  state.q = vector_of(posture);
  state.qd = JointVector::Zero(model.joint_count());
  dynamics.update(state);
  robotics::MassMatrix matrix;
  dynamics.mass_matrix(matrix);
  double hastiest = 0;  // any joint's, rad/s2 or m/s2
  for (const auto& joint : model.joints()) hastiest = std::max(hastiest, speed_of(joint) / changes_speed_s);

  std::vector<MarkSearch> found(posture.size());
  JointVector stands = state.q;
  for (std::size_t i = posture.size(); i-- > 0;) {  // the tip first
    const auto& joint = model.joints()[i];
    const auto row = static_cast<Eigen::Index>(i);
    const auto [lower, upper] = range_of(joint);
    const double effort = *joint.limits.effort, speed = speed_of(joint);
    const double middle = (lower + upper) / 2, side = middle >= posture[i] ? 1 : -1;
    // Within its range, with what it takes to come to rest there.
    const double step = std::min(mark_s * speed, 0.25 * (upper - lower));
    const auto beyond = [&](double towards) {
      JointVector there = stands;
      there[row] += towards * (step + rests_s * speed);
      return there;
    };
    const auto is_good = [&](double towards) {
      const JointVector there = beyond(towards);
      return there[row] > lower && there[row] < upper && itself.is_clear(stands, there);
    };
    const double towards = !is_good(side) && is_good(-side) ? -side : side;
    const double needed =
        hastiest * (matrix.row(row).cwiseAbs().sum() + std::min(effort / effort_per_rotor, most_rotor)) +
        joint.friction + joint.damping * speed;
    found[i] = {.mark = posture[i] + towards * step,
                .speed = towards * speed,
                .torque = std::clamp(spare * needed, least_share * effort, most_share * effort),
                .distance = looked_for_s * speed};
    stands = beyond(towards);
  }
  return found;
}

double wrist_range_n(const robotics::Model& model, robotics::FrameId tip, const std::vector<double>& posture) {
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  robotics::State state;
  state.q = vector_of(posture);
  state.qd = JointVector::Zero(model.joint_count());
  dynamics.update(state);
  robotics::Jacobian jacobian;
  dynamics.jacobian(tip, jacobian);
  double felt_n = HUGE_VAL;  // by the first joint, along the direction that it feels best
  for (std::size_t i = 0; i < model.joints().size(); ++i) {
    const double lever = jacobian.col(static_cast<Eigen::Index>(i)).tail<3>().norm();
    if (lever > 1e-6) felt_n = std::min(felt_n, contact_share * *model.joints()[i].limits.effort / lever);
  }
  return rounded_down(std::clamp(felt_n / earlier / contact_share, least_range_n, most_range_n));
}

void add_equipment(const NewRobot& robot, const Equipment& equipment, const NewName& name, NewParts& parts) {
  auto& words = parts.words;
  const auto has = [&](bool it, const char* word) {
    words[word] = "";
    if (!it) parts.without_lines.emplace_back(word);
  };
  has(equipment.homing, "@homing@");
  has(equipment.wrist_sensor, "@wrist@");
  words["@gravity@"] = equipment.homing ? "0 0 0" : "0 0 -9.81";
  words["@start@"] = equipment.homing ? "homing" : "operation";
  const Tries tries = tries_of(robot, equipment, name);
  words["@tries@"] = tries.lines;
  words["@told@"] = tries.told;
  words["@until_s@"] = fmt::format("{:g}", tries.until_s);
  words["@ends_s@"] = fmt::format("{:g}", tries.until_s + afterwards_s);
  if (equipment.wrist_sensor) {
    words["@wrist_force@"] = rounded_text(robot.wrist_range_n);
    words["@wrist_moment@"] = rounded_text(lever_m * robot.wrist_range_n);
    words["@wrist_push@"] = rounded_text(0.5 * robot.wrist_range_n);
  }
  if (!equipment.homing) return;
  std::vector<std::size_t> order;
  for (std::size_t i = robot.marks.size(); i > 0; --i) order.push_back(i);
  words["@homing_order@"] = fmt::format("{}", fmt::join(order, " "));
  words["@homing_speed@"] = each(robot.marks, [](const MarkSearch& mark) { return rounded_text(mark.speed); });
  words["@homing_torque@"] = each(robot.marks, [](const MarkSearch& mark) { return rounded_text(mark.torque); });
  words["@homing_distance@"] = each(robot.marks, [](const MarkSearch& mark) { return rounded_text(mark.distance); });
  words["@homing_s@"] = fmt::format("{:g}", std::ceil(static_cast<double>(order.size()) * (looked_for_s + 1)) + 5);
  words["@marks@"] = marks_of_world(robot);
}

}  // namespace hirosco::tools
