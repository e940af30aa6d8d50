// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "subsystems/robot_arm/testing/flown.hpp"
#include "subsystems/robot_arm/testing/homing.hpp"

/// An arm whose joints do not know their zero when they are switched on (docs/adr/0208), in orbit; the test is its device.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::descriptor_text;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::homing_numbers;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;
using robot_arm::testing::with_homing;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::uint16_t not_referenced = 1070, under_gravity = 1071;
constexpr std::uint8_t works_by_position = 1, homes = 3;
constexpr std::size_t counted_joints = 6;
/// Six joints have been found, one by one.
constexpr const char* all_found = "1 3 5:0001 5:0002 5:0003 5:0004 5:0005 5:0006 7";

[[nodiscard]] std::string homed_file() { return std::string{folder} + "robot_arm.urdf"; }
[[nodiscard]] std::string homed_arm() {
  return with_homing(descriptor_for(counted_joints, homed_file()), homing_numbers());
}

/// Its encoders count from where they were switched on; frames end with a flag of each joint.
struct Counting : Flown {
  std::array<double, counted_joints> mark{};  ///< where it is, as the joint truly stands
  std::array<double, counted_joints> ahead{0.7, -1.3, 2.1, 0.4, -2.5, 1.1};  ///< of what is told a joint is
  std::array<bool, counted_joints> has_mark{true, true, true, true, true, true}, knows{}, takes{};
  std::optional<double> wall;  ///< beyond this the fifth joint meets something
  JointVector told_position;

  explicit Counting(const std::string& descriptor_text) : Flown{model_of(homed_file()), descriptor_text} {
    plant.set_gravity({0, 0, 0});
  }
  void exchange_once() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    OctetReader reader{command.payload, std::endian::little};
    std::vector<double> torques;
    for (std::size_t i = 0; i < counted_joints; ++i) torques.push_back(reader.get<double>());
    for (bool& each : takes) each = reader.get<std::uint8_t>() == 1;
    const std::vector<double> told_now = measured_after(torques);
    std::vector<std::byte> payload(sizeof(double) * told_now.size() + counted_joints);
    OctetWriter writer{payload, std::endian::little};
    for (const double number : told_now) writer.put(number);
    for (const bool each : knows) writer.put(static_cast<std::uint8_t>(each ? 1 : 0));
    std::array<std::byte, max_device_frame_octets> answer{};
    static_cast<void>(
        device->send(write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload}).value()));
  }
  std::vector<double> measured_after(const std::vector<double>& torques) {
    const JointVector before = plant.measured().position;
    constexpr double stiffness_n_m_rad = 2000;
    outside[4] = wall && before[4] > *wall ? -stiffness_n_m_rad * (before[4] - *wall) : 0;
    std::vector<double> numbers = play(torques);
    const JointVector& here = plant.measured().position;
    for (std::size_t i = 0; i < counted_joints; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (takes[i] && has_mark[i] && (before[k] - mark[i]) * (here[k] - mark[i]) <= 0) knows[i] = true, ahead[i] = 0;
      numbers[i] -= ahead[i];
    }
    told_position = vector_of(std::span{numbers}.first(counted_joints));
    return numbers;
  }
  void lose_power() {
    knows.fill(false);
    ahead.fill(0.9);
  }
  void fly(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange_once();
    }
    rig.service();
  }
  /// Steps have numbers, too.
  [[nodiscard]] bool has_ended(hirosco::testing::Sent request) const {
    const std::string outcome = rig.outcome(request);
    return outcome.ends_with(" 7") || outcome.find(" 8:") != outcome.npos || outcome.find(" 4:") != outcome.npos;
  }
  std::string asked(hirosco::testing::Sent request, int most = 30'000) {
    while (!has_ended(request) && most-- > 0) fly();
    return rig.outcome(request);
  }
  std::string asked(const char* function) { return asked(rig.call(function)); }
  [[nodiscard]] double fastest_joint() const { return plant.measured().velocity.cwiseAbs().maxCoeff(); }
};

