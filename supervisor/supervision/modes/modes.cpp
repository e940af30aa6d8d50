// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/modes.hpp"

#include <algorithm>

namespace hirosco::supervisor {

void Modes::provide() {
  own_.on_function("SET_MODE", [this](double id) -> Outcome {
    const auto& modes = craft_.mission.modes;
    const auto found = std::ranges::find(modes, static_cast<std::uint8_t>(id), &descriptor::Mode::id);
    if (found == modes.end()) return refused(pus::FailureCode::UnknownIdentifier);
    // A mode whose members are dead is not that mode, whatever it is called (hazard SF15).
    if (!std::ranges::all_of(found->commission, [&](const auto& step) { return lives(step); }))
      return refused(pus::FailureCode::WrongStatus);
    enter(*found);
    return ok();
  });
}

bool Modes::lives(const descriptor::CommissionStep& step) const {
  return std::ranges::any_of(craft_.members, [&](const Member& subject) {
    return subject.descriptor().name == step.subsystem && subject.alive();
  });
}

void Modes::enter(const descriptor::Mode& mode) {
  craft_.mode = &mode;
  ++craft_.mode_epoch;
  own_.enter_mode(craft_.mode_epoch);
  for (Member& member : craft_.members) member.enter_mode(craft_.mode_epoch);
  craft_.tell("mode " + mode.name, supervisor_apid);
}

}  // namespace hirosco::supervisor
