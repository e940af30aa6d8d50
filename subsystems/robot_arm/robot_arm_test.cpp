// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "hirosco/subsystem/testing/tried_functions.hpp"
#include "subsystems/robot_arm/testing/ball.hpp"
#include "subsystems/robot_arm/testing/flown.hpp"

/// One class, robots with 1, 3, 6 and 16 joints: what differs between them is their URDF file and their descriptor.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::chain;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::file_with;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::replace_all;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct ArmOf : ::testing::TestWithParam<std::size_t> {
  std::size_t n = GetParam();
  Flown flown{
      n, n == 6 ? std::string{folder} + "robot_arm.urdf" : file_with("chain" + std::to_string(n) + ".urdf", chain(n)),
      1.1};
  JointVector start = 0.1 * JointVector::Ones(static_cast<Eigen::Index>(n));
  JointVector goal = JointVector::Constant(static_cast<Eigen::Index>(n), n > 6 ? 0.3 : 0.9);
  void SetUp() override { flown.plant.place(start); }
};

TEST_P(ArmOf, HoldsItsPlaceAndReachesEachGoalWithinAMilliradianThoughItIsATenthHeavier) {
  flown.operate();
  flown.cycle(500);
  EXPECT_LT(flown.off(start), 1e-3);
  for (const JointVector& where : {goal, start}) {
    const auto request = flown.move_j(where);
    flown.finish(request);
    EXPECT_EQ(flown.rig.outcome(request), "1 3 5:0001 7");
    EXPECT_LE(flown.off(where), 1e-3);
  }
  EXPECT_EQ(flown.rig.events(1001), 2);
  EXPECT_LE(flown.largest_share, 1);
}

INSTANTIATE_TEST_SUITE_P(Joints, ArmOf, ::testing::Values(1, 3, 6, 16));

struct RobotArmTest : ::testing::Test {
  Flown flown{6, std::string{folder} + "robot_arm.urdf"};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  void SetUp() override { flown.plant.place(start); }
};

TEST_F(RobotArmTest, MovesNothingBeforeItIsOperational) {
  flown.rig.bring_to(State::PreOperational, 1);
  flown.cycle(5);
  flown.command(State::SafeOperational);
  flown.cycle(20);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  EXPECT_THAT(flown.commanded, Each(0.0));
}

TEST_F(RobotArmTest, RefusesAGoalBeyondTheRangeOfOneJointOfTheFile) {
  flown.operate();
  for (Eigen::Index i = 0; i < 6; ++i)
    for (const double side : {1.0, -1.0}) {
      const auto& limits = flown.model.joints()[static_cast<std::size_t>(i)].limits;
      JointVector beyond = start;
      beyond[i] = side > 0 ? *limits.upper + 0.01 : *limits.lower - 0.01;
      const auto request = flown.move_j(beyond);
      flown.cycle(3);
      EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 4:")) << i << " " << side;
    }
  flown.cycle(100);
  EXPECT_LT(flown.off(start), 1e-3);
}

TEST_F(RobotArmTest, HoldEndsAMotionOnItsWayAndStaysThere) {
  flown.operate();
  const auto motion = flown.move_j(goal);
  flown.cycle(400);
  const auto hold = flown.rig.call("HOLD");
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(hold), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:0204");
  flown.cycle(1000);
  const JointVector where = flown.plant.measured().position;
  EXPECT_GT(flown.off(goal), 0.1);
  flown.cycle(500);
  EXPECT_LT(flown.off(where), 1e-3);
  const auto next = flown.move_j(start);
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), "1 3 5:0001 7");
}

TEST_F(RobotArmTest, StopLeavesItToItsBrakesUntilItIsBroughtUpAnew) {
  flown.operate();
  const auto motion = flown.move_j(goal);
  flown.cycle(400);
  const auto stop = flown.rig.call("STOP");
  flown.finish(stop);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:0204");
  flown.cycle(5);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  EXPECT_EQ(flown.rig.inhibited(), inhibited_by_author);
  const auto refused = flown.move_j(start);
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:8006"));
  flown.command(State::SafeOperational);
  flown.command(State::Operational);
  const auto next = flown.move_j(start);
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), "1 3 5:0001 7");
}

