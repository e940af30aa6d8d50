// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "bench/robots/robot_cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hirosco/descriptor/model/setting_files.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "robotics/motion/inverse_kinematics.hpp"
#include "robotics/shapes/swept.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "tools/new_folder/postures.hpp"
#include "tools/new_folder/robot.hpp"

namespace hirosco::bench {
namespace {

using robotics::JointVector;
using robotics::Vector3;

constexpr const char* device_name = "ARM";
constexpr double payload_kg = 2, gravity_m_s2 = 9.81;
/// Of MOVE_J, as the README of a folder has it; of MOVE_L, m/s and rad/s.
constexpr double speed = 0.5, line_m_s = 0.1, line_rad_s = 0.5;
constexpr double line_m = 0.1, line_step_m = 0.002;
constexpr std::size_t most_goals = 2, most_lines = 2;
/// How far further goals are from each other, and how near to the ends of ranges, rad or m.
constexpr double farthest = 1.0, from_ends = 0.1;
/// What a drive may hold at rest with the payload and without, of its effort, and give to friction besides: the arm's own limit is 0.8 of what
/// is felt behind friction.
constexpr double most_held = 0.65, most_needed = 0.85;
/// What counts as a contact where a load is not declared, of a joint's effort: whoever carries something unknown is told to.
constexpr double contact_limit = 0.6;
constexpr int candidates = 2000;
constexpr auto goal_limit = 90s, line_limit = 30s;

[[nodiscard]] const descriptor::MissionSubsystem* arm_of(const descriptor::Mission& mission) {
  const auto found = std::ranges::find_if(mission.subsystems, [](const descriptor::MissionSubsystem& member) {
    return member.subsystem.find_function("MOVE_L") != nullptr &&
           member.subsystem.find_function("SET_PAYLOAD") != nullptr;
  });
  return found != mission.subsystems.end() ? &*found : nullptr;
}

[[nodiscard]] std::vector<double> numbers(const JointVector& vector) { return {vector.begin(), vector.end()}; }
[[nodiscard]] JointVector vector_of(const std::vector<double>& numbers) {
  JointVector vector;
  vector.resize(static_cast<Eigen::Index>(numbers.size()));
  std::ranges::copy(numbers, vector.begin());
  return vector;
}

/// What the robot can do by its file, with 2 kg at its tool.
class Planner {
 public:
  Planner(const robotics::Model& model, robotics::FrameId tip, std::span<const robotics::LinkHull> hulls)
      : model_{model},
        tip_{tip},
        dynamics_{model, robotics::Base::Fixed},
        inverse_{model, tip, {}},
        itself_{model, hulls} {
    dynamics_.set_gravity({0, 0, -gravity_m_s2});
    state_.qd = JointVector::Zero(model.joint_count());
  }

