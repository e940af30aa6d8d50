// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "subsystems/robot_arm/floating/tool_law.hpp"
#include "subsystems/robot_arm/testing/free_plant.hpp"

/// A floating arm whose tool somebody leads over a real-time link in inertial axes (docs/adr/0245), on a craft that nothing holds; the test measures its base and is who leads.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robotics::Pose;
using robotics::Vector3;
using ::testing::StartsWith;

struct FloatingToolFollows : robot_arm::testing::FreeArm {
  static constexpr std::uint16_t lost = 2130, let_go = 2131, unfit = 2133, contact_event = 2113, too_near_event = 2111,
                                 range_end_near = 2110;
  static constexpr std::uint16_t tool_follow = 5, attitude_hold = 3;
  hirosco::testing::Rig::Partner measures, leader;
  Pose led;
  Vector3 moving{Vector3::Zero()}, turning{Vector3::Zero()};
  std::uint8_t active{1};
  bool speaks{true};

  void SetUp() override {
    flown.plant.place(ready);
    flown.rig.bring_to(State::PreOperational, tool_follow);
    std::string outcome;
    measures = flown.rig.attach(2, pus::st128::Role::Consumer, "POSE",
                                std::vector<pus::st128::OfferedField>{{"POSITION", Type::Double, 3},
                                                                      {"ORIENTATION", Type::Double, 4},
                                                                      {"RATE", Type::Double, 3},
                                                                      {"VELOCITY", Type::Double, 3},
                                                                      {"QUALITY", Type::Uint8, 1},
                                                                      {"FREE", Type::Uint8, 1},
                                                                      {"STAMP", Type::Uint32, 1}},
                                &outcome);
    ASSERT_EQ(outcome, done) << ::testing::PrintToString(flown.rig.explanations);
    leader = flown.rig.attach(1, pus::st128::Role::Consumer, "TOOL_POSE",
                              std::vector<pus::st128::OfferedField>{{"POSITION", Type::Double, 3},
                                                                    {"ORIENTATION", Type::Double, 4},
                                                                    {"VELOCITY", Type::Double, 3},
                                                                    {"RATE", Type::Double, 3},
                                                                    {"ACTIVE", Type::Uint8, 1}},
                              &outcome);
    ASSERT_EQ(outcome, done) << ::testing::PrintToString(flown.rig.explanations);
    led = tool();
    cycle(50);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = flown.rig.set_state(state);
      cycle(5);
      ASSERT_EQ(flown.rig.outcome(request), done) << ::testing::PrintToString(flown.rig.explanations);
    }
    ASSERT_EQ(flown.rig.inhibited(), 0u);
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      tell_base();
      if (speaks) say();
      flown.cycle();
    }
  }
  void tell_base() {
    std::vector<std::byte> payload(13 * sizeof(double) + 2 + sizeof(std::uint32_t));
    OctetWriter writer{payload, std::endian::little};
    put(writer, flown.plant.base());
    for (int i = 0; i < 6; ++i) writer.put(0.0);
    writer.put(std::uint8_t{1});
    writer.put(std::uint8_t{1});
    writer.put(std::uint32_t{0});
    measures.writer.write(payload, flown.rig.clock.now(), LinkStatus::Valid);
  }
  void say() {
    std::vector<std::byte> payload(13 * sizeof(double) + 1);
    OctetWriter writer{payload, std::endian::little};
    put(writer, led);
    for (const Vector3* each : {&moving, &turning})
      for (const double number : *each) writer.put(number);
    writer.put(active);
    leader.writer.write(payload, flown.rig.clock.now(), LinkStatus::Valid);
  }
  static void put(OctetWriter& writer, const Pose& pose) {
    for (const double number : pose.position) writer.put(number);
    const robotics::Quaternion turned{pose.rotation};
    for (const double number : {turned.w(), turned.x(), turned.y(), turned.z()}) writer.put(number);
  }
  /// By the plant, and not by what the arm believes.
  [[nodiscard]] Pose tool() const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Free};
    const Pose base = flown.plant.base();
    dynamics.update({.base_position = base.position,
                     .base_orientation = robotics::Quaternion{base.rotation},
                     .q = flown.plant.measured().position,
                     .qd = JointVector::Zero(7)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value());
  }
  [[nodiscard]] double off_m() const { return (tool().position - led.position).norm(); }
  [[nodiscard]] double off_rad() const { return robot_arm::rotation_between(tool().rotation, led.rotation).norm(); }
  std::string asked_now(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = flown.rig.call(function, numbers);
    cycle(3);
    return flown.rig.outcome(request);
  }
  /// Whoever leads goes on with these velocities, each come to and left within half a second.
  void lead(const Vector3& moves, const Vector3& turns, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      const double share = std::min({1.0, i / 500.0, (cycles - i) / 500.0});
      moving = share * moves;
      turning = share * turns;
      led.position += 0.001 * moving;
      const Vector3 by = 0.001 * turning;
      if (by.norm() > 0) led.rotation = Eigen::AngleAxisd(by.norm(), by.normalized()).toRotationMatrix() * led.rotation;
      cycle();
    }
    moving.setZero();
    turning.setZero();
  }
  void stands() {
    cycle(1500);
    const Pose there = tool();
    cycle(500);
    EXPECT_LT((tool().position - there.position).norm(), 1e-3);
    EXPECT_LT(speed(), 5e-3);
    EXPECT_EQ(flown.rig.inhibited(), 0u);
  }
};

