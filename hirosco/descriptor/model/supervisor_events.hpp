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
/// They tell of plans themselves: nothing can be planned for that.
inline constexpr std::array<std::string_view, 3> events_of_plans{"RECOVERY_STEP", "PLAN_PREEMPTED", "PLAN_REFUSED"};
[[nodiscard]] constexpr bool is_of_plans(std::string_view event) noexcept {
  return std::ranges::find(events_of_plans, event) != events_of_plans.end();
}
/// Enumeration of a supervisor's descriptor that a mission's plans are added to: their numbers, from 1, and names.
inline constexpr std::string_view plans_enumeration = "PLANS";
/// The only one that a restart can answer.
inline constexpr std::string_view event_of_death = "PROCESS_DIED";

}  // namespace hirosco::descriptor
