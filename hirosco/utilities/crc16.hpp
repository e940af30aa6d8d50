// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"

namespace hirosco {

namespace detail {
inline constexpr std::uint16_t crc16_polynomial = 0x1021;

[[nodiscard]] constexpr std::array<std::uint16_t, 256> crc16_table() noexcept {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::uint32_t rest = static_cast<std::uint32_t>(i) << 8;
    for (int bit = 0; bit < 8; ++bit) rest = (rest << 1) ^ ((rest & 0x8000U) != 0 ? crc16_polynomial : 0U);
    table[i] = static_cast<std::uint16_t>(rest & 0xFFFFU);
  }
  return table;
}
}  // namespace detail

/// CRC-16/CCITT-FALSE (polynomial 0x1021, start 0xFFFF): error control of space packets (PUS-C, ECSS-E-ST-70-41C B.1)
/// and of device frames. Pass the last result as `start` to go on over several pieces.  Realtime: bounded by the length.
[[nodiscard]] constexpr std::uint16_t crc16(Octets octets, std::uint16_t start = 0xFFFF) noexcept {
  constexpr auto table = detail::crc16_table();
  std::uint32_t rest = start;
  for (const std::byte octet : octets)
    rest = ((rest << 8) & 0xFFFFU) ^ table[(rest >> 8) ^ std::to_integer<std::uint32_t>(octet)];
  return static_cast<std::uint16_t>(rest);
}

}  // namespace hirosco
