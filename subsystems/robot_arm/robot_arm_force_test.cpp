// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "subsystems/robot_arm/testing/flown.hpp"
#include "subsystems/robot_arm/testing/sensing.hpp"

/// An arm with a sensor of force and moment at its tip (docs/adr/0179); the test is its device.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::Vector3;
using robot_arm::vector_of;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;

constexpr std::uint16_t joints_met = 1025, went_back = 1027, wrist_met = 1065, sensor_lost = 1066;

[[nodiscard]] std::string sensing() {
  std::string text = robot_arm::testing::with_force_sensor(robot_arm::testing::descriptor_text());
  replace_all(text, robot_arm::testing::self_test_required, "");
  replace_all(text, "value=\"robot_arm.urdf\"", "value=\"" + std::string{folder} + "robot_arm.urdf\"");
  return text;
}

/// Its frames end with six numbers of the sensor and their age.
struct Sensing : Flown {
  Vector3 force{Vector3::Zero()}, moment{Vector3::Zero()};  ///< in the tip's axes
  std::uint32_t age_ms{0};

  explicit Sensing(const std::string& descriptor_text)
      : Flown{model_of(std::string{folder} + "robot_arm.urdf"), descriptor_text} {}
  void exchange_once() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    OctetReader reader{command.payload, std::endian::little};
    std::vector<double> commanded_now;
    while (reader.remaining() > 0) commanded_now.push_back(reader.get<double>());
    const std::vector<double> told = play(commanded_now);
    std::vector<std::byte> payload(sizeof(double) * (told.size() + 6) + sizeof(std::uint32_t));
    OctetWriter writer{payload, std::endian::little};
    for (const double number : told) writer.put(number);
    for (const double number : force) writer.put(number);
    for (const double number : moment) writer.put(number);
    writer.put(age_ms);
    std::array<std::byte, max_device_frame_octets> answer{};
    static_cast<void>(
        device->send(write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload}).value()));
  }
  void fly(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange_once();
    }
    rig.service();
  }
  std::string asked(hirosco::testing::Sent request, int most = 6000) {
    while (rig.outcome(request).find_first_of("478") == std::string::npos && most-- > 0) fly(5);
    return rig.outcome(request);
  }
};

struct RobotArmForce : ::testing::Test {
  Sensing arm;
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});

  explicit RobotArmForce(const std::string& descriptor_text = sensing()) : arm{descriptor_text} {}
  void SetUp() override {
    arm.plant.place(start);
    arm.rig.bring_to(State::PreOperational, 1);
    arm.fly(5);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = arm.rig.set_state(state);
      arm.fly(5);
      ASSERT_EQ(arm.rig.outcome(request), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
    }
    ASSERT_EQ(arm.rig.inhibited(), 0u);
  }
  [[nodiscard]] robotics::Matrix3 turned(const JointVector& at) const {
    robotics::Dynamics dynamics{arm.model, robotics::Base::Fixed};
    dynamics.update({.q = at, .qd = JointVector::Zero(6)});
    return dynamics.frame_pose(arm.model.find_frame("tool").value()).rotation;
  }
  /// What such a force at the tool takes at the joints, there.
  [[nodiscard]] JointVector at_joints(const Vector3& force_n, const JointVector& at) const {
    robotics::Dynamics dynamics{arm.model, robotics::Base::Fixed};
    dynamics.update({.q = at, .qd = JointVector::Zero(6)});
    robotics::Jacobian jacobian;
    dynamics.jacobian(arm.model.find_frame("tool").value(), jacobian);
    return jacobian.bottomRows<3>().transpose() * force_n;
  }
};

