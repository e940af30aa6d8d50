// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/telecommand/waiting_for_disk.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

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

/// What waits for a disk, and what goes on with it when its supervisor has died.
struct WaitingBeforeTest : WaitingForDiskTest {
  WaitingForDisk next;

  void add_of(std::uint64_t number, std::uint16_t source) {
    waiting.add({.number = number,
                 .apid = 10,
                 .origin = Origin::ground(),
                 .packet = {},
                 .memory = {},
                 .request = {static_cast<std::uint32_t>(number + 100), source, 9}});
  }
  /// Request ids of those that were about to leave.
  std::vector<std::uint32_t> recalled() {
    std::array<std::byte, 256> octets{};
    OctetWriter writer{octets};
    waiting.note(writer);
    OctetReader reader{writer.written()};
    std::vector<std::uint32_t> ids;
    for (const auto& [apid, request] : next.recall(reader)) {
      EXPECT_EQ(apid, 10);
      ids.push_back(request.id);
    }
    EXPECT_TRUE(reader.exhausted());
    return ids;
  }
  std::vector<std::uint32_t> waited_before() {
    std::vector<std::uint32_t> ids;
    for (const pus::Request& each : next.take_waited_before()) ids.push_back(each.id);
    return ids;
  }
};

TEST_F(WaitingBeforeTest, WhatWasAboutToLeaveIsToldApartFromWhatWaited) {
  for (const std::uint64_t number : {1U, 2U, 3U}) add_of(number, 7);
  EXPECT_TRUE(waiting.leave_up_to(2));
  EXPECT_EQ(recalled(), (std::vector<std::uint32_t>{101, 102}));
  EXPECT_EQ(waited_before(), std::vector<std::uint32_t>{103});
  EXPECT_TRUE(waited_before().empty());
}

TEST_F(WaitingBeforeTest, NobodyMissesAnEndOfTheSupervisorsOwn) {
  add_of(1, pus::supervisor_apid);
  add_of(2, 7);
  EXPECT_FALSE(waiting.leave_up_to(1));
  EXPECT_TRUE(waiting.leave_up_to(2));
  EXPECT_EQ(recalled(), std::vector<std::uint32_t>{102});
}

TEST_F(WaitingBeforeTest, WhatWaitedIsNotedForOneMoreUntilItWasTaken) {
  add_of(1, 7);
  EXPECT_TRUE(recalled().empty());
  std::swap(waiting, next);  // who went on dies, too
  EXPECT_TRUE(recalled().empty());
  EXPECT_EQ(waited_before(), std::vector<std::uint32_t>{101});
}

}  // namespace
}  // namespace hirosco::supervisor
