// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Devices on a network: what the mission names is permitted, everything else is not (docs/adr/0112).
namespace hirosco::descriptor {
namespace {

using namespace testing;

constexpr std::string_view first = "<Supervisor";

/// The mission of the test data, with these elements in it, whose coronagraph has a device at another address.
Reading<Mission> with(const std::string& elements, const std::string& address, const std::string& transfer = "udp") {
  const std::string mission = file_system()(data / "mission.xml").value();
  const std::string robot = file_system()(data / "coronagraph.xml").value();
  const std::string now = changed("transfer=\"udp\" address=\"127.0.0.1:5001\"",
                                  "transfer=\"" + transfer + "\" address=\"" + address + "\"", robot);
  const auto source =
      overlay({{"mission.xml", changed(std::string{first}, elements + "\n" + std::string{first}, mission)},
               {"coronagraph.xml", now}});
  return read_mission(data / "mission.xml", source);
}
std::string code(const Reading<Mission>& reading) { return reading.problems.empty() ? "" : reading.problems[0].code; }
const std::string network = R"(<DeviceNetwork address="192.0.2.0/24"/>)";

TEST(MissionDeviceNetwork, PermitsTheDevicesInIt) {
  for (const char* transfer : {"udp", "tcp"}) {
    const auto reading = with(network, "192.0.2.7:5001", transfer);
    ASSERT_TRUE(reading.value) << code(reading);
    EXPECT_EQ(words_of(reading.value->device_networks), "192.0.2.0/24");
  }
  EXPECT_TRUE(with(R"(<DeviceNetwork address="2001:db8::/64" interface="eth1"/>)", "[2001:db8::7]:5001").value);
}

TEST(MissionDeviceNetwork, NothingElseLeavesThisComputer) {
  EXPECT_EQ(code(with("", "192.0.2.7:5001")), "E0313");
  EXPECT_EQ(code(with("", "192.0.2.7:5001", "tcp")), "E0313");
  EXPECT_EQ(code(with(network, "192.0.3.7:5001")), "E0313");
  EXPECT_EQ(code(with(network, "[2001:db8::7]:5001")), "E0313");
  EXPECT_EQ(code(with(network, "arm.example.org:5001")), "E0313") << "what a name means is another computer's word";
  const auto reading = with(network, "192.0.3.7:5001");
  EXPECT_EQ(reading.problems[0].file, data / "coronagraph.xml");
  EXPECT_GT(reading.problems[0].at.line, 1);
  EXPECT_NE(reading.problems[0].hint.find("<DeviceNetwork"), std::string::npos);
}

TEST(MissionDeviceNetwork, IsANetworkOfTheCraftsOwn) {
  for (const char* address : {"192.0.2.7", "192.0.2.1/24", "0.0.0.0/0", "127.0.0.0/8", "192.0.2.0/24%eth1", "lan"}) {
    const auto reading = with(std::string{R"(<DeviceNetwork address=")"} + address + "\"/>", "127.0.0.1:5001");
    EXPECT_EQ(code(reading), "E0347") << address;
  }
  EXPECT_EQ(code(with(R"(<DeviceNetwork address="192.0.2.0/24" interface="no name"/>)", "127.0.0.1:5001")), "E0347");
  EXPECT_EQ(code(with(network + network, "127.0.0.1:5001")), "E0347") << "twice";
  EXPECT_EQ(code(with("<DeviceNetwork/>", "127.0.0.1:5001")), "E0105");
}

TEST(MissionDeviceNetwork, ThatStandsBehindWhoNeedsItIsReadAsWell) {
  const std::string mission = file_system()(data / "mission.xml").value();
  const std::string robot = file_system()(data / "coronagraph.xml").value();
  const auto reading = read_mission(data / "mission.xml",
                                    overlay({{"mission.xml", changed("</Mission>", network + "</Mission>", mission)},
                                             {"coronagraph.xml", changed("127.0.0.1:5001", "192.0.2.7:5001", robot)}}));
  EXPECT_TRUE(reading.value) << code(reading);
}

}  // namespace
}  // namespace hirosco::descriptor
