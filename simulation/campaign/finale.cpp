// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "simulation/campaign/planned_flight.hpp"
#include "supervisor/guard/guarded_member.hpp"

/// The same end for every flight: the faults stop, SAFE_ALL stops the craft, and two seconds later all that lives, and does not hang, can be
/// brought up by ground's telecommands and stays up (I10; hazard SF14).
namespace hirosco::campaign {

using descriptor::State;

std::uint32_t PlannedFlight::state(std::string_view name) const {
  const VitalPage* page = craft_->vital(name);
  return page != nullptr ? page->state.load() : 0;
}

void PlannedFlight::end_faults() {
  for (const auto& device : mission_.devices) {
    if (auto* simulated = craft_->device(device.name)) {
      static_cast<void>(simulated->fault("heal"));
      static_cast<void>(simulated->fault("plug"));
      // The hand moves as at the beginning: one that stirs the robot against the rail trips limits, and rightly so.
      for (const auto& [name, value, at] : device.settings) static_cast<void>(simulated->fault(name + " " + value));
    }
  }
  for (const auto& member : mission_.subsystems) {
    craft_->stop(member.subsystem.name, false);
    craft_->stick(member.subsystem.name, false);
    craft_->strain(member.subsystem.name, 0, {});
    craft_->call_spin_off(member.subsystem.name);
  }
  if (supervisor_stopped_) craft_->stop(mission_.supervisor.name, false);
  supervisor_stopped_ = false;
  disk_.fault = DiskFault::None;
  disk_.delay = {};
  trace_->say("calm");
}

/// Nobody moves a handle while the craft is brought up: where a hand had held it away the robot may stand at the end of the rail, and whoever
/// wanders on from there trips limits, and rightly so.
void PlannedFlight::rest_hands() {
  for (const auto& device : mission_.devices)
    if (auto* simulated = craft_->device(device.name)) static_cast<void>(simulated->fault("hand hold 0 0"));
}

/// Who stands in the middle of a cycle is ended by the guard and started again; until then nobody can bring it up, and its
/// operator is told that it hangs. That takes as long as its descriptor grants a cycle whose real-time priority was taken.
void PlannedFlight::see_hangs_ended() {
  constexpr Duration end_takes = 1500ms;  // killed a second after it was fenced, and started again
  for (const auto& member : mission_.subsystems) {
    const std::string& name = member.subsystem.name;
    const auto stands_at = [&]() -> std::optional<std::uint64_t> {
      const VitalPage* page = craft_->vital(name);
      if (page == nullptr || !craft_->alive(name) || page->cycling.load() == 0) return std::nullopt;
      return page->cycles.load();
    };
    const auto before = stands_at();
    const Duration limit = member.subsystem.hang.reduced * supervisor::guard_observation_period + end_takes;
    if (!before) continue;
    run_until([&] { return stands_at() != before; }, limit);
    if (!stands_at()) run_until(craft_->now() - start_of_flight + end_takes);
  }
}

/// Sends a function with all acknowledgements and waits for its end.
bool PlannedFlight::call(std::string_view subsystem, std::string_view name, std::optional<double> argument) {
  const auto* target = mission_.find_member(subsystem);
  if (target == nullptr) return false;
  const auto common = pus::common_functions();
  const auto built_in = std::ranges::find(common, name, &descriptor::Function::name);
  const auto* function = built_in != common.end() ? &*built_in : target->find_function(name);
  if (function == nullptr) return false;
  std::vector<double> values;
  if (argument) values.push_back(*argument);
  const auto data = pus::encode_call(*function, std::span<const double>{values});
  if (!data || !send("ground", {.apid = target->id, .service = 8, .subtype = 1, .ack = 15}, *data)) return false;
  const std::uint32_t request = last_request_;
  constexpr Duration patience = 2s;
  run_until([&] { return verdicts_[request].over; }, patience);
  trace_->say("called {} {} {} {}", target->name, name, argument.value_or(0),
              verdicts_[request].completed ? "completed" : "failed");
  return verdicts_[request].completed;
}

void PlannedFlight::finale() {
  if (craft_->supervisor().finished()) return;
  end_faults();
  run_until(craft_->now() - start_of_flight + 100ms);
  // A store that has failed takes nothing more; a new one does.
  static_cast<void>(call(mission_.supervisor.name, "SET_DATABASE", 1));
  static_cast<void>(call(mission_.supervisor.name, "SAFE_ALL", {}));
  rest_hands();
  run_until(plan_.finale + 2s);
  trace_->say("recovered");
  for (const auto& member : mission_.subsystems)
    if (craft_->alive(member.subsystem.name))
      send("ground", {.apid = member.subsystem.id, .service = 17, .subtype = 1, .ack = 15}, {});
  run_until(craft_->now() - start_of_flight + 200ms);
  see_hangs_ended();
  bring_up();
  static_cast<void>(call(mission_.supervisor.name, "SAFE_ALL", {}));
  run_until(craft_->now() - start_of_flight + 500ms);
  static_cast<void>(call(mission_.supervisor.name, "SHUTDOWN", {}));
  constexpr Duration longest_shutdown = 6s;
  run_until(craft_->now() - start_of_flight + longest_shutdown);
}

/// The mode that couples most, or what is left of it.
void PlannedFlight::bring_up() {
  const auto* mode = mission_.find_mode("telepresence");
  const auto* alone = mission_.find_mode("standalone");
  const auto* commissioning = mission_.find_mode(mission_.initial_mode);
  if (mode == nullptr || alone == nullptr || commissioning == nullptr) return;
  const auto lives = [&](const auto& step) { return craft_->alive(step.subsystem); };
  if (!std::ranges::all_of(mode->commission, lives)) mode = alone;
  static_cast<void>(call(mission_.supervisor.name, "SET_MODE", commissioning->id));
  // An operator who brings the craft up gives it the power for that again.
  if (mission_.power_budget_w)
    static_cast<void>(call(mission_.supervisor.name, "SET_POWER_BUDGET", mission_.power_budget_w));
  std::vector<const descriptor::CommissionStep*> steps;
  for (const auto& step : mode->commission)
    if (lives(step) && step.subsystem != mission_.ground.subsystem) steps.push_back(&step);
  const auto each = [&](std::string_view function, const auto& argument) {
    for (const auto* step : steps) static_cast<void>(call(step->subsystem, function, argument(*step)));
  };
  const auto to = [](State target) { return [target](const auto&) { return static_cast<double>(target); }; };
  const auto configuration = [&](const descriptor::CommissionStep& step) {
    const auto& subsystem = mission_.find_subsystem(step.subsystem)->subsystem;
    return static_cast<double>(subsystem.find_configuration(step.configuration)->id);
  };
  for (const auto* step : steps) {
    if (state(step->subsystem) != static_cast<std::uint32_t>(State::Offline))
      static_cast<void>(call(step->subsystem, "SET_STATE", static_cast<double>(State::Offline)));
  }
  each("SET_STATE", to(State::PreOperational));
  each("CONFIGURE", configuration);
  for (const std::uint8_t link : mode->establish) static_cast<void>(call(mission_.supervisor.name, "LINK", link));
  each("SET_STATE", to(State::SafeOperational));
  each("SET_STATE", to(State::Operational));
  for (const auto* step : steps) trace_->say("up {}", step->subsystem);
  run_until(craft_->now() - start_of_flight + 500ms);
  trace_->say("flown");
}

}  // namespace hirosco::campaign
