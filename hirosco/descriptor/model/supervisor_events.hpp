// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

/// What the supervisor's own events mean for recovery plans (docs/adr/0047).
namespace hirosco::descriptor {

/// What a supervisor tells of one of its subsystems: a plan for it may name either of the two.
inline constexpr std::array<std::string_view, 6> events_about_subsystems{
    "PROCESS_DIED", "HANG", "POWER_REFUSED", "POWER_LOW", "LOAD_SHED", "GROUND_LINK_LOST"};
[[nodiscard]] constexpr bool is_about_subsystem(std::string_view event) noexcept {
  return std::ranges::find(events_about_subsystems, event) != events_about_subsystems.end();
}
/// Of the ground link alone: nobody is there on ground any more, and somebody is again. The ground link's own events have these names; the supervisor
/// tells the first where that cannot (docs/adr/0165).
inline constexpr std::string_view event_of_ground_lost = "GROUND_LINK_LOST";
inline constexpr std::string_view event_of_ground_back = "GROUND_LINK_RESTORED";
/// Whether a supervisor may tell it of that subsystem.
[[nodiscard]] constexpr bool may_be_told_of(std::string_view event, std::string_view subsystem,
                                            std::string_view ground_link) noexcept {
  return is_about_subsystem(event) && (event != event_of_ground_lost || subsystem == ground_link);
}
/// A stop of everything that no telecommand asked for. It is carried out when it is told.
inline constexpr std::string_view event_of_local_stop = "LOCAL_STOP";
/// Nothing can be planned for what tells of plans themselves, nor for what stops everything already.
inline constexpr std::array<std::string_view, 4> unplanned_events{"RECOVERY_STEP", "PLAN_PREEMPTED", "PLAN_REFUSED",
                                                                  event_of_local_stop};
[[nodiscard]] constexpr bool is_unplanned(std::string_view event) noexcept {
  return std::ranges::find(unplanned_events, event) != unplanned_events.end();
}
/// Enumeration of a supervisor's descriptor that a mission's plans are added to: their numbers, from 1, and names.
inline constexpr std::string_view plans_enumeration = "PLANS";
/// The only one that a restart can answer.
inline constexpr std::string_view event_of_death = "PROCESS_DIED";

}  // namespace hirosco::descriptor
