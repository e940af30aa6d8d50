// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/way_out.hpp"

/// Out by a stored path (docs/adr/0199).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::Flown;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct RobotArmAbort : robot_arm::testing::WayOut {};

TEST_F(RobotArmAbort, GoesToTheNearestPostureOfItsPathAndFromThereToTheLast) {
  store({turned(0.8), turned(0.3), turned(0.3, 0.4)});
  operate();
  const auto request = flown.ask("MOVE_ABORT", {0.5});
  double to_first = HUGE_VAL, to_second = HUGE_VAL;
  for (int i = 0; i < 6000 && flown.rig.outcome(request).find_first_of("78") == std::string::npos; ++i) {
    flown.cycle();
    to_first = std::min(to_first, flown.off(turned(0.8)));
    to_second = std::min(to_second, flown.off(turned(0.3)));
  }
  EXPECT_EQ(flown.rig.outcome(request), done);
  EXPECT_LE(flown.off(turned(0.3, 0.4)), 1e-3);
  EXPECT_LE(to_second, 0.01) << "a corner is gone to, not cut";
  EXPECT_GT(to_first, 0.45);
  EXPECT_EQ(flown.rig.events(1001), 1);
  EXPECT_LE(flown.largest_share, 1);
  const auto again = flown.ask("MOVE_ABORT", {0.5});
  flown.finish(again);
  EXPECT_EQ(flown.rig.outcome(again), done) << "where it is already it is done";
}

TEST_F(RobotArmAbort, GoesNoFasterThanItIsTold) {
  store({turned(1)});
  operate();
  const auto request = flown.ask("MOVE_ABORT", {0.25});
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), done);
  EXPECT_LE(flown.fastest, 0.25 * 2 * 1.1) << "of 2 rad/s";
  EXPECT_GE(flown.fastest, 0.25 * 2 * 0.9);
}

TEST_F(RobotArmAbort, IsRefusedInWordsWhereNoPathIsStoredOrAPostureIsOutOfRange) {
  operate();
  const auto none = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(none), StartsWith("1 4:8009"));
  EXPECT_THAT(flown.rig.outcome(none), HasSubstr(hex_of("ABORT_PATH.COUNT is 0")));
  flown.command(State::SafeOperational);
  JointVector beyond = start;
  beyond[1] = 2.5;
  store({start, beyond});
  operate();
  for (const auto& request : {flown.ask("MOVE_ABORT", {0.5}), flown.rig.call("CHECK_ABORT")}) {
    flown.cycle(3);
    EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 4:8002"));
    EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of("posture 2 is out of the range of joint")));
  }
  flown.cycle(100);
  EXPECT_LT(flown.off(start), 1e-3);
}

TEST_F(RobotArmAbort, MayHaveAPostureAtTheVeryEndOfARange) {
  JointVector end = start;
  end[1] = 2.2;
  ASSERT_GT(static_cast<double>(static_cast<float>(end[1])), 2.2) << "as it is stored";
  store({end});
  EXPECT_THAT(check(), StartsWith("1 3 ")) << "it is judged, and not refused";
}

TEST_F(RobotArmAbort, PathIsWrittenWhileNothingCanMoveAndOutlivesTheProcess) {
  const auto& parameters = flown.rig.descriptor().parameters;
  const auto its = std::ranges::find(parameters, std::string_view{"ABORT_PATH"},
                                     [](const auto& each) { return std::string_view{each.field.name}; });
  ASSERT_NE(its, parameters.end());
  EXPECT_TRUE(its->persistent);
  operate();
  EXPECT_NE(flown.rig.outcome(write_path({start})), "1 3 7");
  const auto none = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(none), StartsWith("1 4:8009")) << "nothing of it was taken";
}

TEST_F(RobotArmAbort, PathThatTakesLongerThanATelecommandMayIsToldByItsCheck) {
  store({turned(2.4), turned(-2.4), turned(2.4), turned(-2.4), turned(2.4), turned(-2.4), turned(2.4), turned(-2.4)});
  EXPECT_THAT(check(), StartsWith("1 3 8:8007"));
  operate();
  const auto out = flown.ask("MOVE_ABORT", {0.25});
  flown.finish(out);
  EXPECT_THAT(flown.rig.outcome(out), StartsWith("1 3 8:8007")) << "as its check has said";
  EXPECT_LT(flown.off(start), 1e-3);
}

