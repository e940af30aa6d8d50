// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/new_folder/postures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/motion/inverse_kinematics.hpp"

namespace hirosco::tools {

namespace {

using robotics::JointVector;

constexpr double gravity_m_s2 = 9.81;
/// Of a joint's effort at rest: what is lighter is as good.
constexpr double light_enough = 0.5;
/// What motions may take besides, and the most that they need where the file says nothing.
constexpr double share_for_motion = 0.75, usual_acceleration = 4, jerk_per_acceleration = 10;
/// From the ends of a range, so that measured is within it.
constexpr double inset_share = 0.05;
constexpr double goal_share = 0.2, goal_farthest = 0.3;
/// How far a goal may be on the way to another posture.
constexpr double bent_share = 0.6;
/// Where a joint turns on and on, and where postures and pages end.
constexpr double turn_rad = 3.14;
/// CLEARANCE_LIMIT of what is made is 0.01, and whoever would come to rest just there is refused; twice that, and some, may be asked for.
constexpr double clear_m = 0.025;
/// Between two looks at a way, rad or m of the joint that goes farthest.
constexpr double look_each = 0.03;

/// As the file limits it; of joints of which it does not, as much as motions need.
[[nodiscard]] double allowed_acceleration(const robotics::Model& model) {
  double least = largest_acceleration;
  for (const auto& joint : model.joints())
    least = std::min(least, joint.limits.acceleration.value_or(usual_acceleration));
  return least;
}
[[nodiscard]] double allowed_jerk(const robotics::Model& model, double acceleration) {
  const double usual = acceleration * jerk_per_acceleration;
  double least = largest_jerk;
  for (const auto& joint : model.joints()) least = std::min(least, joint.limits.jerk.value_or(usual));
  return least;
}
/// In tenths, and not above it.
[[nodiscard]] double in_tenths(double value) { return std::floor(value * 10) / 10; }

/// What gravity and dry friction take of drives at rest.
class Statics {
 public:
  Statics(const robotics::Model& model, robotics::FrameId tip)
      : model_{model}, tip_{tip}, dynamics_{model, robotics::Base::Fixed} {
    dynamics_.set_gravity({0, 0, -gravity_m_s2});
    state_.qd = JointVector::Zero(model.joint_count());
  }

