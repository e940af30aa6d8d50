// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/os/word_wait.hpp"

/// What a mechanism must do for a consumer whose cycle a sample starts (adr 0094), beside LinkConformance. A mechanism is the test's
/// parameter; one that wakes nobody must say so.
namespace hirosco::testing {

/// Both ends of such a link, whichever of the two pairs its kind has.
class WakingLink {
 public:
  static constexpr std::uint32_t octets = 24;
  static LinkLayout layout(const LinkMechanism& mechanism, bool wakes = true) {
    return {.epoch = 7,
            .payload_octets = octets,
            .layout_hash = 0x1234'5678'9ABC'DEF0,
            .period = 1ms,
            .depth = mechanism.kind() == LinkKind::Queued ? default_link_depth : 0,
            .wakes = wakes};
  }
  WakingLink(const LinkMechanism& mechanism, bool wakes) {
    const LinkLayout agreed = layout(mechanism, wakes);
    const MemoryHandle shared = mechanism.establish(memory_, agreed).value();
    if (mechanism.kind() == LinkKind::Loaned) {
      lender_ = mechanism.lend(memory_, shared, agreed).value();
      borrower_ = mechanism.borrow(memory_, shared, agreed).value();
    } else {
      writer_ = mechanism.produce(memory_, shared, agreed).value();
      reader_ = mechanism.consume(memory_, shared, agreed).value();
    }
  }
  void publish() {
    if (writer_) return writer_->write(payload_, TimePoint{1us}, LinkStatus::Valid);
    lender_->lend()[0] = std::byte{1};
    lender_->publish(TimePoint{1us}, LinkStatus::Valid);
  }
  std::uint64_t count() { return borrower_ ? borrower_->newest().count : reader_->read(seen_).count; }
  [[nodiscard]] const std::uint32_t& word() const {
    return *(borrower_ ? borrower_->arrival_word() : reader_->arrival_word());
  }
  [[nodiscard]] std::uint32_t look() const {
    return std::atomic_ref<std::uint32_t>{const_cast<std::uint32_t&>(word())}.load(std::memory_order_acquire);
  }

 private:
  HeapMemory memory_;
  std::unique_ptr<LinkWriter> writer_;
  std::unique_ptr<LinkReader> reader_;
  std::unique_ptr<LoanWriter> lender_;
  std::unique_ptr<LoanReader> borrower_;
  std::vector<std::byte> payload_ = std::vector<std::byte>(octets), seen_ = payload_;
};

/// A consumer in a thread of its own sleeps before each of so many samples, each published after the one before was read. The first
/// one for which it slept `patience`; 0: it was woken for all.
inline std::uint64_t first_slept_through(WakingLink& link, std::uint64_t samples, Duration patience) {
  const SystemClock clock;
  std::atomic<std::uint64_t> read{0};
  std::atomic<bool> stop{false};
  std::thread producer{[&] {
    for (std::uint64_t next = 1; next <= samples && !stop.load(); ++next) {
      while (read.load() + 1 < next && !stop.load()) std::this_thread::yield();
      link.publish();
    }
  }};
  std::uint64_t slept_through = 0;
  while (read.load() < samples && slept_through == 0) {
    const std::uint32_t seen = link.look();
    const std::uint64_t count = link.count();
    const bool came = count > read.load();
    if (came) read.store(count);
    if (count >= samples || came) continue;
    const TimePoint deadline = clock.now() + patience;
    static_cast<void>(wait_on_word(link.word(), seen, deadline));
    if (clock.now() >= deadline) slept_through = count + 1;
  }
  stop.store(true);
  producer.join();
  return slept_through;
}

class WakeConformance : public ::testing::TestWithParam<const LinkMechanism*> {};

TEST_P(WakeConformance, AWayThatWakesNobodySaysSoAndIsNotMadeForWhoSleeps) {
  if (GetParam()->wakes()) return;
  HeapMemory memory;
  LinkLayout asked = WakingLink::layout(*GetParam());
  asked.route = {.link = 3, .producer = "127.0.0.1", .consumer = "127.0.0.1", .key = 0};
  EXPECT_FALSE(GetParam()->establish(memory, asked));
}

TEST_P(WakeConformance, TheWordIsAnotherOneAfterEachSampleAndStaysWhenItIsRead) {
  if (!GetParam()->wakes()) return;
  WakingLink link{*GetParam(), true};
  for (std::uint64_t number = 1; number <= 200; ++number) {
    const std::uint32_t before = link.look();
    link.publish();
    const std::uint32_t after = link.look();
    ASSERT_NE(after, before) << number;
    ASSERT_EQ(link.count(), number);
    ASSERT_EQ(link.look(), after) << "to read is no arrival";
  }
}

TEST_P(WakeConformance, WhoSleepsIsWokenForEachSample) {
  if (!GetParam()->wakes()) return;
  WakingLink link{*GetParam(), true};
  EXPECT_EQ(first_slept_through(link, 5'000, 30s), 0u);
}

/// The planted defect: the very same test finds a producer that publishes and does not wake. It is the one that an agreement without the flag
/// makes, so this shows as well that who is not asked to makes no system call.
TEST_P(WakeConformance, AProducerThatDoesNotWakeIsFound) {
  if (!GetParam()->wakes()) return;
  WakingLink link{*GetParam(), false};
  EXPECT_NE(first_slept_through(link, 100'000, 20ms), 0u);
}

}  // namespace hirosco::testing
