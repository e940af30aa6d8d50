// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/wire_layout.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace hirosco {
namespace {

std::size_t octets_of(const LayoutField& field) noexcept { return octets_of(field.type) * field.count; }

template <class Word>
void copy_swapped(const std::byte* from, std::byte* to, std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    Word word;
    std::memcpy(&word, from + i * sizeof word, sizeof word);
    word = byte_swapped(word);
    std::memcpy(to + i * sizeof word, &word, sizeof word);
  }
}

/// Both ways are the same: what is swapped twice is as before.
void copy_field(const LayoutField& field, const std::byte* from, std::byte* to, std::endian order) noexcept {
  const std::size_t each = octets_of(field.type);
  if (order == std::endian::native || each == 1) {
    std::memcpy(to, from, each * field.count);
    return;
  }
  if (each == 2) copy_swapped<std::uint16_t>(from, to, field.count);
  if (each == 4) copy_swapped<std::uint32_t>(from, to, field.count);
  if (each == 8) copy_swapped<std::uint64_t>(from, to, field.count);
}

}  // namespace

std::size_t wire_octets(std::span<const LayoutField> fields) noexcept {
  std::size_t sum = 0;
  for (const LayoutField& field : fields) sum += octets_of(field);
  return sum;
}

std::size_t native_octets(std::span<const LayoutField> fields) noexcept {
  std::size_t end = 0;
  for (const LayoutField& field : fields) end = std::max(end, field.native_offset + octets_of(field));
  return end;
}

bool wire_is_native(std::span<const LayoutField> fields, std::endian order) noexcept {
  std::size_t at = 0;
  for (const LayoutField& field : fields) {
    if (field.native_offset != at) return false;
    if (order != std::endian::native && octets_of(field.type) > 1) return false;
    at += octets_of(field);
  }
  return true;
}

void encode(std::span<const LayoutField> fields, Octets native_object, MutableOctets wire, std::endian order) noexcept {
  assert(native_object.size() >= native_octets(fields) && wire.size() >= wire_octets(fields));
  std::byte* to = wire.data();
  for (const LayoutField& field : fields) {
    if (octets_of(field) == 0) continue;
    copy_field(field, native_object.data() + field.native_offset, to, order);
    to += octets_of(field);
  }
}

void decode(std::span<const LayoutField> fields, Octets wire, MutableOctets native_object, std::endian order) noexcept {
  assert(wire.size() >= wire_octets(fields) && native_object.size() >= native_octets(fields));
  const std::byte* from = wire.data();
  for (const LayoutField& field : fields) {
    if (octets_of(field) == 0) continue;
    copy_field(field, from, native_object.data() + field.native_offset, order);
    from += octets_of(field);
  }
}

}  // namespace hirosco
