// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "robotics/motion/inverse_kinematics.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/preferred_posture.hpp"

namespace hirosco::robot_arm {

/// With which the joints of a pose are looked for, and of a line: as it is gone, and so little at a time that it fits into a cycle.
inline constexpr robotics::InverseKinematicsOptions a_little_at_a_time{
    .singular = 0.02, .damping = 0.02, .tolerance = 1e-7, .most_iterations = 3};

/// Likewise where joints that the tip leaves free go to a posture: until these stand, too, and so slowly that they do not go past it where the way there bends.
inline constexpr robotics::InverseKinematicsOptions to_a_posture{.singular = a_little_at_a_time.singular,
                                                                 .damping = a_little_at_a_time.damping,
                                                                 .posture_gain = 0.5,
                                                                 .tolerance = a_little_at_a_time.tolerance,
                                                                 .most_iterations = a_little_at_a_time.most_iterations,
                                                                 .settled = 1e-5};

/// Looks for the posture with the tip in a pose, on the branch that is nearest to where the arm stands, a little in each cycle. The same pose from the
/// same place is the same posture. Or on the branch that is nearest to a posture that is preferred: the same pose is the same posture from wherever it is looked for, where it is found from
/// there; else as without it, as near to that one as this branch has it. Joints are drawn where there are some to spare (docs/adr/0219).
class PoseSearch {
 public:
  enum class Found : std::uint8_t { NotYet, Posture, Nothing };

  PoseSearch(const robotics::Model& model, robotics::FrameId tip, Bounds bounds)
      : bounds_{bounds}, kinematics_{model, tip, a_little_at_a_time}, drawn_{model, tip, to_a_posture} {}

  void begin(const robotics::Pose& tip, const JointVector& from, const PreferredPosture& preferred = {}) noexcept;
  /// A little farther: at most 50 times until it is NotYet no more, twice as often where a posture is preferred.
  [[nodiscard]] Found step() noexcept;

  /// What was found; of nothing, as near as it came.
  [[nodiscard]] const JointVector& posture() const noexcept { return posture_; }
  /// It is so near to a singular posture that a small way of the tool is a long one of joints.
  [[nodiscard]] bool singular() noexcept;
  /// Of nothing: who is at an end of its range; nobody: it is out of reach.
  [[nodiscard]] std::optional<std::size_t> joint_at_its_end() const noexcept;
  /// Of nothing: it came so near that a singular posture alone keeps it from being there.
  [[nodiscard]] bool nearly() noexcept;
  /// How far the tip is from the pose, m.
  [[nodiscard]] double off_m() noexcept { return kinematics_.left(tip_, posture_).tail<3>().norm(); }

 private:
  [[nodiscard]] bool found_one() noexcept;

  Bounds bounds_;
  robotics::InverseKinematics kinematics_, drawn_;
  robotics::Pose tip_{};
  PreferredPosture preferred_;
  JointVector from_, posture_;
  bool from_preferred_{false};  ///< and not yet from where the arm stands
  int steps_{0};
};

/// Who is at an end of its range there: the one that is nearest to it.
[[nodiscard]] std::optional<std::size_t> at_its_end(Bounds bounds, const JointVector& posture) noexcept;

}  // namespace hirosco::robot_arm
