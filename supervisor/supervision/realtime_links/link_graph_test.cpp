// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

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
  void let_go(std::uint8_t link, int apid) { graph.let_go(link, static_cast<std::uint16_t>(apid)); }
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

/// 11 and 12 need each other, 13 needs 12, 12 needs nothing of 13.
TEST_F(LinkGraphTest, WhoIsToGoOnWithoutASetIsNotTakenDownNorAnybodyBehindIt) {
  descriptor::Mission said = mission;
  said.links[0].on_loss = descriptor::OnLoss::Hold;  // 11 -> 12
  said.links[2].on_loss = descriptor::OnLoss::Ignore;  // 12 -> 13
  LinkGraph telling{said};
  for (const std::uint8_t link : std::initializer_list<std::uint8_t>{1, 2, 3}) telling.set_up(link, true);
  EXPECT_THAT(telling.taken_down_with(11), ElementsAre(11));
  EXPECT_THAT(telling.links_out_of({11}), ElementsAre(1));
  EXPECT_THAT(telling.taken_down_with(12), ElementsAre(11, 12)) << "11 says nothing of its loss";
  EXPECT_THAT(telling.links_out_of({11, 12}), ElementsAre(3));
  EXPECT_THAT(telling.taken_down_with(13), ElementsAre(11, 12, 13)) << "12 goes down for it, and so does who needs 12";
  EXPECT_THAT(graph.taken_down_with(11), ElementsAre(11)) << "nothing is up here";
  for (const std::uint8_t link : std::initializer_list<std::uint8_t>{1, 2, 3}) graph.set_up(link, true);
  EXPECT_EQ(graph.taken_down_with(13), graph.network_of(13)) << "where nobody says anything it is the network";
}

TEST_F(LinkGraphTest, ALinkThatBothEndsLetGoOfSplitsItsNetwork) {
  graph.set_up(1, true);
  graph.set_up(2, true);
  graph.set_up(3, true);
  for (const int end : {12, 13}) let_go(3, end);
  EXPECT_THAT(graph.network_of(13), ElementsAre(13));
  EXPECT_THAT(graph.network_of(11), ElementsAre(11, 12));
  for (const int end : {12, 11}) let_go(1, end);
  EXPECT_THAT(graph.network_of(11), ElementsAre(11, 12));  // the other way still holds them together
}

TEST_F(LinkGraphTest, TheWordOfOneEndEndsTheUseOfALinkAndNotTheNetworkThatAFenceReaches) {
  for (const auto& [sayer, holder] : {std::pair{12, 13}, std::pair{13, 12}}) {
    graph.set_up(3, true);
    let_go(3, sayer);
    EXPECT_FALSE(graph.is_up(3));
    EXPECT_EQ(graph.up_count(), 0u);
    EXPECT_THAT(graph.links_of(12), IsEmpty());
    for (const int member : {12, 13}) EXPECT_THAT(network_of(member), ElementsAre(12, 13));
    const auto half = graph.half_held();
    ASSERT_EQ(half.size(), 1u);
    EXPECT_EQ(half[0].gone, sayer);
    EXPECT_EQ(half[0].holder, holder);
    graph.let_go(3, 14);
    let_go(3, sayer);
    EXPECT_THAT(network_of(12), ElementsAre(12, 13)) << "who is no end of it, or says it twice";
    let_go(3, holder);
    for (const int member : {12, 13}) EXPECT_THAT(network_of(member), ElementsAre(member));
    EXPECT_THAT(graph.half_held(), IsEmpty());
  }
}

TEST_F(LinkGraphTest, ALinkOfNoUseIsHeldByBothUntilTheySayOtherwise) {
  graph.set_up(4, true);
  graph.set_up(4, false);
  EXPECT_FALSE(graph.is_up(4));
  EXPECT_THAT(network_of(14), ElementsAre(14, 15));
}

TEST_F(LinkGraphTest, ALinkIsHeldAsLongAsOneEndHoldsIt) {
  for (const auto& [first, second] : {std::pair{12, 13}, std::pair{13, 12}}) {
    const auto holds = [&](int apid) { return graph.holds(3, static_cast<std::uint16_t>(apid)); };
    EXPECT_FALSE(graph.is_held(3));
    graph.set_up(3, true);
    EXPECT_TRUE(holds(first) && holds(second));
    EXPECT_FALSE(holds(11)) << "who is no end of it";
    let_go(3, first);
    EXPECT_FALSE(holds(first));
    EXPECT_TRUE(holds(second) && graph.is_held(3));
    let_go(3, second);
    EXPECT_FALSE(holds(second) || graph.is_held(3));
  }
  graph.set_up(3, true);
  graph.forget(3);
  EXPECT_FALSE(graph.is_held(3));
  EXPECT_FALSE(graph.is_held(9));
}

TEST_F(LinkGraphTest, WhoIsGoneIsJoinedToNobody) {
  for (const int link : {1, 3, 4}) graph.set_up(static_cast<std::uint8_t>(link), true);
  graph.let_go(1, 12);
  graph.forget_all_of(12);
  for (const int member : {11, 12, 13}) EXPECT_THAT(network_of(member), ElementsAre(member));
  EXPECT_THAT(network_of(14), ElementsAre(14, 15));
}

TEST_F(LinkGraphTest, ALinkThatIsMadeAnewIsHeldByBothAgain) {
  graph.set_up(3, true);
  graph.let_go(3, 12);
  graph.set_up(3, true);
  graph.let_go(3, 13);
  EXPECT_THAT(network_of(12), ElementsAre(12, 13));
  graph.let_go(3, 12);
  EXPECT_THAT(network_of(12), ElementsAre(12));
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
