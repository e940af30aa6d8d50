// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "hirosco/xml/reader.hpp"
#include "robotics/dynamics/dynamics.hpp"
#include "robotics/motion/inverse_kinematics.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "tools/new_folder/robot.hpp"

namespace hirosco::tools {

namespace {

using descriptor::Diagnostic;
using robotics::JointVector;

constexpr double gravity_m_s2 = 9.81;
/// Of a joint's effort at rest: the arm's own limit is 0.8.
constexpr double light_enough = 0.5, most_load = 0.7;
/// What motions may take besides, and the most that they need.
constexpr double share_for_motion = 0.75, most_acceleration = 4, least_acceleration = 0.1;
constexpr int postures_looked_at = 400;
/// From the ends of a range, so that measured is within it.
constexpr double inset_share = 0.05;
constexpr double goal_share = 0.2, goal_farthest = 0.3;
/// How far a goal may be on the way to another posture.
constexpr double bent_share = 0.6;
/// Where a joint turns on and on, and where postures and pages end.
constexpr double turn_rad = 3.14;
/// Of moments: the world takes what is on the border, and nothing beyond.
constexpr double rounding = 1e-12;
/// kg, kg m2: what is less is nothing to the world, which takes a link without any moment, but none with two of them.
constexpr double least_mass = 1e-15, least_moment = 1e-14;

struct Range {
  double lower, upper;
};
[[nodiscard]] Range range_of(const robotics::Model::Joint& joint) {
  return {joint.limits.lower.value_or(-turn_rad), joint.limits.upper.value_or(turn_rad)};
}

/// What gravity and dry friction take of drives at rest.
class Statics {
 public:
  struct Load {
    double share{0};
    std::size_t joint{0};
    double needed{0};
  };

  Statics(const robotics::Model& model, robotics::FrameId tip)
      : model_{model}, tip_{tip}, dynamics_{model, robotics::Base::Fixed} {
    dynamics_.set_gravity({0, 0, -gravity_m_s2});
    state_.qd = JointVector::Zero(model.joint_count());
  }

  /// Of the joint that has the least left.
  [[nodiscard]] Load load(const JointVector& posture) {
    state_.q = posture;
    dynamics_.update(state_);
    dynamics_.bias(held_);
    Load most;
    for (std::size_t i = 0; i < model_.joints().size(); ++i) {
      const auto& joint = model_.joints()[i];
      const double needed = std::abs(held_[static_cast<Eigen::Index>(i)]) + joint.friction;
      const double share = needed / *joint.limits.effort;
      if (share >= most.share) most = {share, i, needed};
    }
    return most;
  }
  /// Of all joints at once, in the posture of the last load(): whichever way each goes.
  [[nodiscard]] double acceleration() {
    dynamics_.mass_matrix(matrix_);
    double least = most_acceleration;
    for (std::size_t i = 0; i < model_.joints().size(); ++i) {
      const auto& joint = model_.joints()[i];
      const auto row = static_cast<Eigen::Index>(i);
      const double left = share_for_motion * *joint.limits.effort - std::abs(held_[row]) - joint.friction;
      least = std::min(least, left / matrix_.row(row).cwiseAbs().sum());
    }
    return least;
  }
  [[nodiscard]] robotics::Vector3 tip() const { return dynamics_.frame_pose(tip_).position; }

