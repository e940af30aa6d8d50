// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// What an arm's laws do where a cycle is long and a torque comes two cycles late (docs/adr/0193).
namespace hirosco::robot_arm {
namespace {

using testing::bounds_of;
using testing::model_of;
using testing::Plant;

constexpr double widest_rad_s = 60;  ///< of BANDWIDTH
constexpr double rotor = 0.3;

/// An arm whose links and rotors are `heavier` on board than they are.
struct Late {
  double cycle_s;
  robotics::Model model;
  robotics::Model truth = model_of(testing::six_axes);
  std::vector<JointBounds> bounds = bounds_of(model);
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  Laws laws{model, model.find_frame("tool").value(), cycle_s};
  Plant plant{truth};
  std::vector<double> rotors;
  Laws::Settings settings;
  JointVector start = vector_of(std::array{0.3, 0.9, 0.8, -0.5, 0.4, 0.2});
  Setpoint wanted{start, JointVector::Zero(6), JointVector::Zero(6)};
  std::deque<JointVector> under_way;

  Late(double cycle, double heavier, double bandwidth_rad_s)
      : cycle_s{cycle}, model{model_of(testing::six_axes, heavier)}, rotors(6, heavier * rotor) {
    settings = {.position = {.bandwidth_rad_s = bandwidth_rad_s, .rotor = rotors, .gravity_m_s2 = {0, 0, -9.81}}};
    dynamics.set_gravity({0, 0, -9.81});
    plant.rotor = rotor;
    plant.friction_factor = 0;
    plant.step_s = 250e-6;
    plant.place(start + 0.001 * JointVector::Ones(6));
  }
  void cycle(const JointVector* outside = nullptr) {
    const Measured measured = plant.measured();
    robotics::State state;
    state.q = measured.position;
    state.qd = measured.velocity;
    dynamics.update(state);
    const JointVector torque = laws.torque(wanted, measured, dynamics, {}, bounds, settings);
    while (under_way.size() < static_cast<std::size_t>(robotics::delay_cycles)) under_way.push_back(torque);
    under_way.push_back(torque);
    plant.step(under_way.front(), cycle_s, outside);
    under_way.pop_front();
  }
  /// The farthest off, and the fastest, in the last half of a second of so many.
  struct Peak {
    double off{0}, fast{0};
  };
  Peak fly(double seconds, const JointVector* outside = nullptr) {
    Peak peak;
    for (double t = 0; t < seconds; t += cycle_s) {
      cycle(outside);
      if (t < seconds - 0.5) continue;
      peak.off = std::max(peak.off, (plant.measured().position - start).cwiseAbs().maxCoeff());
      peak.fast = std::max(peak.fast, plant.measured().velocity.cwiseAbs().maxCoeff());
    }
    return peak;
  }
};

TEST(SlowCycles, LeaveTheLawOfPositionsAtRestThoughItsModelIsAFifthTooHeavyOrTooLight) {
  for (const double cycle_s : {0.001, 0.002, 0.004})
    for (const double heavier : {0.8, 1.0, 1.2}) {
      Late arm{cycle_s, heavier, std::min(widest_rad_s, robotics::fastest_rad_s(cycle_s))};
      EXPECT_LT(arm.fly(4).off, 5e-4) << cycle_s << " s, " << heavier;
    }
}

TEST(SlowCycles, LeaveNoLawWhoseBandwidthIsThatOfAMillisecond) {
  Late arm{0.004, 1.2, widest_rad_s};
  EXPECT_GT(arm.fly(4).off, 1e-3) << "the bound is for nothing";
}

TEST(SlowCycles, LeaveSoftLawsAtRestOnTheStiffestSprings) {
  for (const double cycle_s : {0.001, 0.002, 0.004})
    for (const double ratio : {0.3, 1.0}) {
      Late arm{cycle_s, 1, std::min(widest_rad_s, robotics::fastest_rad_s(cycle_s))};
      // As stiff as IMPEDANCE_J takes them, in the posture in which it is asked.
      robotics::State state;
      state.q = arm.start;
      state.qd = JointVector::Zero(6);
      arm.dynamics.update(state);
      robotics::MassMatrix mass;
      arm.dynamics.mass_matrix(mass);
      Impedance impedance{JointVector::Zero(6), 0, 0, ratio};
      for (Eigen::Index i = 0; i < 6; ++i)
        impedance.joint_n_m_rad[i] = 0.999 * arm.settings.position.bandwidth_rad_s *
                                     arm.settings.position.bandwidth_rad_s * (mass(i, i) + rotor);
      ASSERT_FALSE(arm.laws.compliance().too_stiff(LawKind::JointImpedance, impedance, arm.dynamics, arm.rotors,
                                                   arm.settings.position.bandwidth_rad_s));
      arm.laws.set(LawKind::JointImpedance, impedance);
      EXPECT_LT(arm.fly(4).fast, 2e-3) << cycle_s << " s, " << ratio;
    }
}

/// The spring of a joint's effort before the end of its range, and its damper, are bounded by the cycle as those that somebody asks for.
TEST(SlowCycles, LeaveAnArmThatIsPushedTowardsTheEndOfARangeAtRest) {
  for (const double cycle_s : {0.001, 0.002, 0.004}) {
    Late arm{cycle_s, 1, std::min(widest_rad_s, robotics::fastest_rad_s(cycle_s))};
    arm.laws.set(LawKind::Float);
    JointVector there = arm.start;
    there[5] = arm.bounds[5].highest - 0.02;
    arm.plant.place(there);
    JointVector push = JointVector::Zero(6);
    push[5] = 1;
    EXPECT_LT(arm.fly(6, &push).fast, 5e-3) << cycle_s << " s";
  }
}

/// Whose spring a cycle softens begins it farther from the end: nine tenths of the effort are stopped before that all the same.
TEST(SlowCycles, LeaveNobodyBeyondTheEndOfARangeWhoPushesWithLessThanTheEffort) {
  for (const double cycle_s : {0.001, 0.002, 0.004}) {
    Late arm{cycle_s, 1, std::min(widest_rad_s, robotics::fastest_rad_s(cycle_s))};
    arm.laws.set(LawKind::Float);
    const JointBounds& its = arm.bounds[5];
    const double fastest = robotics::fastest_rad_s(cycle_s);
    JointVector there = arm.start;
    there[5] = its.highest - std::max(0.1, its.effort / (fastest * fastest * rotor)) - 0.01;
    arm.plant.place(there);
    JointVector push = JointVector::Zero(6);
    constexpr double grows_s = 5;
    for (double t = 0; t < grows_s + 1; t += cycle_s) {
      push[5] = 0.9 * its.effort * std::min(1.0, t / grows_s);
      arm.cycle(&push);
      ASSERT_LT(arm.plant.measured().position[5], its.highest) << cycle_s << " s, after " << t;
    }
  }
}

TEST(SlowCycles, LeaveRatesThatShrinkAsTheyBecomeLonger) {
  EXPECT_DOUBLE_EQ(robotics::fastest_rad_s(0.001), 80);
  EXPECT_DOUBLE_EQ(robotics::fastest_rad_s(0.004), 20);
  EXPECT_DOUBLE_EQ(robotics::slowest_rad_s, 20);
}

TEST(SlowCycles, AreTakenUpToTheLongest) {
  EXPECT_TRUE(robotics::check_cycle(robotics::longest_cycle_s));
  EXPECT_FALSE(robotics::check_cycle(robotics::longest_cycle_s + 1e-6));
}

}  // namespace
}  // namespace hirosco::robot_arm
