// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/utilities/crc16.hpp"
#include "hirosco/utilities/octets.hpp"

namespace hirosco::testing {

/// A device, enable or power frame that is intact again and of this kind, whatever it was before.
inline Octets sealed_as(std::uint8_t kind, MutableOctets frame) {
  frame[2] = std::byte{kind};
  OctetWriter sum{frame.last(2), std::endian::little};
  sum.put(crc16(Octets{frame}.first(frame.size() - 2)));
  return frame;
}

}  // namespace hirosco::testing
