// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace task {
void hand_over(const ProcedureStep& step, const Means& means, const CommandDone& done);
[[nodiscard]] std::string against(const ProcedureStep& step, const Means& means);
}  // namespace task

/// What its subject does somebody else does from now on (paper 4.3: station keeping to the attitude control): its subject is fenced and stops, the
/// receiver, by its APID, comes from where it is to Operational in a configuration, by its id, with the links that this needs.
/// Whoever was stopped since the ground or a mode let it go last receives nothing (E0370).
inline constexpr StepKind hand_over{
    .name = "hand_over",
    .values = 2,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return "task to " + step.words[0] + " in " + step.words[1]; },
    .run = [](const ProcedureStep& step, const Means& means, CommandDone done) { task::hand_over(step, means, done); },
    .fences = [](const ProcedureStep& step, const Means&) { return std::vector<std::uint16_t>{step.subject}; },
    .against = task::against,
    .safety = [](const ProcedureStep&) { return Safety::Stop; },
};

}  // namespace hirosco::supervisor::steps
