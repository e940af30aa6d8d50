// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/epoch_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "supervisor/platform/test_folder.hpp"

namespace hirosco::supervisor {
namespace {

constexpr std::int64_t year_2020_s = 1'577'836'800 + onboard_epoch_to_unix_s;
[[nodiscard]] OnboardTime seconds_after_2020(std::int64_t s) {
  return OnboardTime{std::chrono::seconds{year_2020_s + s}};
}

struct EpochFileTest : ::testing::Test {
  TestFolder folder;
  std::filesystem::path path{folder.path() / "a" / "flight.epoch"};
};

TEST_F(EpochFileTest, AFirstFlightBeginsWithTheSecondsSince2020) {
  EXPECT_EQ(EpochFile{path}.first(seconds_after_2020(1000)).value(), 1000u);
}

TEST_F(EpochFileTest, AClockThatWasSetBackDoesNotBringOldEpochsBack) {
  const auto first = EpochFile{path}.first(seconds_after_2020(200'000'000)).value();
  const auto second = EpochFile{path}.first(seconds_after_2020(5)).value();
  EXPECT_GT(second, first);
}

TEST_F(EpochFileTest, WhatAFlightUsesBeyondItsReserveIsKeptToo) {
  EpochFile file{path};
  const auto first = file.first(seconds_after_2020(10)).value();
  for (std::uint32_t used = first; used < first + 100'000; used += 100) file.keep_above(used);
  EXPECT_GT(EpochFile{path}.first(seconds_after_2020(10)).value(), first + 99'900);
}

TEST_F(EpochFileTest, NumbersThatHaveRunOutAreRefused) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream{path} << 0xFFFF'FFFFu;
  EXPECT_EQ(EpochFile{path}.first(seconds_after_2020(10)).error().code, ErrorCode::OutOfRange);
}

}  // namespace
}  // namespace hirosco::supervisor
