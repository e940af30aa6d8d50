// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"

/// Which plan answers an event (paper 4.3 and 5): the most specific of the mission, else the paper's default.
namespace hirosco::supervisor {

struct RaisedEvent {
  std::string_view subsystem;
  std::string_view event;            ///< name, or the number as text when the descriptor does not know it
  descriptor::Severity severity{};
  std::string_view mode;
  std::string_view teller{};         ///< who told of it where that is not the subsystem: a plan may name either
  enum class Origin : std::uint8_t { Subsystem, Supervisor } origin{Origin::Subsystem};
};

/// An event of a subsystem as its plan is chosen. What the supervisor tells of it is as severe as our descriptor calls it; what either of the two
/// may tell, as the more severe one does, whoever told it.
[[nodiscard]] RaisedEvent raised_of(const descriptor::Mission& mission,
                                    const descriptor::SubsystemDescriptor& subsystem, std::string_view event,
                                    descriptor::Severity severity, std::string_view mode);

struct Reaction {
  std::string_view plan;  ///< name, "default" when no plan of the mission matched
  std::vector<descriptor::PlanStep> steps;
  std::uint16_t number{0};  ///< of the plan in the mission, from 1; 0 = the default
  std::uint8_t priority{descriptor::default_plan_priority};
};

/// Events of the supervisor itself are answered only by plans that name it or the event: no actuator of
/// its is in danger, and a plan for "everything of medium severity" means the subsystems.
/// Criteria count in the order event, subsystem, mode, severity; of equally specific plans the first wins.
[[nodiscard]] Reaction choose_reaction(const descriptor::Mission& mission, const RaisedEvent& event);

}  // namespace hirosco::supervisor