  [[nodiscard]] bool holds(const JointVector& posture) {
    state_.q = posture;
    dynamics_.update(state_);
    robotics::Coordinates held;
    dynamics_.bias(held);
    robotics::Jacobian jacobian;
    dynamics_.jacobian(tip_, jacobian);
    for (int i = 0; i < model_.joint_count(); ++i) {
      const auto& joint = model_.joints()[static_cast<std::size_t>(i)];
      const double with = std::abs(held[i] + jacobian(5, i) * payload_kg * gravity_m_s2);
      const double most = std::max(with, std::abs(held[i]));
      if (most > most_held * *joint.limits.effort || most + joint.friction > most_needed * *joint.limits.effort)
        return false;
    }
    return true;
  }
  [[nodiscard]] bool within(const JointVector& posture) const {
    for (int i = 0; i < model_.joint_count(); ++i) {
      const auto& limits = model_.joints()[static_cast<std::size_t>(i)].limits;
      const double in = limits.lower && limits.upper ? std::min(from_ends, 0.05 * (*limits.upper - *limits.lower)) : 0;
      if (limits.lower && posture[i] < *limits.lower + in) return false;
      if (limits.upper && posture[i] > *limits.upper - in) return false;
    }
    return true;
  }
  /// All the way from one to the other.
  [[nodiscard]] bool goes(const JointVector& from, const JointVector& to) {
    constexpr int looks = 20;
    for (int i = 0; i <= looks; ++i) {
      const JointVector between = from + (to - from) * (static_cast<double>(i) / looks);
      if (!within(between) || !holds(between)) return false;
    }
    return itself_.is_clear(from, to);
  }
  /// Whether the tool goes straight so far from there, with half of each joint's velocity.
  [[nodiscard]] bool goes_straight(const JointVector& from, const Vector3& way) {
    JointVector posture = from;
    const robotics::Pose begin = pose(from);
    const int steps = static_cast<int>(std::ceil(way.norm() / line_step_m));
    for (int i = 1; i <= steps; ++i) {
      const JointVector before = posture;
      robotics::Pose wanted = begin;
      wanted.position += way * (static_cast<double>(i) / steps);
      if (!inverse_.solve(wanted, before, posture) || !within(posture) || !holds(posture) || !itself_.is_clear(posture))
        return false;
      for (int joint = 0; joint < model_.joint_count(); ++joint) {
        const double rate = std::abs(posture[joint] - before[joint]) / (way.norm() / steps) * line_m_s;
        if (rate > 0.5 * *model_.joints()[static_cast<std::size_t>(joint)].limits.velocity) return false;
      }
    }
    return true;
  }
  [[nodiscard]] robotics::Pose pose(const JointVector& posture) {
    state_.q = posture;
    dynamics_.update(state_);
    return dynamics_.frame_pose(tip_);
  }
  /// Not far from there, and gone to with the load where that is held there. Empty: none of many can be gone to and has lines.
  [[nodiscard]] std::vector<double> another(const JointVector& from, bool loaded) {
    for (int i = 0; i < candidates; ++i) {
      JointVector to = from;
      for (int joint = 0; joint < model_.joint_count(); ++joint) {
        const auto& limits = model_.joints()[static_cast<std::size_t>(joint)].limits;
        const double far =
            limits.lower && limits.upper ? std::min(farthest, 0.3 * (*limits.upper - *limits.lower)) : farthest;
        to[joint] += far * (2 * static_cast<double>(random_()) / static_cast<double>(random_.max()) - 1);
      }
      if ((loaded ? goes(from, to) : within(to) && holds(to) && itself_.is_clear(from, to)) && !lines(to).empty())
        return numbers(to);
    }
    return {};
  }
  [[nodiscard]] std::vector<Vector3> lines(const JointVector& from) {
    std::vector<Vector3> found;
    for (const Vector3& axis : {Vector3{0, 0, 1}, Vector3{0, 1, 0}, Vector3{1, 0, 0}})
      for (const double sign : {1.0, -1.0}) {
        if (found.size() == most_lines) return found;
        if (const Vector3 way = sign * line_m * axis; goes_straight(from, way)) {
          found.push_back(way);
          break;
        }
      }
    return found;
  }

 private:
  const robotics::Model& model_;
  robotics::FrameId tip_;
  robotics::Dynamics dynamics_;
  robotics::InverseKinematics inverse_;
  tools::SelfClearance itself_;
  robotics::State state_;
  std::minstd_rand random_{1};
};

/// A number that is none stays.
void keep_worst(double& worst, double found) {
  if (!std::isnan(worst) && !(found <= worst)) worst = found;
}

/// The robot of the mission as the arm knows it, and where its joints are among the world's.
struct Known {
  robotics::urdf::NamedRobot robot;
  robotics::FrameId tip;
  std::string tip_name, fixed;
  std::vector<std::size_t> in_world;
};
[[nodiscard]] std::expected<Known, std::string> known(const descriptor::SubsystemDescriptor& subsystem) {
  auto robot = robotics::urdf::read_named(subsystem, device_name);
  if (!robot) return std::unexpected{robot.error().text};
  const auto tip = robotics::urdf::named_tip(subsystem, device_name, *robot);
  if (!tip) return std::unexpected{tip.error().text};
  const auto fixed = descriptor::setting_of_all(subsystem, device_name, robotics::urdf::fixed_setting);
  const auto whole = robotics::urdf::read("", robot->text);
  const auto model = robotics::Model::make(robotics::urdf::describe(*whole.value));
  if (!fixed || !model) return std::unexpected{std::string{"the file cannot be read whole"}};
  Known made{std::move(*robot), *tip, {}, *fixed, {}};
  made.tip_name = made.robot.model.frame(*tip).name;
  for (const auto& joint : made.robot.model.joints())
    made.in_world.push_back(static_cast<std::size_t>(
        std::ranges::find(model->joints(), joint.name, &robotics::Model::Joint::name) - model->joints().begin()));
  return made;
}

/// One flight.
class Flown {
 public:
  Flown(const std::filesystem::path& mission, const RobotTask& task, const Known& arm, std::uint64_t seed)
      : task_{task},
        arm_{arm},
        flight_{{.mission = mission, .subsystems = {}, .devices = {}, .seed = seed}},
        kinematics_{arm.robot.model, robotics::Base::Fixed} {}

