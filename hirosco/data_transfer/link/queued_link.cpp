// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: link core (docs/safety/modules.csv).
#include "hirosco/data_transfer/link/queued_link.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>

#include "hirosco/data_transfer/link/detail/link_words.hpp"

// A ring of slots, each with a sequence of its own, for one producer and any number of consumers. Invariants:
//  1. Line 0 is written once, in QueuedWriter::make, its magic last; nobody writes it after that.
//  2. Only the producer writes. Sample n is written into slot n % (depth + 1). The slot's sequence is 2n - 1 from before its first
//     word is stored until after its last one, and 2n then. After that the newest count is n.
//  3. Every word is stored with release order and read with acquire order. A consumer that has read a word of a later sample finds at
//     its second look a sequence other than 2n; one that finds 2n before and after has read sample n whole.
//  4. One slot is more than `depth`: while sample n + 1 is written, the samples n - depth + 1 .. n are all whole. Samples before these are
//     not asked for, so that what is lost depends on how far a consumer fell behind and not on who of the two is quicker.
//  5. That a sample is there stand two words for: the newest count, which is not below it, and the sequence of its slot. A consumer reads
//     and passes over samples only by both: no damage of one word brings a sample that is none, or keeps those that are there.
//  6. A sample that was published and is not whole in its slot is gone: overwritten meanwhile, or damaged there. It is given up as soon as
//     the newest count is sure (5), else a consumer would wait for it until the ring had come around.
//  7. Nobody waits. A consumer tries `attempts` times, then answers with its own last copy. The producer does not know of consumers.
//  8. A consumer believes nothing it has read but as data: a count is taken modulo the slots, sizes are those of the agreement.
namespace hirosco {
namespace {

struct Queue : detail::LinkWords {
  static std::uint64_t slots(std::uint32_t depth) noexcept { return std::uint64_t{depth} + 1; }
  static std::size_t slot_at(std::uint64_t count, std::uint32_t payload_octets, std::uint32_t depth) noexcept {
    return queued_memory::slots_at + count % slots(depth) * queued_memory::slot_octets(payload_octets);
  }
  static bool plausible(const LinkLayout& layout) noexcept {
    return layout.payload_octets >= 1 && layout.payload_octets <= max_link_payload_octets &&
           queue_fits(layout.depth, layout.payload_octets);
  }
  static bool fit(Octets memory, const LinkLayout& layout) noexcept {
    return plausible(layout) && on_a_line(memory.data()) &&
           memory.size() >= queued_memory_octets(layout.payload_octets, layout.depth);
  }
  static Word version_epoch(const LinkLayout& layout) noexcept { return queued_memory::version << 32 | layout.epoch; }
  static constexpr const char* no_fit = "link memory too small, not aligned, or payload size or depth impossible";
};

}  // namespace

std::size_t queued_memory::slot_octets(std::uint32_t payload_octets) noexcept {
  return Queue::in_lines(payload_in_slot + payload_octets);
}

std::size_t queued_memory_octets(std::uint32_t payload_octets, std::uint32_t depth) noexcept {
  return queued_memory::slots_at + Queue::slots(depth) * queued_memory::slot_octets(payload_octets);
}

std::optional<LinkGlance> glance_at_queue(Octets memory) noexcept {
  using namespace queued_memory;
  if (!Queue::on_a_line(memory.data()) || memory.size() < slots_at) return std::nullopt;
  if (Queue::load(memory.data(), magic_at, std::memory_order_acquire) != magic) return std::nullopt;
  const Queue::Word count = Queue::load(memory.data(), newest_at, std::memory_order_acquire);
  return LinkGlance{count, Queue::time_of(Queue::load(memory.data(), stamp_at, std::memory_order_relaxed))};
}

// --- the producer ----------------------------------------------------------------------------------------------------

Result<QueuedWriter> QueuedWriter::make(MutableOctets memory, const LinkLayout& layout) noexcept {
  using namespace queued_memory;
  if (!Queue::fit(memory, layout)) return fail(ErrorCode::Mismatch, Queue::no_fit, layout.payload_octets);
  std::byte* const start = memory.data();
  const auto set = [start](std::size_t at, Queue::Word value) {
    Queue::word(start, at).store(value, std::memory_order_relaxed);
  };
  // All of it, so that no slot brings a page fault into the cycle.
  const std::size_t all = queued_memory_octets(layout.payload_octets, layout.depth);
  for (std::size_t at = 0; at < all; at += sizeof(Queue::Word)) set(at, 0);
  set(status_at, Queue::coded(LinkStatus::None));  // what is read before the first sample
  set(version_epoch_at, Queue::version_epoch(layout));
  set(payload_octets_at, layout.payload_octets);
  set(layout_hash_at, layout.layout_hash);
  set(period_at, std::bit_cast<Queue::Word>(std::int64_t{layout.period.count()}));
  set(depth_at, layout.depth);
  Queue::word(start, magic_at).store(magic, std::memory_order_release);

  QueuedWriter writer;
  writer.memory_ = start;
  writer.payload_octets_ = layout.payload_octets;
  writer.depth_ = layout.depth;
  writer.wakes_ = layout.wakes;
  return writer;
}

void QueuedWriter::write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept {
  using namespace queued_memory;
  assert(payload.size() == payload_octets_);
  const auto set = [this](std::size_t at, Queue::Word value) {
    Queue::word(memory_, at).store(value, std::memory_order_release);
  };
  ++count_;
  const std::size_t slot = Queue::slot_at(count_, payload_octets_, depth_);
  claim_lines(memory_ + newest_at, sizeof(Queue::Word));
  claim_lines(memory_ + slot, payload_in_slot + payload_octets_);
  set(slot + sequence_in_slot, 2 * count_ - 1);
  set(slot + status_in_slot, Queue::coded(status));
  set(slot + stamp_in_slot, Queue::stamp_of(sampled_at));
  for (std::size_t at = 0; at < payload_octets_; at += sizeof(Queue::Word)) {
    Queue::Word value = 0;
    std::memcpy(&value, payload.data() + at, std::min(sizeof value, payload_octets_ - at));
    set(slot + payload_in_slot + at, value);
  }
  set(slot + sequence_in_slot, 2 * count_);
  set(status_at, Queue::coded(status));
  set(stamp_at, Queue::stamp_of(sampled_at));
  set(newest_at, count_);
  if (wakes_) Queue::wake(memory_, newest_at);
}

void QueuedWriter::set_status(LinkStatus status) noexcept {
  Queue::word(memory_, queued_memory::status_at).store(Queue::coded(status), std::memory_order_release);
}

// --- a consumer ------------------------------------------------------------------------------------------------------

Result<QueuedReader> QueuedReader::make(Octets memory, const LinkLayout& layout) {
  using namespace queued_memory;
  if (!Queue::fit(memory, layout)) return fail(ErrorCode::Mismatch, Queue::no_fit, layout.payload_octets);
  const std::byte* const start = memory.data();
  const auto get = [start](std::size_t at) { return Queue::load(start, at, std::memory_order_relaxed); };
  if (Queue::load(start, magic_at, std::memory_order_acquire) != magic)
    return fail(ErrorCode::Mismatch, "link memory has no header");
  if (get(version_epoch_at) >> 32 != version)
    return fail(ErrorCode::Mismatch, "link version", static_cast<std::int64_t>(get(version_epoch_at) >> 32));
  if (get(version_epoch_at) != Queue::version_epoch(layout))
    return fail(ErrorCode::Mismatch, "link epoch", static_cast<std::uint32_t>(get(version_epoch_at)));
  if (get(payload_octets_at) != layout.payload_octets)
    return fail(ErrorCode::Mismatch, "link payload size", std::bit_cast<std::int64_t>(get(payload_octets_at)));
  if (get(layout_hash_at) != layout.layout_hash)
    return fail(ErrorCode::Mismatch, "link layout", std::bit_cast<std::int64_t>(get(layout_hash_at)));
  if (get(depth_at) != layout.depth)
    return fail(ErrorCode::Mismatch, "link depth", std::bit_cast<std::int64_t>(get(depth_at)));
  // Every page is looked at once, so that none is missing in the cycle.
  const std::size_t all = queued_memory_octets(layout.payload_octets, layout.depth);
  for (std::size_t at = 0; at < all; at += Queue::page) static_cast<void>(get(at));

  QueuedReader reader;
  reader.memory_ = start;
  reader.payload_octets_ = layout.payload_octets;
  reader.depth_ = layout.depth;
  reader.kept_.resize(Queue::words_of(layout.payload_octets));
  reader.arriving_.resize(reader.kept_.size());
  // What was overwritten before this consumer came is not lost: nobody owed it.
  std::optional<std::uint64_t> newest;
  for (int attempt = 0; attempt < Queue::attempts && !newest; ++attempt) newest = reader.newest();
  if (newest && *newest > layout.depth) reader.passed_ = reader.told_ = *newest - layout.depth;
  return reader;
}

/// Count of the newest sample. Empty: it changed meanwhile, or one of its two places is damaged (5).
std::optional<std::uint64_t> QueuedReader::newest() const noexcept {
  using namespace queued_memory;
  const std::uint64_t count = Queue::load(memory_, newest_at, std::memory_order_acquire);
  if (count > std::numeric_limits<std::uint64_t>::max() / 2) return std::nullopt;  // its double would be another one's
  const std::size_t slot = Queue::slot_at(count, payload_octets_, depth_);
  if (Queue::load(memory_, slot + sequence_in_slot, std::memory_order_acquire) != 2 * count) return std::nullopt;
  return count;
}

LinkSample QueuedReader::read(MutableOctets payload) noexcept {
  assert(payload.size() == payload_octets_);
  for (int attempt = 0; attempt < Queue::attempts; ++attempt) {
    const std::uint64_t told_newest = Queue::load(memory_, queued_memory::newest_at, std::memory_order_acquire);
    if (told_newest <= passed_) return last(payload);  // below: damage, no earlier sample passes for a new one
    if (told_newest - passed_ > depth_) {
      const auto sure = newest();
      if (sure && *sure > passed_ + depth_) passed_ = *sure - depth_;
    }
    LinkSample sample;
    if (copy(passed_ + 1, sample)) return accept(sample, payload);
    if (newest()) ++passed_;
    relax(attempt);
  }
  return last(payload);
}

bool QueuedReader::copy(std::uint64_t count, LinkSample& sample) noexcept {
  using namespace queued_memory;
  const std::byte* const slot = memory_ + Queue::slot_at(count, payload_octets_, depth_);
  const auto get = [slot](std::size_t at) { return Queue::load(slot, at, std::memory_order_acquire); };
  if (get(sequence_in_slot) != 2 * count) return false;
  sample.count = count;
  sample.status = Queue::status_of(get(status_in_slot));
  sample.sampled_at = Queue::time_of(get(stamp_in_slot));
  for (std::size_t i = 0; i < arriving_.size(); ++i) arriving_[i] = get(payload_in_slot + i * sizeof(Queue::Word));
  return get(sequence_in_slot) == 2 * count;
}

LinkSample QueuedReader::accept(LinkSample sample, MutableOctets payload) noexcept {
  std::swap(kept_, arriving_);
  std::memcpy(payload.data(), kept_.data(), payload_octets_);
  sample.flow = Flow::New;
  sample.status = std::max(sample.status, now());
  sample.lost = sample.count - told_ - 1;
  passed_ = told_ = sample.count;
  return last_ = sample;
}

const std::uint32_t* QueuedReader::arrival_word() const noexcept {
  return Queue::low_half(memory_, queued_memory::newest_at);
}

/// What the producer says of itself now, ahead of the samples that wait.
LinkStatus QueuedReader::now() const noexcept {
  const Queue::Word word = Queue::load(memory_, queued_memory::status_at, std::memory_order_acquire);
  return told_ == 0 && word == Queue::coded(LinkStatus::None) ? LinkStatus::None : Queue::status_of(word);
}

LinkSample QueuedReader::last(MutableOctets payload) const noexcept {
  LinkSample sample = last_;
  sample.status = now();
  sample.flow = last_.count == 0 ? Flow::None : Flow::Old;
  sample.lost = 0;
  if (sample.flow == Flow::Old) std::memcpy(payload.data(), kept_.data(), payload_octets_);
  return sample;
}

// --- the mechanism ---------------------------------------------------------------------------------------------------

namespace {

class QueuedView final : public LinkView {
 public:
  explicit QueuedView(Mapping mapping) noexcept : mapping_{std::move(mapping)} {}
  [[nodiscard]] std::optional<LinkGlance> glance() const noexcept override { return glance_at_queue(mapping_.octets); }

