// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace state_step {
[[nodiscard]] inline State wanted(const ProcedureStep& step) { return static_cast<State>(step.values[0]); }

/// Decision 11: to Safe-Operational goes only who is Operational; elsewhere it is logged.
[[nodiscard]] inline bool answers(const ProcedureStep& step, const Craft& craft) {
  const Member* subject = craft.member(step.subject);
  return wanted(step) != State::SafeOperational || (subject != nullptr && subject->state() == State::Operational);
}

/// A plan takes its subject from what it does; whether its service loop obeys may be just what has failed. So the
/// actuators come first, and its next permitted SET_STATE to Operational lets them go. Nobody else of its network is fenced.
[[nodiscard]] inline std::vector<std::uint16_t> fenced(const ProcedureStep& step, const Means& means) {
  const bool stops = !step.occasion.plan.empty() && wanted(step) != State::Operational;
  if (!stops || !answers(step, means.craft)) return {};
  return {step.subject};
}
}  // namespace state_step

/// Its subject to a state: the value.
inline constexpr StepKind set_state{
    .name = "set_state",
    .values = 1,
    .text = [](const ProcedureStep& step,
               const descriptor::Mission&) { return std::string{to_text(state_step::wanted(step))}; },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          const State state = state_step::wanted(step);
          // Again: an earlier step of the same plan may have let it go since.
          for (const std::uint16_t apid : state_step::fenced(step, means)) means.craft.guard.fence(apid);
          if (!step.occasion.plan.empty()) means.commanded.lower(step.subject, state, step.occasion.event);
          if (!step.occasion.event.empty())
            means.craft.tell("plan " + step.occasion.plan + ": " + means.craft.name_of(step.subject) + " to " +
                                 std::string{to_text(state)} + " because of " + step.occasion.event,
                             step.subject);
          const auto free_at = state == State::Operational ? step.free_at : std::nullopt;
          means.desk.command(step.subject, "SET_STATE", static_cast<double>(state), std::move(done), free_at);
        },
    .fences = state_step::fenced,
    .answers = state_step::answers,
    .safety =
        [](const ProcedureStep& step) {
          return state_step::wanted(step) == State::Operational ? Safety::None : Safety::Stop;
        },
};

}  // namespace hirosco::supervisor::steps