TEST_F(FloatingToolFollows, PlaceAndOrientationInInertialAxesThoughItsBaseTurnsUntilHold) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  double farthest_m = 0, farthest_rad = 0;
  for (int part = 0; part < 4; ++part) {
    ASSERT_NO_FATAL_FAILURE(lead({0.03, 0.02, 0.01}, {0, 0.02, 0.01}, 1000));
    farthest_m = std::max(farthest_m, off_m());
    farthest_rad = std::max(farthest_rad, off_rad());
  }
  cycle(1500);
  EXPECT_LT(off_m(), 1e-3);
  EXPECT_LT(off_rad(), 2e-3);
  EXPECT_LT(farthest_m, 5e-3) << "and on the way";
  EXPECT_LT(farthest_rad, 5e-3);
  const Pose base = flown.plant.base();
  EXPECT_GT(Eigen::AngleAxisd(base.rotation).angle(), 1e-3) << "its base has been turned for that";
  EXPECT_THAT(asked_now("MOVE_TOOL", {0, 0, 0.01, 5}), StartsWith("1 4:0108")) << "busy";
  EXPECT_EQ(asked_now("HOLD"), done);
  cycle(600);
  const Pose there = tool();
  ASSERT_NO_FATAL_FAILURE(lead({0.03, 0, 0}, Vector3::Zero(), 1500));
  EXPECT_LT((tool().position - there.position).norm(), 2e-3) << "it follows no more";
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Whatever is asked of it: no faster than TOOL_SPEED, without a jump of what joints are to do.
TEST_F(FloatingToolFollows, NoFasterThanItMayGoThoughWhoLeadsJumps) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  led.position += Vector3{0.06, 0, 0.03};
  double fastest = 0, steepest = 0;
  Vector3 before = tool().position, velocity = Vector3::Zero();
  for (int i = 0; i < 5000; ++i) {
    cycle();
    const Vector3 now = tool().position, its = (now - before) / 0.001;
    fastest = std::max(fastest, its.norm());
    steepest = std::max(steepest, (its - velocity).norm() / 0.001);
    before = now;
    velocity = its;
  }
  EXPECT_LT(off_m(), 1e-3);
  EXPECT_LT(fastest, 0.055) << "TOOL_SPEED";
  EXPECT_GT(fastest, 0.03);
  EXPECT_LT(steepest, 0.25) << "m/s2, of which its goal has 0.1";
  EXPECT_EQ(flown.rig.events(unfit), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(FloatingToolFollows, NobodyWhoIsLostAndStands) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  ASSERT_NO_FATAL_FAILURE(lead({0.03, 0, 0}, Vector3::Zero(), 1500));
  speaks = false;
  ASSERT_NO_FATAL_FAILURE(stands());
  EXPECT_EQ(flown.rig.events(lost), 1);
  speaks = true;
  led = tool();
  cycle(10);
  EXPECT_EQ(asked_now("FOLLOW"), done) << "and anew";
}

TEST_F(FloatingToolFollows, NobodyWhoLetsGoNorWhoIsFarAwayWhenItIsTo) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  active = 0;
  cycle(5);
  EXPECT_EQ(flown.rig.events(let_go), 1);
  EXPECT_THAT(asked_now("FOLLOW"), StartsWith("1 4:8011")) << "NOT_LED";
  active = 1;
  ASSERT_NO_FATAL_FAILURE(stands());
  led.position.x() += 0.03;
  cycle(5);
  EXPECT_THAT(asked_now("FOLLOW"), StartsWith("1 4:8011")) << "it would leap";
  led = tool();
  led.rotation = Eigen::AngleAxisd(0.06, Vector3::UnitZ()).toRotationMatrix() * led.rotation;
  cycle(5);
  EXPECT_THAT(asked_now("FOLLOW"), StartsWith("1 4:8011"));
}

