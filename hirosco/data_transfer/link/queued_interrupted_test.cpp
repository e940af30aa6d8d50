// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <functional>
#include <vector>

#include "hirosco/data_transfer/link/queued_link.hpp"

/// What the two ends of a queued link see of each other in the middle of a sample. Two threads meet there too seldom for a test, so an end is
/// stopped: on a page that may not be touched yet, and the signal does what the other end does meanwhile.
namespace hirosco::queueing {
namespace {

constexpr std::size_t page = 4096;
constexpr std::uint32_t long_payload = 2 * page;
constexpr std::uint32_t short_depth = 2;
const LinkLayout long_layout{7, long_payload, 0x1234'5678'9ABC'DEF0, 1ms, short_depth};

/// Memory whose pages can be forbidden until somebody touches one.
class Pages {
 public:
  explicit Pages(std::size_t octets) : octets_{(octets + page - 1) / page * page} {
    memory_ = ::mmap(nullptr, octets_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  }
  ~Pages() { ::munmap(memory_, octets_); }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  MutableOctets all() { return {static_cast<std::byte*>(memory_), octets_}; }
  std::uint64_t word(std::size_t at) {
    return std::atomic_ref<std::uint64_t>{*reinterpret_cast<std::uint64_t*>(all().data() + at)}.load();
  }

 private:
  std::size_t octets_;
  void* memory_;
};

/// While it lives, the first touch of the page with this octet waits for `meanwhile`.
class Stop {
 public:
  Stop(std::byte* touched, std::function<void()> meanwhile) {
    page_ = reinterpret_cast<void*>(reinterpret_cast<std::uintptr_t>(touched) / page * page);
    meanwhile_ = std::move(meanwhile);
    struct sigaction action{};
    action.sa_handler = [](int) {
      ::mprotect(page_, page, PROT_READ | PROT_WRITE);
      ++stops_;
      meanwhile_();
    };
    ::sigaction(SIGSEGV, &action, &before_);
    stops_ = 0;
    ::mprotect(page_, page, PROT_NONE);
  }
  ~Stop() {
    ::mprotect(page_, page, PROT_READ | PROT_WRITE);
    ::sigaction(SIGSEGV, &before_, nullptr);
    meanwhile_ = {};
  }
  Stop(const Stop&) = delete;
  Stop& operator=(const Stop&) = delete;
  [[nodiscard]] static int stops() { return stops_; }

 private:
  // A signal's handler has no other way to them.
  static inline void* page_;
  static inline std::function<void()> meanwhile_;
  static inline int stops_;
  struct sigaction before_{};
};

std::vector<std::byte> long_sample(std::uint64_t n) {
  return std::vector<std::byte>(long_payload, static_cast<std::byte>(n));
}

struct InterruptedQueue : ::testing::Test {
  Pages memory{queued_memory_octets(long_payload, short_depth)};
  QueuedWriter writer = QueuedWriter::make(memory.all(), long_layout).value();
  QueuedReader reader = QueuedReader::make(memory.all(), long_layout).value();
  std::vector<std::byte> seen = std::vector<std::byte>(long_payload);
  std::uint64_t written{0};

  static std::size_t slot_of(std::uint64_t n) {
    return queued_memory::slots_at + n % (short_depth + 1) * queued_memory::slot_octets(long_payload);
  }
  void write(std::uint64_t last) {
    while (written < last) {
      ++written;
      writer.write(long_sample(written), {}, LinkStatus::Valid);
    }
  }
};

TEST_F(InterruptedQueue, ASampleThatIsBeingWrittenIsMarkedAndAllBeforeItAreWhole) {
  write(4);
  Pages source{long_payload};
  std::ranges::fill(source.all(), std::byte{5});
  std::uint64_t marked = 0;
  std::vector<std::uint64_t> counts;
  bool whole = true;
  {
    const Stop stop{source.all().data() + page, [&] {
                      marked = memory.word(slot_of(5));
                      while (reader.read(seen).flow == Flow::New) {
                        counts.push_back(seen[0] == std::byte{3} ? 3 : 4);
                        whole = whole && seen == long_sample(counts.back());
                      }
                    }};
    writer.write(source.all(), {}, LinkStatus::Valid);
    EXPECT_EQ(Stop::stops(), 1);
  }
  EXPECT_EQ(marked, 2 * 5 - 1u);
  EXPECT_EQ(counts, (std::vector<std::uint64_t>{3, 4}));
  EXPECT_TRUE(whole);
  EXPECT_EQ(memory.word(slot_of(5)), 2 * 5u);
  EXPECT_EQ(reader.read(seen).count, 5u);
  EXPECT_EQ(seen, long_sample(5));
}

TEST_F(InterruptedQueue, ASampleThatIsOverwrittenWhileItIsReadIsLostAndNotTorn) {
  for (const std::uint64_t later :
       {std::uint64_t{1}, std::uint64_t{short_depth}, std::uint64_t{4}, std::uint64_t{10}}) {
    while (reader.read(seen).flow == Flow::New) {}
    const std::uint64_t before = written;
    write(before + short_depth);
    LinkSample found;
    {
      const Stop stop{memory.all().data() + slot_of(before + 1) + page, [&] { write(written + later); }};
      found = reader.read(seen);
      EXPECT_EQ(Stop::stops(), 1);
    }
    // Up to one more than the depth the slot is not begun anew: the sample is whole.
    const std::uint64_t expected = later <= 1 ? before + 1 : written - short_depth + 1;
    EXPECT_EQ(found.flow, Flow::New);
    EXPECT_EQ(found.count, expected) << later;
    EXPECT_EQ(found.lost, expected - before - 1);
    EXPECT_EQ(seen, long_sample(expected)) << later;
  }
}

}  // namespace
}  // namespace hirosco::queueing
