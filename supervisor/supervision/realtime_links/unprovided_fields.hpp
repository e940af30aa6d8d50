// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

namespace hirosco::supervisor {

/// What other ends of its links read and this subsystem provides in none of its configurations, as "HAND reads SPEED of ARM.STATE (link 1)": of
/// a text that was judged there is nothing, one that is gone back to nobody judges (docs/adr/0236). Such a link is refused by its ends.
/// Realtime: allocates.
[[nodiscard]] std::vector<std::string> unprovided_fields(const descriptor::Mission& mission,
                                                         const descriptor::SubsystemDescriptor& producer);

}  // namespace hirosco::supervisor
