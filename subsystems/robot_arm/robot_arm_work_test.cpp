// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/flown.hpp"

/// Limits of the force at the tool, and of power, whatever moves the arm.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using ::testing::Each;
using ::testing::StartsWith;

constexpr double no_limit = 10'000;

struct RobotArmWork : ::testing::Test {
  Flown flown{6, std::string{folder} + "robot_arm.urdf"};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});

  void SetUp() override {
    flown.plant.place(start);
    flown.operate();
  }
  std::string asked(const char* function, const std::vector<double>& numbers) {
    const auto request = flown.ask(function, numbers);
    flown.cycle(3);
    return flown.rig.outcome(request);
  }
  /// What such a force takes at the joints, where the arm is.
  JointVector at_tool(const robotics::Vector3& force_n) const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = flown.plant.measured().position, .qd = JointVector::Zero(6)});
    robotics::Jacobian jacobian;
    dynamics.jacobian(flown.model.find_frame("tool").value(), jacobian);
    return jacobian.bottomRows<3>().transpose() * force_n;
  }
  void expect_stopped(std::uint16_t event) {
    EXPECT_EQ(flown.rig.events(event), 1);
    EXPECT_EQ(flown.rig.inhibited(), inhibited_by_author);
    flown.cycle(3);
    EXPECT_EQ(flown.mode, DeviceMode::Off);
    EXPECT_THAT(flown.commanded, Each(0.0));
  }
  /// The most that all joints gave and took on the way to the goal, and how many cycles that took.
  std::pair<double, int> fly_to(const JointVector& where) {
    const auto request = flown.move_j(where);
    double most_w = 0;
    int cycles = 0;
    while (flown.rig.outcome(request).find_first_of("78") == std::string::npos && cycles < 30'000)
      for (int i = 0; i < 10; ++i, ++cycles) {
        flown.cycle();
        const auto& measured = flown.plant.measured();
        most_w = std::max(most_w, measured.torque.cwiseProduct(measured.velocity).cwiseAbs().sum());
      }
    EXPECT_EQ(flown.rig.outcome(request), "1 3 5:0001 7");
    return {most_w, cycles};
  }
};

TEST_F(RobotArmWork, AMotionGoesSlowerForItsPowerAndIsNotStopped) {
  const auto [free_w, free_cycles] = fly_to(goal);
  static_cast<void>(fly_to(start));
  const double limit_w = 0.7 * free_w;
  ASSERT_GT(limit_w, 15);
  ASSERT_EQ(asked("SET_POWER_LIMIT", {limit_w, no_limit}), "1 3 7");
  const auto [kept_w, kept_cycles] = fly_to(goal);
  EXPECT_LT(kept_w, limit_w);
  EXPECT_GT(kept_cycles, free_cycles);
  EXPECT_LE(flown.off(goal), 1e-3);
  EXPECT_EQ(flown.rig.events(1041), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(RobotArmWork, MorePowerThanItsLimitIsStoppedByNameThoughNoTorqueAndNoSpeedIsTooMuch) {
  ASSERT_EQ(asked("SET_POWER_LIMIT", {100, no_limit}), "1 3 7");
  const auto motion = flown.move_j(goal, 0.2);
  flown.cycle(20);
  flown.told = flown.plant.measured();
  flown.told->torque[0] = 100;
  flown.told->velocity[0] = 1.5;
  flown.cycle(4);
  expect_stopped(1041);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:8003");
  EXPECT_EQ(flown.rig.events(1020), 0);
  EXPECT_EQ(flown.rig.events(1023), 0);
}

/// It goes as fast as its limit permits about an axis that carries nothing, and somebody pushes it on from behind. What holds it back and brakes it takes more than the limit, and its
/// drives give next to nothing: it stands as SET_CONTACT says, and has not been left to its brakes before it felt whom it met.
TEST_F(RobotArmWork, WhoBrakesHardForSomebodyGivesNoPowerAndIsNotStoppedForIt) {
  constexpr double limit_w = 30;
  ASSERT_EQ(asked("SET_POWER_LIMIT", {limit_w, no_limit}), "1 3 7");
  const auto motion = flown.ask("JOG_J", {0.5, 0, 0, 0, 0, 0, 1});
  flown.cycle(300);
  EXPECT_NEAR(flown.plant.measured().velocity[0], 0.5, 0.01);
  flown.outside[0] = 60;
  int taken_beyond = 0;
  double given_w = 0;
  for (int i = 0; i < 300; ++i) {
    if (i == 80) flown.outside[0] = 0;
    flown.cycle();
    const auto& measured = flown.plant.measured();
    const JointVector work_w = measured.torque.cwiseProduct(measured.velocity);
    given_w = std::max(given_w, work_w.cwiseMax(0.0).sum());
    if (work_w.cwiseMin(0.0).sum() < -limit_w) ++taken_beyond;
  }
  ASSERT_GT(taken_beyond, 10) << "counted as given it would be stopped";
  EXPECT_LT(given_w, 0.5 * limit_w);
  EXPECT_EQ(flown.rig.events(1025), 1);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:8004");
  EXPECT_EQ(flown.rig.events(1041), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  const auto next = flown.move_j(start);
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), "1 3 5:0001 7");
}

TEST_F(RobotArmWork, WhoPushesTheToolHarderThanItsLimitHasTheArmStopped) {
  ASSERT_EQ(asked("SET_CONTACT", {0, 0.3}), "1 3 7");
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {60}), "1 3 7");
  flown.outside = at_tool({0, 40, 0});
  flown.cycle(500);
  EXPECT_EQ(flown.rig.events(1040), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  EXPECT_THAT(asked("SET_FORCE_LIMIT", {30}), StartsWith("1 4:8005")) << "more acts on it already";
  flown.outside = at_tool({0, 90, 0});
  for (int i = 0; i < 100 && flown.rig.events(1040) == 0; ++i) flown.cycle();
  expect_stopped(1040);
}

