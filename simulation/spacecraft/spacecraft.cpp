// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/spacecraft.hpp"

#include <algorithm>

namespace hirosco::simulation {
namespace {

/// Away from zero, so that spans before the start stay positive.
[[nodiscard]] ManualClock clock_at_start() {
  ManualClock clock;
  clock.set(TimePoint{1s});
  return clock;
}

}  // namespace

Spacecraft::Spacecraft(const Parts& parts)
    : mission_{parts.mission},
      links_{parts.links},
      clock_{clock_at_start()},
      stores_{{.clock = clock_,
               .log = parts.log,
               .make_log = parts.make_log,
               .make_log_readings = parts.make_log_readings,
               .open_database = parts.open_database,
               .values = parts.values,
               .files = parts.files}},
      processes_{{.mission = parts.mission,
                  .subsystems = parts.subsystems,
                  .ground = ground_,
                  .platform = platform([this, &observer = parts.observer](
                                           std::string_view text) { observer.told(clock_.onboard(), text); },
                                       parts.realtime),
                  .wrap_channel = parts.wrap_channel,
                  .mistake_version = parts.mistake_version}},
      devices_{{.mission = parts.mission,
                .makers = parts.devices,
                .flows = flows_,
                .clock = clock_,
                .observer = parts.observer,
                .seed = parts.seed,
                .realtime = parts.realtime}},
      loops_{{.processes = processes_, .devices = devices_}},
      keeper_{{.mission = parts.mission,
               .flows = flows_,
               .revives_after = parts.revives_after,
               .journal_octets = parts.journal_octets}},
      supervision_{{.mission = parts.mission,
                    .platform = platform({}, parts.realtime),
                    .observer = parts.observer,
                    .processes = processes_,
                    .keeper = keeper_,
                    .stores = stores_,
                    .seed = parts.seed}},
      commands_{parts.mission} {
  supervision_.start();
}

Spacecraft::~Spacecraft() = default;

Platform Spacecraft::platform(std::function<void(std::string_view)> explain, bool realtime) {
  return {.clock = clock_,
          .memory = memory_,
          .flows = flows_,
          .realtime = realtime,
          .explain = std::move(explain),
          .links = links_};
}

// --- virtual time ------------------------------------------------------------------------------------------------------

void Spacecraft::run(Duration span) {
  const TimePoint end = clock_.now() + span;
  while (advance(end)) {}
}

bool Spacecraft::run_until(const std::function<bool()>& condition, Duration limit) {
  const TimePoint end = clock_.now() + limit;
  while (!condition())
    if (!advance(end)) return condition();
  return true;
}

/// Goes to the next thing that is due and does it. At one instant the order is fixed: devices, cycles, service loops, loops of
/// services of their own, guard, supervisor, each in mission order. False when nothing is left before `end`.
bool Spacecraft::advance(TimePoint end) {
  if (supervision_.finished()) return false;
  const TimePoint due = std::min({supervision_.next_wake(), devices_.next_wake(), loops_.next_wake()});
  if (due > end) {
    clock_.set(
        std::max(end, clock_.now()));  // it may be over already: a supervisor hung for longer, in the midst of its step
    return false;
  }
  const TimePoint now = std::max(due, clock_.now());
  clock_.set(now);
  devices_.step(now);
  loops_.step(now);
  supervision_.step(now);
  return true;
}

void Spacecraft::supervisor_hangs_here(Duration span) {
  supervision_.stand_still(true);
  run(span);
  supervision_.stand_still(false);
  supervision_.die_here();
}

CommandOutcome Spacecraft::command(std::string_view subsystem, std::string_view function,
                                   const std::vector<Value>& arguments, Duration limit) {
  const std::vector<std::byte> packet = commands_.write(subsystem, function, arguments);
  if (packet.empty()) return {};
  FollowedCommand followed{ground_, packet};
  ground_.send(packet);
  static_cast<void>(run_until([&] { return followed.over(); }, limit));
  return followed.outcome();
}

// --- subsystems by name --------------------------------------------------------------------------------------------------

std::string_view Spacecraft::version(std::string_view name) const noexcept {
  const SimulatedProcess* process = processes_.find(name);
  return process != nullptr ? std::string_view{process->version()} : std::string_view{};
}

const GenericSubsystem* Spacecraft::subsystem(std::string_view name) const noexcept {
  const SimulatedProcess* process = processes_.find(name);
  return process != nullptr ? process->subsystem() : nullptr;
}

const VitalPage* Spacecraft::vital(std::string_view name) const noexcept {
  const SimulatedProcess* process = processes_.find(name);
  return process != nullptr ? &process->vital() : nullptr;
}

PermitPage* Spacecraft::permit(std::string_view name) noexcept {
  SimulatedProcess* process = processes_.find(name);
  return process != nullptr ? &process->newest_permit() : nullptr;
}

void Spacecraft::stop(std::string_view name, bool stopped) {
  if (name == mission_.supervisor.name) supervision_.stop(stopped);
  else if (SimulatedProcess* process = processes_.find(name)) process->stop(stopped);
}

void Spacecraft::spin(std::string_view name) {
  if (SimulatedProcess* process = processes_.find(name)) process->spin(clock_.now());
}

void Spacecraft::call_spin_off(std::string_view name) {
  if (SimulatedProcess* process = processes_.find(name)) process->call_spin_off();
}

void Spacecraft::stick(std::string_view name, bool stuck) {
  if (SimulatedProcess* process = processes_.find(name)) process->stick(stuck);
}

void Spacecraft::strain(std::string_view name, int cycles, Duration takes) {
  if (SimulatedProcess* process = processes_.find(name)) process->strain(cycles, takes);
}

bool Spacecraft::send_as(std::string_view name, Octets packet) {
  SimulatedProcess* process = processes_.find(name);
  return process != nullptr && process->send(packet);
}

}  // namespace hirosco::simulation
