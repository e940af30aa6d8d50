// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: link core (docs/safety/modules.csv).
#include "hirosco/data_transfer/link/latest_link.hpp"

#include <atomic>
#include <bit>
#include <cassert>
#include <cstring>
#include <new>
#include <utility>

#include "hirosco/data_transfer/link/detail/link_words.hpp"
#include "hirosco/data_transfer/link/detail/wide_words.hpp"
#include "hirosco/utilities/processor.hpp"

// A sequence lock over words of 8 octets, for one writer and any number of readers. Invariants:
//  1. Line 0 is written once, in LatestWriter::make, its magic last; nobody writes it after that.
//  2. Only the writer writes. Its sequence is odd from before the first word of a sample is stored until after the last.
//  3. The writer stores every word of a sample with release order. A reader that loads such a word with acquire order
//     has therefore also seen the odd sequence before it (2), and finds at its second look a sequence other than the
//     even one it began with. Fences would do the same; thread sanitizers do not understand them. Where two words are
//     moved at once (detail/wide_words.hpp) the processor has that order by itself.
//  4. The writer stores the even sequence with release order, a reader loads it with acquire order first: the words it
//     then loads are those of this sample or newer ones, never older ones. With 3: equal even sequences, whole sample.
//  5. A reader tries `attempts` times, then answers with its own last copy. It never waits for a writer, which may be
//     preempted by it, stopped or dead.
//  6. A consumer that sleeps waits for another sequence: it may be woken in the middle of a sample, finds the odd one then, and the
//     even one after it is another one again. No sample is slept through.
//  7. A reader believes nothing it has read but as data: no length, index or address comes from the memory.
namespace hirosco {
namespace {

using Words = detail::LinkWords;
using Word = Words::Word;

constexpr int attempts = 8;

bool plausible(const LinkLayout& layout) noexcept {
  return layout.payload_octets >= 1 && layout.payload_octets <= max_link_payload_octets;
}

bool fits(const void* start, std::size_t octets, const LinkLayout& layout) noexcept {
  return plausible(layout) && Words::on_a_line(start) && octets >= link_memory_octets(layout.payload_octets);
}

Word version_epoch(const LinkLayout& layout) noexcept { return link_memory::version << 32 | layout.epoch; }

}  // namespace

std::size_t link_memory_octets(std::uint32_t payload_octets) noexcept {
  return Words::in_lines(link_memory::payload_at + Words::words_of(payload_octets) * sizeof(Word));
}

std::optional<LinkGlance> glance_at_link(Octets memory) noexcept {
  if (!Words::on_a_line(memory.data()) || memory.size() < link_memory::payload_at) return std::nullopt;
  if (Words::load(memory.data(), link_memory::magic_at, std::memory_order_acquire) != link_memory::magic)
    return std::nullopt;
  const auto stamp = Words::load(memory.data(), link_memory::stamp_at, std::memory_order_relaxed);
  return LinkGlance{Words::load(memory.data(), link_memory::count_at, std::memory_order_relaxed),
                    Words::time_of(stamp)};
}

Result<LatestWriter> LatestWriter::make(MutableOctets memory, const LinkLayout& layout) noexcept {
  if (!fits(memory.data(), memory.size(), layout)) {
    return fail(ErrorCode::Mismatch, "link memory too small, not aligned, or payload size impossible",
                layout.payload_octets);
  }
  std::byte* const start = memory.data();
  const auto set = [start](std::size_t at, Word value) {
    Words::word(start, at).store(value, std::memory_order_relaxed);
  };
  const std::size_t all = link_memory_octets(layout.payload_octets);
  for (std::size_t at = 0; at < all; at += sizeof(Word)) set(at, 0);
  set(link_memory::version_epoch_at, version_epoch(layout));
  set(link_memory::payload_octets_at, layout.payload_octets);
  set(link_memory::layout_hash_at, layout.layout_hash);
  set(link_memory::period_at, std::bit_cast<Word>(std::int64_t{layout.period.count()}));
  Words::word(start, link_memory::magic_at).store(link_memory::magic, std::memory_order_release);

  LatestWriter writer;
  writer.memory_ = start;
  writer.payload_octets_ = layout.payload_octets;
  writer.wakes_ = layout.wakes;
  return writer;
}

void LatestWriter::write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept {
  assert(memory_ != nullptr && payload.size() == payload_octets_);
  const auto publish = [this](std::size_t at, Word value) {
    Words::word(memory_, at).store(value, std::memory_order_release);
  };
  claim_lines(memory_ + link_memory::sequence_at, link_memory::payload_at - link_memory::sequence_at + payload_octets_);
  Words::word(memory_, link_memory::sequence_at).store(++sequence_, std::memory_order_relaxed);
  publish(link_memory::status_at, Words::coded(status));
  publish(link_memory::count_at, ++count_);
  publish(link_memory::stamp_at, Words::stamp_of(sampled_at));
  const std::size_t whole = payload_octets_ / sizeof(Word) * sizeof(Word);
  for (std::size_t at = detail::store_wide(payload.data(), memory_ + link_memory::payload_at, whole); at < whole;
       at += sizeof(Word)) {
    Word value;
    std::memcpy(&value, payload.data() + at, sizeof value);
    publish(link_memory::payload_at + at, value);
  }
  if (whole != payload_octets_) {
    Word value = 0;
    std::memcpy(&value, payload.data() + whole, payload_octets_ - whole);
    publish(link_memory::payload_at + whole, value);
  }
  publish(link_memory::sequence_at, ++sequence_);
  if (wakes_) detail::LinkWords::wake(memory_, link_memory::sequence_at);
}

void LatestWriter::set_status(LinkStatus status) noexcept {
  assert(memory_ != nullptr);
  Words::word(memory_, link_memory::sequence_at).store(++sequence_, std::memory_order_relaxed);
  Words::word(memory_, link_memory::status_at).store(Words::coded(status), std::memory_order_release);
  Words::word(memory_, link_memory::sequence_at).store(++sequence_, std::memory_order_release);
}

Result<LatestReader> LatestReader::make(Octets memory, const LinkLayout& layout) noexcept {
  if (!fits(memory.data(), memory.size(), layout)) {
    return fail(ErrorCode::Mismatch, "link memory too small, not aligned, or payload size impossible",
                layout.payload_octets);
  }
  const std::byte* const start = memory.data();
  const auto get = [start](std::size_t at) { return Words::load(start, at, std::memory_order_relaxed); };
  if (Words::load(start, link_memory::magic_at, std::memory_order_acquire) != link_memory::magic)
    return fail(ErrorCode::Mismatch, "link memory has no header");
  if (get(link_memory::version_epoch_at) >> 32 != link_memory::version)
    return fail(ErrorCode::Mismatch, "link version",
                static_cast<std::int64_t>(get(link_memory::version_epoch_at) >> 32));
  if (get(link_memory::version_epoch_at) != version_epoch(layout))
    return fail(ErrorCode::Mismatch, "link epoch", static_cast<std::uint32_t>(get(link_memory::version_epoch_at)));
  if (get(link_memory::payload_octets_at) != layout.payload_octets)
    return fail(ErrorCode::Mismatch, "link payload size",
                std::bit_cast<std::int64_t>(get(link_memory::payload_octets_at)));
  if (get(link_memory::layout_hash_at) != layout.layout_hash)
    return fail(ErrorCode::Mismatch, "link layout", std::bit_cast<std::int64_t>(get(link_memory::layout_hash_at)));

  LatestReader reader;
  reader.memory_ = start;
  reader.payload_octets_ = layout.payload_octets;
  reader.kept_.reset(new (std::nothrow) Word[Words::words_of(layout.payload_octets)]{});
  reader.arriving_.reset(new (std::nothrow) Word[Words::words_of(layout.payload_octets)]{});
  if (!reader.kept_ || !reader.arriving_) return fail(ErrorCode::ResourceExhausted, "no memory for a link's copy");
  return reader;
}

LinkSample LatestReader::read(MutableOctets payload) noexcept {
  assert(memory_ != nullptr && payload.size() == payload_octets_);
  const auto get = [this](std::size_t at) { return Words::load(memory_, at, std::memory_order_acquire); };
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const Word sequence = get(link_memory::sequence_at);
    if (sequence == last_sequence_) return last(payload);
    if (sequence % 2 == 0) {
      const Word status = get(link_memory::status_at);
      const Word count = get(link_memory::count_at);
      const Word stamp = get(link_memory::stamp_at);
      copy(payload);
      if (Words::load(memory_, link_memory::sequence_at, std::memory_order_relaxed) == sequence) {
        last_sequence_ = sequence;
        return accept(status, count, stamp, payload);
      }
    }
    relax(attempt);
  }
  return last(payload);
}

