// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_releases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "supervisor/supervision/testing/handshakes_rig.hpp"

/// Beside those of a link that a handshake made, in link_handshakes_test.cpp.
namespace hirosco::supervisor {
namespace {

using testing::arm;
using ::testing::ElementsAre;
using testing::hand;
using ::testing::IsEmpty;
using testing::LinkWitness;
using enum LinkReleases::Released;

/// Link 2 from HAND to ARM, which both hold.
struct LinkReleasesTest : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  LinkGraph graph{mission};
  LinkWitness supervisor;
  LinkReleases releases{mission, graph, supervisor};
  std::vector<LinkReleases::Released> ended;
  TimePoint now{1s};

  void SetUp() override {
    graph.set_up(2, true);
    releases.begin(2, [this](LinkReleases::Released how) { ended.push_back(how); });
  }
};

TEST_F(LinkReleasesTest, TellTheConsumerFirst) {
  EXPECT_THAT(supervisor.take(), ElementsAre("10<-4", "11<-4"));
  EXPECT_TRUE(releases.under_way(2));
  EXPECT_THAT(releases.links(), ElementsAre(2));
}

TEST_F(LinkReleasesTest, TellNobodyWhoHasLetGo) {
  graph.let_go(2, arm);
  supervisor.take();
  LinkReleases again{mission, graph, supervisor};
  again.begin(2, {});
  EXPECT_THAT(supervisor.take(), ElementsAre("11<-4"));
}

TEST_F(LinkReleasesTest, EndWhenNobodyHoldsTheLink) {
  graph.let_go(2, arm);
  releases.end_those_let_go();
  EXPECT_THAT(ended, IsEmpty());
  graph.let_go(2, hand);
  releases.end_those_let_go();
  EXPECT_THAT(ended, ElementsAre(ByBoth));
  EXPECT_FALSE(releases.under_way(2));
}

TEST_F(LinkReleasesTest, EndWithTheNextStepWhenWhoHoldsOnRefuses) {
  graph.let_go(2, arm);
  releases.refused(2, arm);
  releases.step(now);
  EXPECT_THAT(ended, IsEmpty()) << "it has nothing left to let go of";
  releases.refused(2, hand);
  EXPECT_THAT(ended, IsEmpty());
  releases.step(now);
  EXPECT_THAT(ended, ElementsAre(Refused));
}

TEST_F(LinkReleasesTest, EndInTimeWhenSomebodySaysNothing) {
  releases.step(now);
  releases.step(now + LinkOperator::answer_limit);
  EXPECT_THAT(ended, IsEmpty());
  releases.step(now + LinkOperator::answer_limit + 1ns);
  EXPECT_THAT(ended, ElementsAre(Unanswered));
}

}  // namespace
}  // namespace hirosco::supervisor