/// There and back by 4.8 rad, again and again: 241 cycles each at most.
TEST_F(RobotArmAbort, PathIsNotJudgedForLongerThanIsDeclaredAndTheBoundIsNamed) {
  std::vector<JointVector> path{turned(2.4), turned(-2.4), turned(2.4), turned(-2.4)};
  flown.write("ABORT_JUDGING_LIMIT", 1.0);
  store(path);
  EXPECT_EQ(check(), "1 3 7");
  path.push_back(turned(2.4));
  path.push_back(turned(-2.4));
  store(path);
  const auto longer = flown.rig.call("CHECK_ABORT");
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(longer), StartsWith("1 4:8007"));
  EXPECT_THAT(flown.rig.outcome(longer), HasSubstr(hex_of("longer than ABORT_JUDGING_LIMIT, ms")));
  operate();
  const auto out = flown.ask("MOVE_ABORT", {1});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(out), StartsWith("1 4:8007")) << "what is not judged is not gone";
  flown.cycle(300);
  EXPECT_LT(flown.off(start), 1e-3);
}

/// One posture is looked at in a cycle, and everybody else is answered meanwhile.
TEST_F(RobotArmAbort, TellsHowFarItIsJudgedAndKeepsNobodyWaiting) {
  store({turned(2.4), turned(-2.4)});
  const auto request = flown.rig.call("CHECK_ABORT");
  flown.cycle(121);
  EXPECT_EQ(flown.rig.outcome(request), "1 3");
  EXPECT_NEAR(flown.told_number("ABORT_JUDGED"), 0.5, 0.05);
  const auto ping = flown.rig.send(17, 1, {});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(ping), ::testing::EndsWith("7"));
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  EXPECT_EQ(flown.told_number("ABORT_JUDGED"), 1);
}

TEST_F(RobotArmAbort, PathIsCheckedForThePowerThatItMayGoWith) {
  store({turned(2.4), turned(-2.4), turned(2.4), turned(-2.4)});
  EXPECT_EQ(check(), "1 3 7");
  const auto set = flown.ask("SET_POWER_LIMIT", {10, 10'000});
  flown.cycle(3);
  ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  EXPECT_THAT(check(), StartsWith("1 3 8:8007"));
}

TEST_F(RobotArmAbort, PathThatIsCheckedKeepsNobodyIn) {
  store({turned(0.8), turned(-0.6)});
  operate();
  for (const char* function : {"MOVE_ABORT", "RETREAT"}) {
    const auto checked = flown.rig.call("CHECK_ABORT");
    flown.cycle(5);
    ASSERT_EQ(flown.rig.outcome(checked), "1 3") << "70 looks and more";
    const auto out = flown.ask(function, {0.5});
    flown.finish(out);
    EXPECT_EQ(flown.rig.outcome(checked), aborted) << function;
    EXPECT_THAT(flown.rig.outcome(out), ::testing::EndsWith(" 7")) << function;
  }
}

TEST_F(RobotArmAbort, TellsHalfWayOnceThoughItHasMorePowerThanItBeganWith) {
  store({turned(0.1), turned(2)});
  operate();
  const auto set_power = [&](double limit_w) {
    const auto set = flown.ask("SET_POWER_LIMIT", {limit_w, 10'000});
    flown.cycle(3);
    ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  };
  ASSERT_NO_FATAL_FAILURE(set_power(10));
  const auto out = flown.ask("MOVE_ABORT", {1});
  flown.cycle(300);
  ASSERT_LT(flown.off(start), 0.09) << "on its way to the first of them";
  ASSERT_NO_FATAL_FAILURE(set_power(10'000));
  flown.finish(out);
  EXPECT_EQ(flown.rig.outcome(out), done);
}

TEST_F(RobotArmAbort, PathIsCheckedBeforeAnythingMovesAndWhoIsInTheWayIsNamed) {
  store({turned(0.3), turned(0.3, 0.4)});
  EXPECT_EQ(check(), "1 3 7");
  store({start, vector_of(std::array{0.0, 0.0, 2.6, 2.2, 0.0, 0.0})});
  EXPECT_THAT(check(), StartsWith("1 3 8:800a"));
  EXPECT_THAT(check(), HasSubstr(hex_of(" and ")));
  store({start, turned(0.4)});
  keep_out(tool_at(turned(0.4)));
  EXPECT_THAT(check(), HasSubstr(hex_of("a volume to keep out of")));
  operate();
  EXPECT_THAT(check(), StartsWith("1 3 8:800a"));
  EXPECT_EQ(flown.rig.events(1001), 0) << "no motion is done";
  EXPECT_EQ(flown.rig.events(1026), 0) << "nothing was stopped on its way";
  EXPECT_LT(flown.off(start), 1e-3);
}

TEST_F(RobotArmAbort, PathThatIsTooNearIsToldByItsCheckHoweverNearTheArmStands) {
  store({start, turned(0.4)});
  keep_out(tool_at(start));
  EXPECT_THAT(check(), StartsWith("1 3 8:800a")) << "no nearer than where it is is no way out";
  EXPECT_THAT(check(), HasSubstr(hex_of("a volume to keep out of")));
  operate();
  EXPECT_THAT(check(), StartsWith("1 3 8:800a"));
  keep_out({3, 3, 3});
  EXPECT_EQ(check(), "1 3 7");
}

TEST_F(RobotArmAbort, EndsBeforeItMovesWhereNoPostureCanBeReachedAndThePairIsNamed) {
  store({turned(0.8)});
  keep_out(tool_at(turned(0.4)));
  operate();
  const auto request = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(200);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:800a"));
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of("a volume to keep out of")));
  EXPECT_EQ(flown.rig.events(1026), 0) << "it was not stopped on its way";
  EXPECT_LT(flown.off(start), 1e-3);
  const auto next = flown.move_j(turned(-0.3));
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), done);
}

TEST_F(RobotArmAbort, GoesStraightToThePostureBehindWhatStandsInTheMiddleOfItsPath) {
  store({turned(0.8), turned(-0.6)});
  keep_out(tool_at(turned(0.4)));
  operate();
  const auto request = flown.ask("MOVE_ABORT", {1});
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), done);
  EXPECT_LE(flown.off(turned(-0.6)), 1e-3);
}

