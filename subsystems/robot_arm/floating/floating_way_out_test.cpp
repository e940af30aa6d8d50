// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/floating.hpp"
#include "subsystems/robot_arm/testing/stored_path.hpp"

/// Ways out of a floating arm, and that a way of its joints is judged before it goes (docs/adr/0209). In laws that track, whose base gives way, it is flown in missions/servicer/tests.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct FloatingArmOut : robot_arm::testing::FloatingWay {
  static constexpr std::uint16_t motion_done = 2101, retracted = 2112;
  static constexpr double near_enough = 2e-3;  ///< rad
  const std::string done = "1 3 7", aborted = "1 3 8:0204";

  /// In Safe-Operational, where nothing moves.
  void stand_safe() {
    flown.plant.place(ready);
    flown.rig.bring_to(State::PreOperational, 1);
    flown.cycle(5);
    flown.command(State::SafeOperational);
  }
  void store(const std::vector<JointVector>& postures) {
    ASSERT_EQ(flown.rig.outcome(robot_arm::testing::write_path(flown, postures)), done)
        << ::testing::PrintToString(flown.rig.explanations);
  }
  void operate_with(const std::vector<JointVector>& postures) {
    ASSERT_NO_FATAL_FAILURE(stand_safe());
    ASSERT_NO_FATAL_FAILURE(store(postures));
    flown.command(State::Operational);
  }
  hirosco::testing::Sent ask(const char* function, std::initializer_list<double> numbers) {
    const auto request = flown.rig.call(function, numbers);
    flown.cycle(3);
    return request;
  }
  std::string asked(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = ask(function, numbers);
    flown.finish(request);
    return flown.rig.outcome(request);
  }
  void go(const JointVector& where, double duration_s) {
    const auto request = move_joint(where, duration_s);
    flown.finish(request);
    ASSERT_EQ(flown.rig.outcome(request), done);
  }
  void expect_stands() {
    flown.cycle(1000);
    const JointVector where = flown.plant.measured().position;
    flown.cycle(500);
    EXPECT_LT(flown.off(where), 1e-3);
  }
};

TEST_F(FloatingArmOut, RetreatGoesBackByTheWayItCameAndNoFarther) {
  begin(ready);
  const auto none = ask("RETREAT", {0.1});
  EXPECT_THAT(flown.rig.outcome(none), StartsWith("1 4:800a")) << "it has not moved yet";
  ASSERT_NO_FATAL_FAILURE(go(turned(0.3), 4));
  JointVector corner = turned(0.3), beyond = turned(0.3);
  beyond[5] -= 0.2;
  ASSERT_NO_FATAL_FAILURE(go(beyond, 4));
  EXPECT_EQ(asked("RETREAT", {0.2}), done);
  EXPECT_LT(flown.off(corner), 0.015) << "within a place of the trail";
  EXPECT_EQ(flown.rig.events(retracted), 1);
  EXPECT_EQ(asked("RETREAT", {1.2}), done);
  EXPECT_LT(flown.off(ready), 0.015);
  EXPECT_LE(flown.fastest, 0.2);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  ASSERT_NO_FATAL_FAILURE(go(turned(0.2), 3));
}

TEST_F(FloatingArmOut, AbortPathIsGoneToItsNearestPostureAndOnToItsLast) {
  ASSERT_NO_FATAL_FAILURE(operate_with({turned(0.9), turned(0.2), turned(-0.4)}));
  const auto request = ask("MOVE_ABORT", {1});
  double to_first = HUGE_VAL, to_second = HUGE_VAL;
  for (int i = 0; i < 3000 && flown.rig.outcome(request) == "1 3"; ++i) {
    flown.cycle(10);
    to_first = std::min(to_first, flown.off(turned(0.9)));
    to_second = std::min(to_second, flown.off(turned(0.2)));
  }
  EXPECT_EQ(flown.rig.outcome(request), done);
  EXPECT_LT(flown.off(turned(-0.4)), near_enough);
  EXPECT_GT(to_first, 0.6);
  EXPECT_LT(to_second, 0.01) << "a corner is gone to, not cut";
  EXPECT_EQ(flown.rig.events(motion_done), 1);
  EXPECT_NEAR(flown.told_number("PROGRESS"), 1, 1e-2);
  EXPECT_LE(flown.fastest, 0.21);
  expect_stands();
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmOut, AbortPathIsCheckedWhileNothingMovesAndWhoIsInTheWayIsNamed) {
  ASSERT_NO_FATAL_FAILURE(stand_safe());
  const auto none = ask("CHECK_ABORT", {});
  EXPECT_THAT(flown.rig.outcome(none), StartsWith("1 4:800a"));
  EXPECT_THAT(flown.rig.outcome(none), HasSubstr(hex_of("ABORT_PATH.COUNT is 0")));
  ASSERT_NO_FATAL_FAILURE(store({turned(0.6), ready}));
  EXPECT_EQ(asked("CHECK_ABORT"), done);
  EXPECT_EQ(flown.told_number("ABORT_JUDGED"), 1);
  keep_out(tool_at(turned(0.4)));
  const std::string blocked = asked("CHECK_ABORT");
  EXPECT_THAT(blocked, StartsWith("1 3 8:8009"));
  EXPECT_THAT(blocked, HasSubstr(hex_of("a volume to keep out of")));
  ASSERT_NO_FATAL_FAILURE(store({robot_arm::vector_of(std::array{0.1, -1.0, 0.0, -2.0, 0.0, 0.0, 0.0})}));
  EXPECT_THAT(asked("CHECK_ABORT"), HasSubstr(hex_of("base and link")));
  EXPECT_EQ(flown.rig.events(motion_done), 0);
  EXPECT_EQ(flown.rig.events(too_near_event), 0);
}

