// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <vector>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"

/// What a mechanism that lends its samples must do beside LinkConformance. A mechanism is the test's parameter.
namespace hirosco::testing {

class LoanConformance : public ::testing::TestWithParam<const LinkMechanism*> {
 protected:
  static constexpr std::uint32_t octets = 1000;  ///< no multiple of a cache line
  static inline const LinkLayout layout{
      .epoch = 7, .payload_octets = octets, .layout_hash = 0x1234'5678'9ABC'DEF0, .period = 33ms};
  static std::vector<std::byte> sample(std::uint64_t number) {
    std::vector<std::byte> payload(octets);
    for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(number * 31 + i);
    return payload;
  }
  void SetUp() override {
    shared_ = GetParam()->establish(memory_, layout).value();
    writer_ = GetParam()->lend(memory_, shared_, layout).value();
    reader_ = GetParam()->borrow(memory_, shared_, layout).value();
  }
  void publish(std::uint64_t number, LinkStatus status = LinkStatus::Valid) {
    std::ranges::copy(sample(number), writer_->lend().begin());
    writer_->publish(TimePoint{Duration{number * 1000}}, status);
  }
  [[nodiscard]] bool looks_at(std::uint64_t number) { return std::ranges::equal(reader_->look(), sample(number)); }

  HeapMemory memory_;
  MemoryHandle shared_;
  std::unique_ptr<LoanWriter> writer_;
  std::unique_ptr<LoanReader> reader_;
};

TEST_P(LoanConformance, ThereIsNothingToLookAtBeforeTheFirstSample) {
  EXPECT_EQ(reader_->newest().flow, Flow::None);
  EXPECT_TRUE(reader_->look().empty());
  EXPECT_FALSE(reader_->whole());
  ASSERT_FALSE(writer_->lend().empty());
  EXPECT_EQ(reader_->newest().flow, Flow::None) << "lent is not published";
}

TEST_P(LoanConformance, ALentPlaceHasTheAgreedSizeLiesOnALineAndStaysUntilItIsPublished) {
  const MutableOctets place = writer_->lend();
  EXPECT_EQ(place.size(), octets);
  EXPECT_EQ(std::bit_cast<std::uintptr_t>(place.data()) % 64, 0u);
  EXPECT_EQ(writer_->lend().data(), place.data());
  writer_->publish(TimePoint{1us}, LinkStatus::Valid);
  EXPECT_NE(writer_->lend().data(), place.data()) << "the newest is not lent";
}

TEST_P(LoanConformance, WhatIsPublishedIsLookedAtOnceAsNewAndStaysAsOld) {
  publish(1);
  LinkSample found = reader_->newest();
  EXPECT_EQ(found.flow, Flow::New);
  EXPECT_EQ(found.status, LinkStatus::Valid);
  EXPECT_EQ(found.count, 1u);
  EXPECT_EQ(found.sampled_at, TimePoint{1us});
  EXPECT_EQ(reader_->look().size(), octets);
  EXPECT_TRUE(looks_at(1));
  EXPECT_TRUE(reader_->whole());
  found = reader_->newest();
  EXPECT_EQ(found.flow, Flow::Old);
  EXPECT_EQ(found.count, 1u);
  EXPECT_TRUE(looks_at(1));
  EXPECT_TRUE(reader_->whole());
}

TEST_P(LoanConformance, NothingLentIsNothingPublished) {
  writer_->publish(TimePoint{1us}, LinkStatus::Valid);
  EXPECT_EQ(reader_->newest().flow, Flow::None);
  publish(1);
  writer_->publish(TimePoint{2us}, LinkStatus::Valid);
  EXPECT_EQ(reader_->newest().count, 1u);
}

TEST_P(LoanConformance, WhatIsLookedAtStaysWholeForTwoPublicationsAndThenTellsThatItIsNot) {
  for (std::uint64_t number = 1; number <= 20; ++number) {
    publish(number);
    ASSERT_EQ(reader_->newest().count, number);
    ASSERT_TRUE(looks_at(number));
    const Octets place = reader_->look();
    const std::uint64_t looked_at = number;
    std::uint64_t since = 0;
    for (; reader_->whole() && since < 100; ++since) {
      ASSERT_TRUE(std::ranges::equal(place, sample(looked_at))) << "whole, but another sample";
      publish(++number);
    }
    EXPECT_GT(since, 2u);
    EXPECT_LT(since, 100u) << "it never tells";
    EXPECT_FALSE(reader_->whole());
  }
}

TEST_P(LoanConformance, APlaceThatIsBeingMadeAnewIsNotWholeFromItsFirstOctetOn) {
  publish(1);
  ASSERT_EQ(reader_->newest().count, 1u);
  const Octets place = reader_->look();
  for (std::uint64_t number = 2; writer_->lend().data() != place.data(); ++number) {
    ASSERT_LT(number, 100u);
    EXPECT_TRUE(reader_->whole());
    publish(number);
  }
  EXPECT_FALSE(reader_->whole());
}

TEST_P(LoanConformance, ToAskForTheNewestLeavesWhatIsLookedAtAlone) {
  publish(1);
  ASSERT_EQ(reader_->newest().count, 1u);
  const Octets place = reader_->look();
  publish(2);
  EXPECT_EQ(reader_->newest().count, 2u);
  EXPECT_TRUE(reader_->whole());
  EXPECT_TRUE(std::ranges::equal(place, sample(1)));
  EXPECT_TRUE(looks_at(2));
}

TEST_P(LoanConformance, WhatAConsumerNeverSawIsCountedOnce) {
  publish(1);
  EXPECT_EQ(reader_->newest().lost, 0u);
  for (std::uint64_t number = 2; number <= 9; ++number) publish(number);
  EXPECT_EQ(reader_->newest().lost, 7u);
  EXPECT_EQ(reader_->newest().lost, 0u);
}

TEST_P(LoanConformance, WhoCopiesSeesItsWordChangeWithEachSampleAsWhoBorrowsDoes) {
  const auto copying = GetParam()->consume(memory_, shared_, layout).value();
  ASSERT_NE(copying->arrival_word(), nullptr);
  for (std::uint64_t number = 1; number <= 9; ++number) {
    const std::uint32_t before = *copying->arrival_word();
    publish(number);
    EXPECT_NE(*copying->arrival_word(), before) << number;
    EXPECT_EQ(*copying->arrival_word(), *reader_->arrival_word());
  }
}

TEST_P(LoanConformance, AChangeOfStatusIsSeenWithoutASample) {
  writer_->set_status(LinkStatus::Stopping);
  LinkSample found = reader_->newest();
  EXPECT_EQ(found.flow, Flow::None);
  EXPECT_EQ(found.status, LinkStatus::Stopping);
  publish(1);
  ASSERT_EQ(reader_->newest().status, LinkStatus::Valid);
  ASSERT_FALSE(writer_->lend().empty());
  for (const LinkStatus status : {LinkStatus::Stopping, LinkStatus::Fault, LinkStatus::Degraded}) {
    writer_->set_status(status);
    found = reader_->newest();
    EXPECT_EQ(found.flow, Flow::Old);
    EXPECT_EQ(found.status, status);
    EXPECT_TRUE(looks_at(1));
    EXPECT_TRUE(reader_->whole());
  }
}

TEST_P(LoanConformance, AProducerThatDiesWhileItMakesASampleLeavesTheOneBefore) {
  publish(1);
  std::ranges::fill(writer_->lend(), std::byte{0xEE});
  writer_.reset();
  EXPECT_EQ(reader_->newest().flow, Flow::New);
  EXPECT_TRUE(looks_at(1));
  EXPECT_TRUE(reader_->whole());
  EXPECT_EQ(reader_->newest().flow, Flow::Old);
}

TEST_P(LoanConformance, AnyNumberOfConsumersLookAtOnePlaceAndNothingIsCopied) {
  std::vector<std::unique_ptr<LoanReader>> readers;
  for (int i = 0; i < 20; ++i) readers.push_back(GetParam()->borrow(memory_, shared_, layout).value());
  for (std::uint64_t number = 1; number <= 9; ++number) {
    const std::byte* const made = writer_->lend().data();
    publish(number);
    for (const auto& reader : readers) {
      const LinkSample found = reader->newest();
      ASSERT_EQ(found.flow, Flow::New);
      ASSERT_EQ(found.count, number);
      // Another process has it at another address; here both ends are one.
      ASSERT_EQ(reader->look().data(), made);
      ASSERT_TRUE(std::ranges::equal(reader->look(), sample(number)));
      ASSERT_TRUE(reader->whole());
    }
  }
}

/// One consumer stands still, one dies while it looks, one comes late: each loses what it loses, and nobody else anything.
TEST_P(LoanConformance, ASlowOrDeadConsumerCostsSamplesOfItsOwnOnly) {
  auto slow = GetParam()->borrow(memory_, shared_, layout).value();
  auto dead = GetParam()->borrow(memory_, shared_, layout).value();
  publish(1);
  ASSERT_EQ(slow->newest().count, 1u);
  ASSERT_FALSE(slow->look().empty());
  ASSERT_EQ(dead->newest().count, 1u);
  ASSERT_FALSE(dead->look().empty());
  dead.reset();
  std::uint64_t lost = 0;
  for (std::uint64_t number = 1; number <= 100; ++number) {
    if (number > 1) publish(number);
    const LinkSample found = reader_->newest();
    lost += found.lost;
    ASSERT_EQ(found.count, number) << "the producer waits for nobody";
    ASSERT_TRUE(looks_at(number));
    ASSERT_TRUE(reader_->whole());
  }
  EXPECT_EQ(lost, 0u);
  EXPECT_FALSE(slow->whole());
  EXPECT_EQ(slow->newest().lost, 98u);
  EXPECT_TRUE(std::ranges::equal(slow->look(), sample(100)));
  const auto late = GetParam()->borrow(memory_, shared_, layout).value();
  EXPECT_EQ(late->newest().lost, 0u);
}

/// The planted defect: a consumer that does what none can, as its memory is mapped for reading. The suite sees it in the others.
TEST_P(LoanConformance, AConsumerThatCouldWriteWouldBeSeenByTheOthers) {
  publish(1);
  ASSERT_EQ(reader_->newest().count, 1u);
  const Octets place = reader_->look();
  const_cast<std::byte&>(place[0]) ^= std::byte{1};
  EXPECT_FALSE(looks_at(1));
}

TEST_P(LoanConformance, ThereIsNoSecondProducerAndNoOtherAgreement) {
  EXPECT_FALSE(GetParam()->lend(memory_, shared_, layout));
  EXPECT_FALSE(GetParam()->produce(memory_, shared_, layout));
  for (const auto& change :
       {+[](LinkLayout& of) { ++of.epoch; }, +[](LinkLayout& of) { --of.payload_octets; },
        +[](LinkLayout& of) { of.payload_octets += 64; }, +[](LinkLayout& of) { of.layout_hash ^= 1; }}) {
    LinkLayout other = layout;
    change(other);
    EXPECT_FALSE(GetParam()->borrow(memory_, shared_, other));
  }
  EXPECT_FALSE(GetParam()->borrow(memory_, GetParam()->establish(memory_, layout).value(), layout)) << "nobody lends";
  EXPECT_FALSE(GetParam()->lend(memory_, memory_.create("other", 64).value(), layout)) << "too small";
}

TEST_P(LoanConformance, ImpossibleSamplesAreRefused) {
  for (const std::uint32_t impossible : {0u, max_loaned_payload_octets + 1, 0xFFFF'FFFFu}) {
    LinkLayout wrong = layout;
    wrong.payload_octets = impossible;
    EXPECT_FALSE(GetParam()->establish(memory_, wrong)) << impossible;
    EXPECT_FALSE(GetParam()->lend(memory_, shared_, wrong)) << impossible;
    EXPECT_FALSE(GetParam()->borrow(memory_, shared_, wrong)) << impossible;
  }
}

}  // namespace hirosco::testing
