// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "robotics/limits/two_of_three.hpp"
#include "subsystems/robot_gripper/control/fingers.hpp"
#include "subsystems/robot_gripper/control/opening.hpp"

namespace hirosco::robot_gripper {

/// How the force between fingers is found.
enum class Law : std::uint8_t {
  Width,  ///< keeps to a wanted width
  Reach,  ///< closes with a speed, never harder than it is to press, until it meets something
  Press,  ///< presses with a force, by its sensors; what gives way it follows, no faster than it would reach
};

/// The laws of a gripper, one in force. The force that closes is bounded in each: by `Settings::width_force_n` where it keeps a width, by the
/// force that it is to press with where it grips.
class Grip {
 public:
  struct Settings {
    double bandwidth_rad_s{40};
    double width_force_n{10};  ///< most of Law::Width
    double acceleration_m_s2{1};  ///< of reaching
    double cycle_s{0.001};
  };
  Grip() = default;
  Grip(const Fingers& fingers, const Settings& settings) noexcept : fingers_{fingers}, settings_{settings} {}

  /// Keeps a width from now on.
  void keep() noexcept;
  /// Keeps the width; what it presses with goes bit by bit.
  void let_go() noexcept;
  /// Closes until it presses; who presses already does so with the new force.
  void grip(double force_n, double speed_m_s) noexcept;
  /// Presses at once with what it pressed with when it was interrupted.
  void press_on(double force_n, double speed_m_s) noexcept;
  /// One cycle's torques.
  [[nodiscard]] Joints torques(const Opening::Wanted& wanted, const Measured& measured) noexcept;

  [[nodiscard]] Law law() const noexcept { return law_; }
  [[nodiscard]] double wanted_force_n() const noexcept { return law_ == Law::Width ? 0 : force_n_; }
  /// How long it has pressed at rest with the force that it is to press with, within `share` of it.
  [[nodiscard]] double settled_s() const noexcept { return settled_s_; }
  void set_tolerance(double share) noexcept { tolerance_ = share; }

 private:
  [[nodiscard]] double keep_width(const Opening::Wanted& wanted, double width_m, double speed_m_s) noexcept;
  [[nodiscard]] double leave() noexcept;
  [[nodiscard]] double reach(double speed_m_s, double force_n) noexcept;
  [[nodiscard]] double press(double speed_m_s, double force_n) noexcept;

  Fingers fingers_;
  Settings settings_;
  Law law_{Law::Width};
  double force_n_{0}, speed_m_s_{0};  ///< of gripping
  double tolerance_{0.05};
  double integral_n_{0};  ///< of Width and Reach
  double reaching_m_s_{0};  ///< wanted speed of closing, on its way to speed_m_s_
  double reached_s_{0}, stalled_s_{0};
  robotics::TwoOfThree met_, gone_;
  double pressing_n_{0}, trim_n_{0};
  double leaves_n_{0}, leaving_n_{0};  ///< of what it lets go: what is left of it, and what it was
  double settled_s_{0};
};

/// What is between the fingers, as far as their sensors can tell: from when on something is held, and when it is no longer.
class Held {
 public:
  enum class Change : std::uint8_t {
    None,
    LostClosed,  ///< the fingers have closed further than they held
    LostOpened,  ///< they have been forced open
  };
  void hold(double width_m) noexcept;
  void let_go() noexcept { held_ = false; }
  /// Two of three samples that are farther than `distance_m` from where it was held: told once.
  [[nodiscard]] Change update(double width_m, double distance_m) noexcept;
  [[nodiscard]] bool held() const noexcept { return held_; }
  [[nodiscard]] double width_m() const noexcept { return width_m_; }

 private:
  bool held_{false};
  double width_m_{0};
  robotics::TwoOfThree closed_, opened_;
};

}  // namespace hirosco::robot_gripper
