// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/descriptor/model/mission.hpp"
#include "tools/doctor/system.hpp"

namespace hirosco::tools::doctor {

/// Looks at this computer, within half a second, by the calls that a flight of the mission makes itself. It forks, so there must be no other
/// thread. `not_ready` is the caller's to say.
[[nodiscard]] System look_at(const descriptor::Mission& mission);

}  // namespace hirosco::tools::doctor