/// Held by springs, and somebody moves it quickly.
TEST_F(RobotArmWork, MoreWorkOfTheToolThanItsLimitIsStopped) {
  ASSERT_EQ(asked("SET_CONTACT", {0, 0.3}), "1 3 7");
  ASSERT_EQ(asked("IMPEDANCE_J", {200, 200, 100, 20, 20, 20, 0.7}), "1 3 7");
  ASSERT_EQ(asked("SET_POWER_LIMIT", {no_limit, 5}), "1 3 7");
  flown.cycle(200);
  flown.outside[0] = 40;
  for (int i = 0; i < 500 && flown.rig.events(1042) == 0; ++i) flown.cycle();
  expect_stopped(1042);
}

/// Brakes hold it, drives give nothing, and what brakes hold is not taken for something that pushes.
TEST_F(RobotArmWork, BroughtUpAnewUnderALowLimitItIsNotStoppedForItsOwnWeight) {
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {20}), "1 3 7");
  flown.command(State::SafeOperational);
  flown.told = flown.plant.measured();
  flown.told->torque.setZero();
  flown.cycle(500);
  flown.command(State::Operational);
  flown.told.reset();
  flown.cycle(500);
  EXPECT_EQ(flown.rig.events(1040), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Who leans on it when it is let go is felt before the filter would have forgotten what brakes held.
TEST_F(RobotArmWork, IsWatchedSoonAfterItsBrakesHaveLetItGo) {
  ASSERT_EQ(asked("SET_CONTACT", {0, 0.3}), "1 3 7");
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {60}), "1 3 7");
  flown.command(State::SafeOperational);
  flown.cycle(200);
  flown.command(State::Operational);
  flown.outside = at_tool({0, 90, 0});
  int cycles = 0;
  for (; cycles < 200 && flown.rig.events(1040) == 0; ++cycles) flown.cycle();
  EXPECT_LE(cycles, 85);
  expect_stopped(1040);
}

