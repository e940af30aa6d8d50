// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "hirosco/utilities/crc16.hpp"
#include "hirosco/utilities/octets.hpp"

/// What fuzz targets have in common.
namespace hirosco::fuzz {

/// Ends the process with these words where something does not hold that is to hold whatever comes.
inline void expect(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

namespace detail {
inline std::uint64_t taken{0};
}

/// Some input, or a part of it, was taken and not refused: a slice whose corpus is refused as a whole says so (slice.cpp).
inline void taken() noexcept { ++detail::taken; }
[[nodiscard]] inline std::uint64_t taken_so_far() noexcept { return detail::taken; }

[[nodiscard]] inline Octets octets_of(const std::uint8_t* data, std::size_t size) noexcept {
  return {reinterpret_cast<const std::byte*>(data), size};
}
[[nodiscard]] inline std::string_view text_of(const std::uint8_t* data, std::size_t size) noexcept {
  return {reinterpret_cast<const char*>(data), size};
}

/// With the check sum that these octets have behind them, so that it hides nothing; and with no room behind that, so that reading on shows.
[[nodiscard]] inline std::vector<std::byte> with_crc16(Octets octets, std::endian order = std::endian::big) {
  std::vector<std::byte> sealed(octets.size() + sizeof(std::uint16_t));
  OctetWriter{sealed, order}.put(octets).put(crc16(octets));
  return sealed;
}

}  // namespace hirosco::fuzz
