// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// The process of its subject is ended, its actuators first. Its death is an event, which the plan for that answers.
inline constexpr StepKind kill{
    .name = "kill",
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.craft.guard.fence(step.subject);
          const Member* subject = means.craft.member(step.subject);
          if (subject != nullptr && subject->alive()) {
            means.craft.tell("plan " + step.occasion.plan + ": " + means.craft.name_of(step.subject) +
                                 " is ended because of " + step.occasion.event,
                             step.subject);
            means.craft.launcher.kill(subject->process());
          }
          done(true, {});
        },
    .fences = [](const ProcedureStep& step, const Means&) { return std::vector<std::uint16_t>{step.subject}; },
    .against = [](const ProcedureStep& step, const Means& means) -> std::string {
      const Member* subject = means.craft.member(step.subject);
      return subject != nullptr && subject->alive() ? std::string{} : "it is down";
    },
    .safety = [](const ProcedureStep&) { return Safety::Stop; },
    .holds = StepKind::Holds::Nobody,
};

}  // namespace hirosco::supervisor::steps
