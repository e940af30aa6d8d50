// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/parameter/testing/whole_data.hpp"

namespace hirosco::testing {
namespace {

TEST(WholeData, NoneIsTornWithFiveWritersAndFiveReaders) {
  const WholeDataCount count = run_whole_data_load(1'000'000);
  EXPECT_GE(count.read, 1'000'000u);
  EXPECT_EQ(count.torn, 0u);
  EXPECT_GT(count.written, count.cycles) << "no batch of a writer was applied: nothing was tested";
}

TEST(WholeData, AStructureKnowsAWordOfAnotherStore) {
  for (std::size_t word = 0; word < 6; ++word) {
    Checked checked = Checked::made(1, 2);
    ASSERT_TRUE(checked.whole());
    checked.mixed[word] = Checked::made(1, 3).mixed[word];
    EXPECT_FALSE(checked.whole());
  }
}

TEST(WholeData, CatchesTheTwinWithoutASequence) {
  EXPECT_GT(torn_of<UnsequencedParameter>(500'000'000), 0u);
  EXPECT_EQ(torn_of<Parameter<Checked>>(100'000), 0u);
}

}  // namespace
}  // namespace hirosco::testing
