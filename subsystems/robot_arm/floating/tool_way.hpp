// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/floating/base_estimate.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

/// Through which postures a law of the tool takes the joints on a straight course, reckoned before anybody goes: in so many steps of its time, by the law
/// itself and by the on-board model, whose base gives way without momentum. A joint that its course would have faster than it may be falls behind here as well.
/// Noise and a momentum of the craft's it knows nothing of.
/// Realtime: bounded, no allocation after construction. Thread: one.
class ToolWay {
 public:
  static constexpr int steps = 64;

  struct Plan {
    ToolLaw law{ToolLaw::FixedBase};
    robotics::Pose base{};  ///< as it is
    robotics::Matrix3 base_kept{robotics::Matrix3::Identity()};  ///< by AttitudeHold
    JointVector position{};
    robotics::Pose tool{};  ///< where it is to be when it begins
    Vector3 offset_m{Vector3::Zero()};
    double duration_s{1};
    double cycle_s{0.001};  ///< of who will go it
    PreferredPosture preferred{};  ///< to where joints go that the tool leaves free
  };
  /// `model` must outlive this.  Realtime: allocates.
  ToolWay(const robotics::Model& model, robotics::FrameId tip) : model_{model, tip} {}

  /// As of FloatingModel; of ways that begin later.
  void carry(const robotics::Pose& tool_in_tip, const Payload& payload) noexcept { model_.carry(tool_in_tip, payload); }
  void begin(const Plan& plan) noexcept;
  /// On by one of them. False: none is left, or whoever goes there is stopped for another reason, and nobody knows farther.
  [[nodiscard]] bool step(Bounds bounds) noexcept;
  /// Of the last step.
  [[nodiscard]] const JointVector& posture() const noexcept { return posture_; }

 private:
  [[nodiscard]] bool go_on(Bounds bounds) noexcept;
  [[nodiscard]] JointVector rates(Bounds bounds, double step_s) const noexcept;
  [[nodiscard]] bool comes_to_end(const JointVector& way, Bounds bounds) const noexcept;

  FloatingModel model_;
  BaseEstimate base_;
  Plan plan_;
  JointVector posture_;
  int taken_{steps};
};

}  // namespace hirosco::robot_arm
