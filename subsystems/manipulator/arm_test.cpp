// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/manipulator/manipulator.hpp"
#include "subsystems/manipulator/testing/free_arm.hpp"

/// One class, arms with 1, 2, 6, 7 and 16 joints: what differs between them is
/// their descriptor.
namespace hirosco {
namespace {

using manipulator::testing::described_arm;
using ::testing::Each;
using ::testing::HasSubstr;

struct ArmTest : ::testing::TestWithParam<std::size_t>, manipulator::testing::FreeArm {
  ArmTest() : FreeArm{make_arm(), GetParam()} {}
};

TEST_P(ArmTest, HoldsItsPositionWhereverItStandsAndComesBackToIt) {
  position_rad[n - 1] -= 0.3;
  const auto where = position_rad;
  operate();
  cycle(200);
  expect_at(where, 1e-6);
  for (std::size_t i = 0; i < n; ++i) {
    position_rad[i] += 0.01;
    cycle(2000);
    expect_at(where, 1e-4);
  }
}

TEST_P(ArmTest, MovesAllJointsInStepAndIsDoneWhenAllAreMeasuredAtTheGoal) {
  operate();
  const auto from = position_rad, goal = elsewhere();
  path.clear();
  const auto request = move_to(goal, 2.0);
  cycle(2010);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001");
  cycle(2200);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 7");
  EXPECT_EQ(rig.events(1001), 1);
  expect_at(goal, 0.005);
  for (const auto& at : path) {
    const double share = (at[0] - from[0]) / (goal[0] - from[0]);
    for (std::size_t i = 1; i < n; ++i)
      ASSERT_NEAR((at[i] - from[i]) / (goal[i] - from[i]), share, 0.02) << "joint " << i + 1;
  }
}

TEST_P(ArmTest, RefusesWhatItsLongestWayIsTooFarForAndWhatOneJointCannotReach) {
  operate();
  auto goal = position_rad;
  goal[n - 1] -= 1.0;
  auto request = move_to(goal, 1.8);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 4:8002") << "1 rad takes 1.875 s at 1 rad/s";
  request = move_to(goal, 1.9);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 3");
}

TEST_P(ArmTest, GoesHomeToTheInitialValueOfItsDescriptor) {
  const auto home = position_rad;
  for (double& position : position_rad) position -= 0.2;
  operate();
  const auto request = rig.call("HOME");
  cycle(6200);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 7");
  expect_at(home, 0.005);
}

TEST_P(ArmTest, LimitsTheTorqueOfEachJoint) {
  operate();
  for (std::size_t loaded = 0; loaded < n; ++loaded) {
    rig.forget_telemetry();
    load_n_m[loaded] = 13;
    cycle(6);
    EXPECT_EQ(rig.inhibited(), inhibited_by_author) << "joint " << loaded + 1;
    EXPECT_EQ(mode, DeviceMode::Off);
    EXPECT_THAT(commanded_n_m, Each(0.0));
    const auto told = std::ranges::find(rig.raised, 1020, &testing::Raised::id);
    ASSERT_NE(told, rig.raised.end());
    EXPECT_EQ(std::to_integer<std::size_t>(told->auxiliary[0]), loaded + 1);
    load_n_m[loaded] = 0;
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
  }
  EXPECT_LE(largest_n_m, 60);
}

TEST_P(ArmTest, StopsWhenItIsToldToAndWhenItLeavesOperational) {
  operate();
  const auto first = move_to(elsewhere(), 2.0);
  cycle(1000);
  const auto stop = rig.call("HOLD");
  cycle(3);
  EXPECT_EQ(rig.outcome(stop), "1 3 7");
  EXPECT_EQ(rig.outcome(first), "1 3 8:0204");
  cycle(1000);
  const auto where = position_rad;
  cycle(1000);
  expect_at(where, 1e-4);
  const auto second = move_to(elsewhere(), 2.0);
  cycle(1000);
  command(State::SafeOperational);
  EXPECT_EQ(rig.outcome(second), "1 3 8:0204");
  EXPECT_EQ(mode, DeviceMode::Off);
  EXPECT_THAT(commanded_n_m, Each(0.0));
}

TEST_P(ArmTest, FollowsAHandleWithAsManyAxesFromWhereItStands) {
  operate(2);
  const auto from = position_rad;
  cycle(200);
  expect_at(from, 1e-6);
  auto goal = from;
  for (std::size_t axis = 0; axis < n; ++axis) {
    handle_rad[axis] = 0.05;
    goal[axis] += 0.05;
    cycle(1000);
    expect_at(goal, 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Joints, ArmTest, ::testing::Values(1, 2, 6, 7, 16));

TEST(ArmDescriptor, WhoseArraysDifferInLengthIsRefusedByName) {
  std::string text = described_arm(6);
  const std::string handle = R"(<ParamRef name="HANDLE" id="111" type="DOUBLE" count="6")";
  text.replace(text.find(handle), handle.size(), R"(<ParamRef name="HANDLE" id="111" type="DOUBLE" count="5")");
  const auto arm = make_arm();
  testing::Rig rig{*arm, text};
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
  EXPECT_THAT(rig.configure_now(1), ::testing::StartsWith("1 3 8:"));
  EXPECT_THAT(rig.explanations, ::testing::Contains(HasSubstr("CLUTCH.HANDLE has another length than DES_POSITION")));
}

TEST(ArmDescriptor, WithMoreJointsThanAnArmCanHaveIsRefusedByName) {
  std::string text = described_arm(16);
  const std::string velocity = R"(name="DES_VELOCITY" id="2" type="DOUBLE" count=")";
  text.replace(text.find(velocity), velocity.size() + 2, velocity + "17");
  const auto arm = make_arm();
  testing::Rig rig{*arm, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_THAT(rig.explanations,
              ::testing::Contains(HasSubstr("DES_VELOCITY: the C++ type is Sized<double, 16>, the "
                                            "descriptor declares DOUBLE[17], which are more than 16")));
}

TEST(ArmDescriptor, WhoseMoveToNamesAnotherNumberOfJointsIsRefused) {
  std::string text = described_arm(6);
  const auto begin = text.find("      <Argument name=\"Q6\"");
  text.erase(begin, text.find('\n', begin) + 1 - begin);
  const auto arm = make_arm();
  testing::Rig rig{*arm, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_THAT(rig.explanations, ::testing::Contains(HasSubstr("MOVE_TO takes a number for each element")));
}

} // namespace
} // namespace hirosco
