// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hirosco/parameter/type.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco {

/// One field of an object in memory: `count` values of `type`, side by side from `native_offset`. A structure is given
/// by its members' fields; Type::Struct itself has no octets and is passed over.
struct LayoutField {
  Type type{Type::Uint8};
  std::uint32_t count{1};
  std::size_t native_offset{0};
};

/// Where values come to lie as members of one C++ aggregate: each at a multiple of its type's octets, the whole filled up to
/// a multiple of the largest.  Realtime: bounded.
class NaturalLayout {
 public:
  /// `count` values of `type` behind the ones before; where they begin.
  std::size_t add(Type type, std::size_t count) noexcept {
    const std::size_t each = octets_of(type);
    const std::size_t at = up_to(each);
    end_ = at + each * count;
    alignment_ = each > alignment_ ? each : alignment_;
    return at;
  }
  [[nodiscard]] std::size_t octets() const noexcept { return up_to(alignment_); }

 private:
  [[nodiscard]] std::size_t up_to(std::size_t multiple) const noexcept {
    return multiple == 0 ? end_ : (end_ + multiple - 1) / multiple * multiple;
  }
  std::size_t end_{0};
  std::size_t alignment_{1};
};

/// Octets that the fields fill on the wire, one after another without gaps.  Realtime: bounded by the fields.
[[nodiscard]] std::size_t wire_octets(std::span<const LayoutField> fields) noexcept;

/// Octets that a native object must have at least.  Realtime: bounded by the fields.
[[nodiscard]] std::size_t native_octets(std::span<const LayoutField> fields) noexcept;

/// Whether objects of `native_octets` octets are what they are on the wire: same places, same order. Then one copy does.
[[nodiscard]] bool wire_is_native(std::span<const LayoutField> fields, std::endian order) noexcept;

/// Writes the fields of a native object to the wire in the wire's byte order.  Realtime: bounded by the fields, no heap.
/// `native_object` has native_octets(fields), `wire` wire_octets(fields) octets at least (invariants).
void encode(std::span<const LayoutField> fields, Octets native_object, MutableOctets wire, std::endian order) noexcept;

/// The way back; octets of the object between the fields stay as they are.  Realtime and invariants: as encode.
void decode(std::span<const LayoutField> fields, Octets wire, MutableOctets native_object, std::endian order) noexcept;

}  // namespace hirosco
