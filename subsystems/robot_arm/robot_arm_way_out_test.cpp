// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/way_out.hpp"

/// Out while it still brakes, by a stored path or the way it came (docs/adr/0199).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::Flown;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct RobotArmWayOut : robot_arm::testing::WayOut {
  /// In the midst of a motion it is told to hold, and has begun to brake.
  void brake(const char* by = "HOLD") {
    static_cast<void>(flown.move_j(goal));
    flown.cycle(400);
    static_cast<void>(flown.rig.call(by));
    flown.cycle(3);
    ASSERT_GT(flown.plant.measured().velocity.cwiseAbs().maxCoeff(), 0.2) << "it moves still";
  }
};

TEST_F(RobotArmWayOut, AndRetreatBeginOnceTheArmStandsThatStillBrakes) {
  store({start});
  operate();
  ASSERT_NO_FATAL_FAILURE(brake());
  const auto retreat = flown.ask("RETREAT", {0.2});
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(retreat), "1 3") << "it waits";
  flown.finish(retreat);
  EXPECT_EQ(flown.rig.outcome(retreat), "1 3 7");
  EXPECT_EQ(flown.rig.events(1027), 1);
  ASSERT_NO_FATAL_FAILURE(brake());
  const auto out = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(out), "1 3") << "it waits";
  const auto other = flown.ask("RETREAT", {0.2});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(other), StartsWith("1 4:0108")) << "one waits, not two";
  flown.finish(out);
  EXPECT_EQ(flown.rig.outcome(out), done);
  EXPECT_LE(flown.off(start), 1e-3);
}

/// A contact ends the torque, and its law is in force until the next cycle.
TEST_F(RobotArmWayOut, ThatWaitsIsNotTakenForATorqueThatIsSaidAnew) {
  store({start});
  operate();
  const std::vector<double> torque{6, 0, 0, 0, 0, 0, 1};
  const auto driven = flown.ask("TORQUE_J", torque);
  flown.cycle(400);
  flown.outside[0] = -60;
  for (int i = 0; i < 100 && flown.rig.events(1025) == 0; ++i) flown.cycle();
  flown.outside[0] = 0;
  const auto out = flown.ask("MOVE_ABORT", {0.5}), again = flown.ask("TORQUE_J", torque);
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(driven), "1 3 8:8004");
  EXPECT_EQ(flown.rig.outcome(out), "1 3") << "it waits";
  EXPECT_THAT(flown.rig.outcome(again), StartsWith("1 4:0108")) << "who met somebody is not driven on";
}

TEST_F(RobotArmWayOut, ThatWaitsIsRefusedInItsOwnWordsOnceTheArmStands) {
  operate();
  ASSERT_NO_FATAL_FAILURE(brake());
  const auto out = flown.ask("MOVE_ABORT", {0.5});
  flown.finish(out);
  EXPECT_THAT(flown.rig.outcome(out), StartsWith("1 3 8:8009"));
  EXPECT_THAT(flown.rig.outcome(out), HasSubstr(hex_of("ABORT_PATH.COUNT is 0")));
}

TEST_F(RobotArmWayOut, ThatWaitsIsCalledOffByHoldAndTheArmStands) {
  store({start});
  operate();
  for (const char* function : {"RETREAT", "MOVE_ABORT"}) {
    ASSERT_NO_FATAL_FAILURE(brake());
    const auto waits = flown.ask(function, {0.5});
    flown.cycle(3);
    const auto hold = flown.rig.call("HOLD");
    flown.cycle(3);
    EXPECT_EQ(flown.rig.outcome(hold), "1 3 7");
    EXPECT_EQ(flown.rig.outcome(waits), aborted) << function;
    EXPECT_EQ(stands(), "it stands") << function;
    EXPECT_GT(flown.off(start), 0.02) << function;
    const auto back = flown.move_j(start);
    flown.finish(back);
    ASSERT_EQ(flown.rig.outcome(back), done);
  }
}

TEST_F(RobotArmWayOut, NeverOvercomesAStopHoweverItIsAskedFor) {
  store({start});
  operate();
  ASSERT_NO_FATAL_FAILURE(brake("STOP"));
  const auto refused = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:0108")) << "a stop is under way";
  EXPECT_EQ(stands(), "it stands");
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  flown.command(State::SafeOperational);
  operate();
  ASSERT_NO_FATAL_FAILURE(brake());
  const auto waits = flown.ask("RETREAT", {0.5});
  flown.cycle(3);
  const auto stop = flown.rig.call("STOP");
  flown.finish(stop);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(waits), aborted);
  flown.cycle(500);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  EXPECT_EQ(flown.rig.inhibited(), inhibited_by_author);
}

