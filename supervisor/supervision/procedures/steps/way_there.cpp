// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/way_there.hpp"

#include "supervisor/supervision/procedures/steps/step_kinds.hpp"

namespace hirosco::supervisor {

using descriptor::State;

void WayThere::add(const descriptor::SubsystemDescriptor& subsystem, const descriptor::Configuration& configuration,
                   const Present& from, State to) {
  // What a configuration holds, links and devices, is given back in Post-Operational: also from Pre-Operational it leads there.
  const bool holds = from.state == State::PreOperational && from.configuration != 0;
  if (from.state == State::Operational) stop_.push_back(to_state(subsystem.id, State::SafeOperational));
  if (from.state == State::ErrorOperational || holds) post_.push_back(to_state(subsystem.id, State::PostOperational));
  if (from.state != State::PreOperational || holds) pre_.push_back(to_state(subsystem.id, State::PreOperational));
  configure_.push_back(step("configure", subsystem.id, {configuration.id}));
  if (to >= State::SafeOperational) safe_.push_back(to_state(subsystem.id, State::SafeOperational));
  if (to >= State::Operational && configuration.self_test == descriptor::SelfTest::Required)
    self_test_.push_back(step("self_test", subsystem.id, {configuration.id}));
  if (to >= State::Operational) operational_.push_back(to_state(subsystem.id, State::Operational));
}

void WayThere::initialise(const descriptor::SubsystemDescriptor& subsystem, const Present& from) {
  if (from.state == State::Operational) stop_.push_back(to_state(subsystem.id, State::SafeOperational));
  if (from.state != State::PreOperational) pre_.push_back(to_state(subsystem.id, State::PreOperational));
}

void WayThere::recall(std::uint16_t apid, State to) {
  recall_.push_back(step("recall", apid, {static_cast<std::int64_t>(State::PreOperational)}));
  if (to >= State::SafeOperational)
    recall_safe_.push_back(step("recall", apid, {static_cast<std::int64_t>(State::SafeOperational)}));
}

void WayThere::down(const descriptor::SubsystemDescriptor& subsystem, const Present& from) {
  if (from.state == State::Operational) stop_.push_back(to_state(subsystem.id, State::SafeOperational));
  pre_.push_back(to_state(subsystem.id, State::Offline));
}

void WayThere::link(std::uint8_t id) { link_.push_back(step("link", supervisor_apid, {id})); }

void WayThere::await_power(Duration at_most) {
  await_power_.push_back(step("await_power", supervisor_apid, {at_most / std::chrono::milliseconds{1}}));
}

void WayThere::enter(const descriptor::Mode& mode) { mode_.push_back(step("enter_mode", supervisor_apid, {mode.id})); }

}  // namespace hirosco::supervisor
