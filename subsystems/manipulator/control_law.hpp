// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The control laws of the manipulator, free of the framework: numbers in, numbers out.
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::manipulator {

using Joints = std::array<double, 2>;

/// One sample of the arm's sensors.
struct Measured {
  Joints motor_position_rad{};
  Joints motor_velocity_rad_s{};
  Joints position_rad{};
  Joints velocity_rad_s{};
  Joints torque_n_m{};
  std::array<float, 2> temperature_c{};
};

struct Gains {
  double kp_n_m_per_rad{300};
  double kd_n_m_s_per_rad{24};
  /// Of the law without its torque feedback: what the joint is loaded with at rest is no more, whatever the gains.
  double effort_max_n_m{60};
  /// By how much the position error may ask for more than the joint holds already: what is let go, or loses contact, is
  /// caught up with slowly.
  double surplus_max_n_m{60};
};

/// Position control of a flexible joint with torque feedback:
///   u = kp (qd - theta) + kd (qd' - theta'),   tau_m = 4 u - 3 tau_j,
/// which makes the motor feel a quarter as heavy. qd' is the filtered difference of qd. u is kept within the effort of
/// the gains.
class JointController {
 public:
  /// `period_s` of the cycle, above 0.
  explicit JointController(double period_s) noexcept : period_s_{period_s} {}
  /// Forgets the past: the next call sees `desired` standing still.
  void reset(const Joints& desired_rad) noexcept;
  /// Motor torque, N m, within +-torque_max_n_m.
  [[nodiscard]] Joints motor_torque(const Joints& desired_rad, const Measured& measured, const Gains& gains) noexcept;
  [[nodiscard]] const Joints& desired_velocity_rad_s() const noexcept { return velocity_; }

  static constexpr double torque_max_n_m = 60;

 private:
  double period_s_;
  Joints last_{};
  Joints velocity_{};
};

/// Minimum-jerk motion of both joints from rest to rest.
class Trajectory {
 public:
  /// `duration_s` at or below 0 arrives at once.
  void start(const Joints& from_rad, const Joints& to_rad, double duration_s) noexcept;
  /// Ends at the point reached.
  void stop() noexcept;
  /// Moves on and returns the setpoint.
  Joints advance(double span_s) noexcept;
  [[nodiscard]] Joints position_rad() const noexcept;
  [[nodiscard]] const Joints& target_rad() const noexcept { return to_; }
  [[nodiscard]] double duration_s() const noexcept { return duration_s_; }
  [[nodiscard]] double progress() const noexcept;  ///< 0..1 of the time
  [[nodiscard]] bool done() const noexcept { return past_s_ >= duration_s_; }
  /// Largest speed of a joint on this motion, rad/s.
  [[nodiscard]] static double peak_speed(const Joints& from_rad, const Joints& to_rad, double duration_s) noexcept;

 private:
  Joints from_{};
  Joints to_{};
  double duration_s_{0};
  double past_s_{0};
};

/// Maps handle angles to joint angles about the pair at which they were coupled, so that coupling never jumps.
class Clutch {
 public:
  void engage(const Joints& joint_rad, const Joints& handle_rad) noexcept {
    joint_ = joint_rad;
    handle_ = handle_rad;
  }
  [[nodiscard]] Joints desired(const Joints& handle_rad, double position_scale) const noexcept {
    return {joint_[0] + position_scale * (handle_rad[0] - handle_[0]),
            joint_[1] + position_scale * (handle_rad[1] - handle_[1])};
  }
  [[nodiscard]] const Joints& joint_rad() const noexcept { return joint_; }
  [[nodiscard]] const Joints& handle_rad() const noexcept { return handle_; }

 private:
  Joints joint_{};
  Joints handle_{};
};

enum class TorqueVerdict : std::uint8_t { Fine, Soft, Hard };

/// Trips when two of the last three samples of one joint exceed a limit: one disturbed sample does not stop a mission.
class TorqueLimit {
 public:
  void reset() noexcept { *this = {}; }
  /// The worst verdict of both joints; `joint` and `value` tell of which. NaN counts as above every limit.
  struct Finding {
    TorqueVerdict verdict{TorqueVerdict::Fine};
    std::uint8_t joint{0};
    double value_n_m{0};
  };
  [[nodiscard]] Finding update(const Joints& torque_n_m, double soft_n_m, double hard_n_m) noexcept;

 private:
  std::array<std::uint8_t, 2> soft_{};  // last three samples, one bit each
  std::array<std::uint8_t, 2> hard_{};
};

/// What remains of a motor torque while the joint torque is at its limit: it may relieve the joint, not load it further.
[[nodiscard]] Joints relieving(const Joints& motor_torque_n_m, const Joints& joint_torque_n_m,
                               double limit_n_m) noexcept;

enum class TemperatureVerdict : std::uint8_t { Fine, Warning, Critical, Maximum };

struct TemperatureLimits {
  float warning_c{55};
  float critical_c{70};
  float maximum_c{80};
};
/// Verdict of the hotter joint; NaN counts as maximum.
[[nodiscard]] TemperatureVerdict judge(const std::array<float, 2>& temperature_c,
                                       const TemperatureLimits& limits) noexcept;

/// Kinematics as the controller believes them.
struct Geometry {
  double l1_m{0.25};
  double l2_m{0.22};
};
[[nodiscard]] Joints tip(const Geometry& geometry, const Joints& position_rad) noexcept;
/// Joint angles that bring the tip there, second joint bent as at home; the nearest ones where it is out of reach.
[[nodiscard]] Joints joints_for(const Geometry& geometry, const Joints& tip_m) noexcept;
/// Force of the tip on its surroundings that the joint torques tell of at rest: solves J^T f = tau. Zero where the arm is
/// closer to singular than |det J| < 1e-3 m2.
[[nodiscard]] Joints tip_force(const Geometry& geometry, const Joints& position_rad, const Joints& torque_n_m) noexcept;

}  // namespace hirosco::manipulator
