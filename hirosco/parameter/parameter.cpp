// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/parameter/parameter.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace hirosco {
namespace {

using parameter_detail::Word;
using parameter_detail::word_octets;

/// One value of 1, 2, 4 or 8 octets between native and big-endian order.
void copy_swapped(std::byte* to, const std::byte* from, std::size_t octets) noexcept {
  if constexpr (std::endian::native == std::endian::big) std::memcpy(to, from, octets);
  else std::reverse_copy(from, from + octets, to);
}

}  // namespace

bool ParameterCell::snapshot(MutableOctets native) const noexcept {
  if (native.size() != live_.size()) return false;
  return parameter_detail::read_whole(*sequence_, max_attempts, [&] {
    for (std::size_t at = 0; at < native.size(); at += word_octets) {
      const Word word = words_[at / word_octets].load(std::memory_order_acquire);
      std::memcpy(native.data() + at, &word, std::min(word_octets, native.size() - at));
    }
  });
}

std::size_t ParameterCell::encode(std::span<const NativeField> fields, MutableOctets out) const noexcept {
  const std::size_t size = encoded_octets(fields);
  if (size > out.size()) return 0;
  std::byte* to = out.data();
  for (const auto& field : fields) {
    const std::size_t octets = octets_of(field.type);
    for (std::size_t i = 0; i < field.count; ++i, to += octets)
      copy_swapped(to, live_.data() + field.offset + i * octets, octets);
  }
  return size;
}

std::size_t ParameterCell::snapshot_encode(std::span<const NativeField> fields, MutableOctets out) const noexcept {
  const std::size_t size = encoded_octets(fields);
  if (size > out.size()) return 0;
  const bool whole = parameter_detail::read_whole(*sequence_, max_attempts, [&] {
    std::byte* to = out.data();
    for (const auto& field : fields) {
      const std::size_t octets = octets_of(field.type);
      for (std::size_t i = 0; i < field.count; ++i, to += octets) {
        // Numbers are aligned to their size: none spans two words.
        const std::size_t at = field.offset + i * octets;
        const Word word = words_[at / word_octets].load(std::memory_order_acquire);
        copy_swapped(to, reinterpret_cast<const std::byte*>(&word) + at % word_octets, octets);
      }
    }
  });
  return whole ? size : 0;
}

bool ParameterCell::stage_encoded(std::span<const NativeField> fields, Octets encoded) noexcept {
  if (encoded.size() != encoded_octets(fields)) return false;
  const std::byte* from = encoded.data();
  for (const auto& field : fields) {
    const std::size_t octets = octets_of(field.type);
    for (std::size_t i = 0; i < field.count; ++i, from += octets)
      copy_swapped(live_.data() + field.offset + i * octets, from, octets);
  }
  return true;
}

}  // namespace hirosco
