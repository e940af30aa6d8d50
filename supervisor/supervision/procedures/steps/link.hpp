// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// A real-time link up: the value is its id. The supervisor leads the handshake, whoever the subject is.
inline constexpr StepKind link{
    .name = "link",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return "link " + std::to_string(step.values[0]); },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.desk.command(supervisor_apid, "LINK", static_cast<double>(step.values[0]), std::move(done));
        },
    .of_craft = true,
};

}  // namespace hirosco::supervisor::steps
