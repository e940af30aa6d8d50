// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_arguments.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

namespace hirosco::simulation {
namespace {

descriptor::Mission a_mission() {
  descriptor::Mission mission;
  auto& member = mission.subsystems.emplace_back();
  member.subsystem.name = "ARM";
  auto& device = member.subsystem.devices.emplace_back();
  device.name = "JOINTS";
  device.actuator = true;
  device.stop = descriptor::StopKind::Controlled;
  device.stop_within = std::chrono::milliseconds{200};
  device.enable.emplace();
  device.enable->transfer = Transfer::Unix;
  device.enable->address = "joints.enable";
  for (const auto sampling : {std::chrono::microseconds{2000}, std::chrono::microseconds{250}}) {
    auto& configuration = member.subsystem.configurations.emplace_back();
    configuration.name = sampling.count() == 250 ? "FAST" : "SLOW";
    configuration.sampling = sampling;
    auto& use = configuration.devices.emplace_back();
    use.endnode.transfer = Transfer::Udp;
    use.endnode.address = "joints";
    use.endnode.byte_order = descriptor::ByteOrder::Big;
  }
  auto& simulated = mission.devices.emplace_back();
  simulated.subsystem = "ARM";
  simulated.device = "JOINTS";
  return mission;
}

TEST(DeviceArguments, TakesByteOrderPeriodStopAndSecondInhibitFromTheDescriptor) {
  const auto mission = a_mission();
  const auto made = device_arguments(mission, mission.devices[0]);
  ASSERT_TRUE(made) << made.error();
  EXPECT_EQ(made->settings.byte_order, std::endian::big);
  EXPECT_EQ(made->settings.cycle, std::chrono::microseconds{250}) << "of the fastest configuration";
  EXPECT_EQ(made->settings.stop, SimulatedDevice::Stop::Controlled);
  EXPECT_EQ(made->settings.stop_within, std::chrono::milliseconds{200});
  ASSERT_TRUE(made->settings.enable);
  EXPECT_EQ(made->settings.enable->address, "joints.enable");
  EXPECT_EQ(made->address().address, "joints");
  const std::vector<std::string> expected{
      "--transfer",        "udp",  "--address",        "joints",       "--byte-order",     "big",
      "--cycle-us",        "250",  "--stop",           "controlled",   "--stop-within-ms", "200",
      "--enable-transfer", "unix", "--enable-address", "joints.enable"};
  EXPECT_EQ(made->arguments(), expected);
}

TEST(DeviceArguments, IsRefusedInWordsWhereConfigurationsDisagreeOrNoneUsesIt) {
  auto mission = a_mission();
  mission.subsystems[0].subsystem.configurations[1].devices[0].endnode.byte_order = descriptor::ByteOrder::Little;
  const auto different = device_arguments(mission, mission.devices[0]);
  ASSERT_FALSE(different);
  EXPECT_NE(different.error().find("SLOW and FAST"), std::string::npos) << different.error();
  for (auto& configuration : mission.subsystems[0].subsystem.configurations) configuration.devices.clear();
  EXPECT_FALSE(device_arguments(mission, mission.devices[0]));
  mission.devices[0].device = "NONE";
  EXPECT_FALSE(device_arguments(mission, mission.devices[0]));
}

}  // namespace
}  // namespace hirosco::simulation