struct RobotArmHoming : ::testing::Test {
  Counting arm;
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});

  explicit RobotArmHoming(const std::string& text = homed_arm()) : arm{text} {
    constexpr std::array sides{1.0, 1.0, -1.0, 1.0, 1.0, -1.0};
    for (std::size_t i = 0; i < counted_joints; ++i)
      arm.mark.at(i) = start[static_cast<Eigen::Index>(i)] + 0.05 * sides.at(i);
    arm.plant.place(start);
  }
  void enter(State state) {
    const auto request = arm.rig.set_state(state);
    arm.fly(5);
    ASSERT_EQ(arm.rig.outcome(request), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
  }
  void bring_up(std::uint8_t configuration) {
    arm.rig.bring_to(State::PreOperational, configuration);
    arm.fly(5);
    enter(State::SafeOperational);
    arm.fly(5);
  }
  void operate(std::uint8_t configuration = homes) {
    ASSERT_NO_FATAL_FAILURE(bring_up(configuration));
    ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
    ASSERT_EQ(arm.rig.inhibited(), 0u);
    ASSERT_EQ(arm.mode, DeviceMode::Active);
  }
  void act_by(std::uint8_t configuration) {
    enter(State::SafeOperational);
    enter(State::PreOperational);
    const auto configured = arm.rig.configure(configuration);
    arm.fly(20);
    ASSERT_EQ(arm.rig.outcome(configured), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
    enter(State::SafeOperational);
    arm.fly(5);
    enter(State::Operational);
  }
  [[nodiscard]] static std::string hex_of(const std::string& words) {
    return testing::hex(std::as_bytes(std::span{words}));
  }
  /// Of a failure: the joint's number, then words.
  [[nodiscard]] static std::string of_joint(int joint, const std::string& words) {
    return "000000000000000" + std::to_string(joint) + hex_of(words);
  }
  [[nodiscard]] std::string self_tested() { return arm.asked(arm.rig.send(17, 128, {}), 200); }
  void stands() {
    arm.fly(600);
    const JointVector there = arm.plant.measured().position;
    arm.fly(300);
    EXPECT_LT(arm.off(there), 1e-3);
    EXPECT_EQ(arm.rig.inhibited(), 0u);
  }
  /// Until it looks with this joint, from 1, and has come to its speed.
  void until_looks_with(std::size_t joint) {
    for (int i = 0; i < 20'000 && !arm.takes.at(joint - 1); ++i) arm.fly();
    ASSERT_TRUE(arm.takes.at(joint - 1));
    arm.fly(200);
    ASSERT_FALSE(arm.knows.at(joint - 1));
  }
};

TEST_F(RobotArmHoming, FindsItsZerosOneByOneInItsOrderAndTheOthersStand) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  JointVector stood = start;
  std::vector<std::size_t> order;
  double fastest = 0;
  std::array<bool, counted_joints> knew{};
  for (int i = 0; i < 20'000 && !arm.has_ended(home); ++i) {
    arm.fly();
    fastest = std::max(fastest, arm.fastest_joint());
    const JointVector& here = arm.plant.measured().position;
    for (std::size_t joint = 0; joint < counted_joints; ++joint) {
      const auto k = static_cast<Eigen::Index>(joint);
      if (arm.knows.at(joint) && !knew.at(joint)) order.push_back(joint + 1);
      // Whoever looks, or has found its zero and comes to rest, moves.
      if (arm.takes.at(joint) || arm.knows.at(joint)) stood[k] = here[k];
      ASSERT_NEAR(here[k], stood[k], 5e-3) << joint;
    }
    knew = arm.knows;
  }
  EXPECT_EQ(arm.rig.outcome(home), all_found) << ::testing::PrintToString(arm.rig.explanations);
  EXPECT_EQ(order, (std::vector<std::size_t>{6, 5, 4, 3, 2, 1}));
  EXPECT_LT(fastest, 0.2);
  EXPECT_LT((arm.told_position - arm.plant.measured().position).cwiseAbs().maxCoeff(), 1e-12);
  stands();
  EXPECT_EQ(arm.asked("HOME"), "1 3 7") << "all know their zero already";
}

TEST_F(RobotArmHoming, GoesByItsModelThenInAnotherConfigurationWithoutBeingStartedAnew) {
  ASSERT_NO_FATAL_FAILURE(operate());
  ASSERT_EQ(arm.asked("HOME"), all_found);
  ASSERT_NO_FATAL_FAILURE(act_by(works_by_position));
  EXPECT_EQ(arm.rig.inhibited(), 0u);
  EXPECT_EQ(arm.rig.events(not_referenced), 0);
  const auto motion = arm.move_j(start, 0.5);
  EXPECT_EQ(arm.asked(motion), "1 3 5:0001 7");
  EXPECT_LT(arm.off(start), 1e-3);
}

/// POSITION jumps by up to 2.5 rad then.
TEST_F(RobotArmHoming, MakesNoStepInTorqueWhereAJointFindsItsZero) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  std::array<bool, counted_joints> knew{};
  JointVector last = arm.commanded;
  int since = 1000, found = 0;
  double steepest = 0;
  for (int i = 0; i < 20'000 && !arm.has_ended(home); ++i) {
    arm.fly();
    ++since;
    if (arm.knows != knew) since = 0, ++found;
    // What is told now is answered in the next two cycles.
    if (since <= 3) steepest = std::max(steepest, (arm.commanded - last).cwiseAbs().maxCoeff());
    knew = arm.knows;
    last = arm.commanded;
  }
  EXPECT_EQ(found, 6);
  EXPECT_LT(steepest, 0.5);
  EXPECT_EQ(arm.rig.inhibited(), 0u);
}

