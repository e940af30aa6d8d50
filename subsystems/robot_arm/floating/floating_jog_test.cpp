// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/floating/tool_law.hpp"
#include "subsystems/robot_arm/testing/floating.hpp"

/// A floating arm that is jogged, in JOINTS, and what is at its tip (docs/adr/0222). In laws that track it is flown in missions/servicer/tests.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using ::testing::StartsWith;

struct FloatingArmJogs : robot_arm::testing::FloatingWay {
  static constexpr std::uint16_t motion_done = 2101;
  const std::string done = "1 3 7", busy = "1 4:0108";

  hirosco::testing::Sent ask(const char* function, std::initializer_list<double> numbers) {
    const auto request = flown.rig.call(function, numbers);
    flown.cycle(3);
    return request;
  }
  std::string asked(const char* function, std::initializer_list<double> numbers) {
    const auto request = ask(function, numbers);
    flown.finish(request);
    return flown.rig.outcome(request);
  }
  /// The first joint.
  hirosco::testing::Sent turn(double rad_s, double span_s) { return ask("JOG_J", {rad_s, 0, 0, 0, 0, 0, 0, span_s}); }
  [[nodiscard]] robotics::Pose tip_pose() const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = flown.plant.measured().position, .qd = JointVector::Zero(7)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value());
  }
  [[nodiscard]] double speed() const { return flown.plant.measured().velocity[0]; }
};

/// As far as its velocity by its time: what it is slower by in the beginning it goes on at the end.
TEST_F(FloatingArmJogs, MovesAJointForItsTimeAndStands) {
  begin(ready);
  const auto request = turn(0.1, 1);
  flown.cycle(700);
  EXPECT_EQ(flown.rig.outcome(request), "1 3");
  EXPECT_NEAR(speed(), 0.1, 0.01);
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), done);
  flown.cycle(1000);
  EXPECT_LT(flown.off(turned(0.1)), 2e-3);
  EXPECT_LT(std::abs(speed()), 1e-4);
  EXPECT_LT(flown.fastest, 0.115);
  EXPECT_EQ(flown.rig.events(motion_done), 1);
}

TEST_F(FloatingArmJogs, GoesOnWhileItIsSaidAgainAndCompletesTheOneBefore) {
  begin(ready);
  auto last = turn(0.1, 0.5);
  flown.cycle(450);
  double slowest = HUGE_VAL;
  for (int again = 0; again < 5; ++again) {
    const auto next = turn(0.1, 0.5);
    EXPECT_EQ(flown.rig.outcome(last), done) << again;
    EXPECT_EQ(flown.rig.outcome(next), "1 3") << again;
    for (int i = 0; i < 400; ++i) flown.cycle(), slowest = std::min(slowest, again == 0 ? HUGE_VAL : speed());
    last = next;
  }
  EXPECT_GT(slowest, 0.095);
  EXPECT_EQ(flown.rig.events(motion_done), 0) << "it has not stood";
  flown.finish(last);
  EXPECT_EQ(flown.rig.outcome(last), done);
  EXPECT_EQ(flown.rig.events(motion_done), 1);
}