  CaseFound fly(const RobotCase& wanted, const std::function<void(simulation::Flight&)>& look) {
    if (look) look(flight_);
    fly_all(wanted);
    for (const auto& line : flight_.story().lines()) {
      const bool grave =
          line.text.find(" medium ") != std::string::npos || line.text.find(" high ") != std::string::npos;
      const bool met = line.text.find(" CONTACT ") != std::string::npos;
      if ((grave || met) && found_.problems.size() < 6) found_.problems.push_back(line.text);
    }
    return found_;
  }

 private:
  void problem(std::string text) { found_.problems.push_back(std::move(text)); }

  void fly_all(const RobotCase& wanted) {
    auto* device = flight_.craft().device(task_.device);
    std::vector<std::string> lines = wanted.differs;
    if (wanted.loaded) lines.insert(lines.begin(), posture_of(task_.goals.back().joints));
    for (const std::string& line : lines)
      if (device == nullptr || !device->fault(line)) return problem("its world does not take '" + line + "'");
    if (!flight_.commission()) return problem("it was not commissioned: " + flight_.story().text());
    // Nobody declares it while the arm still swings from what it found hanging there.
    static_cast<void>(flight_.craft().run_until([] { return false; }, 1s));
    if (wanted.declared_kg > 0 && !command("SET_PAYLOAD", {wanted.declared_kg, 0.0, 0.0, 0.0}, 10s)) return;
    if (wanted.loaded && !command("SET_CONTACT", {std::uint8_t{1}, contact_limit}, 10s)) return;
    for (const auto& [goal, loaded] : task_.goals) {
      if (wanted.loaded && !loaded) continue;
      std::vector<Value> arguments(goal.begin(), goal.end());
      arguments.emplace_back(speed);
      if (!command("MOVE_J", arguments, goal_limit)) return;
      ++found_.goals;
      const std::vector<double> now = positions();
      for (std::size_t i = 0; i < now.size(); ++i) keep_worst(found_.joint_rad, std::abs(now[i] - goal[i]));
      keep_worst(found_.tool_m, (tip() - by_model(goal).position).norm());
    }
    for (const auto& way : task_.lines) {
      const Vector3 offset{way[0], way[1], way[2]};
      const robotics::Pose begin = pose();
      if (!line(begin.position, begin.position + offset, begin.rotation)) return;
      if (!line(begin.position + offset, begin.position, begin.rotation)) return;
    }
  }

  /// The fault line that puts it there, whatever of it is not the arm's as it is.
  [[nodiscard]] std::string posture_of(const std::vector<double>& goal) {
    std::vector<double> all;
    for (std::size_t i = 0; !std::isnan(word(fmt::format("q{}", i + 1))); ++i)
      all.push_back(word(fmt::format("q{}", i + 1)));
    for (std::size_t i = 0; i < goal.size(); ++i) all.at(arm_.in_world[i]) = goal[i];
    return fmt::format("posture {:.9g}", fmt::join(all, ","));
  }

