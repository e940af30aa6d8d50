# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A second method beside shared memory: "unix" in descriptors. A ring in memory stands for its sockets, as the places are counted here
and not how samples travel. It passes the conformance of all mechanisms and a descriptor may ask for it; no file of supervisor/ or
subsystem/ is touched."""
WHO = "a link mechanism"
BEFORE = "3 + 7 in 4 rooms"
GOAL = "own files + 1 row; its word in the schema"
MOST_FILES, MOST_EDITED = 2, 1
MOST_ASKED = 1
ASKED = [
    ("hirosco/descriptor/link_methods.xsd", '<xs:enumeration value="udp"/>', '<xs:enumeration value="udp"/><xs:enumeration value="unix"/>',
     "descriptor_test Schema.HasTheWordsOfEachEnumerationThatTheReaderTakesAndNoOthers"),
]
MADE = [("docs/interfaces/schema.md", "tools/check_schema.py")]
FILES = {"hirosco/data_transfer/link/unix_queue.hpp": """\
#pragma once

#include "hirosco/data_transfer/link/link.hpp"

namespace hirosco {

/// Every sample in order, as long as a consumer is at most 63 behind.
class UnixQueue final : public LinkMechanism {
 public:
  LinkMethod method() const noexcept override { return LinkMethod::Unix; }
  LinkKind kind() const noexcept override { return LinkKind::Queued; }
  Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const override;
  Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider, const MemoryHandle& shared,
                                              const LinkLayout& layout) const override;
  Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider, const MemoryHandle& shared,
                                              const LinkLayout& layout) const override;
  Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider, const MemoryHandle& shared) const override;
};

}  // namespace hirosco
""", "hirosco/data_transfer/link/unix_queue.cpp": """\
#include "hirosco/data_transfer/link/unix_queue.hpp"

#include <atomic>
#include <cstring>
#include <utility>
#include <vector>

namespace hirosco {
namespace {

using Word = std::uint64_t;
constexpr std::uint64_t places = 64;
constexpr Word magic = 0x4B4E'494C'5155'4555;
// The memory's words: what was agreed, status, samples written, time of the newest; then a place for each sample, of which the
// first word is odd while it is written and twice the sample's count afterwards.
enum At : std::size_t { magic_at, epoch_at, octets_at, hash_at, status_at, count_at, newest_at, first_place };

std::size_t payload_words(const LinkLayout& layout) { return (layout.payload_octets + sizeof(Word) - 1) / sizeof(Word); }
std::size_t place_words(const LinkLayout& layout) { return 2 + payload_words(layout); }
bool possible(const LinkLayout& layout) {
  return layout.payload_octets >= 1 && layout.payload_octets <= max_link_payload_octets;
}
std::size_t octets_of(const LinkLayout& layout) {
  return ((first_place + places * place_words(layout)) * sizeof(Word) + 63) / 64 * 64;
}

/// The words of a mapping, and where the place of a sample begins.
class Ring {
 public:
  Ring(Mapping mapping, const LinkLayout& layout) : mapping_{std::move(mapping)}, layout_{layout} {}
  std::atomic_ref<Word> word(std::size_t at) const {
    return std::atomic_ref<Word>{reinterpret_cast<Word*>(mapping_.octets.data())[at]};
  }
  std::size_t place(Word count) const { return first_place + (count % places) * place_words(layout_); }
  const LinkLayout& layout() const { return layout_; }

 private:
  Mapping mapping_;
  LinkLayout layout_;
};

class Writer final : public LinkWriter {
 public:
  explicit Writer(Ring ring) : ring_{std::move(ring)} {}
  void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept override {
    const std::size_t place = ring_.place(++count_);
    const auto stamp = static_cast<Word>(sampled_at.time_since_epoch().count());
    ring_.word(place).store(2 * count_ - 1, std::memory_order_relaxed);
    ring_.word(place + 1).store(stamp, std::memory_order_release);
    for (std::size_t i = 0; i < payload.size(); i += sizeof(Word)) {
      Word value = 0;
      std::memcpy(&value, payload.data() + i, std::min(sizeof value, payload.size() - i));
      ring_.word(place + 2 + i / sizeof(Word)).store(value, std::memory_order_release);
    }
    ring_.word(place).store(2 * count_, std::memory_order_release);
    ring_.word(newest_at).store(stamp, std::memory_order_relaxed);
    set_status(status);
    ring_.word(count_at).store(count_, std::memory_order_release);
  }
  void set_status(LinkStatus status) noexcept override {
    const Word number = std::to_underlying(status);
    ring_.word(status_at).store(~number << 32 | number, std::memory_order_release);
  }

