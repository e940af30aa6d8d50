// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/memory/sealed_memory.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "hirosco/data_transfer/link/loaned_link.hpp"
#include "hirosco/data_transfer/link/queued_link.hpp"

/// Links in memory of their own, of which nobody but the producer maps a writable page. Linux.
namespace hirosco::sealing {
namespace {

constexpr std::uint32_t payload_octets = 4096;

LinkLayout layout_of(std::uint32_t octets, std::uint32_t depth = 0) {
  return {7, octets, 0x1234'5678'9ABC'DEF0, 33ms, depth};
}

/// Every word of sample n is a different function of n, so that a mixture of two samples cannot pass for one.
std::vector<std::byte> sample(std::uint64_t n, std::size_t octets) {
  std::vector<std::byte> made(octets);
  for (std::uint64_t i = 0; i < octets / 8; ++i) {
    const std::uint64_t word = (n + i) * 0x9E37'79B9'7F4A'7C15;
    std::memcpy(made.data() + i * 8, &word, 8);
  }
  return made;
}
void fill(MutableOctets place, std::uint64_t n) { std::ranges::copy(sample(n, place.size()), place.begin()); }
bool is_sample(Octets place, std::uint64_t n) { return std::ranges::equal(place, sample(n, place.size())); }

TEST(LoanedLinkInSealedMemory, OneMebiOctetIsLookedAtWhereItWasMade) {
  const LinkLayout layout = layout_of(1U << 20);
  SealedMemory provider;
  const LoanedLink mechanism;
  const MemoryHandle shared = mechanism.establish(provider, layout).value();
  const auto writer = mechanism.lend(provider, shared, layout).value();
  const auto reader = mechanism.borrow(provider, shared, layout).value();
  EXPECT_FALSE(mechanism.lend(provider, shared, layout)) << "sealed";
  fill(writer->lend(), 1);
  writer->publish(TimePoint{1us}, LinkStatus::Valid);
  ASSERT_EQ(reader->newest().flow, Flow::New);
  EXPECT_TRUE(is_sample(reader->look(), 1));
  EXPECT_TRUE(reader->whole());
  // Two mappings of one memory: what is made later in the same place is seen there, and told.
  const Octets place = reader->look();
  for (std::uint64_t n = 2; n <= 1 + loaned_memory::places; ++n) {
    fill(writer->lend(), n);
    writer->publish(TimePoint{1us}, LinkStatus::Valid);
  }
  EXPECT_TRUE(is_sample(place, 1 + loaned_memory::places));
  EXPECT_FALSE(reader->whole());
}

TEST(LoanedLinkInSealedMemory, WhoCopiesHasLostNothingBeforeItsFirstSample) {
  const LinkLayout layout = layout_of(payload_octets);
  SealedMemory provider;
  const LoanedLink mechanism;
  const MemoryHandle shared = mechanism.establish(provider, layout).value();
  const auto writer = mechanism.lend(provider, shared, layout).value();
  const auto reader = mechanism.consume(provider, shared, layout).value();
  constexpr std::byte untouched{0x5A};
  std::vector<std::byte> copy(payload_octets, untouched);
  EXPECT_EQ(reader->read(copy).flow, Flow::None);
  EXPECT_EQ(std::ranges::count(copy, untouched), payload_octets);
  for (std::uint64_t n = 1; n <= 3; ++n) {
    fill(writer->lend(), n);
    writer->publish(TimePoint{1us}, LinkStatus::Valid);
  }
  const LinkSample first = reader->read(copy);
  EXPECT_EQ(first.count, 3u);
  EXPECT_EQ(first.lost, 0u);
  for (int n = 4; n <= 6; ++n) {
    static_cast<void>(writer->lend());
    writer->publish(TimePoint{1us}, LinkStatus::Valid);
  }
  EXPECT_EQ(reader->read(copy).lost, 2u);
  const LinkSample again = reader->read(copy);
  EXPECT_EQ(again.flow, Flow::Old);
  EXPECT_EQ(again.lost, 0u);
}

TEST(LoanedLinkInSealedMemory, WhatEndsWithinAWordIsCopiedToItsLastOctetAndNoFurther) {
  constexpr std::uint32_t octets = 13;
  const LinkLayout layout = layout_of(octets);
  SealedMemory provider;
  const LoanedLink mechanism;
  const MemoryHandle shared = mechanism.establish(provider, layout).value();
  const auto writer = mechanism.produce(provider, shared, layout).value();
  const auto reader = mechanism.consume(provider, shared, layout).value();
  std::vector<std::byte> made(octets), copy(octets);
  for (std::size_t i = 0; i < made.size(); ++i) made[i] = static_cast<std::byte>(i + 1);
  writer->write(made, TimePoint{1us}, LinkStatus::Valid);
  ASSERT_EQ(reader->read(copy).flow, Flow::New);
  EXPECT_EQ(copy, made);
}

TEST(LoanedLinkInSealedMemory, OtherKindsLendNothing) {
  struct Copying final : LinkMechanism {
    [[nodiscard]] LinkMethod method() const noexcept override { return LinkMethod::SharedMemory; }
    [[nodiscard]] LinkKind kind() const noexcept override { return LinkKind::Latest; }
    Result<MemoryHandle> establish(MemoryProvider&, const LinkLayout&) const override { return MemoryHandle{}; }
    Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider&, const MemoryHandle&,
                                                const LinkLayout&) const override {
      return fail(ErrorCode::Unavailable, "");
    }
    Result<std::unique_ptr<LinkReader>> consume(MemoryProvider&, const MemoryHandle&,
                                                const LinkLayout&) const override {
      return fail(ErrorCode::Unavailable, "");
    }
    Result<std::unique_ptr<LinkView>> look(MemoryProvider&, const MemoryHandle&) const override {
      return fail(ErrorCode::Unavailable, "");
    }
  };
  SealedMemory provider;
  EXPECT_EQ(Copying{}.lend(provider, {}, layout_of(8)).error().code, ErrorCode::NotPermitted);
  EXPECT_EQ(Copying{}.borrow(provider, {}, layout_of(8)).error().code, ErrorCode::NotPermitted);
}

TEST(QueuedLinkInSealedMemory, ItsConsumerMapsReadOnlyAndItsProducerIsTheOnlyOne) {
  SealedMemory provider;
  const QueuedLink mechanism;
  const LinkLayout layout = layout_of(payload_octets, 4);
  const MemoryHandle shared = mechanism.establish(provider, layout).value();
  EXPECT_FALSE(mechanism.consume(provider, shared, layout)) << "a second producer may yet come";
  const auto writer = mechanism.produce(provider, shared, layout).value();
  EXPECT_FALSE(mechanism.produce(provider, shared, layout));
  const auto reader = mechanism.consume(provider, shared, layout).value();
  EXPECT_FALSE(mechanism.consume(provider, shared, layout_of(payload_octets, 5)));
  writer->write(sample(1, payload_octets), TimePoint{1us}, LinkStatus::Valid);
  std::vector<std::byte> seen(payload_octets);
  EXPECT_EQ(reader->read(seen).flow, Flow::New);
  EXPECT_EQ(seen, sample(1, payload_octets));
}

}  // namespace
}  // namespace hirosco::sealing
