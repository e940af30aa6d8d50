// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/joystick/joystick_device.hpp"

#include <gtest/gtest.h>

#include "simulation/devices/testing/bench.hpp"

namespace hirosco::simulation {
namespace {

using JoystickBench = Bench<JoystickDevice>;

TEST(JoystickDevice, ObeysTheHandAndItsMotors) {
  JoystickBench bench;
  ASSERT_TRUE(bench.device.hand("hold 0.1 -0.1"));
  for (int k = 0; k < 6000; ++k) {
    bench.command(DeviceMode::Active, 1, -0.215, 0);
    bench.step();
  }
  const auto status = bench.status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->payload.size(), JoystickDevice::sensor_octets);
  EXPECT_NEAR(status->value(0), 0.1 - 0.215 / 4.3, 1e-6);
  EXPECT_NEAR(status->value(1), -0.1, 1e-6);
  EXPECT_EQ(bench.device.injections().at(0).line, "hand hold 0.1 -0.1");
}

TEST(JoystickDevice, UnderstandsEveryHandLineAndRefusesOthers) {
  JoystickBench bench;
  for (const char* line : {"hold 0 0", "target 0.1 -0.4", "sine 1 0.15 0.5", "sine 2 0.15 0.5 1.57",
                           "ramp 0.065 0 0.04", "cartesian 0.0176 0 1", "wander"})
    EXPECT_TRUE(bench.device.hand(line)) << line;
  for (const char* line :
       {"", "target 0.1", "hold 0", "hold 2 0", "sine 3 0.1 1", "sine 1 0.1", "ramp 1 0 0.04", "ramp 0 0 0", "sit"})
    EXPECT_FALSE(bench.device.hand(line)) << line;
}

TEST(JoystickDevice, IsRefusedAtTheStartWithADeclaredStopThatItDoesNotHave) {
  LocalFlows flows;
  SimulatedDevice::Settings settings;
  settings.stop = SimulatedDevice::Stop::Controlled;
  settings.stop_within = std::chrono::milliseconds{200};
  JoystickDevice joystick{flows, {Transfer::SharedMemory, "joystick"}, settings};
  EXPECT_EQ(joystick.plug().error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hirosco::simulation
