// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"

/// What every mechanism of real-time links must do, whatever it is and whichever samples it brings. A mechanism is the
/// test's parameter.
namespace hirosco::testing {

class LinkConformance : public ::testing::TestWithParam<const LinkMechanism*> {
 protected:
  using Payload = std::array<std::byte, 24>;
  const LinkLayout layout{.epoch = 7,
                          .payload_octets = sizeof(Payload),
                          .layout_hash = 0x1234'5678'9ABC'DEF0,
                          .period = 500us,
                          .depth = GetParam()->kind() == LinkKind::Queued ? default_link_depth : 0};
  static Payload sample(std::uint64_t number) {
    Payload payload{};
    for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(number * 31 + i);
    return payload;
  }
  void make() {
    shared_ = GetParam()->establish(memory_, layout).value();
    writer_ = GetParam()->produce(memory_, shared_, layout).value();
    reader_ = GetParam()->consume(memory_, shared_, layout).value();
  }
  void write(std::uint64_t number, LinkStatus status = LinkStatus::Valid) {
    writer_->write(sample(number), TimePoint{Duration{number * 1000}}, status);
  }

  HeapMemory memory_;
  MemoryHandle shared_;
  std::unique_ptr<LinkWriter> writer_;
  std::unique_ptr<LinkReader> reader_;
  Payload seen_{};
};

TEST_P(LinkConformance, ThereIsNothingBeforeTheFirstSample) {
  make();
  const LinkSample found = reader_->read(seen_);
  EXPECT_EQ(found.flow, Flow::None);
  EXPECT_EQ(found.count, 0u);
}

TEST_P(LinkConformance, ASampleComesWholeOnceAsNewAndStaysAsOld) {
  make();
  write(1);
  LinkSample found = reader_->read(seen_);
  EXPECT_EQ(found.flow, Flow::New);
  EXPECT_EQ(found.status, LinkStatus::Valid);
  EXPECT_EQ(found.count, 1u);
  EXPECT_EQ(found.sampled_at, TimePoint{1us});
  EXPECT_EQ(seen_, sample(1));
  seen_ = {};
  found = reader_->read(seen_);
  EXPECT_EQ(found.flow, Flow::Old);
  EXPECT_EQ(found.count, 1u);
  EXPECT_EQ(seen_, sample(1));
}

TEST_P(LinkConformance, SamplesReadInTurnComeInOrderAndNoneIsLost) {
  make();
  for (std::uint64_t number = 1; number <= 1000; ++number) {
    write(number);
    const LinkSample found = reader_->read(seen_);
    ASSERT_EQ(found.flow, Flow::New);
    ASSERT_EQ(found.count, number);
    ASSERT_EQ(found.lost, 0u);
    ASSERT_EQ(seen_, sample(number));
  }
}

TEST_P(LinkConformance, WhatAConsumerNeverSawIsCountedOnce) {
  make();
  write(1);
  reader_->read(seen_);
  std::uint64_t lost = 0, taken = 1;
  for (std::uint64_t number = 2; number <= 5000; ++number) write(number);
  for (;;) {
    const LinkSample found = reader_->read(seen_);
    if (found.flow != Flow::New) break;
    ASSERT_EQ(seen_, sample(found.count));
    lost += found.lost;
    ++taken;
  }
  EXPECT_EQ(lost + taken, 5000u);
}

TEST_P(LinkConformance, AChangeOfStatusIsSeenWithoutASample) {
  make();
  write(1);
  ASSERT_EQ(reader_->read(seen_).flow, Flow::New);
  for (const LinkStatus status : {LinkStatus::Stopping, LinkStatus::Fault, LinkStatus::Degraded}) {
    writer_->set_status(status);
    const LinkSample found = reader_->read(seen_);
    EXPECT_EQ(found.flow, Flow::Old);
    EXPECT_EQ(found.status, status);
    EXPECT_EQ(seen_, sample(1));
  }
}

TEST_P(LinkConformance, EveryConsumerHasItsOwnPlace) {
  make();
  write(1);
  ASSERT_EQ(reader_->read(seen_).flow, Flow::New);
  const auto second = GetParam()->consume(memory_, shared_, layout).value();
  write(2);
  EXPECT_EQ(reader_->read(seen_).count, 2u);
  Payload others{};
  LinkSample last;
  for (LinkSample found = second->read(others); found.flow == Flow::New; found = second->read(others)) last = found;
  EXPECT_EQ(last.count, 2u);
  EXPECT_EQ(others, sample(2));
}

TEST_P(LinkConformance, WhatWasNotAgreedIsNoLink) {
  make();
  const auto consumed_with = [&](auto change) {
    LinkLayout other = layout;
    change(other);
    return GetParam()->consume(memory_, shared_, other).has_value();
  };
  EXPECT_TRUE(consumed_with([](LinkLayout&) {}));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { ++of.epoch; }));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { of.payload_octets += 64; }));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { --of.payload_octets; }));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { of.layout_hash ^= 1; }));
  EXPECT_FALSE(GetParam()->consume(memory_, GetParam()->establish(memory_, layout).value(), layout))
      << "nobody produces there";
  EXPECT_FALSE(GetParam()->produce(memory_, memory_.create("other", 64).value(), layout)) << "too small";
}

TEST_P(LinkConformance, ThereIsNoSecondProducer) {
  make();
  EXPECT_FALSE(GetParam()->produce(memory_, shared_, layout));
}

TEST_P(LinkConformance, ImpossibleSamplesAreRefused) {
  const std::uint32_t most = max_payload_octets(GetParam()->kind());
  for (const std::uint32_t octets : {0u, most + 1, 0xFFFF'FFFFu}) {
    LinkLayout impossible = layout;
    impossible.payload_octets = octets;
    EXPECT_FALSE(GetParam()->establish(memory_, impossible)) << octets;
  }
  LinkLayout largest = layout;
  largest.payload_octets = most;
  EXPECT_TRUE(GetParam()->establish(memory_, largest));
}

TEST_P(LinkConformance, ALookTellsTheNewestSampleAndTakesNothing) {
  make();
  const auto view = GetParam()->look(memory_, shared_).value();
  write(1);
  write(2);
  const auto glance = view->glance();
  ASSERT_TRUE(glance);
  EXPECT_EQ(glance->count, 2u);
  EXPECT_EQ(glance->sampled_at, TimePoint{2us});
  EXPECT_EQ(reader_->read(seen_).flow, Flow::New);
  const auto unproduced = GetParam()->establish(memory_, layout).value();
  EXPECT_FALSE(GetParam()->look(memory_, unproduced).value()->glance());
}

}  // namespace hirosco::testing
