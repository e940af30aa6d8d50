// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/cycle/cycle_pace.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What the cycle thread does between two cycles: sleeps until `planned`, or until a sample arrives before that, at the earliest at
/// `wait.earliest`. Whoever floods costs its consumer no more wake-ups than that: before that instant it waits by the clock, and who
/// was woken without a sample rests as long again before it looks.
/// Realtime: blocks; system calls, no heap. Thread: the cycle.
void rest_until(TimePoint planned, const CycleWait& wait, const Clock& clock) noexcept;

}  // namespace hirosco
