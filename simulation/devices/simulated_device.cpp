// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hirosco::simulation {
namespace {

constexpr std::size_t most_injections = 10'000;  // then the record ends; the faults still work

/// enable [NAME] N WHAT: of the endnode that drives the device, or of the one that is named.
[[nodiscard]] Result<> fault_inhibit(const Words& words, std::string_view driving, SimulatedInhibit& inhibit,
                                     FurtherEnds& further) {
  if (words.number(1, 0, 1e9)) return fault_way(inhibit.ways(), words, 1);
  return fault_way(words[1] == driving ? inhibit.ways() : further.inhibit_ways(words[1]), words, 2);
}

}  // namespace

SimulatedDevice::SimulatedDevice(FlowFactory& flows, FlowAddress address, const Settings& settings)
    : flows_{flows},
      settings_{settings},
      endnodes_{flows, {std::move(address), settings.fall_backs, settings.endnode, settings.further}},
      inhibit_{settings.enable, settings.enable_limit, settings.enable_fall_backs},
      switch_{settings.power, settings.power_fall_backs},
      obedience_{{settings.actuator, settings.watchdog, settings.stop, settings.stop_within}, inhibit_},
      further_{settings.further, settings.watchdog, settings.enable_limit, *this},
      clock_{settings.cycle, settings.clock} {}

Result<> SimulatedDevice::plug() {
  if (plugged()) return ok();
  if (!can(settings_.stop)) return fail(ErrorCode::InvalidArgument, "a stop that this device does not have");
  if (!world_made_) {
    HIROSCO_TRY(make_world());
  }
  world_made_ = true;
  HIROSCO_TRY(further_.open(flows_));
  HIROSCO_TRY(inhibit_.open(flows_));
  HIROSCO_TRY(switch_.open(flows_));
  return endnodes_.open();
}

void SimulatedDevice::step(TimePoint now) {
  const WorldClock::Held held = clock_.wake(now);
  const Duration forgiven_here = obedience_.forgive(held);
  inhibit_.prolong(held.pause + forgiven_here);
  const Duration forgiven = std::max(forgiven_here, further_.forgive(held));
  // Without power it hears nothing and moves nothing; it comes back knowing nothing of what was before.
  if (switch_.step(now)) begin_anew();
  inhibit_.receive(now, plugged() && powered());
  const bool exchanged = receive(now);
  const bool elsewhere = further_.receive(endnodes_.further(), now, powered());
  obedience_.watch(now);
  obedience_.choose_output(now);
  further_.choose_output(now);
  const std::int64_t due = clock_.due(now, exchanged);
  // What the watchdog forgives, the world does not live through: a command that its subsystem had no time to follow up would drive the
  // motors on, and a control loop left open for tens of milliseconds came back to torques beyond the hard limit.
  const bool stands = forgiven > Duration{0} && !exchanged && !elsewhere && acts() && has_world_alone();
  const std::int64_t lived = stands ? 0 : due;
  const Duration cycle = clock_.world_cycle();
  for (std::int64_t i = 0; i < lived; ++i) {
    advance(cycle);
    obedience_.count_down(cycle);
    further_.count_down(cycle);
  }
  clock_.count(lived, exchanged);
  if (acts()) obeyed_cycles_ = cycles();
  if (due > 0 || exchanged) answer(now);
  answers_.send_due(now, endnodes_.driving());
  inhibit_.answer(plugged(), {.output = output(), .flags = flags(), .epoch = obedience_.epoch()});
  further_.answer(endnodes_.further(), {flags(), powered(), plugged(), answers_.silent(clock_.now())});
}

/// As it boots: it knows nothing of what was before, and what moves has brakes or nothing.
void SimulatedDevice::begin_anew() noexcept {
  obedience_.begin_anew();
  inhibit_.forget();
  further_.begin_anew();
  endnodes_.forget();
  answers_.forget();
  do_forget();
}