TEST_F(RobotArmHoming, EndsWithTheNumberOfAJointThatHasNoMarkAndGoesOnWhereItHasOne) {
  arm.has_mark[3] = false;
  ASSERT_NO_FATAL_FAILURE(operate());
  const std::string outcome = arm.asked("HOME");
  EXPECT_THAT(outcome, StartsWith("1 3 5:0001 5:0002 8:8031"));
  EXPECT_THAT(outcome, HasSubstr(of_joint(4, "no mark")));
  EXPECT_THAT(arm.takes, Each(false));
  stands();
  EXPECT_NEAR(arm.plant.measured().position[3] - start[3], 0.4, 0.03);
  arm.has_mark[3] = true;
  arm.mark[3] = arm.plant.measured().position[3] + 0.05;
  EXPECT_EQ(arm.asked("HOME"), "1 3 5:0001 5:0002 5:0003 5:0004 7");
}

TEST_F(RobotArmHoming, StandsBeforeWhatIsInTheWayAndPressesNoHarderThanItsTorque) {
  arm.wall = start[4] + 0.02;
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  double hardest = 0;
  for (int i = 0; i < 20'000 && !arm.has_ended(home); ++i) {
    arm.fly();
    hardest = std::max(hardest, std::abs(arm.commanded[4]));
  }
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:8032"));
  EXPECT_THAT(arm.rig.outcome(home), HasSubstr(of_joint(5, "all of TORQUE of HOMING")));
  EXPECT_LE(hardest, 5);
  stands();
  EXPECT_LT(std::abs(arm.commanded[4]), 1) << "it presses on for nobody";
  EXPECT_FALSE(arm.knows[4]);
  arm.wall.reset();
  EXPECT_EQ(arm.asked("HOME"), "1 3 5:0001 5:0002 5:0003 5:0004 5:0005 7");
}

TEST_F(RobotArmHoming, IsEndedByHoldAndByStopAndGoesOnWithThoseThatAreLeft) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto first = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  EXPECT_EQ(arm.asked("HOLD"), "1 3 7");
  EXPECT_EQ(arm.rig.outcome(first), "1 3 5:0001 8:0204");
  EXPECT_THAT(arm.takes, Each(false));
  stands();
  const auto second = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(4));
  EXPECT_EQ(arm.asked("STOP"), "1 3 7");
  EXPECT_EQ(arm.rig.outcome(second), "1 3 5:0001 8:0204");
  arm.fly(5);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8006"));
  ASSERT_NO_FATAL_FAILURE(enter(State::SafeOperational));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.asked("HOME"), "1 3 5:0001 5:0002 5:0003 5:0004 7");
}

TEST_F(RobotArmHoming, IsEndedByTheStopOfEverythingInTheNextCycle) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  arm.rig.fence();
  arm.fly(2);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_THAT(arm.takes, Each(false));
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:"));
}

TEST_F(RobotArmHoming, IsEndedWhereAJointLosesItsZeroMeanwhileAndSaysWhich) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const auto home = arm.rig.call("HOME");
  ASSERT_NO_FATAL_FAILURE(until_looks_with(5));
  arm.knows[5] = false;
  arm.ahead[5] = 1.5;
  arm.fly(5);
  EXPECT_THAT(arm.rig.outcome(home), StartsWith("1 3 5:0001 8:8030"));
  EXPECT_THAT(arm.rig.outcome(home), HasSubstr(of_joint(6, "it lost its zero")));
  stands();
  arm.mark[5] = arm.plant.measured().position[5] - 0.05;
  EXPECT_EQ(arm.asked("HOME"), all_found);
}

