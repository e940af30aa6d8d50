// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace waiting {
[[nodiscard]] inline std::uint16_t whose(const ProcedureStep& step) {
  return step.values[descriptor::wait_for_of] != 0 ? static_cast<std::uint16_t>(step.values[descriptor::wait_for_of])
                                                   : step.subject;
}
}  // namespace waiting

/// Until somebody is in a state: the state, whose (0 = its subject's), and for how many milliseconds at most.
inline constexpr StepKind wait_for{
    .name = "wait_for",
    .values = 3,
    .text =
        [](const ProcedureStep& step, const descriptor::Mission& mission) {
          const auto* member = mission.find_subsystem(waiting::whose(step));
          return "until " + (member != nullptr ? member->subsystem.name : std::string{}) + " is " +
                 std::string{to_text(static_cast<State>(step.values[descriptor::wait_for_state]))};
        },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          const auto wanted = static_cast<State>(step.values[descriptor::wait_for_state]);
          Craft& craft = means.craft;
          const auto holds = [&craft, wanted, apid = waiting::whose(step)] {
            const Member* member = craft.member(apid);
            return member != nullptr && member->state() == wanted;
          };
          means.waiting.wait(craft.now,
                             craft.now + std::chrono::milliseconds{step.values[descriptor::wait_for_within_ms]}, holds,
                             std::move(done));
        },
};

}  // namespace hirosco::supervisor::steps
