// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Until somebody measures what electrical power there is (docs/adr/0124), for so many milliseconds at most. It never fails: what is granted
/// without a measurement may suffice, and if not, the refusal says so.
inline constexpr StepKind await_power{
    .name = "await_power",
    .values = 1,
    .text = [](const ProcedureStep&,
               const descriptor::Mission&) { return std::string{"until somebody measures its power"}; },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          Craft& craft = means.craft;
          const auto known = [&craft] { return !craft.power_known || craft.power_known(); };
          const auto go_on = [done = std::move(done)](bool, const std::string&) { done(true, {}); };
          means.waiting.wait(craft.now, craft.now + std::chrono::milliseconds{step.values[0]}, known, go_on);
        },
};

}  // namespace hirosco::supervisor::steps