TEST_F(FloatingToolFollows, NobodyWhoAsksForWhatNoToolShouldDo) {
  const std::array<std::function<void()>, 5> asks{
      [this] { led.position.y() = std::nan(""); }, [this] { led.rotation *= 1.1; },
      [this] { led.position.z() += 0.12; }, [this] { moving = {0, 0.07, 0}; }, [this] { turning = {0, 0, 0.07}; }};
  int ends = 0;
  for (const auto& ask : asks) {
    led = tool();
    moving.setZero();
    turning.setZero();
    cycle(20);
    ASSERT_EQ(asked_now("FOLLOW"), done) << ends;
    ask();
    cycle(5);
    EXPECT_EQ(flown.rig.events(unfit), ++ends);
    ASSERT_NO_FATAL_FAILURE(stands());
  }
}

TEST_F(FloatingToolFollows, AndStandsWhereItMeetsSomebody) {
  ASSERT_EQ(asked_now("FOLLOW"), done);
  flown.plant.push_n = {-32, 0, 0};
  for (int i = 0; i < 200 && flown.rig.events(contact_event) == 0; ++i) cycle();
  EXPECT_EQ(flown.rig.events(contact_event), 1);
  flown.plant.push_n.setZero();
  cycle(1500);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
  const Pose there = tool();
  led = there;
  ASSERT_NO_FATAL_FAILURE(lead({0.03, 0, 0}, Vector3::Zero(), 1500));
  const double gone = (tool().position - there.position).dot(Vector3::UnitX());
  EXPECT_LT(gone, 5e-3) << "it follows no more";
}

/// The goal waits for joints that are slower for their power; nobody is thrown there later.
TEST_F(FloatingToolFollows, AsSlowlyAsItsPowerLeaves) {
  ASSERT_EQ(asked_now("SET_FORCE_LIMIT", {10}), done);
  ASSERT_EQ(asked_now("SET_POWER_LIMIT", {10, 1}), done);
  ASSERT_EQ(asked_now("FOLLOW"), done);
  ASSERT_NO_FATAL_FAILURE(lead({0.03, 0, 0.02}, Vector3::Zero(), 3000));
  cycle(4000);
  EXPECT_LT(off_m(), 2e-3);
  EXPECT_EQ(flown.rig.events(unfit), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

/// Whoever is near is no goal, whoever leads there.
TEST_F(FloatingToolFollows, NearNobodyWhoStandsInItsWay) {
  const Vector3 there =
      flown.plant.base().rotation.transpose() * (tool().position + Vector3{0.25, 0, 0} - flown.plant.base().position);
  ASSERT_EQ(asked_now("KEEP_OUT",
                      {there.x(), there.y(), there.z(), there.x(), there.y(), there.z(), 0.1, 0, 0, 0, 0, 0, 0, 0,
                       0,         0,         0,         0,         0,         0,         0,   0, 0, 0, 0, 0, 0, 0}),
            done);
  ASSERT_EQ(asked_now("FOLLOW"), done);
  for (int part = 0; part < 8 && flown.rig.events(too_near_event) == 0; ++part)
    ASSERT_NO_FATAL_FAILURE(lead({0.04, 0, 0}, Vector3::Zero(), 1000));
  EXPECT_EQ(flown.rig.events(too_near_event), 1);
  cycle(1500);
  EXPECT_EQ(flown.rig.inhibited(), 0u) << "it stands, and no brakes";
  const Vector3 ball = flown.plant.base().rotation * there + flown.plant.base().position;
  EXPECT_GT((tool().position - ball).norm(), 0.1 + 0.019);
}

/// Springs go where it is led, and whoever is in the way meets springs.
TEST_F(FloatingToolFollows, BySpringsWhereTheyHoldItsTool) {
  ASSERT_EQ(asked_now("IMPEDANCE_L", {300, 15, 0.9}), done);
  ASSERT_EQ(asked_now("FOLLOW"), done);
  ASSERT_NO_FATAL_FAILURE(lead({0.02, 0, 0.01}, Vector3::Zero(), 3000));
  cycle(4000);
  EXPECT_LT(off_m(), 5e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST(FloatingArmAlone, IsNotLedByItsToolWhereNothingTurnsThat) {
  std::string text = robot_arm::testing::floating_descriptor();
  const auto led = text.find("<Requires name=\"TOOL_POSE\""), end = text.find("</Requires>", led);
  const std::string leader = text.substr(led, end + std::string_view{"</Requires>"}.size() - led);
  text.insert(text.rfind("<Requires name=\"POSE\""), leader);  // of ATTITUDE_HOLD
  robot_arm::testing::FlownFree flown{text};
  flown.rig.bring_to(State::PreOperational, 0);
  const std::string words = "TOOL_POSE leads, and ATTITUDE_HOLD turns no tool";
  EXPECT_THAT(flown.rig.configure_now(FloatingToolFollows::attitude_hold),
              ::testing::HasSubstr(hirosco::testing::hex(std::as_bytes(std::span{words}))));
}

}  // namespace
}  // namespace hirosco
