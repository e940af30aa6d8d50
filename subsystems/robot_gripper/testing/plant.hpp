// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "subsystems/robot_gripper/control/fingers.hpp"

/// Finger joints for tests of the control, and what is between them. The world of a flight is another one (simulation/mujoco).
namespace hirosco::robot_gripper::testing {

class Plant {
 public:
  explicit Plant(const Fingers& fingers) : fingers_{fingers} {
    measured_ = {Joints::zeros(fingers.count()), Joints::zeros(fingers.count()), Joints::zeros(fingers.count())};
    open(1);
  }
  /// This share of the range.
  void open(double share) {
    for (std::size_t i = 0; i < fingers_.count(); ++i) {
      measured_.position[i] = fingers_[i].closed + share * (fingers_[i].open - fingers_[i].closed);
      measured_.velocity[i] = measured_.torque[i] = 0;
    }
  }
  /// Steps of 50 us. Stops of the joints are stiff, too.
  void step(const Joints& drive, double span_s) {
    constexpr double h = 50e-6;
    for (double t = 0; t < span_s - h / 2; t += h) {
      const double into_m = object_m.value_or(-1) - fingers_.width(measured_.position);
      const double rate_m_s = -fingers_.speed(measured_.velocity);
      pressed_n = into_m > 0 ? std::max(0.0, stiffness * into_m + damping * rate_m_s) : 0;
      for (std::size_t i = 0; i < fingers_.count(); ++i) {
        const Finger& its = fingers_[i];
        double& q = measured_.position[i];
        double& qd = measured_.velocity[i];
        const double way = (its.open - its.closed) / fingers_.full_width_m();
        double force = drive[i] - friction_factor * its.friction * std::tanh(qd / 1e-4);
        measured_.torque[i] = force;
        force += (pressed_n + pulled_open_n) / (static_cast<double>(fingers_.count()) * way);
        const double past = q < its.lowest() ? its.lowest() - q : q > its.highest() ? its.highest() - q : 0;
        if (past != 0) force += 1e5 * past - 300 * qd;
        const double acceleration = force / its.moved;
        measured_.torque[i] -= rotor_share * its.moved * acceleration;
        qd += h * acceleration;
        q += h * qd;
      }
    }
  }
  [[nodiscard]] const Measured& measured() const { return measured_; }
  [[nodiscard]] double width_m() const { return fingers_.width(measured_.position); }
  [[nodiscard]] double closing_m_s() const { return -fingers_.speed(measured_.velocity); }

  std::optional<double> object_m;  ///< its width
  double stiffness{2e4}, damping{200};
  double pulled_open_n{0};
  double friction_factor{1};
  double rotor_share{0.8};  ///< of what a joint moves
  double pressed_n{0};

 private:
  Fingers fingers_;
  Measured measured_;
};

}  // namespace hirosco::robot_gripper::testing