 private:
  Ring ring_;
  Word count_{0};
};

class Reader final : public LinkReader {
 public:
  explicit Reader(Ring ring)
      : ring_{std::move(ring)}, kept_(ring_.layout().payload_octets), arriving_(payload_words(ring_.layout())) {}
  LinkSample read(MutableOctets payload) noexcept override {
    const Word written = ring_.word(count_at).load(std::memory_order_acquire);
    LinkSample sample = last_;
    sample.status = status();
    sample.flow = last_.count == 0 ? Flow::None : Flow::Old;
    sample.lost = 0;
    Word next = last_.count == 0 ? written : last_.count + 1;
    if (written >= places && next + places <= written + 1) next = written - places + 2;
    for (int attempt = 0; attempt < 4 && next != 0 && next <= written && sample.flow != Flow::New; ++attempt, ++next)
      if (copy(next, sample)) {
        sample.flow = Flow::New;
        sample.lost = last_.count == 0 ? 0 : next - last_.count - 1;
        sample.count = next;
        std::memcpy(kept_.data(), arriving_.data(), kept_.size());
        last_ = sample;
      }
    if (sample.flow != Flow::None) std::memcpy(payload.data(), kept_.data(), kept_.size());
    return sample;
  }

 private:
  bool copy(Word count, LinkSample& sample) noexcept {
    const std::size_t place = ring_.place(count);
    if (ring_.word(place).load(std::memory_order_acquire) != 2 * count) return false;
    const auto stamp = ring_.word(place + 1).load(std::memory_order_acquire);
    for (std::size_t i = 0; i < arriving_.size(); ++i)
      arriving_[i] = ring_.word(place + 2 + i).load(std::memory_order_acquire);
    if (ring_.word(place).load(std::memory_order_relaxed) != 2 * count) return false;
    sample.sampled_at = TimePoint{Duration{static_cast<std::int64_t>(stamp)}};
    return true;
  }
  LinkStatus status() const noexcept {
    const Word word = ring_.word(status_at).load(std::memory_order_acquire);
    const auto number = static_cast<std::uint32_t>(word);
    if (word == 0) return LinkStatus::None;
    const bool known = number >= 1 && number <= 3 && static_cast<std::uint32_t>(word >> 32) == ~number;
    return known ? LinkStatus{number} : LinkStatus::Fault;
  }
  Ring ring_;
  std::vector<std::byte> kept_;
  std::vector<Word> arriving_;
  LinkSample last_{};
};

class View final : public LinkView {
 public:
  explicit View(Ring ring) : ring_{std::move(ring)} {}
  std::optional<LinkGlance> glance() const noexcept override {
    const Word count = ring_.word(count_at).load(std::memory_order_acquire);
    if (ring_.word(magic_at).load(std::memory_order_acquire) != magic || count == 0) return std::nullopt;
    const auto stamp = static_cast<std::int64_t>(ring_.word(newest_at).load(std::memory_order_relaxed));
    return LinkGlance{count, TimePoint{Duration{stamp}}};
  }

 private:
  Ring ring_;
};

}  // namespace

Result<MemoryHandle> UnixQueue::establish(MemoryProvider& provider, const LinkLayout& layout) const {
  if (!possible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  return provider.create("hirosco-link", octets_of(layout));
}

Result<std::unique_ptr<LinkWriter>> UnixQueue::produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                          const LinkLayout& layout) const {
  if (!possible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  HIROSCO_TRY(provider.verify(shared, octets_of(layout), false));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadWrite));
  HIROSCO_TRY(provider.seal_writers(shared));
  Ring ring{std::move(mapping), layout};
  ring.word(epoch_at) = layout.epoch;
  ring.word(octets_at) = layout.payload_octets;
  ring.word(hash_at) = layout.layout_hash;
  ring.word(magic_at).store(magic, std::memory_order_release);
  return std::make_unique<Writer>(std::move(ring));
}