TEST_F(RobotArmAbort, IsStoppedBeforeAVolumeThatComesIntoItsWay) {
  store({turned(1.2)});
  operate();
  const auto request = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(300);
  keep_out(tool_at(turned(0.9)));
  flown.finish(request);
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr("8:800a"));
  EXPECT_EQ(flown.rig.events(1026), 1);
  flown.cycle(500);
  EXPECT_GT((tool_at(flown.plant.measured().position) - tool_at(turned(0.9))).norm(), 0.05);
}

TEST_F(RobotArmAbort, IsEndedByHoldAndByStopInItsMidst) {
  store({turned(0.4), turned(1.2)});
  operate();
  const auto first = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(600);
  const auto busy = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(busy), StartsWith("1 4:0108")) << "who goes already";
  const auto hold = flown.rig.call("HOLD");
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(hold), "1 3 7");
  EXPECT_THAT(flown.rig.outcome(first), HasSubstr("8:0204"));
  EXPECT_EQ(stands(), "it stands");
  const auto second = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(500);
  const auto stop = flown.rig.call("STOP");
  flown.finish(stop);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  EXPECT_THAT(flown.rig.outcome(second), HasSubstr("8:0204"));
  flown.cycle(5);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  const auto refused = flown.ask("MOVE_ABORT", {0.5});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:8006"));
}

TEST_F(RobotArmAbort, IsSomethingThatADescriptorMayLeaveOut) {
  std::string text = descriptor_for(6, file);
  const auto cut = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.erase(at, text.find(to, at) + to.size() - at);
  };
  cut("<StructRef name=\"ABORT_PATH\"", R"(minimum="1" maximum="30" writable="PreOperational SafeOperational"/>)");
  cut("<Function name=\"MOVE_ABORT\"", "</Function>");
  cut("<Function name=\"CHECK_ABORT\"", "</Function>");
  Flown other{robot_arm::testing::model_of(file), text};
  other.plant.place(start);
  other.operate();
  const auto motion = other.move_j(goal);
  other.finish(motion);
  EXPECT_EQ(other.rig.outcome(motion), done);
}

}  // namespace
}  // namespace hirosco
