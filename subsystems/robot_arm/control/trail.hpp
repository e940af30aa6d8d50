// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// How far apart two places are: what the joint has to go that has to go farthest, rad or m.
[[nodiscard]] inline double apart(const JointVector& one, const JointVector& other) noexcept {
  return one.size() == 0 ? 0 : (one - other).cwiseAbs().maxCoeff();
}

/// The way that an arm came by, in places at least a spacing apart; of a longer one its newest part.
class Trail {
 public:
  static constexpr double spacing = 0.01;  ///< rad or m
  static constexpr std::size_t most = 128;

  void clear() noexcept { size_ = 0; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  void record(const JointVector& place) noexcept {
    if (size_ > 0 && apart(place, newest()) < spacing) return;
    places_[next_] = place;
    next_ = (next_ + 1) % most;
    size_ = std::min(size_ + 1, most);
  }
  /// 0: the newest; less than size().
  [[nodiscard]] const JointVector& place(std::size_t back) const noexcept {
    return places_[(next_ + most - 1 - back) % most];
  }
  [[nodiscard]] const JointVector& newest() const noexcept { return place(0); }
  void drop() noexcept {
    if (size_ == 0) return;
    next_ = (next_ + most - 1) % most;
    --size_;
  }

 private:
  std::array<JointVector, most> places_{};
  std::size_t next_{0};
  std::size_t size_{0};
};

}  // namespace hirosco::robot_arm
