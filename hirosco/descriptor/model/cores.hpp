// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// Which cores of the computer the cycles of a mission go on, and what they take of each (docs/adr/0234).
namespace hirosco::descriptor {

/// On which its cycle and its loops of services with a priority go; empty: the shared one, where it is not known which that is.
[[nodiscard]] std::optional<std::uint16_t> core_of(const Mission& mission, const MissionSubsystem& member) noexcept;
/// "core 3", or the core of all who name none.
[[nodiscard]] std::string core_words(std::optional<std::uint16_t> core);

/// That are each one member's alone, in their order.
[[nodiscard]] std::vector<std::uint16_t> lone_cores(const Mission& mission);
/// Somebody is to be elsewhere than where all are that say nothing.
[[nodiscard]] bool names_cores(const Mission& mission) noexcept;

/// What the declared budgets take of a core, of 1.
struct CoreShare {
  std::optional<std::uint16_t> core;
  double share{0};
};
/// Of each core that cycles of a mode, or loops of services, go on; the shared one first.
[[nodiscard]] std::vector<CoreShare> core_shares(const Mission& mission, const Mode& mode);
/// Of each the greatest of all modes.
[[nodiscard]] std::vector<CoreShare> core_shares(const Mission& mission);

}  // namespace hirosco::descriptor
