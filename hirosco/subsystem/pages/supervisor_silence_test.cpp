// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/pages/supervisor_silence.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

using namespace std::chrono_literals;

TEST(SupervisorSilence, HasALimitOfOneCycleAtLeastWhateverThePeriod) {
  EXPECT_EQ(supervisor_silence_cycles(Duration{0}), 1u);
  EXPECT_EQ(supervisor_silence_cycles(Duration{-5}), 1u);
  EXPECT_EQ(supervisor_silence_cycles(std::chrono::hours{1}), 1u);
}

TEST(SupervisorSilence, OfAPeriodThatOnlyTheRunKnowsIsReckonedToo) {
  const volatile Duration::rep none = 0;  // known to the compiler, a division by it could come to anything
  EXPECT_EQ(supervisor_silence_cycles(Duration{none}), 1u);
}

TEST(SupervisorSilence, CountsWhatPassesBetweenTwoLooksAsTheyAreMadeAndOfAPauseATenthOfTheLimit) {
  EXPECT_GT(most_silence_a_look, 10ms);
  EXPECT_EQ(most_silence_a_look * 10, supervisor_silence_limit);
}

TEST(SupervisorSilence, HasALimitOfTwoSecondsInWholeCyclesAndNotShorter) {
  EXPECT_EQ(supervisor_silence_cycles(1ms), 2000u);
  EXPECT_EQ(supervisor_silence_cycles(500us), 4000u);
  EXPECT_EQ(supervisor_silence_cycles(3ms), 667u);
  EXPECT_EQ(supervisor_silence_cycles(2s), 1u);
  EXPECT_EQ(supervisor_silence_cycles(2s - 1ns), 2u);
}

}  // namespace
}  // namespace hirosco
