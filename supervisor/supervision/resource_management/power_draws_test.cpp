// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_draws.hpp"

#include <algorithm>
#include <limits>

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

/// What ARM draws, and HAND with it where the test says so, CAMERA measures: a structure with nothing but that.
struct PowerDrawsTest : PartsTest {
  static constexpr std::uint16_t told_by = 4801;
  static constexpr double claim_w = 60;  ///< of ARM, in its second configuration
  static descriptor::Mission drawn(std::vector<std::uint16_t> of, std::string_view plan = {}) {
    auto made = parts_mission();
    descriptor::PowerDraw draw;
    draw.measured = {
        .name = "CAMERA.LOAD", .age = 1s, .apid = camera, .at = {.structure = told_by, .offset = 0, .octets = 10}};
    draw.of = std::move(of);
    draw.beyond_w = 5;
    draw.longer_than = 3s;
    made.power_draws = {draw};
    if (!plan.empty()) {
      descriptor::Plan answer;
      answer.name = plan;
      answer.event = "POWER_EXCEEDED";
      answer.steps = {{.kind = "set_state", .values = {static_cast<std::int64_t>(SafeOperational)}}};
      made.plans.push_back(answer);
    }
    return made;
  }
  explicit PowerDrawsTest(descriptor::Mission flown = drawn({arm})) : PartsTest{std::move(flown)} {}
  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    set(arm, Operational, 2);
    set(hand, PreOperational);
    parts.power.observe();
  }
  /// So much is measured for so long, twice in a second.
  void draws(double watts, Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end;) {
      std::array<std::byte, 10> data;
      OctetWriter writer{data};
      writer.put(told_by).put(watts);
      report(camera, 3, 25, data);
      wait(500ms);
      parts.draws.watch(clock.now());
    }
  }
  [[nodiscard]] long times_told(std::string_view text) const {
    return std::ranges::count_if(story, [&](const std::string& line) { return line.find(text) != std::string::npos; });
  }
  [[nodiscard]] long events() {
    own_step();
    return times_told("POWER_EXCEEDED");
  }
};

TEST_F(PowerDrawsTest, WhoDrawsNoMoreThanItClaimsAndWhatIsBesideThatIsNotNamed) {
  draws(claim_w + 5, 60s);
  EXPECT_EQ(events(), 0);
}

TEST_F(PowerDrawsTest, AnExcessIsToldOnceWithItsNameWhenItHasLastedLongEnough) {
  draws(claim_w + 6, 3s);
  EXPECT_EQ(events(), 0);
  draws(claim_w + 6, 1s);
  EXPECT_EQ(times_told("power: 66 W are drawn by ARM, 65 W may be: CAMERA.LOAD"), 1) << ::testing::PrintToString(story);
  draws(claim_w + 20, 60s);
  EXPECT_EQ(events(), 1);
}

TEST_F(PowerDrawsTest, AnExcessThatEndsBeforeItsTimeIsNone) {
  for (int times = 0; times < 20; ++times) {
    draws(200, 2500ms);
    draws(claim_w, 500ms);
  }
  EXPECT_EQ(events(), 0);
}

TEST_F(PowerDrawsTest, WhatEndsIsToldAndTheNextOneIsAnother) {
  draws(200, 5s);
  draws(claim_w, 1s);
  EXPECT_EQ(times_told("ARM again no more than claimed"), 1);
  draws(200, 5s);
  EXPECT_EQ(events(), 2);
}

TEST_F(PowerDrawsTest, WhoClaimsNothingMayDrawWhatIsBesideClaimsAlone) {
  set(arm, Offline);
  parts.power.observe();
  draws(5, 10s);
  EXPECT_EQ(events(), 0);
  draws(6, 5s);
  EXPECT_EQ(events(), 1);
}

TEST_F(PowerDrawsTest, WhatIsNotMeasuredIsNoExcessAndNoEndOfOne) {
  draws(200, 2500ms);
  wait(2s);
  parts.draws.watch(clock.now());
  draws(200, 2500ms);
  EXPECT_EQ(events(), 0) << "its time begins anew";
  draws(200, 2s);
  EXPECT_EQ(events(), 1);
  draws(std::numeric_limits<double>::quiet_NaN(), 5s);
  EXPECT_EQ(times_told("again"), 0);
  draws(200, 60s);
  EXPECT_EQ(events(), 1) << "it is the same";
}

TEST_F(PowerDrawsTest, OfSomebodyElseOrAnotherStructureNothingIsTaken) {
  std::array<std::byte, 10> data;
  OctetWriter writer{data};
  writer.put(told_by).put(500.0);
  for (int i = 0; i < 20; ++i) {
    report(hand, 3, 25, data);
    wait(500ms);
    parts.draws.watch(clock.now());
  }
  EXPECT_EQ(events(), 0);
}

TEST_F(PowerDrawsTest, WithoutAPlanForItNobodyIsStopped) {
  draws(200, 10s);
  EXPECT_FALSE(craft.member(arm)->recovery.going_down());
  EXPECT_FALSE(guard.fenced(arm));
}

struct PlannedDraws : PowerDrawsTest {
  PlannedDraws() : PowerDrawsTest{drawn({arm}, "rest")} {}
};

TEST_F(PlannedDraws, ThePlanOfTheMissionIsForWhoDrawsTooMuch) {
  draws(200, 10s);
  EXPECT_TRUE(was_told("ARM to SafeOperational because of POWER_EXCEEDED")) << ::testing::PrintToString(story);
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_FALSE(guard.fenced(hand));
}

struct TwoOnOneOutlet : PowerDrawsTest {
  TwoOnOneOutlet() : PowerDrawsTest{drawn({arm, hand})} {}
};

TEST_F(TwoOnOneOutlet, ClaimTogetherAndAreNamedTogether) {
  set(hand, SafeOperational);
  parts.power.observe();
  const double both_w = (parts.power.ledger().held_mw(arm) + parts.power.ledger().held_mw(hand)) * 1e-3;
  ASSERT_GT(both_w, claim_w);
  draws(both_w + 5, 10s);
  EXPECT_EQ(events(), 0);
  draws(both_w + 6, 5s);
  EXPECT_EQ(times_told("are drawn by ARM, HAND"), 1) << ::testing::PrintToString(story);
  EXPECT_EQ(events(), 2) << "an event for each";
}

}  // namespace
}  // namespace hirosco::supervisor
