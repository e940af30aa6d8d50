// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/loaned_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <thread>
#include <vector>

namespace hirosco::lending {
namespace {

constexpr std::uint32_t payload_octets = 4096;

LinkLayout layout_of(std::uint32_t octets) { return {7, octets, 0x1234'5678'9ABC'DEF0, 33ms}; }

struct alignas(64) Line {
  std::array<std::byte, 64> octets;
};

/// Memory of a link as a provider would hand it out, between two lines that nobody may touch.
class LoanMemory {
 public:
  static constexpr std::byte untouched{0x5A};
  explicit LoanMemory(std::uint32_t payload = payload_octets)
      : lines_(loaned_memory_octets(payload) / sizeof(Line) + 2) {
    for (const std::size_t beside : {std::size_t{0}, lines_.size() - 1}) lines_[beside].octets.fill(untouched);
  }
  MutableOctets all() { return {lines_[1].octets.data(), (lines_.size() - 2) * sizeof(Line)}; }
  std::atomic_ref<std::uint64_t> word(std::size_t at) {
    return std::atomic_ref<std::uint64_t>{*reinterpret_cast<std::uint64_t*>(all().data() + at)};
  }
  [[nodiscard]] bool inside(Octets octets) {
    return octets.data() >= all().data() + loaned_memory::payload_at &&
           octets.data() + octets.size() <= all().data() + all().size();
  }
  [[nodiscard]] bool beside_is_untouched() const {
    const auto is = [](std::byte octet) { return octet == untouched; };
    return std::ranges::all_of(lines_.front().octets, is) && std::ranges::all_of(lines_.back().octets, is);
  }

 private:
  std::vector<Line> lines_;
};

/// Every word of sample n is a different function of n, so that a mixture of two samples cannot pass for one.
std::uint64_t word_of(std::uint64_t n, std::uint64_t i) { return (n + i) * 0x9E37'79B9'7F4A'7C15; }

std::atomic_ref<std::uint64_t> word_in(Octets place, std::size_t i) {
  return std::atomic_ref<std::uint64_t>{
      const_cast<std::uint64_t*>(reinterpret_cast<const std::uint64_t*>(place.data()))[i]};
}
void fill(MutableOctets place, std::uint64_t n) {
  for (std::size_t i = 0; i < place.size() / 8; ++i) word_in(place, i).store(word_of(n, i), std::memory_order_release);
}
bool is_sample(Octets place, std::uint64_t n) {
  for (std::size_t i = 0; i < place.size() / 8; ++i)
    if (word_in(place, i).load(std::memory_order_acquire) != word_of(n, i)) return false;
  return true;
}

class LoanedLinkTest : public ::testing::Test {
 protected:
  void publish(std::uint64_t n, LinkStatus status = LinkStatus::Valid) {
    fill(writer_.lend(), n);
    writer_.publish(TimePoint{Duration{n * 1000}}, status);
  }

  LoanMemory memory_;
  LoanedWriter writer_ = LoanedWriter::make(memory_.all(), layout_of(payload_octets)).value();
  LoanedReader reader_ = LoanedReader::make(memory_.all(), layout_of(payload_octets)).value();
};

TEST_F(LoanedLinkTest, HasTheFormThatIsWrittenDown) {
  EXPECT_EQ(memory_.word(136).load(), 0xFFFF'FFFF'0000'0000u) << "no status yet";
  publish(1, LinkStatus::Degraded);
  EXPECT_EQ(memory_.word(0).load(), loaned_memory::magic);
  EXPECT_EQ(memory_.word(8).load(), 0x0000'0001'0000'0007u);
  EXPECT_EQ(memory_.word(16).load(), payload_octets);
  EXPECT_EQ(memory_.word(24).load(), 0x1234'5678'9ABC'DEF0u);
  EXPECT_EQ(memory_.word(32).load(), 33'000'000u);
  EXPECT_EQ(memory_.word(64).load(), 1u);
  EXPECT_EQ(memory_.word(192).load(), 2u);
  EXPECT_EQ(memory_.word(200).load(), 0xFFFF'FFFD'0000'0002u);
  EXPECT_EQ(memory_.word(208).load(), 1000u);
  EXPECT_EQ(memory_.word(384 + payload_octets).load(), word_of(1, 0));
  EXPECT_NE(writer_.lend().data(), nullptr);
  EXPECT_EQ(memory_.word(256).load(), 3u) << "being made";
  EXPECT_EQ(loaned_memory_octets(payload_octets), 384u + 4 * payload_octets);
  EXPECT_EQ(loaned_memory_octets(1), 640u);
}

TEST_F(LoanedLinkTest, AGlanceTellsTheNewestSample) {
  publish(1);
  publish(2);
  const auto glance = glance_at_loans(memory_.all());
  ASSERT_TRUE(glance);
  EXPECT_EQ(glance->count, 2u);
  EXPECT_EQ(glance->sampled_at, TimePoint{2us});
  EXPECT_FALSE(glance_at_loans(LoanMemory{}.all()));
  EXPECT_FALSE(glance_at_loans(memory_.all().first(loaned_memory::payload_at - 1)));
  EXPECT_FALSE(glance_at_loans({}));
  EXPECT_FALSE(glance_at_loans(memory_.all().subspan(8))) << "not on a line";
  for (const std::uint64_t other : {loaned_memory::magic - 1, loaned_memory::magic + 1}) {
    memory_.word(loaned_memory::magic_at).store(other);
    EXPECT_FALSE(glance_at_loans(memory_.all())) << "another memory";
  }
}

TEST_F(LoanedLinkTest, WhatWasPublishedBeforeTheFirstLookIsNotLost) {
  for (std::uint64_t n = 1; n <= 3; ++n) publish(n);
  EXPECT_EQ(reader_.newest().lost, 0u);
  for (std::uint64_t n = 4; n <= 6; ++n) publish(n);
  EXPECT_EQ(reader_.newest().lost, 2u);
}

TEST_F(LoanedLinkTest, AConsumerWritesNothingIntoTheMemory) {
  publish(1);
  const std::vector<std::byte> before(memory_.all().begin(), memory_.all().end());
  for (int i = 0; i < 3; ++i) {
    static_cast<void>(reader_.newest());
    static_cast<void>(reader_.look());
    static_cast<void>(reader_.whole());
  }
  EXPECT_TRUE(std::ranges::equal(before, memory_.all()));
}

TEST(LoanedLinkHeader, IsRefusedWhereItDiffersFromWhatWasAgreed) {
  LoanMemory memory;
  const LinkLayout agreed = layout_of(payload_octets);
  EXPECT_STREQ(LoanedReader::make(memory.all(), agreed).error().text, "link memory has no header");
  ASSERT_TRUE(LoanedWriter::make(memory.all(), agreed));
  EXPECT_TRUE(LoanedReader::make(memory.all(), agreed));
  LinkLayout other = agreed;
  other.epoch = 8;
  EXPECT_STREQ(LoanedReader::make(memory.all(), other).error().text, "link epoch");
  other = agreed;
  --other.payload_octets;
  EXPECT_STREQ(LoanedReader::make(memory.all(), other).error().text, "link payload size");
  other = agreed;
  other.layout_hash ^= 1;
  EXPECT_STREQ(LoanedReader::make(memory.all(), other).error().text, "link layout");
  memory.word(loaned_memory::version_epoch_at).store((loaned_memory::version + 1) << 32 | agreed.epoch);
  const Error other_version = LoanedReader::make(memory.all(), agreed).error();
  EXPECT_STREQ(other_version.text, "link version");
  EXPECT_EQ(other_version.value, static_cast<std::int64_t>(loaned_memory::version + 1));
}

TEST(LoanedLinkHeader, IsRefusedInMemoryThatDoesNotFit) {
  LoanMemory memory;
  const LinkLayout layout = layout_of(payload_octets);
  const auto too_small = memory.all().first(memory.all().size() - 1);
  EXPECT_FALSE(LoanedWriter::make(too_small, layout));
  EXPECT_FALSE(LoanedReader::make(too_small, layout));
  EXPECT_FALSE(LoanedWriter::make(memory.all().subspan(8), layout_of(8))) << "not on a line";
  EXPECT_FALSE(LoanedWriter::make(memory.all(), layout_of(0)));
  EXPECT_FALSE(LoanedWriter::make(memory.all(), layout_of(max_loaned_payload_octets + 1)));
  EXPECT_FALSE(LoanedReader::make({}, layout));
}

TEST(LoanedLinkHeader, MemoryThatWasUsedBeforeBeginsAnew) {
  LoanMemory memory;
  std::ranges::fill(memory.all(), std::byte{0xA5});
  LoanedWriter writer = LoanedWriter::make(memory.all(), layout_of(payload_octets)).value();
  LoanedReader reader = LoanedReader::make(memory.all(), layout_of(payload_octets)).value();
  EXPECT_EQ(reader.newest().flow, Flow::None);
  EXPECT_TRUE(std::ranges::all_of(writer.lend(), [](std::byte octet) { return octet == std::byte{0}; }));
  EXPECT_TRUE(memory.beside_is_untouched());
}

/// What may become of a word of shared memory: one flipped bit, and whole words that damage or malice leaves behind (hazard SF19).
std::vector<std::uint64_t> damages(std::uint64_t word) {
  std::vector<std::uint64_t> damaged{
      0,        ~std::uint64_t{0}, ~word,   0x5555'5555'5555'5555, 0xAAAA'AAAA'AAAA'AAAA, word + 1,
      word - 1, word + 4,          word - 4};
  for (unsigned bit = 0; bit < 64; ++bit) damaged.push_back(word ^ std::uint64_t{1} << bit);
  std::erase(damaged, word);
  return damaged;
}

TEST(LoanedLinkDamage, OfTheFirstLineIsSeenWhenTheLinkIsMade) {
  using namespace loaned_memory;
  LoanMemory memory;
  const LinkLayout layout = layout_of(payload_octets);
  ASSERT_TRUE(LoanedWriter::make(memory.all(), layout));
  for (const std::size_t at : {magic_at, version_epoch_at, payload_octets_at, layout_hash_at}) {
    const std::uint64_t good = memory.word(at).load();
    for (const std::uint64_t damaged : damages(good)) {
      memory.word(at).store(damaged);
      EXPECT_EQ(LoanedReader::make(memory.all(), layout).error().code, ErrorCode::Mismatch) << at << ' ' << damaged;
    }
    memory.word(at).store(good);
  }
}

TEST_F(LoanedLinkTest, DamageOfTheStatusIsAFaultWhateverItWas) {
  for (const auto status : {LinkStatus::Valid, LinkStatus::Degraded, LinkStatus::Stopping, LinkStatus::Fault}) {
    publish(1, status);
    const std::size_t at = loaned_memory::status_at(reader_.newest().count);
    const std::uint64_t good = memory_.word(at).load();
    EXPECT_EQ(reader_.newest().status, status);
    for (const std::uint64_t damaged : damages(good)) {
      memory_.word(at).store(damaged);
      EXPECT_EQ(reader_.newest().status, LinkStatus::Fault) << damaged;
    }
  }
}

TEST_F(LoanedLinkTest, DamageOfAnyWordLeadsNowhereElseIsNewAtMostOnceAndIsOverWithTheNextSample) {
  std::uint64_t n = 0;
  for (std::size_t at = 0; at < loaned_memory::payload_at; at += 8) {
    for (const bool before_it_was_told : {true, false}) {
      publish(++n);
      for (const std::uint64_t damaged : damages(memory_.word(at).load())) {
        publish(++n);
        if (!before_it_was_told) static_cast<void>(reader_.newest());
        memory_.word(at).store(damaged);
        // A producer that is dead by now: its link must look old, so that it becomes stale.
        int news = 0;
        for (int look = 0; look < 4; ++look) {
          news += reader_.newest().flow == Flow::New ? 1 : 0;
          const Octets place = reader_.look();
          ASSERT_TRUE(place.empty() || (memory_.inside(place) && place.size() == payload_octets))
              << at << ' ' << damaged;
          static_cast<void>(reader_.whole());
        }
        EXPECT_LE(news, before_it_was_told ? 1 : 0) << at << ' ' << damaged;
        publish(++n);
        publish(++n);
        publish(++n);
        publish(++n);
        const LinkSample sample = reader_.newest();
        ASSERT_EQ(sample.flow, Flow::New) << at << ' ' << damaged;
        ASSERT_EQ(sample.count, n);
        ASSERT_EQ(sample.status, LinkStatus::Valid);
        ASSERT_TRUE(is_sample(reader_.look(), n));
        ASSERT_TRUE(reader_.whole());
      }
    }
  }
  EXPECT_TRUE(memory_.beside_is_untouched());
}

TEST_F(LoanedLinkTest, DamageBeforeTheFirstSampleIsNoSample) {
  memory_.word(loaned_memory::sequence_at(0)).store(1);
  EXPECT_EQ(reader_.newest().flow, Flow::None);
  EXPECT_TRUE(reader_.look().empty());
  EXPECT_FALSE(reader_.whole());
}

TEST_F(LoanedLinkTest, AProducerOfMaliceMovesNoConsumerOutOfTheMemory) {
  // Both words that a consumer believes together, so that it takes any count there is.
  for (std::uint64_t bit = 1; bit < 64; ++bit) {
    const std::uint64_t count = (std::uint64_t{1} << bit) + 3 * bit;
    memory_.word(loaned_memory::sequence_at(count)).store(2 * count);
    memory_.word(loaned_memory::newest_at).store(count);
    EXPECT_EQ(reader_.newest().count, count);
    EXPECT_EQ(reader_.look().size(), payload_octets);
    EXPECT_TRUE(memory_.inside(reader_.look()));
    const auto glance = glance_at_loans(memory_.all());
    ASSERT_TRUE(glance);
    EXPECT_EQ(glance->count, count);
  }
  EXPECT_TRUE(memory_.beside_is_untouched());
}

TEST_F(LoanedLinkTest, ACountThatGoesBackIsNoNewSample) {
  for (std::uint64_t n = 1; n <= 3; ++n) publish(n);
  ASSERT_EQ(reader_.newest().count, 3u);
  memory_.word(loaned_memory::newest_at).store(2);
  const LinkSample sample = reader_.newest();
  EXPECT_EQ(sample.flow, Flow::Old);
  EXPECT_EQ(sample.count, 3u);
  EXPECT_TRUE(is_sample(reader_.look(), 3));
}

// --- two processors --------------------------------------------------------------------------------------------------

class TrueLender {
 public:
  explicit TrueLender(LoanMemory& memory)
      : writer_{LoanedWriter::make(memory.all(), layout_of(payload_octets)).value()} {}
  void make(std::uint64_t n) {
    fill(writer_.lend(), n);
    writer_.publish(TimePoint{}, LinkStatus::Valid);
  }

 private:
  LoanedWriter writer_;
};

/// The planted bug: what it makes anew keeps the sequence of the sample before until it is done.
class WrongLender {
 public:
  explicit WrongLender(LoanMemory& memory) : memory_{memory} {
    static_cast<void>(LoanedWriter::make(memory.all(), layout_of(payload_octets)).value());
  }
  void make(std::uint64_t n) {
    using namespace loaned_memory;
    fill(memory_.all().subspan(payload_at + n % places * payload_octets, payload_octets), n);
    memory_.word(sequence_at(n)).store(2 * n, std::memory_order_release);
    memory_.word(newest_at).store(n, std::memory_order_release);
  }

 private:
  LoanMemory& memory_;
};

struct Looks {
  int whole{0};
  int lapped{0};
  int torn{0};  ///< told to be whole
};

/// Looks until so many were whole and so many lapped, or one was torn, or the last look is over.
template <class Lender>
Looks look_at(int wanted, int most) {
  LoanMemory memory;
  Lender lender{memory};
  LoanedReader reader = LoanedReader::make(memory.all(), layout_of(payload_octets)).value();
  std::atomic<bool> stop{false};
  std::thread producer{[&] {
    for (std::uint64_t n = 1; !stop.load(std::memory_order_relaxed); ++n) {
      lender.make(n);
      if (n % 8 == 0) std::this_thread::yield();
    }
  }};
  Looks looks;
  std::vector<std::uint64_t> seen(payload_octets / 8);
  for (int look = 0; look < most && looks.torn == 0 && (looks.whole < wanted || looks.lapped < wanted); ++look) {
    const LinkSample sample = reader.newest();
    const Octets place = reader.look();
    if (place.empty()) {
      std::this_thread::yield();
      continue;
    }
    // Of most looks the rest comes late: with three publications behind it the producer is at work in this very place.
    constexpr std::array<std::uint64_t, 5> late{0, 3, 3, 3, 5};
    const std::uint64_t laps = late[static_cast<std::size_t>(look) % late.size()];
    const std::size_t half = static_cast<std::size_t>(look) * 37 % seen.size();
    for (std::size_t i = 0; i < half; ++i) seen[i] = word_in(place, i).load(std::memory_order_acquire);
    for (int waited = 0; memory.word(loaned_memory::newest_at).load(std::memory_order_relaxed) < sample.count + laps;
         ++waited)
      if (waited % 10'000 == 9'999) std::this_thread::yield();  // on a busy machine it may need this very processor
    for (std::size_t i = half; i < seen.size(); ++i) seen[i] = word_in(place, i).load(std::memory_order_acquire);
    if (!reader.whole()) {
      ++looks.lapped;
      continue;
    }
    ++looks.whole;
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (seen[i] != word_of(sample.count, i)) {
        ++looks.torn;
        break;
      }
  }
  stop = true;
  producer.join();
  return looks;
}

TEST(LoanedLinkStress, NoTornSampleIsWholeAndALappedOneIsTold) {
  const Looks looks = look_at<TrueLender>(50, 1'000'000);
  EXPECT_EQ(looks.torn, 0);
  EXPECT_GE(looks.whole, 50);
  EXPECT_GE(looks.lapped, 50);
}

TEST(LoanedLinkStress, CatchesALenderThatDoesNotMarkItsWork) {
  // On a busy computer that may take many looks: the first torn sample ends it.
  constexpr int until_one_is_torn = std::numeric_limits<int>::max();
  EXPECT_EQ(look_at<WrongLender>(until_one_is_torn, until_one_is_torn).torn, 1);
}

}  // namespace
}  // namespace hirosco::lending