// Into both places as it comes: a second copy of what was stored a moment ago would wait for the store buffer. What is
// torn in `payload` is put right by last(); before the first sample it could not be, so accept() fills it then.
void LatestReader::copy(MutableOctets payload) noexcept {
  const auto get = [this](std::size_t at) { return Words::load(memory_, at, std::memory_order_acquire); };
  const std::size_t direct = last_.count == 0 ? 0 : payload_octets_ / sizeof(Word);
  const std::size_t wide =
      detail::load_wide(memory_ + link_memory::payload_at, reinterpret_cast<std::byte*>(arriving_.get()),
                        payload.data(), direct * sizeof(Word));
  for (std::size_t i = wide / sizeof(Word); i < direct; ++i) {
    const Word value = arriving_[i] = get(link_memory::payload_at + i * sizeof(Word));
    std::memcpy(payload.data() + i * sizeof value, &value, sizeof value);
  }
  for (std::size_t i = direct; i < Words::words_of(payload_octets_); ++i)
    arriving_[i] = get(link_memory::payload_at + i * sizeof(Word));
}

const std::uint32_t* LatestReader::arrival_word() const noexcept {
  return detail::LinkWords::low_half(memory_, link_memory::sequence_at);
}

LinkSample LatestReader::last(MutableOctets payload) const noexcept {
  LinkSample sample = last_;
  sample.flow = last_.count == 0 ? Flow::None : Flow::Old;
  if (sample.flow == Flow::Old) std::memcpy(payload.data(), kept_.get(), payload_octets_);
  return sample;
}

