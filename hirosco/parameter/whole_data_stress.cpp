// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// Requirement F11 at its full size; the default test does a hundredth of it.
#include <gtest/gtest.h>

#include <iostream>

#include "hirosco/parameter/testing/whole_data.hpp"

namespace hirosco::testing {
namespace {

TEST(WholeDataStress, NoneOfAHundredMillionIsTorn) {
  const WholeDataCount count = run_whole_data_load(100'000'000);
  std::cout << count.read << " read, " << count.torn << " torn, " << count.missed << " missed, " << count.written
            << " written, " << count.refused << " batches refused (queue full), " << count.cycles << " cycles\n";
  EXPECT_GE(count.read, 100'000'000u);
  EXPECT_EQ(count.torn, 0u);
  EXPECT_GT(count.written, count.cycles);
}

}  // namespace
}  // namespace hirosco::testing
