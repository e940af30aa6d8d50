// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/link/queued_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <vector>

#include "hirosco/data_transfer/memory/heap_memory.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco::queueing {
namespace {

constexpr std::uint32_t payload_octets = 64;
constexpr std::uint32_t depth = 4;
constexpr std::uint32_t slots = depth + 1;
constexpr std::size_t slot_size = 128;
using Payload = std::array<std::byte, payload_octets>;

LinkLayout layout_of(std::uint32_t octets, std::uint32_t kept = depth) {
  return {7, octets, 0x1234'5678'9ABC'DEF0, 1ms, kept};
}
std::size_t slot_of(std::uint64_t count) { return queued_memory::slots_at + count % slots * slot_size; }

struct alignas(64) Line {
  std::array<std::byte, 64> octets;
};

/// Memory of a link as a provider would hand it out, between two lines that nobody may touch.
class QueueMemory {
 public:
  static constexpr std::byte untouched{0x5A};
  explicit QueueMemory(std::uint32_t payload = payload_octets, std::uint32_t kept = depth)
      : lines_(queued_memory_octets(payload, kept) / sizeof(Line) + 2) {
    for (const std::size_t beside : {std::size_t{0}, lines_.size() - 1}) lines_[beside].octets.fill(untouched);
  }
  MutableOctets all() { return {lines_[1].octets.data(), (lines_.size() - 2) * sizeof(Line)}; }
  std::atomic_ref<std::uint64_t> word(std::size_t at) {
    return std::atomic_ref<std::uint64_t>{*reinterpret_cast<std::uint64_t*>(all().data() + at)};
  }
  [[nodiscard]] bool beside_is_untouched() const {
    const auto is = [](std::byte octet) { return octet == untouched; };
    return std::ranges::all_of(lines_.front().octets, is) && std::ranges::all_of(lines_.back().octets, is);
  }

 private:
  std::vector<Line> lines_;
};

/// Every word of sample n is a different function of n, so that a mixture of two samples cannot pass for one.
Payload sample(std::uint64_t n) {
  Payload payload;
  for (std::uint64_t i = 0; i < payload.size() / 8; ++i) {
    const std::uint64_t word = (n + i) * 0x9E37'79B9'7F4A'7C15;
    std::memcpy(payload.data() + i * 8, &word, 8);
  }
  return payload;
}

class QueuedLinkTest : public ::testing::Test {
 protected:
  void write(std::uint64_t n, LinkStatus status = LinkStatus::Valid) {
    writer_.write(sample(n), TimePoint{Duration{n * 1000}}, status);
  }
  void write_up_to(std::uint64_t last) {
    while (written_ < last) write(++written_);
  }

  QueueMemory memory_;
  QueuedWriter writer_ = QueuedWriter::make(memory_.all(), layout_of(payload_octets)).value();
  QueuedReader reader_ = QueuedReader::make(memory_.all(), layout_of(payload_octets)).value();
  std::uint64_t written_{0};
  Payload seen_{};
};

TEST_F(QueuedLinkTest, HasTheFormThatIsWrittenDown) {
  EXPECT_EQ(memory_.word(72).load(), 0xFFFF'FFFF'0000'0000u) << "no status yet";
  write(1, LinkStatus::Degraded);
  EXPECT_EQ(memory_.word(0).load(), queued_memory::magic);
  EXPECT_EQ(memory_.word(8).load(), 0x0000'0001'0000'0007u);
  EXPECT_EQ(memory_.word(16).load(), payload_octets);
  EXPECT_EQ(memory_.word(24).load(), 0x1234'5678'9ABC'DEF0u);
  EXPECT_EQ(memory_.word(32).load(), 1'000'000u);
  EXPECT_EQ(memory_.word(40).load(), depth);
  EXPECT_EQ(memory_.word(64).load(), 1u);
  EXPECT_EQ(memory_.word(72).load(), 0xFFFF'FFFD'0000'0002u);
  EXPECT_EQ(memory_.word(80).load(), 1000u);
  EXPECT_EQ(memory_.word(256).load(), 2u) << "the second slot: twice the count";
  EXPECT_EQ(memory_.word(264).load(), 0xFFFF'FFFD'0000'0002u);
  EXPECT_EQ(memory_.word(272).load(), 1000u);
  EXPECT_EQ(memory_.word(280).load(), 0x9E37'79B9'7F4A'7C15u);
  EXPECT_EQ(queued_memory_octets(payload_octets, depth), 128u + 5 * 128);
  EXPECT_EQ(queued_memory_octets(40, 2), 128u + 3 * 64);
  EXPECT_EQ(queued_memory_octets(41, 2), 128u + 3 * 128);
}

TEST_F(QueuedLinkTest, AGlanceTellsTheNewestSampleAndTakesNothing) {
  write_up_to(2);
  const auto glance = glance_at_queue(memory_.all());
  ASSERT_TRUE(glance);
  EXPECT_EQ(glance->count, 2u);
  EXPECT_EQ(glance->sampled_at, TimePoint{2us});
  EXPECT_EQ(reader_.read(seen_).count, 1u);
  EXPECT_FALSE(glance_at_queue(QueueMemory{}.all()));
  EXPECT_FALSE(glance_at_queue(memory_.all().first(queued_memory::slots_at - 1)));
  EXPECT_TRUE(glance_at_queue(memory_.all().first(queued_memory::slots_at)));
  EXPECT_FALSE(glance_at_queue({}));
  EXPECT_FALSE(glance_at_queue(memory_.all().subspan(8))) << "not on a line";
  for (const std::uint64_t other : {queued_memory::magic - 1, queued_memory::magic + 1}) {
    memory_.word(queued_memory::magic_at).store(other);
    EXPECT_FALSE(glance_at_queue(memory_.all())) << "another memory";
  }
}

TEST_F(QueuedLinkTest, HasNothingBeforeTheFirstSampleAndLeavesThePayloadAlone) {
  seen_.fill(std::byte{0x55});
  const Payload before = seen_;
  LinkSample found = reader_.read(seen_);
  EXPECT_EQ(found.flow, Flow::None);
  EXPECT_EQ(found.status, LinkStatus::None);
  EXPECT_EQ(found.count, 0u);
  writer_.set_status(LinkStatus::Stopping);
  found = reader_.read(seen_);
  EXPECT_EQ(found.flow, Flow::None);
  EXPECT_EQ(found.status, LinkStatus::Stopping);
  EXPECT_EQ(seen_, before);
}

TEST_F(QueuedLinkTest, AnOldSampleIsTheLastOneAgainAndNothingIsLostTwice) {
  write_up_to(depth + 3);
  EXPECT_EQ(reader_.read(seen_).lost, 3u);
  while (reader_.read(seen_).flow == Flow::New) {}
  seen_ = {};
  const LinkSample found = reader_.read(seen_);
  EXPECT_EQ(found.flow, Flow::Old);
  EXPECT_EQ(found.count, depth + 3);
  EXPECT_EQ(found.lost, 0u);
  EXPECT_EQ(found.sampled_at, TimePoint{7us});
  EXPECT_EQ(seen_, sample(depth + 3));
}

TEST_F(QueuedLinkTest, WithASampleThatItsProducerNeverFinishedAllThoseBeforeItAreThere) {
  write_up_to(depth);
  memory_.word(slot_of(depth + 1)).store(2 * (depth + 1) - 1);  // what a producer killed in write() leaves behind
  memory_.word(slot_of(depth + 1) + queued_memory::payload_in_slot).store(0xDEAD);
  for (std::uint64_t n = 1; n <= depth; ++n) {
    ASSERT_EQ(reader_.read(seen_).count, n);
    ASSERT_EQ(seen_, sample(n));
  }
  EXPECT_EQ(reader_.read(seen_).flow, Flow::Old);
  EXPECT_EQ(seen_, sample(depth));
}

TEST_F(QueuedLinkTest, WritesNothingBesideThePayloadNorIntoTheMemory) {
  constexpr std::byte untouched{0x5A};
  std::array<std::byte, 64 + payload_octets + 64> room;
  for (std::uint64_t n = 1; n < 4; ++n) {
    room.fill(untouched);
    write(n);
    const std::vector<std::byte> before(memory_.all().begin(), memory_.all().end());
    for (const Flow flow : {Flow::New, Flow::Old}) {
      EXPECT_EQ(reader_.read(MutableOctets{room}.subspan(64, payload_octets)).flow, flow);
      EXPECT_TRUE(std::ranges::equal(Octets{room}.subspan(64, payload_octets), sample(n)));
      for (const Octets beside : {Octets{room}.first(64), Octets{room}.last(64)})
        EXPECT_TRUE(std::ranges::all_of(beside, [](std::byte octet) { return octet == untouched; }));
    }
    EXPECT_TRUE(std::ranges::equal(before, memory_.all()));
  }
  EXPECT_TRUE(memory_.beside_is_untouched());
}

TEST(QueuedLinkHeader, IsRefusedWhereItDiffersFromWhatWasAgreed) {
  QueueMemory memory;
  const LinkLayout agreed = layout_of(payload_octets);
  EXPECT_EQ(QueuedReader::make(memory.all(), agreed).error().code, ErrorCode::Mismatch) << "no header yet";
  ASSERT_TRUE(QueuedWriter::make(memory.all(), agreed));
  EXPECT_TRUE(QueuedReader::make(memory.all(), agreed));
  const auto refusal = [&](auto change) {
    LinkLayout other = agreed;
    change(other);
    return std::string_view{QueuedReader::make(memory.all(), other).error().text};
  };
  EXPECT_EQ(refusal([](LinkLayout& of) { ++of.epoch; }), "link epoch");
  EXPECT_EQ(refusal([](LinkLayout& of) { --of.payload_octets; }), "link payload size");
  EXPECT_EQ(refusal([](LinkLayout& of) { of.layout_hash ^= 1; }), "link layout");
  EXPECT_EQ(refusal([](LinkLayout& of) { --of.depth; }), "link depth");
  memory.word(queued_memory::version_epoch_at).store((queued_memory::version + 1) << 32 | agreed.epoch);
  const Error later = QueuedReader::make(memory.all(), agreed).error();
  EXPECT_STREQ(later.text, "link version");
  EXPECT_EQ(later.value, std::int64_t{queued_memory::version + 1});
}

TEST(QueuedLinkHeader, IsRefusedInMemoryThatDoesNotFit) {
  QueueMemory memory;
  const LinkLayout layout = layout_of(payload_octets);
  const auto too_small = memory.all().first(memory.all().size() - 1);
  for (const Error& error :
       {QueuedWriter::make(too_small, layout).error(), QueuedReader::make(too_small, layout).error()}) {
    EXPECT_EQ(error.code, ErrorCode::Mismatch);
    EXPECT_STREQ(error.text, "link memory too small, not aligned, or payload size or depth impossible");
  }
  EXPECT_FALSE(QueuedWriter::make(memory.all().subspan(8), layout_of(8, 2)).has_value()) << "not on a line";
  EXPECT_FALSE(QueuedWriter::make(memory.all(), layout_of(0)).has_value());
  EXPECT_FALSE(QueuedWriter::make(memory.all(), layout_of(8, 1)).has_value());
  EXPECT_FALSE(QueuedReader::make({}, layout).has_value());
}

TEST(QueuedLinkHeader, OfAnImpossibleSizeOrDepthIsNotEvenGivenMemory) {
  const QueuedLink link;
  HeapMemory memory;
  const auto shared = link.establish(memory, layout_of(payload_octets));
  ASSERT_TRUE(shared);
  for (const LinkLayout& impossible : {layout_of(0), layout_of(max_link_payload_octets + 1), layout_of(8, 1)}) {
    const auto established = link.establish(memory, impossible);
    ASSERT_FALSE(established);
    EXPECT_EQ(established.error().code, ErrorCode::Mismatch);
    EXPECT_STREQ(established.error().text, "link payload size or depth");
    EXPECT_EQ(established.error().value, impossible.payload_octets);
    const auto refused = [&](const auto& end) { return end ? "" : end.error().text; };
    EXPECT_STREQ(refused(link.produce(memory, *shared, impossible)), "link payload size or depth");
    EXPECT_STREQ(refused(link.consume(memory, *shared, impossible)), "link payload size or depth");
  }
}

TEST(QueuedLinkHeader, MemoryThatWasUsedBeforeBeginsAnew) {
  QueueMemory memory;
  std::ranges::fill(memory.all(), std::byte{0xA5});
  QueuedWriter writer = QueuedWriter::make(memory.all(), layout_of(payload_octets)).value();
  QueuedReader reader = QueuedReader::make(memory.all(), layout_of(payload_octets)).value();
  Payload seen{};
  EXPECT_EQ(reader.read(seen).flow, Flow::None);
  EXPECT_EQ(glance_at_queue(memory.all())->count, 0u);
  EXPECT_EQ(glance_at_queue(memory.all())->sampled_at, TimePoint{});
  writer.write(sample(1), TimePoint{42ns}, LinkStatus::Valid);
  EXPECT_EQ(reader.read(seen).count, 1u);
  EXPECT_EQ(seen, sample(1));
  EXPECT_TRUE(memory.beside_is_untouched());
}

TEST(QueuedLinkPayload, MayHaveAnyLength) {
  for (std::uint32_t octets = 1; octets <= 100; ++octets) {
    QueueMemory memory{octets, 2};
    QueuedWriter writer = QueuedWriter::make(memory.all(), layout_of(octets, 2)).value();
    QueuedReader reader = QueuedReader::make(memory.all(), layout_of(octets, 2)).value();
    std::vector<std::byte> seen(octets);
    for (int n = 1; n <= 4; ++n) {
      const std::vector<std::byte> sent(octets, static_cast<std::byte>(0xA5 + n));
      writer.write(sent, {}, LinkStatus::Valid);
      ASSERT_EQ(reader.read(seen).flow, Flow::New);
      ASSERT_EQ(sent, seen) << octets;
    }
    EXPECT_TRUE(memory.beside_is_untouched()) << octets;
  }
}

// --- damage ----------------------------------------------------------------------------------------------------------

/// What may become of a word of shared memory: one flipped bit, and whole words that damage leaves behind (hazard SF19).
std::vector<std::uint64_t> damages(std::uint64_t word) {
  std::vector<std::uint64_t> damaged{0,
                                     ~std::uint64_t{0},
                                     ~word,
                                     0x5555'5555'5555'5555,
                                     0xAAAA'AAAA'AAAA'AAAA,
                                     word + 1,
                                     word - 1,
                                     word + 2,
                                     word - 2,
                                     0xFFFF'FFFF'0000'0000,
                                     word * 2,
                                     word + 2 * slots,
                                     word + slots};
  for (unsigned bit = 0; bit < 64; ++bit) damaged.push_back(word ^ std::uint64_t{1} << bit);
  std::erase(damaged, word);
  return damaged;
}
constexpr std::size_t most_damages = 13 + 64;

TEST(QueuedLinkDamage, OfTheFirstLineIsSeenWhenTheLinkIsMade) {
  using namespace queued_memory;
  QueueMemory memory;
  const LinkLayout layout = layout_of(payload_octets);
  ASSERT_TRUE(QueuedWriter::make(memory.all(), layout));
  for (const std::size_t at : {magic_at, version_epoch_at, payload_octets_at, layout_hash_at, depth_at}) {
    const std::uint64_t good = memory.word(at).load();
    for (const std::uint64_t damaged : damages(good)) {
      memory.word(at).store(damaged);
      EXPECT_EQ(QueuedReader::make(memory.all(), layout).error().code, ErrorCode::Mismatch) << at << ' ' << damaged;
    }
    memory.word(at).store(good);
  }
}

TEST_F(QueuedLinkTest, DamageOfAStatusIsAFaultWhateverItWas) {
  for (const std::size_t at : {queued_memory::status_at, slot_of(0) + queued_memory::status_in_slot})
    for (const auto status : {LinkStatus::Valid, LinkStatus::Degraded, LinkStatus::Stopping, LinkStatus::Fault}) {
      const auto read_as = [&](auto change) {
        while (++written_ % slots != 0) write(written_);
        write(written_, status);
        while (reader_.read(seen_).count + 1 < written_) {}
        memory_.word(at).store(change(memory_.word(at).load()));
        const LinkSample found = reader_.read(seen_);
        EXPECT_EQ(found.count, written_);
        return found.status;
      };
      EXPECT_EQ(read_as([](std::uint64_t word) { return word; }), status);
      const auto good = memory_.word(at).load();
      for (const std::uint64_t damage : damages(good))
        EXPECT_EQ(read_as([damage](std::uint64_t) { return damage; }), LinkStatus::Fault) << at << ' ' << damage;
    }
}

/// A word is damaged while samples wait to be read. What is read then is in order, each at most once and as it was written but for
/// the damaged word itself; nothing is counted that is not there; and when the ring was written over once, all is as before.
TEST_F(QueuedLinkTest, DamageOfAnyWordCostsSamplesAndNothingElse) {
  const std::size_t words = memory_.all().size() / 8;
  std::uint64_t count = 0;
  const auto drain = [&](std::size_t damaged_at, std::uint64_t damage) {
    std::uint64_t lost = 0;
    // Bounded: a reader that never came to an end would give more than there is.
    for (std::uint64_t reads = 0; reads <= 4 * slots; ++reads) {
      const LinkSample found = reader_.read(seen_);
      EXPECT_TRUE(found.count <= written_) << damaged_at << ' ' << damage;
      if (found.flow != Flow::New) {
        EXPECT_EQ(found.count, count);
        continue;
      }
      EXPECT_EQ(found.count, count + found.lost + 1) << damaged_at << ' ' << damage;
      count = found.count;
      lost += found.lost;
      const std::size_t payload = slot_of(count) + queued_memory::payload_in_slot;
      const bool its_payload = damaged_at >= payload && damaged_at < payload + payload_octets;
      EXPECT_TRUE(its_payload || seen_ == sample(count)) << damaged_at << ' ' << damage;
    }
    return lost;
  };
  std::size_t turn = 0;
  for (std::size_t at = queued_memory::newest_at; at < words * 8; at += 8)
    for (std::uint64_t waiting = 0; waiting <= depth; ++waiting)
      for (std::size_t i = 0; i < most_damages; ++i) {
        if (++turn % hirosco::testing::one_in(std::size_t{7}) != 0) continue;
        // Every place of the ring is the newest one in turn.
        write_up_to(written_ + 1 + i % 2);
        drain(0, 0);
        ASSERT_EQ(count, written_);
        write_up_to(written_ + waiting);
        const auto all = damages(memory_.word(at).load());
        if (i >= all.size()) break;
        const std::uint64_t damage = all[i];
        memory_.word(at).store(damage);
        EXPECT_LE(drain(at, damage), 1u) << at << ' ' << damage << ": one word, one sample";
        // A producer that goes on: the damaged place is written over, and not one sample of these is missing.
        for (std::uint64_t next = 0; next < slots; ++next) {
          write_up_to(written_ + 1);
          EXPECT_LE(drain(at, damage), 1u) << at << ' ' << damage;
        }
        ASSERT_EQ(count, written_) << at << ' ' << damage;
        write_up_to(written_ + depth);
        ASSERT_EQ(drain(0, 0), 0u) << at << ' ' << damage;
        ASSERT_EQ(count, written_) << at << ' ' << damage;
      }
  EXPECT_TRUE(memory_.beside_is_untouched());
}

TEST_F(QueuedLinkTest, ASampleWhoseSlotIsDamagedIsLostAndThoseBehindItCome) {
  write_up_to(depth);
  memory_.word(slot_of(2)).store(1);
  EXPECT_EQ(reader_.read(seen_).count, 1u);
  const LinkSample found = reader_.read(seen_);
  EXPECT_EQ(found.flow, Flow::New);
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.lost, 1u);
  EXPECT_EQ(seen_, sample(3));
  memory_.word(slot_of(4)).store(1);
  write_up_to(5);
  EXPECT_EQ(reader_.read(seen_).lost, 1u);
  EXPECT_EQ(reader_.read(seen_).lost, 0u) << "told once";
}

TEST(QueuedLinkDamage, OfAllSlotsButTheNewestCostsThemAllAndEachReadIsBounded) {
  constexpr std::uint32_t kept = 100;
  QueueMemory memory{payload_octets, kept};
  QueuedWriter writer = QueuedWriter::make(memory.all(), layout_of(payload_octets, kept)).value();
  QueuedReader reader = QueuedReader::make(memory.all(), layout_of(payload_octets, kept)).value();
  for (std::uint64_t n = 1; n <= kept; ++n) writer.write(sample(n), {}, LinkStatus::Valid);
  for (std::uint64_t n = 1; n < kept; ++n) memory.word(queued_memory::slots_at + n * slot_size).store(n);
  Payload seen{};
  LinkSample found = reader.read(seen);
  EXPECT_EQ(found.flow, Flow::None) << "a read does not pass over a hundred at once";
  for (std::uint32_t reads = 0; reads < kept && found.flow == Flow::None; ++reads) found = reader.read(seen);
  EXPECT_EQ(found.flow, Flow::New);
  EXPECT_EQ(found.count, kept);
  EXPECT_EQ(found.lost, kept - 1);
  EXPECT_EQ(seen, sample(kept));
}

TEST_F(QueuedLinkTest, OfAProducerThatForgesItsCountNothingComesTwiceNorAfterALaterOne) {
  write_up_to(3);
  while (reader_.read(seen_).flow == Flow::New) {}
  // Both places agree: a count far ahead, then the way back.
  constexpr std::uint64_t forged = 1'000'000;
  memory_.word(slot_of(forged)).store(2 * forged);
  memory_.word(queued_memory::newest_at).store(forged);
  const LinkSample found = reader_.read(seen_);
  EXPECT_EQ(found.flow, Flow::New);
  EXPECT_EQ(found.count, forged);
  EXPECT_EQ(found.lost, forged - 4);
  write_up_to(20);
  for (int look = 0; look < 20; ++look) EXPECT_EQ(reader_.read(seen_).flow, Flow::Old);
  EXPECT_TRUE(memory_.beside_is_untouched());
}

TEST(QueuedLinkDamage, ACountWhoseDoubleIsThatOfASampleIsNone) {
  // Where the slots are a power of two, the highest bit leaves the slot as it is, and it is lost when doubled.
  QueueMemory memory{payload_octets, 3};
  QueuedWriter writer = QueuedWriter::make(memory.all(), layout_of(payload_octets, 3)).value();
  QueuedReader reader = QueuedReader::make(memory.all(), layout_of(payload_octets, 3)).value();
  writer.write(sample(1), {}, LinkStatus::Valid);
  memory.word(queued_memory::newest_at).store(1 + (std::uint64_t{1} << 63));
  Payload seen{};
  EXPECT_EQ(reader.read(seen).count, 1u);
  writer.write(sample(2), {}, LinkStatus::Valid);
  EXPECT_EQ(reader.read(seen).count, 2u);
}

}  // namespace
}  // namespace hirosco::queueing
