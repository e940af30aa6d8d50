// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/free_plant.hpp"
#include "subsystems/robot_arm/testing/sensing.hpp"

/// A floating arm with a sensor of force and moment at its tip (docs/adr/0235); the test is its device.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robotics::Vector3;
using ::testing::StartsWith;

/// Its frames end with six numbers of the sensor and their age.
struct FloatingArmFeels : ::testing::Test {
  static constexpr std::uint16_t joints_met = 2113, went_back = 2112, wrist_met = 2140, sensor_lost = 2141;
  const std::string done = "1 3 7";
  robot_arm::testing::FlownFree arm{
      robot_arm::testing::with_force_sensor_on_a_floating_base(robot_arm::testing::floating_descriptor())};
  Vector3 force{Vector3::Zero()};  ///< in the tip's axes
  std::uint32_t age_ms{0};
  const JointVector ready = robot_arm::vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});

  void SetUp() override {
    arm.plant.place(ready);
    arm.rig.bring_to(State::PreOperational, 1);
    fly(5);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = arm.rig.set_state(state);
      fly(5);
      ASSERT_EQ(arm.rig.outcome(request), done) << ::testing::PrintToString(arm.rig.explanations);
    }
    ASSERT_EQ(arm.rig.inhibited(), 0u);
  }
  void exchange_once() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = arm.device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    arm.mode = command.mode;
    OctetReader reader{command.payload, std::endian::little};
    std::vector<double> commanded;
    while (reader.remaining() > 0) commanded.push_back(reader.get<double>());
    const std::vector<double> told = arm.play(commanded);
    std::vector<std::byte> payload(sizeof(double) * (told.size() + 6) + sizeof(std::uint32_t));
    OctetWriter writer{payload, std::endian::little};
    for (const double number : told) writer.put(number);
    for (const double number : force) writer.put(number);
    for (int i = 0; i < 3; ++i) writer.put(0.0);
    writer.put(age_ms);
    std::array<std::byte, max_device_frame_octets> answer{};
    static_cast<void>(
        arm.device->send(write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload}).value()));
  }
  void fly(int count = 1) {
    for (int i = 0; i < count; ++i) {
      arm.rig.service();
      arm.rig.cycle();
      exchange_once();
    }
    arm.rig.service();
  }
  hirosco::testing::Sent ask(const char* function, std::initializer_list<double> numbers = {}) {
    const auto request = arm.rig.call(function, numbers);
    fly(3);
    return request;
  }
  void react_by(std::uint8_t reaction) {
    const auto request = arm.rig.call_with("SET_CONTACT", {Value{Number{reaction}}, Value{0.3}});
    fly(5);
    ASSERT_EQ(arm.rig.outcome(request), done);
  }
  hirosco::testing::Sent move_and_be_felt() {
    const auto motion = ask("MOVE_TOOL", {0.1, 0, 0, 8});
    fly(3500);
    EXPECT_EQ(arm.rig.outcome(motion), "1 3");
    force = {0, 0, 35};  // of 30 N; no joint feels it here
    fly(20);
    return motion;
  }
};

TEST_F(FloatingArmFeels, WithItsWristWhomNoJointFeelsAndStands) {
  const auto motion = move_and_be_felt();
  EXPECT_THAT(arm.rig.outcome(motion), StartsWith("1 3 8:800c"));
  EXPECT_EQ(arm.rig.events(wrist_met), 1);
  EXPECT_EQ(arm.rig.events(joints_met), 0);
  fly(1500);
  const JointVector there = arm.plant.measured().position;
  fly(500);
  EXPECT_LT(arm.off(there), 1e-3);
  EXPECT_EQ(arm.rig.inhibited(), 0u);
}

TEST_F(FloatingArmFeels, WithItsWristAndGoesBackByTheWayItCame) {
  ASSERT_NO_FATAL_FAILURE(react_by(3));
  const auto motion = move_and_be_felt();
  EXPECT_THAT(arm.rig.outcome(motion), StartsWith("1 3 8:800c"));
  force.setZero();
  fly(8000);
  EXPECT_EQ(arm.rig.events(went_back), 1);
  EXPECT_LT(arm.off(ready), 0.03);
}

TEST_F(FloatingArmFeels, NothingByASensorThatIsLostAndItsJointsWatchOn) {
  force = {0, 0, 10};
  fly(10);
  age_ms = 25;
  fly(10);
  EXPECT_EQ(arm.rig.events(sensor_lost), 1);
  force = {0, 0, 90};
  const auto motion = ask("MOVE_TOOL", {0.1, 0, 0, 8});
  fly(3000);
  EXPECT_EQ(arm.rig.events(wrist_met), 0);
  EXPECT_EQ(arm.rig.outcome(motion), "1 3");
  arm.plant.push_n = {-32, 0, 0};
  for (int i = 0; i < 200 && arm.rig.events(joints_met) == 0; ++i) fly();
  fly(20);
  EXPECT_EQ(arm.rig.events(joints_met), 1);
  EXPECT_THAT(arm.rig.outcome(motion), StartsWith("1 3 8:800c"));
}

/// One contact, as both feel it, is answered once: who goes back for it is not stopped by the other.
TEST_F(FloatingArmFeels, WithBothAndAnswersOnce) {
  ASSERT_NO_FATAL_FAILURE(react_by(3));
  const auto motion = ask("MOVE_TOOL", {0.1, 0, 0, 8});
  fly(3500);
  arm.plant.push_n = {-32, 0, 0};
  force = {0, 0, 35};
  for (int i = 0; i < 100 && arm.rig.events(joints_met) == 0; ++i) fly();
  arm.plant.push_n.setZero();
  force.setZero();
  EXPECT_EQ(arm.rig.events(wrist_met), 1);
  EXPECT_EQ(arm.rig.events(joints_met), 1);
  EXPECT_THAT(arm.rig.outcome(motion), StartsWith("1 3 8:800c"));
  fly(8000);
  EXPECT_EQ(arm.rig.events(went_back), 1) << "it went all the way";
  EXPECT_LT(arm.off(ready), 0.05);
}

}  // namespace
}  // namespace hirosco