/// Brakes hold more than the limit of its weight there, and drives nothing.
TEST_F(RobotArmWork, IsNotToldOfItsOwnBrakesWhereNoTorqueReachesADrive) {
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {20}), "1 3 7");
  for (const State state : {State::SafeOperational, State::ErrorOperational}) {
    flown.command(state);
    flown.told = flown.plant.measured();
    flown.told->torque.setZero();
    for (int i = 0; i < 300; ++i) {
      flown.cycle();
      ASSERT_NE(flown.mode, DeviceMode::Active) << to_text(state);
      ASSERT_THAT(flown.commanded, Each(0.0)) << to_text(state);
    }
    EXPECT_EQ(flown.rig.events(1040), 0) << to_text(state);
  }
}

/// What an arm may be about while torques reach its drives.
struct About {
  const char* what;
  void (*begin)(RobotArmWork& arm);
};
struct RobotArmWorkWhile : RobotArmWork, ::testing::WithParamInterface<About> {
  /// Somebody holds the first joint up until it is felt, and is gone.
  static void meet(RobotArmWork& arm, double reaction) {
    static_cast<void>(arm.flown.move_j(arm.goal, 0.3));
    arm.flown.cycle(300);
    ASSERT_EQ(arm.asked("SET_CONTACT", {reaction, 0.3}), "1 3 7");
    arm.flown.outside[0] = 70;
    for (int i = 0; i < 200 && arm.flown.rig.events(1025) == 0; ++i) arm.flown.cycle();
    EXPECT_EQ(arm.flown.rig.events(1025), 1);
    arm.flown.outside.setZero();
    arm.flown.cycle(70);
    ASSERT_EQ(arm.asked("SET_CONTACT", {0, 0.3}), "1 3 7");
  }
  static void brake(RobotArmWork& arm, const char* function) {
    static_cast<void>(arm.flown.move_j(arm.goal, 1));
    arm.flown.cycle(500);
    static_cast<void>(arm.flown.rig.call(function));
    arm.flown.cycle(5);
  }
};

TEST_P(RobotArmWorkWhile, ItDoesWhateverMoreForceThanItsLimitStopsIt) {
  ASSERT_EQ(asked("SET_CONTACT", {0, 0.3}), "1 3 7");
  flown.cycle(100);
  GetParam().begin(*this);
  ASSERT_EQ(asked("SET_FORCE_LIMIT", {60}), "1 3 7");
  ASSERT_EQ(flown.mode, DeviceMode::Active);
  ASSERT_EQ(flown.rig.events(1040), 0);
  flown.outside = at_tool({0, 90, 0});
  for (int i = 0; i < 100 && flown.rig.events(1040) == 0; ++i) flown.cycle();
  expect_stopped(1040);
}

INSTANTIATE_TEST_SUITE_P(
    Each, RobotArmWorkWhile,
    ::testing::Values(About{"Holds", [](RobotArmWork&) {}},
                      About{"Moves",
                            [](RobotArmWork& arm) {
                              static_cast<void>(arm.flown.move_j(arm.goal, 0.3));
                              arm.flown.cycle(300);
                            }},
                      About{"JogsItsJoints",
                            [](RobotArmWork& arm) {
                              static_cast<void>(arm.flown.ask("JOG_J", {0.2, 0, 0, 0, 0, 0, 1}));
                              arm.flown.cycle(300);
                            }},
                      About{"JogsItsTool",
                            [](RobotArmWork& arm) {
                              static_cast<void>(arm.flown.ask("JOG_L", {0, 0.05, 0, 0, 0, 0, 1}));
                              arm.flown.cycle(300);
                            }},
                      About{"GoesBack",
                            [](RobotArmWork& arm) {
                              static_cast<void>(arm.fly_to(arm.goal));
                              static_cast<void>(arm.flown.ask("RETREAT", {0.5}));
                              arm.flown.cycle(200);
                            }},
                      About{"IsSoftInItsJoints",
                            [](RobotArmWork& arm) {
                              EXPECT_EQ(arm.asked("IMPEDANCE_J", {200, 200, 100, 20, 20, 20, 0.7}), "1 3 7");
                              arm.flown.cycle(200);
                            }},
                      About{"IsSoftAtItsTool",
                            [](RobotArmWork& arm) {
                              EXPECT_EQ(arm.asked("IMPEDANCE_L", {400, 20, 0.7}), "1 3 7");
                              arm.flown.cycle(200);
                            }},
                      About{"IsDriven",
                            [](RobotArmWork& arm) {
                              EXPECT_THAT(arm.asked("TORQUE_J", {3, 0, 0, 0, 0, 0, 1}), StartsWith("1 3"));
                              arm.flown.cycle(100);
                            }},
                      About{"Floats",
                            [](RobotArmWork& arm) {
                              RobotArmWorkWhile::meet(arm, 2);
                              EXPECT_THAT(arm.asked("MOVE_J", {0, 0, 0, 0, 0, 0, 0.1}), StartsWith("1 4:800c"));
                            }},
                      About{"StandsBehindAContact", [](RobotArmWork& arm) { RobotArmWorkWhile::meet(arm, 1); }},
                      About{"BacksOffFromAContact", [](RobotArmWork& arm) { RobotArmWorkWhile::meet(arm, 3); }},
                      About{"BrakesForHold", [](RobotArmWork& arm) { RobotArmWorkWhile::brake(arm, "HOLD"); }},
                      About{"BrakesForStop", [](RobotArmWork& arm) { RobotArmWorkWhile::brake(arm, "STOP"); }}),
    [](const ::testing::TestParamInfo<About>& about) { return about.param.what; });

