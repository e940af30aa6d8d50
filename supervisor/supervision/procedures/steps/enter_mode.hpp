// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// The mode of the craft, once everybody is where it wants them: the value is its id. The subject is the supervisor.
inline constexpr StepKind enter_mode{
    .name = "enter_mode",
    .values = 1,
    .text =
        [](const ProcedureStep& step, const descriptor::Mission& mission) {
          const auto found = std::ranges::find(mission.modes, step.values[0], &descriptor::Mode::id);
          return "mode " + (found != mission.modes.end() ? found->name : std::to_string(step.values[0]));
        },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.desk.command(step.subject, "ENTER_MODE", static_cast<double>(step.values[0]), std::move(done));
        },
};

}  // namespace hirosco::supervisor::steps
