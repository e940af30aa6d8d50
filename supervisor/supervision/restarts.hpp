// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/utilities/time.hpp"

/// When a subsystem whose process ended is started again: after a pause that doubles with each time, and no more often
/// than its plan says (`procedures/steps/restart.hpp`; `Processes` starts it; hazard SF15; reliability 5: a crash loop stays down until the ground starts it, docs/adr/0068). The ground
/// link alone never stays down: nobody could bring it up again.
namespace hirosco::supervisor {

class Restarts {
 public:
  enum class AtLimit { StaysDown, GoesOn };
  /// At most `limit` times within `within`, after a pause that doubles.
  struct Rule {
    std::size_t limit{0};
    Duration within{};
    Duration pause{};
    descriptor::State most{descriptor::State::Offline};  ///< as far as it comes back to what it was commanded to be
  };
  static constexpr Duration longest_pause = std::chrono::seconds{10};
  static constexpr Duration shortest_retry = std::chrono::milliseconds{100};

  /// False: the limit is reached, it stays down.
  bool plan(std::uint16_t apid, const Rule& rule, TimePoint now, AtLimit at_limit = AtLimit::StaysDown) {
    std::vector<TimePoint>& before = history_[apid];
    std::erase_if(before, [&](TimePoint at) { return now - at >= rule.within; });
    most_.erase(apid);
    if (before.size() >= rule.limit && at_limit == AtLimit::StaysDown) return false;
    most_[apid] = rule.most;
    Duration pause = rule.pause;
    for (std::size_t i = 0; i < before.size() && pause < longest_pause; ++i) pause *= 2;
    pause = std::min(pause, std::max(longest_pause, rule.pause));
    before.push_back(now);
    due_[apid] = now + pause;
    pauses_[apid] = pause;
    return true;
  }
  /// The start itself failed, which is no death: it is tried again as long as the flight lasts, after a pause that doubles.
  void again(std::uint16_t apid, TimePoint now) {
    Duration& pause = pauses_[apid];
    pause = std::clamp(2 * pause, shortest_retry, longest_pause);
    due_[apid] = now + pause;
  }
  /// One that is due now, and no longer planned.
  [[nodiscard]] std::optional<std::uint16_t> take_due(TimePoint now) {
    for (auto entry = due_.begin(); entry != due_.end(); ++entry) {
      if (now < entry->second) continue;
      const std::uint16_t apid = entry->first;
      due_.erase(entry);
      return apid;
    }
    return std::nullopt;
  }
  /// Of the newest plan(), once; empty: it stays down, or nothing was planned.
  [[nodiscard]] std::optional<descriptor::State> take_most(std::uint16_t apid) {
    const auto found = most_.extract(apid);
    return found ? std::optional{found.mapped()} : std::nullopt;
  }
  void cancel() { due_.clear(); }

 private:
  std::map<std::uint16_t, std::vector<TimePoint>> history_;
  std::map<std::uint16_t, TimePoint> due_;
  std::map<std::uint16_t, descriptor::State> most_;
  std::map<std::uint16_t, Duration> pauses_;  ///< before the newest start
};

}  // namespace hirosco::supervisor
