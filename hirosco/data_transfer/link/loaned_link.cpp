// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: link core (docs/safety/modules.csv).
#include "hirosco/data_transfer/link/loaned_link.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cstring>
#include <vector>

#include "hirosco/data_transfer/link/detail/link_words.hpp"
#include "hirosco/utilities/processor.hpp"

// A ring of places, each with a sequence of its own, for one producer and any number of consumers. Invariants:
//  1. Line 0 is written once, in LoanedWriter::make, its magic last; nobody writes it after that.
//  2. Only the producer writes. Sample n is made in place n % places. The sequence of the place is 2n - 1 from before its first octet
//     is written until after its last one, and 2n then.
//  3. The producer lends place n + 1 only, where n is the newest: the newest is never made anew, and a place is not before three
//     samples after its own were published. Who looks at the newest has two whole periods of the producer at least.
//  4. lend() stores the odd sequence ahead of a release fence. The author's octets are no atomics. A consumer that has read one
//     which was written after the fence finds, behind the acquire fence of whole(), this sequence or a later one: not 2n.
//  5. publish() stores the sequence 2n, then the newest count, with release order; newest() loads them with acquire order in turn: what
//     it tells was written whole. With 4: looked at, and 2n afterwards: whole.
//  6. Nobody waits. A consumer tries `attempts` times, then tells what it told last. The producer does not know of consumers.
//  7. A consumer believes nothing it has read but as data: a count is taken modulo `places`, sizes are those of the agreement.
namespace hirosco {
namespace {

/// The words of such a memory. In a class, as these names are those of other mechanisms, too.
struct Loans : detail::LinkWords {
  static std::size_t place_at(std::uint64_t count, std::uint32_t payload_octets) noexcept {
    return loaned_memory::payload_at + count % loaned_memory::places * in_lines(payload_octets);
  }

  static bool plausible(const LinkLayout& layout) noexcept {
    return layout.payload_octets >= 1 && layout.payload_octets <= max_loaned_payload_octets;
  }
  static bool fit(const void* start, std::size_t octets, const LinkLayout& layout) noexcept {
    return plausible(layout) && on_a_line(start) && octets >= loaned_memory_octets(layout.payload_octets);
  }

  // Thread sanitizers do not understand fences, and the compiler refuses them there. Tests under one write and read what is lent
  // as atomic words in release and acquire order, which does the same.
  static void fence(std::memory_order order) noexcept {
#if defined(__SANITIZE_THREAD__)
    std::atomic_signal_fence(order);
#else
    std::atomic_thread_fence(order);
#endif
  }