TEST_F(FloatingArmOut, AbortPathIsJudgedForNoLongerThanIsDeclared) {
  ASSERT_NO_FATAL_FAILURE(stand_safe());
  flown.write("ABORT_JUDGING_LIMIT", 1.0);
  ASSERT_NO_FATAL_FAILURE(store({turned(2.7), turned(-2.7), turned(2.7), turned(-2.7), turned(2.7)}));
  const auto refused = ask("CHECK_ABORT", {});
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:800b"));
  EXPECT_THAT(flown.rig.outcome(refused), HasSubstr(hex_of("longer than ABORT_JUDGING_LIMIT, ms")));
}

TEST_F(FloatingArmOut, EndsBeforeItMovesWhereNoPostureCanBeReached) {
  ASSERT_NO_FATAL_FAILURE(operate_with({turned(0.9)}));
  keep_out(tool_at(turned(0.45)));
  expect_refused(ask("MOVE_ABORT", {1}), "and a volume to keep out of");
  ASSERT_NO_FATAL_FAILURE(go(turned(-0.2), 3));
}

/// As a recovery plan asks for it, which does not wait: behind TOO_NEAR the arm comes to rest for half a second yet.
TEST_F(FloatingArmOut, BeginsOnceTheArmStandsThatWasStoppedBeforeAVolume) {
  ASSERT_NO_FATAL_FAILURE(operate_with({ready}));
  const auto motion = move_joint(turned(0.9), 12);
  flown.cycle(2000);
  keep_out(tool_at(turned(0.7)));
  flown.finish(motion);
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:8009"));
  const auto out = ask("MOVE_ABORT", {1});
  EXPECT_EQ(flown.rig.outcome(out), "1 3") << "it waits";
  const auto other = ask("RETREAT", {0.2});
  EXPECT_THAT(flown.rig.outcome(other), StartsWith("1 4:0108")) << "one waits, not two";
  flown.finish(out);
  EXPECT_EQ(flown.rig.outcome(out), done);
  EXPECT_LT(flown.off(ready), near_enough);
  EXPECT_EQ(flown.rig.events(too_near_event), 1);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmOut, ThatWaitsOrGoesIsEndedByHold) {
  ASSERT_NO_FATAL_FAILURE(operate_with({turned(-0.8)}));
  static_cast<void>(move_joint(turned(0.6), 8));
  flown.cycle(4000);
  EXPECT_EQ(flown.rig.outcome(ask("HOLD", {})), done);
  const auto waits = ask("RETREAT", {0.2});
  EXPECT_EQ(flown.rig.outcome(waits), "1 3") << "it comes to rest yet";
  EXPECT_EQ(flown.rig.outcome(ask("HOLD", {})), done);
  EXPECT_EQ(flown.rig.outcome(waits), aborted);
  expect_stands();
  const auto goes = ask("MOVE_ABORT", {1});
  flown.cycle(3000);
  EXPECT_EQ(flown.rig.outcome(ask("HOLD", {})), done);
  EXPECT_EQ(flown.rig.outcome(goes), aborted);
  expect_stands();
  EXPECT_GT(flown.off(turned(-0.8)), 0.2);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmOut, OvercomesNoBrakes) {
  ASSERT_NO_FATAL_FAILURE(operate_with({turned(0.3)}));
  EXPECT_EQ(asked("BRAKE"), done);
  for (const char* function : {"RETREAT", "MOVE_ABORT"}) {
    const auto refused = ask(function, {0.5});
    EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:8006")) << function;
  }
  flown.command(State::SafeOperational);
  flown.command(State::Operational);
  const auto goes = ask("MOVE_ABORT", {1});
  flown.cycle(500);
  flown.command(State::SafeOperational);
  EXPECT_EQ(flown.rig.outcome(goes), aborted);
}

TEST_F(FloatingArmOut, IsSomethingThatADescriptorMayLeaveOut) {
  std::string text = robot_arm::testing::floating_descriptor();
  const auto cut = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.erase(at, text.find(to, at) + to.size() - at);
  };
  cut("<StructRef name=\"ABORT_PATH\"", R"(minimum="1" maximum="30" writable="PreOperational SafeOperational"/>)");
  for (const char* function : {"RETREAT", "MOVE_ABORT", "CHECK_ABORT"})
    cut(std::string{"<Function name=\""} + function, "</Function>");
  cut("<Event name=\"RETRACTED\"", "</Event>");
  robot_arm::testing::FlownFloating other{text};
  other.plant.place(ready);
  other.operate();
  const JointVector there = turned(0.1);
  const auto motion =
      other.rig.call("MOVE_JOINT", {there[0], there[1], there[2], there[3], there[4], there[5], there[6], 3});
  other.finish(motion);
  EXPECT_EQ(other.rig.outcome(motion), done);
}

TEST_F(FloatingArmOut, AWayOfJointsThatSomebodyIsInIsToldWithThePairAndWhereAndNothingMoves) {
  begin(ready);
  keep_out(tool_at(turned(0.45)));
  expect_refused(move_joint(turned(0.9), 12), "and a volume to keep out of");
  const double where = flown.told_number("PROGRESS");
  EXPECT_GT(where, 0.1);
  EXPECT_LT(where, 0.5) << "before the middle, where the ball is";
}

}  // namespace
}  // namespace hirosco
