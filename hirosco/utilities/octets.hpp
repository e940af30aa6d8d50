// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace hirosco {

using Octets = std::span<const std::byte>;
using MutableOctets = std::span<std::byte>;

template <class T>
concept WireNumber = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

template <std::size_t Bytes>
using UnsignedOf = std::conditional_t<
    Bytes == 1, std::uint8_t,
    std::conditional_t<Bytes == 2, std::uint16_t, std::conditional_t<Bytes == 4, std::uint32_t, std::uint64_t>>>;

/// Swaps the octets of an unsigned integer (std::byteswap of a later library).
template <std::unsigned_integral T>
[[nodiscard]] constexpr T byte_swapped(T value) noexcept {
  if constexpr (sizeof(T) == 1) return value;
  else if constexpr (sizeof(T) == 2) return static_cast<T>(__builtin_bswap16(value));
  else if constexpr (sizeof(T) == 4) return __builtin_bswap32(value);
  else return __builtin_bswap64(value);
}

/// `to`: at least as long as `from`; they may overlap. g++ 12 makes a loop of single octets of std::ranges::copy.
inline void copy_octets(Octets from, MutableOctets to) noexcept {
  if (!from.empty()) std::memmove(to.data(), from.data(), from.size());
}

/// Writes numbers into a fixed buffer. Overrun is sticky: write all, ask once.
/// Realtime: wait-free. Thread: one.
class OctetWriter {
 public:
  explicit OctetWriter(MutableOctets buffer, std::endian order = std::endian::big) noexcept
      : buffer_{buffer}, order_{order} {}

  template <WireNumber T>
  OctetWriter& put(T value) noexcept {
    auto raw = std::bit_cast<UnsignedOf<sizeof(T)>>(value);
    if (order_ != std::endian::native) raw = byte_swapped(raw);
    if (MutableOctets place = take(sizeof raw); !place.empty()) std::memcpy(place.data(), &raw, sizeof raw);
    return *this;
  }
  OctetWriter& put(Octets octets) noexcept {
    if (octets.empty()) return *this;
    if (MutableOctets place = take(octets.size()); !place.empty()) copy_octets(octets, place);
    return *this;
  }
  OctetWriter& fill(std::size_t count, std::byte value) noexcept {
    if (MutableOctets place = take(count); !place.empty())
      std::memset(place.data(), std::to_integer<int>(value), place.size());
    return *this;
  }

  /// True while everything written has found room.
  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] std::size_t size() const noexcept { return used_; }
  [[nodiscard]] Octets written() const noexcept { return Octets{buffer_}.first(used_); }

 private:
  MutableOctets take(std::size_t count) noexcept {
    if (!good_ || count > buffer_.size() - used_) {
      good_ = false;
      return {};
    }
    const MutableOctets place = buffer_.subspan(used_, count);
    used_ += count;
    return place;
  }

  MutableOctets buffer_;
  std::endian order_;
  std::size_t used_{0};
  bool good_{true};
};

/// Reads numbers from octets. Underrun is sticky: read all, ask once; what is missing reads as 0.
/// Realtime: wait-free. Thread: one.
class OctetReader {
 public:
  explicit OctetReader(Octets octets, std::endian order = std::endian::big) noexcept : octets_{octets}, order_{order} {}

  template <WireNumber T>
  [[nodiscard]] T get() noexcept {
    UnsignedOf<sizeof(T)> raw{};
    if (const Octets place = take(sizeof raw); !place.empty()) std::memcpy(&raw, place.data(), sizeof raw);
    if (order_ != std::endian::native) raw = byte_swapped(raw);
    return std::bit_cast<T>(raw);
  }
  [[nodiscard]] Octets get(std::size_t count) noexcept { return count == 0 ? Octets{} : take(count); }

  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] std::size_t position() const noexcept { return used_; }
  [[nodiscard]] std::size_t remaining() const noexcept { return octets_.size() - used_; }
  [[nodiscard]] Octets rest() const noexcept { return octets_.subspan(used_); }
  /// Everything was read and nothing was missing.
  [[nodiscard]] bool exhausted() const noexcept { return good_ && remaining() == 0; }

 private:
  Octets take(std::size_t count) noexcept {
    if (!good_ || count > octets_.size() - used_) {
      good_ = false;
      return {};
    }
    const Octets place = octets_.subspan(used_, count);
    used_ += count;
    return place;
  }

  Octets octets_;
  std::endian order_;
  std::size_t used_{0};
  bool good_{true};
};

}  // namespace hirosco
