// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/own_flow_access.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/utilities/os/process.hpp"

/// What the process of a subsystem may take and reach, as its descriptor says (docs/adr/0080, 0081).
namespace hirosco::supervisor {

/// What the system itself refuses beyond. Memory is not limited where a sanitizer needs more than there is.
[[nodiscard]] ProcessLimits limits_of(const descriptor::Resources& resources) noexcept;

/// Its program, descriptors, libraries, files of its settings and what those bring along to read, what the rows of its devices' means of transfer
/// (flow_access.hpp) and of its links ask for, the ground link's sockets, and nothing else: where the supervisor's side holds an endnode it lets
/// nobody in (docs/adr/0150, 0175). In a flight of this instance, which is part of where named flows are; as that user. Opens no file.
[[nodiscard]] Sandbox sandbox_of(const descriptor::MissionSubsystem& subsystem, const std::filesystem::path& program,
                                 const std::string& instance, ProcessUser user = ProcessUser::WhoeverFlies);

/// The same sandbox, with the places of its flows made, as what is not there is let in by no rule (docs/adr/0169). Where one cannot be
/// it is let in elsewhere only: it is told why when it opens that device. Those of a user of its own are made by make_own_places().
[[nodiscard]] Sandbox make_sandbox(const descriptor::MissionSubsystem& subsystem, const std::filesystem::path& program,
                                   const std::string& instance);

/// What it reaches beyond what is its own, because the system knows no narrower rule, in words; empty: nothing.
[[nodiscard]] std::string left_open(const Sandbox& sandbox);

/// What of `wants` is not let through by `had`, in words; empty: nothing.
[[nodiscard]] std::string shut_out(const Sandbox& had, const Sandbox& wants);

}  // namespace hirosco::supervisor
