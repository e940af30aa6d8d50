// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_gripper/control/motion_progress.hpp"

#include <cmath>

namespace hirosco::robot_gripper {
namespace {

/// So long a goal has to be measured before it counts as reached, and at most so long after the end of the path.
constexpr double settled_enough_s = 0.02;
constexpr double patience_s = 3;
/// So long the wanted force, at rest, before something counts as held.
constexpr double held_after_s = 0.1;
/// Farther behind than it may be for so long: something is in the way.
constexpr double obstructed_after_s = 0.05;

}  // namespace

void MotionProgress::begin_path(double goal_m, double cycle_s) noexcept {
  cycle_s_ = cycle_s;
  goal_m_ = goal_m;
  reported_ = false;
  waited_s_ = settled_s_ = behind_s_ = 0;
}

void MotionProgress::begin_grip(double cycle_s) noexcept {
  cycle_s_ = cycle_s;
  reported_ = false;
  waited_s_ = 0;
}

MotionProgress::News MotionProgress::follow(const Opening& opening, double width_m, const Limits& limits) noexcept {
  // Who springs open from what it pressed on is ahead: nothing is in his way.
  const double off_m = opening.now().width_m - width_m, left_m = goal_m_ - opening.now().width_m;
  const double behind_m = off_m * left_m < 0 ? 0 : std::abs(off_m);
  behind_s_ = behind_m > limits.behind_m ? behind_s_ + cycle_s_ : 0;
  if (behind_s_ >= obstructed_after_s) return {.end = End::Obstructed};
  News news;
  if (!reported_ && opening.progress() >= 0.5) news.step = reported_ = true;
  if (!opening.at_rest()) return news;
  settled_s_ = std::abs(goal_m_ - width_m) <= limits.off_goal_m ? settled_s_ + cycle_s_ : 0;
  waited_s_ += cycle_s_;
  if (settled_s_ >= settled_enough_s) news.end = End::Reached;
  else if (waited_s_ > patience_s) news.end = End::NotReached;
  return news;
}

MotionProgress::News MotionProgress::follow(const Grip& grip, End met) noexcept {
  const bool presses = grip.law() == Law::Press;
  News news;
  if (presses && !reported_) news.step = reported_ = true;
  if (met != End::None) {
    news.end = met;
    return news;
  }
  waited_s_ = presses ? waited_s_ + cycle_s_ : 0;
  if (waited_s_ > patience_s) news.end = End::ForceNotReached;
  return news;
}

MotionProgress::End MotionProgress::met(const Grip& grip, double width_m, double empty_m) noexcept {
  if (grip.law() != Law::Press || !(grip.settled_s() >= held_after_s)) return End::None;
  return width_m <= empty_m ? End::NothingMet : End::Held;
}

}  // namespace hirosco::robot_gripper
