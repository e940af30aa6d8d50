// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/finale.hpp"

#include <algorithm>

#include "hirosco/pus/st08_function/function_service.hpp"
#include "supervisor/guard/guarded_member.hpp"

namespace hirosco::campaign {

using descriptor::State;

void Finale::fly(Duration begin) {
  if (parts_.craft.finished()) return;
  parts_.actions.end_faults();
  parts_.time.run(100ms);
  // A store that has failed takes nothing more; a new one does.
  static_cast<void>(call(parts_.mission.supervisor.name, "SET_DATABASE", 1));
  static_cast<void>(call(parts_.mission.supervisor.name, "SAFE_ALL", {}));
  parts_.actions.rest_hands();
  parts_.time.run_until(begin + 2s);
  parts_.trace.say("recovered");
  for (const auto& member : parts_.mission.subsystems)
    if (parts_.craft.alive(member.subsystem.name))
      parts_.traffic.send(FlightTraffic::ground, {.apid = member.subsystem.id, .service = 17, .subtype = 1, .ack = 15},
                          {});
  parts_.time.run(200ms);
  see_hangs_ended();
  bring_up();
  static_cast<void>(call(parts_.mission.supervisor.name, "SAFE_ALL", {}));
  parts_.time.run(500ms);
  static_cast<void>(call(parts_.mission.supervisor.name, "SHUTDOWN", {}));
  constexpr Duration longest_shutdown = 6s;
  parts_.time.run(longest_shutdown);
}

/// Who stands in the middle of a cycle is ended by the guard and started again; until then nobody can bring it up, and its
/// operator is told that it hangs. That takes as long as its descriptor grants a cycle whose real-time priority was taken.
void Finale::see_hangs_ended() {
  constexpr Duration end_takes = 1500ms;  // killed a second after it was fenced, and started again
  for (const auto& member : parts_.mission.subsystems) {
    const std::string& name = member.subsystem.name;
    const auto stands_at = [&]() -> std::optional<std::uint64_t> {
      const VitalPage* page = parts_.craft.vital(name);
      if (page == nullptr || !parts_.craft.alive(name) || page->cycling.load() == 0) return std::nullopt;
      return page->cycles.load();
    };
    const auto before = stands_at();
    const Duration limit = member.subsystem.hang.reduced * supervisor::guard_observation_period + end_takes;
    if (!before) continue;
    parts_.time.run_until([&] { return stands_at() != before; }, limit);
    if (!stands_at()) parts_.time.run(end_takes);
  }
}

/// The first of its modes that has all of its members, or what is left of the last.
void Finale::bring_up() {
  const auto* commissioning = parts_.mission.find_mode(parts_.mission.initial_mode);
  const auto lives = [&](const auto& step) { return parts_.craft.alive(step.subsystem); };
  const descriptor::Mode* mode = nullptr;
  for (const std::string& name : parts_.ends) {
    mode = parts_.mission.find_mode(name);
    if (std::ranges::all_of(mode->commission, lives)) break;
  }
  static_cast<void>(call(parts_.mission.supervisor.name, "SET_MODE", commissioning->id));
  // An operator who brings the craft up gives it the power for that again.
  if (parts_.mission.power_budget_w)
    static_cast<void>(call(parts_.mission.supervisor.name, "SET_POWER_BUDGET", parts_.mission.power_budget_w));
  std::vector<const descriptor::CommissionStep*> steps;
  for (const auto& step : mode->commission)
    if (lives(step) && step.subsystem != parts_.mission.ground.subsystem) steps.push_back(&step);
  const auto each = [&](std::string_view function, const auto& argument) {
    for (const auto* step : steps) static_cast<void>(call(step->subsystem, function, argument(*step)));
  };
  const auto to = [](State target) { return [target](const auto&) { return static_cast<double>(target); }; };
  const auto configuration = [&](const descriptor::CommissionStep& step) {
    const auto& subsystem = parts_.mission.find_subsystem(step.subsystem)->subsystem;
    return static_cast<double>(subsystem.find_configuration(step.configuration)->id);
  };
  for (const auto* step : steps) {
    if (state(step->subsystem) != static_cast<std::uint32_t>(State::Offline))
      static_cast<void>(call(step->subsystem, "SET_STATE", static_cast<double>(State::Offline)));
  }
  each("SET_STATE", to(State::PreOperational));
  each("CONFIGURE", configuration);
  for (const std::uint8_t link : mode->establish) static_cast<void>(call(parts_.mission.supervisor.name, "LINK", link));
  each("SET_STATE", to(State::SafeOperational));
  each("SET_STATE", to(State::Operational));
  for (const auto* step : steps) parts_.trace.say("up {}", step->subsystem);
  parts_.time.run(500ms);
  parts_.trace.say("flown");
}

/// Sends a function with all acknowledgements and waits for its end.
bool Finale::call(std::string_view subsystem, std::string_view name, std::optional<double> argument) {
  const auto* target = parts_.mission.find_member(subsystem);
  if (target == nullptr) return false;
  const auto common = pus::common_functions();
  const auto built_in = std::ranges::find(common, name, &descriptor::Function::name);
  const auto* function = built_in != common.end() ? &*built_in : target->find_function(name);
  if (function == nullptr) return false;
  std::vector<double> values;
  if (argument) values.push_back(*argument);
  const auto data = pus::encode_call(*function, std::span<const double>{values});
  if (!data ||
      !parts_.traffic.send(FlightTraffic::ground, {.apid = target->id, .service = 8, .subtype = 1, .ack = 15}, *data))
    return false;
  const std::uint32_t request = parts_.traffic.last_request();
  constexpr Duration patience = 2s;
  parts_.time.run_until([&] { return parts_.traffic.verdict(request).over; }, patience);
  parts_.trace.say("called {} {} {} {}", target->name, name, argument.value_or(0),
                   parts_.traffic.verdict(request).completed ? "completed" : "failed");
  return parts_.traffic.verdict(request).completed;
}

std::uint32_t Finale::state(std::string_view name) const {
  const VitalPage* page = parts_.craft.vital(name);
  return page != nullptr ? page->state.load() : 0;
}

}  // namespace hirosco::campaign
