// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

using testing::bounds_of;
using testing::model_of;
using testing::Plant;

constexpr std::array soft_kinds{LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Float};

struct LawsTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  static constexpr std::array rotors{0.5, 0.5, 0.4, 0.1, 0.1, 0.1};
  robotics::Model model = model_of(testing::six_axes);
  std::vector<JointBounds> bounds = bounds_of(model);
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  robotics::Dynamics of_plant{model, robotics::Base::Fixed};
  robotics::FrameId tip = model.find_frame("tool").value();
  Laws laws{model, tip, cycle_s};
  Laws::Settings settings{.position = {.rotor = rotors, .gravity_m_s2 = {0, 0, -9.81}}};
  Impedance impedance{vector_of(std::array{200.0, 200.0, 100.0, 20.0, 20.0, 20.0}), 400, 20, 0.7};
  Setpoint wanted;
  Payload payload;
  Plant plant{model};
  const JointVector zeros = JointVector::Zero(6);
  const JointVector start = vector_of(std::array{0.3, 0.9, 0.8, -0.5, 0.4, 0.2});

  LawsTest() {
    dynamics.set_gravity({0, 0, -9.81});
    wanted = {start, zeros, zeros};
    plant.place(start);
    plant.rotor = 0.1;
  }
  void update(robotics::Dynamics& of, const Measured& measured) {
    robotics::State state;
    state.q = measured.position;
    state.qd = measured.velocity;
    of.update(state);
  }
  JointVector torque(const Measured& measured) {
    update(dynamics, measured);
    return laws.torque(wanted, measured, dynamics, payload, bounds, settings);
  }
  /// What so much takes at the tool, of all joints, at rest where the plant is.
  JointVector weight(double mass_kg) {
    update(of_plant, {plant.measured().position, zeros, zeros});
    robotics::Coordinates torque = robotics::Coordinates::Zero(6);
    Law::add_payload({mass_kg}, tip, settings.position.gravity_m_s2, of_plant, zeros, torque);
    return torque;
  }
  /// Cycles with what acts from outside.
  void run(double seconds, const JointVector* outside = nullptr) {
    for (double t = 0; t < seconds; t += cycle_s) plant.step(torque(plant.measured()), cycle_s, outside);
  }
  /// Of motion: links as the model has them, and the plant's rotors.
  double kinetic_energy() {
    update(of_plant, plant.measured());
    return of_plant.kinetic_energy() + 0.5 * plant.rotor * plant.measured().velocity.squaredNorm();
  }
};

/// Whatever the arm does and whoever pushes meanwhile: from any law to any other.
TEST_F(LawsTest, ChangeWithoutAStepInTorqueFromEachToEach) {
  const JointVector push = vector_of(std::array{8.0, -10.0, 6.0, 1.5, -1.0, 0.5});
  constexpr std::array all{LawKind::Position, LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Float};
  for (const LawKind from : all)
    for (const LawKind to : all) {
      laws.reset();
      plant.place(start);
      laws.set(from, impedance);
      run(0.3, &push);
      JointVector last = torque(plant.measured());
      plant.step(last, cycle_s, &push);
      const auto steepest = [&](int cycles) {
        double most = 0;
        for (int i = 0; i < cycles; ++i) {
          const JointVector now = torque(plant.measured());
          for (std::size_t j = 0; j < 6; ++j) {
            const auto at = static_cast<Eigen::Index>(j);
            most = std::max(most, std::abs(now[at] - last[at]) / bounds[j].effort);
          }
          last = now;
          plant.step(now, cycle_s, &push);
        }
        return most;
      };
      // As the arm does it: a hard law begins where the arm is.
      if (to == LawKind::Position) wanted.position = plant.measured().position;
      laws.set(to, {2 * impedance.joint_n_m_rad, 800, 40, 1});
      EXPECT_LT(steepest(1), 0.004) << static_cast<int>(from) << " to " << static_cast<int>(to);
      EXPECT_LT(steepest(400), 0.05) << static_cast<int>(from) << " to " << static_cast<int>(to);
      wanted.position = start;
    }
}

