// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/control/law.hpp"
#include "subsystems/robot_arm/control/torque_drive.hpp"
#include "subsystems/robot_arm/control/walls.hpp"

namespace hirosco::robot_arm {

/// Which law makes torques of setpoints.
enum class LawKind : std::uint8_t {
  Position,  ///< computed torque: keeps its place against what acts from outside
  JointImpedance,  ///< springs and dampers at the joints
  ToolImpedance,  ///< springs and dampers between the tool and where it is to be
  Float,  ///< goes wherever it is led, against dampers alone
  Torque,  ///< goes where the torques of drive() lead it
};

/// How softly an arm is held. Each damper is so large as its spring and what it moves make it with this ratio; 1: critical.
struct Impedance {
  JointVector joint_n_m_rad;  ///< of each joint
  double tool_n_m{0};  ///< N/m, in all directions
  double tool_n_m_rad{0};  ///< N m/rad, about all axes
  double damping_ratio{0.7};
};

/// An arm that gives way. What it is held with are potentials, of springs and gravity, and dampers: whoever pushes gets back no
/// more than he gave, whatever the arm does (passivity); the links' inertia and Coriolis forces are left as they are. Besides,
/// each joint has a spring before the end of its range and a damper before its velocity, in all of these laws.
class Compliance {
 public:
  struct Settings {
    LawKind kind{LawKind::Float};
    /// Of Float: how fast it comes to rest when nobody leads it, 1/s.
    double float_damping_per_s{5};
    std::span<const double> rotor{};  ///< as in Law::Settings
    Vector3 gravity_m_s2{Vector3::Zero()};
    /// What the cycle leaves (robotics::fastest_rad_s): springs of joints and dampers are no stronger.
    double fastest_rad_s{robotics::fastest_rad_s(0.001)};
  };
  Compliance(const robotics::Model& model, robotics::FrameId tip);

  /// Where the tool is in the tip's frame.
  void set_tool(const Vector3& place_m) noexcept { tool_m_ = place_m; }
  void set(const Impedance& impedance) noexcept { impedance_ = impedance; }
  [[nodiscard]] const Impedance& impedance() const noexcept { return impedance_; }
  /// The law is Float from now on: as of FloatAims.
  void let_go() noexcept { float_aims_.let_go(); }
  /// From now on, while the law is Torque.
  void drive(const Driven& driven) noexcept { driven_ = driven; }

  /// Not yet within the joints' efforts. `dynamics` was updated with what is measured.
  [[nodiscard]] JointVector torque(const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
                                   const Payload& payload, Bounds bounds, const Settings& settings) noexcept;

  /// What of the last torque() carries the arm and keeps it within ranges and velocities; the rest presses.
  [[nodiscard]] const JointVector& carrying() const noexcept { return carrying_; }

  /// The first spring, from 0, with which what it moves in the posture of `dynamics` would swing faster than `rad_s`: a joint's, or a
  /// direction of the tool's, x y z about and x y z along. Nothing: all are softer.
  [[nodiscard]] std::optional<std::size_t> too_stiff(LawKind kind, const Impedance& impedance,
                                                     robotics::Dynamics& dynamics, std::span<const double> rotor,
                                                     double rad_s) noexcept;

 private:
  void weigh(robotics::Dynamics& dynamics, std::span<const double> rotor) noexcept;
  [[nodiscard]] Jacobian tool_jacobian(const robotics::Dynamics& dynamics) const noexcept;
  [[nodiscard]] Vector6 tool_inertia(const Jacobian& jacobian) noexcept;
  void add_tool(const Setpoint& wanted, const Measured& measured, const robotics::Dynamics& dynamics,
                double fastest_rad_s, JointVector& torque) noexcept;

  const robotics::Model* model_;
  robotics::FrameId tip_;
  Vector3 tool_m_{Vector3::Zero()};
  Impedance impedance_;
  Driven driven_;
  JointVector carrying_;
  FloatAims float_aims_;
  robotics::Dynamics still_;  ///< as measured, at rest: gravity alone
  robotics::Dynamics goal_;  ///< as wanted
  robotics::State state_;
  robotics::MassMatrix mass_;  ///< with rotors
  Eigen::LLT<robotics::MassMatrix> factors_;
};

}  // namespace hirosco::robot_arm
