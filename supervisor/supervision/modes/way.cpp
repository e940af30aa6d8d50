// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/way.hpp"

#include "supervisor/supervision/procedures/step_kinds.hpp"

namespace hirosco::supervisor {

using descriptor::State;

void Way::add(const descriptor::Subsystem& subsystem, const descriptor::Configuration& configuration,
              std::optional<State> from, State to) {
  if (from == State::ErrorOperational) down_.push_back(to_state(subsystem.id, State::PostOperational));
  if (from != State::PreOperational) pre_.push_back(to_state(subsystem.id, State::PreOperational));
  configure_.push_back(step("configure", subsystem.id, {configuration.id}));
  if (to >= State::SafeOperational) safe_.push_back(to_state(subsystem.id, State::SafeOperational));
  if (to >= State::Operational && configuration.self_test == descriptor::SelfTest::Required)
    self_test_.push_back(step("self_test", subsystem.id, {configuration.id}));
  if (to >= State::Operational) operational_.push_back(to_state(subsystem.id, State::Operational));
}

void Way::link(std::uint8_t id) { link_.push_back(step("link", supervisor_apid, {id})); }

void Way::enter(const descriptor::Mode& mode) { mode_.push_back(step("set_mode", supervisor_apid, {mode.id})); }

}  // namespace hirosco::supervisor
