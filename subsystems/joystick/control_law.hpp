// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// The control laws of the joystick, free of the framework: numbers in, numbers out.
/// All of it: Realtime: bounded, no allocation, no system call. Thread: the cycle.
namespace hirosco::joystick {

using Axes = std::array<double, 2>;

/// What the hand is to feel of the robot. The law is replaceable while the hand is on it: another one takes over the
/// torque that is shown. Every law counts per axis the energy that the display took in (above 0) or gave (below 0).
class DisplayLaw {
 public:
  static constexpr double torque_max_n_m = 1.5;
  /// From the full torque to none when the peer falls silent: no kick in the hand.
  static constexpr int ramp_cycles = 4;

  /// `peer_active`: the link is valid and the robot says that it is active.
  struct Input {
    Axes velocity_rad_s{};
    Axes peer_torque_n_m{};
    bool peer_active{false};
  };

  /// `period_s` of the cycle, above 0.
  explicit DisplayLaw(double period_s) noexcept : period_s_{period_s} {}
  virtual ~DisplayLaw() = default;

  /// Forgets the past.
  void reset() noexcept { state_ = {}; }
  /// Goes on from what `other` shows; its own energy count starts at zero.
  void take_over(const DisplayLaw& other) noexcept;
  /// Torque for the handle's motors, N m, within +-torque_max_n_m.
  [[nodiscard]] Axes torque(const Input& input, double force_scale) noexcept;

  [[nodiscard]] const Axes& observed_energy_j() const noexcept { return state_.energy_j; }
  [[nodiscard]] double dissipated_j() const noexcept { return state_.dissipated_j; }
  [[nodiscard]] bool clipped() const noexcept { return state_.clipped; }          ///< in the last cycle
  [[nodiscard]] bool controller_acted() const noexcept { return state_.acted; }  ///< passivity, in the last cycle

 protected:
  DisplayLaw(const DisplayLaw&) = default;
  DisplayLaw& operator=(const DisplayLaw&) = default;
  /// Damping in N m s/rad to add in this cycle at an axis, whose energy count already holds the torque that is wanted.
  [[nodiscard]] virtual double damping(double energy_j, double velocity_rad_s) const noexcept = 0;
  [[nodiscard]] double period_s() const noexcept { return period_s_; }

 private:
  [[nodiscard]] double observed(std::size_t axis, double torque_n_m, double velocity_rad_s) noexcept;

  struct State {
    Axes held_n_m{};
    int share{0};  // of ramp_cycles
    Axes energy_j{};
    double dissipated_j{0};
    bool clipped{false};
    bool acted{false};
  };
  double period_s_;
  State state_{};
};

/// Position-force coupling as in the paper: tau_s = -s_f tau_j. Unstable on stiff contact above some force scale or delay.
class PositionForce final : public DisplayLaw {
 public:
  using DisplayLaw::DisplayLaw;

 private:
  [[nodiscard]] double damping(double, double) const noexcept override { return 0; }
};

/// The same with time-domain passivity: whenever the display has given more energy than it got, a damper takes the
/// difference out. Contact stays stable at any force scale and delay.
class PassivePositionForce final : public DisplayLaw {
 public:
  using DisplayLaw::DisplayLaw;

 private:
  [[nodiscard]] double damping(double energy_j, double velocity_rad_s) const noexcept override;
};

}  // namespace hirosco::joystick
