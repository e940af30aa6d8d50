// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "hirosco/descriptor/model/mission.hpp"
#include "simulation/spacecraft/spacecraft.hpp"

namespace hirosco::simulation {

/// What the octets of a simulated flight rest on besides its files, in one line of words NAME=VALUE: hirosco, architecture, c_library, engines, mission, seed.
/// Where one of these differs, the octets may, and nothing is wrong (docs/adr/0182).  Realtime: allocates.
[[nodiscard]] std::string origin_of(const descriptor::Mission& mission, Spacecraft& craft, std::uint64_t seed);
/// Begin of that line where others follow it: `# simulated: hirosco=...`.
inline constexpr const char* origin_mark = "# simulated: ";

}  // namespace hirosco::simulation
