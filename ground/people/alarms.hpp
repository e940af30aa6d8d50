// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ground/archive/archive.hpp"
#include "ground/model/answered.hpp"

namespace hirosco::ground {

/// What deviated in this flight: one alarm for each event of medium or high severity, latched until somebody has acknowledged it. One
/// that is shelved calls nobody until its time is over. What people did is in the archive, so that a new page and a new station know it.
/// Thread: one.
class Alarms {
 public:
  static constexpr int lowest_severity = 3;  ///< medium
  static constexpr std::size_t most_alarms = 2000;
  static constexpr std::size_t longest_note = 200;
  static constexpr Duration longest_shelf = 24h;

  struct Act {
    OnboardTime t{};
    std::string who;
    std::string note;
    OnboardTime until{};  ///< of a shelf
  };
  struct Alarm {
    StoredEvent newest;
    OnboardTime first{};
    std::uint64_t count{0};  ///< how often in this flight
    std::uint64_t fresh{0};  ///< of these since the last acknowledgement
    std::optional<Act> acknowledged;
    std::optional<Act> shelved;
  };
  /// What there was from `began` on, with what people did.
  Alarms(Archive& archive, OnboardTime began);

  /// Nothing when the event is none, else the alarm as it is now.
  std::optional<nlohmann::json> hear(const StoredEvent& event);
  /// {subsystem, event, action: acknowledge, shelve or unshelve, note, for_s} by `who`; the alarm as it is now. 404: there is none.
  /// Subsystem "*" acknowledges all that there is, and the last stop: the whole list.
  [[nodiscard]] Answered<nlohmann::json> act(const nlohmann::json& body, const std::string& who, OnboardTime now);
  /// Those whose shelf is over, as they are now.
  [[nodiscard]] std::vector<nlohmann::json> expire(OnboardTime now);
  /// Another flight begins: nothing of the one before.
  void begin(OnboardTime began);
  /// {alarms, seen_until}: those that call first; when somebody acknowledged all.
  [[nodiscard]] nlohmann::json list() const;

 private:
  using Key = std::pair<std::uint16_t, std::uint16_t>;  ///< subsystem, event
  void apply(const StoredMark& mark);
  void note(const StoredEvent& event);

  Archive& archive_;
  std::map<Key, Alarm> alarms_;
  OnboardTime seen_until_{};
};

}  // namespace hirosco::ground
