// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "hirosco/data_transfer/link/link.hpp"

/// The latest-value real-time link in shared memory: one writer, many readers, no system call (decision 20).
namespace hirosco {

/// Where things stand in a link's memory, in octets. All words are of 8 octets in the order of the machine.
namespace link_memory {
inline constexpr std::uint64_t magic = 0x4B4E'494C'5243'5348;  ///< "HSCRLINK" of a little-endian machine
inline constexpr std::uint64_t version = 2;
inline constexpr std::size_t magic_at = 0;           ///< line 0: written once, before the link is handed on
inline constexpr std::size_t version_epoch_at = 8;   ///< version in the high, epoch in the low half
inline constexpr std::size_t payload_octets_at = 16;
inline constexpr std::size_t layout_hash_at = 24;
inline constexpr std::size_t period_at = 32;         ///< ns
inline constexpr std::size_t sequence_at = 64;       ///< line 1: odd while the writer is at work
inline constexpr std::size_t status_at = 72;         ///< in the low half, its complement in the high one
inline constexpr std::size_t count_at = 80;          ///< of the sample, from 1
inline constexpr std::size_t stamp_at = 88;          ///< ns of the monotonic clock
inline constexpr std::size_t payload_at = 96;        ///< filled up with zero to a whole word
}  // namespace link_memory

/// Octets of memory that a link with this payload needs (a multiple of 64).
[[nodiscard]] std::size_t link_memory_octets(std::uint32_t payload_octets) noexcept;

/// Of a link's memory. Empty: no link's memory.  Realtime: wait-free. Thread: any.
[[nodiscard]] std::optional<LinkGlance> glance_at_link(Octets memory) noexcept;

/// The producer's end.  Realtime: wait-free, no system call unless the layout says that it wakes. Thread: one.
class LatestWriter final : public LinkWriter {
 public:
  LatestWriter() = default;
  /// Writes the header. Mismatch: memory too small or not 64-octet aligned.
  [[nodiscard]] static Result<LatestWriter> make(MutableOctets memory, const LinkLayout& layout) noexcept;
  void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept override;
  void set_status(LinkStatus status) noexcept override;
  [[nodiscard]] explicit operator bool() const noexcept { return memory_ != nullptr; }
  /// The mapping of the memory lives as long as this end.
  void keep(Mapping mapping) noexcept { mapping_ = std::move(mapping); }

 private:
  std::byte* memory_{nullptr};
  std::uint32_t payload_octets_{0};
  bool wakes_{false};
  std::uint64_t count_{0};
  std::uint64_t sequence_{0};
  Mapping mapping_;
};

/// A consumer's end. Moves, does not copy.
/// Realtime: wait-free (bounded retries), no system call; `make` allocates. Thread: one.
class LatestReader final : public LinkReader {
 public:
  LatestReader() = default;
  /// Mismatch: the header does not say what was agreed (magic, version, epoch, size, layout hash).
  [[nodiscard]] static Result<LatestReader> make(Octets memory, const LinkLayout& layout) noexcept;
  /// Of the newest sample; Old when the writer was caught in the middle too often, too.
  LinkSample read(MutableOctets payload) noexcept override;
  [[nodiscard]] const std::uint32_t* arrival_word() const noexcept override;
  [[nodiscard]] explicit operator bool() const noexcept { return memory_ != nullptr; }
  /// The mapping of the memory lives as long as this end.
  void keep(Mapping mapping) noexcept { mapping_ = std::move(mapping); }

 private:
  const std::byte* memory_{nullptr};
  void copy(MutableOctets payload) noexcept;
  [[nodiscard]] LinkSample last(MutableOctets payload) const noexcept;
  [[nodiscard]] LinkSample accept(std::uint64_t status, std::uint64_t count, std::uint64_t stamp,
                                  MutableOctets payload) noexcept;

  std::uint32_t payload_octets_{0};
  std::uint64_t last_sequence_{0};
  LinkSample last_{};
  std::unique_ptr<std::uint64_t[]> kept_;  ///< payload of last_
  std::unique_ptr<std::uint64_t[]> arriving_;  ///< the copy that is not yet known to be whole
  Mapping mapping_;
};

/// The newest value in shared memory: one writer, any number of readers. In a simulated craft it stands in for other methods,
/// with the size of sample that they carry.
class LatestLink final : public LinkMechanism {
 public:
  explicit LatestLink(LinkMethod method = LinkMethod::SharedMemory, std::uint32_t max_payload = max_link_payload_octets,
                      LinkEndsAt ends_at = LinkEndsAt::Memory) noexcept
      : method_{method}, ends_at_{ends_at}, max_payload_{max_payload} {}
  [[nodiscard]] LinkMethod method() const noexcept override { return method_; }
  [[nodiscard]] LinkKind kind() const noexcept override { return LinkKind::Latest; }
  [[nodiscard]] LinkEndsAt ends_at() const noexcept override { return ends_at_; }
  /// What stands in for another method does no more than that one.
  [[nodiscard]] bool wakes() const noexcept override { return method_ == LinkMethod::SharedMemory; }
  [[nodiscard]] std::uint32_t max_payload() const noexcept override { return max_payload_; }
  [[nodiscard]] Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider,
                                                       const MemoryHandle& shared) const override;

 private:
  LinkMethod method_;
  LinkEndsAt ends_at_;
  std::uint32_t max_payload_;
};

}  // namespace hirosco
