// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/joystick/joystick.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "hirosco/subsystem/testing/tried_functions.hpp"

namespace hirosco {
namespace {

using pus::st128::Role;

/// The test plays the handle, and the robot at the other end of the link.
struct JoystickTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/joystick/joystick.xml"};
  std::unique_ptr<Subsystem> joystick = make_joystick();
  testing::Rig rig{*joystick, descriptor::file_system()(file).value()};
  std::unique_ptr<DataFlow> handle =
      std::move(rig.flows.open({Transfer::SharedMemory, "joystick-handle"}, FlowSide::Device)).value();
  testing::Rig::Partner robot;
  std::array<double, 2> robot_torque_n_m{};
  bool robot_active{true};
  bool robot_speaks{true};
  std::array<double, 2> shown_n_m{};

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      if (robot.writer && robot_speaks) sample_robot();
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void sample_robot() {
    std::array<std::byte, 33> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(0.0).put(0.0).put(robot_torque_n_m[0]).put(robot_torque_n_m[1]);
    writer.put(static_cast<std::uint8_t>(robot_active ? 1 : 0));
    robot.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = handle->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    OctetReader reader{command.payload, std::endian::little};
    shown_n_m[0] = reader.get<double>();
    shown_n_m[1] = reader.get<double>();
    const std::array<std::byte, 34> at_rest{};
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = at_rest});
    static_cast<void>(handle->send(status.value()));
  }
  void command(State state) {
    const auto request = rig.set_state(state);
    cycle(5);
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  void operate(std::uint8_t configuration) {
    rig.bring_to(State::PreOperational, configuration);
    if (configuration == 2)
      robot = rig.attach(1, Role::Consumer, "ROBOT_STATE",
                         {{"POSITION", Type::Double, 2}, {"TORQUE", Type::Double, 2}, {"ACTIVE", Type::Uint8, 1}},
                         nullptr, 500us);
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
  }
  std::string now(std::string_view function, std::initializer_list<double> arguments = {}) {
    const auto request = rig.call(function, arguments);
    cycle(3);
    return rig.outcome(request);
  }
};

TEST_F(JoystickTest, StandaloneShowsTheCommandedTorque) {
  operate(1);
  EXPECT_EQ(now("DISPLAY_TORQUE", {0.5, -0.25}), "1 3 7");
  EXPECT_EQ(shown_n_m, (std::array{0.5, -0.25}));
  EXPECT_EQ(now("CENTRE"), "1 3 7");
  EXPECT_EQ(shown_n_m, (std::array{0.0, 0.0}));
}

TEST_F(JoystickTest, EachFunctionThatChangesAProtectionSaysSoInTheDescriptor) {
  operate(2);  // alone it shows no force that could be scaled or held back
  const testing::TriedFunctions functions{rig,
                                          [this] {
                                            command(State::SafeOperational);
                                            command(State::Operational);
                                          },
                                          [this] { cycle(5); }};
  EXPECT_THAT(functions.untold(), ::testing::IsEmpty());
  EXPECT_THAT(functions.idle(), ::testing::IsEmpty());
}

TEST_F(JoystickTest, WhatCanHaveNoEffectIsRefused) {
  operate(1);
  rig.fence();
  cycle(3);
  ASSERT_NE(rig.inhibited(), 0u);
  EXPECT_EQ(now("DISPLAY_TORQUE", {0.5, -0.25}).substr(0, 8), "1 4:8001");
  EXPECT_EQ(now("SET_HAND", {1}).substr(0, 8), "1 4:8001");
  EXPECT_EQ(now("HAND", {0.1, 0.1}).substr(0, 8), "1 4:8001");
}

TEST_F(JoystickTest, CoupledShowsTheRobotsTorqueAgainstTheHandAndScaled) {
  operate(2);
  robot_torque_n_m = {10.0, -5.0};
  cycle(10);
  EXPECT_NEAR(shown_n_m[0], -0.2, 1e-12);
  EXPECT_NEAR(shown_n_m[1], 0.1, 1e-12);
  EXPECT_EQ(now("DISPLAY_TORQUE", {0.5, 0.5}), "1 4:000f");
}

TEST_F(JoystickTest, ARobotThatIsNotActiveIsNotFelt) {
  operate(2);
  robot_torque_n_m = {10.0, 10.0};
  cycle(10);
  robot_active = false;
  cycle(10);
  EXPECT_EQ(shown_n_m, (std::array{0.0, 0.0}));
}

TEST_F(JoystickTest, ARobotThatFallsSilentLeavesTheHandWithoutForce) {
  operate(2);
  robot_torque_n_m = {10.0, 10.0};
  cycle(10);
  robot_speaks = false;
  cycle(12);
  EXPECT_EQ(shown_n_m, (std::array{0.0, 0.0}));
}

}  // namespace
}  // namespace hirosco
