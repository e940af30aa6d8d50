// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/link/link.hpp"

/// Every sample in shared memory, in order: a ring that its producer fills without knowing who reads, and of which each
/// consumer keeps its own place (adr 0072).
namespace hirosco {

/// Where things stand in the memory of a link that queues, in octets. All words are of 8 octets in the order of the machine.
namespace queued_memory {
inline constexpr std::uint64_t magic = 0x5545'5551'5243'5348;  ///< "HSCRQUEU" of a little-endian machine
inline constexpr std::uint64_t version = 1;
inline constexpr std::size_t magic_at = 0;  ///< line 0: written once, before the link is handed on
inline constexpr std::size_t version_epoch_at = 8;  ///< version in the high, epoch in the low half
inline constexpr std::size_t payload_octets_at = 16;
inline constexpr std::size_t layout_hash_at = 24;
inline constexpr std::size_t period_at = 32;  ///< ns
inline constexpr std::size_t depth_at = 40;
inline constexpr std::size_t newest_at = 64;  ///< line 1: count of the newest sample
inline constexpr std::size_t status_at = 72;  ///< of the producer now: in the low half, its complement in the high one
inline constexpr std::size_t stamp_at = 80;  ///< of the newest sample, ns of the monotonic clock
/// Then depth + 1 slots, each on a line; sample n is in slot n % (depth + 1). In a slot, from its beginning:
inline constexpr std::size_t slots_at = 128;
inline constexpr std::size_t sequence_in_slot = 0;  ///< twice the count of its sample, one less while that is written
inline constexpr std::size_t status_in_slot = 8;  ///< of the producer when it wrote this sample
inline constexpr std::size_t stamp_in_slot = 16;
inline constexpr std::size_t payload_in_slot = 24;  ///< filled up with zero to a whole word
/// Octets of a slot with this payload.
[[nodiscard]] std::size_t slot_octets(std::uint32_t payload_octets) noexcept;
}  // namespace queued_memory

/// Octets of memory that a link with this payload and depth needs (a multiple of 64).
[[nodiscard]] std::size_t queued_memory_octets(std::uint32_t payload_octets, std::uint32_t depth) noexcept;

/// Of the memory of a link that queues. Empty: it is none.  Realtime: wait-free. Thread: any.
[[nodiscard]] std::optional<LinkGlance> glance_at_queue(Octets memory) noexcept;

/// The producer's end.  Realtime: wait-free, no system call unless the layout says that it wakes. Thread: one.
class QueuedWriter final : public LinkWriter {
 public:
  /// Writes the header. Mismatch: memory too small or not 64-octet aligned, or the layout is impossible.
  [[nodiscard]] static Result<QueuedWriter> make(MutableOctets memory, const LinkLayout& layout) noexcept;
  void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept override;
  void set_status(LinkStatus status) noexcept override;
  /// The mapping of the memory lives as long as this end.
  void keep(Mapping mapping) noexcept { mapping_ = std::move(mapping); }

 private:
  QueuedWriter() = default;

  std::byte* memory_{nullptr};
  std::uint32_t payload_octets_{0};
  std::uint32_t depth_{0};
  bool wakes_{false};
  std::uint64_t count_{0};
  Mapping mapping_;
};

/// A consumer's end.  Realtime: wait-free (bounded retries), no system call; `make` allocates. Thread: one.
class QueuedReader final : public LinkReader {
 public:
  /// Begins with the oldest sample that is there, at most `depth` before the newest. Mismatch: the header does not say
  /// what was agreed (magic, version, epoch, size, layout hash, depth).
  [[nodiscard]] static Result<QueuedReader> make(Octets memory, const LinkLayout& layout);
  /// Old when the producer overtook it too often, and when the count went back, too.
  LinkSample read(MutableOctets payload) noexcept override;
  [[nodiscard]] const std::uint32_t* arrival_word() const noexcept override;
  /// The mapping of the memory lives as long as this end.
  void keep(Mapping mapping) noexcept { mapping_ = std::move(mapping); }

 private:
  QueuedReader() = default;
  [[nodiscard]] std::optional<std::uint64_t> newest() const noexcept;
  [[nodiscard]] bool copy(std::uint64_t count, LinkSample& sample) noexcept;
  [[nodiscard]] LinkSample accept(LinkSample sample, MutableOctets payload) noexcept;
  [[nodiscard]] LinkSample last(MutableOctets payload) const noexcept;
  [[nodiscard]] LinkStatus now() const noexcept;

  const std::byte* memory_{nullptr};
  std::uint32_t payload_octets_{0};
  std::uint32_t depth_{0};
  std::uint64_t passed_{0};  ///< count of the last sample that was read or given up
  std::uint64_t told_{0};  ///< up to here samples were handed out or told as lost
  LinkSample last_{};
  std::vector<std::uint64_t> kept_;  ///< payload of last_
  std::vector<std::uint64_t> arriving_;  ///< the copy that is not yet known to be whole
  Mapping mapping_;
};

/// Every sample in shared memory: one producer, any number of consumers, each with its own place.
class QueuedLink final : public LinkMechanism {
 public:
  [[nodiscard]] LinkMethod method() const noexcept override { return LinkMethod::SharedMemory; }
  [[nodiscard]] LinkKind kind() const noexcept override { return LinkKind::Queued; }
  [[nodiscard]] bool wakes() const noexcept override { return true; }
  [[nodiscard]] Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider,
                                                       const MemoryHandle& shared) const override;
};

}  // namespace hirosco
