// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Its subject into a configuration: the value is its id.
inline constexpr StepKind configure{
    .name = "configure",
    .values = 1,
    .text =
        [](const ProcedureStep& step, const descriptor::Mission& mission) {
          const auto id = static_cast<std::uint8_t>(step.values[0]);
          const auto* member = mission.find_member(step.subject);
          const auto* one = member != nullptr ? member->find_configuration(id) : nullptr;
          return "configuration " + (one != nullptr ? one->name : std::to_string(id));
        },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          means.desk.command(step.subject, "CONFIGURE", static_cast<double>(step.values[0]), std::move(done));
        },
};

}  // namespace hirosco::supervisor::steps
