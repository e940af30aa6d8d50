// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guard_findings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum GuardFinding::Kind;

TEST(FindingsOfTheGuard, AreTakenOnceInTheirOrderAndEachWakesWhoTakesThem) {
  int woken = 0;
  GuardFindings findings{[&] { ++woken; }};
  findings.find_out(CycleHangs, 10);
  findings.find_out(InhibitSilent, 11, 2);
  EXPECT_EQ(woken, 2);
  EXPECT_THAT(findings.take(), ElementsAre(GuardFinding{CycleHangs, 10, 0}, GuardFinding{InhibitSilent, 11, 2}));
  EXPECT_THAT(findings.take(), IsEmpty());
  findings.wake();
  EXPECT_EQ(woken, 3);
}

TEST(FindingsOfTheGuard, AreKeptWhereNobodyIsToBeWoken) {
  GuardFindings findings{{}};
  findings.find_out(Back, 10);
  findings.wake();
  EXPECT_THAT(findings.take(), ElementsAre(GuardFinding{Back, 10, 0}));
}

TEST(FindingsOfTheGuard, TellOfTheEndOfAProcessNoMoreWhenAnotherHasBegun) {
  GuardFindings findings{{}};
  for (const std::uint16_t apid : {std::uint16_t{10}, std::uint16_t{11}})
    for (const auto kind : {CycleHangs, Ended, Killed}) findings.find_out(kind, apid);
  findings.forget_end_of(10);
  EXPECT_THAT(findings.take(),
              ElementsAre(GuardFinding{CycleHangs, 10, 0}, GuardFinding{Killed, 10, 0}, GuardFinding{CycleHangs, 11, 0},
                          GuardFinding{Ended, 11, 0}, GuardFinding{Killed, 11, 0}));
}

TEST(FindingsOfTheGuard, ThatNobodyTakesAreToldOnceEachBehindTheFirstThousand) {
  constexpr std::size_t most = 1024;
  GuardFindings findings{{}};
  for (std::size_t i = 0; i < most + 100; ++i) findings.find_out(StopAsked, 0);
  for (int i = 0; i < 3; ++i) findings.find_out(CycleHangs, 10);
  const auto taken = findings.take();
  ASSERT_EQ(taken.size(), most + 1);
  EXPECT_EQ(taken[most - 1], (GuardFinding{StopAsked, 0, 0}));
  EXPECT_EQ(taken[most], (GuardFinding{CycleHangs, 10, 0}));
}

}  // namespace
}  // namespace hirosco::supervisor
