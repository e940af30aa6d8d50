// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/driven.hpp"
#include "subsystems/robot_gripper/robot_gripper.hpp"
#include "subsystems/robot_gripper/testing/plant.hpp"

/// A gripper as its subsystem, with a test as its device: brakes that keep what was pressed, and what is between its fingers.
namespace hirosco {
namespace {

using robot_gripper::Finger;
using robot_gripper::Fingers;
using robot_gripper::Joints;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* folder = HIROSCO_SOURCE_DIR "/subsystems/robot_gripper/";
constexpr std::uint16_t motion_done = 1001, object_held = 1002, object_released = 1003, object_lost = 1004,
                        nothing_met = 1005, force_exceeded = 1020, speed_exceeded = 1023;

std::string descriptor_with(const std::string& from = "", const std::string& to = "") {
  std::string text = descriptor::file_system()(std::string{folder} + "robot_gripper.xml").value();
  const std::string file = "value=\"robot_gripper.urdf\"";
  text.replace(text.find(file), file.size(), "value=\"" + std::string{folder} + "robot_gripper.urdf\"");
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

struct RobotGripperTest : ::testing::Test, hirosco::testing::Driven {
  /// As the file says, with 2 kg of rotor.
  Fingers fingers{
      std::array{Finger{.closed = 0, .open = 0.05, .effort = 80, .velocity = 0.1, .moved = 2.3, .friction = 1}}, 0.1};
  robot_gripper::testing::Plant plant{fingers};
  std::optional<robot_gripper::Measured> told;  ///< in place of the truth

  RobotGripperTest() : Driven{make_robot_gripper(), descriptor_with(), "robot-gripper"} {}
  std::vector<double> play(std::span<const double> forces) override {
    Joints commanded = Joints::zeros(1);
    commanded[0] = forces[0];
    if (mode == DeviceMode::Active) plant.step(commanded, 0.001);
    const robot_gripper::Measured& measured = told ? *told : plant.measured();
    return {measured.position[0], measured.velocity[0], measured.torque[0]};
  }
  std::string done(const char* function, std::initializer_list<double> arguments) {
    const auto request = rig.call(function, arguments);
    finish(request);
    return rig.outcome(request);
  }
  void hold_a_box(double force_n = 20) {
    operate();
    plant.object_m = 0.06;
    ASSERT_EQ(done("GRIP", {force_n, 0.05}), "1 3 5:0001 7");
    ASSERT_EQ(rig.events(object_held), 1);
  }
};

TEST_F(RobotGripperTest, GoesToWidthsAndOpens) {
  operate();
  EXPECT_EQ(done("MOVE_TO", {0.03, 0.1}), "1 3 5:0001 7");
  EXPECT_NEAR(plant.width_m(), 0.03, 5e-4);
  EXPECT_EQ(done("OPEN", {0.2}), "1 3 5:0001 7");
  EXPECT_NEAR(plant.width_m(), 0.1, 5e-4);
  EXPECT_EQ(rig.events(motion_done), 2);
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(RobotGripperTest, HoldsABoxWithTheForceThatItWasToldAndLetsGoWhenItOpens) {
  hold_a_box();
  EXPECT_NEAR(plant.pressed_n, 20, 1);
  EXPECT_THAT(done("MOVE_TO", {0.03, 0.1}), StartsWith("1 4:800a")) << "it never presses by width";
  EXPECT_EQ(done("GRIP", {8, 0.05}), "1 3 5:0001 7");
  EXPECT_NEAR(plant.pressed_n, 8, 0.4);
  EXPECT_EQ(done("OPEN", {0.1}), "1 3 5:0001 7");
  EXPECT_EQ(rig.events(object_released), 1);
  EXPECT_EQ(plant.pressed_n, 0);
  EXPECT_EQ(rig.events(object_lost), 0);
}

TEST_F(RobotGripperTest, SaysThatItMetNothing) {
  operate();
  EXPECT_THAT(done("GRIP", {20, 0.1}), HasSubstr(" 8:8005"));
  EXPECT_EQ(rig.events(nothing_met), 1);
  EXPECT_EQ(rig.events(object_held), 0);
  EXPECT_EQ(done("OPEN", {0.2}), "1 3 5:0001 7");
}

TEST_F(RobotGripperTest, TellsOnceThatWhatItHeldIsLostAndStandsThere) {
  hold_a_box();
  plant.object_m.reset();
  cycle(1000);
  EXPECT_EQ(rig.events(object_lost), 1);
  EXPECT_EQ(rig.events(speed_exceeded), 0);
  EXPECT_GT(plant.width_m(), 0.05) << "it closes no further";
  EXPECT_LT(std::abs(plant.closing_m_s()), 1e-4);
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(RobotGripperTest, GoesOnPressingWhenItIsForcedOpenAndTellsIt) {
  hold_a_box();
  for (int i = 0; i < 400; ++i) {
    plant.object_m = 0.06 + 1e-5 * i;
    cycle();
  }
  EXPECT_EQ(rig.events(object_lost), 1);
  cycle(500);
  EXPECT_NEAR(plant.pressed_n, 20, 1.5);
}

TEST_F(RobotGripperTest, DoesNotLetGoInSafeOperationalAndGoesOnPressingAfterwards) {
  hold_a_box();
  command(State::SafeOperational);
  EXPECT_EQ(mode, DeviceMode::Off) << "its brakes hold";
  cycle(200);
  EXPECT_NEAR(plant.pressed_n, 20, 1);
  command(State::Operational);
  double least_n = 1e9;
  for (int i = 0; i < 500; ++i) {
    cycle();
    least_n = std::min(least_n, plant.pressed_n);
  }
  EXPECT_GT(least_n, 17);
  EXPECT_EQ(rig.events(object_lost), 0);
  EXPECT_EQ(rig.events(object_held), 1);
}

TEST_F(RobotGripperTest, TellsALossInSafeOperational) {
  hold_a_box();
  command(State::SafeOperational);
  plant.open(0.3);
  cycle(10);
  EXPECT_EQ(rig.events(object_lost), 1);
}

TEST_F(RobotGripperTest, ConfiguredAnewItKnowsByItsBrakesThatItHoldsSomething) {
  hold_a_box();
  command(State::SafeOperational);
  command(State::PreOperational);
  const auto again = rig.configure(1);
  cycle(20);
  ASSERT_EQ(rig.outcome(again), "1 3 7");
  command(State::SafeOperational);
  command(State::Operational);
  cycle(500);
  EXPECT_EQ(rig.events(object_held), 2);
  EXPECT_NEAR(plant.pressed_n, 20, 1.5);
}

TEST_F(RobotGripperTest, StopAndHoldLetNothingGo) {
  hold_a_box();
  const auto hold = rig.call("HOLD");
  cycle(200);
  EXPECT_EQ(rig.outcome(hold), "1 3 7");
  EXPECT_NEAR(plant.pressed_n, 20, 1);
  const auto stop = rig.call("STOP");
  cycle(20);
  EXPECT_EQ(rig.outcome(stop), "1 3 7");
  EXPECT_EQ(mode, DeviceMode::Off);
  EXPECT_EQ(rig.inhibited(), inhibited_by_author);
  cycle(200);
  EXPECT_NEAR(plant.pressed_n, 20, 1);
  EXPECT_THAT(done("OPEN", {0.1}), StartsWith("1 4:8006"));
  EXPECT_EQ(rig.events(object_lost), 0);
}

TEST_F(RobotGripperTest, StopsOnItsWayWhereItIs) {
  operate();
  const auto motion = rig.call("MOVE_TO", {0.02, 0.1});
  cycle(300);
  const auto stop = rig.call("STOP");
  finish(stop);
  EXPECT_EQ(rig.outcome(stop), "1 3 7");
  EXPECT_EQ(rig.outcome(motion), "1 3 8:0204");
  EXPECT_GT(plant.width_m(), 0.03);
}

TEST_F(RobotGripperTest, GivesUpWhereSomethingIsInTheWay) {
  operate();
  plant.object_m = 0.06;
  EXPECT_THAT(done("MOVE_TO", {0.03, 0.1}), HasSubstr(" 8:8004"));
  EXPECT_LE(plant.pressed_n, 10.5);
  cycle(500);
  EXPECT_LT(plant.pressed_n, 2) << "it backs off";
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(RobotGripperTest, WhoIsAheadOfItsPathIsNotObstructed) {
  operate();
  ASSERT_EQ(done("MOVE_TO", {0.02, 0.1}), "1 3 5:0001 7");
  const auto open = rig.call("OPEN", {0.02});
  cycle(300);
  // By somebody who pulls harder than it holds, three times as fast as it goes.
  for (int i = 0; i < 4500; ++i) {
    plant.pulled_open_n = plant.closing_m_s() < -0.06 ? 8 : 12;
    cycle();
    if (i == 600) {
      EXPECT_GT(plant.width_m(), 0.055) << "its path is at 0.036 then";
    }
  }
  finish(open);
  EXPECT_EQ(rig.outcome(open), "1 3 5:0001 7");
}

TEST_F(RobotGripperTest, DoesOneThingAtATimeUntilItIsToldToHold) {
  operate();
  const auto grip = rig.call("GRIP", {10, 0.1});
  cycle(3);
  EXPECT_THAT(done("OPEN", {0.1}), StartsWith("1 4:"));
  const auto hold = rig.call("HOLD");
  cycle(3);
  EXPECT_EQ(rig.outcome(hold), "1 3 7");
  EXPECT_EQ(rig.outcome(grip), "1 3 8:0204");
  cycle(300);
  EXPECT_LT(std::abs(plant.closing_m_s()), 1e-4);
}

struct RobotGripperWatch : RobotGripperTest, ::testing::WithParamInterface<double> {};
TEST_P(RobotGripperWatch, IsInhibitedInTheCycleByTooMuchForceAndByWhatIsNoNumber) {
  operate();
  told = plant.measured();
  told->torque[0] = GetParam();
  cycle(4);
  EXPECT_EQ(mode, DeviceMode::Off);
  EXPECT_EQ(rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(rig.events(force_exceeded), 1);
}
INSTANTIATE_TEST_SUITE_P(Torques, RobotGripperWatch, ::testing::Values(-78.0, 78.0, std::nan("")));

/// One value is written in Pre-Operational after CONFIGURE; of what is told of the torque each other cycle is `shake` above and below.
struct RobotGripperWritten : RobotGripperTest {
  double hardest_n{0}, shake{0};
  std::vector<double> play(std::span<const double> forces) override {
    hardest_n = std::max(hardest_n, std::abs(forces[0]));
    std::vector<double> numbers = RobotGripperTest::play(forces);
    numbers[2] *= 1 + shake;
    shake = -shake;
    return numbers;
  }
  void operate_with(const char* name, double value) {
    rig.bring_to(State::PreOperational, 1);
    cycle(5);
    write(name, value);
    command(State::SafeOperational);
    command(State::Operational);
    hardest_n = 0;
  }
  /// What drives it in the first 20 ms, in which a jerk of 10 m/s3 comes to 0.2 m/s2.
  double begins_with_n() {
    rig.call("MOVE_TO", {0.03, 0.1});
    cycle(20);
    return hardest_n;
  }
  int holds_shaken() {
    plant.object_m = 0.06;
    shake = 0.1;
    rig.call("GRIP", {20, 0.05});
    cycle(5000);
    return rig.events(object_held);
  }
};
TEST_F(RobotGripperWritten, ALightRotorIsMovedByLittle) {
  operate_with("ROTOR_INERTIA", 2);
  EXPECT_LT(begins_with_n(), 3);
}
TEST_F(RobotGripperWritten, AHeavyRotorIsMovedByMuch) {
  operate_with("ROTOR_INERTIA", 100);
  EXPECT_GT(begins_with_n(), 6);
}
TEST_F(RobotGripperWritten, ItAcceleratesNoMoreThanItIsTo) {
  operate_with("ACCELERATION", 0.01);
  EXPECT_GT(finish(rig.call("MOVE_TO", {0.03, 0.1})), 4000)
      << "2 sqrt(0.07 m / 0.01 m/s2) is 5.3 s, and 1 s as it is configured";
}
TEST_F(RobotGripperWritten, AWideToleranceHoldsWhatShakesAsMuch) {
  operate_with("FORCE_TOLERANCE", 0.2);
  EXPECT_EQ(holds_shaken(), 1);
}
TEST_F(RobotGripperWritten, ANarrowToleranceDoesNot) {
  operate_with("FORCE_TOLERANCE", 0.05);
  EXPECT_EQ(holds_shaken(), 0);
}

TEST_F(RobotGripperTest, PassesItsSelfTestAlsoWithSomethingBetweenItsFingers) {
  hold_a_box();
  command(State::SafeOperational);
  const auto request = rig.send(17, 128, {});
  cycle(40);
  EXPECT_THAT(rig.outcome(request), HasSubstr("7")) << ::testing::PrintToString(rig.explanations);
  command(State::Operational);
  cycle(100);
  EXPECT_NEAR(plant.pressed_n, 20, 1.5);
}

/// A descriptor or a file that is wrong, and what it is refused with.
struct Wrong {
  const char* from;
  const char* to;
  const char* told;
};
struct RobotGripperRefuses : ::testing::TestWithParam<Wrong> {};

TEST_P(RobotGripperRefuses, WhatDoesNotFitTogether) {
  const auto& [from, to, told] = GetParam();
  const auto author = make_robot_gripper();
  hirosco::testing::Rig rig{*author, descriptor_with(from, to)};
  const std::string up = rig.set_state_now(State::PreOperational);
  if (up == "1 3 7") {
    EXPECT_THAT(rig.configure_now(1), StartsWith("1 3 8:"));
  }
  EXPECT_THAT(rig.explanations, Contains(HasSubstr(told)));
}

INSTANTIATE_TEST_SUITE_P(
    Descriptors, RobotGripperRefuses,
    ::testing::Values(
        Wrong{"sampling_us=\"1000\"", "sampling_us=\"5000\"", "sampling_us is too long"},
        Wrong{"robot_gripper.urdf\"/>", "nowhere.urdf\"/>", "nowhere.urdf"},
        Wrong{"name=\"CLOSED\" value=\"lower\"", "name=\"CLOSED\" value=\"left\"", "CLOSED of GRIPPER is 'left'"},
        Wrong{"name=\"CLOSED\" value=\"lower\"", "name=\"FINGERS\" value=\"thumb\"", "has no joint 'thumb'"},
        Wrong{R"(name="POSITION" id="100" type="DOUBLE" count="1")",
              R"(name="POSITION" id="100" type="DOUBLE" count="2")",
              "CUR_VALUES.POSITION has another length than there are finger joints"}));

}  // namespace
}  // namespace hirosco
