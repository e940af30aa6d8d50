// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"

namespace hirosco {

namespace detail {
inline constexpr auto crc32_of_octet = [] {
  constexpr std::uint32_t polynomial = 0xEDB88320;
  std::array<std::uint32_t, 256> rest{};
  for (std::uint32_t octet = 0; octet < rest.size(); ++octet) {
    rest[octet] = octet;
    for (int bit = 0; bit < 8; ++bit) rest[octet] = (rest[octet] >> 1) ^ ((rest[octet] & 1) != 0 ? polynomial : 0);
  }
  return rest;
}();
}  // namespace detail

/// CRC-32 of IEEE 802.3, as zlib's crc32().  Realtime: bounded by the octets.
[[nodiscard]] constexpr std::uint32_t crc32(Octets octets) noexcept {
  std::uint32_t rest = 0xFFFFFFFF;
  for (const std::byte octet : octets)
    rest = (rest >> 8) ^ detail::crc32_of_octet[(rest ^ std::to_integer<std::uint32_t>(octet)) & 0xFF];
  return ~rest;
}

}  // namespace hirosco
