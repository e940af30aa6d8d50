// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hirosco::communication {

/// Places of clients in the order of their turns, each once at most.  Realtime: bounded. Thread: one.
class Turns {
 public:
  static constexpr std::size_t most = 256;

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Whose turn it is, while there is one.
  [[nodiscard]] std::uint8_t first() const noexcept { return places_[first_]; }
  /// Behind all others.
  void join(std::uint8_t place) noexcept { places_[(first_ + size_++) % most] = place; }
  /// The first has had its turn.
  void done() noexcept {
    first_ = (first_ + 1) % most;
    --size_;
  }
  /// The first goes behind all others.
  void pass_over() noexcept {
    const std::uint8_t place = first();
    done();
    join(place);
  }
  /// Wherever it stands.
  void leave(std::uint8_t place) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::uint8_t each = places_[(first_ + i) % most];
      if (each != place) places_[(first_ + kept++) % most] = each;
    }
    size_ = kept;
  }

 private:
  std::array<std::uint8_t, most> places_{};
  std::size_t first_{0};
  std::size_t size_{0};
};

}  // namespace hirosco::communication
