// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "subsystems/robot_arm/control/straight_way.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_trouble.hpp"
#include "subsystems/robot_arm/floating/tool_way.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Who is in the way of joints or of a tool of a craft that floats: looked at while it stands, a step in a cycle, before it goes (docs/adr/0185, 0209). One at a time.
/// Realtime: bounded, no allocation, but begin(). Thread: the cycle, and the service loop while there is none.
class FloatingBeforehand {
 public:
  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    Obstacles& obstacles;
  };
  explicit FloatingBeforehand(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  /// What is at the tip from now on.
  void carry(const robotics::Pose& tool_in_tip, const Payload& payload) noexcept { tool_->carry(tool_in_tip, payload); }

  // --- each is under way then; step() goes on with it ---------------------------------------------------------------------
  /// To go there in so long. Or why not, as far as is known at once.
  [[nodiscard]] std::optional<FloatingReason> judge(const JointVector& from, const JointVector& goal,
                                                    double duration_s) noexcept;
  void judge(const ToolWay::Plan& plan) noexcept;
  [[nodiscard]] bool under_way() const noexcept { return of_ != Of::Nothing; }
  /// Nobody waits for it any more.
  void end() noexcept { of_ = Of::Nothing; }

  enum class Found : std::uint8_t {
    NotYet,
    JointsMayGo,  ///< by joints()
    ToolMayGo,
    Blocked,  ///< by near(); of a way of joints, joints() tells where
  };
  /// Each cycle while it is under way.
  [[nodiscard]] Found step() noexcept;
  [[nodiscard]] bool of_joints() const noexcept { return of_ == Of::AllJoints; }
  [[nodiscard]] const StraightWay& joints() const noexcept { return joints_; }
  [[nodiscard]] const Obstacles::Nearest& near() const noexcept { return near_; }

 private:
  enum class Of : std::uint8_t { Nothing, AllJoints, Tool };

  Parts parts_;
  double cycle_s_{0.001};
  Of of_{Of::Nothing};
  StraightWay joints_;
  std::optional<ToolWay> tool_;
  Obstacles::Nearest near_{};
};

}  // namespace hirosco::robot_arm
