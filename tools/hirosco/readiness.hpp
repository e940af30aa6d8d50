// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::tools {

/// Where a mission is to fly.
enum class FlownAs : std::uint8_t {
  Processes,   ///< programs beside this one or in PATH
  Threads,     ///< subsystems as modules, devices as programs
  Simulation,  ///< modules beside this program or in PATH, in this process
};

/// What a mission names and is not here (E0401, E0404), and the settings that a simulated device refuses (E0402). The devices
/// that this program has are asked themselves, so that no descriptor library knows what a device is.
[[nodiscard]] std::vector<descriptor::Diagnostic> unready(const descriptor::Mission& mission, FlownAs flown_as);

/// What of robots' files that simulated devices are given is likely to be a wrong unit (U0509): warnings. What else their reader warns of was said
/// when the folder was made.
[[nodiscard]] std::vector<descriptor::Diagnostic> unlikely(const descriptor::Mission& mission);

/// Modules that are here and that `hirosco simulate` would not take (E0404): built against another version, damaged, or without what they are
/// linked with. A program without a module flies all the same.
[[nodiscard]] std::vector<descriptor::Diagnostic> unloadable(const descriptor::Mission& mission);

/// What the Software-Init of each subsystem that has a module here will find of its author's mistakes (E0406), ports of all its
/// configurations and the settings that nobody reads (E0405) among them. A flight finds the same, later.
[[nodiscard]] std::vector<descriptor::Diagnostic> unintroduced(const descriptor::Mission& mission);

/// Whose program here is a script that flies in no sandbox (E0411, docs/adr/0210): warnings, and errors where the mission wants each in one.
[[nodiscard]] std::vector<descriptor::Diagnostic> unisolated(const descriptor::Mission& mission);

/// Prints what keeps the mission from flying to standard error; true when nothing does.
[[nodiscard]] bool ready(const descriptor::Mission& mission, FlownAs flown_as);

}  // namespace hirosco::tools
