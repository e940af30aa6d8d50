// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/processor_share.hpp"

#include <gtest/gtest.h>

namespace hirosco {
namespace {

TEST(ProcessorShare, IsOfAWholeWindowAndOfWhatWasHadInIt) {
  ProcessorShare share;
  const TimePoint start{5s};
  EXPECT_FALSE(share.look(700ms, start)) << "what it had before is nobody's to judge";
  EXPECT_FALSE(share.look(1200ms, start + 999ms));
  EXPECT_EQ(share.look(1200ms, start + 1s), 50U);
  EXPECT_FALSE(share.look(1300ms, start + 1500ms));
  EXPECT_EQ(share.look(4200ms, start + 3s), 150U)
      << "of one processor, on several; a window is as long as it was looked at late";
}

TEST(ProcessorShare, OfTimeThatRunsBackwardsIsNothing) {
  ProcessorShare share;
  EXPECT_FALSE(share.look(2s, TimePoint{0s}));
  EXPECT_EQ(share.look(1s, TimePoint{1s}), 0U);
}

}  // namespace
}  // namespace hirosco
