// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/torque_drive.hpp"
#include "subsystems/robot_arm/control/work_bounds.hpp"
#include "subsystems/robot_arm/floating/float_law.hpp"
#include "subsystems/robot_arm/floating/law_change.hpp"
#include "subsystems/robot_arm/floating/soft_law.hpp"

namespace hirosco::robot_arm {

/// All laws that make torques of a floating arm (docs/adr/0235), one of them in force, from each to each without a step; within efforts, and within the force of the tool and the power of joints and tool that may be commanded.
/// Position is the law of velocities: joints follow those that are asked for.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class FloatingLaws {
 public:
  /// Of a cycle.
  struct Now {
    LawKind kind{LawKind::Position};
    JointVector rates;  ///< of Position
    SoftGoal goal;  ///< of springs
    Driven driven;  ///< of Torque
    ToolLaw axes{ToolLaw::FixedBase};  ///< of the tool's goal
    double followed_per_s{robot_arm::followed_per_s};
    double float_damping_per_s{5};
    const ToolLever* lever{nullptr};  ///< none: nothing bounds force and power
    WorkLimits work{};
  };
  /// In configure(), of so many joints: nothing was put out.
  void begin(Eigen::Index joints, double cycle_s) noexcept;
  void set(const Impedance& impedance) noexcept { soft_.set(impedance); }
  [[nodiscard]] const Impedance& impedance() const noexcept { return soft_.impedance(); }
  /// As of SoftLaw: no faster than this.
  [[nodiscard]] double fastest_swing_rad_s() const noexcept { return fastest_swing_; }
  [[nodiscard]] double swings_rad_s(LawKind kind, ToolLaw axes, const Impedance& impedance,
                                    const FloatingModel& model) noexcept {
    return soft_.swings_rad_s(kind, axes, impedance, model);
  }
  /// What springs hold is elsewhere from now on.
  void jump() noexcept { change_.change(LawChange::smooth_s); }

  [[nodiscard]] const JointVector& torque(const FloatingModel& model, const Measured& measured, Bounds bounds,
                                          const Now& now) noexcept;

 private:
  void take(LawKind kind) noexcept;
  [[nodiscard]] JointVector asked(const FloatingModel& model, const Measured& measured, Bounds bounds, const Now& now,
                                  JointVector& carrying) noexcept;
  [[nodiscard]] JointVector moved_by_model(const FloatingModel& model, const Now& now) noexcept;

  SoftLaw soft_;
  FloatAims aims_;
  LawChange change_;
  LawKind kind_{LawKind::Position};
  JointVector expected_;  ///< rad/s or m/s that Position would have by now with nobody in the way
  JointVector torque_;
  double cycle_s_{0.001}, fastest_rad_s_{0}, fastest_swing_{0};
};

}  // namespace hirosco::robot_arm