  [[nodiscard]] bool line(const Vector3& from, const Vector3& to, const robotics::Matrix3& rotation) {
    const robotics::Quaternion kept{rotation};
    const Vector3 along = (to - from).normalized();
    flight_.craft().on_cycle([&](std::string_view subsystem, TimePoint) {
      if (subsystem != task_.subsystem) return;
      const Vector3 gone = tip() - from;
      keep_worst(found_.beside_m, (gone - gone.dot(along) * along).norm());
    });
    const bool done = command(
        "MOVE_L", {to.x(), to.y(), to.z(), kept.w(), kept.x(), kept.y(), kept.z(), line_m_s, line_rad_s}, line_limit);
    flight_.craft().on_cycle({});
    if (!done) return false;
    ++found_.lines;
    keep_worst(found_.tool_m, (tip() - to).norm());
    keep_worst(found_.turned_rad, robotics::Quaternion{pose().rotation}.angularDistance(kept));
    return true;
  }

  [[nodiscard]] bool command(std::string_view function, const std::vector<Value>& arguments, Duration limit) {
    const TimePoint begun = flight_.craft().now();
    const auto outcome = flight_.craft().command(task_.subsystem, function, arguments, limit);
    if (outcome.completed) return true;
    const auto before_s = seconds(flight_.craft().now() - begun);
    problem(fmt::format("{} after {:.1f} s: {}", function, before_s,
                        outcome.failure ? fmt::format("failed with 0x{:04X}", static_cast<unsigned>(*outcome.failure))
                                        : std::string{"not done in time"}));
    return false;
  }

  [[nodiscard]] double word(const std::string& name) {
    const std::string words = " " + flight_.craft().device(task_.device)->truth();
    const auto at = words.find(" " + name + "=");
    return at == std::string::npos ? NAN : std::strtod(words.c_str() + at + name.size() + 2, nullptr);
  }
  [[nodiscard]] Vector3 tip() { return {word("tip_x"), word("tip_y"), word("tip_z")}; }
  [[nodiscard]] std::vector<double> positions() {
    std::vector<double> now;
    for (const std::size_t joint : arm_.in_world) now.push_back(word(fmt::format("q{}", joint + 1)));
    return now;
  }
  [[nodiscard]] robotics::Pose by_model(const std::vector<double>& joints) {
    robotics::State state;
    state.q = vector_of(joints);
    state.qd = JointVector::Zero(state.q.size());
    kinematics_.update(state);
    return kinematics_.frame_pose(arm_.tip);
  }
  [[nodiscard]] robotics::Pose pose() { return {by_model(positions()).rotation, tip()}; }

