// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/os/sandbox.hpp"

/// By what a member of a mission reaches others: its sandbox is made of it, and the reader asks of it who reaches a second inhibit, so that both say
/// the same (docs/adr/0175). What each way needs, its own row says.
namespace hirosco::descriptor {

/// To its devices, in whichever configuration and as whichever fall-back.
[[nodiscard]] std::vector<FlowAddress> flows_of(const SubsystemDescriptor& subsystem);

/// Adds what links of the mission, and the ground link, need of its sandbox.
void let_in_links(const MissionSubsystem& member, Sandbox& sandbox);

}  // namespace hirosco::descriptor
