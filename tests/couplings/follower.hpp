// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco {

/// Turns its axis as the newest number says, or steadily where it follows nobody, and counts what it sees of the set that it follows: SEEN.
/// Input: LinkInput or QueueInput.
template <template <class> class Input>
class Follower final : public Subsystem {
  struct Tick {
    std::uint64_t number;
    double angle_rad;
  };
  struct Seen {
    std::uint64_t taken;
    std::uint64_t uncounted;  ///< numbers of a queue that neither came nor are counted as lost
    std::uint64_t torn;  ///< samples of which one part is not of the same cycle as the other
  };
  struct Turned {
    double angle_rad;
  };
  struct Turn {
    double rate_rad_per_s;
  };

  Result<Step> software_init() override {
    publish("ANGLE", angle_);
    publish("SCALE", scale_);
    publish("SEEN", seen_);
    require_link("TICKS", ticks_);
    use_device("AXIS", axis_);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return follow(); }
  Result<> safe_operational(const Cycle&) noexcept override { return follow(); }
  Result<> operational(const Cycle&) noexcept override { return follow(); }
  Result<> error_operational(const Cycle&) noexcept override { return follow(); }

  Result<> follow() noexcept {
    take(ticks_);
    angle_.store(axis_.input().angle_rad);
    constexpr double rate_rad_per_s = 0.2;
    axis_.output().rate_rad_per_s = scale_.load() * rate_rad_per_s * (newest_.number % 2 == 0 ? 1 : 0.5);
    return ok();
  }

  void take(const LinkInput<Tick>& link) noexcept {
    if (link.count() == 0 || link.age_cycles() != 0) return;
    Seen seen = seen_.load();
    newest_ = link.value();
    ++seen.taken;
    seen.torn += is_whole(newest_) ? 0 : 1;
    seen_.store(seen);
  }

  void take(const QueueInput<Tick>& queue) noexcept {
    const std::span<const Tick> ticks = queue.samples();
    Seen seen = seen_.load();
    for (const Tick& tick : ticks) seen.torn += is_whole(tick) ? 0 : 1;
    seen.taken += ticks.size();
    // As many came as the link says behind those before: it is the same link still.
    const bool same = received_ != 0 && queue.received() == received_ + ticks.size();
    if (same && !ticks.empty()) {
      const std::uint64_t told = ticks.size() + queue.lost() - lost_;
      const std::uint64_t passed = ticks.back().number - newest_.number;
      seen.uncounted += std::max(passed, told) - told;
    }
    if (!ticks.empty()) newest_ = ticks.back();
    received_ = queue.received();
    lost_ = queue.lost();
    seen_.store(seen);
  }

  static bool is_whole(const Tick& tick) noexcept { return tick.angle_rad == 0.001 * static_cast<double>(tick.number); }

  Input<Tick> ticks_;
  DevicePort<Turned, Turn> axis_;
  Parameter<double> angle_;
  Parameter<double> scale_;
  Parameter<Seen> seen_;
  Tick newest_{};
  std::uint64_t received_{0};
  std::uint64_t lost_{0};
};

}  // namespace hirosco