  static Word version_epoch(const LinkLayout& layout) noexcept { return loaned_memory::version << 32 | layout.epoch; }
  /// None stands in the first place before there is a sample.
  static constexpr LinkStatus status_of(Word word) noexcept {
    return word == coded(LinkStatus::None) ? LinkStatus::None : LinkWords::status_of(word);
  }
};

}  // namespace

std::size_t loaned_memory_octets(std::uint32_t payload_octets) noexcept {
  using namespace loaned_memory;
  return payload_at + places * Loans::in_lines(payload_octets);
}

std::optional<LinkGlance> glance_at_loans(Octets memory) noexcept {
  using namespace loaned_memory;
  const bool aligned = std::bit_cast<std::uintptr_t>(memory.data()) % Loans::line == 0;
  if (!aligned || memory.size() < payload_at) return std::nullopt;
  if (Loans::load(memory.data(), magic_at, std::memory_order_acquire) != magic) return std::nullopt;
  const Loans::Word count = Loans::load(memory.data(), newest_at, std::memory_order_acquire);
  const Loans::Word stamp = Loans::load(memory.data(), stamp_at(count), std::memory_order_relaxed);
  return LinkGlance{count, TimePoint{Duration{std::bit_cast<std::int64_t>(stamp)}}};
}

Result<LoanedWriter> LoanedWriter::make(MutableOctets memory, const LinkLayout& layout) noexcept {
  using namespace loaned_memory;
  if (!Loans::fit(memory.data(), memory.size(), layout)) {
    return fail(ErrorCode::Mismatch, "link memory too small, not aligned, or payload size impossible",
                layout.payload_octets);
  }
  std::byte* const start = memory.data();
  const auto set = [start](std::size_t at, Loans::Word value) {
    Loans::word(start, at).store(value, std::memory_order_relaxed);
  };
  // All of it, so that no place brings a page fault into the cycle.
  for (std::size_t at = 0; at < loaned_memory_octets(layout.payload_octets); at += sizeof(Loans::Word)) set(at, 0);
  set(status_at(0), Loans::coded(LinkStatus::None));  // what is read before the first sample
  set(version_epoch_at, Loans::version_epoch(layout));
  set(payload_octets_at, layout.payload_octets);
  set(layout_hash_at, layout.layout_hash);
  set(period_at, std::bit_cast<Loans::Word>(std::int64_t{layout.period.count()}));
  Loans::word(start, magic_at).store(magic, std::memory_order_release);

  LoanedWriter writer;
  writer.memory_ = start;
  writer.payload_octets_ = layout.payload_octets;
  if (layout.wakes) writer.start_waking();
  return writer;
}

MutableOctets LoanedWriter::lend() noexcept {
  using namespace loaned_memory;
  const std::uint64_t next = count_ + 1;
  if (!lent_) {
    Loans::word(memory_, sequence_at(next)).store(2 * next - 1, std::memory_order_relaxed);
    Loans::fence(std::memory_order_release);
    lent_ = true;
  }
  return {memory_ + Loans::place_at(next, payload_octets_), payload_octets_};
}

void LoanedWriter::publish(TimePoint sampled_at, LinkStatus status) noexcept {
  using namespace loaned_memory;
  if (!lent_) return;
  lent_ = false;
  ++count_;
  const auto set = [this](std::size_t at, Loans::Word value) {
    Loans::word(memory_, at).store(value, std::memory_order_release);
  };
  set(status_at(count_), Loans::coded(status));
  set(stamp_at(count_), std::bit_cast<Loans::Word>(std::int64_t{sampled_at.time_since_epoch().count()}));
  set(sequence_at(count_), 2 * count_);
  set(newest_at, count_);
  if (wakes_.load(std::memory_order_relaxed)) Loans::wake(memory_, newest_at);
}

void LoanedWriter::set_status(LinkStatus status) noexcept {
  using namespace loaned_memory;
  Loans::word(memory_, status_at(count_)).store(Loans::coded(status), std::memory_order_release);
}

Result<LoanedReader> LoanedReader::make(Octets memory, const LinkLayout& layout) noexcept {
  using namespace loaned_memory;
  if (!Loans::fit(memory.data(), memory.size(), layout)) {
    return fail(ErrorCode::Mismatch, "link memory too small, not aligned, or payload size impossible",
                layout.payload_octets);
  }
  const std::byte* const start = memory.data();
  const auto get = [start](std::size_t at) { return Loans::load(start, at, std::memory_order_relaxed); };
  if (Loans::load(start, magic_at, std::memory_order_acquire) != magic)
    return fail(ErrorCode::Mismatch, "link memory has no header");
  if (get(version_epoch_at) >> 32 != version)
    return fail(ErrorCode::Mismatch, "link version", static_cast<std::int64_t>(get(version_epoch_at) >> 32));
  if (get(version_epoch_at) != Loans::version_epoch(layout))
    return fail(ErrorCode::Mismatch, "link epoch", static_cast<std::uint32_t>(get(version_epoch_at)));
  if (get(payload_octets_at) != layout.payload_octets)
    return fail(ErrorCode::Mismatch, "link payload size", std::bit_cast<std::int64_t>(get(payload_octets_at)));
  if (get(layout_hash_at) != layout.layout_hash)
    return fail(ErrorCode::Mismatch, "link layout", std::bit_cast<std::int64_t>(get(layout_hash_at)));
  // Every page is looked at once, so that none is missing in the cycle.
  for (std::size_t at = 0; at < loaned_memory_octets(layout.payload_octets); at += Loans::page)
    static_cast<void>(get(at));

  LoanedReader reader;
  reader.memory_ = start;
  reader.payload_octets_ = layout.payload_octets;
  return reader;
}

LinkSample LoanedReader::newest() noexcept {
  using namespace loaned_memory;
  const auto get = [this](std::size_t at) { return Loans::load(memory_, at, std::memory_order_acquire); };
  for (int attempt = 0; attempt < Loans::attempts; ++attempt) {
    const std::uint64_t count = get(newest_at);
    const Loans::Word sequence = get(sequence_at(count));
    LinkSample sample{.status = Loans::status_of(get(status_at(count))),
                      .count = count,
                      .sampled_at = TimePoint{Duration{std::bit_cast<std::int64_t>(get(stamp_at(count)))}}};
    const bool made = sequence == 2 * count && get(sequence_at(count)) == sequence;
    // A count that goes back is damage: no earlier sample passes for a new one.
    if (made && count >= told_.count) {
      const std::uint64_t before = std::exchange(told_, sample).count;
      sample.flow = count == 0 ? Flow::None : count == before ? Flow::Old : Flow::New;
      sample.lost = before != 0 && count > before ? count - before - 1 : 0;
      return sample;
    }
    relax(attempt);
  }
  LinkSample sample = told_;
  sample.flow = told_.count == 0 ? Flow::None : Flow::Old;
  return sample;
}

Octets LoanedReader::look() noexcept {
  looked_at_ = told_.count;
  if (looked_at_ == 0) return {};
  return {memory_ + Loans::place_at(looked_at_, payload_octets_), payload_octets_};
}

bool LoanedReader::whole() const noexcept {
  using namespace loaned_memory;
  if (looked_at_ == 0) return false;
  Loans::fence(std::memory_order_acquire);
  return Loans::load(memory_, sequence_at(looked_at_), std::memory_order_relaxed) == 2 * looked_at_;
}

const std::uint32_t* LoanedReader::arrival_word() const noexcept {
  return Loans::low_half(memory_, loaned_memory::newest_at);
}

// --- the mechanism ---------------------------------------------------------------------------------------------------

namespace {

// A place is filled up to a line, so that its last word is all there.
class CopyingWriter final : public LinkWriter {
 public:
  explicit CopyingWriter(LoanedWriter lender) noexcept : lender_{std::move(lender)} {}
  void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept override {
    const MutableOctets place = lender_.lend();
    assert(payload.size() == place.size());
    for (std::size_t at = 0; at < payload.size(); at += sizeof(Loans::Word)) {
      Loans::Word value = 0;
      std::memcpy(&value, payload.data() + at, std::min(sizeof value, payload.size() - at));
      Loans::word(place.data(), at).store(value, std::memory_order_release);
    }
    lender_.publish(sampled_at, status);
  }
  void set_status(LinkStatus status) noexcept override { lender_.set_status(status); }

