// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "supervisor/supervision/event_handling/plan_choice.hpp"

/// What the plans of a mission would do, without a flight: the choice is that of `plan_choice.hpp`.
namespace hirosco::supervisor {

struct PlannedReaction {
  std::string subsystem;
  std::string event;
  descriptor::Severity severity{};  ///< as declared
  std::vector<std::string> modes;  ///< in which it is so, in the order of the mission
  std::string plan;
  std::string steps;  ///< "restart limit=3 within_s=60 pause_ms=100 to=Offline, shut_down_network"
};

/// Every event of the supervisor, then of each subsystem, what the supervisor tells of it among them, each with every reaction that it has.
[[nodiscard]] std::vector<PlannedReaction> planned_reactions(const descriptor::Mission& mission);

}  // namespace hirosco::supervisor
