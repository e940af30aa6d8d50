// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace settings {
void recall(const ProcedureStep& step, const Means& means, CommandDone done);
}  // namespace settings

/// The settings that its subject had by telecommand, sent to it again one after the other, in this state: the value. What is refused
/// ends it, but where its subject is the supervisor itself.
inline constexpr StepKind recall{
    .name = "recall",
    .values = 1,
    .text = [](const ProcedureStep&, const descriptor::Mission&) { return std::string{"settings"}; },
    .run = settings::recall,
};

}  // namespace hirosco::supervisor::steps
