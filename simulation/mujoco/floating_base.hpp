// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <expected>
#include <string>

#include <mujoco/mujoco.h>

namespace hirosco::simulation {

/// What a robot's root link is when nothing holds it: a free body with three reaction wheels about its axes, at its centre of mass, and
/// thrusters that turn it. The wheels are bodies of MuJoCo's like all others, so what they take up is part of what is conserved. They count in
/// the root link's mass and inertia: with wheels that are not driven it resists a rotation by just what its file says.
/// An orientation is w x y z, inertial from base; torques and rates are in the base's axes.
/// Realtime: does not allocate. Thread: one.
class FloatingBase {
 public:
  using Vector = std::array<double, 3>;
  using Quaternion = std::array<double, 4>;
  static constexpr int wheels = 3;
  static constexpr int dofs = 6 + wheels;
  static constexpr double wheel_torque_n_m = 0.25;
  static constexpr double wheel_momentum_n_m_s = 8;
  static constexpr double thruster_torque_n_m = 1.2;

  /// Lets the link of this name float in what is to be compiled. In words why not.
  [[nodiscard]] static std::expected<void, std::string> add_to(mjSpec& spec, const std::string& root);

  FloatingBase() = default;
  /// Of a compiled model; takes the wheels out of the root link.
  void find(mjModel& model, const std::string& root) noexcept;
  [[nodiscard]] bool floats() const noexcept { return body_ > 0; }

  [[nodiscard]] Vector position_m(const mjData& data) const noexcept;  ///< of the root link's origin
  [[nodiscard]] Quaternion orientation(const mjData& data) const noexcept;
  [[nodiscard]] Vector rate_rad_s(const mjData& data) const noexcept;
  [[nodiscard]] Vector velocity_m_s(const mjData& data) const noexcept;  ///< of the origin, inertial axes
  [[nodiscard]] Vector wheels_n_m_s(const mjData& data) const noexcept;
  /// Of all that floats, with the wheels: angular about its centre of mass, and linear; inertial axes.
  struct Momentum {
    Vector angular_n_m_s{};
    Vector linear_n_s{};
  };
  [[nodiscard]] Momentum momentum(const mjModel& model, mjData& data) const noexcept;

  /// What a motion begins with: [rate; velocity of the origin], both in the base's axes.
  void set_twist(mjData& data, const std::array<double, 6>& twist) const noexcept;
  void set_wheels(mjData& data, const Vector& momentum_n_m_s) noexcept;
  /// On the base, held to what wheels and thrusters have, until it is another.
  void drive(const Vector& by_wheels, const Vector& by_thrusters) noexcept;
  /// Before a step.
  void apply(mjData& data) const noexcept;

 private:
  int body_{0};
  int position_{0};  ///< index in MuJoCo
  int dof_{0};
  std::array<int, wheels> wheel_dof_{};
  Vector by_wheels_{}, by_thrusters_{};
};

}  // namespace hirosco::simulation
