// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/free_plant.hpp"

/// A floating arm that springs hold, or torques drive, in JOINTS (docs/adr/0235). In laws that track it is flown in missions/servicer/tests.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using ::testing::AnyOf;
using ::testing::StartsWith;

struct FloatingArmIsSoft : robot_arm::testing::FreeArm {
  static constexpr std::uint16_t contact_event = 2113, too_near_event = 2111, motion_done = 2101;
  const JointVector stiffness = vector_of(std::array{400.0, 400.0, 400.0, 400.0, 20.0, 20.0, 2.0});

  std::string soften_joints(double times = 1) {
    const JointVector k = times * stiffness;
    return asked("IMPEDANCE_J", {k[0], k[1], k[2], k[3], k[4], k[5], k[6], 0.9});
  }
  void begin_untouched() {
    begin();
    ASSERT_NO_FATAL_FAILURE(react_by(0));
  }
  [[nodiscard]] robotics::Vector3 tool() const { return now().tool().position; }
};

TEST_F(FloatingArmIsSoft, AtItsJointsAndComesBackWhereItWas) {
  ASSERT_NO_FATAL_FAILURE(begin_untouched());
  ASSERT_EQ(soften_joints(), done);
  flown.plant.push_n = {4, -3, 2};
  flown.cycle(3000);
  const robotics::Vector3 pushed = flown.plant.base().rotation.transpose() * flown.plant.push_n;
  const JointVector expected = (now().tool_of_free().bottomRows<3>().transpose() * pushed).cwiseQuotient(stiffness);
  const JointVector way = flown.plant.measured().position - ready;
  EXPECT_GT(expected.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT((way - expected).cwiseAbs().maxCoeff(), 0.15 * expected.cwiseAbs().maxCoeff());
  flown.plant.push_n.setZero();
  flown.cycle(5000);
  EXPECT_LT(flown.off(ready), 5e-3) << "of a craft that turns on by what it was pushed";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Who holds it hard gives way by a tenth of that and less.
TEST_F(FloatingArmIsSoft, AtItsToolAndHardAgainWhereItIsThen) {
  ASSERT_NO_FATAL_FAILURE(begin_untouched());
  ASSERT_EQ(asked("IMPEDANCE_L", {200, 20, 0.9}), done);
  const robotics::Vector3 from = tool();
  flown.plant.push_n = {0, 4, 0};
  flown.cycle(3000);
  const robotics::Vector3 there = tool();
  EXPECT_GT((there - from).norm(), 0.01);
  EXPECT_LT((there - from).norm(), 0.04);
  ASSERT_EQ(asked("POSITION_CONTROL"), done);
  flown.plant.push_n.setZero();
  flown.cycle(2000);
  EXPECT_LT((tool() - there).norm(), 0.2 * (there - from).norm());
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Whoever pushes meanwhile holds against some newton metres, which are put out before and after.
TEST_F(FloatingArmIsSoft, OrHardOrFloatsWithoutAStepInTorqueWhoeverPushes) {
  ASSERT_NO_FATAL_FAILURE(begin_untouched());
  flown.plant.push_n = {4, -3, 2};
  flown.cycle(2000);
  const auto without_a_step = [&](const char* function, std::initializer_list<double> numbers) {
    flown.steepest = 0;
    const auto request = flown.rig.call(function, numbers);
    flown.cycle(100);
    EXPECT_EQ(flown.rig.outcome(request).substr(0, 3), done.substr(0, 3)) << function;
    EXPECT_LT(flown.steepest, 0.5) << function;
    EXPECT_GT(flown.commanded.cwiseAbs().maxCoeff(), 0.5) << function << ": else a step would not have been seen";
    flown.cycle(1000);
  };
  without_a_step("IMPEDANCE_J", {300, 300, 300, 300, 20, 20, 2, 0.9});
  without_a_step("IMPEDANCE_J", {100, 100, 100, 100, 5, 5, 1, 0.9});
  without_a_step("IMPEDANCE_L", {300, 20, 0.9});
  without_a_step("POSITION_CONTROL", {});
  without_a_step("IMPEDANCE_L", {300, 20, 0.9});
  without_a_step("HOLD", {});
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmIsSoft, AndMovesWhileSpringsHoldIt) {
  begin();
  ASSERT_EQ(asked("IMPEDANCE_L", {500, 20, 0.9}), done);
  robotics::Vector3 goal = tool();
  goal.z() += 0.05;
  EXPECT_EQ(asked("MOVE_TOOL", {0, 0, 0.05, 4}), done);
  flown.cycle(3000);
  EXPECT_LT((tool() - goal).norm(), 2e-3);
  EXPECT_EQ(asked("JOG_L", {0, 0.05, 0, 0, 0, 0, 0.5}), done);
  flown.cycle(3000);
  goal.y() += 0.025;
  EXPECT_LT((tool() - goal).norm(), 3e-3);
  EXPECT_THAT(asked("JOG_J", {0.1, 0, 0, 0, 0, 0, 0, 0.5}), StartsWith("1 4:8010")) << "springs hold the tool";
  ASSERT_EQ(soften_joints(), done);
  const JointVector here = flown.plant.measured().position;
  EXPECT_THAT(asked("MOVE_TOOL", {0, 0, 0.05, 4}), StartsWith("1 4:8010")) << "springs hold joints";
  EXPECT_EQ(asked("MOVE_JOINT", {here[0] + 0.1, here[1], here[2], here[3], here[4], here[5], here[6], 4}), done);
  flown.cycle(3000);
  EXPECT_NEAR(flown.plant.measured().position[0], here[0] + 0.1, 2e-3);
  EXPECT_THAT(asked("SET_PAYLOAD", {1, 0, 0, 0}), StartsWith("1 4:8010"));
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmIsSoft, AndComesToRestByHoldAndIsSoftThere) {
  begin();
  ASSERT_EQ(asked("IMPEDANCE_L", {300, 20, 0.9}), done);
  const auto motion = ask("MOVE_TOOL", {0, 0, 0.1, 6});
  flown.cycle(3000);
  EXPECT_EQ(asked("HOLD"), done);
  EXPECT_THAT(flown.rig.outcome(motion), StartsWith("1 3 8:0204"));
  flown.cycle(1000);
  const robotics::Vector3 there = tool();
  ASSERT_NO_FATAL_FAILURE(react_by(0));
  flown.plant.push_n = {0, 4, 0};
  flown.cycle(2000);
  EXPECT_GT((tool() - there).norm(), 5e-3) << "it gives way yet";
  flown.plant.push_n.setZero();
  flown.cycle(4000);
  EXPECT_LT((tool() - there).norm(), 3e-3);
}

TEST_F(FloatingArmIsSoft, NoStifferThanItsLawMaySwing) {
  begin();
  EXPECT_THAT(asked("IMPEDANCE_J", {400, 400, 400, 400, 400, 400, 400, 0.7}), StartsWith("1 4:800f"));
  EXPECT_THAT(asked("IMPEDANCE_L", {5000, 500, 0.7}), AnyOf(done, StartsWith("1 4:800f")));
  EXPECT_EQ(soften_joints(), done);
}

TEST_F(FloatingArmIsSoft, AndHardBehindEachEntryIntoOperational) {
  begin();
  ASSERT_EQ(asked("IMPEDANCE_L", {50, 5, 0.9}), done);
  flown.command(State::SafeOperational);
  flown.command(State::Operational);
  ASSERT_NO_FATAL_FAILURE(react_by(0));
  const robotics::Vector3 there = tool();
  flown.plant.push_n = {0, 4, 0};
  flown.cycle(1000);
  EXPECT_LT((tool() - there).norm(), 0.02) << "4 N on 50 N/m would be more";
}

struct FloatingArmIsDriven : FloatingArmIsSoft {
  std::string driven(std::initializer_list<double> numbers) { return asked("TORQUE_J", numbers); }
};

TEST_F(FloatingArmIsDriven, ByATorqueForItsTimeAndStands) {
  begin();
  const auto drive = ask("TORQUE_J", {4, 0, 0, 0, 0, 0, 0, 0.5});
  flown.cycle(300);
  EXPECT_EQ(flown.rig.outcome(drive), "1 3");
  EXPECT_NEAR(flown.plant.measured().velocity[0], 0.06, 0.01)
      << "which nobody meets: a velocity in a second, 0.2 rad/s2";
  EXPECT_GT(flown.commanded[0], 0.3);
  EXPECT_LT(flown.commanded[0], 4);
  flown.finish(drive);
  EXPECT_EQ(flown.rig.outcome(drive), done) << "it stands behind it";
  EXPECT_EQ(flown.rig.events(motion_done), 1);
  const JointVector there = flown.plant.measured().position;
  flown.cycle(1000);
  EXPECT_LT(speed(), 1e-3);
  EXPECT_LT(flown.off(there), 2e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmIsDriven, OnWhileItIsSaidAgainAndNoFasterThanItMay) {
  begin();
  auto last = ask("TORQUE_J", {60, 0, 0, 0, 0, 0, 0, 0.5});
  for (int again = 0; again < 12; ++again) {
    flown.cycle(400);
    const auto next = ask("TORQUE_J", {60, 0, 0, 0, 0, 0, 0, 0.5});
    EXPECT_EQ(flown.rig.outcome(last), done) << again;
    last = next;
  }
  EXPECT_GT(flown.plant.measured().velocity[0], 0.15);
  EXPECT_LT(flown.fastest, 0.19) << "of 0.2 rad/s";
  EXPECT_EQ(flown.rig.events(motion_done), 0) << "it has not stood";
  EXPECT_EQ(asked("HOLD"), done);
  EXPECT_THAT(flown.rig.outcome(last), StartsWith("1 3 8:0204"));
  flown.cycle(1000);
  EXPECT_LT(speed(), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmIsDriven, NeverIntoTheEndOfARange) {
  flown.plant.place(ready + vector_of(std::array{2.6, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
  flown.operate();
  double farthest = 0;
  for (int again = 0; again < 12; ++again) {
    ask("TORQUE_J", {30, 0, 0, 0, 0, 0, 0, 1});
    for (int i = 0; i < 700; ++i) flown.cycle(), farthest = std::max(farthest, flown.plant.measured().position[0]);
  }
  EXPECT_GT(farthest, 2.8);
  EXPECT_LT(farthest, 2.9);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmIsDriven, NoHarderThanATorqueThatWouldStopIt) {
  begin();
  EXPECT_THAT(driven({0, 65, 0, 0, 0, 0, 0, 0.5}), StartsWith("1 4:800e")) << "LOAD_ABOVE_LIMIT: 0.8 of 80 N m";
  EXPECT_THAT(asked("TORQUE_J", {0, 0, 0, 0, 0, 0, 0, 0.1}), done);
}

TEST_F(FloatingArmIsDriven, AndStandsWhereItMeetsSomebody) {
  begin();
  const auto drive = ask("TORQUE_J", {4, 0, 0, 0, 0, 0, 0, 1});
  flown.cycle(300);
  flown.plant.push_n = {-32, 0, 0};
  for (int i = 0; i < 200 && flown.rig.events(contact_event) == 0; ++i) flown.cycle();
  flown.cycle(20);
  flown.plant.push_n.setZero();
  EXPECT_THAT(flown.rig.outcome(drive), StartsWith("1 3 8:800c"));
  flown.cycle(1500);
  EXPECT_LT(speed(), 5e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Springs hold it again where torques have left it.
TEST_F(FloatingArmIsDriven, AndIsAsSoftBehindThatAsBefore) {
  begin();
  ASSERT_EQ(soften_joints(), done);
  EXPECT_EQ(driven({4, 0, 0, 0, 0, 0, 0, 0.5}), done);
  const JointVector there = flown.plant.measured().position;
  EXPECT_GT(there[0], ready[0] + 0.002);
  ASSERT_NO_FATAL_FAILURE(react_by(0));
  flown.plant.push_n = {0, 4, 0};
  flown.cycle(2000);
  EXPECT_GT(flown.off(there), 5e-3);
  flown.plant.push_n.setZero();
  flown.cycle(5000);
  EXPECT_LT(flown.off(there), 3e-3);
}

TEST_F(FloatingArmIsDriven, NorSoftNorLimitedInADescriptorThatLeavesThatOut) {
  std::string text = robot_arm::testing::floating_descriptor();
  const auto cut = [&](const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.erase(at, text.find(to, at) + to.size() - at);
  };
  for (const char* name :
       {"IMPEDANCE_J", "IMPEDANCE_L", "POSITION_CONTROL", "TORQUE_J", "SET_FORCE_LIMIT", "SET_POWER_LIMIT"})
    cut(std::string{"<Function name=\""} + name, "</Function>");
  for (const char* name : {"\"TOOL_FORCE\"", "\"JOINT_POWER\"", "\"TOOL_POWER\"", "\"TOOL_FORCE_LIMIT\"",
                           "\"POWER_LIMIT\"", "\"TOOL_POWER_LIMIT\"", "\"JOINT_STIFFNESS\"", "\"DES_TORQUE\""})
    cut(std::string{"<ParamRef name="} + name, "/>");
  cut("<StructRef name=\"LAW\"", "</StructRef>");
  cut("<Enumeration name=\"LAWS\"", "</Enumeration>");
  for (const char* name : {"TOOL_FORCE_EXCEEDED", "POWER_LIMIT_EXCEEDED", "TOOL_POWER_EXCEEDED"})
    cut(std::string{"<Event name=\""} + name, "</Event>");
  robot_arm::testing::FlownFloating other{text};
  other.plant.place(ready);
  other.operate();
  const auto motion = other.rig.call("MOVE_TOOL", {0.02, 0, 0, 2});
  other.finish(motion);
  EXPECT_EQ(other.rig.outcome(motion), done);
}

}  // namespace
}  // namespace hirosco