/// What its sensors tell, and which event that is.
struct Excessive {
  const char* what;
  int event;
  void (*tell)(robot_arm::Measured&);
};
struct RobotArmLimits : RobotArmTest, ::testing::WithParamInterface<Excessive> {};

TEST_P(RobotArmLimits, InhibitTheActuatorsWithTheirNameAndEndTheMotion) {
  flown.operate();
  const auto motion = flown.move_j(goal);
  flown.cycle(100);
  flown.told = flown.plant.measured();
  GetParam().tell(*flown.told);
  flown.cycle(4);
  EXPECT_EQ(flown.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(flown.mode, DeviceMode::Off);
  EXPECT_THAT(flown.commanded, Each(0.0));
  EXPECT_EQ(flown.rig.events(static_cast<std::uint16_t>(GetParam().event)), 1);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:8003");
}

INSTANTIATE_TEST_SUITE_P(Each, RobotArmLimits,
                         ::testing::Values(Excessive{"torque", 1020, [](auto& m) { m.torque[3] = 23; }},
                                           Excessive{"hard torque", 1021, [](auto& m) { m.torque[3] = -27; }},
                                           Excessive{"position", 1022, [](auto& m) { m.position[1] = 2.3; }},
                                           Excessive{"speed", 1023, [](auto& m) { m.velocity[0] = 2.3; }},
                                           Excessive{"following", 1024, [](auto& m) { m.position[5] -= 0.2; }}),
                         [](const auto& each) { return "By" + std::to_string(each.param.event); });

TEST_F(RobotArmTest, StopsWhereSomebodyIsMet) {
  flown.operate();
  const auto motion = flown.move_j(goal, 0.5);
  flown.cycle(500);
  EXPECT_EQ(flown.rig.events(1025), 0);
  flown.outside[0] = 60;
  int cycles = 0;
  while (flown.rig.events(1025) == 0 && cycles < 200) flown.cycle(), ++cycles;
  EXPECT_LT(cycles, 40);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:8004");
  flown.outside[0] = 0;
  flown.cycle(1500);
  const JointVector where = flown.plant.measured().position;
  flown.cycle(500);
  EXPECT_LT(flown.off(where), 1e-3);
  EXPECT_GT(flown.off(goal), 0.1);
}

TEST_F(RobotArmTest, SetsNoTorqueLimitBelowWhatItHolds) {
  flown.operate();
  flown.cycle(100);
  const auto refused = flown.rig.call("SET_TORQUE_LIMIT", {0.1});
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(refused), StartsWith("1 4:8005"));
  const auto taken = flown.rig.call("SET_TORQUE_LIMIT", {0.6});
  flown.cycle(3);
  EXPECT_EQ(flown.rig.outcome(taken), "1 3 7");
}

/// What is set and not said is lost in a crash, and the arm moves again without it: through a volume that it kept out of.
TEST_F(RobotArmTest, EachFunctionThatChangesAProtectionSaysSoInTheDescriptor) {
  flown.operate();
  const hirosco::testing::TriedFunctions functions{flown.rig,
                                                   [this] {
                                                     flown.plant.place(start);
                                                     flown.command(State::SafeOperational);
                                                     flown.command(State::Operational);
                                                   },
                                                   [this] { flown.cycle(5); }};
  EXPECT_THAT(functions.untold(), ::testing::IsEmpty());
  EXPECT_THAT(functions.idle(), ::testing::IsEmpty());
}

TEST_F(RobotArmTest, GoesStraightWithinTwoMillimetres) {
  flown.operate();
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  const auto tip = flown.model.find_frame("tool").value();
  const auto tool = [&] {
    robotics::State state;
    state.q = flown.plant.measured().position;
    state.qd = flown.plant.measured().velocity;
    dynamics.update(state);
    return dynamics.frame_pose(tip);
  };
  const robotics::Pose from = tool();
  const robotics::Quaternion kept{from.rotation};
  const robotics::Vector3 way{-0.2, 0.15, 0.1};
  const robotics::Vector3 to = from.position + way;
  const auto request = flown.ask("MOVE_L", {to.x(), to.y(), to.z(), kept.w(), kept.x(), kept.y(), kept.z(), 0.25, 0.5});
  double beside_m = 0;
  for (int i = 0; i < 4000; ++i) {
    flown.cycle();
    const robotics::Vector3 gone = tool().position - from.position;
    beside_m = std::max(beside_m, (gone - gone.dot(way) / way.squaredNorm() * way).norm());
  }
  EXPECT_EQ(flown.rig.outcome(request), "1 3 5:0001 7");
  EXPECT_LE(beside_m, 0.002);
  EXPECT_LE((tool().position - to).norm(), 0.001);
}

