// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <bit>

#include "hirosco/utilities/os/life.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// What the guard does with the word that the system marks when a process ends. The test writes it as the system does.
namespace hirosco::supervisor {
namespace {

using namespace testing;

constexpr std::uint32_t waiters = 0x8000'0000, owner_died = 0x4000'0000;

struct EndsTest : GuardTest {
  void hold(std::uint16_t apid, std::uint32_t thread = 4711) {
    lives[apid].vital->life = thread | waiters;
    guard.life_changed(apid);
  }
  void end(std::uint16_t apid) {
    lives[apid].vital->life = waiters | owner_died;
    guard.life_changed(apid);
  }
  void let_move() {
    for (const std::uint16_t apid : {arm, hand, camera}) {
      cycling(apid);
      ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    }
  }
  [[nodiscard]] bool watched(std::uint16_t apid) const {
    const auto watched = guard.lives();
    return std::ranges::find(watched, apid, &Guard::WatchedLife::apid) != watched.end();
  }
};

TEST_F(EndsTest, WhoEndsIsFencedWithThoseThatFallWithIt) {
  for (const std::uint16_t apid : {arm, hand, camera}) hold(apid);
  let_move();
  guard.falls_with(arm, {arm, hand});
  end(arm);
  EXPECT_FALSE(may_move(arm));
  EXPECT_FALSE(may_move(hand));
  EXPECT_TRUE(may_move(camera));
  EXPECT_THAT(kinds(arm), ::testing::ElementsAre(GuardFinding::Kind::Ended));
}

TEST_F(EndsTest, WhoFallsWithItIsFencedThoughAnotherOfThemIsNobodyOfTheMission) {
  hold(arm);
  let_move();
  guard.falls_with(arm, {99, hand});
  end(arm);
  EXPECT_FALSE(may_move(arm));
  EXPECT_FALSE(may_move(hand));
}

TEST_F(EndsTest, TheWordOfOneThatIsForgottenSaysNothing) {
  hold(arm);
  guard.forget(arm);
  const auto fences = guard.fences(arm);
  end(arm);
  EXPECT_EQ(guard.fences(arm), fences);
  EXPECT_THAT(kinds(arm), ::testing::IsEmpty()) << "the supervisor has taken note of its end itself";
}

TEST_F(EndsTest, TheNewestWordOfWhoFallsCounts) {
  hold(arm);
  let_move();
  guard.falls_with(arm, {hand, camera});
  guard.falls_with(arm, {camera});
  end(arm);
  EXPECT_TRUE(may_move(hand));
  EXPECT_FALSE(may_move(camera));
}

TEST_F(EndsTest, WhoComesAliveStopsNobody) {
  let_move();
  guard.falls_with(arm, {arm, hand});
  hold(arm);
  EXPECT_TRUE(may_move(arm));
  EXPECT_TRUE(may_move(hand));
  EXPECT_TRUE(guard.take_findings().empty());
}

TEST_F(EndsTest, OfWhomNobodyHoldsTheWordNothingIsConcluded) {
  let_move();
  guard.life_changed(arm);
  EXPECT_TRUE(may_move(arm));
  EXPECT_TRUE(watched(arm));
}

TEST_F(EndsTest, EachChangeOfAHeldWordCountsAsTheEnd) {
  for (int bit = 0; bit < 32; ++bit) {
    start(arm);
    hold(arm);
    let_move();
    lives[arm].vital->life = (4711 | waiters) ^ (1U << bit);
    guard.life_changed(arm);
    EXPECT_FALSE(may_move(arm)) << bit;
    EXPECT_FALSE(watched(arm)) << "no word keeps a thread busy, bit " << bit;
    EXPECT_THAT(kinds(arm), ::testing::ElementsAre(GuardFinding::Kind::Ended)) << bit;
  }
}

TEST_F(EndsTest, AWordThatNamesNoThreadFirstIsNoLife) {
  for (const std::uint32_t word : {owner_died, waiters}) {
    start(arm);
    let_move();
    lives[arm].vital->life = word;
    guard.life_changed(arm);
    EXPECT_FALSE(may_move(arm)) << word;
    EXPECT_FALSE(watched(arm)) << word;
  }
}

TEST_F(EndsTest, TheEndIsFoundOnce) {
  hold(arm);
  end(arm);
  const auto fences = guard.fences(arm);
  lives[arm].vital->life = 12;
  guard.life_changed(arm);
  EXPECT_EQ(guard.fences(arm), fences);
  EXPECT_THAT(kinds(arm), ::testing::ElementsAre(GuardFinding::Kind::Ended));
}

TEST_F(EndsTest, ThoseThatFellWithAnEarlierProcessDoNotFallWithTheNextOne) {
  guard.falls_with(arm, {hand});
  guard.forget(arm);
  start(arm);
  hold(arm);
  let_move();
  end(arm);
  EXPECT_FALSE(may_move(arm));
  EXPECT_TRUE(may_move(hand));
}

TEST_F(EndsTest, AnEndThatNobodyHasTakenYetIsNotTheNextProcesss) {
  hold(arm);
  end(arm);
  guard.forget(arm);
  start(arm);
  EXPECT_TRUE(kinds(arm).empty());
}

TEST_F(EndsTest, WhoeverIsStartedOrForgottenIsToldToTheThreadThatWaits) {
  const std::uint32_t before = guard.changes().load();
  guard.forget(arm);
  EXPECT_NE(guard.changes().load(), before);
  EXPECT_FALSE(watched(arm));
  const std::uint32_t between = guard.changes().load();
  start(arm);
  EXPECT_NE(guard.changes().load(), between);
  EXPECT_TRUE(watched(arm));
}

TEST_F(EndsTest, WhoFellIsNotLetGoByAPermissionFromBefore) {
  hold(arm);
  cycling(hand);
  const auto seen = guard.fences(hand);
  guard.falls_with(arm, {hand});
  end(arm);
  EXPECT_FALSE(guard.release(hand, seen));
  EXPECT_FALSE(may_move(hand));
}

}  // namespace
}  // namespace hirosco::supervisor
