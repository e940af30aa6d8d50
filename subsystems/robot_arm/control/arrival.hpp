// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Whether a motion has come to where it was to go. The end of its path is not yet the goal: it is done when it is measured there, and rests.
/// Realtime: bounded, no allocation. Thread: any, one at a time.
class Arrival {
 public:
  enum class To : std::uint8_t {
    Nowhere,  ///< it ends by itself, or by who leads it
    WayBack,
    Goal,
  };
  /// Of a motion that begins.
  void begin(To to) noexcept { *this = {}, to_ = to; }
  /// It has a pose for a goal: the tool is to be there too.
  void expect_tool(const Vector3& there_m) noexcept { tool_to_m_ = there_m; }
  [[nodiscard]] bool goes_back() const noexcept { return to_ == To::WayBack; }

  /// Whether half of it is to be told: once, and of who has a goal.
  [[nodiscard]] bool tell_half(bool behind) noexcept;

  // --- at the end of its path ---------------------------------------------------------------------------------------------
  /// It has come to its end, which has the tool there: a goal of joints has it nowhere else, and who has a pose for a goal is turned so. Nothing is
  /// asked of the tool of who has no goal.
  void end_path(const robotics::Pose& tool) noexcept;
  [[nodiscard]] bool path_ended() const noexcept { return path_ended_; }
  /// What the joints have left, rad or m, is no more than `tolerance`, and the tool is as it is to be.
  [[nodiscard]] bool there(const JointVector& left, double tolerance, const robotics::Pose& tool) const noexcept;
  /// Each cycle.
  void wait(bool there, double cycle_s) noexcept;
  [[nodiscard]] bool settled() const noexcept;
  /// It was waited for long enough.
  [[nodiscard]] bool overdue() const noexcept;

 private:
  To to_{To::Nowhere};
  bool half_told_{false};
  std::optional<Vector3> tool_to_m_;
  std::optional<robotics::Matrix3> turned_to_;
  bool path_ended_{false};
  double waited_s_{0};
  double settled_s_{0};
};

}  // namespace hirosco::robot_arm
