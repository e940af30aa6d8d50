// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace fencing {
inline void fence(const ProcedureStep& step, const Means& means) { means.craft.guard.fence(step.subject); }
}  // namespace fencing

/// The actuators of its subject stop, whatever that does; its state stays.
inline constexpr StepKind fence{
    .name = "fence",
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          fencing::fence(step, means);  // again: an earlier step may have let it go since
          if (!step.occasion.event.empty())
            means.craft.tell("plan " + step.occasion.plan + ": " + means.craft.name_of(step.subject) +
                                 " fenced because of " + step.occasion.event,
                             step.subject);
          done(true, {});
        },
    .act_first = fencing::fence,
    .safety = [](const ProcedureStep&) { return Safety::Stop; },
};

}  // namespace hirosco::supervisor::steps
