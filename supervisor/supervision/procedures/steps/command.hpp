// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/ranges.h>

#include <string>
#include <utility>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// A function of its subject is called: its place in the descriptor, and how many numbers it is given.
inline constexpr StepKind command{
    .name = "command",
    .values = 2,
    .text =
        [](const ProcedureStep& step, const descriptor::Mission&) {
          return step.arguments.empty() ? step.words.front()
                                        : fmt::format("{} {}", step.words.front(), fmt::join(step.arguments, " "));
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
          means.desk.send(step.subject, pus::FunctionService::service_type, 1, *data, {}, std::move(done), Duration{0});
        },
};

}  // namespace hirosco::supervisor::steps