TEST_F(RobotArmWayOut, ThatWaitsEndsWithTheLimitThatTookTheActuatorsAway) {
  store({start});
  operate();
  ASSERT_NO_FATAL_FAILURE(brake());
  const auto waits = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  flown.told = flown.plant.measured();
  flown.told->torque[3] = 23;
  flown.cycle(4);
  EXPECT_EQ(flown.rig.outcome(waits), "1 3 8:8003");
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  flown.cycle(100);
  EXPECT_EQ(flown.rig.inhibited(), inhibited_by_author);
}

TEST_F(RobotArmWayOut, BeginsBehindTheWayBackFromAContact) {
  store({start});
  operate();
  const auto set = flown.rig.call_with("SET_CONTACT", {Value{Number{std::uint8_t{3}}}, Value{0.3}});
  flown.cycle(3);
  ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  const auto motion = flown.move_j(goal, 0.5);
  flown.cycle(500);
  flown.outside[0] = 60;
  for (int i = 0; i < 200 && flown.rig.events(1025) == 0; ++i) flown.cycle();
  flown.outside[0] = 0;
  flown.cycle(20);
  ASSERT_EQ(flown.rig.outcome(motion), "1 3 8:8004");
  const auto out = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(out), "1 3") << "it backs off by itself, and this waits";
  flown.finish(out);
  EXPECT_EQ(flown.rig.outcome(out), done);
  EXPECT_EQ(flown.rig.events(1027), 1);
  EXPECT_LE(flown.off(start), 1e-3);
}

TEST_F(RobotArmWayOut, ThatWaitsEndsWhereOperationalIsLeftAndBeginsNowhereElse) {
  store({start});
  operate();
  for (const State state : {State::SafeOperational, State::ErrorOperational}) {
    ASSERT_NO_FATAL_FAILURE(brake());
    const auto waits = flown.ask("MOVE_ABORT", {0.5});
    flown.cycle(3);
    ASSERT_EQ(flown.rig.outcome(waits), "1 3") << to_text(state);
    flown.command(state);
    EXPECT_EQ(flown.rig.outcome(waits), aborted) << to_text(state);
    EXPECT_NE(flown.mode, DeviceMode::Active) << to_text(state);
    EXPECT_EQ(stands(), "it stands") << to_text(state);
    if (state == State::ErrorOperational) break;  // from there the way is down
    operate();
    EXPECT_EQ(stands(), "it stands") << to_text(state);
    EXPECT_GT(flown.off(start), 0.02) << to_text(state);
    const auto back = flown.move_j(start);
    flown.finish(back);
    ASSERT_EQ(flown.rig.outcome(back), done) << to_text(state);
  }
}

/// An arm of less acceleration than ours may have brakes for longer than that.
TEST_F(RobotArmWayOut, IsWaitedForTwelveSeconds) {
  std::string text = descriptor_for(6, file);
  const std::string usual = R"(unit="rad/s2" init="4" minimum="0.1")";
  ASSERT_NE(text.find(usual), std::string::npos);
  robot_arm::testing::replace_all(text, usual, R"(unit="rad/s2" init="0.02" minimum="0.01")");
  Flown slow{robot_arm::testing::model_of(file), text};
  JointVector from = start, to = start;
  from[0] = -2.4;
  to[0] = 2.8;
  slow.plant.place(from);
  slow.operate();
  const auto motion = slow.move_j(to);
  slow.cycle(9'000);
  static_cast<void>(slow.rig.call("HOLD"));
  slow.cycle(3);
  ASSERT_EQ(slow.rig.outcome(motion), aborted);
  const auto waits = slow.ask("MOVE_ABORT", {0.5});
  EXPECT_NEAR(slow.finish(waits), 12'000, 20);
  EXPECT_EQ(slow.rig.outcome(waits), "1 3 8:8001");
  const JointVector where = slow.plant.measured().position;
  slow.cycle(10);
  EXPECT_GT(slow.off(where), 1e-6) << "it brakes still";
  slow.cycle(5'000);
  const JointVector there = slow.plant.measured().position;
  slow.cycle(500);
  EXPECT_LT(slow.off(there), 1e-3) << "and stands, and goes nowhere";
}

}  // namespace
}  // namespace hirosco
