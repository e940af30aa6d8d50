// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/members/member_recovery.hpp"

#include <gtest/gtest.h>

#include <array>

namespace hirosco::supervisor {
namespace {

using enum descriptor::Severity;
constexpr std::array severities{Info, Low, Medium, High};

TEST(MemberRecovery, AtRestNothingRunsAndEveryEventMayBeginSomething) {
  const MemberRecovery rest;
  EXPECT_FALSE(rest.running());
  EXPECT_FALSE(rest.going_down());
  for (const auto severity : severities) EXPECT_FALSE(rest.outweighs(severity));
}

TEST(MemberRecovery, APlanOutweighsWhatIsAsGraveAsItselfOrLess) {
  for (const auto runs : severities) {
    MemberRecovery recovery;
    recovery.plan_begins(runs);
    EXPECT_TRUE(recovery.running());
    EXPECT_FALSE(recovery.going_down());
    for (const auto severity : severities) EXPECT_EQ(recovery.outweighs(severity), runs >= severity);
  }
}

TEST(MemberRecovery, APlanIsEndedByItsOwnEndAndByNoOther) {
  for (const auto runs : severities)
    for (const auto ended : severities) {
      MemberRecovery recovery;
      recovery.plan_begins(runs);
      recovery.plan_ended(ended);
      EXPECT_EQ(recovery.running(), ended != runs);
    }
}

TEST(MemberRecovery, TheEndOfAPlanThatSomethingWorseHasOverriddenEndsNothing) {
  MemberRecovery recovery;
  recovery.plan_begins(Medium);
  recovery.plan_begins(High);
  recovery.plan_ended(Medium);
  EXPECT_TRUE(recovery.outweighs(High));
  recovery.plan_ended(High);
  EXPECT_FALSE(recovery.running());
}

TEST(MemberRecovery, OnlyTheFirstReasonLeadsAMemberDown) {
  MemberRecovery recovery;
  recovery.plan_begins(Low);
  EXPECT_TRUE(recovery.goes_down());
  EXPECT_FALSE(recovery.goes_down());
  EXPECT_TRUE(recovery.going_down());
  EXPECT_TRUE(recovery.outweighs(High));
}

TEST(MemberRecovery, NoPlanEndsTheWayDownWhateverItsSeverity) {
  MemberRecovery recovery;
  ASSERT_TRUE(recovery.goes_down());
  for (const auto severity : severities) recovery.plan_ended(severity);
  EXPECT_TRUE(recovery.running());
  EXPECT_TRUE(recovery.going_down());
}

TEST(MemberRecovery, TheEndOfTheWayDownEndsAllAndTheNextReasonLeadsAgain) {
  MemberRecovery recovery;
  ASSERT_TRUE(recovery.goes_down());
  recovery.came_down();
  EXPECT_FALSE(recovery.running());
  EXPECT_FALSE(recovery.going_down());
  EXPECT_TRUE(recovery.goes_down());
}

TEST(MemberRecovery, ANewProcessBeginsWithNothing) {
  MemberRecovery planned, down;
  planned.plan_begins(High);
  ASSERT_TRUE(down.goes_down());
  for (MemberRecovery* each : {&planned, &down}) {
    each->started();
    EXPECT_FALSE(each->running());
    EXPECT_FALSE(each->going_down());
    each->came_down();  // the late end of what was begun with the last one
    EXPECT_FALSE(each->running());
  }
}

}  // namespace
}  // namespace hirosco::supervisor
