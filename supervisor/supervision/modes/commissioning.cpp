// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/commissioning.hpp"

#include <utility>

#include "supervisor/supervision/modes/mode_plan.hpp"
#include "supervisor/supervision/procedures/steps/way_there.hpp"

namespace hirosco::supervisor {

void Commissioning::start(std::function<void()> failed) {
  begins_ = true;
  // Itself first: the functions of the others' commissioning are its own. A stop in these moments ends the others' only: nobody could
  // command a supervisor that is not there.
  start_itself([this, failed = std::move(failed)](bool success) {
    const bool goes_on = std::exchange(begins_, false);
    if (!success) return failed();
    if (!goes_on) return;
    if (const auto* start_mode = craft_.mission.find_mode(craft_.mission.start_mode)) return commission(*start_mode);
    succeeded_ = true;
  });
}

void Commissioning::start_itself(std::function<void(bool)> done) {
  const descriptor::SubsystemDescriptor& own = craft_.mission.supervisor;
  WayThere way;
  way.add(own, own.configurations.front(), {State::Offline}, State::Operational);
  way.recall(own.id, State::Operational);  // where it goes on for another one
  itself_.start({.stages = way.stages(), .finished = [this, done = std::move(done)](const ProcedureEnd& end) {
                   if (!end.success) craft_.tell("supervisor cannot start: " + end.text(), supervisor_apid);
                   if (!end.success) craft_.fail();
                   done(end.success);
                 }});
}

void Commissioning::commission(const descriptor::Mode& start_mode) {
  WayThere way;
  for (const auto& step : start_mode.commission) {
    const auto& subsystem = craft_.mission.find_subsystem(step.subsystem)->subsystem;
    way.add(subsystem, *subsystem.find_configuration(step.configuration), {State::Offline}, step.state);
  }
  for (const std::uint8_t id : start_mode.establish) way.link(id);
  // Whoever measures reports from Pre-Operational on; what is granted without that may not suffice.
  if (const auto& measured = craft_.mission.power_measured) way.await_power(measured->age);
  way.enter(start_mode);
  runner_.start({.stages = way.stages(),
                 .finished = [this, &start_mode](const ProcedureEnd& end) { ended(start_mode, end.text()); },
                 .knows_of_no_stop = true});
}

void Commissioning::ended(const descriptor::Mode& start_mode, const std::string& failure) {
  // A plan may have taken one down after its own step was done, or a link may have been lost.
  const std::string missing = failure.empty() ? missing_from(craft_, links_, start_mode) : failure;
  succeeded_ = missing.empty();
  if (succeeded_) return craft_.tell("commissioned: mode " + craft_.mode->name);
  craft_.tell("commissioning stopped: " + missing);
  craft_.fail();
}

void Commissioning::drop() {
  if (std::exchange(begins_, false)) itself_.cancel();
  runner_.cancel();
}

Cancelled Commissioning::cancel(std::string_view why) {
  if (craft_.shutting_down || !running()) return Cancelled::Nothing;
  begins_ = false;
  runner_.cancel();
  craft_.tell("commissioning stopped: " + std::string{why}, supervisor_apid);
  return Cancelled::ForGood;
}

}  // namespace hirosco::supervisor