/// A load is there or not, was learnt or not, and is said to be there, to be another or to be gone, in each law: what is put out has no step, and what
/// was learnt of a load is not held twice.
TEST_F(LawsTest, TakeALoadThatIsDeclaredWithoutAStepAndHoldNoneTwice) {
  constexpr std::array all{LawKind::Position, LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Float};
  constexpr double hangs_kg = 2;
  plant.friction_factor = 0;
  plant.step_s = 250e-6;
  for (const LawKind kind : all)
    for (const bool hangs : {true, false})
      for (const double declared_kg : {hangs_kg, 6.0, 0.0}) {
        const std::string what =
            std::to_string(static_cast<int>(kind)) + (hangs ? " hangs " : " nothing ") + std::to_string(declared_kg);
        laws.reset();
        payload = {};
        plant.place(start);
        JointVector load = zeros;
        JointVector last;
        double steepest = 0;
        const auto cycle = [&] {
          if (hangs) load = -weight(hangs_kg);
          const JointVector now = torque(plant.measured());
          for (std::size_t j = 0; last.size() > 0 && j < 6; ++j) {
            const auto at = static_cast<Eigen::Index>(j);
            steepest = std::max(steepest, std::abs(now[at] - last[at]) / bounds[j].effort);
          }
          last = now;
          plant.step(now, cycle_s, &load);
        };
        for (int i = 0; i < 6000; ++i) cycle();
        laws.set(kind, impedance);
        for (int i = 0; i < 500; ++i) cycle();
        const JointVector before = plant.measured().position;
        steepest = 0;
        laws.take_load(weight(declared_kg) - weight(payload.mass_kg), settings);
        payload = {declared_kg};
        cycle();
        EXPECT_LT(steepest, 0.004) << what;
        for (int i = 0; i < 600; ++i) cycle();
        EXPECT_LT(steepest, 0.01) << what;
        if (kind == LawKind::Position || (hangs && declared_kg == hangs_kg)) {
          EXPECT_LT((plant.measured().position - before).cwiseAbs().maxCoeff(), 0.01) << what;
        }
      }
}

/// Soft right behind what was said of its load: the share that it carried goes with what the integral gave.
TEST_F(LawsTest, GoSoftBehindADeclaredLoadWithoutASurplus) {
  plant.friction_factor = 0;
  plant.step_s = 250e-6;
  JointVector load = zeros;
  const auto cycle = [&] {
    load = -weight(2);
    plant.step(torque(plant.measured()), cycle_s, &load);
  };
  for (int i = 0; i < 4000; ++i) cycle();
  laws.take_load(weight(2), settings);
  payload = {2};
  for (int i = 0; i < 10; ++i) cycle();
  laws.set(LawKind::ToolImpedance, {impedance.joint_n_m_rad, 200, 20, 0.7});
  for (int i = 0; i < 2000; ++i) cycle();
  EXPECT_LT((plant.measured().position - start).cwiseAbs().maxCoeff(), 0.01);
}

/// Pushed with a random force for a second and then left alone: what it has of motion is never more than was
/// brought in, and it comes to rest. Gravity brings nothing: it is carried.
TEST_F(LawsTest, GiveBackNoMoreEnergyThanWasBroughtIn) {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> any{-1, 1};
  plant.friction_factor = 0;
  for (const LawKind kind : soft_kinds)
    for (int trial = 0; trial < 2; ++trial) {
      laws.reset();
      plant.place(start);
      laws.set(kind, impedance);
      JointVector push = zeros;
      double brought_in_j = 0, worst_j = -HUGE_VAL;
      for (int i = 0; i < 3000; ++i) {
        if (i % 100 == 0)
          for (Eigen::Index j = 0; j < 6; ++j)
            push[j] = i < 1000 ? 0.15 * bounds[static_cast<std::size_t>(j)].effort * any(random) : 0;
        const JointVector before = plant.measured().position;
        plant.step(torque(plant.measured()), cycle_s, &push);
        brought_in_j += push.dot(plant.measured().position - before);
        worst_j = std::max(worst_j, kinetic_energy() - brought_in_j);
      }
      EXPECT_LT(worst_j, 0.05) << static_cast<int>(kind) << " " << trial;
      EXPECT_LT(plant.measured().velocity.cwiseAbs().maxCoeff(), 0.05) << static_cast<int>(kind) << " " << trial;
    }
}

TEST_F(LawsTest, AJointIsPushedAsideAsFarAsItsSpringSays) {
  plant.friction_factor = 0;
  laws.set(LawKind::JointImpedance, impedance);
  const JointVector push = vector_of(std::array{10.0, -10.0, 5.0, 1.0, -1.0, 1.0});
  run(4, &push);
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(plant.measured().position[i] - start[i], push[i] / impedance.joint_n_m_rad[i], 2e-3) << i;
}

TEST_F(LawsTest, TheToolIsPushedAsideAsFarAsItsSpringsSay) {
  plant.friction_factor = 0;
  laws.set(LawKind::ToolImpedance, impedance);
  update(of_plant, plant.measured());
  const Vector3 before = of_plant.frame_pose(tip).position;
  const Vector3 force{8, -6, 10};
  for (int i = 0; i < 4000; ++i) {
    update(of_plant, plant.measured());
    Jacobian jacobian;
    of_plant.jacobian(tip, jacobian);
    const JointVector push = jacobian.bottomRows<3>().transpose() * force;
    plant.step(torque(plant.measured()), cycle_s, &push);
  }
  update(of_plant, plant.measured());
  const Vector3 aside = of_plant.frame_pose(tip).position - before;
  EXPECT_LT((aside - force / impedance.tool_n_m).norm(), 0.02 * aside.norm());
}