 private:
  const robotics::Model& model_;
  robotics::FrameId tip_;
  robotics::Dynamics dynamics_;
  robotics::State state_;
  robotics::Coordinates held_;
  robotics::MassMatrix matrix_;
};

/// Whether the tool goes straight from there, along each axis to both sides, without haste of any joint: README and page try that next.
/// Of arms that cannot keep their tool's orientation nobody asks it.
[[nodiscard]] bool goes_straight(const robotics::Model& model, robotics::FrameId tip, const JointVector& from) {
  constexpr double way_m = 0.03, speed_m_s = 0.1, share_of_speed = 0.5;
  constexpr double from_ends = 0.03;  // of ranges, rad or m
  constexpr int joints_of_a_pose = 6;
  if (model.joint_count() < joints_of_a_pose) return true;
  robotics::InverseKinematics inverse{model, tip, {.tolerance = 1e-6, .most_iterations = 20}};
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  robotics::State state;
  state.q = from;
  state.qd = JointVector::Zero(model.joint_count());
  dynamics.update(state);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {way_m, -way_m}) {
      robotics::Pose wanted = dynamics.frame_pose(tip);
      wanted.position[axis] += side;
      JointVector there = from;
      if (!inverse.solve(wanted, from, there)) return false;
      for (int i = 0; i < model.joint_count(); ++i) {
        const auto& joint = model.joints()[static_cast<std::size_t>(i)];
        const auto [lower, upper] = range_of(joint);
        const double most = share_of_speed * *joint.limits.velocity * way_m / speed_m_s;
        if (std::abs(there[i] - from[i]) > most || there[i] < lower + from_ends || there[i] > upper - from_ends)
          return false;
      }
    }
  return true;
}

class Judge {
 public:
  Judge(std::filesystem::path file, robotics::urdf::Robot robot, std::string text, JudgedRobot& judged)
      : file_{std::move(file)}, robot_{std::move(robot)}, text_{std::move(text)}, judged_{judged} {
    if (auto tree = xml::read_tree(text_)) root_ = std::move(*tree);
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
      gripper =
          judge_gripper(robot_, *model, fingers, [&](std::string_view joint, std::string message, std::string hint) {
            problem(place_of("joint", joint, "name"), "U0608", std::move(message), std::move(hint));
          });
      if (!gripper) return;
      if (wanted_tip.empty()) wanted_tip = gripper->carrier;
      // Each is known: nothing is left to be told.
      static_cast<void>(robotics::urdf::fix(robot_, fingers));
      model = robotics::Model::make(robotics::urdf::describe(robot_));
      if (!model) return problem(place(root_), "U0310", model.error().text, "");
    }
    const std::string tip = judge_tip(wanted_tip);
    if (!judged_.problems.empty()) return;
    const auto frame = model->find_frame(tip);
    if (!frame) return;
    NewRobot made{.name = robot_.name,
                  .urdf = text_,
                  .model = *model,
                  .hand = std::move(gripper),
                  .world_joints = std::move(world_joints),
                  .tip = tip,
                  .posture = {},
                  .goal = {}};
    if (find_postures(made, *frame)) judged_.robot = std::move(made);
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

  [[nodiscard]] static robotics::Vector3 principal_moments(const robotics::Inertia& inertia) {
    return Eigen::SelfAdjointEigenSolver<robotics::Matrix3>{inertia.about_centre, Eigen::EigenvaluesOnly}.eigenvalues();
  }

  [[nodiscard]] static bool may_be(const robotics::Inertia& inertia) {
    if (inertia.about_centre.isZero(0)) return true;
    const auto moments = principal_moments(inertia);
    const double largest = moments.maxCoeff();
    return moments.minCoeff() >= least_moment && largest <= (moments.sum() - largest) * (1 + rounding);
  }

