// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/ranges.h>

#include <chrono>
#include <string>
#include <utility>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace calling {
/// What a mission says where it says nothing, and the least that it may say: what is waited for any answer.
inline constexpr std::chrono::seconds least{
    descriptor::find_plan_step("command")->attributes[descriptor::command_done_within_s].least};
static_assert(least == CommandDesk::answer_limit &&
                  descriptor::find_plan_step("command")->attributes[descriptor::command_done_within_s].otherwise ==
                      least.count(),
              "what may be said is what the desk does");
[[nodiscard]] inline std::chrono::seconds done_within(const ProcedureStep& step) {
  return std::chrono::seconds{step.values[descriptor::command_done_within_s]};
}
}  // namespace calling

/// A function of its subject is called: its place in the descriptor, how many numbers it is given, and within how many
/// seconds it is to be completed (docs/adr/0206).
inline constexpr StepKind command{
    .name = "command",
    .values = 3,
    .text =
        [](const ProcedureStep& step, const descriptor::Mission&) {
          std::string text = step.words.front();
          if (!step.arguments.empty()) text += fmt::format(" {}", fmt::join(step.arguments, " "));
          if (calling::done_within(step) != calling::least)
            text += fmt::format(" within {} s", calling::done_within(step).count());
          return text;
        },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          const auto* member = means.craft.mission.find_subsystem(step.subject);
          const auto* function = member != nullptr ? member->subsystem.find_function(step.words.front()) : nullptr;
          if (function == nullptr) return done(false, "it has no such function");
          const auto data = pus::encode_call(*function, std::span<const double>{step.arguments});
          if (!data) return done(false, data.error().text);
          if (!step.occasion.event.empty())
            means.craft.tell("plan " + step.occasion.plan + ": " + means.craft.name_of(step.subject) + " " +
                                 text_of(step, means.craft.mission) + " because of " + step.occasion.event,
                             step.subject);
          means.desk.send(step.subject, pus::FunctionService::service_type, 1, *data, {}, std::move(done),
                          calling::done_within(step) - calling::least);
        },
};

}  // namespace hirosco::supervisor::steps
