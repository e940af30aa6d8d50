// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/utilities/octets.hpp"

namespace hirosco::pus {

/// The 16-bit ISO checksum of PUS-C annex B: the alternative to the CRC, for memory checks; never on our links.
/// Realtime: bounded. Thread: any.
[[nodiscard]] constexpr std::uint16_t iso_checksum(Octets octets) noexcept {
  unsigned c0 = 0;
  unsigned c1 = 0;
  for (const std::byte octet : octets) {
    c0 = (c0 + std::to_integer<unsigned>(octet)) % 255;
    c1 = (c1 + c0) % 255;
  }
  const unsigned first = 255 - (c0 + c1) % 255;
  const unsigned second = c1 == 0 ? 255 : c1;
  return static_cast<std::uint16_t>(first << 8 | second);
}

}  // namespace hirosco::pus
