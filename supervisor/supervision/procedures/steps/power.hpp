// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// What the craft may draw from now on, in W: the supervisor takes down what is beyond.
inline constexpr StepKind power{
    .name = "power",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return std::to_string(step.values[0]) + " W to spend"; },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.desk.command(supervisor_apid, "SET_POWER_BUDGET", static_cast<double>(step.values[0]), std::move(done));
        },
    .of_craft = true,
};

}  // namespace hirosco::supervisor::steps