/// True when an acceptable command came.
bool SimulatedDevice::receive(TimePoint now) noexcept {
  std::array<std::byte, max_device_frame_octets> buffer;
  const auto received = endnodes_.receive(buffer);
  if (!received || received->flow != Flow::New || !powered()) return false;
  const auto command = read_command(Octets{buffer}.first(std::min(received->octets, buffer.size())));
  if (!command) {
    ++damaged_commands_;
    return false;
  }
  return accept(*command, now);
}

bool SimulatedDevice::accept(const DeviceCommand& command, TimePoint now) noexcept {
  using enum Obedience::Verdict;
  const Obedience::Judgement judgement = obedience_.judge(command, now);
  if (judgement.verdict == Refused) return false;
  if (judgement.verdict == Heard) return true;
  if (judgement.verdict == Obeyed && !take(OctetReader{command.payload, settings_.byte_order})) {
    ++damaged_commands_;
    return false;
  }
  obedience_.accept(command, judgement, now);
  return true;
}

void SimulatedDevice::answer(TimePoint now) noexcept {
  if (answers_.measures(now)) {
    std::array<std::byte, max_device_payload_octets> payload;
    OctetWriter writer{payload, settings_.byte_order};
    write_sensors(writer);
    answers_.measured({.epoch = obedience_.epoch(),
                       .sequence = obedience_.sequence(),
                       .flags = flags(),
                       .payload = writer.written()});
  }
  if (plugged() && powered()) answers_.answer(now);
}

TimePoint SimulatedDevice::next_wake() const noexcept {
  if (!clock_.started()) return clock_.now();
  TimePoint wake = std::min(clock_.next(), obedience_.trips_at());
  if (active()) wake = std::min(wake, inhibit_.ends_at());
  return std::min({wake, further_.next_wake(), answers_.next_due(), switch_.off_at()});
}

Result<> SimulatedDevice::fault(std::string_view line) {
  const Words words{line};
  HIROSCO_TRY(apply_fault(words));
  if (injections_.size() < most_injections) injections_.push_back({clock_.now(), std::string{line}});
  return ok();
}

std::string SimulatedDevice::truth() const {
  const double cycle_s = seconds(settings_.cycle);
  return fmt::format("{} world_s={:.4f} obeyed_s={:.4f}{}", do_truth(), static_cast<double>(cycles()) * cycle_s,
                     static_cast<double>(obeyed_cycles_) * cycle_s,
                     switch_.opened() ? fmt::format(" powered={}", powered() ? 1 : 0) : "");
}

void SimulatedDevice::heal() noexcept {
  answers_.heal();
  endnodes_.heal();
  further_.heal();
  for (EndnodeWays* const ways : {inhibit_.ways(), switch_.ways()})
    if (ways != nullptr) ways->heal();
  do_heal();
}

void SimulatedDevice::unplug() noexcept {
  endnodes_.close();
  inhibit_.withdraw();
  further_.withdraw();
  answers_.drop();
}

Result<> SimulatedDevice::apply_fault(const Words& words) {
  const std::string_view what = words[0];
  if (what == "unplug" || what == "plug" || what == "silent" || what == "reboot" || what == "heal") {
    HIROSCO_TRY(words.expect(1));
    if (what == "reboot") begin_anew();
    if (what == "silent") answers_.fall_silent();
    if (what == "heal") heal();
    if (what == "plug") return plug();
    if (what == "unplug") unplug();
    return ok();
  }
  if (what == "stall" || what == "freeze" || what == "delay" || what == "corrupt")
    return answers_.fault(words, clock_.now());
  if (what == "way" || what == "endnode") return endnodes_.fault(words);
  if (what == "enable") return fault_inhibit(words, settings_.endnode, inhibit_, further_);
  if (what == "power") return fault_way(switch_.ways(), words, 1);
  return do_fault(words);
}

}  // namespace hirosco::simulation
