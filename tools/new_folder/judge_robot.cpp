// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>

#include "hirosco/xml/reader.hpp"
#include "robotics/shapes/swept.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "tools/new_folder/bodies.hpp"
#include "tools/new_folder/chain.hpp"
#include "tools/new_folder/meshes.hpp"
#include "tools/new_folder/postures.hpp"
#include "tools/new_folder/robot.hpp"

namespace hirosco::tools {

namespace {

using descriptor::Diagnostic;
using robotics::JointVector;

class Judge {
 public:
  Judge(std::filesystem::path file, robotics::urdf::Robot robot, std::string text, JudgedRobot& judged)
      : file_{std::move(file)}, robot_{std::move(robot)}, text_{std::move(text)}, judged_{judged} {
    if (auto tree = xml::read_tree(text_)) root_ = std::move(*tree);
  }

  void say_who_stands(const std::vector<std::string>& joints) {
    constexpr std::size_t most_named = 8;
    const std::span named{joints.data(), std::min(joints.size(), most_named)};
    warning(place(root_), "U0609",
            fmt::format("{} joints stand at 0, fixed in the file that is written: {}{}", joints.size(),
                        fmt::join(named, ", "), joints.size() > most_named ? ", ..." : ""),
            "what they move is part of what carries it; the tool of --tip is moved by the others alone");
  }

  void take(TakenMeshes meshes) {
    std::ranges::move(meshes.warnings, std::back_inserter(judged_.warnings));
    meshes.warnings.clear();
    taken_ = std::move(meshes);
    // What comes along is where the file will name it; what stays where it is was told.
    const auto beside = [&](const std::filesystem::path& wanted) -> Result<std::string> {
      const auto found = std::ranges::find_if(
          taken_.files, [&](const auto& mesh) { return file_.parent_path() / mesh.first == wanted; });
      if (found == taken_.files.end()) return fail(ErrorCode::NotFound, "does not exist");
      return found->second;
    };
    auto reading = robotics::read_collision_shapes(file_, taken_.urdf, beside);
    std::ranges::move(reading.problems, std::back_inserter(judged_.problems));
    for (Diagnostic& warning : reading.warnings)
      if (warning.code == "U0703") judged_.warnings.push_back(std::move(warning));
    if (reading.value) hulls_ = std::move(reading.value->hulls);
  }

  void judge(std::string wanted_tip, const std::vector<std::string>& fingers) {
    judge_bodies();
    auto model = robotics::Model::make(robotics::urdf::describe(robot_));
    if (!model) return problem(place(root_), "U0310", model.error().text, "");
    judge_drives(*model);
    std::vector<std::string> world_joints;
    for (const auto& joint : model->joints()) world_joints.push_back(joint.name);
    std::optional<NewGripper> gripper;
    if (!fingers.empty()) {
      if (!judged_.problems.empty()) return;
      gripper = judge_gripper(robot_, *model, fingers, wanted_tip,
                              [&](std::string_view joint, std::string message, std::string hint) {
                                problem(place_of("joint", joint, "name"), "U0608", std::move(message), std::move(hint));
                              });
      if (!gripper) return;
      if (wanted_tip.empty()) wanted_tip = gripper->carrier;
      robotics::sweep(hulls_, robot_, fingers);
      // Each is known: nothing is left to be told.
      static_cast<void>(robotics::urdf::fix(robot_, fingers));
      model = robotics::Model::make(robotics::urdf::describe(robot_));
      if (!model) return problem(place(root_), "U0310", model.error().text, "");
    }
    judge_haste(*model);
    const std::string tip = judge_tip(wanted_tip);
    judge_word("link", tip);
    for (const std::string& finger : fingers) judge_word("joint", finger);
    if (!judged_.problems.empty()) return;
    const auto frame = model->find_frame(tip);
    if (!frame) return;
    NewRobot made{.name = robot_.name,
                  .urdf = std::move(taken_.urdf),
                  .meshes = std::move(taken_.files),
                  .model = *model,
                  .hand = std::move(gripper),
                  .world_joints = std::move(world_joints),
                  .tip = tip,
                  .posture = {},
                  .goal = {}};
    if (!find_postures(made, *frame)) return;
    warn_of_placeholders(made.model.joints(), most_rotor);
    if (made.hand) warn_of_placeholders(made.hand->joints, most_finger_rotor);
    judged_.robot = std::move(made);
  }

