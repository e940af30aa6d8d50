// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

/// What the supervisor's own events mean for recovery plans (docs/adr/0047).
namespace hirosco::descriptor {

/// What a supervisor tells of one of its subsystems: a plan for it may name either of the two.
inline constexpr std::array<std::string_view, 5> events_about_subsystems{"PROCESS_DIED", "HANG", "POWER_REFUSED",
                                                                         "POWER_LOW", "LOAD_SHED"};
[[nodiscard]] constexpr bool is_about_subsystem(std::string_view event) noexcept {
  return std::ranges::find(events_about_subsystems, event) != events_about_subsystems.end();
}
/// It tells of each step of a plan: nothing can be planned for that.
inline constexpr std::string_view event_of_plans = "RECOVERY_STEP";
/// The only one that a restart can answer.
inline constexpr std::string_view event_of_death = "PROCESS_DIED";

}  // namespace hirosco::descriptor
