// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

/// Which heaters are on in a cycle: each as large a share of the time as it is to be, all together never above a power. No framework.
namespace hirosco::thermal {

inline constexpr std::size_t most_zones = 12;

struct Wanted {
  float share{0};  ///< of the time, 0 to 1
  float heater_w{0};  ///< that it draws while it is on
  std::uint8_t rank{0};  ///< who is first when not all can be on: the lowest
  bool urgent{false};  ///< before all that are not, whatever the rank
};

/// Realtime: bounded. Each zone is owed its share of each cycle, and is on for a cycle once a whole one is owed. What is owed to who had to
/// wait is kept, up to two cycles: so who comes later gets what is left over, and nobody catches up for an hour.
class HeaterShare {
 public:
  static constexpr float most_owed = 2;

  /// `on[i]`: heater i is on in this cycle. At most `most_w` are drawn by all together.
  void share(std::span<const Wanted> zones, float most_w, std::span<std::uint8_t> on) noexcept {
    std::array<std::size_t, most_zones> order{};
    const std::size_t count = std::min({zones.size(), on.size(), most_zones});
    for (std::size_t i = 0; i < count; ++i) order[i] = i;
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), [&](std::size_t a, std::size_t b) {
      if (zones[a].urgent != zones[b].urgent) return zones[a].urgent;
      return std::pair{zones[a].rank, a} < std::pair{zones[b].rank, b};
    });
    drawn_w_ = 0;
    for (std::size_t place = 0; place < count; ++place) {
      const std::size_t i = order[place];
      owed_[i] = zones[i].share > 0 ? std::min(owed_[i] + zones[i].share, most_owed) : 0;
      const bool due = owed_[i] >= 1 - rounding;
      const bool fits = drawn_w_ + zones[i].heater_w <= most_w;
      on[i] = due && fits ? 1 : 0;
      if (on[i] == 0) continue;
      owed_[i] = std::max(0.0F, owed_[i] - 1);
      drawn_w_ += zones[i].heater_w;
    }
  }
  /// Less is given to it than it is to have: a whole cycle is owed to it still.
  [[nodiscard]] bool is_short(std::size_t zone) const noexcept { return owed_[zone] >= 1 - rounding; }
  /// By the heaters that are on in this cycle.
  [[nodiscard]] float drawn_w() const noexcept { return drawn_w_; }
  void begin() noexcept { *this = {}; }

 private:
  /// Ten shares of a tenth are a whole one, whatever their sum is in binary.
  static constexpr float rounding = 5e-4F;
  std::array<float, most_zones> owed_{};
  float drawn_w_{0};
};

/// What is drawn against what is commanded: a switch that does not open, or a heater that is burnt out.
class DrawnWatch {
 public:
  /// True when they begin to differ; once, until they agree again.
  bool update(float commanded_w, float drawn_w) noexcept {
    const float tolerance_w = 1 + 0.05F * commanded_w;
    const float more_w = drawn_w - commanded_w;
    if (std::abs(more_w) <= tolerance_w || !std::isfinite(drawn_w)) {
      *this = {};
      return false;
    }
    excess_w_ = in_a_row_ == 0 ? more_w : std::min(excess_w_, more_w);
    in_a_row_ = std::min(in_a_row_ + 1, needed);
    return in_a_row_ == needed && !std::exchange(told_, true);
  }
  /// That nobody has commanded, and that is not there for others.
  [[nodiscard]] float excess_w() const noexcept { return in_a_row_ == needed ? std::max(0.0F, excess_w_) : 0; }

 private:
  static constexpr int needed = 3;
  float excess_w_{0};
  int in_a_row_{0};
  bool told_{false};
};

}  // namespace hirosco::thermal
