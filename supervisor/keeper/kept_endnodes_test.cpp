// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/kept_endnodes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

descriptor::Device kept_device(std::string name, bool has_inhibit) {
  descriptor::Device made;
  made.name = std::move(name);
  if (has_inhibit) {
    made.enable.emplace();
    made.enable->transfer = Transfer::SharedMemory;
    made.enable->address = made.name + "-enable";
  }
  return made;
}

/// ARM (10) with two drives and a camera between them, LAMP (11) without a second inhibit, HAND (12) with a drive of the same name as ARM's.
descriptor::Mission craft_with_inhibits() {
  descriptor::Mission mission;
  const auto add = [&](const char* name, std::uint16_t apid, std::vector<descriptor::Device> devices) {
    descriptor::MissionSubsystem member;
    member.subsystem.name = name;
    member.subsystem.id = apid;
    member.subsystem.devices = std::move(devices);
    mission.subsystems.push_back(std::move(member));
  };
  add("ARM", 10, {kept_device("DRIVE", true), kept_device("CAMERA", false), kept_device("BRAKE", true)});
  add("LAMP", 11, {kept_device("BULB", false)});
  add("HAND", 12, {kept_device("DRIVE", true)});
  return mission;
}

TEST(KeptEndnodes, AreTheSecondInhibitsOfAllDevicesInTheOrderOfTheMission) {
  const auto kept = kept_endnodes(craft_with_inhibits());
  std::vector<std::string> names;
  for (const KeptEndnode& each : kept) names.push_back(std::to_string(each.apid) + " " + each.device);
  EXPECT_THAT(names, ElementsAre("10 DRIVE", "10 BRAKE", "12 DRIVE"));
  ASSERT_THAT(kept, SizeIs(3));
  EXPECT_EQ(kept[1].address.address, "BRAKE-enable");
  EXPECT_EQ(kept[1].address.transfer, Transfer::SharedMemory);
  EXPECT_EQ(kept[1].address.holder, FlowHolder::Supervisor) << "no subsystem holds its own second inhibit";
}

TEST(KeptEndnodes, BeyondThePlacesOfThePageNoneIsKept) {
  descriptor::Mission mission;
  mission.subsystems.resize(2);
  for (std::size_t i = 0; i < most_inhibits + 3; ++i)
    mission.subsystems[i < 3 ? 0 : 1].subsystem.devices.push_back(kept_device("D" + std::to_string(i), true));
  const auto kept = kept_endnodes(mission);
  ASSERT_THAT(kept, SizeIs(most_inhibits));
  EXPECT_EQ(kept.back().device, "D" + std::to_string(most_inhibits - 1)) << "the first are";
}

TEST(InhibitNotes, EachDeviceHasThePlaceInThePageThatTheKeeperLooksAtForIt) {
  const auto mission = craft_with_inhibits();
  const auto page = std::make_unique<KeeperPage>();
  const InhibitNotes notes{mission, *page};
  EXPECT_EQ(notes.of(10, "DRIVE"), &page->inhibits[0]);
  EXPECT_EQ(notes.of(10, "BRAKE"), &page->inhibits[1]);
  EXPECT_EQ(notes.of(12, "DRIVE"), &page->inhibits[2]) << "by its subsystem, too";
}

TEST(InhibitNotes, WhoIsNotKeptHasNoPlaceAndWithoutAKeeperNobodyHas) {
  const auto mission = craft_with_inhibits();
  const auto page = std::make_unique<KeeperPage>();
  const InhibitNotes notes{mission, *page};
  EXPECT_EQ(notes.of(10, "CAMERA"), nullptr);
  EXPECT_EQ(notes.of(11, "DRIVE"), nullptr);
  EXPECT_EQ(notes.of(12, "BRAKE"), nullptr);
  EXPECT_EQ(InhibitNotes{}.of(10, "DRIVE"), nullptr);
}

TEST(KeptEndnodes, FallBacksStandBehindAllThatIsPreferredAndGiveWayToThat) {
  auto mission = craft_with_inhibits();
  descriptor::Device& drive = mission.subsystems[0].subsystem.devices[0];
  drive.enable_terms.fall_backs.assign(2, *drive.enable);
  drive.enable_terms.fall_backs[1].address = "DRIVE-third";
  const auto kept = kept_endnodes(mission);
  ASSERT_THAT(kept, SizeIs(5));
  EXPECT_EQ(kept[2].way, 0U);
  EXPECT_EQ(kept[4].device, "DRIVE");
  EXPECT_EQ(kept[4].way, 2U);
  EXPECT_EQ(kept[4].address.address, "DRIVE-third");
  const auto page = std::make_unique<KeeperPage>();
  const InhibitNotes notes{mission, *page};
  EXPECT_EQ(notes.of(10, "DRIVE", 0), &page->inhibits[0]);
  EXPECT_EQ(notes.of(10, "DRIVE", 1), &page->inhibits[3]);
  EXPECT_EQ(notes.of(10, "DRIVE", 2), &page->inhibits[4]);
  EXPECT_EQ(notes.of(12, "DRIVE", 1), nullptr);
  for (std::size_t i = 0; i < most_inhibits; ++i)
    mission.subsystems[2].subsystem.devices.push_back(kept_device("D" + std::to_string(i), true));
  for (const KeptEndnode& each : kept_endnodes(mission)) EXPECT_EQ(each.way, 0U);
}

}  // namespace
}  // namespace hirosco::supervisor
