// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"

/// What a mechanism that delivers every sample must do beside LinkConformance. A mechanism is the test's parameter.
namespace hirosco::testing {

class QueueConformance : public ::testing::TestWithParam<const LinkMechanism*> {
 protected:
  using Payload = std::array<std::byte, 24>;
  static constexpr std::uint32_t depth = 8;
  static inline const LinkLayout layout{.epoch = 7,
                                        .payload_octets = sizeof(Payload),
                                        .layout_hash = 0x1234'5678'9ABC'DEF0,
                                        .period = 1ms,
                                        .depth = depth};
  static Payload sample(std::uint64_t number) {
    Payload payload{};
    for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(number * 31 + i);
    return payload;
  }
  void SetUp() override {
    shared_ = GetParam()->establish(memory_, layout).value();
    writer_ = GetParam()->produce(memory_, shared_, layout).value();
    reader_ = consumer();
  }
  std::unique_ptr<LinkReader> consumer() { return GetParam()->consume(memory_, shared_, layout).value(); }
  void write(std::uint64_t first, std::uint64_t last, LinkStatus status = LinkStatus::Valid) {
    for (std::uint64_t number = first; number <= last; ++number)
      writer_->write(sample(number), TimePoint{Duration{number * 1000}}, status);
  }
  /// Reads what is there: it must be the samples `first` to `last` with `lost` ahead of them, and nothing more.
  void expect(LinkReader& reader, std::uint64_t first, std::uint64_t last, std::uint64_t lost = 0) {
    for (std::uint64_t number = first; number <= last; ++number, lost = 0) {
      const LinkSample found = reader.read(seen_);
      ASSERT_EQ(found.flow, Flow::New) << number;
      ASSERT_EQ(found.count, number);
      ASSERT_EQ(found.lost, lost) << number;
      ASSERT_EQ(found.sampled_at, TimePoint{Duration{number * 1000}});
      ASSERT_EQ(seen_, sample(number));
    }
    ASSERT_NE(reader.read(seen_).flow, Flow::New);
  }

  HeapMemory memory_;
  MemoryHandle shared_;
  std::unique_ptr<LinkWriter> writer_;
  std::unique_ptr<LinkReader> reader_;
  Payload seen_{};
};

TEST_P(QueueConformance, WhatCameSinceTheLastReadComesOldestFirst) {
  std::uint64_t written = 0;
  for (std::uint64_t burst = 1; burst <= depth; ++burst) {
    write(written + 1, written + burst);
    expect(*reader_, written + 1, written + burst);
    written += burst;
  }
}

TEST_P(QueueConformance, AConsumerThatFellBehindGoesOnWithTheNewestOnesAndKnowsHowManyItMissed) {
  std::uint64_t read = 0;
  for (const std::uint64_t behind : {depth, depth + 1, depth + 2, 2 * depth + 1, 10 * depth}) {
    write(read + 1, read + behind);
    expect(*reader_, read + behind - depth + 1, read + behind, behind - depth);
    read += behind;
  }
}

TEST_P(QueueConformance, AConsumerThatFallsBehindWhileItReadsMissesTheOldest) {
  write(1, depth);
  ASSERT_EQ(reader_->read(seen_).count, 1u);
  write(depth + 1, depth + 4);
  expect(*reader_, 5, depth + 4, 3);
}

TEST_P(QueueConformance, WhatCameBeforeAConsumerDidIsNotLostButWhatItLeftIs) {
  write(1, 3);
  const auto early = consumer();
  write(4, 3 * depth);
  const auto late = consumer();
  expect(*late, 2 * depth + 1, 3 * depth);
  expect(*early, 2 * depth + 1, 3 * depth, 2 * depth);
}

TEST_P(QueueConformance, EveryConsumerHasItsOwnPlace) {
  const auto second = consumer();
  write(1, 4);
  expect(*reader_, 1, 4);
  write(5, 6);
  expect(*second, 1, 6);
  expect(*reader_, 5, 6);
}

TEST_P(QueueConformance, AFaultIsToldAheadOfTheSamplesThatWait) {
  write(1, 2);
  writer_->set_status(LinkStatus::Fault);
  for (const std::uint64_t number : {1U, 2U}) {
    const LinkSample found = reader_->read(seen_);
    EXPECT_EQ(found.count, number);
    EXPECT_EQ(found.flow, Flow::New);
    EXPECT_EQ(found.status, LinkStatus::Fault);
  }
  EXPECT_EQ(reader_->read(seen_).status, LinkStatus::Fault);
}

TEST_P(QueueConformance, WhatWasMadeInAFaultIsNotMadeGoodByALaterSample) {
  write(1, 1, LinkStatus::Fault);
  write(2, 2, LinkStatus::Degraded);
  write(3, 3);
  for (const LinkStatus status : {LinkStatus::Fault, LinkStatus::Degraded, LinkStatus::Valid, LinkStatus::Valid})
    EXPECT_EQ(reader_->read(seen_).status, status);
}

TEST_P(QueueConformance, TheDepthIsAgreed) {
  for (const std::uint32_t other : {depth - 1, depth + 1, 0U}) {
    LinkLayout layout_of_another = layout;
    layout_of_another.depth = other;
    EXPECT_FALSE(GetParam()->consume(memory_, shared_, layout_of_another)) << other;
    EXPECT_FALSE(GetParam()->produce(memory_, GetParam()->establish(memory_, layout).value(), layout_of_another));
  }
}

TEST_P(QueueConformance, AnImpossibleDepthIsRefused) {
  LinkLayout asked = layout;
  for (const auto& [octets, of_depth, possible] : {std::tuple{8U, 0U, false},
                                                   {8U, min_link_depth - 1, false},
                                                   {8U, min_link_depth, true},
                                                   {8U, max_link_depth, true},
                                                   {8U, max_link_depth + 1, false},
                                                   {8U, 0xFFFF'FFFFU, false},
                                                   {max_queue_octets / max_link_depth, max_link_depth, true},
                                                   {max_queue_octets / max_link_depth + 1, max_link_depth, false}}) {
    asked.payload_octets = octets;
    asked.depth = of_depth;
    EXPECT_EQ(GetParam()->establish(memory_, asked).has_value(), possible) << octets << ' ' << of_depth;
  }
}

}  // namespace hirosco::testing
