// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/descriptor/read/read.hpp"
#include "robotics/urdf/robot.hpp"
#include "subsystems/robot_arm/control/joints.hpp"

/// Robots for tests of the arm's control, and what moves them there. The world of a flight is another one (simulation/mujoco).
namespace hirosco::robot_arm::testing {

inline const std::string six_axes = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/robot_arm.urdf";

[[nodiscard]] inline robotics::ModelDescription described(const std::string& file) {
  const auto reading = robotics::urdf::read(file, descriptor::file_system());
  for (const auto& problem : reading.problems) ADD_FAILURE() << problem.message;
  return robotics::urdf::describe(reading.value.value());
}
/// Each link so many times as heavy as the file says.
[[nodiscard]] inline robotics::Model model_of(const std::string& file, double mass_factor = 1) {
  auto description = described(file);
  for (auto& joint : description.joints) {
    joint.moved.mass *= mass_factor;
    joint.moved.about_centre *= mass_factor;
  }
  return robotics::Model::make(description).value();
}

[[nodiscard]] inline std::vector<JointBounds> bounds_of(const robotics::Model& model) {
  std::vector<JointBounds> bounds;
  for (const auto& joint : model.joints())
    bounds.push_back({joint.limits.lower.value_or(-HUGE_VAL),
                      joint.limits.upper.value_or(HUGE_VAL),
                      joint.limits.effort.value(),
                      {joint.limits.velocity.value(), 4, 40}});
  return bounds;
}

/// Rigid bodies, viscous damping and dry friction of the file.
class Plant {
 public:
  explicit Plant(const robotics::Model& model) : model_{model}, dynamics_{model, robotics::Base::Fixed} {
    dynamics_.set_gravity({0, 0, -9.81});
    state_.q.setZero(model.joint_count());
    state_.qd = state_.q;
    measured_ = {state_.q, state_.qd, state_.q};
  }
  void place(const JointVector& q) {
    state_.q = measured_.position = q;
    state_.qd.setZero();
    measured_.velocity = state_.qd;
  }
  /// `outside`: what acts on the joints besides.
  void step(const JointVector& drive, double span_s, const JointVector* outside = nullptr) {
    const double h = step_s;
    for (double t = 0; t < span_s - h / 2; t += h) {
      dynamics_.update(state_);
      robotics::Coordinates force = drive, acceleration;
      for (Eigen::Index i = 0; i < force.size(); ++i) {
        const auto& joint = model_.joints()[static_cast<std::size_t>(i)];
        force[i] -= joint.damping * state_.qd[i] + friction_factor * joint.friction * std::tanh(state_.qd[i] / knee);
      }
      measured_.torque = force;
      if (outside != nullptr) force += *outside;
      robotics::MassMatrix mass;
      robotics::Coordinates bias;
      dynamics_.mass_matrix(mass);
      dynamics_.bias(bias);
      for (Eigen::Index i = 0; i < force.size(); ++i) mass(i, i) += rotor;
      acceleration = mass.llt().solve(force - bias);
      measured_.torque -= rotor * acceleration;
      state_.qd += h * acceleration;
      state_.q += h * state_.qd;
    }
    measured_.position = state_.q;
    measured_.velocity = state_.qd;
  }
  [[nodiscard]] const Measured& measured() const { return measured_; }

  void set_gravity(const Vector3& gravity_m_s2) { dynamics_.set_gravity(gravity_m_s2); }

  static constexpr double knee = 1e-3;  ///< rad/s or m/s, over which dry friction changes its sign
  double friction_factor{1};
  double step_s{50e-6};
  double rotor{0};  ///< of each joint

 private:
  const robotics::Model& model_;
  robotics::Dynamics dynamics_;
  robotics::State state_;
  Measured measured_;
};

}  // namespace hirosco::robot_arm::testing