TEST_F(RobotArmForce, EndsAMotionForLessThanItsJointsFeel) {
  const auto motion = arm.move_j(goal, 0.3);
  arm.fly(300);
  arm.force = {0, 31, 0};  // of a range of 100 N with a limit of 0.3
  arm.fly(2);
  EXPECT_EQ(arm.rig.events(wrist_met), 0) << "it has to last";
  arm.fly(5);
  EXPECT_EQ(arm.rig.events(wrist_met), 1);
  EXPECT_EQ(arm.rig.events(joints_met), 0);
  EXPECT_EQ(arm.rig.outcome(motion), "1 3 8:8004");
  arm.fly(500);
  const JointVector there = arm.plant.measured().position;
  arm.fly(500);
  EXPECT_LT(arm.off(there), 1e-3);
  EXPECT_EQ(arm.rig.events(wrist_met), 1) << "told once";
}

TEST_F(RobotArmForce, TakesOutWhatADeclaredLoadWeighsHoweverItIsTurned) {
  const auto taken = arm.rig.call_with("SET_PAYLOAD", {Value{2.0}, Value{0.0}, Value{0.0}, Value{0.1}});
  EXPECT_EQ(arm.asked(taken), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
  const Vector3 weight = turned(start).transpose() * Vector3{0, 0, -2 * 9.81};
  arm.force = weight;
  arm.moment = Vector3{0, 0, 0.1}.cross(weight);
  arm.fly(100);
  EXPECT_EQ(arm.rig.events(wrist_met), 0);
  arm.force *= 3;
  arm.fly(100);
  EXPECT_EQ(arm.rig.events(wrist_met), 1);
}

TEST_F(RobotArmForce, MovesUnderWhatStandsThereAndEndsForWhatComesToIt) {
  const Vector3 leans = {0, 0, -35};
  arm.force = turned(start).transpose() * leans;
  arm.fly(100);
  ASSERT_EQ(arm.rig.events(wrist_met), 1);
  const auto motion = arm.move_j(start + 0.01 * (goal - start), 0.3);
  EXPECT_EQ(arm.asked(motion), "1 3 5:0001 7");
  const auto next = arm.move_j(goal, 0.3);
  arm.fly(20);
  arm.force *= 2;
  arm.fly(20);
  EXPECT_EQ(arm.rig.outcome(next), "1 3 8:8004");
}

/// 35 of the range of 100 N or 10 N m stand there with a limit of 0.3, a motion begins with them, and they go away.
TEST_F(RobotArmForce, WhatStoodThereAndHasGoneIsBorneNoMore) {
  int told = 0;
  for (const bool turns : {false, true}) {
    const auto acts = [&](double share) {
      const Vector3 along = turned(start).transpose() * Vector3{0, 0, -share};
      arm.force = turns ? Vector3{Vector3::Zero()} : Vector3{100 * along};
      arm.moment = turns ? Vector3{10 * along} : Vector3{Vector3::Zero()};
    };
    acts(0.35);
    arm.fly(100);
    ASSERT_EQ(arm.rig.events(wrist_met), ++told) << turns;
    const auto motion = arm.move_j(start + (turns ? 0.02 : 0.01) * (goal - start), 0.3);
    ASSERT_EQ(arm.asked(motion), "1 3 5:0001 7") << turns;
    acts(0);
    arm.fly(20);
    acts(-0.1);
    arm.fly(20);
    EXPECT_EQ(arm.rig.events(wrist_met), told) << turns << ": from the other side nothing stood there";
    acts(0.35);
    arm.fly(20);
    EXPECT_EQ(arm.rig.events(wrist_met), ++told) << turns << ": who comes back is met";
    acts(0);
    arm.fly(20);
  }
}

/// It hangs there, a motion begins with it, and then it is said what it is: WRIST tells nothing of it from then on.
TEST_F(RobotArmForce, ALoadThatWasBorneIsBorneNoMoreOnceItIsDeclared) {
  constexpr double mass_kg = 3.6;
  const Vector3 weight{0, 0, -9.81 * mass_kg};
  const auto lifted_by = [&](double force_n) {
    arm.force = turned(start).transpose() * (weight + Vector3{0, 0, force_n});
  };
  lifted_by(0);
  arm.outside = at_joints(weight, start);
  arm.fly(100);
  ASSERT_EQ(arm.rig.events(wrist_met), 1);
  const auto motion = arm.move_j(start + 0.01 * (goal - start), 0.3);
  ASSERT_EQ(arm.asked(motion), "1 3 5:0001 7");
  const auto taken = arm.rig.call_with("SET_PAYLOAD", {Value{mass_kg}, Value{0.0}, Value{0.0}, Value{0.0}});
  ASSERT_EQ(arm.asked(taken), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
  arm.fly(50);
  lifted_by(10);
  arm.fly(20);
  EXPECT_EQ(arm.rig.events(wrist_met), 1) << "a third of the limit";
  lifted_by(40);
  arm.fly(20);
  EXPECT_EQ(arm.rig.events(wrist_met), 2);
  EXPECT_EQ(arm.rig.events(joints_met), 0);
}

TEST_F(RobotArmForce, FallsBackToWhatItsJointsFeelWhenItIsLostAndSaysSo) {
  const auto motion = arm.move_j(goal, 0.3);
  arm.fly(100);
  arm.age_ms = 21;
  arm.force = {0, 90, 0};
  arm.fly(100);
  EXPECT_EQ(arm.rig.events(sensor_lost), 1);
  EXPECT_EQ(arm.rig.events(wrist_met), 0) << "old numbers stop nobody";
  EXPECT_EQ(arm.rig.outcome(motion), "1 3");
  arm.outside[0] = 60;
  for (int i = 0; i < 200 && arm.rig.events(joints_met) == 0; ++i) arm.fly();
  EXPECT_EQ(arm.rig.events(joints_met), 1);
  arm.outside[0] = 0;
  EXPECT_EQ(arm.rig.inhibited(), 0u);
  arm.age_ms = 0;
  arm.force[1] = std::numeric_limits<double>::quiet_NaN();
  arm.fly(10);
  EXPECT_EQ(arm.rig.events(wrist_met), 0) << "what is no number is none";
  EXPECT_EQ(arm.rig.events(sensor_lost), 1) << "it was not back";
  arm.force.setZero();
  arm.fly(10);
  arm.age_ms = 500;
  arm.fly(10);
  EXPECT_EQ(arm.rig.events(sensor_lost), 2) << "each time";
}

/// Goes back by 0.3 rad from whoever it meets, which of a motion with 0.4 of the velocities is some two thirds of what it has come. Wrist and joints feel one push after
/// another: the wrist after three cycles, the joints behind the filter of what acts from outside.
struct RobotArmForceGoesBack : RobotArmForce {
  JointVector met_at;
  testing::Sent motion;

  RobotArmForceGoesBack() : RobotArmForce{going_back()} {}
  [[nodiscard]] static std::string going_back() {
    std::string text = sensing();
    replace_all(text, R"(init="0.1" minimum="0.01" maximum="0.5")", R"(init="0.3" minimum="0.01" maximum="0.5")");
    return text;
  }
  void SetUp() override {
    ASSERT_NO_FATAL_FAILURE(RobotArmForce::SetUp());
    const auto set = arm.rig.call_with("SET_CONTACT", {Value{Number{std::uint8_t{3}}}, Value{0.3}});
    ASSERT_EQ(arm.asked(set), "1 3 7");
    motion = arm.move_j(goal, 0.4);
    arm.fly(660);  // 60 of which its way is judged in
    ASSERT_EQ(arm.rig.events(wrist_met) + arm.rig.events(joints_met), 0);
  }
  void at_wrist(double force_n) { arm.force = {0, force_n, 0}; }
  /// Of the first joint; the motion leads it to less, and back to more.
  void at_joint(double torque_n_m) { arm.outside[0] = torque_n_m; }
  void lets_go() { at_wrist(0), at_joint(0); }
  /// Once more.
  void is_told(std::uint16_t event) {
    const int before = arm.rig.events(event);
    for (int i = 0; i < 90 && arm.rig.events(event) == before; ++i) arm.fly();
    ASSERT_EQ(arm.rig.events(event), before + 1);
    if (met_at.size() == 0) met_at = arm.plant.measured().position;
  }
  /// How far the first joint has gone back once it stands: of the whole way that is 1 / 1.2, since another one has the farthest.
  [[nodiscard]] double gone_back() {
    for (int i = 0; i < 5000 && arm.rig.events(went_back) == 0; ++i) arm.fly();
    EXPECT_EQ(arm.rig.events(went_back), 1);
    arm.fly(500);
    const JointVector there = arm.plant.measured().position;
    arm.fly(200);
    EXPECT_LT(arm.off(there), 1e-3);
    EXPECT_EQ(arm.rig.events(went_back), 1);
    EXPECT_EQ(arm.rig.outcome(motion), "1 3 8:8004");
    EXPECT_EQ(arm.rig.inhibited(), 0u);
    return there[0] - met_at[0];
  }
  static constexpr double whole_way = 0.25, far_less = 0.1;
};

TEST_F(RobotArmForceGoesBack, TheWholeWayThoughItsJointsFeelLaterWhatItsWristHasFelt) {
  at_wrist(35), at_joint(60);
  ASSERT_NO_FATAL_FAILURE(is_told(wrist_met));
  ASSERT_NO_FATAL_FAILURE(is_told(joints_met));
  lets_go();
  EXPECT_NEAR(gone_back(), whole_way, 0.03);
  EXPECT_EQ(arm.rig.events(wrist_met), 1);
  EXPECT_EQ(arm.rig.events(joints_met), 1);
}

TEST_F(RobotArmForceGoesBack, TheWholeWayThoughItsWristFeelsLaterWhatItsJointsHaveFelt) {
  at_joint(60);
  ASSERT_NO_FATAL_FAILURE(is_told(joints_met));
  at_wrist(35);
  ASSERT_NO_FATAL_FAILURE(is_told(wrist_met));
  lets_go();
  EXPECT_NEAR(gone_back(), whole_way, 0.03);
}

/// Who has told of the first one is heard about the next one at once, though the other has had its say about the first meanwhile.
TEST_F(RobotArmForceGoesBack, AndStandsWhenItsWristMeetsAnotherOneAtOnce) {
  at_wrist(35), at_joint(60);
  ASSERT_NO_FATAL_FAILURE(is_told(wrist_met));
  ASSERT_NO_FATAL_FAILURE(is_told(joints_met));
  lets_go();
  arm.fly(2);
  at_wrist(-35);
  ASSERT_NO_FATAL_FAILURE(is_told(wrist_met));
  lets_go();
  EXPECT_LT(gone_back(), far_less);
}

TEST_F(RobotArmForceGoesBack, AndStandsWhenItsJointsMeetAnotherOneAtOnce) {
  at_joint(60);
  ASSERT_NO_FATAL_FAILURE(is_told(joints_met));
  at_wrist(35);
  ASSERT_NO_FATAL_FAILURE(is_told(wrist_met));
  at_wrist(0), at_joint(-50);
  ASSERT_NO_FATAL_FAILURE(is_told(joints_met));
  lets_go();
  EXPECT_LT(gone_back(), far_less);
}

/// A tenth of a second behind the first one it is another one, whoever feels it.
TEST_F(RobotArmForceGoesBack, AndStandsForWhatItsJointsMeetLongBehindWhatItsWristHasMet) {
  at_wrist(35);
  ASSERT_NO_FATAL_FAILURE(is_told(wrist_met));
  lets_go();
  arm.fly(120);
  at_joint(-50);
  ASSERT_NO_FATAL_FAILURE(is_told(joints_met));
  lets_go();
  EXPECT_LT(gone_back(), far_less);
}

}  // namespace
}  // namespace hirosco
