// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/abort_way.hpp"

#include <algorithm>
#include <cmath>

#include "subsystems/robot_arm/control/trail.hpp"

namespace hirosco::robot_arm {
namespace {

/// From one posture to the other, at least one. Of what is no number, or farther than anybody goes, more than anybody may look at.
[[nodiscard]] std::size_t looks_between(const JointVector& from, const JointVector& to) noexcept {
  constexpr double more_than_any = 1e6;
  const double looks = std::ceil(apart(from, to) / AbortWay::spacing);
  return looks < more_than_any ? static_cast<std::size_t>(std::max(1.0, looks))
                               : static_cast<std::size_t>(more_than_any);
}

}  // namespace

void AbortWay::begin(std::span<const JointVector> postures, const JointVector& here, Judged what,
                     std::size_t most_looks) noexcept {
  size_ = std::min(postures.size(), most);
  std::ranges::copy(postures.first(size_), postures_.begin());
  here_ = here;
  what_ = what;
  joins_ = was_blocked_ = false;
  tried_.fill(false);
  in_the_way_ = {};
  blocked_ = 0;
  found_ = size_ > 0 ? Found::NotYet : Found::Nothing;
  first_ = size_;
  most_looks_ = most_looks;
  looked_ = 0;
  if (size_ == 0) return;
  count_looks();
  if (found_ == Found::NotYet) look_along(postures_[size_ - 1], size_ - 1);
}

/// The whole path, and at least the way to the nearest posture of it, is what it takes; the way to each of them is all that there may be.
void AbortWay::count_looks() noexcept {
  std::size_t path = 1, nearest = 0, to_all = 0;
  for (std::size_t i = 1; i < size_; ++i) path += looks_between(postures_[i], postures_[i - 1]);
  for (std::size_t i = 0; i < size_ && what_ == Judged::FromHere; ++i) {
    const std::size_t looks = looks_between(here_, postures_[i]);
    nearest = i == 0 ? looks : std::min(nearest, looks);
    to_all += looks;
  }
  if (path + nearest > most_looks_) found_ = Found::TooLong;
  all_looks_ = std::min(path + to_all, std::max<std::size_t>(1, most_looks_));
}

double AbortWay::progress() const noexcept {
  if (found_ != Found::NotYet) return 1;
  return std::min(1.0, static_cast<double>(looked_) / static_cast<double>(all_looks_));
}

void AbortWay::look_along(const JointVector& from, std::size_t to) noexcept {
  from_ = before_ = then_ = from;
  to_ = to;
  step_ = 0;
  steps_ = looks_between(from_, postures_[to_]);
  step();
}

void AbortWay::step() noexcept {
  before_ = then_;
  ++step_;
  then_ = from_ + static_cast<double>(step_) / static_cast<double>(steps_) * (postures_[to_] - from_);
}

void AbortWay::heed(const robotics::Clearance::Nearest& nearer) noexcept {
  if (found_ != Found::NotYet) return;
  ++looked_;
  if (nearer.distance_m == HUGE_VAL) {
    if (step_ < steps_) step();
    else end_of_segment();
    return;
  }
  // The way to the nearest posture is what is told of, where there are several. The path is looked along the other way round.
  if (!was_blocked_) in_the_way_ = nearer, blocked_ = joins_ || step_ == steps_ ? to_ : to_ + 1;
  was_blocked_ = joins_;
  if (what_ == Judged::PathAlone) found_ = Found::Nothing;
  else join();
}

/// Of the path, from its end back; of a way that joins it, all that was left to judge.
void AbortWay::end_of_segment() noexcept {
  if (joins_) {
    found_ = Found::Way;
    return;
  }
  first_ = to_;
  if (first_ > 0) look_along(postures_[first_], first_ - 1);
  else if (what_ == Judged::PathAlone) found_ = Found::Way;
  else join();
}

void AbortWay::join() noexcept {
  joins_ = true;
  std::size_t nearest = size_;
  for (std::size_t i = first_; i < size_; ++i)
    if (!tried_[i] && (nearest == size_ || apart(here_, postures_[i]) < apart(here_, postures_[nearest]))) nearest = i;
  if (nearest == size_) {
    found_ = Found::Nothing;
    return;
  }
  if (looked_ + looks_between(here_, postures_[nearest]) > most_looks_) {
    found_ = Found::TooLong;
    return;
  }
  tried_[nearest] = true;
  look_along(here_, nearest);
}

}  // namespace hirosco::robot_arm
