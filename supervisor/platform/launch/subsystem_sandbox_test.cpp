// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/subsystem_sandbox.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace hirosco::supervisor {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

descriptor::MissionSubsystem with_device(Transfer transfer, const char* address) {
  descriptor::MissionSubsystem made;
  made.subsystem.file = "/missions/arm.xml";
  made.subsystem.devices.resize(1);
  descriptor::Configuration configuration;
  descriptor::DeviceUse use;
  use.endnode.transfer = transfer;
  use.endnode.address = address;
  configuration.devices.push_back(use);
  made.subsystem.configurations.push_back(configuration);
  return made;
}

TEST(SubsystemSandbox, NamesItsProgramAndDescriptorsAndNothingToWriteButWhatItsDevicesNeed) {
  auto plain = with_device(Transfer::Udp, "127.0.0.1:5000");
  plain.subsystem.commands.resize(1);
  plain.subsystem.commands[0].file = "/missions/hand.xml";
  const Sandbox sandbox = sandbox_of(plain, "/opt/hirosco/bin/arm");
  EXPECT_THAT(sandbox.executable, Contains("/opt/hirosco/bin/arm"));
  EXPECT_THAT(sandbox.readable, Contains("/missions/arm.xml"));
  EXPECT_THAT(sandbox.readable, Contains("/missions/hand.xml"));
  EXPECT_THAT(sandbox.writable, ElementsAre("/dev/null"));
  EXPECT_THAT(sandbox.executable, Not(Contains("/usr/bin")));
}

TEST(SubsystemSandbox, OpensTheFolderThatADevicesTransferWritesTo) {
  EXPECT_THAT(sandbox_of(with_device(Transfer::SharedMemory, "arm"), "/bin/arm").writable,
              ElementsAre("/dev/null", "/dev/shm"));
  EXPECT_THAT(sandbox_of(with_device(Transfer::Unix, "/run/arm/socket"), "/bin/arm").writable,
              ElementsAre("/dev/null", "/run/arm"));
}

TEST(SubsystemSandbox, LetsReadWhatASettingOfADeviceNamesAsAFileAndNothingElseThatSettingsSay) {
  auto arm = with_device(Transfer::Udp, "127.0.0.1:5000");
  arm.subsystem.configurations[0].devices[0].settings = {
      {"MODEL_FILE", "../robots/arm.urdf", {}}, {"MODEL_NAME", "secret.txt", {}}, {"MAP_FILE", "/maps/all", {}}};
  const Sandbox sandbox = sandbox_of(arm, "/bin/arm");
  EXPECT_THAT(sandbox.readable, Contains("/robots/arm.urdf"));
  EXPECT_THAT(sandbox.readable, Contains("/maps/all"));
  EXPECT_THAT(sandbox.readable, Not(Contains("/missions/secret.txt")));
}

TEST(SubsystemSandbox, LetsReadTheMeshesBesideARobotsFileThatItNames) {
  const std::filesystem::path folder{::testing::TempDir()};
  std::ofstream{folder / "arm.urdf"}
      << "<robot><link><mesh filename='parts/a.stl'/><mesh filename='../b.stl'/></link></robot>";
  auto arm = with_device(Transfer::Udp, "127.0.0.1:5000");
  arm.subsystem.file = folder / "arm.xml";
  arm.subsystem.configurations[0].devices[0].settings = {{"MODEL_FILE", "arm.urdf", {}}};
  const Sandbox sandbox = sandbox_of(arm, "/bin/arm");
  EXPECT_THAT(sandbox.readable, Contains((folder / "arm.urdf").string()));
  EXPECT_THAT(sandbox.readable, Contains((folder / "parts/a.stl").string()));
  EXPECT_THAT(sandbox.readable, Not(Contains(::testing::HasSubstr("b.stl"))));
}

TEST(SubsystemSandbox, KnowsAScriptByItsFirstLine) {
  EXPECT_TRUE(is_script(HIROSCO_SOURCE_DIR "/tools/check_layers.py"));
  EXPECT_FALSE(is_script("/proc/self/exe"));
  EXPECT_FALSE(is_script("/no/such/program"));
}

TEST(SubsystemLimits, AreThoseOfItsDescriptor) {
  descriptor::Resources resources;
  EXPECT_FALSE(limits_of(resources).memory_octets);
  resources.most[static_cast<std::size_t>(descriptor::Resource::Memory)] = 8192;
  resources.most[static_cast<std::size_t>(descriptor::Resource::Descriptors)] = 40;
  EXPECT_EQ(limits_of(resources).descriptors, 40U);
}

}  // namespace
}  // namespace hirosco::supervisor
