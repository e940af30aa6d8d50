// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hirosco/utilities/octets.hpp"

namespace hirosco {

namespace crc16_detail {
/// tables[k][b]: what octet b contributes when k further octets follow it.
[[nodiscard]] consteval std::array<std::array<std::uint16_t, 256>, 8> make_crc16_tables() {
  std::array<std::array<std::uint16_t, 256>, 8> tables{};
  for (unsigned octet = 0; octet < 256; ++octet) {
    unsigned crc = octet << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000U) != 0 ? (crc << 1) ^ 0x1021U : crc << 1;
    tables[0][octet] = static_cast<std::uint16_t>(crc);
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t octet = 0; octet < 256; ++octet) {
      const std::uint16_t before = tables[k - 1][octet];
      tables[k][octet] = static_cast<std::uint16_t>(before << 8 ^ tables[0][before >> 8]);
    }
  return tables;
}
inline constexpr auto crc16_tables = make_crc16_tables();
}  // namespace crc16_detail

inline constexpr std::uint16_t crc16_preset = 0xFFFF;

/// CRC-16/CCITT-FALSE, error control of space packets (ECSS-E-ST-70-41C B.1) and of device frames: polynomial 0x1021, preset 0xFFFF, most significant bit first, no inversion.
/// Pass the result of one part as `crc` of the next. Over octets that end with their own CRC the result is 0.
/// Eight octets a step, then four, as it runs over every packet on each hop.  Realtime: bounded. Thread: any.
[[nodiscard]] constexpr std::uint16_t crc16(Octets octets, std::uint16_t crc = crc16_preset) noexcept {
  const auto& t = crc16_detail::crc16_tables;
  const auto at = [&octets](std::size_t i) { return std::to_integer<unsigned>(octets[i]); };
  std::size_t i = 0;
  for (; i + 8 <= octets.size(); i += 8)
    crc = static_cast<std::uint16_t>(t[7][at(i) ^ (crc >> 8U)] ^ t[6][at(i + 1) ^ (crc & 0xFFU)] ^ t[5][at(i + 2)] ^
                                     t[4][at(i + 3)] ^ t[3][at(i + 4)] ^ t[2][at(i + 5)] ^ t[1][at(i + 6)] ^
                                     t[0][at(i + 7)]);
  if (i + 4 <= octets.size()) {
    crc = static_cast<std::uint16_t>(t[3][at(i) ^ (crc >> 8U)] ^ t[2][at(i + 1) ^ (crc & 0xFFU)] ^ t[1][at(i + 2)] ^
                                     t[0][at(i + 3)]);
    i += 4;
  }
  for (; i < octets.size(); ++i) crc = static_cast<std::uint16_t>(crc << 8 ^ t[0][at(i) ^ (crc >> 8U)]);
  return crc;
}

namespace crc16_detail {
inline constexpr std::array<std::byte, 9> crc16_check_input{std::byte{'1'}, std::byte{'2'}, std::byte{'3'},
                                                            std::byte{'4'}, std::byte{'5'}, std::byte{'6'},
                                                            std::byte{'7'}, std::byte{'8'}, std::byte{'9'}};
static_assert(crc16(crc16_check_input) == 0x29B1, "CRC-16/CCITT-FALSE check value");
}  // namespace crc16_detail

}  // namespace hirosco