  /// How many joints there are where all of that goes well, but for shapes; else 0.
  [[nodiscard]] std::size_t flying_joints(const std::string& tip) {
    judge_bodies();
    const auto model = robotics::Model::make(robotics::urdf::describe(robot_));
    if (!model) return 0;
    judge_drives(*model);
    judge_haste(*model);
    judge_word("link", judge_tip(tip));
    const auto frame = model->find_frame(tip);
    const bool flies = judged_.problems.empty() && frame && least_load(*model, *frame).share <= most_load;
    return flies ? model->joints().size() : 0;
  }

 private:
  [[nodiscard]] static descriptor::Location place(const xml::Element& element) {
    return {element.at.line, element.at.column};
  }
  /// Of a joint or link of this name, or of an element in it where it has one.
  [[nodiscard]] descriptor::Location place_of(std::string_view kind, std::string_view name,
                                              std::string_view within) const {
    for (const xml::Element& element : root_.children) {
      const auto* found = element.find("name");
      if (element.name != kind || found == nullptr || found->value != name) continue;
      for (const xml::Element& child : element.children) {
        if (child.name == within) return place(child);
        for (const xml::Element& inner : child.children)
          if (inner.name == within) return place(inner);
      }
      return place(element);
    }
    return place(root_);
  }
  void problem(descriptor::Location at, const char* code, std::string message, std::string hint) {
    judged_.problems.push_back({file_, at, code, std::move(message), std::move(hint), 1});
  }
  void warning(descriptor::Location at, const char* code, std::string message, std::string hint) {
    judged_.warnings.push_back({file_, at, code, std::move(message), std::move(hint), 1, descriptor::Grade::Warning});
  }

  void judge_bodies() {
    for (RefusedBody& body : refused_bodies(robot_))
      problem(place_of("link", body.link, "inertia"), body.code, std::move(body.message), std::move(body.hint));
  }

  /// The one that is named, or the only end that joints move. Empty: told why.
  [[nodiscard]] std::string judge_tip(const std::string& wanted) {
    const auto description = robotics::urdf::describe(robot_);
    const auto moves = [&](const std::string& link) {
      const auto frame = std::ranges::find(description.frames, link, &robotics::FrameDescription::name);
      return frame != description.frames.end() && frame->joint.has_value();
    };
    std::vector<std::string> ends;
    for (const std::string& end : robotics::urdf::tips(robot_))
      if (moves(end)) ends.push_back(end);
    const auto all = fmt::format("ends that move are: {}", fmt::join(ends, ", "));
    if (wanted.empty()) {
      if (ends.size() == 1) return ends.front();
      problem(place(root_), "U0603", fmt::format("the robot has {} ends that move", ends.size()),
              fmt::format("say which link is the tool, for example --tip {}; {}", likely_tool(ends), all));
      return {};
    }
    if (std::ranges::find(robot_.links, wanted, &robotics::urdf::Link::name) == robot_.links.end())
      problem(place(root_), "U0603", fmt::format("--tip: the robot has no link '{}'", wanted), all);
    else if (!moves(wanted))
      problem(place_of("link", wanted, "name"), "U0603", fmt::format("--tip: no joint moves link '{}'", wanted), all);
    else return wanted;
    return {};
  }

  /// The first one that nearly as many joints move as any: no wheel, and no finger beside its palm.
  [[nodiscard]] std::string likely_tool(const std::vector<std::string>& ends) const {
    constexpr double nearly = 0.7;
    const std::vector<ChainEnd> all = chain_ends(text_);
    for (const std::string& end : ends) {
      const auto found = std::ranges::find(all, end, &ChainEnd::link);
      const auto most = static_cast<double>(all.empty() ? 0 : all.front().joints);
      if (found != all.end() && static_cast<double>(found->joints) >= nearly * most) return end;
    }
    return "LINK";
  }

