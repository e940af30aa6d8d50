// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace hirosco::robotics {

/// Two of the last three samples: one that is disturbed stops no mission and begins nothing, two are no accident.
/// Realtime: wait-free, no allocation.
class TwoOfThree {
 public:
  /// Takes a sample and tells whether two of the last three were true. Before the first one all were false.
  [[nodiscard]] constexpr bool add(bool sample) noexcept {
    last_ = static_cast<std::uint8_t>((last_ << 1 | (sample ? 1 : 0)) & 0b111);
    return std::popcount(last_) >= 2;
  }
  /// As before the first sample.
  constexpr void forget() noexcept { last_ = 0; }

 private:
  std::uint8_t last_{0};  // three samples, one bit each
};

}  // namespace hirosco::robotics