TEST_F(RobotArmHoming, WithoutPowerItIsNotKnownAgainAndNothingMovesByItsModel) {
  ASSERT_NO_FATAL_FAILURE(operate());
  ASSERT_EQ(arm.asked("HOME"), all_found);
  ASSERT_NO_FATAL_FAILURE(act_by(works_by_position));
  const auto motion = arm.move_j(start, 0.2);
  arm.fly(100);
  arm.lose_power();
  arm.fly();
  double hardest = 0;
  for (int i = 0; i < 10; ++i) {
    arm.fly();
    hardest = std::max(hardest, arm.commanded.cwiseAbs().maxCoeff());
    if (i == 0) {
      EXPECT_EQ(arm.mode, DeviceMode::Off) << "in the cycle that hears of it";
    }
  }
  EXPECT_EQ(hardest, 0);
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(arm.rig.events(not_referenced), 1);
  EXPECT_THAT(arm.rig.outcome(motion), HasSubstr("8:8030"));
  EXPECT_THAT(arm.rig.outcome(motion), HasSubstr(of_joint(1, "it does not know its zero")));
  ASSERT_NO_FATAL_FAILURE(enter(State::SafeOperational));
  EXPECT_THAT(self_tested(), HasSubstr("8:"));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_EQ(arm.rig.events(not_referenced), 2);
  const auto next = arm.move_j(start, 0.2);
  arm.fly(3);
  EXPECT_THAT(arm.rig.outcome(next), StartsWith("1 4:8006"));
}

TEST_F(RobotArmHoming, IsRefusedInEveryOtherConfigurationWithTheJointThatDoesNotKnowItsZero) {
  arm.knows = {true, true, false, true, true, true};
  arm.ahead = {0, 0, 10, 0, 0, 0};
  ASSERT_NO_FATAL_FAILURE(bring_up(works_by_position));
  const std::string tested = self_tested();
  EXPECT_THAT(tested, HasSubstr("8:"));
  EXPECT_THAT(tested, HasSubstr(of_joint(3, "does not know its zero")));
  EXPECT_EQ(arm.rig.inhibited(), 0u) << "what it tells is beyond no range";
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_EQ(arm.rig.events(not_referenced), 1);
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8034"));
}