/// Every joint within a milliradian, and the tool of an arm of a metre farther than a millimetre off: that is not the end of its way.
struct RobotArmArrival : RobotArmTest {
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  const std::string done = "1 3 5:0001 7";

  [[nodiscard]] robotics::Pose tool(const JointVector& joints) {
    dynamics.update({.q = joints, .qd = JointVector::Zero(start.size())});
    return dynamics.frame_pose(flown.model.find_frame("tool").value());
  }
  /// `asks` in another flight, too, which is told otherwise just before it would be done.
  void is_done_with_its_tool(const std::function<hirosco::testing::Sent(Flown&)>& asks) {
    const auto asked = [&](Flown& arm) {
      arm.plant.place(start);
      arm.operate();
      return asks(arm);
    };
    const auto request = asked(flown);
    int cycles = 0;
    for (; cycles < 6000 && flown.rig.outcome(request) != done; ++cycles) flown.cycle();
    ASSERT_LT(cycles, 6000);
    flown.cycle(2000);
    const JointVector there = flown.plant.measured().position;
    JointVector nearly = there;
    for (const int joint : {1, 2, 3}) nearly[joint] -= 9.5e-4;
    ASSERT_GT((tool(nearly).position - tool(there).position).norm(), 1.1e-3);
    Flown other{6, std::string{folder} + "robot_arm.urdf"};
    const auto again = asked(other);
    constexpr int before = 10;
    other.cycle(cycles - before);
    ASSERT_NE(other.rig.outcome(again), done);
    other.told = other.plant.measured();
    other.told->position = nearly;
    other.cycle(3 * before);
    EXPECT_NE(other.rig.outcome(again), done);
    other.told.reset();
    other.finish(again);
    EXPECT_EQ(other.rig.outcome(again), done);
  }
};

TEST_F(RobotArmArrival, IsDoneWithALineOnceTheToolItselfIsMeasuredThere) {
  is_done_with_its_tool([&](Flown& arm) {
    const robotics::Pose from = tool(start);
    const robotics::Quaternion kept{from.rotation};
    return arm.ask("MOVE_L", {from.position.x(), from.position.y(), from.position.z() - 0.1, kept.w(), kept.x(),
                              kept.y(), kept.z(), 0.25, 0.5});
  });
}

TEST_F(RobotArmArrival, IsDoneWithAGoalOfJointsOnceTheToolIsWhereTheyHaveIt) {
  is_done_with_its_tool([&](Flown& arm) { return arm.move_j(goal); });
}

/// In short pieces, each said before the one before is over; who says no other has an arm that stands.
TEST_F(RobotArmTest, JogsOnWithoutAHaltWhileItIsToldToAndStandsWithinAMomentOnceNobodyDoes) {
  const std::vector<double> joints{0.3, 0, 0, 0, 0, 0, 0.3}, tool{0, 0, 0.05, 0, 0, 0, 0.3};
  for (const auto& [function, other, numbers] :
       {std::tuple{"JOG_J", "JOG_L", joints}, std::tuple{"JOG_L", "JOG_J", tool}}) {
    Flown arm{6, std::string{folder} + "robot_arm.urdf"};
    arm.plant.place(start);
    arm.operate();
    auto request = arm.ask(function, numbers);
    arm.cycle(200);
    double slowest = HUGE_VAL;
    for (int i = 0; i < 10; ++i) {
      const auto next = arm.ask(function, numbers);
      for (int j = 0; j < 150; ++j) {
        arm.cycle();
        slowest = std::min(slowest, arm.plant.measured().velocity.cwiseAbs().maxCoeff());
      }
      EXPECT_EQ(arm.rig.outcome(request), "1 3 7") << function;
      EXPECT_EQ(arm.rig.outcome(next), "1 3") << function;
      request = next;
    }
    EXPECT_GT(slowest, 0.03) << function;
    const auto refused = arm.ask(other, numbers == joints ? tool : joints);
    arm.cycle(3);
    EXPECT_THAT(arm.rig.outcome(refused), StartsWith("1 4:0108")) << function;
    arm.cycle(600);
    EXPECT_EQ(arm.rig.outcome(request), "1 3 7") << function;
    const JointVector there = arm.plant.measured().position;
    arm.cycle(200);
    EXPECT_LT(arm.off(there), 1e-3) << function;
  }
}

