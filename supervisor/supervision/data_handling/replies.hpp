// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/deliveries.hpp"
#include "supervisor/supervision/data_handling/unanswered.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// Reports go to their destination: what answers a member's telecommand goes back to that member, besides to the ground
/// (adr 0062). Nobody can send to a member what it has not asked for. One that does not read is waited for with a few
/// reports.  Thread: the supervisor's.
class Replies final : public Hearer, public Watch {
 public:
  static constexpr std::size_t most_waiting = Deliveries::most_waiting;

  /// Stands before whoever forgets what was answered.
  Replies(Craft& craft, Unanswered& unanswered);

  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override { deliveries_.watch(now); }

 private:
  Craft& craft_;
  Unanswered& unanswered_;
  Deliveries deliveries_;
};

}  // namespace hirosco::supervisor
