// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Subsystems 11 to 15, links 1: 11->12, 2: 12->11, 3: 12->13, 4: 14->15.
struct LinkGraphTest : ::testing::Test {
  descriptor::Mission mission = [] {
    descriptor::Mission made;
    for (std::uint16_t id = 11; id <= 15; ++id) {
      descriptor::MissionSubsystem member;
      member.subsystem.name.append(1, 'S').append(std::to_string(id));
      member.subsystem.id = id;
      made.subsystems.push_back(member);
    }
    const auto link = [&](std::uint8_t id, const char* from, const char* to, const char* set) {
      made.links.push_back({.id = id, .from = from, .provides = set, .to = to, .requires_ = set, .at = {}});
    };
    link(1, "S11", "S12", "A");
    link(2, "S12", "S11", "B");
    link(3, "S12", "S13", "C");
    link(4, "S14", "S15", "D");
    return made;
  }();
  LinkGraph graph{mission};
  [[nodiscard]] std::vector<std::uint16_t> network_of(int apid) const {
    return graph.network_of(static_cast<std::uint16_t>(apid));
  }
};

TEST_F(LinkGraphTest, BeginsWithEverythingDownAndEverybodyAlone) {
  EXPECT_EQ(graph.defined_count(), 4u);
  EXPECT_EQ(graph.up_count(), 0u);
  EXPECT_THAT(graph.network_of(12), ElementsAre(12));
  EXPECT_THAT(graph.links_of(12), IsEmpty());
}

TEST_F(LinkGraphTest, ANetworkIsWhateverIsConnectedWhicheverWayTheLinksPoint) {
  graph.set_up(1, true);
  graph.set_up(3, true);
  graph.set_up(4, true);
  for (const int member : {11, 12, 13}) EXPECT_THAT(network_of(member), ElementsAre(11, 12, 13));
  for (const int member : {14, 15}) EXPECT_THAT(network_of(member), ElementsAre(14, 15));
}

TEST_F(LinkGraphTest, ALinkThatGoesDownSplitsItsNetwork) {
  graph.set_up(1, true);
  graph.set_up(2, true);
  graph.set_up(3, true);
  graph.set_up(3, false);
  EXPECT_THAT(graph.network_of(13), ElementsAre(13));
  EXPECT_THAT(graph.network_of(11), ElementsAre(11, 12));
  graph.set_up(1, false);
  EXPECT_THAT(graph.network_of(11), ElementsAre(11, 12));  // the other way still holds them together
}

TEST_F(LinkGraphTest, LinksOfASubsystemAreThoseAtEitherEndThatAreUp) {
  graph.set_up(1, true);
  graph.set_up(3, true);
  EXPECT_THAT(graph.links_of(12), ElementsAre(1, 3));
  EXPECT_THAT(graph.links_of(13), ElementsAre(3));
  EXPECT_THAT(graph.links_of(14), IsEmpty());
}

TEST_F(LinkGraphTest, ARequiredSetKnowsItsLink) {
  EXPECT_EQ(graph.link_into(11, "B"), 2);
  EXPECT_EQ(graph.link_into(11, "A"), 0);
  EXPECT_EQ(graph.link_into(99, "B"), 0);
}

TEST_F(LinkGraphTest, OfTwoLinksIntoOneSetTheOneThatIsUpCounts) {
  mission.links.push_back({.id = 7, .from = "S13", .provides = "B", .to = "S11", .requires_ = "B", .at = {}});
  LinkGraph both{mission};
  EXPECT_EQ(both.link_into(11, "B"), 2);
  both.set_up(7, true);
  EXPECT_EQ(both.link_into(11, "B"), 7);
}

TEST_F(LinkGraphTest, UnknownLinksAreNeverUp) {
  graph.set_up(9, true);
  EXPECT_FALSE(graph.is_up(9));
  EXPECT_FALSE(graph.is_up(0));
  EXPECT_EQ(graph.up_count(), 0u);
}

}  // namespace
}  // namespace hirosco::supervisor
