// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace notice {
void give(const ProcedureStep& step, const Means& means, const CommandDone& done);
}  // namespace notice

/// All that is joined to its subject by real-time links is told of it, and goes on (paper 4.3): each that has this function is called
/// by it. Who cannot hear it now is told of, and holds up nobody.
inline constexpr StepKind notify_network{
    .name = "notify_network",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return step.words.front() + " to its network"; },
    .run = [](const ProcedureStep& step, const Means& means, CommandDone done) { notice::give(step, means, done); },
    .holds = StepKind::Holds::Nobody,
};

}  // namespace hirosco::supervisor::steps
