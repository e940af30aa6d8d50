// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "hirosco/data_transfer/link/link.hpp"

/// The newest large sample in shared memory that its producer lends: images and point clouds are made where they are
/// looked at (adr 0070).
namespace hirosco {

/// Where things stand in the memory of a link that lends, in octets. All words are of 8 octets in the order of the machine.
namespace loaned_memory {
inline constexpr std::uint64_t magic = 0x4E41'4F4C'5243'5348;  ///< "HSCRLOAN" of a little-endian machine
inline constexpr std::uint64_t version = 1;
inline constexpr std::size_t places = 4;
inline constexpr std::size_t magic_at = 0;  ///< line 0: written once, before the link is handed on
inline constexpr std::size_t version_epoch_at = 8;  ///< version in the high, epoch in the low half
inline constexpr std::size_t payload_octets_at = 16;
inline constexpr std::size_t layout_hash_at = 24;
inline constexpr std::size_t period_at = 32;  ///< ns
inline constexpr std::size_t newest_at = 64;  ///< line 1: count of the newest sample; its place is the rest by `places`
/// A line for each place: twice the count of its sample, one less while that is made; status in the low half of its word and the
/// complement in the high one; ns of the monotonic clock.
[[nodiscard]] constexpr std::size_t sequence_at(std::uint64_t count) noexcept { return 128 + count % places * 64; }
[[nodiscard]] constexpr std::size_t status_at(std::uint64_t count) noexcept { return sequence_at(count) + 8; }
[[nodiscard]] constexpr std::size_t stamp_at(std::uint64_t count) noexcept { return sequence_at(count) + 16; }
inline constexpr std::size_t payload_at = 128 + places * 64;  ///< of the first place; each begins on a line
}  // namespace loaned_memory

/// Octets of memory that a link with this payload needs (a multiple of 64).
[[nodiscard]] std::size_t loaned_memory_octets(std::uint32_t payload_octets) noexcept;

/// Of the memory of a link that lends. Empty: it is none.  Realtime: wait-free. Thread: any.
[[nodiscard]] std::optional<LinkGlance> glance_at_loans(Octets memory) noexcept;

/// The producer's end.  Realtime: wait-free, no system call unless the layout says that it wakes. Thread: one.
class LoanedWriter final : public LoanWriter {
 public:
  /// Writes the header. Mismatch: memory too small or not 64-octet aligned.
  [[nodiscard]] static Result<LoanedWriter> make(MutableOctets memory, const LinkLayout& layout) noexcept;
  [[nodiscard]] MutableOctets lend() noexcept override;
  void publish(TimePoint sampled_at, LinkStatus status) noexcept override;
  void set_status(LinkStatus status) noexcept override;
  void start_waking() noexcept override { wakes_.store(true, std::memory_order_relaxed); }
  /// The mapping of the memory lives as long as this end.
  void keep(Mapping mapping) noexcept { mapping_ = std::move(mapping); }
  LoanedWriter(LoanedWriter&& other) noexcept
      : memory_{other.memory_},
        payload_octets_{other.payload_octets_},
        count_{other.count_},
        lent_{other.lent_},
        wakes_{other.wakes_.load(std::memory_order_relaxed)},
        mapping_{std::move(other.mapping_)} {}

 private:
  LoanedWriter() = default;

  std::byte* memory_{nullptr};
  std::uint32_t payload_octets_{0};
  std::uint64_t count_{0};
  bool lent_{false};
  std::atomic<bool> wakes_{false};
  Mapping mapping_;
};

/// A consumer's end.  Realtime: wait-free (bounded retries), no system call. Thread: one.
class LoanedReader final : public LoanReader {
 public:
  /// Mismatch: the header does not say what was agreed (magic, version, epoch, size, layout hash).
  [[nodiscard]] static Result<LoanedReader> make(Octets memory, const LinkLayout& layout) noexcept;
  /// Old when the producer overtook it too often, and when the count went back, too.
  LinkSample newest() noexcept override;
  [[nodiscard]] Octets look() noexcept override;
  [[nodiscard]] bool whole() const noexcept override;
  [[nodiscard]] const std::uint32_t* arrival_word() const noexcept override;
  /// The mapping of the memory lives as long as this end.
  void keep(Mapping mapping) noexcept { mapping_ = std::move(mapping); }

 private:
  LoanedReader() = default;

  const std::byte* memory_{nullptr};
  std::uint32_t payload_octets_{0};
  LinkSample told_{};
  std::uint64_t looked_at_{0};  ///< count of the sample; 0 = none
  Mapping mapping_;
};

/// The newest large value in shared memory: one producer, any number of consumers. Its ends that copy are for who has its
/// sample elsewhere, or wants to keep it.
class LoanedLink final : public LinkMechanism {
 public:
  [[nodiscard]] LinkMethod method() const noexcept override { return LinkMethod::SharedMemory; }
  [[nodiscard]] LinkKind kind() const noexcept override { return LinkKind::Loaned; }
  [[nodiscard]] bool wakes() const noexcept override { return true; }
  [[nodiscard]] Result<MemoryHandle> establish(MemoryProvider& provider, const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkWriter>> produce(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkReader>> consume(MemoryProvider& provider, const MemoryHandle& shared,
                                                            const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LinkView>> look(MemoryProvider& provider,
                                                       const MemoryHandle& shared) const override;
  [[nodiscard]] Result<std::unique_ptr<LoanWriter>> lend(MemoryProvider& provider, const MemoryHandle& shared,
                                                         const LinkLayout& layout) const override;
  [[nodiscard]] Result<std::unique_ptr<LoanReader>> borrow(MemoryProvider& provider, const MemoryHandle& shared,
                                                           const LinkLayout& layout) const override;
};

}  // namespace hirosco
