// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/latest_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <thread>
#include <vector>

namespace hirosco {
namespace {

constexpr std::size_t payload_octets = 256;
using Payload = std::array<std::byte, payload_octets>;

LinkLayout layout_of(std::uint32_t octets) { return {7, octets, 0x1234'5678'9ABC'DEF0, 500us}; }

struct alignas(64) Line {
  std::array<std::byte, 64> octets;
};

/// Memory of a link as a provider would hand it out: zeroed, on a line, before one that nobody may touch.
class LinkMemory {
 public:
  static constexpr std::byte untouched{0x5A};
  explicit LinkMemory(std::uint32_t payload) : lines_(link_memory_octets(payload) / sizeof(Line) + 1) {
    lines_.back().octets.fill(untouched);
  }
  MutableOctets all() { return {lines_[0].octets.data(), (lines_.size() - 1) * sizeof(Line)}; }
  [[nodiscard]] bool behind_is_untouched() const {
    return std::ranges::all_of(lines_.back().octets, [](std::byte octet) { return octet == untouched; });
  }
  std::atomic_ref<std::uint64_t> word(std::size_t at) {
    return std::atomic_ref<std::uint64_t>{*reinterpret_cast<std::uint64_t*>(all().data() + at)};
  }

 private:
  std::vector<Line> lines_;
};

/// Every word of sample n is a different function of n, so that a mixture of two samples cannot pass for one.
void fill(MutableOctets payload, std::uint64_t n) {
  for (std::uint64_t i = 0; i < payload.size() / 8; ++i) {
    const std::uint64_t word = (n + i) * 0x9E37'79B9'7F4A'7C15;
    std::memcpy(payload.data() + i * 8, &word, 8);
  }
}
bool is_sample(Octets payload, std::uint64_t n) {
  std::vector<std::byte> expected(payload.size());
  fill(expected, n);
  return std::ranges::equal(payload, expected);
}

class RealtimeLink : public ::testing::Test {
 protected:
  void write(std::uint64_t n, LinkStatus status = LinkStatus::Valid) {
    Payload payload;
    fill(payload, n);
    writer_.write(payload, TimePoint{Duration{n * 1000}}, status);
  }

  LinkMemory memory_{payload_octets};
  LatestWriter writer_ = LatestWriter::make(memory_.all(), layout_of(payload_octets)).value();
  LatestReader reader_ = LatestReader::make(memory_.all(), layout_of(payload_octets)).value();
  Payload seen_{};
};

TEST_F(RealtimeLink, AGlanceTellsTheCountAndTheTimeOfTheNewestSampleAndTakesNothingFromTheReader) {
  write(1);
  write(2);
  const auto glance = glance_at_link(memory_.all());
  ASSERT_TRUE(glance);
  EXPECT_EQ(glance->count, 2U);
  EXPECT_EQ(glance->sampled_at, TimePoint{Duration{2000}});
  EXPECT_FALSE(glance_at_link(LinkMemory{payload_octets}.all()));
  EXPECT_FALSE(glance_at_link(memory_.all().first(64)));
  EXPECT_FALSE(glance_at_link({}));
  EXPECT_FALSE(glance_at_link(memory_.all().subspan(8))) << "not on a line";
}

TEST_F(RealtimeLink, HasNothingBeforeTheFirstSample) {
  const LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::None);
  EXPECT_EQ(sample.status, LinkStatus::None);
  EXPECT_EQ(sample.count, 0u);
}

TEST_F(RealtimeLink, DeliversASampleOnceAsNewAndThenAsOld) {
  write(1);
  LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::New);
  EXPECT_EQ(sample.status, LinkStatus::Valid);
  EXPECT_EQ(sample.count, 1u);
  EXPECT_EQ(sample.sampled_at, TimePoint{1us});
  EXPECT_TRUE(is_sample(seen_, 1));

  seen_.fill(std::byte{0});
  sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::Old);
  EXPECT_EQ(sample.count, 1u);
  EXPECT_EQ(sample.sampled_at, TimePoint{1us});
  EXPECT_TRUE(is_sample(seen_, 1));
}

TEST_F(RealtimeLink, CountsTheSamplesThatTheReaderNeverSaw) {
  write(1);
  EXPECT_EQ(reader_.read(seen_).lost, 0u);
  for (std::uint64_t n = 2; n <= 5; ++n) write(n);
  const LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.count, 5u);
  EXPECT_EQ(sample.lost, 3u);
  EXPECT_EQ(reader_.read(seen_).lost, 0u);
}