 private:
  LoanedWriter lender_;
};

class CopyingReader final : public LinkReader {
 public:
  CopyingReader(LoanedReader borrower, const LinkLayout& layout)
      : borrower_{std::move(borrower)},
        kept_(Loans::in_lines(layout.payload_octets) / sizeof(Loans::Word)),
        arriving_(kept_.size()) {}
  LinkSample read(MutableOctets payload) noexcept override {
    for (int attempt = 0; attempt < Loans::attempts; ++attempt) {
      LinkSample found = borrower_.newest();
      if (found.count == last_.count) {
        last_.status = found.status;
        break;
      }
      const Octets place = borrower_.look();
      assert(payload.size() == place.size());
      for (std::size_t i = 0; i < arriving_.size(); ++i)
        arriving_[i] = Loans::load(place.data(), i * sizeof(Loans::Word), std::memory_order_acquire);
      if (!borrower_.whole()) continue;
      std::swap(kept_, arriving_);
      found.flow = Flow::New;
      found.lost = last_.count == 0 ? 0 : found.count - last_.count - 1;
      last_ = found;
      std::memcpy(payload.data(), kept_.data(), payload.size());
      return found;
    }
    LinkSample again = last_;
    again.flow = last_.count == 0 ? Flow::None : Flow::Old;
    again.lost = 0;
    if (again.flow == Flow::Old) std::memcpy(payload.data(), kept_.data(), payload.size());
    return again;
  }
  [[nodiscard]] const std::uint32_t* arrival_word() const noexcept override { return borrower_.arrival_word(); }