TEST_F(FloatingArmJogs, IsNoWayForAnythingElseUntilHold) {
  begin(ready);
  const auto jog = turn(0.1, 1);
  flown.cycle(300);
  EXPECT_EQ(flown.rig.outcome(move_tool(0.02, 0, 0, 2)).substr(0, busy.size()), busy);
  EXPECT_EQ(flown.rig.outcome(ask("JOG_L", {0, 0.02, 0, 0, 0, 0, 0.5})).substr(0, busy.size()), busy);
  EXPECT_EQ(flown.rig.outcome(ask("SET_PAYLOAD", {5, 0, 0, 0})).substr(0, busy.size()), busy);
  EXPECT_EQ(asked("HOLD", {}), done);
  EXPECT_THAT(flown.rig.outcome(jog), StartsWith("1 3 8:0204"));
  flown.cycle(700);
  EXPECT_LT(std::abs(speed()), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmJogs, StaysWithinTheRangeOfAJoint) {
  begin(turned(2.7));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(asked("JOG_J", {0.2, 0, 0, 0, 0, 0, 0, 1}), done);
  flown.cycle(500);
  EXPECT_NEAR(flown.plant.measured().position[0], 2.9, 2e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  EXPECT_EQ(asked("JOG_J", {-0.1, 0, 0, 0, 0, 0, 0, 1}), done) << "and comes back";
  EXPECT_LT(flown.plant.measured().position[0], 2.85);
}

TEST_F(FloatingArmJogs, IsStoppedBeforeAVolumeAndMayGoAway) {
  begin(ready);
  keep_out(tool_at(turned(0.4)));
  std::string met = done;
  for (int i = 0; i < 8 && met == done; ++i) met = asked("JOG_J", {0.2, 0, 0, 0, 0, 0, 0, 0.5});
  EXPECT_THAT(met, StartsWith("1 3 8:8009"));
  EXPECT_EQ(flown.rig.events(too_near_event), 1);
  flown.cycle(1400);
  EXPECT_LT(std::abs(speed()), 1e-3);
  EXPECT_EQ(asked("JOG_J", {-0.2, 0, 0, 0, 0, 0, 0, 0.5}), done);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmJogs, MovesItsToolAndTurnsItAsItIsTold) {
  begin(ready);
  const robotics::Pose from = tip_pose();
  EXPECT_EQ(asked("JOG_L", {0, 0.03, 0, 0, 0, 0, 1}), done);
  flown.cycle(500);
  EXPECT_LT((tip_pose().position - from.position - robotics::Vector3{0, 0.03, 0}).norm(), 3e-3);
  EXPECT_LT(robot_arm::rotation_between(tip_pose().rotation, from.rotation).norm(), 5e-3);
  const robotics::Pose then = tip_pose();
  EXPECT_EQ(asked("JOG_L", {0, 0, 0, 0, 0, 0.05, 1}), done);
  flown.cycle(500);
  const robotics::Vector3 by = robot_arm::rotation_between(then.rotation, tip_pose().rotation);
  EXPECT_LT((by - robotics::Vector3{0, 0, 0.05}).norm(), 6e-3);
  EXPECT_LT((tip_pose().position - then.position).norm(), 3e-3);
}

TEST_F(FloatingArmJogs, IsNoFasterThanToolsMayBe) {
  begin(ready);
  const auto refused = ask("JOG_L", {0.04, 0.04, 0, 0, 0, 0, 0.5});
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:8004"));
  flown.cycle(200);
  EXPECT_LT(flown.fastest, 1e-6);
}

/// Somebody holds it: its goal waits, and does not run away to be gone to when it is let go.
struct HeldFloating : robot_arm::testing::FlownFloating {
  double torque_n_m{0};
  std::vector<double> play(std::span<const double> torques) override {
    torque_n_m = robot_arm::vector_of(torques).norm();
    return FlownFloating::play(std::vector<double>(torques.size(), 0.0));
  }
};

TEST_F(FloatingArmJogs, ItsGoalWaitsForAToolThatCannotGo) {
  HeldFloating held;
  held.plant.place(ready);
  held.operate();
  double most = 0;
  for (int i = 0; i < 3000; ++i) {
    if (i % 500 == 0) static_cast<void>(held.rig.call("JOG_L", {0, 0.02, 0, 0, 0, 0, 1}));
    held.cycle();
    most = std::max(most, held.torque_n_m);
  }
  EXPECT_GT(most, 1);
  EXPECT_LT(held.torque_n_m, 0.6 * most) << "10 mm of it are left, which are gone in a second";
  EXPECT_EQ(held.rig.inhibited(), 0u);
}

struct FloatingArmTip : FloatingArmJogs {};

/// 0.3 m before the tip is a ball of 5 cm.
TEST_F(FloatingArmTip, IsKeptClearWithItsTool) {
  begin(ready);
  const robotics::Vector3 along = tip_pose().rotation.col(2);
  keep_out(tool() + 0.3 * along);
  const double without = flown.told_number("CLEARANCE");
  EXPECT_EQ(asked("SET_TOOL", {0, 0, 0.22, 0, 0, 0, 0}), done);
  EXPECT_GT(without, 0.04);
  EXPECT_NEAR(flown.told_number("CLEARANCE"), 0.03, 1e-3);
  expect_refused(move_tool(0.02 * along[0], 0.02 * along[1], 0.02 * along[2], 2), "and a volume to keep out of");
  EXPECT_EQ(asked("SET_TOOL", {0, 0, 0, 0, 0, 0, 0}), done);
  EXPECT_NEAR(flown.told_number("CLEARANCE"), without, 1e-5);
}

/// What is turned is turned about the tool.
TEST_F(FloatingArmTip, IsTurnedAboutItsTool) {
  begin(ready);
  EXPECT_EQ(asked("SET_TOOL", {0, 0, 0.4, 0, 0, 0, 0}), done);
  const auto tool_place = [&] { return tip_pose() * robotics::Vector3{0, 0, 0.4}; };
  const robotics::Pose from = tip_pose();
  const robotics::Vector3 place = tool_place(), about = 0.05 * from.rotation.col(0);
  EXPECT_EQ(asked("JOG_L", {0, 0, 0, about[0], about[1], about[2], 1}), done);
  flown.cycle(500);
  EXPECT_LT((tool_place() - place).norm(), 4e-3);
  EXPECT_GT((tip_pose().position - from.position).norm(), 0.015) << "0.05 rad at 0.4 m";
}

TEST_F(FloatingArmTip, HasAToolOfSomeOrientationAndNoneWhileItMoves) {
  begin(ready);
  EXPECT_THAT(flown.rig.outcome(ask("SET_TOOL", {0, 0, 0.1, 0.1, 0, 0, 0})), StartsWith("1 4:800a"));
  EXPECT_EQ(asked("SET_TOOL", {0, 0, 0.1, 0.707, 0, 0, 0.707}), done);
  const auto motion = move_tool(0.02, 0, 0, 3);
  flown.cycle(200);
  EXPECT_THAT(flown.rig.outcome(ask("SET_TOOL", {0, 0, 0, 0, 0, 0, 0})), StartsWith(busy));
  EXPECT_THAT(flown.rig.outcome(ask("SET_PAYLOAD", {1, 0, 0, 0})), StartsWith(busy));
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), done);
}