/// Brakes that open in 0.2 s, and drives that tell no torque until then.
struct SlowlyLetGo : robot_arm::testing::Flown {
  using Flown::Flown;
  int active{0};
  std::vector<double> play(std::span<const double> torques) override {
    active = mode == DeviceMode::Active ? active + 1 : 0;
    std::vector<double> numbers = Flown::play(torques);
    if (active > 200 || active == 0) return numbers;
    plant.place(held);
    for (std::size_t i = 0; i < n; ++i)
      numbers[i] = held[static_cast<Eigen::Index>(i)], numbers[n + i] = numbers[2 * n + i] = 0;
    return numbers;
  }
  robot_arm::JointVector held;
};

TEST(RobotArmWhoseBrakesOpenSlowly, FeelsNoForceOfThem) {
  SlowlyLetGo flown{6, std::string{robot_arm::testing::folder} + "robot_arm.urdf"};
  flown.held = robot_arm::vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  flown.plant.place(flown.held);
  flown.rig.bring_to(State::PreOperational, 1);
  flown.cycle(5);
  const auto limit = flown.ask("SET_FORCE_LIMIT", {60});
  flown.cycle(3);
  ASSERT_EQ(flown.rig.outcome(limit), "1 3 7");
  flown.command(State::SafeOperational);
  flown.command(State::Operational);
  flown.cycle(1000);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// 5 mm/s are no rest, where 5 mrad/s are.
TEST(RobotArmThatSlides, PassesItsSelfTestAtRestAlone) {
  const std::string file = robot_arm::testing::file_with(
      "slider.urdf",
      "<robot name='slider'><link name='base'/><joint name='a' type='prismatic'><parent link='base'/><child "
      "link='tool'/>"
      "<axis xyz='1 0 0'/><limit lower='0' upper='0.1' velocity='1' effort='50'/></joint><link name='tool'><inertial>"
      "<mass value='1'/><inertia ixx='0.01' ixy='0' ixz='0' iyy='0.01' iyz='0' izz='0.01'/></inertial></link></robot>");
  for (const auto& [speed_m_s, passes] : {std::pair{0.001, true}, {0.005, false}}) {
    robot_arm::testing::Flown slider{1, file};
    slider.plant.place(robot_arm::vector_of(std::array{0.05}));
    slider.told = slider.plant.measured();
    slider.told->velocity[0] = speed_m_s;
    slider.rig.bring_to(State::PreOperational, 1);
    slider.cycle(5);
    slider.command(State::SafeOperational);
    const auto request = slider.rig.send(17, 128, {});
    slider.cycle(40);
    const std::string outcome = slider.rig.outcome(request);
    EXPECT_EQ(outcome == "1 3 7", passes) << outcome;
  }
}

}  // namespace
}  // namespace hirosco
