// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/modes.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

struct ModesTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(SafeOperational);
    start_supervisor();
  }
  static constexpr int narrow = 2;
};

TEST_F(ModesTest, AModeHoldsForAllFromTheSameMomentOn) {
  const std::uint32_t before = craft.mode_epoch;
  EXPECT_EQ(call_own("SET_MODE", narrow), "done");
  EXPECT_EQ(craft.mode->name, "narrow");
  EXPECT_GT(craft.mode_epoch, before) << "what was permitted in the last mode is void";
  for (auto& [apid, member] : played) EXPECT_EQ(member.permit->mode_epoch.load(), craft.mode_epoch) << apid;
  EXPECT_TRUE(was_told("mode narrow"));
}

TEST_F(ModesTest, AModeThatTheMissionDoesNotHaveChangesNothing) {
  const std::uint32_t before = craft.mode_epoch;
  EXPECT_EQ(call_own("SET_MODE", 9), to_text(pus::FailureCode::UnknownIdentifier));
  EXPECT_EQ(craft.mode->name, "open");
  EXPECT_EQ(craft.mode_epoch, before);
}

TEST_F(ModesTest, AModeWhoseMembersAreDeadIsRefusedUntilTheyLiveAgain) {
  craft.mission.modes[1].commission = {{.subsystem = "ARM", .configuration = "COUPLED", .state = Operational, .at = {}},
                                       {.subsystem = "HAND", .configuration = "ONLY", .state = Operational, .at = {}}};
  craft.member(hand)->died();
  EXPECT_EQ(call_own("SET_MODE", narrow), to_text(pus::FailureCode::WrongStatus));
  EXPECT_EQ(craft.mode->name, "open");
  parts.restarts.plan(hand, {.limit = 1, .within = 1s, .pause = 0s}, clock.now());
  parts.processes.watch(clock.now());
  EXPECT_EQ(call_own("SET_MODE", narrow), "done");
}

TEST_F(ModesTest, WhoIsStartedLaterIsInTheModeThatHoldsThen) {
  EXPECT_EQ(call_own("SET_MODE", narrow), "done");
  craft.member(hand)->died();
  parts.restarts.plan(hand, {.limit = 1, .within = 1s, .pause = 0s}, clock.now());
  parts.processes.watch(clock.now());
  EXPECT_EQ(played[hand].permit->mode_epoch.load(), craft.mode_epoch);
}

}  // namespace
}  // namespace hirosco::supervisor
