// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "robotics/motion/inverse_kinematics.hpp"
#include "robotics/motion/point_to_point.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/preferred_posture.hpp"

namespace hirosco::robot_arm {

/// Axis times angle.
[[nodiscard]] inline Vector3 rotation_vector(const robotics::Matrix3& rotation) noexcept {
  const Eigen::AngleAxisd turned{rotation};
  return turned.angle() * turned.axis();
}

/// A straight line of the tool, turning about one axis meanwhile, on a jerk-limited path in time. Before the arm goes, the line is walked along in steps of that
/// time, a step in a cycle: whether its joints can follow, and at which places its time has to go slower for them.
class Line {
 public:
  /// Of path time, in full motion it is reached in so long.
  static constexpr double ramp_s = 0.4;
  struct Speed {
    double linear_m_s{0};
    double angular_rad_s{0};
  };
  enum class Found : std::uint8_t { NotYet, Way, Nothing };

  Line(const robotics::Model& model, robotics::FrameId tip, Bounds bounds);

  /// Of the tool, from rest in this posture; then survey() has found nothing yet. InvalidArgument: there is no way, or no speed.
  [[nodiscard]] Result<> plan(const robotics::Pose& from, const robotics::Pose& goal, const robotics::Pose& tool_in_tip,
                              const Speed& speed, const JointVector& posture) noexcept;
  /// Of this plan, before its survey: joints that the tool leaves free go to that posture while it goes.
  void prefer(const PreferredPosture& preferred) noexcept { preferred_ = preferred; }
  /// Walks on by one step at most.
  void survey() noexcept;
  [[nodiscard]] Found found() const noexcept { return found_; }

  // --- of a survey that has ended -----------------------------------------------------------------------------------------
  /// At the end of the line; of one that cannot be followed: where it was lost.
  [[nodiscard]] const JointVector& posture() const noexcept { return next_; }
  /// Who is at an end of its range where it was lost; nobody: it is out of reach, or singular.
  [[nodiscard]] std::optional<std::size_t> joint_in_the_way() const noexcept;
  /// So much of it can be followed.
  [[nodiscard]] double free_m() const noexcept;
  /// With which its time may go there, 0 to 1, and how fast that may change, 1/s.
  [[nodiscard]] double pace(double path_s) const noexcept;
  [[nodiscard]] double change_per_s(double path_s) const noexcept;
  /// With these paces.
  [[nodiscard]] double duration_s() const noexcept;
  /// There, straight between two steps; and what the joints do there at full pace.
  [[nodiscard]] JointVector posture_at(double path_s) const noexcept;
  [[nodiscard]] JointVector onward(double path_s) const noexcept;

  // --- of a plan ----------------------------------------------------------------------------------------------------------
  /// From 0 to 1 in its own time.
  [[nodiscard]] const robotics::PointToPoint& path() const noexcept { return path_; }
  [[nodiscard]] robotics::Pose at(double share) const noexcept;
  /// Of the tool, for the whole line in one second: [ω; v].
  [[nodiscard]] Vector6 twist() const noexcept;
  [[nodiscard]] double length_m() const noexcept { return way_m_.norm(); }
  /// Of its share in full motion, 1/s.
  [[nodiscard]] double rate() const noexcept { return rate_; }
  /// Who goes along a line goes by this: near a singular posture slowly, rather than off it.
  [[nodiscard]] const robotics::InverseKinematics& kinematics() const noexcept { return kinematics_; }

 private:
  static constexpr std::size_t steps = 64;

  [[nodiscard]] double step_s() const noexcept { return path_.duration_s() / steps; }
  [[nodiscard]] double share_at(std::size_t step) const noexcept;
  [[nodiscard]] JointVector drawn_to() const noexcept;
  [[nodiscard]] bool nearly_there(const robotics::Pose& tip) noexcept;
  void take_step() noexcept;
  void bound(std::size_t step) noexcept;
  void smooth() noexcept;

  Bounds bounds_;
  robotics::InverseKinematics kinematics_;
  robotics::PointToPoint path_{};
  robotics::Pose from_{}, tool_{};
  PreferredPosture preferred_;
  Vector3 way_m_{Vector3::Zero()}, axis_{Vector3::UnitZ()};
  double angle_{0};
  double rate_{1};
  Found found_{Found::NotYet};
  std::size_t reached_{0};
  int tries_{0};
  JointVector two_back_, one_back_, next_;
  std::array<JointVector, steps + 1> postures_{};
  std::array<double, steps + 1> square_{};  ///< of the pace, at each step
  std::array<double, steps + 1> change_{};
};

}  // namespace hirosco::robot_arm
