// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Its subject, whose process ended, is started again. Values: how often, within how many seconds, after how many
/// milliseconds, and up to which state it comes back to what it was commanded to be (docs/adr/0076); the limit does not hold for the
/// ground link (docs/adr/0043).
inline constexpr StepKind restart{
    .name = "restart",
    .values = 4,
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          using enum Restarts::AtLimit;
          const Restarts::Rule rule{.limit = static_cast<std::size_t>(step.values[descriptor::restart_limit]),
                                    .within = std::chrono::seconds{step.values[descriptor::restart_within_s]},
                                    .pause = std::chrono::milliseconds{step.values[descriptor::restart_pause_ms]},
                                    .most = static_cast<State>(step.values[descriptor::restart_to])};
          const Member* subject = means.craft.member(step.subject);
          const bool spared = subject != nullptr && means.craft.is_ground_link(*subject);
          if (!means.restarts.plan(step.subject, rule, means.craft.now, spared ? GoesOn : StaysDown))
            means.craft.tell(
                means.craft.name_of(step.subject) + " stays down: it died too often; SET_STATE Offline starts it again",
                step.subject);
          done(true, {});
        },
    .holds = StepKind::Holds::Nobody,
};

}  // namespace hirosco::supervisor::steps
