// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/epoch_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "supervisor/platform/storage/testing/test_folder.hpp"

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
  std::uint32_t used = first;
  while (file.kept() < first + 200'000) file.keep_above(used += 10);
  EXPECT_GE(EpochFile{path}.first(seconds_after_2020(10)).value(), first + 200'000);
}

TEST_F(EpochFileTest, AnOrdinaryFlightWritesOnce) {
  EpochFile file{path};
  const auto first = file.first(seconds_after_2020(10)).value();
  const auto reserved = file.kept();
  std::filesystem::remove(path);
  for (std::uint32_t used = first; used < first + 30'000; ++used) file.keep_above(used);
  EXPECT_EQ(file.kept(), reserved);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(EpochFileTest, ADiskThatHangsOrFailsHoldsNobodyUpAndIsTriedAgain) {
  EpochFile file{path};
  const auto first = file.first(seconds_after_2020(10)).value();
  // Whoever writes a pipe waits for a reader.
  auto beside = path;
  beside += ".new";
  ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
  std::uint32_t used = first + 60'000;
  for (int i = 0; i < 1'000; ++i) file.keep_above(++used);
  EXPECT_LT(file.kept(), first + 66'000);
  std::string text;
  std::ifstream{beside} >> text;
  EXPECT_FALSE(text.empty());
  std::filesystem::remove(beside);
  while (file.kept() < first + 120'000) file.keep_above(++used);
  EXPECT_GT(EpochFile{path}.first(seconds_after_2020(10)).value(), first + 120'000);
}

TEST_F(EpochFileTest, WhoGoesOnIsHeldUpByNoDiskAndIsAboveWhatWasKept) {
  const auto first = EpochFile{path}.first(seconds_after_2020(10)).value();
  // Whoever writes a pipe waits for a reader.
  auto beside = path;
  beside += ".new";
  ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
  EpochFile file{path};
  const auto next = file.next(seconds_after_2020(11), first, std::chrono::hours{1});
  ASSERT_TRUE(next);
  EXPECT_GT(*next, first + 60'000);
  std::string text;
  std::ifstream{beside} >> text;  // its thread is still at it
  EXPECT_GT(std::stoul(text), *next) << text;
  std::filesystem::remove(beside);
}

TEST_F(EpochFileTest, SupervisorsThatFollowEachOtherWhileNothingCanBeKeptNeverUseAnEpochTwice) {
  const auto first = EpochFile{path}.first(seconds_after_2020(10)).value();
  // Nobody can make the file beside it any more.
  auto beside = path;
  beside += ".new";
  std::filesystem::create_directory(beside);
  std::uint32_t in_use = first;
  for (int death = 0; death < 5; ++death) {
    const auto next = EpochFile{path}.next(seconds_after_2020(11), in_use);
    ASSERT_TRUE(next);
    EXPECT_GT(*next, in_use + 4'000) << "what its guard has used since that was noted, too";
    in_use = *next + 100;
  }
}

TEST_F(EpochFileTest, WhoGoesOnIsAboveWhatWasNotedThoughTheDiskDoesNotSayWhatItHas) {
  std::filesystem::create_directories(path.parent_path());
  auto beside = path;
  beside += ".new";
  std::filesystem::create_directory(beside);  // nothing takes the place of what follows
  // Whoever reads a pipe waits for a writer.
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  constexpr std::uint32_t noted = 5'000;
  const auto next = EpochFile{path}.next(seconds_after_2020(10), noted, Duration{0});
  ASSERT_TRUE(next);
  EXPECT_GT(*next, noted + 4'000) << "what its guard has used since that was noted, too";
  std::ofstream{path} << "7\n";  // its thread is still at it
}

TEST_F(EpochFileTest, WhoGoesOnAfterOneThatHadNotedNothingIsAboveTheFile) {
  const auto first = EpochFile{path}.first(seconds_after_2020(10)).value();
  EXPECT_EQ(EpochFile{path}.next(seconds_after_2020(10), 0).value(), first + 65'536 + 1);
}

TEST_F(EpochFileTest, NumbersThatHaveRunOutAreRefused) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream{path} << 0xFFFF'FFFFu;
  EXPECT_EQ(EpochFile{path}.first(seconds_after_2020(10)).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(EpochFile{path}.next(seconds_after_2020(10), 0).error().code, ErrorCode::OutOfRange);
  std::filesystem::remove(path);
  EXPECT_EQ(EpochFile{path}.next(seconds_after_2020(10), 0xFFFF'FFFFu).error().code, ErrorCode::OutOfRange);
}

}  // namespace
}  // namespace hirosco::supervisor
