// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "subsystems/robot_arm/control/braking.hpp"
#include "subsystems/robot_arm/control/joints.hpp"
#include "subsystems/robot_arm/control/line.hpp"
#include "subsystems/robot_arm/control/power_pace.hpp"
#include "subsystems/robot_arm/control/tool_kinematics.hpp"

namespace hirosco::robot_arm {

/// The tool on a straight line: the arm stands while that is surveyed, then goes along it, and comes back to it where joints have left it. Braked, for its power,
/// or where joints cannot follow, its time goes slower.
class LineMotion {
 public:
  /// What a cycle brings.
  struct Step {
    std::optional<JointVector> rates{};  ///< of the joints; nothing: they stand
    bool ends{false};  ///< it rests then
  };

  LineMotion(const robotics::Model& model, robotics::FrameId tip, Bounds bounds, double cycle_s);

  /// From rest in this posture. InvalidArgument: as of Line.
  [[nodiscard]] Result<> begin(const robotics::Pose& goal, const Line::Speed& speed, const JointVector& posture,
                               ToolKinematics& tool, const PreferredPosture& preferred) noexcept;
  /// From this setpoint to that of the next cycle.
  [[nodiscard]] Step advance(const Setpoint& now, bool braking, const PowerPace& power, ToolKinematics& tool) noexcept;
  /// Where it would come to rest if it went on for a cycle and braked then.
  [[nodiscard]] JointVector braked(const JointVector& position) const noexcept;
  [[nodiscard]] const Line& line() const noexcept { return line_; }
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  /// 0 to 1.
  [[nodiscard]] double progress() const noexcept { return progress_on(line_.path(), on_); }
  /// How far the setpoint's tool was from where the line has it, m.
  [[nodiscard]] double off_m() const noexcept { return off_m_; }
  /// How far the line has led it.
  [[nodiscard]] double gone_m() const noexcept { return sample_.position[0] * line_.length_m(); }

 private:
  [[nodiscard]] Step survey(bool braking) noexcept;
  void keep_pace(const JointVector& onward, const JointVector& back, const JointVector& velocity, bool braking,
                 const PowerPace& power) noexcept;
  void keep_limits(const JointVector& velocity, JointVector& rates) noexcept;

  Bounds bounds_;
  double cycle_s_;
  Line line_;
  robotics::PointToPoint::Sample sample_{};
  OnWay on_{};
  double duration_s_{0};
  double off_m_{0};
  JointVector posture_;  ///< to which joints are drawn that the tool leaves free, and so fast, 1/s
  double drawn_per_s_{1};
};

}  // namespace hirosco::robot_arm
