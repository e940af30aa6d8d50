// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "supervisor/overview.hpp"

namespace hirosco::terminal {

/// The newest housekeeping of a subsystem, by name of the parameter.
using HeardValues = std::map<std::string, pus::HousekeepingValue>;

/// The craft as the supervisor's housekeeping tells it to the ground: mode, states, inhibitions, cycles, links. What is not told there
/// (whether scheduling is real-time, what is waited for) is as if all were well. Empty: it has not told all of it yet.
[[nodiscard]] std::optional<supervisor::Overview> heard_overview(const descriptor::Mission& mission,
                                                                 const HeardValues& supervisor);

}  // namespace hirosco::terminal
