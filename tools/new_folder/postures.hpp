// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "robotics/dynamics/model.hpp"
#include "robotics/shapes/clearance.hpp"
#include "robotics/shapes/collision.hpp"

/// `hirosco new robot`: where an arm begins and where it goes first.
namespace hirosco::tools {

/// An arm's own judgement of where it is clear of itself: as its subsystem has it, with some millimetres more.
class SelfClearance {
 public:
  SelfClearance(const robotics::Model& model, std::span<const robotics::LinkHull> hulls);
  [[nodiscard]] bool is_clear(const robotics::JointVector& posture);
  /// All the way, as MOVE_J goes.
  [[nodiscard]] bool is_clear(const robotics::JointVector& from, const robotics::JointVector& to);

 private:
  robotics::Clearance clearance_;
};

struct JointRange {
  double lower, upper;
};
/// Of one that turns on and on: one turn.
[[nodiscard]] JointRange range_of(const robotics::Model::Joint& joint);

/// Of a joint's effort at rest: the arm's own limit is 0.8.
inline constexpr double most_load = 0.7;
/// Besides all joints at 0, or as near as they may, and the middles of all ranges.
inline constexpr int postures_looked_at = 400;

/// What gravity and dry friction take of the drive that has the least left.
struct RestLoad {
  double share{0};  ///< of its effort
  std::size_t joint{0};
  double needed{0};
};

/// Of all postures that are looked at; above `most_load`: the robot holds itself nowhere.
[[nodiscard]] RestLoad least_load(const robotics::Model& model, robotics::FrameId tip);

/// Of ACCELERATION and JERK, which hold for all joints of an arm, as its descriptor has them.
inline constexpr double least_acceleration = 0.1, largest_acceleration = 20, least_jerk = 1, largest_jerk = 1000;

struct FoundPostures {
  RestLoad least_loaded;  ///< above `most_load`: it holds itself nowhere, and nothing else was looked for
  std::vector<int> too_heavy;  ///< for how many postures each joint is the one that does not hold
  std::vector<double> posture, goal;  ///< as NewRobot has them
  double acceleration{0}, jerk{0};
  double reach_m{0}, tip_z_m{0};
};
/// The same at each call.
[[nodiscard]] FoundPostures find_postures(const robotics::Model& model, robotics::FrameId tip,
                                          std::span<const robotics::LinkHull> hulls);

}  // namespace hirosco::tools
