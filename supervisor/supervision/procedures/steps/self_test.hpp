// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "hirosco/pus/st17_test/test_service.hpp"
#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

/// Its subject's self test, in Safe-Operational: the value is the id of its configuration, which says how long that may take.
inline constexpr StepKind self_test{
    .name = "self_test",
    .values = 1,
    .text = [](const ProcedureStep&, const descriptor::Mission&) { return std::string{"self test"}; },
    .run =
        [](const ProcedureStep& step, const Means& means, CommandDone done) {
          using pus::TestService;
          const auto* member = means.craft.mission.find_subsystem(step.subject);
          const auto& subsystem = member != nullptr ? member->subsystem : means.craft.mission.supervisor;
          const auto* configuration = subsystem.find_configuration(static_cast<std::uint8_t>(step.values[0]));
          means.desk.send(step.subject, TestService::service_type, TestService::run_self_test, {}, {}, std::move(done),
                          configuration != nullptr ? configuration->self_test_within : Duration{0});
        },
};

}  // namespace hirosco::supervisor::steps
