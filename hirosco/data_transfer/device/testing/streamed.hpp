// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hirosco/data_transfer/device/stream_framing.hpp"

namespace hirosco::testing {

/// A frame of so many octets of `mark`, as it goes over a stream.
[[nodiscard]] inline std::vector<std::byte> streamed(std::uint8_t mark, std::size_t octets = 40) {
  std::array<std::byte, max_streamed_octets> buffer;
  const Octets made = write_streamed(buffer, std::vector<std::byte>(octets, std::byte{mark}));
  return {made.begin(), made.end()};
}

}  // namespace hirosco::testing
