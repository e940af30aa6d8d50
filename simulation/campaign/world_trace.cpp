// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/campaign/world_trace.hpp"

#include <span>
#include <utility>

#include "hirosco/utilities/crc32.hpp"

namespace hirosco::campaign {
namespace {

constexpr Duration count_every = 20ms;

}  // namespace

WorldTrace::WorldTrace(const descriptor::Mission& mission, simulation::Spacecraft& craft, std::uint32_t clock_percent,
                       std::string_view origin)
    : craft_{craft} {
  say("simulated {}", origin);
  for (const auto& described : mission.subsystems) members_.push_back({.name = described.subsystem.name});
  for (const auto& described : mission.devices) {
    const auto* device = craft.device(described.name);
    if (device == nullptr) continue;
    devices_.push_back({.name = described.name, .device = device});
    // A planted clock that runs wrong is not told of: the trace says what the device should keep.
    say("device {} {} period_ns={}", described.name, described.subsystem,
        device->settings().cycle.count() * clock_percent / 100);
  }
  look();
}

std::int64_t WorldTrace::now_us() const {
  return std::chrono::duration_cast<std::chrono::microseconds>(craft_.now() - start_of_flight).count();
}

void WorldTrace::look() {
  for (Member& member : members_) look_at(member);
  for (Device& device : devices_) look_at(device);
  if (std::exchange(supervised_, craft_.supervised()) != craft_.supervised()) say("supervised {:d}", supervised_);
  if (supervised_) look_at_links();
  if (craft_.now() < next_count_) return;
  next_count_ = craft_.now() + count_every;
  count_cycles();
}

/// As the supervisor has them: while there is none nobody does.
void WorldTrace::look_at_links() {
  std::string up;
  for (std::uint8_t id = 1; id < 32; ++id)
    if (craft_.supervisor().links().is_up(id)) up += fmt::format(" {}", id);
  if (up != links_up_) say("links{}", up);
  links_up_ = std::move(up);
}

void WorldTrace::look_at(Member& member) {
  static constexpr std::array words{"alive", "state", "configuration", "inhibited", "cycling"};
  const VitalPage* page = craft_.vital(member.name);
  std::array<std::uint64_t, words.size()> seen{};
  if (page != nullptr)
    seen = {1, page->state.load(), page->configuration.load(), page->inhibited.load(), page->cycling.load()};
  for (std::size_t i = 0; i < words.size(); ++i)
    if (seen[i] != member.seen[i] && (page != nullptr || i == 0)) say("{} {} {}", words[i], member.name, seen[i]);
  member.seen = seen;
  if (page == nullptr) return;
  look_at_program(member);
  for (std::size_t i = 0; i < member.links.size(); ++i) {
    const std::uint32_t link = page->incoming[i].link.load();
    if (link != member.links[i]) say("incoming {} {} {}", member.name, i, link);
    member.links[i] = link;
  }
  const std::uint64_t cycles = page->cycles.load();
  const std::uint64_t period_ns = page->period_ns.load();
  if (period_ns != member.period_ns) say("period {} {}", member.name, period_ns);
  member.period_ns = period_ns;
  if (cycles != member.cycles) {
    if (member.still) say("moves {} {}", member.name, cycles);
    member.still = false;
    member.cycles = cycles;
    member.moved = craft_.now();
  } else if (!member.still && craft_.now() - member.moved > Duration{static_cast<std::int64_t>(2 * period_ns)}) {
    member.still = true;
    say("still {} since={}", member.name,
        std::chrono::duration_cast<std::chrono::microseconds>(member.moved - start_of_flight).count());
  }
}

/// Which version runs, and by which text of its descriptor: what its process itself has of it.
void WorldTrace::look_at_program(Member& member) {
  const std::string_view version = craft_.version(member.name);
  if (const std::string_view named = version.empty() ? "-" : version; named != member.version) {
    say("version {} {}", member.name, named);
    member.version = named;
  }
  const GenericSubsystem* subsystem = craft_.subsystem(member.name);
  const std::string* text = subsystem != nullptr ? subsystem->descriptor().text.get() : nullptr;
  if (text == nullptr || text == member.text) return;
  member.text = text;
  say("text {} {:08x}", member.name, crc32(std::as_bytes(std::span{*text})));
}

void WorldTrace::look_at(Device& device) {
  const bool active = device.device->active();
  const bool turning = device.device->drives();
  const bool tripped = device.device->watchdog_tripped();
  if (active != device.active) say("active {} {:d}", device.name, active);
  if (turning != device.turning) say("torque {} {:d}", device.name, turning);
  if (tripped != device.tripped) say("tripped {} {:d}", device.name, tripped);
  device.active = active;
  device.turning = turning;
  device.tripped = tripped;
}

void WorldTrace::count_cycles() {
  std::string line = "cycles";
  for (const Member& member : members_) line += fmt::format(" {}={}", member.name, member.cycles);
  for (const Device& device : devices_) line += fmt::format(" {}={}", device.name, device.device->cycles());
  say("{}", line);
}

}  // namespace hirosco::campaign