  /// Few files say it. Who does is kept to it: ACCELERATION and JERK of what is made are no larger.
  void judge_haste(const robotics::Model& model) {
    for (const auto& joint : model.joints())
      for (const auto& [limit, name, least] :
           {std::tuple{joint.limits.acceleration, "acceleration", least_acceleration},
            {joint.limits.jerk, "jerk", least_jerk}})
        if (limit && *limit < least)
          problem(place_of("joint", joint.name, "limit"), "U0612",
                  fmt::format("the {} of joint '{}' is limited to {}: that of an arm is {} at least", name, joint.name,
                              *limit, least),
                  "it holds for all joints of the arm: check the unit (rad/s2 and rad/s3, or m/s2 and m/s3), or leave "
                  "it out, and what the drives can give is taken");
  }

  /// Lines of a simulated device are words, and these names stand in them; all others may have whatever XML takes.
  void judge_word(const char* kind, const std::string& name) {
    if (name.find_first_of(" \t\r\n") != std::string::npos)
      problem(place_of(kind, name, "name"), "U0611", fmt::format("the name of {} '{}' has white space", kind, name),
              "the simulated device is told it as one word: rename it in the file, where others name it too");
  }

  void judge_drives(const robotics::Model& model) {
    for (const auto& joint : model.joints()) {
      const auto at = place_of("joint", joint.name, "limit");
      for (const auto& [limit, name] : {std::pair{joint.limits.velocity, "velocity"}, {joint.limits.effort, "effort"}})
        if (!limit || !(*limit > 0))
          problem(at, "U0601", fmt::format("joint '{}' has no {} above 0", joint.name, name),
                  fmt::format("the arm keeps within it: write <limit {}=\"...\"/> from the drive's data sheet", name));
      const auto [lower, upper] = range_of(joint);
      if (!(upper - lower > 1e-6))
        problem(at, "U0602",
                fmt::format("the range of joint '{}' is from {} to {}: it cannot move", joint.name, lower, upper),
                "write lower and upper (with those of joints that mimic it), or make the joint fixed");
    }
  }

  /// Where it begins and goes, how fast it may speed up. False: it holds itself nowhere.
  [[nodiscard]] bool find_postures(NewRobot& made, robotics::FrameId tip) {
    const robotics::Model& model = made.model;
    const FoundPostures found = tools::find_postures(model, tip, hulls_);
    const auto& weakest = model.joints()[found.least_loaded.joint];
    if (found.least_loaded.share > most_load) {
      problem(place_of("joint", weakest.name, "limit"), "U0605",
              fmt::format(
                  "the robot holds itself nowhere: of {} postures the lightest takes {:.3g} of the effort {:.3g} of "
                  "joint '{}'",
                  postures_looked_at + 2, found.least_loaded.needed, *weakest.limits.effort, weakest.name),
              fmt::format(
                  "at most {} of it may be needed at rest: check the effort, <dynamics friction>, and the masses of "
                  "what it carries",
                  most_load));
      return false;
    }
    warn_of_weight(model, found.too_heavy);
    made.posture = found.posture;
    made.goal = found.goal;
    made.acceleration = found.acceleration;
    made.jerk = found.jerk;
    made.reach_m = found.reach_m;
    made.tip_z_m = found.tip_z_m;
    made.marks = find_marks(model, hulls_, found.posture);
    made.wrist_range_n = wrist_range_n(model, tip, found.posture);
    return true;
  }

  void warn_of_weight(const robotics::Model& model, const std::vector<int>& too_heavy) {
    for (std::size_t i = 0; i < too_heavy.size(); ++i) {
      if (too_heavy[i] == 0) continue;
      const auto& joint = model.joints()[i];
      warning(place_of("joint", joint.name, "limit"), "U0606",
              fmt::format("in {} of {} postures joint '{}' needs more than {} of its effort {:.3g} to hold the robot",
                          too_heavy[i], postures_looked_at, joint.name, most_load, *joint.limits.effort),
              "there its arm is stopped by TORQUE_LIMIT");
    }
  }

