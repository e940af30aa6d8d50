// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/utilities/time.hpp"

/// Telecommands that were handed to a subsystem and whose final report has not passed yet: when their addressee dies,
/// somebody must say that their outcome is unknown (reliability 5.2).
namespace hirosco::supervisor {

class Unanswered {
 public:
  /// More cannot be on their way to all subsystems at once: forward_room() is asked before.
  static constexpr std::size_t most = 16'384;

  /// A telecommand leaves for `apid`. One that asks for no report on its completion is known until it was accepted, or
  /// until its acceptance would not be told either, for nobody waits for more.
  void forwarded(std::uint16_t apid, const pus::TelecommandView& telecommand, TimePoint now);
  /// Whether a report that came by answers something that its destination has asked of its sender. Besides the end of a
  /// telecommand a number of reports does, so that an addressee cannot flood who asks.
  static constexpr std::uint16_t most_reports = 64;
  [[nodiscard]] bool answers(const pus::TelemetryView& report);
  /// How many of `source` are under way, but for those that it has given up itself (Subsystem::request_patience).
  static constexpr Duration patience = std::chrono::seconds{20};
  [[nodiscard]] std::size_t count_of(std::uint16_t source, TimePoint now) const;
  /// A report of service 1 came by: what it ends is forgotten.
  void reported(const pus::TelemetryView& report);
  /// All that `apid` was given and did not end; they are forgotten.
  [[nodiscard]] std::vector<pus::Request> take(std::uint16_t apid);
  [[nodiscard]] bool full() const noexcept { return entries_.size() >= most; }
  [[nodiscard]] std::size_t size() const noexcept { return entries_.size(); }

 private:
  struct Entry {
    std::uint16_t apid{0};
    pus::Request request;
    TimePoint since{};
    std::uint16_t reports{0};  ///< that answered it
  };
  std::deque<Entry> entries_;  ///< in the order of forwarding; the oldest end first as a rule
};

}  // namespace hirosco::supervisor
