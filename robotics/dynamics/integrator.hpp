// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "robotics/dynamics/dynamics.hpp"

namespace hirosco::robotics {

/// Classical Runge-Kutta of fourth order over the equations of motion, with the damping of the joints: forces are
/// `force(t, coordinates)` less damping times joint velocity. Friction is not applied.
/// Realtime: wait-free, where `force` is. Thread: one.
class Integrator {
 public:
  explicit Integrator(Dynamics& dynamics) noexcept;

  /// What force acts at a time: fills all coordinates, the base's, too.
  class Force {
   public:
    virtual ~Force() = default;
    virtual void at(double t_s, Coordinates& force) const noexcept = 0;
  };

  /// The accelerations now. OutOfRange as Dynamics::forward().
  [[nodiscard]] Result<> acceleration(const State& state, double t_s, const Force& force,
                                      Coordinates& acceleration) noexcept;
  /// One step from t to t + h. OutOfRange: as above, or the result is no number; `state` is then worth nothing.
  [[nodiscard]] Result<> step(State& state, double t_s, double h_s, const Force& force) noexcept;

 private:
  /// A state as numbers that are added up; the quaternion is of length 1 only about.
  struct Point {
    Vector3 position;
    Eigen::Vector4d orientation;  ///< x y z w
    Vector6 twist;
    JointVector q;
    JointVector qd;
  };
  [[nodiscard]] Result<> slope(const Point& at, double t_s, const Force& force, Point& slope) noexcept;
  void add(Point& to, double h, const Point& slope) const noexcept;

  Dynamics* dynamics_;
  State stage_;
  Coordinates force_;
  Coordinates acceleration_;
};

}  // namespace hirosco::robotics
