// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/record_ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace hirosco {
namespace {

[[nodiscard]] Octets octets_of(std::string_view text) { return std::as_bytes(std::span{text}); }
[[nodiscard]] std::string text_of(Octets octets) {
  return {reinterpret_cast<const char*>(octets.data()), octets.size()};
}

TEST(RecordRing, GivesRecordsBackInTheirOrder) {
  RecordRing ring{256};
  EXPECT_TRUE(ring.try_write(octets_of("first")));
  EXPECT_TRUE(ring.try_write(octets_of("second, longer")));
  ASSERT_TRUE(ring.front());
  EXPECT_EQ(text_of(*ring.front()), "first");
  ring.pop();
  EXPECT_EQ(text_of(*ring.front()), "second, longer");
  ring.pop();
  EXPECT_EQ(ring.front(), std::nullopt);
  ring.pop();
  EXPECT_EQ(ring.used(), 0U);
}

TEST(RecordRing, JoinsTwoPartsToOneRecord) {
  RecordRing ring{256};
  EXPECT_TRUE(ring.try_write(octets_of("head|"), octets_of("body")));
  EXPECT_TRUE(ring.try_write({}, octets_of("body only")));
  EXPECT_EQ(text_of(*ring.front()), "head|body");
  ring.pop();
  EXPECT_EQ(text_of(*ring.front()), "body only");
}

TEST(RecordRing, KeepsAnEmptyRecord) {
  RecordRing ring{64};
  EXPECT_TRUE(ring.try_write({}));
  ASSERT_TRUE(ring.front());
  EXPECT_TRUE(ring.front()->empty());
  ring.pop();
  EXPECT_FALSE(ring.front());
}

TEST(RecordRing, WritesWholeOrNothingAndCountsWhatItRefuses) {
  RecordRing ring{64};
  const std::string record(24, 'x');
  EXPECT_TRUE(ring.try_write(octets_of(record)));
  EXPECT_TRUE(ring.try_write(octets_of(record)));
  EXPECT_FALSE(ring.try_write(octets_of("one more")));
  EXPECT_EQ(ring.dropped(), 1U);
  ring.pop();
  ring.pop();
  EXPECT_FALSE(ring.front());
}

TEST(RecordRing, RefusesWhatCouldNeverFit) {
  RecordRing ring{64};
  const std::string too_long(ring.max_record() + 1, 'x');
  EXPECT_FALSE(ring.try_write(octets_of(too_long)));
  EXPECT_FALSE(ring.try_write(Octets{octets_of(too_long).data(), std::size_t{0} - 1}, octets_of("b")));
  EXPECT_TRUE(ring.try_reserve(ring.max_record() + 1).empty());
  EXPECT_TRUE(ring.try_reserve(0).empty());
}

TEST(RecordRing, TakesTheLongestRecordAtAnyPosition) {
  for (std::size_t before = 0; before < 40; ++before) {
    RecordRing ring{64};
    for (std::size_t i = 0; i < before; ++i) {
      ASSERT_TRUE(ring.try_write({}));
      ring.pop();
    }
    const std::string longest(ring.max_record(), 'm');
    ASSERT_TRUE(ring.try_write(octets_of(longest))) << before;
    EXPECT_EQ(text_of(*ring.front()), longest);
  }
}

TEST(RecordRing, PublishesAReservationOnlyOnCommit) {
  RecordRing ring{256};
  MutableOctets room = ring.try_reserve(32);
  ASSERT_EQ(room.size(), 32U);
  EXPECT_FALSE(ring.front());
  std::ranges::copy(octets_of("in place"), room.begin());
  ring.commit(8);
  EXPECT_EQ(text_of(*ring.front()), "in place");
  ring.commit(8);
  ring.pop();
  EXPECT_FALSE(ring.front());
}

TEST(RecordRing, AbandonedReservationLeavesNoTrace) {
  RecordRing ring{64};
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(ring.try_write({}));
    ring.pop();
  }
  // This one starts over at the beginning of the buffer, the next fits before its end.
  ASSERT_FALSE(ring.try_reserve(24).empty());
  EXPECT_TRUE(ring.try_write(octets_of("short")));
  EXPECT_EQ(text_of(*ring.front()), "short");
  ring.pop();
  EXPECT_FALSE(ring.front());
}

TEST(RecordRing, BehavesAsAQueueOverRandomOperations) {
  std::mt19937 random{20240611};
  RecordRing ring{1024};
  std::deque<std::string> model;
  std::size_t refused = 0;
  for (int i = 0; i < 200'000; ++i) {
    if (random() % 100 < 55) {
      std::string record(random() % 200, static_cast<char>('a' + i % 26));
      const std::size_t cut = record.empty() ? 0 : random() % record.size();
      if (ring.try_write(octets_of(record).first(cut), octets_of(record).subspan(cut)))
        model.push_back(std::move(record));
      else ++refused;
    } else if (const auto record = ring.front()) {
      ASSERT_FALSE(model.empty());
      ASSERT_EQ(text_of(*record), model.front());
      ring.pop();
      model.pop_front();
    } else {
      ASSERT_TRUE(model.empty());
    }
  }
  EXPECT_EQ(ring.dropped(), refused);
  EXPECT_GT(refused, 100U);
}

TEST(RecordRing, TransfersBetweenThreadsWithoutLossOrDamage) {
  constexpr std::uint32_t count = 100'000;
  RecordRing ring{4096};
  std::thread producer{[&] {
    std::array<std::uint32_t, 60> numbers{};
    for (std::uint32_t i = 0; i < count;) {
      const std::span used = std::span{numbers}.first(1 + i % numbers.size());
      std::ranges::fill(used, i);
      if (ring.try_write(std::as_bytes(used))) ++i;
      else std::this_thread::yield();
    }
  }};
  std::uint32_t wrong = 0;
  for (std::uint32_t expected = 0; expected < count;) {
    const auto record = ring.front();
    if (!record) {
      std::this_thread::yield();
      continue;
    }
    if (record->size() != 4 * (1 + expected % 60)) ++wrong;
    OctetReader reader{*record, std::endian::native};
    while (reader.remaining() != 0)
      if (reader.get<std::uint32_t>() != expected) ++wrong;
    ring.pop();
    ++expected;
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace hirosco
