// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::tools {

/// Services of the framework's that a mode permits and that are no mode's to open (E0352): there is none of the number, everybody may always ask for
/// it, or the supervisor alone may. A subsystem's own are the reader's to find, which stands below the framework's services (docs/adr/0203).
[[nodiscard]] std::vector<descriptor::Diagnostic> permit_problems(const descriptor::Mission& mission);

}  // namespace hirosco::tools
