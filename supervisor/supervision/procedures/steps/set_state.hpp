// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Its subject to a state: the value.
inline constexpr StepKind set_state{
    .name = "set_state",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return std::string{to_text(static_cast<State>(step.values[0]))}; },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          const auto state = static_cast<State>(step.values[0]);
          if (!step.occasion.event.empty())
            means.craft.tell("plan " + step.occasion.plan + ": " + means.craft.name_of(step.subject) + " to " +
                                 std::string{to_text(state)} + " because of " + step.occasion.event,
                             step.subject);
          means.desk.command(step.subject, "SET_STATE", static_cast<double>(state), std::move(done));
        },
    .answers =
        [](const ProcedureStep& step, const Craft& craft) {
          // Decision 11: elsewhere it is logged.
          const Member* subject = craft.member(step.subject);
          return static_cast<State>(step.values[0]) != State::SafeOperational ||
                 (subject != nullptr && subject->state() == State::Operational);
        },
};

}  // namespace hirosco::supervisor::steps
