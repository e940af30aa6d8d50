// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/spsc_ring.hpp"

namespace hirosco {

/// Queue of records of any length from one thread to one other, each record in one piece.
///
/// Form: positions are multiples of 8; a record is its length (4 octets, native), 4 octets unused, then its octets,
/// filled up to 8. A record that would not fit before the end of the buffer starts again at its beginning, and
/// `skip_mark` stands where it would have been.
/// Realtime: wait-free once constructed. Thread: one producer, one consumer; counters any.
class RecordRing {
 public:
  /// Allocates the buffer: `octets` rounded up to a power of two, at least 64. Blocks: allocates.
  explicit RecordRing(std::size_t octets);
  RecordRing(const RecordRing&) = delete;
  RecordRing& operator=(const RecordRing&) = delete;

  /// Appends the record `a` then `b`, whole or not at all; false, and one more dropped(), when it found no room.
  /// Thread: producer.
  bool try_write(Octets a, Octets b = {}) noexcept;

  /// Room for a record of at most `octets` (at least 1), to be filled in place and published by commit(); empty, and
  /// one more dropped(), when there is none. A second reservation replaces the first. Thread: producer.
  [[nodiscard]] MutableOctets try_reserve(std::size_t octets) noexcept;
  /// Publishes the first `used` octets of the reservation; without one, nothing happens. Thread: producer.
  void commit(std::size_t used) noexcept;

  /// The oldest record, valid until pop(). Thread: consumer.
  [[nodiscard]] std::optional<Octets> front() noexcept;
  /// Releases what front() showed; nothing happens on an empty ring. Thread: consumer.
  void pop() noexcept;

  /// Octets of the buffer; each record costs its length, 8 octets and what fills it up to a multiple of 8.
  [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }
  /// A longer record is never accepted: half the buffer, so that an empty ring always has room for it somewhere.
  [[nodiscard]] std::size_t max_record() const noexcept { return capacity() / 2 - header_octets; }
  /// Records refused.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
  /// Octets of the buffer in use: a moment's view.
  [[nodiscard]] std::size_t used() const noexcept;

 private:
  static constexpr std::size_t header_octets = 8;
  static constexpr std::uint32_t skip_mark = 0xFFFF'FFFF;

  struct alignas(cache_line_octets) End {
    std::atomic<std::uint64_t> position{0};
    std::uint64_t other{0};  ///< last seen position of the other end
  };

  [[nodiscard]] bool reserve(std::size_t octets) noexcept;
  void publish(std::size_t used) noexcept;
  [[nodiscard]] bool has_room(std::uint64_t end) noexcept;
  [[nodiscard]] std::byte* at(std::uint64_t position) noexcept { return buffer_.get() + (position & mask_); }
  void put_length(std::uint64_t position, std::uint32_t length) noexcept;
  [[nodiscard]] std::uint32_t length_at(std::uint64_t position) noexcept;

  std::size_t mask_;
  std::unique_ptr<std::byte[]> buffer_;
  End producer_;
  std::uint64_t reserved_at_{0};  ///< producer's own, beside its position
  std::size_t reserved_octets_{0};
  bool reserved_{false};
  End consumer_;
  alignas(cache_line_octets) std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace hirosco