TEST_F(RobotArmHoming, KeepsAConfigurationThatHomesForHomingAlone) {
  ASSERT_NO_FATAL_FAILURE(operate());
  const std::vector<std::pair<const char*, std::vector<double>>> others{{"MOVE_J", {0, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"MOVE_P", {0.5, 0, 0.5, 1, 0, 0, 0, 0.5}},
                                                                        {"JOG_J", {0.1, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"TORQUE_J", {1, 0, 0, 0, 0, 0, 0.5}},
                                                                        {"IMPEDANCE_L", {500, 30, 1}},
                                                                        {"RETREAT", {0.1}},
                                                                        {"MOVE_ABORT", {0.25}}};
  for (const auto& [function, numbers] : others)
    EXPECT_THAT(arm.asked(arm.ask(function, numbers)), StartsWith("1 4:8034")) << function;
  stands();
}

TEST_F(RobotArmHoming, PassesItsSelfTestWithoutItsPosture) {
  arm.ahead.fill(50);
  ASSERT_NO_FATAL_FAILURE(bring_up(homes));
  EXPECT_EQ(self_tested(), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
}

/// What an arm weighs where its posture is not known nobody knows.
struct RobotArmHomingOnGround : RobotArmHoming {
  RobotArmHomingOnGround() : RobotArmHoming{on_ground()} {}
  [[nodiscard]] static std::string on_ground() {
    std::string text = homed_arm();
    replace_all(text, R"(unit="m/s2" init="0 0 0")", R"(unit="m/s2" init="0 0 -9.81")");
    return text;
  }
};

TEST_F(RobotArmHomingOnGround, IsRefusedAndNoBrakeOpens) {
  ASSERT_NO_FATAL_FAILURE(bring_up(homes));
  EXPECT_THAT(self_tested(), HasSubstr(hex_of("GRAVITY is not 0")));
  ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
  EXPECT_EQ(arm.rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(arm.mode, DeviceMode::Off);
  EXPECT_EQ(arm.rig.events(under_gravity), 1);
  EXPECT_THAT(arm.asked("HOME"), StartsWith("1 4:8006"));
}

/// A descriptor that homes nobody, and what it is refused with.
struct UnfitToHome {
  const char* from;
  const char* to;
  const char* told;
};
struct RobotArmHomingRefuses : ::testing::TestWithParam<UnfitToHome> {};

TEST_P(RobotArmHomingRefuses, WhatHomesNobody) {
  const auto& [from, to, told] = GetParam();
  std::string text = homed_arm();
  ASSERT_NE(text.find(from), std::string::npos);
  replace_all(text, from, to);
  const auto subsystem = make_robot_arm();
  testing::Rig rig{*subsystem, text};
  const std::string up = rig.set_state_now(State::PreOperational);
  if (up == "1 3 7") {
    EXPECT_THAT(rig.configure_now(homes), StartsWith("1 3 8:"));
  }
  EXPECT_THAT(rig.explanations, Contains(HasSubstr(told)));
}

INSTANTIATE_TEST_SUITE_P(
    Descriptors, RobotArmHomingRefuses,
    ::testing::Values(
        UnfitToHome{"6 5 4 3 2 1", "6 5 4 3 2 2", "ORDER of HOMING does not name each joint once"},
        UnfitToHome{"0.1 0.1 -0.1", "0.1 0 -0.1", "SPEED of HOMING is 0 or above 1/4"},
        UnfitToHome{"15 15 12", "15 15 0", "TORQUE of HOMING is 0 or above its effort"},
        UnfitToHome{"0.4 0.4 0.4 0.4 0.4 0.4", "0.4 0.4 0.4 0.4 0.4 0", "DISTANCE of HOMING is 0"},
        UnfitToHome{"init=\"0.1 0.1 0.1 0.1 0.1 0.1\" minimum=\"0\" maximum=\"10\"",
                    "init=\"0.1 0.1 0 0.1 0.1 0.1\" minimum=\"0\" maximum=\"10\"", "homing goes by ROTOR_INERTIA"},
        UnfitToHome{"name=\"HOMING\" value=\"on\"", "name=\"HOMING\" value=\"yes\"", "HOMING of ARM is on, or"},
        UnfitToHome{R"(name="REFERENCED" id="66" type="UINT8" count="6")",
                    R"(name="REFERENCED" id="66" type="UINT8" count="5")",
                    "REFERENCED has another length than the robot has joints"}));

TEST(RobotArmWithAbsoluteEncoders, HasNoHomingAndAConfigurationThatHomesIsRefused) {
  std::string text = descriptor_for(counted_joints, homed_file());
  replace_all(text, "value=\"tool\"/>", "value=\"tool\"/><Setting name=\"HOMING\" value=\"on\"/>");
  const auto subsystem = make_robot_arm();
  testing::Rig rig{*subsystem, text};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::Not("1 3 7"));
  EXPECT_THAT(rig.explanations, Contains(HasSubstr("HOMING")));
}

TEST(ShippedArmThatHomes, ActsByItsModelOnlyOnceAllZerosAreKnown) {
  std::string text = with_homing(descriptor_text(), homing_numbers());
  replace_all(text, "value=\"robot_arm.urdf\"", "value=\"" + homed_file() + "\"");
  Counting arm{text};
  arm.rig.bring_to(State::PreOperational, works_by_position);
  arm.fly(5);
  const auto safe = arm.rig.set_state(State::SafeOperational);
  arm.fly(5);
  ASSERT_EQ(arm.rig.outcome(safe), "1 3 7");
  EXPECT_THAT(arm.asked(arm.rig.send(17, 128, {}), 200), HasSubstr("8:"));
  const auto early = arm.rig.set_state(State::Operational);
  arm.fly(5);
  EXPECT_THAT(arm.rig.outcome(early), StartsWith("1 4:010a"));
  arm.knows.fill(true);
  arm.ahead.fill(0);
  arm.fly(5);
  EXPECT_EQ(arm.asked(arm.rig.send(17, 128, {}), 200), "1 3 7");
}

}  // namespace
}  // namespace hirosco
