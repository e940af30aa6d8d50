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
#include "supervisor/supervision/succession/journal.hpp"

/// When a subsystem whose process ended is started again: after a pause that doubles with each time, and no more often
/// than its plan says (`procedures/steps/restart.hpp`; `Processes` starts it; hazard SF15; a crash loop stays
/// down until the ground starts it, docs/adr/0068). The ground link alone never stays down: nobody could bring it up again. It is started
/// where no plan says so, too (`GroundLinkCare`).
namespace hirosco::supervisor {

class Restarts final : public Remembered {
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
  /// It is to be started, now or later.
  [[nodiscard]] bool is_planned(std::uint16_t apid) const { return due_.contains(apid); }
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
  /// The deaths so far: who dies too often stays down, whoever counts. Times are of the monotonic clock, which outlives processes.
  void note(OctetWriter& writer) const override {
    writer.put(static_cast<std::uint16_t>(history_.size()));
    for (const auto& [apid, deaths] : history_) {
      writer.put(apid).put(static_cast<std::uint16_t>(deaths.size()));
      for (const TimePoint at : deaths) writer.put(at.time_since_epoch().count());
    }
    writer.put(static_cast<std::uint16_t>(due_.size()));
    for (const auto& [apid, at] : due_) writer.put(apid).put(at.time_since_epoch().count());
  }
  void recall(OctetReader& reader) override {
    const auto time = [&] { return TimePoint{Duration{reader.get<std::int64_t>()}}; };
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      std::vector<TimePoint>& deaths = history_[reader.get<std::uint16_t>()];
      for (auto each = reader.get<std::uint16_t>(); each > 0 && reader.good(); --each) deaths.push_back(time());
    }
    for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
      const auto apid = reader.get<std::uint16_t>();
      due_[apid] = time();
    }
  }

 private:
  std::map<std::uint16_t, std::vector<TimePoint>> history_;
  std::map<std::uint16_t, TimePoint> due_;
  std::map<std::uint16_t, descriptor::State> most_;
  std::map<std::uint16_t, Duration> pauses_;  ///< before the newest start
};

}  // namespace hirosco::supervisor
