// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/manipulator/control/joints.hpp"

namespace hirosco::manipulator {

/// Maps handle angles to joint angles about the pair at which they were coupled, so that coupling never jumps.
class Clutch {
 public:
  void engage(const Joints& joint_rad, const Joints& handle_rad) noexcept {
    joint_ = joint_rad;
    handle_ = handle_rad;
  }
  [[nodiscard]] Joints desired(const Joints& handle_rad, double position_scale) const noexcept {
    Joints desired = joint_;
    for (std::size_t i = 0; i < desired.size(); ++i)
      desired[i] = joint_[i] + position_scale * (handle_rad[i] - handle_[i]);
    return desired;
  }
  [[nodiscard]] const Joints& joint_rad() const noexcept { return joint_; }
  [[nodiscard]] const Joints& handle_rad() const noexcept { return handle_; }

 private:
  Joints joint_{};
  Joints handle_{};
};

}  // namespace hirosco::manipulator