  const RobotTask& task_;
  const Known& arm_;
  simulation::Flight flight_;
  robotics::Dynamics kinematics_;
  CaseFound found_;
};

}  // namespace

std::vector<RobotCase> robot_cases(double weakest) {
  constexpr double share = 0.1;
  const std::string payload = fmt::format("payload {}", payload_kg);
  return {{"as its file says", {}},
          {"links 10 % heavier", {"mass 1.1"}},
          {"inertias 5 % larger", {"inertia 1.05"}},
          {fmt::format("{:.3g} N m more friction in each joint", share * weakest),
           {fmt::format("friction 1 {}", share * weakest)}},
          {"2 kg at the tool, undeclared", {payload}, true},
          {"2 kg at the tool, declared", {payload}, true, payload_kg}};
}

// Not of numbers that are none.
bool CaseFound::reaches_goals() const noexcept {
  return problems.empty() && goals > 0 && joint_rad <= most_joint_error_rad && tool_m <= most_tool_error_m;
}
bool CaseFound::holds() const noexcept {
  return reaches_goals() && lines > 0 && turned_rad <= most_joint_error_rad && beside_m <= most_beside_line_m;
}

namespace {

/// What is known of a mission's arm by its file, and where it goes first.
struct Asked {
  Known arm;
  std::vector<double> posture;
  RobotTask task;
  std::vector<robotics::LinkHull> hulls;
};
[[nodiscard]] std::expected<Asked, std::string> asked(const std::filesystem::path& file) {
  const auto source = descriptor::file_system();
  const auto reading = descriptor::read_mission(file, source);
  if (!reading.value) return std::unexpected{fmt::format("{} cannot be read", file.string())};
  const auto* member = arm_of(*reading.value);
  if (member == nullptr) return std::unexpected{std::string{"the mission has no arm with MOVE_L and SET_PAYLOAD"}};
  const auto& devices = reading.value->devices;
  const auto device = std::ranges::find_if(devices, [&](const descriptor::SimulatedDevice& one) {
    return one.subsystem == member->subsystem.name && one.device == device_name;
  });
  if (device == devices.end()) return std::unexpected{std::string{"its arm has no simulated device"}};
  auto arm = known(member->subsystem);
  if (!arm) return std::unexpected{arm.error()};
  // Where it begins and its README's goal: what was made of the same file.
  const auto judged = tools::judge_robot(arm->robot.file, source, arm->tip_name, arm->fixed);
  auto shapes = robotics::read_collision_shapes(arm->robot.file, arm->robot.text, source);
  if (!judged.robot || !shapes.value) return std::unexpected{std::string{"hirosco new robot refuses its file"}};
  const auto whole = robotics::urdf::read("", arm->robot.text);
  robotics::sweep(shapes.value->hulls, *whole.value, arm->robot.standing);
  Asked made{std::move(*arm), judged.robot->posture, {}, std::move(shapes.value->hulls)};
  RobotTask& task = made.task;
  task.subsystem = member->subsystem.name;
  task.device = device->name;
  task.tip = made.arm.tip_name;
  task.weakest = HUGE_VAL;
  for (const auto& joint : made.arm.robot.model.joints()) {
    task.joints.push_back(joint.name);
    task.weakest = std::min(task.weakest, *joint.limits.effort);
  }
  for (const auto& goal : {judged.robot->goal, judged.robot->posture}) task.goals.push_back({goal, false});
  return made;
}

}  // namespace

std::expected<RobotTask, std::string> first_task(const std::filesystem::path& file) {
  auto made = asked(file);
  if (!made) return std::unexpected{std::move(made.error())};
  return std::move(made->task);
}

std::expected<RobotTask, std::string> robot_task(const std::filesystem::path& file) {
  auto made = asked(file);
  if (!made) return std::unexpected{std::move(made.error())};
  RobotTask& task = made->task;
  Planner planner{made->arm.robot.model, made->arm.tip, made->hulls};
  JointVector last = vector_of(made->posture);
  for (auto& goal : task.goals) goal.loaded = planner.goes(vector_of(goal.joints), last);
  for (std::size_t i = 0; i < most_goals; ++i)
    if (const auto next = planner.another(last, task.goals.back().loaded); !next.empty()) {
      task.goals.push_back({next, true});
      last = vector_of(next);
    }
  // Who carries something begins at the last one.
  auto &first = task.goals[0], &begin = task.goals[1];
  begin.loaded = begin.loaded && planner.goes(last, vector_of(begin.joints));
  first.loaded = first.loaded && begin.loaded && planner.goes(last, vector_of(first.joints));
  for (const Vector3& way : planner.lines(last)) task.lines.push_back({way.x(), way.y(), way.z()});
  if (task.lines.empty() || !task.goals.back().loaded)
    return std::unexpected{std::string{"no posture was found from which its tool goes straight"}};
  return std::move(made->task);
}

CaseFound fly_case(const std::filesystem::path& mission, const RobotTask& task, const RobotCase& wanted,
                   std::uint64_t seed, const std::function<void(simulation::Flight&)>& look) {
  CaseFound nothing;
  try {
    const auto reading = descriptor::read_mission(mission, descriptor::file_system());
    if (!reading.value) throw std::runtime_error{"its mission cannot be read"};
    const auto arm = known(arm_of(*reading.value)->subsystem);
    if (!arm) throw std::runtime_error{arm.error()};
    return Flown{mission, task, *arm, seed}.fly(wanted, look);
  } catch (const std::runtime_error& error) {
    nothing.problems.emplace_back(error.what());
  }
  return nothing;
}

}  // namespace hirosco::bench
