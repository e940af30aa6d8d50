// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "subsystems/robot_arm/testing/flown.hpp"

/// An arm that somebody leads over a real-time link (docs/adr/0179); the test is who leads.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_text;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;
using ::testing::StartsWith;

constexpr std::uint16_t lost = 1060, let_go = 1061, unfit = 1062;
const std::vector<pus::st128::OfferedField> places{
    {"POSITION", Type::Double, 6}, {"VELOCITY", Type::Double, 6}, {"ACTIVE", Type::Uint8, 1}};
const std::vector<pus::st128::OfferedField> speeds{{"VELOCITY", Type::Double, 6}, {"ACTIVE", Type::Uint8, 1}};

[[nodiscard]] std::string house(std::string text = descriptor_text()) {
  replace_all(text, robot_arm::testing::self_test_required, "");
  replace_all(text, "value=\"robot_arm.urdf\"", "value=\"" + std::string{folder} + "robot_arm.urdf\"");
  return text;
}
/// The same, led by velocities.
[[nodiscard]] std::string by_speeds() {
  std::string text = house();
  const auto from = text.find("<Requires name=\"JOINT_POSITIONS\""), field = text.find("<Field", from);
  text.erase(field, text.find("<Field", field + 1) - field);
  replace_all(text, "JOINT_POSITIONS", "JOINT_SPEEDS");
  return text;
}

/// A sample, and whatever is wrong with it.
struct Told {
  JointVector position{JointVector::Zero(6)};
  JointVector velocity{JointVector::Zero(6)};
  std::uint8_t active{1};
  LinkStatus status{LinkStatus::Valid};
};

struct RobotArmLead : ::testing::Test {
  Flown flown;
  testing::Rig::Partner leader;
  Told told;
  bool speaks{true};
  bool tells_places;
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});

  explicit RobotArmLead(bool places_told = true)
      : flown{model_of(std::string{folder} + "robot_arm.urdf"), places_told ? house() : by_speeds()},
        tells_places{places_told} {}
  void SetUp() override {
    flown.plant.place(start);
    told.position = start;
    flown.rig.bring_to(State::PreOperational, 2);
    std::string outcome;
    leader = tells_places ? flown.rig.attach(1, pus::st128::Role::Consumer, "JOINT_POSITIONS", places, &outcome)
                          : flown.rig.attach(1, pus::st128::Role::Consumer, "JOINT_SPEEDS", speeds, &outcome);
    ASSERT_EQ(outcome, "1 3 7") << ::testing::PrintToString(flown.rig.explanations);
    cycle(5);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = flown.rig.set_state(state);
      cycle(5);
      ASSERT_EQ(flown.rig.outcome(request), "1 3 7") << ::testing::PrintToString(flown.rig.explanations);
    }
    ASSERT_EQ(flown.rig.inhibited(), 0u);
  }
  void say() {
    std::vector<std::byte> payload((tells_places ? 12 : 6) * sizeof(double) + 1);
    OctetWriter writer{payload, std::endian::little};
    if (tells_places)
      for (const double each : told.position) writer.put(each);
    for (const double each : told.velocity) writer.put(each);
    writer.put(told.active);
    leader.writer.write(payload, flown.rig.clock.now(), told.status);
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      if (speaks) say();
      flown.cycle();
    }
  }
  std::string asked(const char* function) {
    const auto request = flown.rig.call(function);
    cycle(3);
    return flown.rig.outcome(request);
  }
  [[nodiscard]] JointVector place() const { return flown.plant.measured().position; }
  [[nodiscard]] double speed() const { return flown.plant.measured().velocity.cwiseAbs().maxCoeff(); }
  /// It has come to rest, holds, and its actuators were never taken away.
  void holds() {
    cycle(1500);
    const JointVector there = place();
    cycle(500);
    EXPECT_LT(flown.off(there), 1e-3);
    EXPECT_LT(speed(), 1e-2);
    EXPECT_EQ(flown.rig.inhibited(), 0u);
    EXPECT_EQ(flown.rig.state(), State::Operational);
  }
  /// Led by the first joint with 0.4 rad/s, for half a second.
  void follows() {
    ASSERT_EQ(asked("FOLLOW"), "1 3 7") << ::testing::PrintToString(flown.rig.explanations);
    told.velocity[0] = 0.4;
    for (int i = 0; i < 500; ++i) {
      told.position[0] += 0.4e-3;
      cycle();
    }
    ASSERT_GT(place()[0], start[0] + 0.1);
  }
};