TEST_F(RobotArmTest, JogsNoLongerThanASecondAtAWord) {
  for (const char* function : {"JOG_J", "JOG_L"}) {
    const auto* declared = flown.rig.descriptor().find_function(function);
    EXPECT_TRUE(pus::encode_call(*declared, std::vector{0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 1.0})) << function;
    EXPECT_FALSE(pus::encode_call(*declared, std::vector{0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 1.01})) << function;
  }
}

TEST_F(RobotArmTest, RefusesAGoalInWhichItMeetsItselfAndNamesWho) {
  flown.operate();
  const auto request = flown.move_j(vector_of(std::array{0.0, 0.0, 2.6, 2.2, 0.0, 0.0}));
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 4:800a"));
  const std::string names = "upper_arm and ";
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr(testing::hex(std::as_bytes(std::span{names}))));
}

TEST_F(RobotArmTest, StopsBeforeWhatItIsToKeepOutOfAndMayGoAwayFromIt) {
  flown.rig.bring_to(State::PreOperational, 1);
  flown.cycle(5);
  flown.command(State::SafeOperational);
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  const auto tool_at = [&](const JointVector& q) {
    robotics::State state;
    state.q = q;
    state.qd = JointVector::Zero(6);
    dynamics.update(state);
    return dynamics.frame_pose(flown.model.find_frame("tool").value()).position;
  };
  // Between start and goal, where both are free.
  const robotics::Vector3 between = tool_at((start + goal) / 2);
  flown.command(State::Operational);
  const auto motion = flown.move_j(goal);
  flown.cycle(300);  // nobody knew of it when its way was judged
  ASSERT_NO_FATAL_FAILURE(robot_arm::testing::keep_out_ball(flown, between));
  flown.finish(motion);
  EXPECT_THAT(flown.rig.outcome(motion), HasSubstr("8:800a"));
  EXPECT_EQ(flown.rig.events(1026), 1);
  flown.cycle(1000);
  EXPECT_GT((tool_at(flown.plant.measured().position) - between).norm(), 0.05);
  EXPECT_GT(flown.off(goal), 0.1);
  const auto away = flown.move_j(start);
  flown.finish(away);
  EXPECT_EQ(flown.rig.outcome(away), "1 3 5:0001 7");
}

/// With what it was configured with, the goal is free.
TEST_F(RobotArmTest, KeepsAsFarFromThingsAsWasWrittenAfterItWasConfigured) {
  for (const double limit_m : {0.02, 0.2}) {
    Flown other{6, std::string{folder} + "robot_arm.urdf"};
    other.plant.place(start);
    other.rig.bring_to(State::PreOperational, 1);
    other.cycle(5);
    other.write("CLEARANCE_LIMIT", limit_m);
    other.command(State::SafeOperational);
    // Beside the tool at the goal: nearer than 0.2 m, and not on the way there.
    robotics::Dynamics dynamics{other.model, robotics::Base::Fixed};
    robotics::State state;
    state.q = goal;
    state.qd = JointVector::Zero(6);
    dynamics.update(state);
    robotics::Vector3 beside = dynamics.frame_pose(other.model.find_frame("tool").value()).position;
    beside *= 1 + 0.15 / beside.norm();
    std::vector<std::optional<Value>> numbers;
    for (const double number : {beside.x(), beside.y(), beside.z(), beside.x(), beside.y(), beside.z(), 0.01})
      numbers.emplace_back(number);
    numbers.resize(28, Value{0.0});
    const auto set = other.rig.call_with("KEEP_OUT", numbers);
    other.cycle(5);
    ASSERT_EQ(other.rig.outcome(set), "1 3 7");
    other.command(State::Operational);
    const auto motion = other.move_j(goal);
    other.finish(motion);
    const std::string outcome = other.rig.outcome(motion);
    EXPECT_EQ(outcome.starts_with("1 4:800a"), limit_m > 0.1) << outcome;
    EXPECT_EQ(outcome == "1 3 5:0001 7", limit_m < 0.1) << outcome;
  }
}

