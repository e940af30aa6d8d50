// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/limits/two_of_three.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace hirosco::robotics {
namespace {

/// What it tells of each sample, 1 for true.
std::string told_of(std::string_view samples) {
  TwoOfThree rule;
  std::string told;
  for (const char sample : samples) told += rule.add(sample == '1') ? '1' : '0';
  return told;
}

TEST(TwoOfThree, TellsTheSecondWhetherItFollowsAtOnceOrAfterOneThatIsFine) {
  EXPECT_EQ(told_of("110000"), "011000");
  EXPECT_EQ(told_of("101000"), "001000");
  EXPECT_EQ(told_of("111100"), "011110");
}

TEST(TwoOfThree, TellsNothingOfOneAloneHoweverOftenItComes) {
  EXPECT_EQ(told_of("100100100"), "000000000");
  EXPECT_EQ(told_of("1"), "0") << "before the first sample all were fine";
}

/// Every sequence of eight, told once more by counting.
TEST(TwoOfThree, TellsOfEverySequenceWhatItsLastThreeSamplesAre) {
  constexpr unsigned length = 8;
  for (unsigned sequence = 0; sequence < 1U << length; ++sequence) {
    TwoOfThree rule;
    std::string samples(2, '0');
    for (unsigned i = 0; i < length; ++i) {
      const bool sample = (sequence >> i & 1) != 0;
      samples += sample ? '1' : '0';
      const int of_three = (samples[i] == '1' ? 1 : 0) + (samples[i + 1] == '1' ? 1 : 0) + (sample ? 1 : 0);
      ASSERT_EQ(rule.add(sample), of_three >= 2) << samples;
    }
  }
}

TEST(TwoOfThree, BeginsAnewWhenItForgets) {
  TwoOfThree rule;
  EXPECT_FALSE(rule.add(true));
  rule.forget();
  EXPECT_FALSE(rule.add(true));
  EXPECT_TRUE(rule.add(true));
}

}  // namespace
}  // namespace hirosco::robotics
