// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "hirosco/descriptor/model/mission.hpp"

namespace hirosco::terminal {

/// Where the ground may ask this of a subsystem: "mode standalone while it is Operational; mode safe in any state". `request` as the
/// table of permission has it: "MOVE_TO", "SET_STATE Operational". Empty: nowhere.
[[nodiscard]] std::string permitted_where(const descriptor::Mission& mission,
                                          const descriptor::SubsystemDescriptor& addressee, std::string_view request);

/// Subsystems that may ask this of it in some mode: "SWITCH, PLANNER". Empty: none.
[[nodiscard]] std::string permitted_to_others(const descriptor::Mission& mission,
                                              const descriptor::SubsystemDescriptor& addressee,
                                              std::string_view request);

/// "while it is Safe-Operational or Operational", "in any state": bit n set is State n.
[[nodiscard]] std::string while_in(std::uint16_t states);

/// Who ends a request that was aborted without a reason of its own, and where that stands; empty: this code is another one.
[[nodiscard]] std::string ended_by(std::uint16_t failure_code);

}  // namespace hirosco::terminal