/// Nothing is moved by what is said, whatever it weighs: nothing hangs in orbit.
TEST_F(FloatingArmTip, StandsWhenAPayloadIsSaidAndWhenItIsTakenBack) {
  begin(ready);
  flown.cycle(500);
  const JointVector before = flown.plant.measured().position;
  for (const double mass_kg : {20.0, 50.0, 0.0}) {
    EXPECT_EQ(asked("SET_PAYLOAD", {mass_kg, 0, 0, 0.2}), done) << mass_kg;
    flown.cycle(1000);
    EXPECT_LT(flown.off(before), 1e-4) << mass_kg;
  }
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Said to be there and not there: answers that are that much too hard would shake the arm until it is stopped.
TEST_F(FloatingArmTip, MovesWithoutShakingThoughAPayloadIsNotThere) {
  begin(ready);
  EXPECT_EQ(asked("SET_PAYLOAD", {20, 0, 0, 0.3}), done);
  const auto motion = move_tool(0.05, 0, 0, 4);
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), done);
  EXPECT_LT(flown.fastest, 0.1);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmTip, AndJogsAreSomethingThatADescriptorMayLeaveOut) {
  std::string text = robot_arm::testing::floating_descriptor();
  const auto cut = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.erase(at, text.find(to, at) + to.size() - at);
  };
  for (const char* name : {"TOOL_PLACE", "PAYLOAD"})
    cut(std::string{"<StructRef name=\""} + name + "\"", "</StructRef>");
  cut("<ParamRef name=\"TOOL_RADIUS\"", "/>");
  for (const char* function : {"JOG_J", "JOG_L", "SET_TOOL", "SET_PAYLOAD"})
    cut(std::string{"<Function name=\""} + function, "</Function>");
  robot_arm::testing::FlownFloating other{text};
  other.plant.place(ready);
  other.operate();
  const auto motion = other.rig.call("MOVE_TOOL", {0.02, 0, 0, 2});
  other.finish(motion);
  EXPECT_EQ(other.rig.outcome(motion), "1 3 7");
}

}  // namespace
}  // namespace hirosco
