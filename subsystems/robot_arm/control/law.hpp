// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "subsystems/robot_arm/control/joints.hpp"

namespace hirosco::robot_arm {

/// Friction changes its sign over this speed, rad/s or m/s.
inline constexpr double friction_knee = 0.02;
/// rad or m: at rest an error this small is left alone, a joint with dry friction would hunt for less.
inline constexpr double left_alone = 1e-4;

/// What hangs on the tip besides what the URDF file has: a point with mass.
struct Payload {
  double mass_kg{0};
  Vector3 place_m{Vector3::Zero()};  ///< of its centre of mass, in the tip's frame
};

/// Of what was learnt of a load, joint by joint, what this torque is of it: none of it has the other's sign, and none is more than was learnt.
[[nodiscard]] JointVector learnt_of(const JointVector& learnt, const JointVector& torque) noexcept;

/// Computed torque: the on-board model turns wanted accelerations into torques. An error of position meets one and the same answer
/// in every joint, whatever it carries: as a mass on a spring that is critically damped, with an integral that takes what the model
/// does not know. All three poles are at -bandwidth.
class Law {
 public:
  struct Settings {
    double bandwidth_rad_s{40};
    /// Of a joint's effort, and its dry friction besides, so much is the integral's to learn; at most half as much again in another posture, or by what coupled joints have learnt.
    double integral_share{0.3};
    /// Of each joint: what its drive moves besides links, behind the gear, kg m2 or kg; empty: nothing. The URDF file does not have it.
    std::span<const double> rotor{};
    Vector3 gravity_m_s2{Vector3::Zero()};  ///< for the payload; the same as that of `dynamics`
  };
  Law(const robotics::Model& model, robotics::FrameId tip, double cycle_s);

  /// Forgets what the integral had learnt.
  void reset() noexcept;
  /// What the integral gives of such torques it gives no more: somebody else does, from now on.
  void let_go_of(const JointVector& torque, const Settings& settings) noexcept;
  /// Within the joints' efforts. `dynamics` was updated with what is measured, gravity included.
  [[nodiscard]] JointVector torque(const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
                                   const Payload& payload, Bounds bounds, const Settings& settings) noexcept;
  /// Of the last torque(): some joint had no more to give.
  [[nodiscard]] bool saturated() const noexcept { return saturated_; }
  /// Somebody has taken back some of the last torque(): nothing is learnt from what comes of it.
  void hold_back() noexcept { saturated_ = true; }

  /// What of the last torque() was not the model's, but an answer to errors.
  [[nodiscard]] JointVector answer(const Settings& settings) const noexcept;
  /// Of the last torque(), before efforts bounded it.
  [[nodiscard]] const JointVector& unbounded() const noexcept { return unbounded_; }

  /// What a payload takes when the joints accelerate so.
  static void add_payload(const Payload& payload, robotics::FrameId tip, const Vector3& gravity_m_s2,
                          const robotics::Dynamics& dynamics, const robotics::Coordinates& acceleration,
                          robotics::Coordinates& torque) noexcept;

 private:
  void learn(const JointVector& error, const Setpoint& wanted, const Measured& measured, robotics::Dynamics& dynamics,
             Bounds bounds, const Settings& settings) noexcept;

  const robotics::Model* model_;
  robotics::FrameId tip_;
  double cycle_s_;
  JointVector integral_;  ///< rad s
  JointVector answer_;  ///< rad/s2
  JointVector unbounded_;
  robotics::MassMatrix mass_;
  bool saturated_{false};
};

}  // namespace hirosco::robot_arm
