// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/dynamics/dynamics.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/law.hpp"

namespace hirosco::robot_arm {

/// What a robot that floats without momentum does when its joints move: the base gives way, so that momentum stays nothing. Columns are
/// joints; what is told of the tool has inertial axes, of the base its own.
/// Realtime: wait-free after construction. Thread: one.
class FloatingModel {
 public:
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, max_joints>;
  using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, max_joints>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, max_joints, max_joints>;

  /// `model` must outlive this.
  FloatingModel(const robotics::Model& model, robotics::FrameId tip);

  /// What is at the tip from the next update() on: where the tool is in its frame, and what the file does not have. Of that the base gives way less or more, and joints move it.
  void carry(const robotics::Pose& tool_in_tip, const Payload& payload) noexcept {
    in_tip_ = tool_in_tip;
    payload_ = payload;
  }
  /// Where the base is, and the joints. OutOfRange: the robot as a whole has no inertia against a rotation.
  [[nodiscard]] Result<> update(const robotics::Pose& base, const JointVector& position) noexcept;

  [[nodiscard]] const JointVector& position() const noexcept { return state_.q; }
  [[nodiscard]] const robotics::Pose& tool() const noexcept { return tool_; }
  /// Generalised Jacobian: from joint velocities to the tool's twist [ω; v] when nothing holds the base.
  [[nodiscard]] const Twists& tool_of_free() const noexcept { return free_; }
  /// The tool's Jacobian of a base that stands.
  [[nodiscard]] const Twists& tool_of_fixed() const noexcept { return fixed_; }
  /// From joint velocities to the base's twist [ω; v] of its origin, in its axes.
  [[nodiscard]] const Twists& base() const noexcept { return base_; }
  /// What torques make what accelerations of the joints when nothing holds the base.
  [[nodiscard]] const Square& inertia() const noexcept { return inertia_; }
  /// What torques keep all accelerations of the joints 0, when they go like that.
  [[nodiscard]] JointVector bias(const JointVector& velocity) noexcept;
  /// How many times as much they move with what is at the tip as without it, in whatever direction that is most; or more.
  [[nodiscard]] double heavier() const noexcept { return heavier_; }
  /// How well joints can move the tool and leave the base unturned: the smallest singular value of both together, base rates counted tenfold.
  [[nodiscard]] double conditioning() const noexcept;

 private:
  [[nodiscard]] Result<> let_base_go() noexcept;
  void add_payload(const robotics::Pose& tip) noexcept;
  void take_tool(const robotics::Pose& tip) noexcept;

  const robotics::Model* model_;
  robotics::FrameId tip_;
  robotics::Pose in_tip_{};
  Payload payload_;
  double heavier_{1};
  robotics::Dynamics dynamics_;
  robotics::State state_;
  robotics::MassMatrix mass_;
  robotics::Jacobian jacobian_;
  robotics::Pose tool_;
  Twists free_, fixed_, base_;
  Square inertia_;
};

}  // namespace hirosco::robot_arm