  /// An effort beyond every drive is no reason to refuse a robot, but what is guessed by it is none that a world takes.
  void warn_of_placeholders(std::span<const robotics::Model::Joint> joints, double most) {
    for (const auto& joint : joints) {
      const double effort = *joint.limits.effort, guessed = effort / effort_per_rotor;
      if (guessed <= most) continue;
      warning(place_of("joint", joint.name, "limit"), "U0610",
              fmt::format("by its effort {:.3g} the drive of joint '{}' would have a rotor of {:.3g}: {} is written",
                          effort, joint.name, guessed, most),
              "TORQUE_LIMIT and the contact watch are shares of this effort, and guard nothing: write the drive's from "
              "its data sheet, or at least ROTOR_INERTIA and rotors of what was made");
    }
  }

  std::filesystem::path file_;
  robotics::urdf::Robot robot_;
  std::string text_;
  JudgedRobot& judged_;
  TakenMeshes taken_;
  std::vector<robotics::LinkHull> hulls_;
  xml::Element root_;
};

/// What of a robot may be in the way of flying all of it, and not in the way of flying one arm.
constexpr std::array of_single_joints{"U0301", "U0303", "U0304", "U0306", "U0307", "U0308", "U0309",
                                      "U0310", "U0601", "U0602", "U0604", "U0605", "U0607", "U0612"};

[[nodiscard]] std::size_t flying_joints(const std::filesystem::path& file, const std::string& urdf,
                                        const std::string& tip) {
  const auto reading = robotics::urdf::read(file, urdf);
  JudgedRobot alone;
  return reading.value ? Judge{file, *reading.value, urdf, alone}.flying_joints(tip) : 0;
}

/// Which arms of a robot that is none as a whole can be flown: with the first problem that they are without.
void say_which_chains(const std::filesystem::path& file, std::string_view text, std::vector<Diagnostic>& problems) {
  const auto first = std::ranges::find_if(problems, [](const Diagnostic& problem) {
    return std::ranges::find(of_single_joints, problem.code) != of_single_joints.end();
  });
  if (first == problems.end()) return;
  constexpr std::size_t most_named = 6;
  std::vector<std::string> named;
  for (const ChainEnd& end : chains_that_fly(text, most_named, [&](const std::string& urdf, const std::string& tip) {
         return flying_joints(file, urdf, tip);
       }))
    named.push_back(fmt::format("{} ({} joints)", end.link, end.joints));
  if (!named.empty())
    first->hint += fmt::format("; or fly one arm of it while the others stand still, by --tip LINK --chain: {}",
                               fmt::join(named, ", "));
}

/// As somebody reads a file.
void put_in_order(std::vector<Diagnostic>& problems) {
  std::ranges::stable_sort(problems, [](const Diagnostic& one, const Diagnostic& other) {
    return std::pair{one.at.line, one.at.column} < std::pair{other.at.line, other.at.column};
  });
}

}  // namespace

JudgedRobot judge_robot(const std::filesystem::path& file, const descriptor::FileSource& source, const std::string& tip,
                        const std::string& gripper, std::span<const std::filesystem::path> packages, bool chain) {
  auto text = source(file);
  const auto fingers = robotics::urdf::listed_names(gripper);
  std::vector<std::string> standing;
  if (chain && text && (tip.empty() || has_link(*text, tip))) {
    auto kept = keep_chain(*text, tip, fingers);
    text = std::move(kept.urdf);
    standing = std::move(kept.standing);
  }
  auto reading = text ? robotics::urdf::read(file, *text) : robotics::urdf::read(file, source);
  JudgedRobot judged{.robot = {}, .problems = std::move(reading.problems), .warnings = std::move(reading.warnings)};
  if (reading.value) {
    Judge judge{file, *reading.value, *text, judged};
    if (!standing.empty()) judge.say_who_stands(standing);
    judge.take(take_meshes(file, *text, source, packages));
    judge.judge(tip, fingers);
    // Said more gravely by U0604.
    if (std::ranges::find(judged.problems, std::string_view{"U0604"}, &Diagnostic::code) != judged.problems.end())
      std::erase_if(judged.warnings, [](const Diagnostic& one) { return one.code == "U0504" || one.code == "U0508"; });
    put_in_order(judged.problems);
  }
  if (text) say_which_chains(file, *text, judged.problems);
  return judged;
}

}  // namespace hirosco::tools
