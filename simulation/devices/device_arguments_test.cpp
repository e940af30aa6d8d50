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
  EXPECT_TRUE(made->settings.actuator);
  EXPECT_EQ(made->settings.stop, SimulatedDevice::Stop::Controlled);
  EXPECT_EQ(made->settings.stop_within, std::chrono::milliseconds{200});
  ASSERT_TRUE(made->settings.enable);
  EXPECT_EQ(made->settings.enable->address, "joints.enable");
  EXPECT_EQ(made->address().address, "joints");
  const std::vector<std::string> expected{"--transfer",
                                          "udp",
                                          "--address",
                                          "joints",
                                          "--byte-order",
                                          "big",
                                          "--cycle-us",
                                          "250",
                                          "--stop",
                                          "controlled",
                                          "--stop-within-ms",
                                          "200",
                                          "--actuator",
                                          "--enable-transfer",
                                          "unix",
                                          "--enable-address",
                                          "joints.enable"};
  EXPECT_EQ(made->arguments(), expected);
}

/// The joints with a camera beside them, each by several ways.
descriptor::Mission several_endnodes() {
  auto mission = a_mission();
  descriptor::SubsystemDescriptor& arm = mission.subsystems[0].subsystem;
  arm.devices[0].name = "JOINTS.DRIVE";
  arm.devices[0].part_of = "JOINTS";
  descriptor::Device camera;
  camera.name = "JOINTS.IMAGE";
  camera.part_of = "JOINTS";
  arm.devices.insert(arm.devices.begin(), camera);
  const auto endnode = [](Transfer transfer, const char* address) {
    descriptor::Endnode made;
    made.transfer = transfer;
    made.address = address;
    return made;
  };
  for (auto& configuration : arm.configurations) {
    configuration.devices[0].device = 1;
    configuration.devices[0].fall_backs = {endnode(Transfer::Unix, "joints2")};
    descriptor::DeviceUse use;
    use.device = 0;
    use.endnode = endnode(Transfer::SharedMemory, "image");
    use.fall_backs = {endnode(Transfer::Unix, "image2"), endnode(Transfer::Unix, "image3")};
    configuration.devices.push_back(use);
  }
  arm.power_switches = {{"JOINTS", endnode(Transfer::Unix, "power"), {}}};
  return mission;
}

TEST(DeviceArguments, OneProgramPlaysAllEndnodesOfADeviceWithTheirFallBacksAndItsSwitch) {
  const auto mission = several_endnodes();
  const auto made = device_arguments(mission, mission.devices[0]);
  ASSERT_TRUE(made) << made.error();
  EXPECT_EQ(made->address().address, "joints") << "the one with the actuator drives its world";
  EXPECT_EQ(made->settings.endnode, "DRIVE");
  ASSERT_EQ(made->settings.fall_backs.size(), 1U);
  EXPECT_EQ(made->settings.fall_backs[0].address, "joints2");
  ASSERT_EQ(made->settings.further.size(), 1U);
  EXPECT_EQ(made->settings.further[0].name, "IMAGE");
  EXPECT_EQ(made->settings.further[0].addresses.size(), 3U);
  ASSERT_TRUE(made->settings.power);
  const std::vector<std::string> expected{"--fall-back", "unix=joints2",
                                          "--endnode",   "DRIVE",
                                          "--further",   "IMAGE,little,shared_memory=image,unix=image2,unix=image3",
                                          "--power",     "unix=power"};
  const auto words = made->arguments();
  ASSERT_GE(words.size(), expected.size());
  EXPECT_TRUE(std::equal(expected.rbegin(), expected.rend(), words.rbegin()));
}

TEST(DeviceArguments, TellADeviceThatIsNoActuatorNothingOfOne) {
  auto mission = a_mission();
  mission.subsystems[0].subsystem.devices[0].actuator = false;
  const auto made = device_arguments(mission, mission.devices[0]);
  ASSERT_TRUE(made) << made.error();
  EXPECT_FALSE(made->settings.actuator);
  EXPECT_EQ(std::ranges::count(made->arguments(), "--actuator"), 0);
}

