// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hirosco::telepresence_relay {

/// One direction of the link between ground and spacecraft: every cycle a set goes in, and the one of `delay` cycles ago
/// comes out, unless it was lost; then the last that arrived stays.
/// Realtime: wait-free. Thread: the cycle.
template <class Set>
class DelayLine {
 public:
  static constexpr std::size_t longest_cycles = 127;

  void reset() noexcept { *this = {}; }
  /// `sent`: false when there is nothing to send or the radio loses it.
  const Set& pass(const Set& set, bool sent, std::size_t delay_cycles) noexcept {
    ring_[at_ % ring_.size()] = {set, sent};
    const Entry& out = ring_[(at_ + ring_.size() - delay_cycles) % ring_.size()];
    ++at_;
    if (out.sent) {
      arrived_ = out.set;
      age_cycles_ = 0;
    } else if (age_cycles_ < never) {
      ++age_cycles_;
    }
    return arrived_;
  }
  /// Cycles since the last arrival.
  [[nodiscard]] std::uint32_t age_cycles() const noexcept { return age_cycles_; }
  static constexpr std::uint32_t never = 1'000'000'000;

 private:
  struct Entry {
    Set set{};
    bool sent{false};
  };
  std::array<Entry, longest_cycles + 1> ring_{};
  std::size_t at_{0};
  Set arrived_{};
  std::uint32_t age_cycles_{never};
};

/// Decides by a share which packets are lost; the same ones in every run.  Realtime: wait-free. Thread: the cycle.
class Loss {
 public:
  [[nodiscard]] bool strikes(double share) noexcept {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) * 0x1.0p-53 < share;
  }

 private:
  std::uint64_t state_{0x9E3779B97F4A7C15ULL};
};

}  // namespace hirosco::telepresence_relay
