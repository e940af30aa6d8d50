// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "supervisor/supervision/procedures/step.hpp"

namespace hirosco::supervisor::steps {

namespace network {
void shut_down(const ProcedureStep& step, const Means& means, const CommandDone& done);
/// Their actuators come first, by shared memory: no packet, no queue and no disk is in that way. The ground link may carry sets of the
/// network; it has no actuators, and ground must hear what goes on.
[[nodiscard]] std::vector<std::uint16_t> members(const ProcedureStep& step, const Means& means);
}  // namespace network

/// All that is joined to its subject by real-time links, to Error-Operational and then Offline. It has begun when it is done.
inline constexpr StepKind shut_down_network{
    .name = "shut_down_network",
    .run = [](const ProcedureStep& step, const Means& means,
              CommandDone done) { network::shut_down(step, means, done); },
    .fences = network::members,
    .safety = [](const ProcedureStep&) { return Safety::Network; },
    .holds = StepKind::Holds::Nobody,  // it marks each of the network itself
};

}  // namespace hirosco::supervisor::steps
