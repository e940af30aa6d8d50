// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/manipulator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/subsystem/testing/tried_functions.hpp"

namespace hirosco {
namespace {

using pus::st128::Role;
using ::testing::ElementsAre;

/// The test plays the robot: it stays where it is put and has the torque and temperature it is given.
struct ManipulatorTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/manipulator/manipulator.xml"};
  std::unique_ptr<Subsystem> manipulator = make_manipulator();
  testing::Rig rig{*manipulator, descriptor::file_system()(file).value()};
  std::unique_ptr<DataFlow> robot =
      std::move(rig.flows.open({Transfer::SharedMemory, "manipulator-robot"}, FlowSide::Device)).value();
  testing::Rig::Partner joystick;
  std::array<double, 2> position_rad{-0.8, 1.6};
  std::array<double, 2> torque_n_m{};
  float temperature_deg_c{20.0F};
  DeviceMode mode{};

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      if (joystick.writer) sample_joystick();
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = robot->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    std::array<std::byte, 89> payload{};
    OctetWriter writer{payload, std::endian::little};
    const std::array<double, 2> still{};
    for (const auto& pair : {position_rad, still, position_rad, still, torque_n_m}) writer.put(pair[0]).put(pair[1]);
    writer.put(temperature_deg_c).put(temperature_deg_c).put(std::uint8_t{0});
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(robot->send(status.value()));
  }
  void sample_joystick() {
    std::array<std::byte, 33> payload{};
    joystick.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  }
  void command(State state) {
    const auto request = rig.set_state(state);
    cycle(5);
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  void operate(std::uint8_t configuration) {
    rig.bring_to(State::PreOperational, configuration);
    if (configuration == 2)
      joystick = rig.attach(1, Role::Consumer, "JOYSTICK_STATE",
                            {{"POSITION", Type::Double, 2}, {"VELOCITY", Type::Double, 2}, {"ENABLE", Type::Uint8, 1}},
                            nullptr, 500us);
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
    EXPECT_EQ(rig.inhibited(), 0u);
    EXPECT_EQ(mode, DeviceMode::Active);
  }
  std::string now(std::string_view function, std::initializer_list<double> arguments = {}) {
    const auto request = rig.call(function, arguments);
    cycle(3);
    return rig.outcome(request);
  }
};

TEST_F(ManipulatorTest, MoveToReportsHalfWayAndCompletesWhenTheArmIsMeasuredAtTheGoal) {
  operate(1);
  const auto request = rig.call("MOVE_TO", {-0.75, 1.55, 0.2});
  cycle(190);
  EXPECT_EQ(rig.outcome(request), "1 3");
  cycle(20);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001");
  cycle(200);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001") << "the time is over, the arm is not there";
  position_rad = {-0.754, 1.546};
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 7");
  EXPECT_EQ(rig.events(1001), 1);
}

TEST_F(ManipulatorTest, AMotionThatDoesNotArriveFailsInsteadOfCompletingByTime) {
  operate(1);
  const auto request = rig.call("MOVE_TO", {-0.75, 1.55, 0.2});
  cycle(400 + 2000 + 10);
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 8:8001");
  EXPECT_EQ(rig.events(1001), 0);
  EXPECT_EQ(rig.inhibited(), 0u) << "it holds where it is";
}

TEST_F(ManipulatorTest, AMotionFasterThanTheArmsLimitsIsRefused) {
  operate(1);
  EXPECT_EQ(now("MOVE_TO", {1.0, 1.6, 0.2}), "1 4:8002") << "1.8 rad take 3.375 s at 1 rad/s";
  EXPECT_EQ(now("MOVE_TO", {1.0, 1.6, 3.37}), "1 4:8002");
  EXPECT_EQ(now("MOVE_TO", {1.0, 1.6, 3.38}), "1 3");
}

TEST_F(ManipulatorTest, OneMotionAtATime) {
  operate(1);
  rig.call("MOVE_TO", {-0.7, 1.5, 1.0});
  EXPECT_EQ(now("HOME"), "1 4:0108");
}

TEST_F(ManipulatorTest, WhatCanHaveNoEffectIsRefused) {
  operate(1);
  torque_n_m = {0.0, 13.0};
  cycle(6);
  ASSERT_EQ(rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(now("MOVE_TO", {-0.7, 1.5, 1.0}), "1 4:8006");
  EXPECT_EQ(now("HOME"), "1 4:8006");
  EXPECT_EQ(now("HOLD"), "1 4:8006");
  EXPECT_EQ(now("HOOK_SPRING", {2}), "1 4:8006");
  EXPECT_EQ(now("RELEASE_SPRING"), "1 4:8006");
  command(State::SafeOperational);
  EXPECT_EQ(now("HOLD"), "1 4:000a04") << "nothing moves there that could be held";
}

TEST_F(ManipulatorTest, AMotionThatTheTorqueLimitEndsSaysSo) {
  operate(1);
  const auto request = rig.call("MOVE_TO", {-0.7, 1.5, 1.0});
  cycle(10);
  torque_n_m = {0.0, 13.0};
  cycle(6);
  EXPECT_EQ(rig.outcome(request), "1 3 8:8003");
}

/// What is set and not said is lost in a crash, and the arm moves again without it.
TEST_F(ManipulatorTest, EachFunctionThatChangesAProtectionSaysSoInTheDescriptor) {
  operate(1);
  const testing::TriedFunctions functions{rig,
                                          [this] {
                                            command(State::SafeOperational);
                                            command(State::Operational);
                                          },
                                          [this] { cycle(5); }};
  EXPECT_THAT(functions.untold(), ::testing::IsEmpty());
  EXPECT_THAT(functions.idle(), ::testing::IsEmpty());
}

TEST_F(ManipulatorTest, NewGainsAreReportedDoneWhenTheLawHasThem) {
  operate(1);
  const auto request = rig.call("SET_GAINS", {350, 24});
  cycle(150);
  EXPECT_EQ(rig.outcome(request), "1 3");
  EXPECT_EQ(now("SET_GAINS", {300, 24}), "1 4:0108");
  cycle(100);
  EXPECT_EQ(rig.outcome(request), "1 3 7") << "50 N m/rad at 500 a second";
}

TEST_F(ManipulatorTest, ATorqueLimitBelowThePresentLoadIsRefused) {
  operate(1);
  torque_n_m = {0.0, -6.0};
  cycle(3);
  EXPECT_EQ(now("SET_TORQUE_LIMIT", {6}), "1 4:8005");
  EXPECT_EQ(now("SET_TORQUE_LIMIT", {7}), "1 3 7");
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(ManipulatorTest, TemperatureLimitsAscend) {
  operate(1);
  EXPECT_EQ(now("SET_TEMP_LIMITS", {70, 55, 80}), "1 4:8007");
  EXPECT_EQ(now("SET_TEMP_LIMITS", {50, 50, 80}), "1 4:8007");
  EXPECT_EQ(now("SET_TEMP_LIMITS", {50, 60, 70}), "1 3 7");
  temperature_deg_c = 65;
  cycle(3);
  EXPECT_EQ(rig.events(1011), 1);
}

TEST_F(ManipulatorTest, HoldAndLeavingOperationalAbortTheMotion) {
  operate(1);
  const auto first = rig.call("MOVE_TO", {-0.7, 1.5, 1.0});
  cycle(10);
  EXPECT_EQ(now("HOLD"), "1 3 7");
  EXPECT_EQ(rig.outcome(first), "1 3 8:0204");
  const auto second = rig.call("MOVE_TO", {-0.7, 1.5, 1.0});
  cycle(10);
  command(State::SafeOperational);
  EXPECT_EQ(rig.outcome(second), "1 3 8:0204");
  EXPECT_EQ(mode, DeviceMode::Off);
}

TEST_F(ManipulatorTest, CoupledTheLinkOwnsTheSetpoint) {
  operate(2);
  EXPECT_EQ(now("MOVE_TO", {-0.7, 1.5, 1.0}), "1 4:000f");
  EXPECT_EQ(now("HOME"), "1 4:000f");
  EXPECT_EQ(now("HOLD"), "1 4:000f");
}

TEST_F(ManipulatorTest, TorqueAboveTheSoftLimitInhibitsAndIsReportedOnceWithJointValueAndLimit) {
  operate(1);
  torque_n_m = {1.0, -13.0};
  cycle(6);
  EXPECT_EQ(rig.inhibited(), inhibited_by_author);
  EXPECT_EQ(mode, DeviceMode::Off);
  cycle(20);
  EXPECT_EQ(rig.events(1020), 1);
  EXPECT_EQ(rig.events(1021), 0);
}

TEST_F(ManipulatorTest, TorqueAboveTheHardLimitIsTheWorseEvent) {
  operate(1);
  torque_n_m = {16.0, 0.0};
  cycle(10);
  EXPECT_EQ(rig.events(1021), 1);
  EXPECT_EQ(rig.events(1020), 0);
}

TEST_F(ManipulatorTest, TheHardLimitStaysOnWatchAfterTheSoftOneTripped) {
  operate(1);
  torque_n_m = {0.0, 13.0};
  cycle(6);
  ASSERT_EQ(rig.events(1020), 1);
  torque_n_m = {0.0, 16.0};
  cycle(6);
  EXPECT_EQ(rig.events(1021), 1) << "inhibited, and loaded further";
  EXPECT_EQ(rig.events(1020), 1);
}

TEST_F(ManipulatorTest, TheHardLimitIsOnWatchInSafeOperationalToo) {
  operate(1);
  command(State::SafeOperational);
  torque_n_m = {-16.0, 0.0};
  cycle(20);
  EXPECT_EQ(rig.events(1021), 1);
}

TEST_F(ManipulatorTest, OneDisturbedSampleStopsNothing) {
  operate(1);
  torque_n_m = {50.0, 0.0};
  cycle();
  torque_n_m = {};
  cycle(10);
  EXPECT_EQ(rig.inhibited(), 0u);
  EXPECT_EQ(mode, DeviceMode::Active);
}

TEST_F(ManipulatorTest, EachLevelOfTemperatureIsReportedOnceOnTheWayUp) {
  operate(1);
  for (const float value : {60.0F, 61.0F, 75.0F, 85.0F, 86.0F}) {
    temperature_deg_c = value;
    cycle(5);
  }
  EXPECT_EQ(rig.events(1010), 1);
  EXPECT_EQ(rig.events(1011), 1);
  EXPECT_EQ(rig.events(1012), 1);
}

}  // namespace
}  // namespace hirosco