  /// Its world takes no inertia that no body has; of links that are fixed to each other that of all of them counts.
  void judge_bodies() {
    const auto whole = robotics::urdf::describe(robot_);
    const auto body_of = [&](const std::string& link) -> const robotics::Inertia& {
      const auto frame = std::ranges::find(whole.frames, link, &robotics::FrameDescription::name);
      return frame != whole.frames.end() && frame->joint ? whole.joints[*frame->joint].moved : whole.base;
    };
    for (const auto& link : robot_.links) {
      if (!link.inertia || may_be(*link.inertia) || may_be(body_of(link.name))) continue;
      const auto moments = principal_moments(*link.inertia);
      problem(place_of("link", link.name, "inertia"), "U0604",
              fmt::format("no body has the inertia of link '{}': principal moments {:.4g}, {:.4g} and {:.4g} kg m2",
                          link.name, moments[0], moments[1], moments[2]),
              "each is above 0 and at most the sum of the others, of it or of all that is fixed to it; the world of a "
              "simulated flight takes no other: look for a typing error or a wrong unit");
    }
    for (const auto& joint : robot_.joints)
      if (joint.type != robotics::urdf::JointType::Fixed && !has_body(joint.child))
        problem(place_of("link", robot_.links[joint.child].name, "inertia"), "U0607",
                fmt::format("joint '{}' moves link '{}', which has no mass or no inertia about some axis", joint.name,
                            robot_.links[joint.child].name),
                "the world of a simulated flight wants all of it in one link, this or one that is fixed to it: write "
                "<inertial> as of a body of this size");
  }
  /// All three moments, in the link or in one that is fixed to it.
  [[nodiscard]] bool has_body(std::size_t link) const {
    if (const auto& inertia = robot_.links[link].inertia)
      if (inertia->mass >= least_mass && principal_moments(*inertia).minCoeff() >= least_moment) return true;
    return std::ranges::any_of(robot_.joints, [&](const auto& joint) {
      return joint.parent == link && joint.type == robotics::urdf::JointType::Fixed && has_body(joint.child);
    });
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
              fmt::format("say which link is the tool, for example --tip {}; {}", ends.empty() ? "LINK" : ends.front(),
                          all));
      return {};
    }
    if (std::ranges::find(robot_.links, wanted, &robotics::urdf::Link::name) == robot_.links.end())
      problem(place(root_), "U0603", fmt::format("--tip: the robot has no link '{}'", wanted), all);
    else if (!moves(wanted))
      problem(place_of("link", wanted, "name"), "U0603", fmt::format("--tip: no joint moves link '{}'", wanted), all);
    else return wanted;
    return {};
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

  [[nodiscard]] JointVector random_posture(const robotics::Model& model) {
    JointVector posture;
    posture.resize(model.joint_count());
    for (int i = 0; i < model.joint_count(); ++i) {
      const auto [lower, upper] = inset(model.joints()[static_cast<std::size_t>(i)]);
      const double part =
          static_cast<double>(random_() - random_.min()) / static_cast<double>(random_.max() - random_.min());
      posture[i] = lower + part * (upper - lower);
    }
    return posture;
  }
  [[nodiscard]] static Range inset(const robotics::Model::Joint& joint) {
    const auto [lower, upper] = range_of(joint);
    const double in = inset_share * (upper - lower);
    return {lower + in, upper - in};
  }
  /// All joints at 0, or as near as their ranges let them.
  [[nodiscard]] static JointVector near_zero(const robotics::Model& model) {
    JointVector posture;
    posture.resize(model.joint_count());
    for (int i = 0; i < model.joint_count(); ++i) {
      const auto [lower, upper] = inset(model.joints()[static_cast<std::size_t>(i)]);
      posture[i] = std::clamp(0.0, lower, upper);
    }
    return posture;
  }
  [[nodiscard]] static JointVector middle(const robotics::Model& model) {
    JointVector posture;
    posture.resize(model.joint_count());
    for (int i = 0; i < model.joint_count(); ++i) {
      const auto [lower, upper] = range_of(model.joints()[static_cast<std::size_t>(i)]);
      posture[i] = (lower + upper) / 2;
    }
    return posture;
  }
  [[nodiscard]] static std::vector<double> numbers(const JointVector& posture) {
    std::vector<double> rounded;
    for (const double value : posture) rounded.push_back(std::round(value * 1e4) / 1e4);
    return rounded;
  }