TEST_F(RealtimeLink, CountsNothingAsLostForAReaderThatComesLate) {
  for (std::uint64_t n = 1; n <= 5; ++n) write(n);
  EXPECT_EQ(reader_.read(seen_).lost, 0u);
}

TEST_F(RealtimeLink, ShowsAChangeOfStatusWithoutANewSample) {
  write(1);
  ASSERT_EQ(reader_.read(seen_).flow, Flow::New);
  writer_.set_status(LinkStatus::Fault);
  const LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::Old);
  EXPECT_EQ(sample.status, LinkStatus::Fault);
  EXPECT_EQ(sample.count, 1u);
  EXPECT_TRUE(is_sample(seen_, 1));
}

TEST_F(RealtimeLink, ShowsAStatusBeforeTheFirstSample) {
  writer_.set_status(LinkStatus::Stopping);
  const LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::None);
  EXPECT_EQ(sample.status, LinkStatus::Stopping);
}

TEST_F(RealtimeLink, LeavesThePayloadAloneBeforeTheFirstSample) {
  seen_.fill(std::byte{0x55});
  const Payload before = seen_;
  EXPECT_EQ(reader_.read(seen_).flow, Flow::None);
  writer_.set_status(LinkStatus::Degraded);
  EXPECT_EQ(reader_.read(seen_).flow, Flow::None);
  EXPECT_EQ(seen_, before);
}

TEST_F(RealtimeLink, KeepsItsOldCopyWhenTheWriterDiesInTheMiddle) {
  write(1);
  ASSERT_EQ(reader_.read(seen_).flow, Flow::New);
  memory_.word(link_memory::sequence_at).store(3);  // what a writer killed in write() leaves behind
  memory_.word(link_memory::count_at).store(2);
  memory_.word(link_memory::payload_at).store(0xDEAD);
  seen_.fill(std::byte{0});
  const LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::Old);
  EXPECT_EQ(sample.count, 1u);
  EXPECT_EQ(sample.status, LinkStatus::Valid);
  EXPECT_TRUE(is_sample(seen_, 1));
}

TEST_F(RealtimeLink, WritesNothingBesideThePayloadWhenReading) {
  constexpr std::byte untouched{0x5A};
  std::array<std::byte, 64 + payload_octets + 64> room;
  for (std::uint64_t n = 1; n < 4; ++n) {
    room.fill(untouched);
    write(n);
    for (const Flow flow : {Flow::New, Flow::Old}) {
      EXPECT_EQ(reader_.read(MutableOctets{room}.subspan(64, payload_octets)).flow, flow);
      EXPECT_TRUE(is_sample(Octets{room}.subspan(64, payload_octets), n));
      for (const Octets beside : {Octets{room}.first(64), Octets{room}.last(64)})
        EXPECT_TRUE(std::ranges::all_of(beside, [](std::byte octet) { return octet == untouched; }));
    }
  }
}

TEST_F(RealtimeLink, HasNothingWhenTheWriterDiesInItsFirstSample) {
  memory_.word(link_memory::sequence_at).store(1);
  EXPECT_EQ(reader_.read(seen_).flow, Flow::None);
}

TEST_F(RealtimeLink, SurvivesAWriterThatCountsBackwards) {
  for (std::uint64_t n = 1; n <= 3; ++n) write(n);
  ASSERT_EQ(reader_.read(seen_).count, 3u);
  memory_.word(link_memory::count_at).store(1);
  memory_.word(link_memory::sequence_at).store(100);
  const LinkSample sample = reader_.read(seen_);
  EXPECT_EQ(sample.flow, Flow::New);
  EXPECT_EQ(sample.lost, 0u);
}

TEST_F(RealtimeLink, DoesNotWriteIntoTheMemoryWhenReading) {
  write(1);
  const std::vector<std::byte> before(memory_.all().begin(), memory_.all().end());
  for (int i = 0; i < 3; ++i) (void)reader_.read(seen_);
  EXPECT_TRUE(std::ranges::equal(before, memory_.all()));
}