 private:
  Mapping mapping_;
};

}  // namespace

Result<MemoryHandle> QueuedLink::establish(MemoryProvider& provider, const LinkLayout& layout) const {
  if (!Queue::plausible(layout)) return fail(ErrorCode::Mismatch, "link payload size or depth", layout.payload_octets);
  return provider.create("hirosco-queue", queued_memory_octets(layout.payload_octets, layout.depth));
}

Result<std::unique_ptr<LinkWriter>> QueuedLink::produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                        const LinkLayout& layout) const {
  if (!Queue::plausible(layout)) return fail(ErrorCode::Mismatch, "link payload size or depth", layout.payload_octets);
  HIROSCO_TRY(provider.verify(shared, queued_memory_octets(layout.payload_octets, layout.depth), false));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadWrite));
  HIROSCO_TRY_LET(QueuedWriter writer, QueuedWriter::make(mapping.octets, layout));
  HIROSCO_TRY(provider.seal_writers(shared));
  writer.keep(std::move(mapping));
  return std::make_unique<QueuedWriter>(std::move(writer));
}

Result<std::unique_ptr<LinkReader>> QueuedLink::consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                        const LinkLayout& layout) const {
  if (!Queue::plausible(layout)) return fail(ErrorCode::Mismatch, "link payload size or depth", layout.payload_octets);
  HIROSCO_TRY(provider.verify(shared, queued_memory_octets(layout.payload_octets, layout.depth), true));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  HIROSCO_TRY_LET(QueuedReader reader, QueuedReader::make(mapping.octets, layout));
  reader.keep(std::move(mapping));
  return std::make_unique<QueuedReader>(std::move(reader));
}

Result<std::unique_ptr<LinkView>> QueuedLink::look(MemoryProvider& provider, const MemoryHandle& shared) const {
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  return std::make_unique<QueuedView>(std::move(mapping));
}

}  // namespace hirosco
