// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/overrun_watch.hpp"

namespace hirosco {

void OverrunWatch::begin(const descriptor::Configuration& configuration, bool realtime) noexcept {
  *this = {};
  period_ = configuration.shortest();
  limit_ = realtime ? configuration.overruns.realtime : configuration.overruns.reduced;
}

bool OverrunWatch::account(Duration execution, Duration late) noexcept {
  if (execution <= period_) {
    in_a_row_ = 0;
    return false;
  }
  ++count_;
  if (late > period_) return false;
  return ++in_a_row_ == limit_;
}

}  // namespace hirosco
