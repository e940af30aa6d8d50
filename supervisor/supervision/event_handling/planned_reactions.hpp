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
  std::uint8_t priority{};
  std::string steps;  ///< "restart limit=3 within_s=60 pause_ms=100 to=Offline, shut_down_network"
};

/// Every event of the supervisor, then of each subsystem, what the supervisor tells of it among them, each with every reaction that it has.
[[nodiscard]] std::vector<PlannedReaction> planned_reactions(const descriptor::Mission& mission);

/// Of a plan that takes time for a subsystem: which others end it there, in whatever mode.
struct PlannedPreemption {
  std::string subsystem;
  std::string plan;  ///< with the severity of the event that it answers: "to-safe (medium)"
  std::vector<std::string> by;  ///< as above, in the order of their events
};

/// Which plan gives way to which, by the rule of `plan_rank.hpp`, as long as its first step runs.
[[nodiscard]] std::vector<PlannedPreemption> planned_preemptions(const descriptor::Mission& mission);

}  // namespace hirosco::supervisor
