// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The control law of the joystick, free of the framework: numbers in, numbers out.
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::joystick {

using Axes = std::array<double, 2>;

/// What the hand is to feel of the robot's joint torques: tau_s = -s_f tau_j. With passivity on, an observer counts per
/// axis the energy that the display has given and taken; whenever it has given more than it got, a damper takes the
/// difference out (time-domain passivity): contact stays stable at any force scale and delay.
class ForceDisplay {
 public:
  static constexpr double torque_max_n_m = 1.5;
  static constexpr int ramp_cycles =
      4;  ///< from the full torque to none when the peer falls silent: no kick in the hand

  struct Settings {
    double force_scale{0.02};
    bool passivity{false};
  };
  /// `peer_active`: the link is valid and the robot says that it is active.
  struct Input {
    Axes velocity_rad_s{};
    Axes peer_torque_n_m{};
    bool peer_active{false};
  };

  /// `period_s` of the cycle, above 0.
  explicit ForceDisplay(double period_s) noexcept : period_s_{period_s} {}
  void reset() noexcept;
  /// Torque for the handle's motors, N m, within +-torque_max_n_m.
  [[nodiscard]] Axes torque(const Input& input, const Settings& settings) noexcept;

  [[nodiscard]] const Axes& observed_energy_j() const noexcept { return energy_j_; }
  [[nodiscard]] double dissipated_j() const noexcept { return dissipated_j_; }
  [[nodiscard]] bool clipped() const noexcept { return clipped_; }  ///< in the last cycle
  [[nodiscard]] bool controller_acted() const noexcept { return acted_; }  ///< passivity, in the last cycle

 private:
  [[nodiscard]] double made_passive(std::size_t axis, double torque_n_m, double velocity_rad_s) noexcept;

  double period_s_;
  Axes held_n_m_{};
  int share_{0};  // of ramp_cycles
  Axes energy_j_{};
  double dissipated_j_{0};
  bool clipped_{false};
  bool acted_{false};
};

}  // namespace hirosco::joystick
