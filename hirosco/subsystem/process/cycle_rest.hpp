// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/subsystem/cycle/cycle_pace.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What the cycle thread does between two cycles: sleeps until `planned`, or until a sample arrives before that, at the earliest at
/// `wait.earliest`. Whoever floods costs its consumer no more wake-ups than that: before that instant it waits by the clock, and who
/// was woken without a sample rests as long again before it looks. A precise cycle sleeps until `wait.spin` before and spins then.
/// \return the thread's processor time when it began to spin; empty: it has not.
/// Realtime: blocks; system calls, no heap. Thread: the cycle.
std::optional<Duration> rest_until(TimePoint planned, const CycleWait& wait, const Clock& clock) noexcept;

/// Looks at the clock until that says `due`. It ends by itself, whatever the clock says: no look takes less than a nanosecond, so who
/// has looked as often as `most` has nanoseconds has waited for that long.
/// \return how often it looked.
/// Realtime: bounded, keeps the processor. Thread: any.
std::uint64_t spin_until(TimePoint due, Duration most, const Clock& clock) noexcept;

}  // namespace hirosco