// Word by word: a sample that was put together in memory and then copied as a whole would wait for the store buffer, too.
LinkSample LatestReader::accept(Word status, Word count, Word stamp, MutableOctets payload) noexcept {
  const std::uint64_t before = last_.count;
  last_.status = Words::status_of(status);
  last_.count = count;
  last_.sampled_at = Words::time_of(stamp);
  if (count == before) return last(payload);
  std::swap(kept_, arriving_);
  const std::size_t direct = before == 0 ? 0 : payload_octets_ / sizeof(Word) * sizeof(Word);
  if (direct != payload_octets_)
    std::memcpy(payload.data() + direct, reinterpret_cast<const std::byte*>(kept_.get()) + direct,
                payload_octets_ - direct);
  return {.flow = Flow::New,
          .status = last_.status,
          .count = count,
          .lost = before != 0 && count > before ? count - before - 1 : 0,
          .sampled_at = last_.sampled_at};
}

// --- the mechanism ---------------------------------------------------------------------------------------------------

namespace {

class LatestView final : public LinkView {
 public:
  explicit LatestView(Mapping mapping) noexcept : mapping_{std::move(mapping)} {}
  [[nodiscard]] std::optional<LinkGlance> glance() const noexcept override { return glance_at_link(mapping_.octets); }

 private:
  Mapping mapping_;
};

}  // namespace

Result<MemoryHandle> LatestLink::establish(MemoryProvider& provider, const LinkLayout& layout) const {
  if (!plausible(layout) || layout.payload_octets > max_payload_ || (layout.wakes && !wakes()))
    return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  return provider.create("hirosco-link", link_memory_octets(layout.payload_octets));
}

Result<std::unique_ptr<LinkWriter>> LatestLink::produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                        const LinkLayout& layout) const {
  HIROSCO_TRY(provider.verify(shared, link_memory_octets(layout.payload_octets), false));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadWrite));
  HIROSCO_TRY_LET(LatestWriter writer, LatestWriter::make(mapping.octets, layout));
  HIROSCO_TRY(provider.seal_writers(shared));
  writer.keep(std::move(mapping));
  return std::make_unique<LatestWriter>(std::move(writer));
}

Result<std::unique_ptr<LinkReader>> LatestLink::consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                        const LinkLayout& layout) const {
  HIROSCO_TRY(provider.verify(shared, link_memory_octets(layout.payload_octets), true));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  HIROSCO_TRY_LET(LatestReader reader, LatestReader::make(mapping.octets, layout));
  reader.keep(std::move(mapping));
  return std::make_unique<LatestReader>(std::move(reader));
}

Result<std::unique_ptr<LinkView>> LatestLink::look(MemoryProvider& provider, const MemoryHandle& shared) const {
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  return std::make_unique<LatestView>(std::move(mapping));
}

}  // namespace hirosco
