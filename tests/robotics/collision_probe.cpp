// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "robotics/shapes/collision.hpp"
#include "robotics/shapes/swept.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_arm/testing/flown.hpp"

/// The arm of a URDF file as a judge may ask it: how far its pairs are apart, and what became of a motion that was asked of its subsystem, which flies
/// on virtual time.
///   collision_probe MODEL.urdf TIP [FIXED,...]: first its joints, whose ranges it keeps, and its pairs; then an answer to each line of standard input:
///   apart Q...: one number for each pair;  time FROM... GOAL...: how long the looks of a cycle take, us;  move FROM... GOAL...: where it was measured each 10 ms, then what its telecommand became;
///   jog FROM... GOAL...: likewise, by JOG_J.
namespace {

using namespace hirosco;
using namespace hirosco::robot_arm;
using robot_arm::testing::Flown;

constexpr int cycles_between_places = 10;
constexpr int longest_cycles = 70'000;
/// How near links may come: as `hirosco new robot` delivers it, and the subsystem's own descriptor has it (new_robot_test). What is free by 20 mm on the meshes has to be so by more than that on hulls.
[[nodiscard]] double delivered_limit_m() {
  std::ifstream file{HIROSCO_SOURCE_DIR "/templates/robot/newpart.xml"};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  const auto at = text.find("init=\"", text.find("name=\"CLEARANCE_LIMIT\""));
  if (at == std::string::npos) throw std::runtime_error{"templates/robot/newpart.xml says no CLEARANCE_LIMIT"};
  return std::stod(text.substr(at + 6));
}

[[nodiscard]] JointVector read(std::istream& in, std::size_t joints) {
  std::vector<double> numbers(joints);
  for (double& number : numbers) in >> number;
  return vector_of(numbers);
}

void say(const JointVector& position) {
  fmt::print("at");
  for (const double each : position) fmt::print(" {}", each);
  fmt::print("\n");
}

/// No gravity: whether drives hold a posture is another question.
[[nodiscard]] std::string descriptor_of(const robotics::Model& model, const std::string& file, const std::string& tip,
                                        const std::string& fixed) {
  using robot_arm::testing::replace_all;
  std::string text = robot_arm::testing::descriptor_for(model.joints().size(), file);
  replace_all(text, "init=\"0 0 -9.81\"", "init=\"0 0 0\"");
  replace_all(text, "minimum=\"-3.15\" maximum=\"3.15\"", "minimum=\"-7\" maximum=\"7\"");
  replace_all(text, "minimum=\"-150\" maximum=\"150\"", "minimum=\"-3000\" maximum=\"3000\"");
  replace_all(text, "name=\"TIP\" value=\"tool\"", "name=\"TIP\" value=\"" + tip + "\"");
  if (const auto at = text.find("<Setting name=\"MODEL_FILE\""); !fixed.empty() && at != std::string::npos)
    text.insert(at, "<Setting name=\"FIXED\" value=\"" + fixed + "\"/>");
  return text;
}

/// Of both looks that a cycle takes, on the way and some hundredths ahead: in the middle, the 99th and the last of a hundred.
[[nodiscard]] std::array<double, 3> microseconds(robotics::Clearance& clearance, const JointVector& from,
                                                 const JointVector& goal) {
  constexpr int looks = 1000;
  std::vector<double> taken;
  for (int i = 0; i < looks; ++i) {
    const JointVector now = from + (goal - from) * i / looks, next = from + (goal - from) * (i + 30) / looks;
    const auto begin = std::chrono::steady_clock::now();
    const double near_m = std::min(clearance.nearest(now).distance_m, clearance.nearer(now, next).distance_m);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
    taken.push_back(near_m > -HUGE_VAL ? took.count() : 0);
  }
  std::ranges::sort(taken);
  return {taken[looks / 2], taken[looks * 99 / 100], taken.back()};
}

void stand_at(Flown& flown, const JointVector& from) {
  flown.command(State::SafeOperational);
  flown.plant.place(from);
  flown.cycle(5);
  flown.command(State::Operational);
  flown.rig.forget_telemetry();
  flown.rig.explanations.clear();
}

/// Whoever brakes comes to rest.
void say_end(Flown& flown, const hirosco::testing::Sent& request, const JointVector& goal) {
  for (int i = 0; i < 100; ++i) flown.cycle(cycles_between_places);
  say(flown.plant.measured().position);
  fmt::print("ended {} off {} {}\n", flown.rig.outcome(request), flown.off(goal),
             flown.rig.explanations.empty() ? "" : flown.rig.explanations.back());
}

/// A quarter as fast as the joint may be that has farthest to go for that, said anew twice a second: nobody judges a way beforehand, and what stops it is who looks ahead.
void jog(Flown& flown, const JointVector& from, const JointVector& goal) {
  stand_at(flown, from);
  const JointVector way = goal - from;
  double rate_per_s = HUGE_VAL;
  for (std::size_t i = 0; i < flown.n; ++i)
    if (const double length = std::abs(way[static_cast<Eigen::Index>(i)]); length > 0)
      rate_per_s = std::min(rate_per_s, 0.25 * flown.model.joints()[i].limits.velocity.value() / length);
  const JointVector velocity = rate_per_s * way;
  std::vector<double> numbers(velocity.begin(), velocity.end());
  numbers.push_back(1);
  hirosco::testing::Sent request;
  constexpr int said_each = 500;
  say(flown.plant.measured().position);
  for (int cycles = 0; cycles * 1e-3 * rate_per_s < 1 && cycles < longest_cycles; cycles += cycles_between_places) {
    if (cycles % said_each == 0) request = flown.ask("JOG_J", numbers);
    flown.cycle(cycles_between_places);
    say(flown.plant.measured().position);
    if (flown.rig.outcome(request).find_first_of("48") != std::string::npos) break;
  }
  say_end(flown, request, goal);
}

void move(Flown& flown, const JointVector& from, const JointVector& goal) {
  stand_at(flown, from);
  const auto request = flown.move_j(goal);
  int cycles = 0;
  const auto ended = [&] {
    const std::string outcome = flown.rig.outcome(request);
    return outcome.starts_with("1 4") || outcome.ends_with(" 7") || outcome.find(" 8:") != std::string::npos;
  };
  say(flown.plant.measured().position);
  while (!ended() && cycles < longest_cycles) {
    flown.cycle(cycles_between_places);
    cycles += cycles_between_places;
    say(flown.plant.measured().position);
  }
  say_end(flown, request, goal);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const std::string file = argv[1], tip = argv[2], fixed = argc > 3 ? argv[3] : "";
  const auto text = descriptor::file_system()(file);
  if (!text) return 1;
  auto reading = robotics::urdf::read(file, *text);
  const auto names = robotics::urdf::listed_names(fixed);
  if (!reading.value) return 1;
  const robotics::urdf::Robot whole = *reading.value;
  if (robotics::urdf::fix(*reading.value, names)) return 1;
  const auto model = robotics::Model::make(robotics::urdf::describe(*reading.value)).value();
  auto shapes = robotics::read_collision_shapes(file, *text, descriptor::file_system());
  for (const auto& warning : shapes.warnings) fmt::print(stderr, "{}: {}\n", warning.code, warning.message);
  if (!shapes.value) {
    for (const auto& problem : shapes.problems) fmt::print(stderr, "{}: {}\n", problem.code, problem.message);
    return 1;
  }
  robotics::sweep(shapes.value->hulls, whole, names);
  robotics::Clearance clearance{model, shapes.value->hulls};
  for (const auto& joint : model.joints())
    fmt::print("joint {} {} {}\n", joint.name, joint.limits.lower.value_or(-4), joint.limits.upper.value_or(4));
  for (std::size_t i = 0; i < clearance.pairs(); ++i)
    fmt::print("pair {} {}\n", clearance.pair(i).built_m, clearance.pair(i).names);
  fmt::print("read\n");
  std::unique_ptr<Flown> flown;
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream in{line};
    std::string what;
    in >> what;
    const std::size_t joints = model.joints().size();
    if (what == "apart") {
      std::vector<double> apart(clearance.pairs());
      clearance.distances(read(in, joints), apart);
      for (const double each : apart) fmt::print("{} ", each);
      fmt::print("\n");
    } else if (what == "time") {
      clearance.set_limit(delivered_limit_m());
      const JointVector from = read(in, joints), goal = read(in, joints);
      fmt::print("time {}\n", fmt::join(microseconds(clearance, from, goal), " "));
    } else if (what == "move" || what == "jog") {
      if (!flown) {
        flown = std::make_unique<Flown>(model, descriptor_of(model, file, tip, fixed));
        flown->plant.set_gravity({0, 0, 0});
        flown->plant.step_s = 250e-6;
        flown->operate();
      }
      const JointVector from = read(in, joints), goal = read(in, joints);
      if (what == "move") move(*flown, from, goal);
      else jog(*flown, from, goal);
    }
    std::cout.flush();
    std::fflush(stdout);
  }
}
