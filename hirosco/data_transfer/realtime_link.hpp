// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"
#include "hirosco/utilities/time.hpp"

/// The latest-value real-time link in shared memory: one writer, many readers, no system call (decision 20).
namespace hirosco {

/// Written by the producer beside each sample. What no producer wrote is read as Fault: no damage of the word turns a
/// fault into something to rely on (findings SF19).
enum class LinkStatus : std::uint32_t { None = 0, Valid = 1, Degraded = 2, Stopping = 3, Fault = 4 };

/// What both sides agreed on and find again in the memory's header.
struct LinkLayout {
  std::uint32_t epoch{};             ///< of the handshake that made this link
  std::uint32_t payload_octets{};    ///< of one sample, 1 .. 65,536
  std::uint64_t layout_hash{};       ///< of the agreed fields, byte order and kind
  Duration period{};                 ///< of the producer
};

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

/// How a link is doing, for displays: no sample is read, no reader's count moves. The two values may be of neighbouring
/// samples. Empty: no link's memory.  Realtime: wait-free. Thread: any.
struct LinkGlance {
  std::uint64_t count{0};  ///< samples written so far
  TimePoint sampled_at{};  ///< of the newest
};
[[nodiscard]] std::optional<LinkGlance> glance_at_link(Octets memory) noexcept;

/// The producer's end.  Realtime: wait-free, no system call. Thread: one.
class LinkWriter {
 public:
  LinkWriter() = default;
  /// Writes the header. Mismatch: memory too small or not 64-octet aligned.
  [[nodiscard]] static Result<LinkWriter> make(MutableOctets memory, const LinkLayout& layout) noexcept;
  /// Publishes one sample. `payload` has the agreed size (invariant). Counts from 1.
  void write(Octets payload, TimePoint sampled_at, LinkStatus status) noexcept;
  /// Changes the status without a new sample (stopping, fault).
  void set_status(LinkStatus status) noexcept;
  [[nodiscard]] explicit operator bool() const noexcept { return memory_ != nullptr; }

 private:
  std::byte* memory_{nullptr};
  std::uint32_t payload_octets_{0};
  std::uint64_t count_{0};
  std::uint64_t sequence_{0};
};

/// What a read found. `flow` None: never a sample yet. Old: the same sample as last time, or the writer was caught in
/// the middle too often and `payload` still holds the reader's last copy.
struct LinkSample {
  Flow flow{Flow::None};
  LinkStatus status{LinkStatus::None};
  std::uint64_t count{0};  ///< of the sample in `payload`
  std::uint64_t lost{0};  ///< samples never seen between this and the one before
  TimePoint sampled_at{};
};

/// A consumer's end. Keeps the last whole sample itself, so that no writer can take it away. Moves, does not copy.
/// Realtime: wait-free (bounded retries), no system call; `make` allocates. Thread: one.
class LinkReader {
 public:
  LinkReader() = default;
  /// Mismatch: the header does not say what was agreed (magic, version, epoch, size, layout hash).
  [[nodiscard]] static Result<LinkReader> make(Octets memory, const LinkLayout& layout) noexcept;
  /// Copies the newest whole sample into `payload` (agreed size, invariant), never a torn one; on Old the last one again,
  /// on None nothing.
  LinkSample read(MutableOctets payload) noexcept;
  [[nodiscard]] explicit operator bool() const noexcept { return memory_ != nullptr; }

 private:
  const std::byte* memory_{nullptr};
  [[nodiscard]] bool copy(std::uint64_t sequence, LinkSample& sample, MutableOctets payload) noexcept;
  [[nodiscard]] LinkSample last(MutableOctets payload) const noexcept;
  [[nodiscard]] LinkSample accept(LinkSample sample, MutableOctets payload) noexcept;

  std::uint32_t payload_octets_{0};
  std::uint64_t last_sequence_{0};
  LinkSample last_{};
  std::unique_ptr<std::uint64_t[]> kept_;  ///< payload of last_
  std::unique_ptr<std::uint64_t[]> arriving_;  ///< the copy that is not yet known to be whole
};

}  // namespace hirosco
