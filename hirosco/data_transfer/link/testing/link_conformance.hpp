// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <vector>

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
  /// As the mission says it: both ends here, where the system finds room.
  LinkLayout declared(std::uint8_t link = 3) const {
    LinkLayout with = layout;
    if (!GetParam()->in_memory())
      with.route = {.link = link, .producer = "127.0.0.1", .consumer = "127.0.0.1", .key = 0};
    return with;
  }
  /// As the handshake tells it to a consumer, when its producer stands.
  LinkLayout agreed(const LinkWriter& producer) const {
    LinkLayout with = declared();
    with.route.producer = producer.route().producer;
    with.route.key = producer.route().key;
    return with;
  }
  std::unique_ptr<LinkReader> consume(LinkWriter& producer) {
    auto reader = GetParam()->consume(memory_, shared_, agreed(producer)).value();
    if (!GetParam()->in_memory()) {
      EXPECT_TRUE(producer.reach(reader->route().consumer));
    }
    return reader;
  }
  void make() {
    shared_ = GetParam()->establish(memory_, declared()).value();
    writer_ = GetParam()->produce(memory_, shared_, declared()).value();
    reader_ = consume(*writer_);
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
  const auto take = [&] {
    const LinkSample found = reader_->read(seen_);
    if (found.flow != Flow::New) return false;
    EXPECT_EQ(seen_, sample(found.count));
    lost += found.lost;
    ++taken;
    return true;
  };
  // A consumer that was away for long may be told at first that there is nothing fresh; then there is.
  for (std::uint64_t number = 2; number < 5000; ++number) write(number);
  take();
  write(5000);
  while (take()) {}
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
  // Who is joined by addresses has a link each, of one sample written to all.
  std::unique_ptr<LinkWriter> other;
  if (!GetParam()->in_memory()) {
    other = GetParam()->produce(memory_, {}, declared()).value();
    other->write(sample(1), TimePoint{}, LinkStatus::Valid);
  }
  const auto second = consume(other ? *other : *writer_);
  write(2);
  if (other) other->write(sample(2), TimePoint{}, LinkStatus::Valid);
  EXPECT_EQ(reader_->read(seen_).count, 2u);
  Payload others{};
  LinkSample last;
  for (LinkSample found = second->read(others); found.flow == Flow::New; found = second->read(others)) last = found;
  EXPECT_EQ(last.count, 2u);
  EXPECT_EQ(others, sample(2));
}

TEST_P(LinkConformance, WhatWasNotAgreedIsNoLink) {
  make();
  // A link is refused, or nothing of another one ever comes out of it.
  const auto consumed_with = [&](auto change) {
    LinkLayout other = agreed(*writer_);
    change(other);
    const auto reader = GetParam()->consume(memory_, shared_, other);
    if (!reader) return false;
    if (GetParam()->in_memory()) return true;
    EXPECT_TRUE(writer_->reach((*reader)->route().consumer));
    write(1);
    std::vector<std::byte> payload(other.payload_octets);
    return (*reader)->read(payload).flow != Flow::None;
  };
  EXPECT_TRUE(consumed_with([](LinkLayout&) {}));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { ++of.epoch; }));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { of.payload_octets += 64; }));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { --of.payload_octets; }));
  EXPECT_FALSE(consumed_with([](LinkLayout& of) { of.layout_hash ^= 1; }));
  EXPECT_FALSE(GetParam()->consume(memory_, GetParam()->establish(memory_, declared()).value(), declared()))
      << "nobody produces there";
  if (GetParam()->in_memory()) {
    EXPECT_FALSE(GetParam()->produce(memory_, memory_.create("other", 64).value(), layout)) << "too small";
  }
}

TEST_P(LinkConformance, ThereIsNoSecondProducer) {
  make();
  const auto second = GetParam()->produce(memory_, shared_, declared());
  if (GetParam()->in_memory()) {
    EXPECT_FALSE(second);
    return;
  }
  // Nobody can be kept from sending; but a consumer hears the one that it was told of.
  ASSERT_TRUE((*second)->reach(reader_->route().consumer));
  (*second)->write(sample(1), TimePoint{}, LinkStatus::Valid);
  EXPECT_EQ(reader_->read(seen_).flow, Flow::None);
}

TEST_P(LinkConformance, ImpossibleSamplesAreRefused) {
  const std::uint32_t most = GetParam()->max_payload();
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
  if (!GetParam()->in_memory()) {
    EXPECT_FALSE(GetParam()->look(memory_, shared_)) << "samples pass nobody else";
    return;
  }
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
