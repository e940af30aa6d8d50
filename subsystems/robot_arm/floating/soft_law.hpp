// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "subsystems/robot_arm/control/compliance.hpp"
#include "subsystems/robot_arm/floating/floating_model.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"

namespace hirosco::robot_arm {

/// Where springs of a floating arm have it: joints, or the tool.
struct SoftGoal {
  Setpoint joints;  ///< no acceleration of it counts
  ToolGoal tool;
};

/// Springs at the joints or at the tool of an arm whose base gives way (docs/adr/0235), and dampers beside them: of each way in which what the joints move swings on these springs, H* and all, with one ratio, so that no
/// light joint is damped as a heavy one. What springs leave free comes to rest. What it is held with are potentials, and dampers: nothing of it drives.
/// Realtime: bounded, no allocation. Thread: one.
class SoftLaw {
 public:
  /// `joints`: so many.
  void begin(Eigen::Index joints) noexcept;
  void set(const Impedance& impedance) noexcept { impedance_ = impedance; }
  [[nodiscard]] const Impedance& impedance() const noexcept { return impedance_; }

  /// Not yet within the joints' efforts, nor their ranges. `kind`: JointImpedance or ToolImpedance; `law`: whose axes the tool's goal has; of AttitudeHold there is none.
  /// `strongest_per_s`: no damper is stronger, of what it moves.
  [[nodiscard]] JointVector torque(LawKind kind, ToolLaw law, const FloatingModel& model, const Measured& measured,
                                   const SoftGoal& goal, Bounds bounds, double strongest_per_s) noexcept;

  /// With which the fastest of them would swing, rad/s, where a payload that was said to be there is not.
  [[nodiscard]] double swings_rad_s(LawKind kind, ToolLaw law, const Impedance& impedance,
                                    const FloatingModel& model) noexcept;

 private:
  void find_ways(LawKind kind, ToolLaw law, const Impedance& impedance, const FloatingModel& model) noexcept;
  [[nodiscard]] JointVector damped(const JointVector& slower, double strongest_per_s) const noexcept;

  Impedance impedance_;
  FloatingModel::Square springs_, factor_, ways_;
  Eigen::LLT<FloatingModel::Square> moved_;
  Eigen::SelfAdjointEigenSolver<FloatingModel::Square> swings_;
};

}  // namespace hirosco::robot_arm
