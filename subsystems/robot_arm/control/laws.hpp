// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/compliance.hpp"
#include "subsystems/robot_arm/control/work_bounds.hpp"

namespace hirosco::robot_arm {

/// All laws of an arm, one of them in force. Whatever is changed by set(), set_tool() and take_load() makes no step in torque: what was
/// put out last is kept, and what the new law would have had instead comes in by and by. Who gives way keeps what the law of
/// positions had learnt of a load that the model does not know, as a constant: an arm that is let go neither sinks nor climbs there.
class Laws {
 public:
  struct Settings {
    Law::Settings position;
    double float_damping_per_s{5};
    /// Of the posture that is measured; none: nothing bounds with which force it presses, and how much work it does.
    const ToolLever* lever{nullptr};
    WorkLimits work{};
  };
  Laws(const robotics::Model& model, robotics::FrameId tip, double cycle_s);

  /// Begins anew with the law of positions: for an arm that its brakes held.
  void reset() noexcept;
  /// What hangs at the tool is known from now on and takes so much more: what of it was learnt before is not held twice.
  void take_load(const JointVector& torque, const Settings& settings) noexcept;
  static constexpr double smooth_s = 0.3;
  void set(LawKind kind, double over_s = smooth_s) noexcept;
  void set(LawKind kind, const Impedance& impedance) noexcept;
  void set_tool(const Vector3& place_m) noexcept;
  /// For what the model does not know, on top of it, in every law that gives way.
  [[nodiscard]] const JointVector& carried() const noexcept { return carried_; }
  void drive(const Driven& driven) noexcept { compliance_.drive(driven); }
  [[nodiscard]] LawKind kind() const noexcept { return kind_; }
  /// Where it is may be far from its setpoint, and that is meant.
  [[nodiscard]] bool gives_way() const noexcept { return kind_ != LawKind::Position; }
  [[nodiscard]] const Impedance& impedance() const noexcept { return compliance_.impedance(); }
  [[nodiscard]] Compliance& compliance() noexcept { return compliance_; }

  /// Within the joints' efforts, and numbers; 0 for what is none. `dynamics` was updated with what is measured, gravity included.
  [[nodiscard]] JointVector torque(const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
                                   const Payload& payload, Bounds bounds, const Settings& settings) noexcept;

 private:
  void carry(const JointVector& answer, Bounds bounds) noexcept;

  LawKind kind_{LawKind::Position};
  Law law_;
  Compliance compliance_;
  double cycle_s_;
  JointVector carried_;  ///< for what the model does not know
  JointVector last_;  ///< put out
  JointVector kept_;  ///< of it, when the law was changed: what the new one would not have
  double fade_s_{smooth_s};
  double fading_s_{0};
  bool changed_{false};
  bool put_out_{false};
};

}  // namespace hirosco::robot_arm
