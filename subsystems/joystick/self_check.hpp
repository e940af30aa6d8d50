// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/joystick/control_law.hpp"

namespace hirosco::joystick {

/// What the hand is to feel: as the cycle asks for it, so that what is tried is what will act.
using Law = Axes (*)(DisplayLaw& law, const DisplayLaw::Input& input, double force_scale) noexcept;
[[nodiscard]] inline Axes display_law(DisplayLaw& law, const DisplayLaw::Input& input, double force_scale) noexcept {
  return law.torque(input, force_scale);
}

/// The joystick's self test (adr 0073): whether the handle answers and measures what a handle can, whether anything would push
/// though the robot presses on nothing, and what both laws would show of a robot that presses a little, much, or by no number,
/// that falls silent, and to a hand that moves.
/// A force of the wrong sign would draw the hand into what the robot touches.
/// Realtime: bounded, no allocation. Thread: the cycle.
class SelfCheck {
 public:
  /// Longer than a torque takes to fade.
  static constexpr int cycles = DisplayLaw::ramp_cycles + 2;
  // As joystick.xml says, with which a test compares them.
  static constexpr double range_rad = 0.4;  ///< of the handle between its stops, to either side: what HAND may ask for
  static constexpr double most_scale = 0.1;  ///< maximum of FORCE_SCALE

  /// Of one cycle of Safe-Operational.
  struct Seen {
    bool alive{false};  ///< the handle answers
    Axes position_rad{};
    Axes velocity_rad_s{};
    std::uint8_t hand{0};  ///< whose hand is on it
    std::uint8_t hands{0};  ///< bit of each hand that there is
    Axes shown_n_m{};  ///< what the law has just put out
    bool peer_active{false};  ///< there is a robot whose torque may be shown
    double force_scale{0};
    double period_s{0};
  };

  explicit SelfCheck(Law law = display_law) noexcept : law_{law} {}
  /// `first`: it begins anew.
  [[nodiscard]] Result<Step> step(const Seen& seen, bool first) noexcept;

 private:
  [[nodiscard]] Result<> check_handle(const Seen& seen) noexcept;
  [[nodiscard]] Result<> check_rest(const Seen& seen) noexcept;
  [[nodiscard]] Result<> check_laws(const Seen& seen) const noexcept;
  template <class Display>
  [[nodiscard]] Result<> check_law(double period_s, double force_scale) const noexcept;
  template <class Display>
  [[nodiscard]] Result<> check_fading(double period_s, double force_scale) const noexcept;
  [[nodiscard]] Result<> check_damping(double period_s, double force_scale) const noexcept;

  Law law_;
  int done_{0};  ///< cycles
  int quiet_{0};  ///< cycles in a row without a robot that presses
  Axes last_rad_{};
};

}  // namespace hirosco::joystick