TEST(RealtimeLinkHeader, IsRefusedWhereItDiffersFromWhatWasAgreed) {
  LinkMemory memory{payload_octets};
  const LinkLayout agreed = layout_of(payload_octets);
  EXPECT_EQ(LatestReader::make(memory.all(), agreed).error().code, ErrorCode::Mismatch) << "no header yet";
  ASSERT_TRUE(LatestWriter::make(memory.all(), agreed));
  EXPECT_TRUE(LatestReader::make(memory.all(), agreed));
  LinkLayout other = agreed;
  other.epoch = 8;
  EXPECT_STREQ(LatestReader::make(memory.all(), other).error().text, "link epoch");
  other = agreed;
  other.payload_octets = 255;
  EXPECT_STREQ(LatestReader::make(memory.all(), other).error().text, "link payload size");
  for (const std::uint64_t hash : {agreed.layout_hash - 1, agreed.layout_hash + 1}) {
    other = agreed;
    other.layout_hash = hash;
    EXPECT_STREQ(LatestReader::make(memory.all(), other).error().text, "link layout") << hash;
  }
  memory.word(link_memory::version_epoch_at).store((link_memory::version + 1) << 32 | agreed.epoch);
  EXPECT_STREQ(LatestReader::make(memory.all(), agreed).error().text, "link version");
  EXPECT_EQ(LatestReader::make(memory.all(), agreed).error().value, std::int64_t{link_memory::version + 1});
}

