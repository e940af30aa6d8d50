// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/under_way.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

struct UnderWayTest : PartsTest {
  UnderWay& under_way = parts.under_way;

  void SetUp() override {
    PartsTest::SetUp();
    start_all(SafeOperational);
  }
  /// The supervisor is on its way up, before all others.
  void commission() {
    parts.own.start(craft.mode_epoch);
    parts.commissioning.start([] {});
    own_step();
    ASSERT_TRUE(parts.commissioning.running());
  }
  /// HAND is on its way to what the narrow mode asks for.
  void change() {
    start_supervisor();
    craft.mission.modes[1].commission = {
        {.subsystem = "HAND", .configuration = "ONLY", .state = Operational, .at = {}}};
    EXPECT_EQ(call_own("SET_MODE", 2), "") << "it has begun";
    ASSERT_TRUE(parts.modes.running());
  }
};

TEST_F(UnderWayTest, WhereNothingIsThereIsNothingToEnd) {
  start_supervisor();
  EXPECT_FALSE(under_way.running());
  story.clear();
  EXPECT_EQ(under_way.cancel("a recovery"), Cancelled::Nothing);
  EXPECT_FALSE(was_told("stopped: a recovery"));
}

TEST_F(UnderWayTest, ACommissioningThatIsCancelledIsEndedForGood) {
  commission();
  EXPECT_TRUE(under_way.running());
  EXPECT_EQ(under_way.cancel("a recovery"), Cancelled::ForGood);
  EXPECT_TRUE(was_told("commissioning stopped: a recovery"));
  EXPECT_FALSE(under_way.running());
}

TEST_F(UnderWayTest, AChangeOfModeThatIsCancelledIsEndedAndTheFlightGoesOn) {
  change();
  EXPECT_TRUE(under_way.running());
  EXPECT_EQ(under_way.cancel("a recovery"), Cancelled::Ended);
  EXPECT_TRUE(was_told("the change to mode narrow stopped: a recovery"));
  EXPECT_EQ(craft.changing_to, nullptr);
  EXPECT_FALSE(under_way.running());
  EXPECT_FALSE(craft.failed());
}

TEST_F(UnderWayTest, AStopOfEverybodyEndsWhicheverItIs) {
  commission();
  under_way.all_stopped("SAFE_ALL");
  EXPECT_TRUE(was_told("commissioning stopped: SAFE_ALL"));
  EXPECT_FALSE(under_way.running());
}

TEST_F(UnderWayTest, AStopOfEverybodyEndsAChangeOfModeToo) {
  change();
  under_way.all_stopped("SAFE_ALL");
  EXPECT_TRUE(was_told("the change to mode narrow stopped: SAFE_ALL"));
  EXPECT_FALSE(under_way.running());
}

TEST_F(UnderWayTest, WhenEverybodyGoesDownNeitherGoesOn) {
  commission();
  under_way.drop();
  EXPECT_FALSE(under_way.running());
  for (int step = 0; step < 20; ++step) own_step();
  EXPECT_FALSE(parts.commissioning.succeeded());
}

TEST_F(UnderWayTest, WhenEverybodyGoesDownAChangeOfModeSaysWhy) {
  change();
  under_way.drop();
  EXPECT_TRUE(was_told("the change to mode narrow stopped: shutdown"));
  EXPECT_FALSE(under_way.running());
}

}  // namespace
}  // namespace hirosco::supervisor