TEST_F(LawsTest, FloatingItGoesWhereItIsLedAndStaysThere) {
  plant.friction_factor = 0;
  laws.set(LawKind::Float);
  const JointVector push = vector_of(std::array{10.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  run(1, &push);
  EXPECT_GT(plant.measured().position[0] - start[0], 0.2);
  run(2);
  const JointVector there = plant.measured().position;
  run(1);
  EXPECT_LT((plant.measured().position - there).cwiseAbs().maxCoeff(), 2e-3);
}

/// As an arm has it: where it is to be is where it is, at an end as well.
TEST_F(LawsTest, FloatingItKeepsARangeThoughItIsToBeWhereverItIs) {
  plant.friction_factor = 0;
  laws.set(LawKind::Float);
  const double highest = bounds[0].highest;
  const auto pushed = [&](double push_n_m, double seconds) {
    JointVector push = zeros;
    push[0] = push_n_m;
    double farthest = -HUGE_VAL;
    for (double t = 0; t < seconds; t += cycle_s) {
      wanted.position = plant.measured().position;
      plant.step(torque(plant.measured()), cycle_s, &push);
      farthest = std::max(farthest, plant.measured().position[0]);
    }
    return farthest;
  };
  const double led = pushed(60, 3);
  EXPECT_LT(led, highest);
  EXPECT_GT(led, highest - 0.1) << "it was led there";
  // Let go of where its spring would begin before: nothing pushes it away, and who leads it away and back meets the spring.
  laws.reset();
  JointVector there = start;
  there[0] = highest - 0.03;
  plant.place(there);
  laws.set(LawKind::Float);
  pushed(0, 2);
  EXPECT_NEAR(plant.measured().position[0], there[0], 2e-3);
  pushed(-20, 1);
  ASSERT_LT(plant.measured().position[0], highest - 0.15);
  EXPECT_LT(pushed(20, 3), there[0]);
  // It takes the whole effort in 0.1 rad.
  constexpr double wall = 0.1;
  EXPECT_NEAR(plant.measured().position[0], highest - wall + wall * 20 / bounds[0].effort, 2e-3);
}

TEST_F(LawsTest, KeepARangeAndAVelocityWithWhateverTheyAreLed) {
  plant.friction_factor = 0;
  for (const LawKind kind : soft_kinds) {
    laws.reset();
    plant.place(start);
    laws.set(kind, impedance);
    JointVector push = zeros;
    push[0] = 60;
    double fastest = 0;
    for (int i = 0; i < 3000; ++i) {
      plant.step(torque(plant.measured()), cycle_s, &push);
      fastest = std::max(fastest, plant.measured().velocity[0]);
    }
    EXPECT_LT(fastest, bounds[0].motion.velocity) << static_cast<int>(kind);
    EXPECT_LT(plant.measured().position[0], bounds[0].highest) << static_cast<int>(kind);
  }
}

TEST_F(LawsTest, GiveNoMoreThanEachJointsEffortAndNothingForWhatIsNoNumber) {
  std::mt19937 random{3};
  std::uniform_real_distribution<double> any{-20, 20};
  for (const LawKind kind : soft_kinds) {
    laws.reset();
    for (int i = 0; i < 100; ++i) {
      Measured measured{zeros, zeros, zeros};
      for (Eigen::Index j = 0; j < 6; ++j) measured.position[j] = any(random), measured.velocity[j] = any(random);
      if (i % 10 == 0) laws.set(kind, impedance);
      if (i % 7 == 0) measured.position[2] = std::numeric_limits<double>::quiet_NaN();
      const JointVector given = torque(measured);
      for (std::size_t j = 0; j < 6; ++j) EXPECT_LE(std::abs(given[static_cast<Eigen::Index>(j)]), bounds[j].effort);
    }
    EXPECT_TRUE(torque({start, zeros, zeros}).allFinite());
  }
}

/// The model does not know a tenth of its weight, and the law of positions has learnt it.
TEST_F(LawsTest, WhoIsLetGoNeitherSinksNorClimbsThoughItIsATenthHeavier) {
  const robotics::Model heavier = model_of(testing::six_axes, 1.1);
  Plant heavy{heavier};
  heavy.rotor = 0.1;
  heavy.friction_factor = 0;
  heavy.place(start);
  for (int i = 0; i < 5000; ++i) heavy.step(torque(heavy.measured()), cycle_s);
  laws.set(LawKind::Float);
  for (int i = 0; i < 1000; ++i) heavy.step(torque(heavy.measured()), cycle_s);
  EXPECT_LT((heavy.measured().position - start).cwiseAbs().maxCoeff(), 0.02);
}

TEST_F(LawsTest, NameTheSpringThatIsTooStiffForWhatItMoves) {
  update(dynamics, {start, zeros, zeros});
  auto& compliance = laws.compliance();
  EXPECT_FALSE(compliance.too_stiff(LawKind::JointImpedance, impedance, dynamics, rotors, 40));
  EXPECT_FALSE(compliance.too_stiff(LawKind::ToolImpedance, impedance, dynamics, rotors, 40));
  impedance.joint_n_m_rad[4] = 1000;
  EXPECT_EQ(compliance.too_stiff(LawKind::JointImpedance, impedance, dynamics, rotors, 40), 4u);
  impedance.tool_n_m = 1e6;
  EXPECT_EQ(compliance.too_stiff(LawKind::ToolImpedance, impedance, dynamics, rotors, 40), 3u);
}

}  // namespace
}  // namespace hirosco::robot_arm
