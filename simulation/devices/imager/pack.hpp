// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

/// PackBits, the packing of TIFF: an octet n from 0 to 127 is followed by n + 1 as they are, one from 129 to 255 by one that stands 257 - n times.
namespace hirosco::simulation {

struct Packed {
  std::size_t pixels{0};  ///< taken from the front
  std::size_t octets{0};  ///< that they need
};

/// As many pixels as find room in `out`, at least one where there is any and two octets of room.  Realtime: bounded.
[[nodiscard]] inline Packed pack(std::span<const std::uint8_t> pixels, std::span<std::uint8_t> out) noexcept {
  constexpr std::size_t longest = 128, worth_it = 3;
  Packed done;
  const auto run_at = [&](std::size_t at) {
    std::size_t run = 1;
    while (run < longest && at + run < pixels.size() && pixels[at + run] == pixels[at]) ++run;
    return run;
  };
  while (done.pixels < pixels.size()) {
    const std::size_t room = out.size() - done.octets, run = run_at(done.pixels);
    if (room < 2) break;
    if (run >= worth_it) {
      out[done.octets++] = static_cast<std::uint8_t>(257 - run);
      out[done.octets++] = pixels[done.pixels];
      done.pixels += run;
      continue;
    }
    const std::size_t most = std::min({longest, room - 1, pixels.size() - done.pixels});
    const auto ends = [&](std::size_t at) {
      return at + 2 < pixels.size() && pixels[at] == pixels[at + 1] && pixels[at] == pixels[at + 2];
    };
    std::size_t length = 1;
    while (length < most && !ends(done.pixels + length)) ++length;
    out[done.octets++] = static_cast<std::uint8_t>(length - 1);
    std::copy_n(pixels.data() + done.pixels, length, out.data() + done.octets);
    done.octets += length;
    done.pixels += length;
  }
  return done;
}

}  // namespace hirosco::simulation