TEST_F(RobotArmTest, PassesItsSelfTest) {
  flown.rig.bring_to(State::PreOperational, 1);
  flown.cycle(5);
  flown.command(State::SafeOperational);
  const auto request = flown.rig.send(17, 128, {});
  flown.cycle(40);
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr("7")) << ::testing::PrintToString(flown.rig.explanations);
}

TEST(ShippedRobotArm, ActsOnlyOnceItsSelfTestHasPassed) {
  const std::string file = std::string{folder} + "robot_arm.urdf";
  std::string text = robot_arm::testing::descriptor_text();
  replace_all(text, "value=\"robot_arm.urdf\"", "value=\"" + file + "\"");
  Flown arm{robot_arm::testing::model_of(file, 1), text};
  arm.rig.bring_to(State::PreOperational, 1);
  arm.cycle(5);
  arm.command(State::SafeOperational);
  const auto early = arm.rig.set_state(State::Operational);
  arm.cycle(5);
  EXPECT_THAT(arm.rig.outcome(early), StartsWith("1 4:010a"));
  const auto test = arm.rig.send(17, 128, {});
  arm.cycle(40);
  EXPECT_THAT(arm.rig.outcome(test), HasSubstr("7")) << ::testing::PrintToString(arm.rig.explanations);
  arm.command(State::Operational);
  EXPECT_EQ(arm.rig.state(), State::Operational);
}

/// A descriptor or a file that is wrong, and what it is refused with.
struct Wrong {
  const char* from;
  const char* to;
  const char* told;
};
struct RobotArmRefuses : ::testing::TestWithParam<Wrong> {};

TEST_P(RobotArmRefuses, WhatDoesNotFitTogether) {
  const auto& [from, to, told] = GetParam();
  std::string text = descriptor_for(6, std::string{folder} + "robot_arm.urdf");
  ASSERT_NE(text.find(from), std::string::npos);
  replace_all(text, from, to);
  const auto arm = make_robot_arm();
  testing::Rig rig{*arm, text};
  const std::string up = rig.set_state_now(State::PreOperational);
  if (up == "1 3 7") {
    EXPECT_THAT(rig.configure_now(1), StartsWith("1 3 8:"));
  }
  EXPECT_THAT(rig.explanations, Contains(HasSubstr(told)));
}

INSTANTIATE_TEST_SUITE_P(
    Descriptors, RobotArmRefuses,
    ::testing::Values(Wrong{"/robot_arm.urdf", "/nowhere.urdf", "nowhere.urdf"},
                      Wrong{"value=\"tool\"", "value=\"nobody\"", "the robot has no link 'nobody'"},
                      Wrong{"value=\"tool\"", "value=\"tool\"/><Setting name=\"FIXED\" value=\"elbow\"",
                            "FIXED of ARM: joint 'elbow' carries link 'tool'"},
                      Wrong{"value=\"tool\"", "value=\"shoulder\"/><Setting name=\"FIXED\" value=\"lift\"",
                            "FIXED of ARM: joint 'lift' carries joint 'elbow'"},
                      Wrong{"<Setting name=\"MODEL_FILE\"", "<Setting name=\"TIP2\"", "MODEL_FILE"},
                      Wrong{R"(name="DES_VELOCITY" id="2" type="DOUBLE" count="6")",
                            R"(name="DES_VELOCITY" id="2" type="DOUBLE" count="5")",
                            "DES_VELOCITY has another length than the robot has joints"},
                      Wrong{R"(type="FLOAT" count="6")", R"(type="FLOAT" count="5")",
                            "JOINTS of ABORT_PATH has another length than the robot has joints"}));

}  // namespace
}  // namespace hirosco
