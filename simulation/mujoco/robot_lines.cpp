// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/robot_lines.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "simulation/mujoco/shapes.hpp"

namespace hirosco::simulation {

bool RobotLines::knows(std::string_view word) noexcept { return std::ranges::find(known, word) != known.end(); }

std::unexpected<Error> RobotLines::refuse(ErrorCode code, std::string why) {
  problem_ = std::move(why);
  return fail(code, problem_.c_str());
}

Result<> RobotLines::take(const Words& words, MujocoRobot& robot, std::size_t number) {
  if (words[0] == "tip") {
    HIROSCO_TRY(words.expect(2));
    auto set = robot.set_tip(std::string{words[1]}, number);
    return set ? ok() : refuse(ErrorCode::NotFound, std::move(set.error()));
  }
  if (words[0] == "posture" || words[0] == "rotors") return place(words, robot, number);
  if (words[0] == "springs") return give_way(words, robot, number);
  return differ(words, robot, number);
}

Result<std::vector<double>> RobotLines::each_joint(std::string_view text, const MujocoRobot& robot,
                                                   std::size_t number) {
  auto numbers = listed_numbers(text);
  if (!numbers) return refuse(ErrorCode::InvalidArgument, std::move(numbers.error()));
  const std::size_t joints = robot.joints(number);
  if (numbers->size() != joints)
    return fail(ErrorCode::InvalidArgument, "another number of joints", static_cast<std::int64_t>(joints));
  return std::move(*numbers);
}

Result<> RobotLines::place(const Words& words, MujocoRobot& robot, std::size_t number) {
  HIROSCO_TRY(words.expect(2));
  HIROSCO_TRY_LET(const std::vector<double> numbers, each_joint(words[1], robot, number));
  if (words[0] == "posture") {
    auto placed = robot.place(numbers, number);
    return placed ? ok() : refuse(ErrorCode::InvalidArgument, std::move(placed.error()));
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!(numbers[i] >= 0 && numbers[i] <= 1e3)) return fail(ErrorCode::OutOfRange, "an inertia is from 0 to 1000");
    if (numbers[i] == 0 && robot.gives_way(robot.first_joint(number) + i))
      return fail(ErrorCode::OutOfRange, "a joint that gives way has a rotor above 0", static_cast<std::int64_t>(i));
  }
  robot.set_rotors(numbers, number);
  return ok();
}

Result<> RobotLines::give_way(const Words& words, MujocoRobot& robot, std::size_t number) {
  constexpr double stiffest = 1e7, most_damping = 1e5;
  HIROSCO_TRY(words.expect(words.count() > 2 ? 3 : 2));
  HIROSCO_TRY_LET(const std::vector<double> stiffness, each_joint(words[1], robot, number));
  std::vector<double> damping(stiffness.size());
  if (words.count() > 2) {
    HIROSCO_TRY_LET(damping, each_joint(words[2], robot, number));
  }
  if (!std::ranges::all_of(stiffness, [](double each) { return each >= 0 && each <= stiffest; }) ||
      !std::ranges::all_of(damping, [](double each) { return each >= 0 && each <= most_damping; }))
    return fail(ErrorCode::OutOfRange, "a stiffness is from 0 to 1e7, a damping from 0 to 1e5");
  auto done = robot.give_way(stiffness, damping, number);
  return done ? ok() : refuse(ErrorCode::InvalidArgument, std::move(done.error()));
}

Result<> RobotLines::differ(const Words& words, MujocoRobot& robot, std::size_t number) {
  const std::string_view what = words[0];
  if (what == "friction") {
    HIROSCO_TRY_LET(const double factor, words.number(1, 0, 100));
    double more = 0;
    if (words.count() > 2) {
      HIROSCO_TRY_LET(more, words.number(2, 0, 1000));
    }
    HIROSCO_TRY(words.expect(words.count() > 2 ? 3 : 2));
    robot.set_friction(factor, more, number);
    return ok();
  }
  if (what == "push") {
    constexpr double most_n = 1e4;
    HIROSCO_TRY(words.expect(4));
    HIROSCO_TRY_LET(const double x, words.number(1, -most_n, most_n));
    HIROSCO_TRY_LET(const double y, words.number(2, -most_n, most_n));
    HIROSCO_TRY_LET(const double z, words.number(3, -most_n, most_n));
    robot.push(x, y, z, number);
    return ok();
  }
  HIROSCO_TRY(words.expect(2));
  if (what == "payload") {
    HIROSCO_TRY_LET(const double mass_kg, words.number(1, 0, 1000));
    robot.set_payload(mass_kg, number);
    return ok();
  }
  HIROSCO_TRY_LET(const double factor, words.number(1, 0.1, 10));
  what == "mass" ? robot.set_mass_factor(factor, number) : robot.set_inertia_factor(factor, number);
  return ok();
}

std::vector<std::string> RobotLines::remarks(const MujocoRobot& robot, std::size_t number) {
  constexpr std::size_t most = 20;
  std::vector<std::string> remarks;
  for (const std::string& shape : robot.left_out(number)) {
    if (remarks.size() == most) {
      remarks.push_back(fmt::format("its world leaves out {} more", robot.left_out(number).size() - most));
      break;
    }
    remarks.push_back("its world leaves out " + shape);
  }
  return remarks;
}

std::string RobotLines::truth_of_joint(const MujocoRobot& robot, std::size_t joint, std::size_t index) {
  std::string text = fmt::format("q{0}={1:.6f} qd{0}={2:.6f} torque_{0}={3:.4f} ", index + 1, robot.position(joint),
                                 robot.velocity(joint), robot.torque(joint));
  if (robot.gives_way(joint)) text += fmt::format("spring_{}={:.7f} ", index + 1, robot.given_way(joint));
  return text;
}

std::string RobotLines::truth(const MujocoRobot& robot, std::size_t number) {
  const auto tip = robot.tip_m(number);
  const auto& touched = robot.touched(number);
  return fmt::format("tip_x={:.6f} tip_y={:.6f} tip_z={:.6f} contacts={} contact_n={:.3f} ", tip[0], tip[1], tip[2],
                     touched.contacts, touched.normal_n);
}

}  // namespace hirosco::simulation
