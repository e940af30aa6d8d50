// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// The actuators of its subject stop, whatever that does; its state stays. What it was commanded to be counts no more.
inline constexpr StepKind fence{
    .name = "fence",
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.craft.guard.fence(step.subject);  // again: an earlier step may have let it go since
          // Nor is it brought back to more than that, should it crash now.
          means.commanded.lower(step.subject, State::SafeOperational, step.occasion.event);
          if (!step.occasion.event.empty())
            means.craft.tell("plan " + step.occasion.plan + ": " + means.craft.name_of(step.subject) +
                                 " fenced because of " + step.occasion.event,
                             step.subject);
          done(true, {});
        },
    .fences = [](const ProcedureStep& step, const Means&) { return std::vector<std::uint16_t>{step.subject}; },
    .safety = [](const ProcedureStep&) { return Safety::Stop; },
};

}  // namespace hirosco::supervisor::steps
