// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// A real-time link is given back: the value is its id. Who needs it stops by itself.
inline constexpr StepKind unlink{
    .name = "unlink",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return "no link " + std::to_string(step.values[0]); },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.desk.command(supervisor_apid, "UNLINK", static_cast<double>(step.values[0]), std::move(done));
        },
    .of_craft = true,
};

}  // namespace hirosco::supervisor::steps