TEST(DeviceArguments, OfTwoActuatorsInOneDeviceTheFirstDrivesItsWorldAndEachHasAStopAndASecondInhibitOfItsOwn) {
  auto mission = several_endnodes();
  descriptor::Device& image = mission.subsystems[0].subsystem.devices[0];
  image.actuator = true;
  image.stop = descriptor::StopKind::Hold;
  const auto made = device_arguments(mission, mission.devices[0]);
  ASSERT_TRUE(made) << made.error();
  EXPECT_EQ(made->settings.endnode, "IMAGE");
  EXPECT_EQ(made->address().address, "image");
  EXPECT_EQ(made->settings.stop, SimulatedDevice::Stop::Hold);
  EXPECT_FALSE(made->settings.enable);
  ASSERT_EQ(made->settings.further.size(), 1U);
  const auto& drive = made->settings.further[0];
  EXPECT_EQ(drive.name, "DRIVE");
  ASSERT_TRUE(drive.actuator);
  EXPECT_EQ(drive.actuator->stop, SimulatedDevice::Stop::Controlled);
  EXPECT_EQ(drive.actuator->stop_within, std::chrono::milliseconds{200});
  ASSERT_TRUE(drive.actuator->enable);
  EXPECT_EQ(drive.actuator->enable->address, "joints.enable");
  const auto words = made->arguments();
  const auto said = std::ranges::find(words, "--drive");
  ASSERT_NE(said, words.end());
  EXPECT_EQ(*(said + 1), "DRIVE,controlled,200,unix=joints.enable");
  EXPECT_EQ(*(said - 1), "DRIVE,big,udp=joints,unix=joints2") << "behind the endnode that it is of";
}

TEST(DeviceArguments, TellEachWayToSecondInhibitsAndToThePowerSwitch) {
  const auto by = [](const char* address) {
    descriptor::Endnode made;
    made.transfer = Transfer::Unix;
    made.address = address;
    return made;
  };
  for (const bool further : {false, true}) {
    auto mission = several_endnodes();
    descriptor::SubsystemDescriptor& arm = mission.subsystems[0].subsystem;
    arm.devices[1].enable_terms.fall_backs = {by("enable2"), by("enable3")};
    arm.power_switches[0].terms.fall_backs = {by("power2")};
    arm.devices[0].actuator = further;  // then it drives the world, and the joints are beside it
    const auto made = device_arguments(mission, mission.devices[0]);
    ASSERT_TRUE(made) << made.error();
    const auto words = made->arguments();
    const auto behind = [&](const char* word) {
      const auto at = std::ranges::find(words, word);
      return at != words.end() ? *(at + 1) : std::string{};
    };
    EXPECT_EQ(behind("--power-fall-back"), "unix=power2");
    EXPECT_EQ(behind("--enable-fall-back"), further ? "" : "unix=enable2");
    EXPECT_EQ(std::ranges::count(words, "--enable-fall-back"), further ? 0 : 2);
    EXPECT_EQ(behind("--drive"), further ? "DRIVE,controlled,200,unix=joints.enable,unix=enable2,unix=enable3" : "");
  }
}

TEST(DeviceArguments, TellTheDeviceTheFilesThatItsSettingsName) {
  auto mission = a_mission();
  auto& subsystem = mission.subsystems[0].subsystem;
  subsystem.file = "missions/arm.xml";
  auto& settings = subsystem.configurations[0].devices[0].settings;
  settings = {{"MODEL_FILE", "arm.urdf", {}}, {"GAIN", "3", {}}};
  const auto made = device_arguments(mission, mission.devices[0]);
  ASSERT_TRUE(made) << made.error();
  const std::map<std::string, std::string> expected{{"MODEL_FILE", "missions/arm.urdf"}};
  EXPECT_EQ(made->settings.files, expected);
  const auto words = made->arguments();
  ASSERT_GE(words.size(), 2U);
  EXPECT_EQ(words.back(), "MODEL_FILE=missions/arm.urdf");
  subsystem.configurations[1].devices[0].settings = {{"MODEL_FILE", "@hirosco/other.urdf", {}}};
  const auto different = device_arguments(mission, mission.devices[0]);
  ASSERT_FALSE(different);
  EXPECT_NE(different.error().find("MODEL_FILE"), std::string::npos) << different.error();
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