TEST(RealtimeLinkHeader, IsRefusedInMemoryThatDoesNotFit) {
  LinkMemory memory{payload_octets};
  const LinkLayout layout = layout_of(payload_octets);
  const auto too_small = memory.all().first(memory.all().size() - 1);
  for (const Error& error :
       {LatestWriter::make(too_small, layout).error(), LatestReader::make(too_small, layout).error()}) {
    EXPECT_EQ(error.code, ErrorCode::Mismatch);
    EXPECT_EQ(std::string_view{error.text}, "link memory too small, not aligned, or payload size impossible");
  }
  EXPECT_FALSE(LatestWriter::make(memory.all().subspan(8), layout_of(8)).has_value()) << "not on a line";
  EXPECT_EQ(LatestWriter::make(memory.all(), layout_of(0)).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(LatestWriter::make(memory.all(), layout_of(65'537)).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(LatestReader::make({}, layout).error().code, ErrorCode::Mismatch);
}

TEST(RealtimeLinkHeader, MemoryThatWasUsedBeforeBeginsAnew) {
  LinkMemory memory{payload_octets};
  std::ranges::fill(memory.all(), std::byte{0xA5});
  LatestWriter writer = LatestWriter::make(memory.all(), layout_of(payload_octets)).value();
  LatestReader reader = LatestReader::make(memory.all(), layout_of(payload_octets)).value();
  Payload seen{};
  EXPECT_EQ(reader.read(seen).flow, Flow::None);
  const auto glance = glance_at_link(memory.all());
  ASSERT_TRUE(glance);
  EXPECT_EQ(glance->count, 0u);
  EXPECT_EQ(glance->sampled_at, TimePoint{});
  writer.write(Payload{}, TimePoint{42ns}, LinkStatus::Valid);
  const LinkSample first = reader.read(seen);
  EXPECT_EQ(first.flow, Flow::New);
  EXPECT_EQ(first.count, 1u);
}

TEST(RealtimeLinkHeader, HasTheFormThatIsWrittenDown) {
  LinkMemory memory{payload_octets};
  LatestWriter writer = LatestWriter::make(memory.all(), layout_of(payload_octets)).value();
  writer.write(Payload{}, TimePoint{42ns}, LinkStatus::Degraded);
  EXPECT_EQ(memory.word(0).load(), link_memory::magic);
  EXPECT_EQ(memory.word(8).load(), 0x0000'0002'0000'0007u);
  EXPECT_EQ(memory.word(16).load(), payload_octets);
  EXPECT_EQ(memory.word(24).load(), 0x1234'5678'9ABC'DEF0u);
  EXPECT_EQ(memory.word(32).load(), 500'000u);
  EXPECT_EQ(memory.word(64).load(), 2u);
  EXPECT_EQ(memory.word(72).load(), 0xFFFF'FFFD'0000'0002u);
  EXPECT_EQ(memory.word(80).load(), 1u);
  EXPECT_EQ(memory.word(88).load(), 42u);
  EXPECT_EQ(link_memory_octets(256), 384u);
  EXPECT_EQ(link_memory_octets(1), 128u);
}

/// What may become of a word of shared memory: one flipped bit, and whole words that damage leaves behind (hazard SF19).
std::vector<std::uint64_t> damages(std::uint64_t word) {
  std::vector<std::uint64_t> damaged{0,        ~std::uint64_t{0}, ~word, 0x5555'5555'5555'5555, 0xAAAA'AAAA'AAAA'AAAA,
                                     word + 1, word - 1};
  for (unsigned bit = 0; bit < 64; ++bit) damaged.push_back(word ^ std::uint64_t{1} << bit);
  std::erase(damaged, word);
  return damaged;
}

TEST(RealtimeLinkDamage, OfTheStatusIsAFaultWhateverItWas) {
  for (const auto status : {LinkStatus::Valid, LinkStatus::Degraded, LinkStatus::Stopping, LinkStatus::Fault}) {
    LinkMemory memory{payload_octets};
    LatestWriter writer = LatestWriter::make(memory.all(), layout_of(payload_octets)).value();
    LatestReader reader = LatestReader::make(memory.all(), layout_of(payload_octets)).value();
    Payload payload{};
    const auto read_as = [&](std::uint64_t word) {
      writer.write(payload, TimePoint{1us}, status);
      memory.word(link_memory::status_at).store(word);
      return reader.read(payload).status;
    };
    writer.write(payload, TimePoint{1us}, status);
    const std::uint64_t good = memory.word(link_memory::status_at).load();
    EXPECT_EQ(read_as(good), status);
    for (const std::uint64_t damaged : damages(good)) EXPECT_EQ(read_as(damaged), LinkStatus::Fault) << damaged;
  }
}

TEST(RealtimeLinkDamage, OfTheFirstLineIsSeenWhenTheLinkIsMade) {
  using namespace link_memory;
  LinkMemory memory{payload_octets};
  const LinkLayout layout = layout_of(payload_octets);
  ASSERT_TRUE(LatestWriter::make(memory.all(), layout));
  for (const std::size_t at : {magic_at, version_epoch_at, payload_octets_at, layout_hash_at}) {
    const std::uint64_t good = memory.word(at).load();
    for (const std::uint64_t damaged : damages(good)) {
      memory.word(at).store(damaged);
      EXPECT_EQ(LatestReader::make(memory.all(), layout).error().code, ErrorCode::Mismatch) << at << ' ' << damaged;
    }
    memory.word(at).store(good);
  }
}

TEST_F(RealtimeLink, DamageOfAnyWordIsReadAsNewAtMostOnceAndIsOverWithTheNextSample) {
  const std::size_t words = memory_.all().size() / sizeof(std::uint64_t);
  std::uint64_t n = 0;
  for (std::size_t word = 0; word < words; ++word) {
    for (const bool before_it_was_read : {true, false}) {
      write(++n);
      for (const std::uint64_t damaged : damages(memory_.word(word * 8).load())) {
        write(++n);
        if (!before_it_was_read) static_cast<void>(reader_.read(seen_));
        memory_.word(word * 8).store(damaged);
        // A writer that is dead by now: its link must look old, so that it becomes stale.
        int news = 0;
        for (int look = 0; look < 4; ++look) news += reader_.read(seen_).flow == Flow::New ? 1 : 0;
        EXPECT_LE(news, 1) << word << ' ' << damaged;
        write(++n);
        write(++n);
        const LinkSample sample = reader_.read(seen_);
        if (word * 8 < link_memory::sequence_at) continue;  // read once, when the link was made
        ASSERT_EQ(sample.flow, Flow::New) << word << ' ' << damaged;
        ASSERT_EQ(sample.count, n);
        ASSERT_EQ(sample.status, LinkStatus::Valid);
        ASSERT_TRUE(is_sample(seen_, n));
      }
    }
  }
}

/// From its first sample on and from the second on a reader has them by different ways, and both ends move more than a word at once where
/// they can. Who sends and who reads has its octets where no word begins.
TEST(RealtimeLinkPayload, MayHaveAnyLength) {
  constexpr std::byte untouched{0x5A};
  for (std::uint32_t octets = 1; octets <= 72; ++octets) {
    LinkMemory memory{octets};
    LatestWriter writer = LatestWriter::make(memory.all(), layout_of(octets)).value();
    LatestReader reader = LatestReader::make(memory.all(), layout_of(octets)).value();
    std::vector<std::byte> sent(1 + octets), seen(1 + octets + 1);
    for (unsigned n = 1; n <= 3; ++n) {
      for (std::uint32_t i = 0; i < octets; ++i) sent[1 + i] = static_cast<std::byte>(37 * n + 11 * i);
      const Octets sample = Octets{sent}.subspan(1);
      writer.write(sample, {}, LinkStatus::Valid);
      for (const Flow flow : {Flow::New, Flow::Old}) {
        std::ranges::fill(seen, untouched);
        EXPECT_EQ(reader.read(MutableOctets{seen}.subspan(1, octets)).flow, flow) << octets << ' ' << n;
        EXPECT_TRUE(std::ranges::equal(sample, Octets{seen}.subspan(1, octets))) << octets << ' ' << n;
        EXPECT_EQ(seen.front(), untouched) << octets << ' ' << n;
        EXPECT_EQ(seen.back(), untouched) << octets << ' ' << n;
      }
      const Octets stored = Octets{memory.all()}.subspan(link_memory::payload_at);
      EXPECT_TRUE(std::ranges::equal(sample, stored.first(octets))) << octets << ' ' << n;
      for (const std::byte filled : stored.subspan(octets)) EXPECT_EQ(filled, std::byte{0}) << octets << ' ' << n;
      EXPECT_TRUE(memory.behind_is_untouched()) << octets << ' ' << n;
    }
  }
}

// The stress below and its proof: a twin with a planted bug must fail the very same test.

constexpr std::size_t large = 4096;

class TrueWriter {
 public:
  explicit TrueWriter(LinkMemory& memory) : writer_{LatestWriter::make(memory.all(), layout_of(large)).value()} {}
  void write(Octets payload) { writer_.write(payload, {}, LinkStatus::Valid); }

 private:
  LatestWriter writer_;
};

/// Known wrong: says that it is at work only when it has finished.
class WrongWriter {
 public:
  explicit WrongWriter(LinkMemory& memory) : memory_{memory} {
    (void)LatestWriter::make(memory.all(), layout_of(large)).value();
  }
  void write(Octets payload) {
    for (std::size_t at = 0; at < large; at += 8) {
      std::uint64_t value;
      std::memcpy(&value, payload.data() + at, 8);
      memory_.word(link_memory::payload_at + at).store(value, std::memory_order_release);
      if (at == large / 2) std::this_thread::yield();
    }
    memory_.word(link_memory::count_at).store(++count_, std::memory_order_release);
    memory_.word(link_memory::sequence_at).store(count_ * 2, std::memory_order_release);
  }

 private:
  LinkMemory& memory_;
  std::uint64_t count_{0};
};

/// Torn or misnumbered samples among `wanted` new ones; stops at the first.
template <class Writer>
int torn_samples(int wanted) {
  LinkMemory memory{large};
  Writer writer{memory};
  LatestReader reader = LatestReader::make(memory.all(), layout_of(large)).value();
  std::atomic<bool> stop{false};
  std::thread producer{[&] {
    std::vector<std::byte> payload(large);
    for (std::uint64_t n = 1; !stop.load(std::memory_order_relaxed); ++n) {
      fill(payload, n);
      writer.write(payload);
      // Gaps of many lengths, so that reads begin, lie and end everywhere in a write and find whole samples, too.
      for (std::uint64_t i = 0; i < n * 37 % 1024; ++i) (void)stop.load();
      if (n % 4 == 0) std::this_thread::yield();
    }
  }};
  std::vector<std::byte> seen(large);
  int torn = 0;
  std::uint64_t before = 0;
  for (int found = 0; found < wanted && torn == 0;) {
    const LinkSample sample = reader.read(seen);
    if (sample.flow != Flow::New) {
      std::this_thread::yield();  // on a busy machine the writer may need this very processor
      continue;
    }
    ++found;
    if (!is_sample(seen, sample.count) || sample.count != before + 1 + (before == 0 ? sample.count - 1 : sample.lost))
      ++torn;
    before = sample.count;
  }
  stop = true;
  producer.join();
  return torn;
}

TEST(RealtimeLinkStress, NeverDeliversATornSample) { EXPECT_EQ(torn_samples<TrueWriter>(1'000), 0); }

TEST(RealtimeLinkStress, CatchesAWriterThatDoesNotMarkItsWork) { EXPECT_GT(torn_samples<WrongWriter>(1'000'000), 0); }

}  // namespace
}  // namespace hirosco
