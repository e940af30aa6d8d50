// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "subsystems/robot_arm/control/pose_search.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/control/straight_way.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/trouble.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// Why a line is lost, with a joint's number.
inline constexpr const char* ends_range_on_line = "on the line ends the range of joint";

/// What is found out about a motion while the arm stands, a step in a cycle, before it goes: which posture a pose has, whether a line can be followed (docs/adr/0173), who is in
/// the way of joints (docs/adr/0209). One at a time.
/// Realtime: bounded, no allocation, but begin(). Thread: the cycle, and the service loop while there is none.
class Beforehand {
 public:
  struct Parts {
    const UrdfArm& known;
    Obstacles& obstacles;  ///< no goal is near them, and no way of joints
  };
  explicit Beforehand(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);

  // --- each is under way then; step() goes on with it ---------------------------------------------------------------------
  /// The straight way of all joints to a goal, which is gone with this share of their velocities. Or why not, as far as is known at once.
  [[nodiscard]] std::optional<Reason> judge_way(Setpoints& setpoints, const JointVector& goal,
                                                double speed_share) noexcept;
  /// A posture that has the tip there; then the way to it.
  void search(const robotics::Pose& tip, const JointVector& here, double speed_share,
              const PreferredPosture& preferred) noexcept;
  /// The line that was begun last.
  void judge_line() noexcept { under_way_ = Of::Line; }

  [[nodiscard]] bool under_way() const noexcept { return under_way_ != Of::Nothing; }
  /// Each cycle while it is under way: on by a step. A reason: it stays where it is. None, and nothing is under way: it goes.
  [[nodiscard]] std::optional<Reason> step(Setpoints& setpoints) noexcept;
  /// Nobody waits for it any more.
  void end() noexcept { under_way_ = Of::Nothing; }
  /// Of a way of joints that somebody was in: how much of it is before that, 0 to 1; until another one is judged, or forget().
  [[nodiscard]] std::optional<double> blocked_at() const noexcept { return blocked_at_; }
  void forget() noexcept { blocked_at_.reset(); }

 private:
  enum class Of : std::uint8_t { Nothing, Way, Pose, Line };
  [[nodiscard]] std::optional<Reason> forbids(const JointVector& from, const JointVector& posture) noexcept;
  [[nodiscard]] std::optional<Reason> step_way(Setpoints& setpoints) noexcept;
  [[nodiscard]] std::optional<Reason> step_search(Setpoints& setpoints) noexcept;
  [[nodiscard]] std::optional<Reason> step_line(Setpoints& setpoints) noexcept;

  Parts parts_;
  double cycle_s_{0.001};
  Of under_way_{Of::Nothing};
  std::optional<PoseSearch> pose_search_;
  StraightWay way_;
  double speed_share_{0};
  std::optional<double> blocked_at_;
};

}  // namespace hirosco::robot_arm