  /// Where it begins and goes, how fast it may speed up. False: it holds itself nowhere.
  [[nodiscard]] bool find_postures(NewRobot& made, robotics::FrameId tip) {
    const robotics::Model& model = made.model;
    Statics statics{model, tip};
    JointVector best = near_zero(model);
    Statics::Load least = statics.load(best);
    const auto consider = [&](const JointVector& posture) {
      const auto load = statics.load(posture);
      if (least.share > light_enough && load.share < least.share) best = posture, least = load;
      return load;
    };
    static_cast<void>(consider(middle(model)));
    double acceleration = most_acceleration;
    std::vector<int> too_heavy(model.joints().size(), 0);
    for (int i = 0; i < postures_looked_at; ++i) {
      const auto load = consider(random_posture(model));
      made.reach_m = std::max(made.reach_m, statics.tip().norm());
      if (load.share > most_load) ++too_heavy[load.joint];
      else acceleration = std::min(acceleration, statics.acceleration());
    }
    const auto& weakest = model.joints()[least.joint];
    if (least.share > most_load) {
      problem(place_of("joint", weakest.name, "limit"), "U0605",
              fmt::format(
                  "the robot holds itself nowhere: of {} postures the lightest takes {:.3g} of the effort {:.3g} of "
                  "joint '{}'",
                  postures_looked_at + 2, least.needed, *weakest.limits.effort, weakest.name),
              fmt::format(
                  "at most {} of it may be needed at rest: check the effort, <dynamics friction>, and the masses of "
                  "what it carries",
                  most_load));
      return false;
    }
    warn_of_weight(model, too_heavy);
    made.posture = numbers(best);
    made.acceleration = std::max(least_acceleration, std::floor(acceleration * 10) / 10);
    made.goal = numbers(find_goal(model, statics, tip, best));
    static_cast<void>(statics.load(best));
    made.tip_z_m = statics.tip().z();
    made.reach_m = std::max(made.reach_m, statics.tip().norm());
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

  /// Towards the middles of the ranges, less far where it would be heavy; elsewhere near by where the tool could not go straight from there.
  [[nodiscard]] JointVector find_goal(const robotics::Model& model, Statics& statics, robotics::FrameId tip,
                                      const JointVector& from) {
    const JointVector towards = middle(model);
    std::optional<JointVector> light;
    for (double share = 1; share > 0.1; share /= 2) {
      JointVector goal = from;
      for (int i = 0; i < model.joint_count(); ++i) {
        const auto [lower, upper] = range_of(model.joints()[static_cast<std::size_t>(i)]);
        const double step = share * std::min(goal_share * (upper - lower), goal_farthest);
        goal[i] += towards[i] >= from[i] ? step : -step;
      }
      if (statics.load(goal).share > most_load) continue;
      if (goes_straight(model, tip, goal)) return goal;
      if (!light) light = goal;
    }
    for (int looked = 0; looked < postures_looked_at; ++looked) {
      // Farther and farther off.
      const double part = bent_share * (looked + 1) / postures_looked_at;
      const JointVector goal = from + part * (random_posture(model) - from);
      if (statics.load(goal).share <= most_load && goes_straight(model, tip, goal)) return goal;
    }
    if (light) return *light;
    JointVector goal = from;
    goal[0] += towards[0] >= from[0] ? 0.01 : -0.01;
    return goal;
  }

  std::filesystem::path file_;
  robotics::urdf::Robot robot_;
  std::string text_;
  JudgedRobot& judged_;
  xml::Element root_;
  std::minstd_rand random_{1};
};

}  // namespace

JudgedRobot judge_robot(const std::filesystem::path& file, const descriptor::FileSource& source, const std::string& tip,
                        const std::string& gripper) {
  const auto text = source(file);
  auto reading = text ? robotics::urdf::read(file, *text) : robotics::urdf::read(file, source);
  JudgedRobot judged{.robot = {}, .problems = std::move(reading.problems), .warnings = std::move(reading.warnings)};
  if (!reading.value) return judged;
  Judge{file, *reading.value, *text, judged}.judge(tip, robotics::urdf::listed_names(gripper));
  // Said more gravely by U0604.
  if (std::ranges::find(judged.problems, std::string_view{"U0604"}, &Diagnostic::code) != judged.problems.end())
    std::erase_if(judged.warnings, [](const Diagnostic& one) { return one.code == "U0504" || one.code == "U0508"; });
  std::ranges::stable_sort(judged.problems, [](const Diagnostic& one, const Diagnostic& other) {
    return std::pair{one.at.line, one.at.column} < std::pair{other.at.line, other.at.column};
  });
  return judged;
}

}  // namespace hirosco::tools
