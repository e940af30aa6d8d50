// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/stop_number.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "supervisor/supervision/testing/small_mission.hpp"

/// The number by itself: who raises it, and what it voids, is in newest_stop_test.cpp.
namespace hirosco::supervisor {
namespace {

/// ARM has its page, HAND has none yet.
struct StopNumberTest : ::testing::Test {
  LocalFlows flows;
  descriptor::Mission mission = testing::small_mission();
  PermitPage page;
  GuardRoster guarded{flows, 1000, {}};
  StopNumber number{guarded};

  void SetUp() override {
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}}) {
      GuardedMember member;
      member.described = &mission.subsystems[at];
      if (at == 0) member.permit = &page;
      guarded.add(std::move(member));
    }
  }
};

TEST_F(StopNumberTest, StandsOnEachPageThatThereIsAsItRises) {
  EXPECT_EQ(number.newest(), StopNumber::no_stop_yet);
  for (std::uint32_t wanted = 2; wanted < 5; ++wanted) {
    number.next();
    EXPECT_EQ(number.newest(), wanted);
    EXPECT_EQ(page.newest_stop.load(), wanted);
  }
  number.put(17);
  EXPECT_EQ(number.newest(), 17u);
  EXPECT_EQ(page.newest_stop.load(), 17u);
}

TEST_F(StopNumberTest, IsNeverThatOfWhoKnowsOfNoneNorAsIfThereHadBeenNone) {
  number.put(std::numeric_limits<std::uint32_t>::max());
  number.next();
  EXPECT_EQ(number.newest(), StopNumber::no_stop_yet + 1);
}

TEST_F(StopNumberTest, IsWrittenAgainWhereAPageWasDamaged) {
  number.next();
  page.newest_stop = 4711;
  for (GuardedMember& member : guarded.members()) number.renew(member);
  EXPECT_EQ(page.newest_stop.load(), number.newest());
}

}  // namespace
}  // namespace hirosco::supervisor