Result<std::unique_ptr<LinkReader>> UnixQueue::consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                          const LinkLayout& layout) const {
  if (!possible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  HIROSCO_TRY(provider.verify(shared, octets_of(layout), true));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  Ring ring{std::move(mapping), layout};
  const bool agreed = ring.word(magic_at).load(std::memory_order_acquire) == magic && ring.word(epoch_at) == layout.epoch &&
                      ring.word(octets_at) == layout.payload_octets && ring.word(hash_at) == layout.layout_hash;
  if (!agreed) return fail(ErrorCode::Mismatch, "link was not agreed like this");
  return std::make_unique<Reader>(std::move(ring));
}

Result<std::unique_ptr<LinkView>> UnixQueue::look(MemoryProvider& provider, const MemoryHandle& shared) const {
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  return std::make_unique<View>(Ring{std::move(mapping), {}});
}

}  // namespace hirosco
"""}
EDITS = [
    ("hirosco/data_transfer/link/linux_mechanisms.cpp", '#include "hirosco/data_transfer/link/link.hpp"\n',
     '#include "hirosco/data_transfer/link/link.hpp"\n#include "hirosco/data_transfer/link/unix_queue.hpp"\n'),
    ("hirosco/data_transfer/link/linux_mechanisms.cpp", "    &latest_link,\n", "    &latest_link,\n    &unix_queue,\n"),
    ("hirosco/data_transfer/link/linux_mechanisms.cpp", "const LatestLink latest_link;\n",
     "const LatestLink latest_link;\nconst UnixQueue unix_queue;\n"),
]
SOURCES = ["hirosco/data_transfer/link/linux_mechanisms.cpp", "hirosco/data_transfer/link/unix_queue.cpp"]
TRY = """\
#include "hirosco/data_transfer/link/testing/link_conformance.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::testing {
namespace {

INSTANTIATE_TEST_SUITE_P(BuiltIn, LinkConformance,
                         ::testing::ValuesIn(standard_link_mechanisms().begin(), standard_link_mechanisms().end()));

TEST(UnixLink, BringsASlowConsumerEverySampleInOrder) {
  const LinkLayout layout{.epoch = 1, .payload_octets = 8, .layout_hash = 1, .period = 1ms};
  const auto* queued = find_link_mechanism(standard_link_mechanisms(), LinkMethod::Unix, LinkKind::Queued);
  ASSERT_NE(queued, nullptr);
  HeapMemory memory;
  const auto shared = queued->establish(memory, layout).value();
  const auto writer = queued->produce(memory, shared, layout).value();
  const auto reader = queued->consume(memory, shared, layout).value();
  std::array<std::byte, 8> payload{};
  writer->write(payload, TimePoint{}, LinkStatus::Valid);
  ASSERT_EQ(reader->read(payload).count, 1u);
  for (int i = 0; i < 40; ++i) writer->write(payload, TimePoint{}, LinkStatus::Valid);
  for (std::uint64_t count = 2; count <= 41; ++count) EXPECT_EQ(reader->read(payload).count, count);
}

TEST(UnixLink, ADescriptorMayAskForIt) {
  const descriptor::FileSource source = [](const std::filesystem::path& file) {
    auto text = descriptor::file_system()(file);
    constexpr std::string_view now = "methods=\\"shared_memory\\" byte_order=\\"native\\" kind=\\"latest\\"",
                               then = "methods=\\"unix shared_memory\\" kind=\\"latest queued\\"";
    if (text->find(now) == std::string::npos) return text;
    text->replace(text->find(now), now.size(), then);
    return text;
  };
  const auto reading = descriptor::read_subsystem(HIROSCO_SOURCE_DIR "/hirosco/descriptor/testdata/coronagraph.xml", source);
  for (const auto& problem : reading.problems) ADD_FAILURE() << problem.message;
  EXPECT_TRUE(reading.value);
}

}  // namespace
}  // namespace hirosco::testing
"""