  /// Of the joint that has the least left.
  [[nodiscard]] RestLoad load(const JointVector& posture) {
    state_.q = posture;
    dynamics_.update(state_);
    dynamics_.bias(held_);
    RestLoad most;
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
    double least = largest_acceleration;
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

[[nodiscard]] std::vector<double> numbers(const JointVector& posture) {
  std::vector<double> rounded;
  for (const double value : posture) rounded.push_back(std::round(value * 1e4) / 1e4);
  return rounded;
}

class Finder {
 public:
  Finder(const robotics::Model& model, robotics::FrameId tip, std::span<const robotics::LinkHull> hulls)
      : model_{model}, tip_{tip}, statics_{model, tip}, itself_{model, hulls} {}

  FoundPostures find() {
    FoundPostures found = look();
    if (found.least_loaded.share > most_load) return found;
    JointVector& best = lightest_;
    if (!itself_.is_clear(best)) best = lightest_clear(best);
    found.posture = numbers(best);
    found.acceleration = std::max(least_acceleration, in_tenths(found.acceleration));
    found.jerk = allowed_jerk(model_, found.acceleration);
    if (found.jerk < found.acceleration * jerk_per_acceleration)
      found.jerk = std::max(least_jerk, in_tenths(found.jerk));
    found.goal = numbers(find_goal(best));
    static_cast<void>(statics_.load(best));
    found.tip_z_m = statics_.tip().z();
    found.reach_m = std::max(found.reach_m, statics_.tip().norm());
    return found;
  }

  /// What each posture takes of the drives, and leaves them.
  FoundPostures look() {
    FoundPostures found;
    lightest_ = near_zero();
    RestLoad& least = found.least_loaded;
    least = statics_.load(lightest_);
    const auto consider = [&](const JointVector& posture) {
      const auto load = statics_.load(posture);
      if (least.share > light_enough && load.share < least.share) lightest_ = posture, least = load;
      return load;
    };
    static_cast<void>(consider(middle()));
    found.acceleration = allowed_acceleration(model_);
    found.too_heavy.assign(model_.joints().size(), 0);
    for (int i = 0; i < postures_looked_at; ++i) {
      const auto load = consider(random_posture());
      found.reach_m = std::max(found.reach_m, statics_.tip().norm());
      if (load.share > most_load) ++found.too_heavy[load.joint];
      else found.acceleration = std::min(found.acceleration, statics_.acceleration());
    }
    return found;
  }

 private:
  [[nodiscard]] JointVector random_posture() {
    JointVector posture;
    posture.resize(model_.joint_count());
    for (int i = 0; i < model_.joint_count(); ++i) {
      const auto [lower, upper] = inset(model_.joints()[static_cast<std::size_t>(i)]);
      const double part =
          static_cast<double>(random_() - random_.min()) / static_cast<double>(random_.max() - random_.min());
      posture[i] = lower + part * (upper - lower);
    }
    return posture;
  }
  [[nodiscard]] JointRange inset(const robotics::Model::Joint& joint) {
    const auto [lower, upper] = range_of(joint);
    const double in = inset_share * (upper - lower);
    return {lower + in, upper - in};
  }
  /// All joints at 0, or as near as their ranges let them.
  [[nodiscard]] JointVector near_zero() {
    JointVector posture;
    posture.resize(model_.joint_count());
    for (int i = 0; i < model_.joint_count(); ++i) {
      const auto [lower, upper] = inset(model_.joints()[static_cast<std::size_t>(i)]);
      posture[i] = std::clamp(0.0, lower, upper);
    }
    return posture;
  }
  [[nodiscard]] JointVector middle() {
    JointVector posture;
    posture.resize(model_.joint_count());
    for (int i = 0; i < model_.joint_count(); ++i) {
      const auto [lower, upper] = range_of(model_.joints()[static_cast<std::size_t>(i)]);
      posture[i] = (lower + upper) / 2;
    }
    return posture;
  }

  /// Of many; where none is clear of itself, the one that there was.
  [[nodiscard]] JointVector lightest_clear(const JointVector& otherwise) {
    JointVector best = otherwise;
    double least = most_load;
    for (int i = 0; i < postures_looked_at; ++i) {
      const JointVector posture = random_posture();
      const double share = statics_.load(posture).share;
      if (share < least && itself_.is_clear(posture)) best = posture, least = share;
    }
    return best;
  }

  /// Towards the middles of the ranges, less far where it would be heavy; elsewhere near by where the tool could not go straight from there,
  /// or where the arm would come too near to itself.
  [[nodiscard]] JointVector find_goal(const JointVector& from) {
    const JointVector towards = middle();
    std::optional<JointVector> fallback;
    const auto is_good = [&](const JointVector& goal) {
      if (statics_.load(goal).share > most_load || (fallback && !goes_straight(goal)) || !itself_.is_clear(from, goal))
        return false;
      if (fallback || goes_straight(goal)) return true;
      fallback = goal;
      return false;
    };
    for (double share = 1; share > 0.1; share /= 2) {
      JointVector goal = from;
      for (int i = 0; i < model_.joint_count(); ++i) {
        const auto [lower, upper] = range_of(model_.joints()[static_cast<std::size_t>(i)]);
        const double step = share * std::min(goal_share * (upper - lower), goal_farthest);
        goal[i] += towards[i] >= from[i] ? step : -step;
      }
      if (is_good(goal)) return goal;
    }
    for (int looked = 0; looked < postures_looked_at; ++looked) {
      // Farther and farther off.
      const double part = bent_share * (looked + 1) / postures_looked_at;
      const JointVector goal = from + part * (random_posture() - from);
      if (is_good(goal)) return goal;
    }
    if (fallback) return *fallback;
    JointVector goal = from;
    goal[0] += towards[0] >= from[0] ? 0.01 : -0.01;
    return goal;
  }

  /// Whether the tool goes straight from there, along each axis to both sides, without haste of any joint: README and page try that next.
  /// Of arms that cannot keep their tool's orientation nobody asks it.
  [[nodiscard]] bool goes_straight(const JointVector& from) {
    constexpr double way_m = 0.03, speed_m_s = 0.1, share_of_speed = 0.5;
    constexpr double from_ends = 0.03;  // of ranges, rad or m
    constexpr int joints_of_a_pose = 6;
    if (model_.joint_count() < joints_of_a_pose) return true;
    robotics::InverseKinematics inverse{model_, tip_, {.tolerance = 1e-6, .most_iterations = 20}};
    robotics::Dynamics dynamics{model_, robotics::Base::Fixed};
    robotics::State state;
    state.q = from;
    state.qd = JointVector::Zero(model_.joint_count());
    dynamics.update(state);
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {way_m, -way_m}) {
        robotics::Pose wanted = dynamics.frame_pose(tip_);
        wanted.position[axis] += side;
        JointVector there = from;
        if (!inverse.solve(wanted, from, there)) return false;
        for (int i = 0; i < model_.joint_count(); ++i) {
          const auto& joint = model_.joints()[static_cast<std::size_t>(i)];
          const auto [lower, upper] = range_of(joint);
          const double most = share_of_speed * *joint.limits.velocity * way_m / speed_m_s;
          if (std::abs(there[i] - from[i]) > most || there[i] < lower + from_ends || there[i] > upper - from_ends)
            return false;
        }
        if (!itself_.is_clear(there)) return false;
      }
    return true;
  }

  const robotics::Model& model_;
  robotics::FrameId tip_;
  Statics statics_;
  SelfClearance itself_;
  std::minstd_rand random_{1};
  JointVector lightest_;
};

}  // namespace

SelfClearance::SelfClearance(const robotics::Model& model, std::span<const robotics::LinkHull> hulls)
    : clearance_{model, hulls} {
  clearance_.set_limit(clear_m);
}

bool SelfClearance::is_clear(const JointVector& posture) { return clearance_.keeps_limits(posture); }

bool SelfClearance::is_clear(const JointVector& from, const JointVector& to) {
  const JointVector way = to - from;
  const int looks = std::max(1, static_cast<int>(std::ceil(way.cwiseAbs().maxCoeff() / look_each)));
  for (int i = 0; i <= looks; ++i)
    if (!is_clear(from + way * (static_cast<double>(i) / looks))) return false;
  return true;
}

JointRange range_of(const robotics::Model::Joint& joint) {
  return {joint.limits.lower.value_or(-turn_rad), joint.limits.upper.value_or(turn_rad)};
}

RestLoad least_load(const robotics::Model& model, robotics::FrameId tip) {
  return Finder{model, tip, {}}.look().least_loaded;
}

FoundPostures find_postures(const robotics::Model& model, robotics::FrameId tip,
                            std::span<const robotics::LinkHull> hulls) {
  return Finder{model, tip, hulls}.find();
}

}  // namespace hirosco::tools
