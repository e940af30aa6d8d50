// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "hirosco/descriptor/read/detail/mission_draft.hpp"

/// Parts of a mode that are read, or checked, each by itself.
namespace hirosco::descriptor::detail {

/// Somebody can be found in it; the others are passed through.
[[nodiscard]] constexpr bool is_steady(State state) noexcept {
  return state == State::Offline || state == State::PreOperational || state == State::SafeOperational ||
         state == State::Operational || state == State::ErrorOperational || state == State::PostOperational;
}
/// One of these; another is reported.
[[nodiscard]] State read_steady_state(Attributes& attributes, std::string_view name, State fallback,
                                      Problems& problems);

/// What a mode lets through.
void read_permit(const xml::Element& element, Mode& mode, MissionDraft& draft);

/// What has to hold before it is entered, or must not.
void read_interlock(const xml::Element& element, Interlock::Kind kind, Mode& mode, MissionDraft& draft);
// check_modes.cpp
/// Modes may be named before they are read: when all are.
void check_from(const xml::Element& modes, const Mission& mission, Problems& problems);
/// Where a subsystem may ask for modes the ground may leave each of them: else that could take the craft from it.
void check_way_back(const Mission& mission, Problems& problems);
/// The mode that `initial` names is in force from the beginning.
void check_initial(const xml::Attribute& initial, const Mode& mode, Problems& problems);
/// The mode that `start` names is entered first.
void check_start(const xml::Attribute& start, const Mode& mode, const Mission& mission, Problems& problems);

// check_mode.cpp
/// What a mode commissions must fit the power budget together.
void check_power(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems);
/// And the one processor of all cycles.
void check_cycles(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems);
/// What the links that a mode brings up take of shared memory fits what each of their ends says of it.
void check_shared_memory(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems);
/// A mode brings up a link into each set that what it commissions requires.
void check_required(const Mode& mode, const Mission& mission, Problems& problems);
/// Both ends of a link are commissioned with the sets that it joins.
void check_established(const xml::Element& element, const Mode& mode, const Mission& mission, Problems& problems);

}  // namespace hirosco::descriptor::detail