 private:
  LoanedReader borrower_;
  std::vector<Loans::Word> kept_;  ///< payload of last_
  std::vector<Loans::Word> arriving_;  ///< the copy that is not yet known to be whole
  LinkSample last_{};
};

class LoanedView final : public LinkView {
 public:
  explicit LoanedView(Mapping mapping) noexcept : mapping_{std::move(mapping)} {}
  [[nodiscard]] std::optional<LinkGlance> glance() const noexcept override { return glance_at_loans(mapping_.octets); }

 private:
  Mapping mapping_;
};

Result<LoanedWriter> producer(MemoryProvider& provider, const MemoryHandle& shared, const LinkLayout& layout) {
  HIROSCO_TRY(provider.verify(shared, loaned_memory_octets(layout.payload_octets), false));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadWrite));
  HIROSCO_TRY_LET(LoanedWriter writer, LoanedWriter::make(mapping.octets, layout));
  HIROSCO_TRY(provider.seal_writers(shared));
  writer.keep(std::move(mapping));
  return writer;
}

Result<LoanedReader> consumer(MemoryProvider& provider, const MemoryHandle& shared, const LinkLayout& layout) {
  HIROSCO_TRY(provider.verify(shared, loaned_memory_octets(layout.payload_octets), true));
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  HIROSCO_TRY_LET(LoanedReader reader, LoanedReader::make(mapping.octets, layout));
  reader.keep(std::move(mapping));
  return reader;
}

}  // namespace

Result<MemoryHandle> LoanedLink::establish(MemoryProvider& provider, const LinkLayout& layout) const {
  if (!Loans::plausible(layout)) return fail(ErrorCode::Mismatch, "link payload size", layout.payload_octets);
  return provider.create("hirosco-loans", loaned_memory_octets(layout.payload_octets));
}

Result<std::unique_ptr<LinkWriter>> LoanedLink::produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                        const LinkLayout& layout) const {
  HIROSCO_TRY_LET(LoanedWriter writer, producer(provider, shared, layout));
  return std::make_unique<CopyingWriter>(std::move(writer));
}

Result<std::unique_ptr<LinkReader>> LoanedLink::consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                        const LinkLayout& layout) const {
  HIROSCO_TRY_LET(LoanedReader reader, consumer(provider, shared, layout));
  return std::make_unique<CopyingReader>(std::move(reader), layout);
}

Result<std::unique_ptr<LinkView>> LoanedLink::look(MemoryProvider& provider, const MemoryHandle& shared) const {
  HIROSCO_TRY_LET(Mapping mapping, provider.map(shared, Access::ReadOnly));
  return std::make_unique<LoanedView>(std::move(mapping));
}

Result<std::unique_ptr<LoanWriter>> LoanedLink::lend(MemoryProvider& provider, const MemoryHandle& shared,
                                                     const LinkLayout& layout) const {
  HIROSCO_TRY_LET(LoanedWriter writer, producer(provider, shared, layout));
  return std::make_unique<LoanedWriter>(std::move(writer));
}

Result<std::unique_ptr<LoanReader>> LoanedLink::borrow(MemoryProvider& provider, const MemoryHandle& shared,
                                                       const LinkLayout& layout) const {
  HIROSCO_TRY_LET(LoanedReader reader, consumer(provider, shared, layout));
  return std::make_unique<LoanedReader>(std::move(reader));
}

}  // namespace hirosco
