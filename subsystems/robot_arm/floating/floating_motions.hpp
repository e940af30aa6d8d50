// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/floating/floating_guidance.hpp"
#include "subsystems/robot_arm/floating/floating_tool_lead.hpp"
#include "subsystems/robot_arm/lead.hpp"

namespace hirosco::robot_arm {

/// What telecommands ask of the guidance of a craft that floats.
/// Realtime: bounded. Thread: the cycle, and the service loop while there is none.
class FloatingMotions final : public FloatingGuidance {
 public:
  using FloatingGuidance::FloatingGuidance;

  // --- functions: refused, or running; numbers in the order of the descriptor ---------------------------------------------
  /// The way of each is walked along while it stands, in the next cycles, and judged before it goes; PROGRESS tells where somebody is in a way of joints.
  [[nodiscard]] Outcome move_joint(const FunctionValues& values) noexcept;
  [[nodiscard]] Outcome move_tool(const std::array<double, 3>& offset_m, double duration_s) noexcept;

  /// With these velocities for so long, then to rest. Who jogs so goes on from the velocities that he has.
  [[nodiscard]] Outcome jog_joints(const FunctionValues& values) noexcept;
  [[nodiscard]] Outcome jog_tool(const std::array<double, 3>& moving_m_s, const std::array<double, 3>& turning_rad_s,
                                 double span_s) noexcept;

  /// By these torques for so long; then it stands. Who drives it on goes on from the torques that it has.
  [[nodiscard]] Outcome drive(const FunctionValues& values) noexcept;

  /// After whoever leads its joints, from where they are to be.
  [[nodiscard]] Outcome follow(Lead& lead) noexcept;
  /// After whoever leads its tool, from where that is to be.
  [[nodiscard]] Outcome follow(FloatingToolLead& lead) noexcept;

  /// Of who follows with his tool, each cycle before he goes on (advance()): with these velocities; `over`: nobody leads him any more, and he stands.
  void lead_tool(const Vector3& turning_rad_s, const Vector3& moving_m_s, bool over) noexcept;
  /// Where it is to be.
  [[nodiscard]] const robotics::Pose& tool_goal() const noexcept { return kept_.goal().pose; }

  /// Out, by its joints in whatever law. Who comes to rest by stop() begins once it stands, unless end_motion() comes before.
  [[nodiscard]] Outcome leave(FloatingWayOut::By by, double number) noexcept;
  /// The stored path alone is judged; nothing moves.
  [[nodiscard]] Outcome check_abort() noexcept;

 private:
  [[nodiscard]] JointVector from() const noexcept;
};

}  // namespace hirosco::robot_arm
