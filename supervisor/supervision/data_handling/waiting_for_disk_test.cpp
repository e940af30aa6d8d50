// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/waiting_for_disk.hpp"

#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

struct WaitingForDiskTest : ::testing::Test {
  WaitingForDisk waiting;
  void add(std::uint64_t number, Origin origin = Origin::ground(), TimePoint since = {}) {
    waiting.add(
        {.number = number, .apid = 10, .origin = origin, .packet = {}, .memory = {}, .request = {}, .since = since});
  }
  /// Number of the one that leaves; 0: none does.
  static std::uint64_t number(const std::optional<WaitingForDisk::Telecommand>& left) {
    return left ? left->number : 0;
  }
};

TEST_F(WaitingForDiskTest, LeavesWhenItsOwnRecordIsDurableAndNotBefore) {
  add(7);
  EXPECT_EQ(number(waiting.take_durable(6)), 0U);
  EXPECT_EQ(number(waiting.take_durable(7)), 7U);
  EXPECT_EQ(number(waiting.take_durable(7)), 0U);
}

TEST_F(WaitingForDiskTest, LeavesInTheOrderInWhichItCame) {
  for (const std::uint64_t each : {3U, 4U, 9U}) add(each);
  EXPECT_EQ(number(waiting.take_durable(8)), 3U);
  EXPECT_EQ(number(waiting.take_durable(8)), 4U);
  EXPECT_EQ(number(waiting.take_durable(8)), 0U);
  EXPECT_EQ(number(waiting.take()), 9U);
  EXPECT_EQ(number(waiting.take()), 0U);
}

TEST_F(WaitingForDiskTest, IsLateAtTheLimitAndNotBefore) {
  const TimePoint since{std::chrono::seconds{10}};
  add(1, Origin::ground(), since);
  add(2, Origin::ground(), since + Duration{1});
  EXPECT_EQ(number(waiting.take_late(since + WaitingForDisk::limit - Duration{1})), 0U);
  EXPECT_EQ(number(waiting.take_late(since + WaitingForDisk::limit)), 1U);
  EXPECT_EQ(number(waiting.take_late(since + WaitingForDisk::limit)), 0U);
}

TEST_F(WaitingForDiskTest, TellsSinceWhenTheOldestWaits) {
  EXPECT_FALSE(waiting.since());
  add(1, Origin::ground(), TimePoint{std::chrono::seconds{10}});
  add(2, Origin::ground(), TimePoint{std::chrono::seconds{11}});
  EXPECT_EQ(waiting.since(), TimePoint{std::chrono::seconds{10}});
  static_cast<void>(waiting.take());
  EXPECT_EQ(waiting.since(), TimePoint{std::chrono::seconds{11}});
}

TEST_F(WaitingForDiskTest, CountsThoseOfEachMember) {
  add(1, Origin::subsystem(11));
  add(2, Origin::subsystem(12));
  add(3, Origin::subsystem(11));
  EXPECT_EQ(waiting.count_of(11), 2U);
  EXPECT_EQ(waiting.count_of(12), 1U);
  EXPECT_EQ(waiting.count_of(13), 0U);
}

TEST_F(WaitingForDiskTest, IsFullAtItsBound) {
  for (std::uint64_t each = 1; each < WaitingForDisk::most; ++each) add(each);
  EXPECT_FALSE(waiting.full());
  add(WaitingForDisk::most);
  EXPECT_TRUE(waiting.full());
}

}  // namespace
}  // namespace hirosco::supervisor
