// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/octets.hpp"

namespace hirosco {

/// CRC-32 of IEEE 802.3, as zlib's crc32().  Realtime: bounded by the octets.
[[nodiscard]] constexpr std::uint32_t crc32(Octets octets) noexcept {
  constexpr std::uint32_t polynomial = 0xEDB88320;
  std::uint32_t rest = 0xFFFFFFFF;
  for (const std::byte octet : octets) {
    rest ^= std::to_integer<std::uint32_t>(octet);
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? polynomial : 0);
  }
  return ~rest;
}

}  // namespace hirosco
