// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/telecommand/origin.hpp"

#include <gtest/gtest.h>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::hand;

constexpr std::uint16_t nobodys = 99, highest = 0xFFFF;

struct OriginTest : ::testing::Test {
  const descriptor::Mission mission = testing::small_mission();
};

TEST_F(OriginTest, IsOneKindWithItsApidAndOfTheGroundItsClient) {
  const Origin ground = Origin::ground(3), member = Origin::subsystem(hand), own = Origin::supervisor();
  EXPECT_TRUE(ground.is_ground() && !ground.is_subsystem() && !ground.is_supervisor());
  EXPECT_TRUE(member.is_subsystem() && !member.is_ground() && !member.is_supervisor());
  EXPECT_TRUE(own.is_supervisor() && !own.is_ground() && !own.is_subsystem());
  EXPECT_EQ(ground.apid(), 0);
  EXPECT_EQ(ground.client(), 3);
  EXPECT_EQ(Origin::ground().client(), 0);
  EXPECT_EQ(member.apid(), hand);
  EXPECT_EQ(member.client(), 0);
  EXPECT_EQ(own.apid(), pus::supervisor_apid);
}

TEST_F(OriginTest, OnBoardEachOwnsItsOwnSourceIdAndNoOther) {
  for (const std::uint16_t source : {std::uint16_t{0}, pus::supervisor_apid, arm, hand, nobodys, highest}) {
    EXPECT_EQ(Origin::subsystem(hand).owns(source, mission), source == hand) << source;
    EXPECT_EQ(Origin::supervisor().owns(source, mission), source == pus::supervisor_apid) << source;
  }
}

TEST_F(OriginTest, TheGroundOwnsAllThatAreNobodysOnBoardWhicheverItsClient) {
  for (const std::uint16_t client : {std::uint16_t{0}, arm, std::uint16_t{3}})
    for (const std::uint16_t source : {std::uint16_t{0}, pus::supervisor_apid, arm, hand, nobodys, highest}) {
      const bool on_board = source == pus::supervisor_apid || source == arm || source == hand;
      EXPECT_EQ(Origin::ground(client).owns(source, mission), !on_board) << source << " of client " << client;
    }
}

TEST_F(OriginTest, OfASourceIdIsWhoOwnsIt) {
  EXPECT_TRUE(Origin::of(pus::supervisor_apid, mission).is_supervisor());
  EXPECT_TRUE(Origin::of(arm, mission).is_subsystem());
  for (const std::uint16_t source : {std::uint16_t{0}, pus::supervisor_apid, arm, hand, nobodys, highest})
    EXPECT_TRUE(Origin::of(source, mission).owns(source, mission)) << source;
  EXPECT_EQ(Origin::of(arm, mission).apid(), arm);
  EXPECT_TRUE(Origin::of(nobodys, mission).is_ground());
}

}  // namespace
}  // namespace hirosco::supervisor
