// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/free_plant.hpp"

/// A floating arm whose joints somebody leads over a real-time link (docs/adr/0235), on a craft that nothing holds; the test is who leads.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using ::testing::StartsWith;

struct FloatingArmFollows : robot_arm::testing::FreeArm {
  static constexpr std::uint16_t lost = 2130, let_go = 2131, unfit = 2132, contact_event = 2113;
  hirosco::testing::Rig::Partner leader;
  JointVector position{ready}, velocity{JointVector::Zero(7)};
  std::uint8_t active{1};
  bool speaks{true};

  void SetUp() override {
    flown.plant.place(ready);
    flown.rig.bring_to(State::PreOperational, 4);
    std::string outcome;
    leader =
        flown.rig.attach(1, pus::st128::Role::Consumer, "JOINT_POSITIONS",
                         std::vector<pus::st128::OfferedField>{
                             {"POSITION", Type::Double, 7}, {"VELOCITY", Type::Double, 7}, {"ACTIVE", Type::Uint8, 1}},
                         &outcome);
    ASSERT_EQ(outcome, done) << ::testing::PrintToString(flown.rig.explanations);
    cycle(5);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = flown.rig.set_state(state);
      cycle(5);
      ASSERT_EQ(flown.rig.outcome(request), done) << ::testing::PrintToString(flown.rig.explanations);
    }
    ASSERT_EQ(flown.rig.inhibited(), 0u);
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      if (speaks) say();
      flown.cycle();
    }
  }
  void say() {
    std::vector<std::byte> payload(14 * sizeof(double) + 1);
    OctetWriter writer{payload, std::endian::little};
    for (const double each : position) writer.put(each);
    for (const double each : velocity) writer.put(each);
    writer.put(active);
    leader.writer.write(payload, flown.rig.clock.now(), LinkStatus::Valid);
  }
  std::string asked_now(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = flown.rig.call(function, numbers);
    cycle(3);
    return flown.rig.outcome(request);
  }
  /// The first joint with this velocity, and back to none, each within half a second.
  void lead(double rad_s, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      velocity[0] = rad_s * std::min({1.0, i / 500.0, (cycles - i) / 500.0});
      position += 0.001 * velocity;
      cycle();
    }
    velocity.setZero();
  }
  void holds() {
    cycle(1500);
    const JointVector there = flown.plant.measured().position;
    cycle(500);
    EXPECT_LT(flown.off(there), 1e-3);
    EXPECT_LT(speed(), 5e-3);
    EXPECT_EQ(flown.rig.inhibited(), 0u);
  }
};

TEST_F(FloatingArmFollows, WhereItsJointsAreLedUntilHold) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  ASSERT_NO_FATAL_FAILURE(lead(0.1, 3000));
  cycle(1500);
  EXPECT_GT(position[0], ready[0] + 0.2);
  EXPECT_LT(flown.off(position), 2e-3);
  EXPECT_THAT(asked_now("MOVE_JOINT", {0, 0, 0, 0, 0, 0, 0, 60}), StartsWith("1 4:0108")) << "busy";
  EXPECT_EQ(asked_now("HOLD"), done);
  cycle(600);
  const JointVector there = flown.plant.measured().position;
  ASSERT_NO_FATAL_FAILURE(lead(0.1, 1500));
  EXPECT_LT(flown.off(there), 2e-3) << "it follows no more";
  holds();
}

TEST_F(FloatingArmFollows, NoFasterThanItsJointsMayGoThoughWhoLeadsJumps) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  position[0] += 0.3;
  cycle(5000);
  EXPECT_LT(flown.off(position), 2e-3);
  EXPECT_LT(flown.fastest, 0.21);
  EXPECT_EQ(flown.rig.events(unfit), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingArmFollows, NobodyWhoIsLostAndStands) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  ASSERT_NO_FATAL_FAILURE(lead(0.1, 1500));
  speaks = false;
  holds();
  EXPECT_EQ(flown.rig.events(lost), 1);
  speaks = true;
  position = flown.plant.measured().position;
  cycle(10);
  EXPECT_EQ(asked_now("FOLLOW"), done) << "and anew";
}

TEST_F(FloatingArmFollows, NobodyWhoLetsGoOrLeadsOutOfARange) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  active = 0;
  cycle(5);
  EXPECT_EQ(flown.rig.events(let_go), 1);
  EXPECT_THAT(asked_now("FOLLOW"), StartsWith("1 4:8011")) << "NOT_LED";
  active = 1;
  cycle(1500);
  position = flown.plant.measured().position;
  cycle(10);
  ASSERT_EQ(asked_now("FOLLOW"), done);
  position[3] = 3.0;
  cycle(5);
  EXPECT_EQ(flown.rig.events(unfit), 1);
  holds();
}

TEST_F(FloatingArmFollows, NobodyWhoIsFarAwayWhenItIsTo) {
  position[2] += 0.1;
  cycle(5);
  EXPECT_THAT(asked_now("FOLLOW"), StartsWith("1 4:8011"));
}

TEST_F(FloatingArmFollows, AndStandsWhereItMeetsSomebody) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  flown.plant.push_n = {-32, 0, 0};
  for (int i = 0; i < 200 && flown.rig.events(contact_event) == 0; ++i) cycle();
  EXPECT_EQ(flown.rig.events(contact_event), 1);
  flown.plant.push_n.setZero();
  cycle(1000);
  const JointVector there = flown.plant.measured().position;
  ASSERT_NO_FATAL_FAILURE(lead(0.1, 1500));
  EXPECT_LT(flown.off(there), 5e-3) << "it follows no more";
}

/// Springs go where it is led, and whoever is in the way meets springs.
TEST_F(FloatingArmFollows, ByItsSpringsWhereTheyHoldItsJoints) {
  ASSERT_EQ(asked_now("IMPEDANCE_J", {400, 400, 400, 400, 20, 20, 2, 0.9}), done);
  ASSERT_EQ(asked_now("FOLLOW"), done);
  ASSERT_NO_FATAL_FAILURE(lead(0.05, 3000));
  cycle(3000);
  EXPECT_LT(flown.off(position), 5e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST(FloatingArmAlone, FollowsNobodyInAConfigurationInWhichNobodyLeads) {
  robot_arm::testing::FlownFree flown;
  flown.plant.place(vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0}));
  flown.operate();
  const auto request = flown.rig.call("FOLLOW");
  flown.cycle(3);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 4:8011"));
}

/// A tool that is kept by POSE and joints that are led are not had at once.
TEST(FloatingArmAlone, IsNotConfiguredToBeLedWhereItKeepsItsTool) {
  std::string text = robot_arm::testing::floating_descriptor();
  const auto led = text.find("<Requires name=\"JOINT_POSITIONS\""), end = text.find("</Requires>", led);
  const std::string leader = text.substr(led, end + std::string_view{"</Requires>"}.size() - led);
  text.insert(text.find("<Requires name=\"POSE\""), leader);
  robot_arm::testing::FlownFree flown{text};
  flown.rig.bring_to(State::PreOperational, 0);
  const std::string words = "JOINT_POSITIONS lead, POSE is kept to: one in a configuration";
  EXPECT_THAT(flown.rig.configure_now(2), ::testing::HasSubstr(hirosco::testing::hex(std::as_bytes(std::span{words}))));
}

}  // namespace
}  // namespace hirosco
