// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/kept.hpp"

#include <gtest/gtest.h>

#include <optional>

/// What the keeper holds so that it outlives the supervisor (docs/adr/0093).
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

// --- stops beside telecommands ---------------------------------------------------------------------------------------------

/// Whether a supervisor that came now would find a stop to carry out.
bool one_is_asked_for(KeeperPage& page) {
  return AskedStops{page}.carry_out([](bool any) { return any; });
}

TEST(AskedStops, OneIsAskedForUntilTheSupervisorHasNotedWhatItHeardOfIt) {
  KeeperPage page;
  AskedStops stops{page};
  EXPECT_FALSE(one_is_asked_for(page));
  stops.count();
  EXPECT_TRUE(one_is_asked_for(page)) << "counted, and its guard dies";
  const auto before = stops.carried_out();
  stops.carry_out([](bool any) { return any; });
  stops.taken(before);
  EXPECT_TRUE(one_is_asked_for(page)) << "that step had begun before the guard carried it out";
  stops.taken(stops.carried_out());
  EXPECT_FALSE(one_is_asked_for(page));
}

TEST(AskedStops, OneThatComesWhileAnotherIsCarriedOutStaysAskedFor) {
  KeeperPage page;
  AskedStops stops{page};
  stops.count();
  stops.carry_out([&](bool any) {
    stops.count();
    return any;
  });
  stops.taken(stops.carried_out());
  EXPECT_TRUE(one_is_asked_for(page)) << "whoever dies now, the next one stops all";
}

TEST(AskedStops, WhoFindsOneAndDiesBeforeItHasNotedThatLeavesItToTheNext) {
  KeeperPage page;
  AskedStops{page}.count();
  for (int death = 0; death < 3; ++death) EXPECT_TRUE(one_is_asked_for(page)) << death;
  AskedStops last{page};
  EXPECT_TRUE(last.carry_out([](bool any) { return any; }));
  last.taken(last.carried_out());
  EXPECT_FALSE(one_is_asked_for(page));
}

// --- another supervisor ---------------------------------------------------------------------------------------------------

TEST(Revivals, AtOnceTwiceAndThenAfterAPauseThatDoubles) {
  Revivals revivals;
  EXPECT_EQ(revivals.next(10s), 0s);
  EXPECT_EQ(revivals.next(100ms), 0s);
  EXPECT_EQ(revivals.next(100ms), 100ms);
  EXPECT_EQ(revivals.next(100ms), 200ms);
  EXPECT_EQ(revivals.next(100ms), 400ms);
  EXPECT_EQ(revivals.next(100ms), std::nullopt) << "a crash loop ends the flight";
}

TEST(Revivals, OneThatLivedLongEnoughBeginsTheCountAnew) {
  Revivals revivals;
  for (int i = 0; i < 300; ++i) EXPECT_EQ(revivals.next(Revivals::long_enough), 0s) << i;
}

// --- the second inhibit, noted ------------------------------------------------------------------------------------------

TEST(KeptInhibit, NoFlippedBitEnables) {
  KeptInhibit inhibit;
  inhibit.note(false, 0x1234, 5);
  ASSERT_FALSE(inhibit.enabled());
  for (unsigned bit = 0; bit < 64; ++bit) {
    inhibit.go.store(std::uint64_t{1} << bit);
    EXPECT_FALSE(inhibit.enabled()) << bit;
  }
  inhibit.note(true, 0x1234, 6);
  ASSERT_TRUE(inhibit.enabled());
  for (unsigned bit = 0; bit < 32; ++bit) {
    inhibit.epoch.store(0x1234U ^ (1U << bit));
    EXPECT_FALSE(inhibit.enabled()) << "under another epoch: " << bit;
  }
}

}  // namespace
}  // namespace hirosco::supervisor
