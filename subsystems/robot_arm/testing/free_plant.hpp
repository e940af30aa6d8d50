// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/driven.hpp"
#include "subsystems/robot_arm/floating/floating_arm.hpp"
#include "subsystems/robot_arm/testing/floating.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// A craft that nothing holds, for tests of an arm on it. The world of a flight is another one (simulation/mujoco).
namespace hirosco::robot_arm::testing {

/// Rigid bodies in orbit.
class FreePlant {
 public:
  explicit FreePlant(const robotics::Model& model)
      : model_{model}, tool_{model.find_frame("tool").value()}, dynamics_{model, robotics::Base::Free} {
    place(JointVector::Zero(model.joint_count()));
  }
  /// With these joints, and no momentum.
  void place(const JointVector& q) {
    state_.q = q;
    state_.qd = JointVector::Zero(q.size());
    state_.base_twist.setZero();
    measured_ = {q, state_.qd, state_.qd};
  }
  void step(const JointVector& drive, double span_s) {
    for (double t = 0; t < span_s - step_s / 2; t += step_s) {
      dynamics_.update(state_);
      robotics::Jacobian jacobian;
      dynamics_.jacobian(tool_, jacobian);
      robotics::Coordinates force = jacobian.bottomRows<3>().transpose() * push_n, acceleration;
      force.tail(drive.size()) += drive;
      ASSERT_TRUE(dynamics_.forward(force, acceleration));
      state_.base_twist += step_s * acceleration.head<6>();
      state_.qd += step_s * acceleration.tail(drive.size());
      state_.q += step_s * state_.qd;
      state_.base_position += step_s * (state_.base_orientation * Vector3{state_.base_twist.tail<3>()});
      robotics::Quaternion by;
      by.w() = 1;
      by.vec() = 0.5 * step_s * state_.base_twist.head<3>();
      state_.base_orientation = (state_.base_orientation * by).normalized();
    }
    measured_ = {state_.q, state_.qd, drive};
  }
  [[nodiscard]] const Measured& measured() const { return measured_; }
  [[nodiscard]] robotics::Pose base() const {
    return {state_.base_orientation.toRotationMatrix(), state_.base_position};
  }

  Vector3 push_n{Vector3::Zero()};  ///< at the tool, in inertial axes
  double step_s{250e-6};

 private:
  const robotics::Model& model_;
  robotics::FrameId tool_;
  robotics::Dynamics dynamics_;
  robotics::State state_;
  Measured measured_;
};

/// A floating arm as its subsystem, in JOINTS, on such a craft; a test is its device.
struct FlownFree : hirosco::testing::Driven {
  robotics::Model model = model_of(floating_folder + "floating_arm.urdf");
  FreePlant plant{model};
  double fastest{0};
  double steepest{0};  ///< N m or N, that a commanded torque has stepped by in a cycle
  JointVector commanded{JointVector::Zero(7)};

  explicit FlownFree(const std::string& descriptor_text = floating_descriptor())
      : Driven{make_floating_arm(), descriptor_text, "mcs-arm"} {}
  std::vector<double> play(std::span<const double> torques) override {
    const JointVector now = vector_of(torques);
    steepest = std::max(steepest, (now - commanded).cwiseAbs().maxCoeff());
    commanded = now;
    if (mode == DeviceMode::Active) plant.step(now, 0.001);
    else plant.place(plant.measured().position);
    const Measured& measured = plant.measured();
    fastest = std::max(fastest, measured.velocity.cwiseAbs().maxCoeff());
    std::vector<double> numbers;
    for (const auto* each : {&measured.position, &measured.velocity, &measured.torque})
      numbers.insert(numbers.end(), each->begin(), each->end());
    return numbers;
  }
  [[nodiscard]] double off(const JointVector& where) const {
    return (plant.measured().position - where).cwiseAbs().maxCoeff();
  }
};

/// A flight of it.
struct FreeArm : ::testing::Test {
  const std::string done = "1 3 7";
  FlownFree flown;
  const JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});

  void begin() {
    flown.plant.place(ready);
    flown.operate();
  }
  hirosco::testing::Sent ask(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = flown.rig.call(function, numbers);
    flown.cycle(3);
    return request;
  }
  std::string asked(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = ask(function, numbers);
    flown.finish(request);
    return flown.rig.outcome(request);
  }
  /// SET_CONTACT; 0: nobody is met.
  void react_by(std::uint8_t reaction, double limit = 0.3) {
    const auto request = flown.rig.call_with("SET_CONTACT", {Value{Number{reaction}}, Value{limit}});
    flown.cycle(5);
    ASSERT_EQ(flown.rig.outcome(request), done);
  }
  [[nodiscard]] double speed() const { return flown.plant.measured().velocity.cwiseAbs().maxCoeff(); }
  /// As it stands now, by the model of a craft without momentum.
  [[nodiscard]] FloatingModel now() const {
    FloatingModel its{flown.model, flown.model.find_frame("tool").value()};
    EXPECT_TRUE(its.update({}, flown.plant.measured().position));
    return its;
  }
};

}  // namespace hirosco::robot_arm::testing
