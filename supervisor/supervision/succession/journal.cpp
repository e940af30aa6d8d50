// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/succession/journal.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>

namespace hirosco::supervisor {

struct Journal::Head {
  std::uint32_t magic{0};
  std::uint32_t version{0};
  std::uint64_t sequence{0};
  std::uint64_t octets{0};
  std::uint64_t checksum{0};  ///< of all before and of the content
};

namespace {

constexpr std::uint32_t journal_magic = 0x484A'4E4C;  // "HJNL"
/// Of all notes together, and of one part's.
constexpr std::size_t most_notes = std::size_t{1} << 19;

/// FNV-1a of 64 bits: finds what is torn; nobody who would forge it can write here.
[[nodiscard]] std::uint64_t checksum(Octets octets, std::uint64_t sum = 0xCBF2'9CE4'8422'2325) noexcept {
  for (const std::byte octet : octets) sum = (sum ^ std::to_integer<std::uint64_t>(octet)) * 0x0000'0100'0000'01B3;
  return sum;
}

}  // namespace

std::size_t Journal::most_octets() const noexcept {
  const std::size_t half = memory_.size() / 2;
  return half > sizeof(Head) ? half - sizeof(Head) : 0;
}

MutableOctets Journal::copy(std::size_t which) const noexcept {
  const std::size_t half = memory_.size() / 2;
  return memory_.subspan(which * half, half);
}

std::uint64_t Journal::sequence_of(std::size_t which) const noexcept {
  if (most_octets() == 0) return 0;
  const Octets octets = copy(which);
  Head head;
  std::memcpy(&head, octets.data(), sizeof head);
  if (head.magic != journal_magic || head.version != version || head.octets > most_octets()) return 0;
  const auto content = octets.subspan(sizeof head, static_cast<std::size_t>(head.octets));
  const auto sum = checksum(content, checksum(octets.first(offsetof(Head, checksum))));
  return sum == head.checksum ? head.sequence : 0;
}

Octets Journal::newest() const noexcept {
  const std::uint64_t first = sequence_of(0), second = sequence_of(1);
  if (first == 0 && second == 0) return {};
  const Octets octets = copy(first > second ? 0 : 1);
  Head head;
  std::memcpy(&head, octets.data(), sizeof head);
  return octets.subspan(sizeof head, static_cast<std::size_t>(head.octets));
}

bool Journal::write(Octets content) noexcept {
  if (content.size() > most_octets() || most_octets() == 0) return false;
  if (!known_) {
    const std::uint64_t first = sequence_of(0), second = sequence_of(1);
    known_ = first > second ? Newest{0, first} : Newest{1, second};
  }
  known_ = {1 - known_->which, known_->sequence + 1};
  const MutableOctets into = copy(known_->which);
  Head head{.magic = journal_magic, .version = version, .sequence = known_->sequence, .octets = content.size()};
  head.checksum = checksum(content, checksum(std::as_bytes(std::span{&head, 1}).first(offsetof(Head, checksum))));
  // What was there counts no more from the first octet on that changes.
  std::memset(into.data(), 0, sizeof head);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  std::ranges::copy(content, into.begin() + sizeof head);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  std::memcpy(into.data(), &head, sizeof head);
  return true;
}

void Journal::clear() noexcept {
  if (most_octets() == 0) return;
  for (const std::size_t which : {0U, 1U}) std::memset(copy(which).data(), 0, sizeof(Head));
}

bool Memory::note() {
  if (journal_ == nullptr) return true;
  const std::size_t most = std::min(most_notes, journal_->most_octets());
  buffer_.resize(most);
  part_.resize(most);
  OctetWriter all{buffer_};
  if (!put_together(all)) {
    journal_->clear();
    written_.clear();
    return false;
  }
  if (std::ranges::equal(all.written(), written_)) return true;
  written_.assign(all.written().begin(), all.written().end());
  return journal_->write(written_);
}

bool Memory::put_together(OctetWriter& all) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    OctetWriter one{part_};
    parts_[i]->note(one);
    if (!one.good()) return false;
    all.put(static_cast<std::uint16_t>(i)).put(static_cast<std::uint32_t>(one.size())).put(one.written());
  }
  return all.good();
}

bool Memory::recall() {
  const Octets found = journal_ != nullptr ? journal_->newest() : Octets{};
  if (found.empty()) return false;
  // All of it is taken apart before any part is told: of what was noted by others, or is not whole, nobody keeps the half.
  std::vector<Octets> notes;
  OctetReader all{found};
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto number = all.get<std::uint16_t>();
    const auto octets = all.get<std::uint32_t>();
    notes.push_back(all.get(octets));
    if (!all.good() || number != i) return false;
  }
  if (!all.exhausted()) return false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    OctetReader one{notes[i]};
    parts_[i]->recall(one);
    if (!one.exhausted()) return false;
  }
  return true;
}

}  // namespace hirosco::supervisor
