// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/control/work_watch.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// Force at the tool, and work: told, bounded where torques are made, watched where they are measured.
namespace hirosco::robot_arm {
namespace {

struct WorkTest : ::testing::Test {
  static constexpr double cycle_s = 0.001;
  robotics::Model model = testing::model_of(testing::six_axes);
  std::vector<JointBounds> bounds = testing::bounds_of(model);
  robotics::FrameId tip = model.find_frame("tool").value();
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  const JointVector zeros = JointVector::Zero(6);
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  const JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  ToolLever lever;
  std::mt19937 random{5};
  std::uniform_real_distribution<double> any{-1, 1};

  WorkTest() {
    dynamics.set_gravity({0, 0, -9.81});
    place(start, zeros);
  }
  void place(const JointVector& position, const JointVector& velocity) {
    robotics::State state;
    state.q = position;
    state.qd = velocity;
    dynamics.update(state);
    lever.update(dynamics, tip, Vector3::Zero());
  }
  JointVector some(double most) {
    JointVector all = zeros;
    for (double& each : all) each = most * any(random);
    return all;
  }
};

TEST_F(WorkTest, AForceAtTheToolIsToldByTheTorquesThatItMakes) {
  for (int i = 0; i < 50; ++i) {
    const Vector3 force{50 * any(random), 50 * any(random), 50 * any(random)};
    Jacobian jacobian;
    dynamics.jacobian(tip, jacobian);
    const JointVector torque = jacobian.bottomRows<3>().transpose() * force;
    EXPECT_LT((lever.force(torque) - force).norm(), 0.05 * force.norm());
  }
}

TEST_F(WorkTest, TheVelocityOfTheToolIsThatOfItsPlaceInTheTip) {
  const JointVector rates = some(1);
  const Vector3 place_m{0.1, 0.05, -0.2};
  place(start, rates);
  lever.update(dynamics, tip, place_m);
  const Vector3 told = lever.velocity(rates), before = dynamics.frame_pose(tip) * place_m;
  constexpr double span_s = 1e-6;
  place(start + span_s * rates, rates);
  const Vector3 after = dynamics.frame_pose(tip) * place_m;
  EXPECT_LT((told - (after - before) / span_s).norm(), 1e-4);
}

/// Each law, 50 mrad beside where it is to be, or driven: what it would press with is bounded, and what carries it stays.
TEST_F(WorkTest, NoLawPressesHarderThanTheCommandedShareOfTheLimit) {
  constexpr double limit_n = 10;
  const Impedance impedance{vector_of(std::array{200.0, 200.0, 100.0, 20.0, 20.0, 20.0}), 400, 20, 0.7};
  const JointVector beside = start + JointVector::Constant(6, 0.05);
  robotics::Coordinates gravity;
  dynamics.bias(gravity);
  const JointVector carried = gravity;
  for (const LawKind kind : {LawKind::Position, LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Torque}) {
    const auto pressed_n = [&](double most_n) {
      Laws laws{model, tip, cycle_s};
      if (kind != LawKind::Position) laws.set(kind, impedance);
      laws.drive({vector_of(std::array{20.0, 0.0, 0.0, 0.0, 0.0, 0.0}), zeros});
      const Laws::Settings settings{
          .position = {.gravity_m_s2 = {0, 0, -9.81}}, .lever = &lever, .work = {.force_n = most_n}};
      const JointVector torque =
          laws.torque({beside, zeros, zeros}, {start, zeros, zeros}, dynamics, {}, bounds, settings);
      return lever.force(torque - carried).norm();
    };
    EXPECT_GT(pressed_n(HUGE_VAL), limit_n) << static_cast<int>(kind);
    EXPECT_NEAR(pressed_n(limit_n), commanded_share * limit_n, 1e-6) << static_cast<int>(kind);
  }
}

/// Something is in its way for seconds, and it presses with all that its limit leaves. A law that gives way behind that carries what was learnt for the load that it is not: that
/// is what it pressed with, and not what it would have pressed with. Its own springs, or who drives it, press no harder together with that.
TEST_F(WorkTest, WhatALimitOfForceHeldBackIsNotPressedWithByWhoGivesWayBehindIt) {
  constexpr double limit_n = 10;
  const Impedance impedance{vector_of(std::array{200.0, 200.0, 100.0, 20.0, 20.0, 20.0}), 400, 20, 0.7};
  const JointVector beside = start + JointVector::Constant(6, 0.05);
  const Laws::Settings settings{
      .position = {.gravity_m_s2 = {0, 0, -9.81}}, .lever = &lever, .work = {.force_n = limit_n}};
  robotics::Coordinates gravity;
  dynamics.bias(gravity);
  const JointVector carried = gravity;
  for (const LawKind kind : {LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Float, LawKind::Torque}) {
    Laws laws{model, tip, cycle_s};
    const auto pressed_n = [&](const JointVector& wanted) {
      const JointVector torque =
          laws.torque({wanted, zeros, zeros}, {start, zeros, zeros}, dynamics, {}, bounds, settings);
      return lever.force(torque - carried).norm();
    };
    for (int i = 0; i < 3000; ++i) ASSERT_LE(pressed_n(beside), commanded_share * limit_n + 1e-6) << i;
    laws.set(kind, impedance);
    double last_n = 0;
    for (int i = 0; i < 600; ++i) {
      last_n = pressed_n(start);
      ASSERT_LE(last_n, commanded_share * limit_n + 1e-6) << static_cast<int>(kind) << " " << i;
    }
    EXPECT_GT(last_n, 0.5 * limit_n) << static_cast<int>(kind) << ": what it did press with is learnt as ever";
    laws.drive({vector_of(std::array{20.0, 0.0, 0.0, 0.0, 0.0, 0.0}), zeros});
    for (int i = 0; i < 600; ++i)
      ASSERT_LE(pressed_n(beside), commanded_share * limit_n + 1e-6) << static_cast<int>(kind) << " " << i;
  }
}

/// From each law to each, wherever the arm is to be then, whoever drives it, and with a limit that is lowered and raised meanwhile: what was learnt, what fades of the law before and what
/// the new one presses with are together no more than the commanded share.
TEST_F(WorkTest, NoHandOverBetweenLawsPressesHarderThanTheCommandedShareOfTheLimit) {
  constexpr std::array all{LawKind::Position, LawKind::JointImpedance, LawKind::ToolImpedance, LawKind::Float,
                           LawKind::Torque};
  const Impedance impedance{vector_of(std::array{200.0, 200.0, 100.0, 20.0, 20.0, 20.0}), 400, 20, 0.7};
  robotics::Coordinates gravity;
  dynamics.bias(gravity);
  const JointVector carried = gravity;
  Laws laws{model, tip, cycle_s};
  double limit_n = 10;
  const auto press = [&](const JointVector& wanted, int cycles) {
    double most_n = 0;
    for (int i = 0; i < cycles; ++i) {
      const Laws::Settings settings{
          .position = {.gravity_m_s2 = {0, 0, -9.81}}, .lever = &lever, .work = {.force_n = limit_n}};
      const JointVector torque =
          laws.torque({wanted, zeros, zeros}, {start, zeros, zeros}, dynamics, {}, bounds, settings);
      most_n = std::max(most_n, lever.force(torque - carried).norm());
    }
    return most_n;
  };
  ASSERT_LE(press(start + JointVector::Constant(6, 0.05), 2000), commanded_share * limit_n + 1e-6);
  for (const LawKind from : all)
    for (const LawKind to : all)
      for (const LawKind kind : {from, to}) {
        laws.set(kind, impedance);
        laws.drive({some(20), zeros});
        limit_n = 8 + 4 * any(random);
        ASSERT_LE(press(start + some(0.05), 310), commanded_share * limit_n + 1e-6)
            << static_cast<int>(from) << " to " << static_cast<int>(to);
      }
}

/// What was learnt stays wherever it keeps the limit alone, and what presses besides is as much as that leaves.
TEST_F(WorkTest, WhatWasLearntStaysAndWhatPressesIsTakenBackToWhatItLeaves) {
  constexpr double limit_n = 40, most_n = commanded_share * limit_n;
  int taken_back = 0, beyond = 0;
  for (int i = 0; i < 1000; ++i) {
    const JointVector known = some(50), learnt = some(20), pressing = some(50);
    const JointVector kept =
        within_work(known + learnt + pressing, {known, learnt}, zeros, lever, {.force_n = limit_n});
    const double force_n = lever.force(kept - known).norm();
    ASSERT_LE(force_n, most_n + 1e-6);
    if (lever.force(learnt).norm() > most_n) {
      ++beyond;
      continue;
    }
    const JointVector left = kept - known - learnt;
    const double share = left.dot(pressing) / pressing.squaredNorm();
    ASSERT_LT((left - share * pressing).norm(), 1e-9);
    ASSERT_GE(share, -1e-9);
    ASSERT_LE(share, 1 + 1e-9);
    if (share > 1 - 1e-9) continue;
    ++taken_back;
    ASSERT_NEAR(force_n, most_n, 1e-6);
  }
  EXPECT_GT(taken_back, 100);
  EXPECT_GT(beyond, 0);
}

TEST_F(WorkTest, WhatKeepsItsLimitsIsPutOutToTheLastDigit) {
  for (int i = 0; i < 100; ++i) {
    const JointVector torque = some(100), carried = some(100);
    EXPECT_EQ(within_work(torque, {carried, some(20)}, some(2), lever, {}), torque);
  }
}

TEST_F(WorkTest, ForceAndPowerOfTheToolAreBoundedAsAWhole) {
  for (int i = 0; i < 1000; ++i) {
    const JointVector torque = some(100), carried = some(50), speed = some(2);
    const JointVector kept = within_work(torque, {carried, zeros}, speed, lever, {.force_n = 40, .tool_power_w = 20});
    const Vector3 force = lever.force(kept - carried);
    EXPECT_LE(force.norm(), commanded_share * 40 + 1e-9);
    EXPECT_LE(force.dot(lever.velocity(speed)), commanded_share * 20 + 1e-9);
  }
}

/// What carries the arm stays, though it is too much alone: then the watch stops it.
TEST_F(WorkTest, PowerOfTheJointsIsTakenFromWhatDrivesAndNeverFromWhatCarriesOrBrakes) {
  constexpr double limit_w = 60;
  for (int i = 0; i < 1000; ++i) {
    const JointVector torque = some(100), carried = some(50), speed = some(2);
    const JointVector kept = within_work(torque, {carried, zeros}, speed, lever, {.power_w = limit_w});
    const double power_w = kept.cwiseProduct(speed).cwiseMax(0.0).sum();
    for (Eigen::Index j = 0; j < 6; ++j) {
      if (torque[j] * speed[j] <= 0) {
        EXPECT_EQ(kept[j], torque[j]);
        continue;
      }
      const double least = std::clamp(carried[j], std::min(0.0, torque[j]), std::max(0.0, torque[j]));
      EXPECT_GE(kept[j], std::min(least, torque[j]) - 1e-9);
      EXPECT_LE(kept[j], std::max(least, torque[j]) + 1e-9);
      if (power_w > commanded_share * limit_w + 1e-9) {
        EXPECT_NEAR(kept[j], least, 1e-9);
      }
    }
  }
}

/// However hard others brake: what they take is none of the power that goes to somebody, nor does it make good for what another gives.
TEST_F(WorkTest, AJointThatBrakesTakesNothingFromWhatAnotherMayGive) {
  const JointVector speed = vector_of(std::array{1.0, -1.0, 0.0, 0.0, 0.0, 0.0});
  for (const double braking : {0.0, 50.0, 140.0}) {
    const JointVector within = vector_of(std::array{-braking, -30.0, 0.0, 0.0, 0.0, 0.0});
    EXPECT_EQ(within_work(within, {zeros, zeros}, speed, lever, {.power_w = 40}), within) << braking;
    const JointVector beyond = vector_of(std::array{-braking, -60.0, 0.0, 0.0, 0.0, 0.0});
    const JointVector kept = within_work(beyond, {zeros, zeros}, speed, lever, {.power_w = 40});
    EXPECT_EQ(kept[0], -braking) << "who brakes goes on braking";
    EXPECT_NEAR(kept[1], -commanded_share * 40, 1e-9) << braking;
  }
}

/// What the tool presses with is not known while brakes hold the arm.
TEST(WorkWatch, TellsTheSecondOfThreeSamplesBeyondALimitOnceAndByName) {
  const WorkLimits limits{.force_n = 100, .power_w = 80, .tool_power_w = 40};
  const WorkWatch::Is within{100, 80, 40};
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto with = [&](Work what, double value) {
    WorkWatch::Is is = within;
    (what == Work::ToolForce ? is.force_n : what == Work::Power ? is.power_w : is.tool_power_w) = value;
    return is;
  };
  for (const Work what : {Work::ToolForce, Work::Power, Work::ToolPower})
    for (const double value : {101.0, none}) {
      WorkWatch watch;
      for (int i = 0; i < 5; ++i) EXPECT_FALSE(watch.update(within, limits, true));
      EXPECT_FALSE(watch.update(with(what, value), limits, true));
      EXPECT_FALSE(watch.update(within, limits, true)) << "one disturbed sample";
      const auto found = watch.update(with(what, value), limits, true);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->what, what);
      EXPECT_FALSE(watch.update(with(what, value), limits, true)) << "told already";
      EXPECT_TRUE(watch.tripped());
      watch.arm();
      EXPECT_FALSE(watch.tripped());
      for (int i = 0; i < 5; ++i) {
        const auto braked = watch.update(with(what, value), limits, false);
        EXPECT_EQ(braked.has_value(), what == Work::Power && i == 1) << i;
      }
    }
}

/// On its path, and not stopped on its way.
TEST_F(WorkTest, AMotionGoesSlowerForThePowerOfItsJointsAndReachesItsGoal) {
  constexpr double limit_w = 60;
  robotics::Coordinates gravity;
  dynamics.bias(gravity);
  const JointVector held = gravity;
  const auto fly = [&](double most_w) {
    Setpoints setpoints{model, tip, bounds, cycle_s};
    setpoints.begin(start);
    setpoints.keep_power(held, most_w);
    EXPECT_TRUE(setpoints.go(goal, 1));
    int cycles = 0;
    double most = 0;
    JointVector before = zeros;
    for (; !setpoints.at_rest() && cycles < 60'000; ++cycles) {
      const Setpoint& now = setpoints.advance();
      double power_w = 0;
      for (Eigen::Index i = 0; i < 6; ++i) {
        const JointBounds& its = bounds[static_cast<std::size_t>(i)];
        power_w += (std::abs(held[i]) + 0.3 * its.effort) * std::abs(now.velocity[i]);
        EXPECT_LE(std::abs(now.velocity[i] - before[i]), 1.02 * its.motion.acceleration * cycle_s);
      }
      before = now.velocity;
      most = std::max(most, power_w);
    }
    EXPECT_LT((setpoints.now().position - goal).cwiseAbs().maxCoeff(), 1e-9);
    return std::pair{most, cycles};
  };
  const auto [free_w, free_cycles] = fly(HUGE_VAL);
  const auto [kept_w, kept_cycles] = fly(limit_w);
  EXPECT_GT(free_w, 2 * limit_w);
  EXPECT_LT(kept_w, limit_w);
  EXPECT_GT(kept_cycles, 2 * free_cycles);
}

/// Somebody sets the limit before, or at any moment of the line: more than it plans with is left only while a joint brakes with all that it may, and it is not beside its line meanwhile.
TEST_F(WorkTest, ALimitThatIsSetWhileItIsOnALineHasItGoSlowerOnThatLine) {
  Setpoints setpoints{model, tip, bounds, cycle_s};
  setpoints.begin(start);
  robotics::Pose goal = setpoints.tool();
  goal.position += Vector3{-0.15, 0.25, -0.1};
  const auto power_w = [&] {
    double sum_w = 0;
    for (Eigen::Index i = 0; i < 6; ++i)
      sum_w += 0.3 * bounds[static_cast<std::size_t>(i)].effort * std::abs(setpoints.now().velocity[i]);
    return sum_w;
  };
  double free_w = 0;
  const auto fly = [&](int set_at, double limit_w) {
    setpoints.begin(start);
    setpoints.keep_power(zeros, HUGE_VAL);
    EXPECT_TRUE(setpoints.go_straight(goal, {0.4, 1}));
    JointVector before = zeros;
    double off_m = 0;
    int cycles = 0;
    for (; cycles < 20'000 && (cycles == 0 || !setpoints.at_rest()); ++cycles) {
      if (cycles == set_at) setpoints.keep_power(zeros, limit_w);
      const Setpoint& now = setpoints.advance();
      for (Eigen::Index i = 0; i < 6; ++i)
        EXPECT_LE(std::abs(now.velocity[i] - before[i]),
                  1.001 * bounds[static_cast<std::size_t>(i)].motion.acceleration * cycle_s);
      double braked = 0;  // of the accelerations, the joint that is braked hardest
      for (Eigen::Index i = 0; i < 6; ++i)
        braked = std::max(braked, std::abs(now.velocity[i] - before[i]) /
                                      (bounds[static_cast<std::size_t>(i)].motion.acceleration * cycle_s));
      before = now.velocity;
      off_m = std::max(off_m, setpoints.off_line_m());
      if (cycles < set_at) free_w = std::max(free_w, power_w());
      if (cycles >= set_at && braked < 0.9) {
        EXPECT_LT(power_w(), 0.82 * limit_w) << set_at << " " << cycles;
      }
      if (cycles > set_at + 600 || set_at == 0) {
        EXPECT_LT(power_w(), 0.82 * limit_w) << set_at << " " << cycles;
      }
    }
    EXPECT_LT(off_m, 5e-4) << set_at;
    EXPECT_LT((setpoints.tool().position - goal.position).norm(), 1e-6) << set_at;
    return cycles;
  };
  const int free_cycles = fly(20'000, HUGE_VAL);
  const double limit_w = 0.4 * free_w;
  ASSERT_GT(limit_w, 5);
  ASSERT_GT(free_cycles, 900);
  for (int set_at : {0, 100, 250, 400, 550, 700, 850})
    EXPECT_GT(fly(set_at, limit_w), free_cycles + (set_at < 800 ? 100 : 0)) << set_at;
}

TEST_F(WorkTest, AJogGoesSlowerForThePowerOfItsJoints) {
  Setpoints setpoints{model, tip, bounds, cycle_s};
  const auto reached = [&](double most_w) {
    setpoints.begin(start);
    setpoints.keep_power(zeros, most_w);
    setpoints.jog(vector_of(std::array{1.5, 0.0, 0.0, 0.0, 0.0, 0.0}));
    for (int i = 0; i < 800; ++i) setpoints.advance();
    return setpoints.now().velocity[0];
  };
  EXPECT_NEAR(reached(HUGE_VAL), 1.5, 1e-9);
  EXPECT_NEAR(reached(50), 40 / (0.3 * 150), 1e-9);
}

}  // namespace
}  // namespace hirosco::robot_arm
