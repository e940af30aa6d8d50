// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/unanswered.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Reports go to their destination: what answers a member's telecommand goes back to that member, besides to the ground
/// (adr 0062). Nobody can send to a member what it has not asked for. One that does not read is waited for with a few
/// reports; what is beyond is lost to it alone, counted and told.  Thread: the supervisor's.
class Replies final : public Hearer, public Watch {
 public:
  static constexpr std::size_t most_waiting = 256;  ///< packets for one member

  /// Stands before whoever forgets what was answered.
  Replies(Craft& craft, Unanswered& unanswered) : craft_{craft}, unanswered_{unanswered} {}

  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override;

 private:
  struct Queue {
    std::uint32_t process{0};  ///< whose it is: one that was started anew has asked for nothing
    std::deque<std::vector<std::byte>> waiting{};
    std::uint32_t lost{0};
    std::uint32_t lost_told{0};
    TimePoint next_told{};
  };
  [[nodiscard]] Queue& queue_of(const Member& member);
  static void flush(const Member& member, Queue& queue);

  Craft& craft_;
  Unanswered& unanswered_;
  std::map<std::uint16_t, Queue> queues_;  ///< of those who have asked
};

}  // namespace hirosco::supervisor
