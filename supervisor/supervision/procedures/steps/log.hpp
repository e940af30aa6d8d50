// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Nothing: every event is in the log and the story already.
inline constexpr StepKind log{.name = "log"};

}  // namespace hirosco::supervisor::steps
