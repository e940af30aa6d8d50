// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/commissioning.hpp"

namespace hirosco::supervisor {

using descriptor::State;

namespace {

[[nodiscard]] Sequence::Command to_state(const descriptor::Subsystem& subsystem, State state) {
  return {subsystem.id, subsystem.name, "SET_STATE", static_cast<double>(state), std::string{to_text(state)}};
}

[[nodiscard]] Sequence::Command to_configuration(const descriptor::Subsystem& subsystem,
                                                 const descriptor::Configuration& configuration, std::string text) {
  return {subsystem.id, subsystem.name, "CONFIGURE", configuration.id, std::move(text)};
}

}  // namespace

void Commissioning::start(std::function<void()> failed) {
  // Itself first: the functions of the others' commissioning are its own.
  const descriptor::Subsystem& own = craft_.mission.supervisor;
  sequence_.start({{to_state(own, State::PreOperational)},
                   {to_configuration(own, own.configurations.front(), "configuration")},
                   {to_state(own, State::SafeOperational)},
                   {to_state(own, State::Operational)}},
                  Sequence::OnFailure::Stop, [this, failed = std::move(failed)](bool success, const std::string& why) {
                    if (!success) {
                      craft_.tell("supervisor cannot start: " + why, supervisor_apid);
                      craft_.failed = true;
                      return failed();
                    }
                    if (const auto* start_mode = craft_.mission.find_mode(craft_.mission.start_mode))
                      return commission(*start_mode);
                    succeeded_ = true;
                  });
}

void Commissioning::commission(const descriptor::Mode& start_mode) {
  const descriptor::Subsystem& own = craft_.mission.supervisor;
  Sequence::Stage pre, configure, link, safe, operational;
  for (const auto& step : start_mode.commission) {
    const auto& subsystem = craft_.mission.find_subsystem(step.subsystem)->subsystem;
    const auto& configuration = *subsystem.find_configuration(step.configuration);
    pre.push_back(to_state(subsystem, State::PreOperational));
    configure.push_back(to_configuration(subsystem, configuration, "configuration " + configuration.name));
    if (step.state == State::PreOperational) continue;
    safe.push_back(to_state(subsystem, State::SafeOperational));
    if (step.state == State::Operational) operational.push_back(to_state(subsystem, State::Operational));
  }
  for (const std::uint8_t id : start_mode.establish)
    link.push_back({own.id, own.name, "LINK", id, "link " + std::to_string(id)});
  Sequence::Stage mode{{own.id, own.name, "SET_MODE", start_mode.id, "mode " + start_mode.name}};
  sequence_.start({pre, configure, link, safe, operational, mode}, Sequence::OnFailure::Stop,
                  [this, &start_mode](bool, const std::string& why) { ended(start_mode, why); });
}

void Commissioning::ended(const descriptor::Mode& start_mode, const std::string& failure) {
  std::string missing = failure;
  // A plan may have taken one down after its own step was done (findings LW2).
  for (const auto& step : start_mode.commission) {
    const Member* subject = craft_.member(craft_.mission.find_subsystem(step.subsystem)->subsystem.id);
    if (missing.empty() && (subject == nullptr || subject->state() != step.state))
      missing = step.subsystem + " is not " + std::string{to_text(step.state)};
  }
  succeeded_ = missing.empty();
  if (succeeded_) return craft_.tell("commissioned: mode " + craft_.mode->name);
  craft_.tell("commissioning stopped: " + missing);
  craft_.failed = true;
}

bool Commissioning::cancel(std::string_view why) {
  if (craft_.shutting_down || !sequence_.running()) return false;
  sequence_.cancel();
  craft_.tell("commissioning stopped: " + std::string{why}, supervisor_apid);
  return true;
}

}  // namespace hirosco::supervisor