TEST_F(RobotArmLead, GoesWhereItIsLedAndStandsWhereWhoeverLeadsItStands) {
  ASSERT_NO_FATAL_FAILURE(follows());
  EXPECT_NEAR(place()[0], told.position[0] - 0.4 * 0.1, 0.02) << "a tenth of a second behind";
  told.velocity.setZero();
  cycle(1500);
  EXPECT_LT(flown.off(told.position), 1e-3);
  EXPECT_EQ(flown.rig.events(lost) + flown.rig.events(let_go) + flown.rig.events(unfit), 0);
  const auto busy = flown.move_j(start);
  cycle(3);
  EXPECT_THAT(flown.rig.outcome(busy), StartsWith("1 4:0108")) << "who follows has no other motion";
  EXPECT_EQ(asked("HOLD"), "1 3 7");
  cycle(200);
  const auto motion = flown.move_j(start);
  for (int i = 0; i < 3000 && flown.rig.outcome(motion).find('7') == std::string::npos; ++i) cycle(5);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 5:0001 7");
}

/// Led upwards, against its weight, with more power than it may: it is not stopped on its way, but behind, and there in the end.
TEST_F(RobotArmLead, GoesSlowerForItsPowerAndIsNotStopped) {
  robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
  dynamics.set_gravity({0, 0, -9.81});
  dynamics.update({.q = start, .qd = JointVector::Zero(6)});
  robotics::Coordinates held;
  dynamics.bias(held);
  constexpr double led_rad_s = 0.6;
  const double limit_w = 0.6 * std::abs(held[1]) * led_rad_s;
  ASSERT_GT(limit_w, 10);
  const auto set = flown.ask("SET_POWER_LIMIT", {limit_w, 10'000});
  cycle(3);
  ASSERT_EQ(flown.rig.outcome(set), "1 3 7");
  ASSERT_EQ(asked("FOLLOW"), "1 3 7") << ::testing::PrintToString(flown.rig.explanations);
  double most_w = 0;
  const auto goes = [&] {
    cycle();
    const auto& measured = flown.plant.measured();
    most_w = std::max(most_w, measured.torque.cwiseProduct(measured.velocity).cwiseAbs().sum());
  };
  told.velocity[1] = -led_rad_s;
  for (int i = 0; i < 700; ++i) {
    told.position[1] -= led_rad_s * 1e-3;
    goes();
  }
  EXPECT_GT(place()[1], told.position[1] + 0.1) << "behind whoever leads";
  told.velocity.setZero();
  for (int i = 0; i < 6000; ++i) goes();
  EXPECT_LT(flown.off(told.position), 1e-3);
  EXPECT_LT(most_w, limit_w);
  EXPECT_GT(most_w, 0.2 * limit_w);
  EXPECT_EQ(flown.rig.events(1041) + flown.rig.events(lost) + flown.rig.events(unfit), 0);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST_F(RobotArmLead, BeginsWithoutAJumpAndOnlyWhereItIsLedNearToWhereItIs) {
  cycle(500);
  told.position[3] += 0.2;
  cycle(2);
  EXPECT_THAT(asked("FOLLOW"), StartsWith("1 4:8020"));
  told.position[3] = start[3] + 0.04;
  cycle(2);
  const JointVector commanded = flown.commanded;
  const auto request = flown.rig.call("FOLLOW");
  JointVector last = commanded;
  double steepest = 0;
  for (int i = 0; i < 1500; ++i) {
    cycle();
    steepest = std::max(steepest, (flown.commanded - last).cwiseAbs().maxCoeff());
    last = flown.commanded;
  }
  EXPECT_EQ(flown.rig.outcome(request), "1 3 7");
  EXPECT_LT(steepest, 2) << "N m from one cycle to the next";
  EXPECT_LT(flown.off(told.position), 1e-3) << "what was between them is gone";
}

TEST_F(RobotArmLead, IsRefusedWithoutAnybodyWhoLeadsAndWhereHeDoesNot) {
  told.active = 0;
  cycle(3);
  EXPECT_THAT(asked("FOLLOW"), StartsWith("1 4:8020"));
  told.active = 1;
  speaks = false;
  cycle(20);
  EXPECT_THAT(asked("FOLLOW"), StartsWith("1 4:8020"));
  EXPECT_EQ(flown.rig.inhibited(), 0u) << "and it goes on holding";
}

TEST_F(RobotArmLead, IsRefusedInAConfigurationInWhichNobodyLeads) {
  Flown alone{model_of(std::string{folder} + "robot_arm.urdf"), house()};
  alone.plant.place(start);
  alone.operate();
  const auto request = alone.rig.call("FOLLOW");
  alone.cycle(3);
  EXPECT_THAT(alone.rig.outcome(request), StartsWith("1 4:8020"));
}

/// What becomes of whoever leads, and what is told of it.
struct Ends {
  const char* what;
  std::uint16_t event;
  void (*become)(RobotArmLead&);
};
struct RobotArmLeadEnds : RobotArmLead, ::testing::WithParamInterface<Ends> {};

TEST_P(RobotArmLeadEnds, SlowsDownWithinItsLimitsAndHoldsAndFollowsAgainWhenItIsTold) {
  ASSERT_NO_FATAL_FAILURE(follows());
  GetParam().become(*this);
  const double fast = flown.plant.measured().velocity[0];
  cycle(12);
  EXPECT_EQ(flown.rig.events(GetParam().event), 1);
  EXPECT_NEAR(flown.plant.measured().velocity[0], fast, 0.1) << "it is not stopped at once";
  holds();
  EXPECT_EQ(flown.rig.events(GetParam().event), 1) << "once";
  EXPECT_EQ(flown.rig.events(lost) + flown.rig.events(let_go) + flown.rig.events(unfit), 1);
  // Who is there again leads again when somebody says so, not before.
  told = Told{.position = place()};
  speaks = true;
  cycle(5);
  told.position[0] -= 0.04;
  cycle(500);
  EXPECT_GT(flown.off(told.position), 0.03);
  EXPECT_EQ(asked("FOLLOW"), "1 3 7") << ::testing::PrintToString(flown.rig.explanations);
  cycle(1500);
  EXPECT_LT(flown.off(told.position), 1e-3);
}

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
INSTANTIATE_TEST_SUITE_P(
    Each, RobotArmLeadEnds,
    ::testing::Values(Ends{"Silent", lost, [](RobotArmLead& test) { test.speaks = false; }},
                      Ends{"Faulty", lost, [](RobotArmLead& test) { test.told.status = LinkStatus::Fault; }},
                      Ends{"LetsGo", let_go, [](RobotArmLead& test) { test.told.active = 0; }},
                      Ends{"NoPlace", unfit, [](RobotArmLead& test) { test.told.position[5] = no_number; }},
                      Ends{"NoVelocity", unfit, [](RobotArmLead& test) { test.told.velocity[5] = no_number; }},
                      Ends{"WithoutEnd", unfit, [](RobotArmLead& test) { test.told.position[2] = HUGE_VAL; }},
                      Ends{"OutOfRange", unfit, [](RobotArmLead& test) { test.told.position[1] = 9; }},
                      Ends{"TooFar", unfit, [](RobotArmLead& test) { test.told.position[0] += 0.6; }},
                      Ends{"TooFast", unfit, [](RobotArmLead& test) { test.told.velocity[4] = -20; }}),
    [](const auto& info) { return std::string{info.param.what}; });

TEST_F(RobotArmLead, HoldAndStopEndItAndSoDoesWhatItMeets) {
  ASSERT_NO_FATAL_FAILURE(follows());
  EXPECT_EQ(asked("HOLD"), "1 3 7");
  holds();
  told = Told{.position = place()};
  ASSERT_EQ(asked("FOLLOW"), "1 3 7");
  flown.outside[0] = 60;
  for (int i = 0; i < 200 && flown.rig.events(1025) == 0; ++i) cycle();
  EXPECT_EQ(flown.rig.events(1025), 1);
  flown.outside[0] = 0;
  holds();
  told = Told{.position = place()};
  cycle(3);
  ASSERT_EQ(asked("FOLLOW"), "1 3 7");
  const auto stop = flown.rig.call("STOP");
  cycle(500);
  EXPECT_EQ(flown.rig.outcome(stop), "1 3 7");
  EXPECT_EQ(flown.mode, DeviceMode::Off);
}

TEST_F(RobotArmLead, StandsBeforeItIsLedIntoItself) {
  JointVector folded = start;
  folded[2] = 2.6, folded[3] = 2.2, folded[4] = folded[5] = 0;
  ASSERT_EQ(asked("FOLLOW"), "1 3 7");
  constexpr int cycles = 6000;
  told.velocity = (folded - start) / (1e-3 * cycles);
  for (int i = 1; i <= cycles; ++i) {
    told.position = start + i * (folded - start) / cycles;
    cycle();
  }
  EXPECT_EQ(flown.rig.events(1026), 1);
  EXPECT_GT(flown.off(folded), 0.01) << "who may go on is within a milliradian of where it is led";
  EXPECT_EQ(flown.rig.events(unfit), 0);
  holds();
}

struct RobotArmLedWithSpeeds : RobotArmLead {
  RobotArmLedWithSpeeds() : RobotArmLead{false} {}
};

TEST_F(RobotArmLedWithSpeeds, GoesWithTheVelocitiesThatItIsToldAndStandsWithoutThem) {
  ASSERT_EQ(asked("FOLLOW"), "1 3 7");
  told.velocity[0] = -0.3;
  cycle(1000);
  EXPECT_NEAR(flown.plant.measured().velocity[0], -0.3, 0.02);
  told.velocity.setZero();
  holds();
  told.velocity[0] = -0.3;
  cycle(500);
  speaks = false;
  holds();
  EXPECT_EQ(flown.rig.events(lost), 1);
}

}  // namespace
}  // namespace hirosco
