// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/craft.hpp"

#include <utility>

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct CraftTest : PartsTest {
  static constexpr std::uint16_t nobody = 99;
  [[nodiscard]] std::vector<LogRecord> logged() { return store->read({.last = 100, .end = LogEnd::Oldest})->records; }
};

TEST_F(CraftTest, EachOfTheMissionIsAMemberInItsOrderAndTheSupervisorIsNone) {
  std::vector<std::uint16_t> apids;
  for (const Member& member : craft.members) apids.push_back(member.apid());
  EXPECT_THAT(apids, ElementsAre(arm, hand, camera));
  for (const std::uint16_t apid : {arm, hand, camera}) {
    ASSERT_NE(craft.member(apid), nullptr);
    EXPECT_EQ(craft.member(apid)->apid(), apid);
    EXPECT_EQ(std::as_const(craft).member(apid), craft.member(apid));
  }
  for (const std::uint16_t apid : {supervisor_apid, nobody}) {
    EXPECT_EQ(craft.member(apid), nullptr);
    EXPECT_EQ(std::as_const(craft).member(apid), nullptr);
  }
}

TEST_F(CraftTest, ItsMembersAreThoseOfItsOwnMissionAndNotOfTheOneThatItWasMadeOf) {
  for (const Member& member : craft.members)
    EXPECT_EQ(&member.described(), craft.mission.find_subsystem(member.apid()));
}

TEST_F(CraftTest, ItBeginsInTheInitialModeOfItsMissionAndNotOnItsWayToAnother) {
  auto other = parts_mission();
  other.initial_mode = "narrow";
  const Craft second{other, craft.platform, *this, guard, log, *this};
  ASSERT_NE(second.mode, nullptr);
  EXPECT_EQ(second.mode->name, "narrow");
  EXPECT_EQ(second.mode, second.mission.find_mode("narrow")) << "of its own mission";
  EXPECT_EQ(second.changing_to, nullptr);
  EXPECT_EQ(craft.mode->name, "open");
}

TEST_F(CraftTest, EverybodyHasANameTheSupervisorTooAndWhoIsUnknownANumber) {
  EXPECT_EQ(craft.name_of(hand), "HAND");
  EXPECT_EQ(craft.name_of(supervisor_apid), "SUPERVISOR");
  EXPECT_EQ(craft.name_of(nobody), "APID 99");
}

TEST_F(CraftTest, TheGroundLinkIsWhoTheMissionSaysAndMayBeNobody) {
  EXPECT_EQ(craft.ground_link(), craft.member(camera));
  EXPECT_TRUE(craft.is_ground_link(*craft.member(camera)));
  EXPECT_FALSE(craft.is_ground_link(*craft.member(arm)));
  craft.mission.ground.subsystem = "ARM";
  EXPECT_EQ(craft.ground_link(), craft.member(arm));
  craft.mission.ground.subsystem.clear();
  EXPECT_EQ(craft.ground_link(), nullptr);
}

TEST_F(CraftTest, WhatItTellsStandsInTheLogAsAnActionAboutWhomItIsAndIsHeard) {
  craft.tell("HAND is warm", hand);
  craft.tell("it is late");
  EXPECT_THAT(story, ElementsAre("HAND is warm", "it is late"));
  const auto records = logged();
  ASSERT_EQ(records.size(), 2U);
  for (const LogRecord& record : records) {
    EXPECT_EQ(record.kind, LogKind::Action);
    EXPECT_EQ(record.source, supervisor_apid);
    EXPECT_THAT(record.packet, IsEmpty());
  }
  EXPECT_EQ(records[0].peer, hand);
  EXPECT_EQ(records[0].note.view(), "HAND is warm");
  EXPECT_EQ(records[1].peer, 0);
}

TEST_F(CraftTest, AFlightThatFailedStaysSo) {
  EXPECT_FALSE(craft.failed());
  craft.fail();
  craft.fail();
  EXPECT_TRUE(craft.failed());
}

TEST_F(CraftTest, WhatOutlivesItIsNotedAtOnceWhereSomebodyNotesAnything) {
  craft.remember();
  int noted = 0;
  craft.remembers = [&noted] { ++noted; };
  craft.remember();
  EXPECT_EQ(noted, 1);
}

}  // namespace
}  // namespace hirosco::supervisor
