// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/status/housekeeping.hpp"

#include <algorithm>
#include <limits>

namespace hirosco::supervisor {
namespace {

constexpr std::uint8_t not_running = 255;

/// Counters on the wire are of 32 bits and start again from 0.
[[nodiscard]] std::uint32_t wrapped(std::uint64_t count) noexcept { return static_cast<std::uint32_t>(count); }

}  // namespace

void Housekeeping::provide() {
  parts_.own.publish("MODE", mode_);
  parts_.own.publish("LINKS", links_);
  parts_.own.publish("REJECTIONS", rejections_);
  parts_.own.publish("COUNTS", counts_);
  parts_.own.publish("SUBSYSTEMS", subsystems_);
  parts_.own.publish("LINK_STATUS", link_status_);
  parts_.own.publish("POWER", power_);
}

void Housekeeping::show() noexcept {
  const LinkGraph& graph = parts_.links.graph();
  mode_.store(craft_.mode->id);
  links_.store({static_cast<std::uint32_t>(graph.up_count()), static_cast<std::uint32_t>(graph.defined_count())});
  rejections_.store(parts_.traffic.rejections());
  counts_.store(parts_.traffic.counts);
  constexpr float watts = 1e-3F;
  power_.store(
      {static_cast<float>(parts_.power.budget_mw()) * watts, static_cast<float>(parts_.power.reserved_mw()) * watts});
  show_members();
  show_links();
}

void Housekeeping::show_members() noexcept {
  SubsystemsStatus status;
  std::size_t place = 0;
  const auto tell_of = [&](std::uint16_t apid, std::optional<State> state, const VitalPage* vital) {
    if (place == told_members) return;
    const std::size_t i = place++;
    status.memory_kb[i] = memory_kb_[i];
    status.apid[i] = apid;
    status.state[i] = state ? static_cast<std::uint8_t>(*state) : not_running;
    if (vital == nullptr) return;
    const auto read = [](const auto& word) { return word.load(std::memory_order_relaxed); };
    status.configuration[i] = static_cast<std::uint8_t>(read(vital->configuration));
    status.inhibited[i] = static_cast<std::uint8_t>(read(vital->inhibited));
    status.cycles[i] = wrapped(read(vital->cycles));
    status.overruns[i] = wrapped(read(vital->overruns));
    status.missed[i] = wrapped(read(vital->missed));
    status.latency_max_ns[i] = read(vital->latency_max_ns);
    status.execution_mean_ns[i] = read(vital->execution_mean_ns);
  };
  tell_of(craft_.mission.supervisor.id, parts_.own.state(), &parts_.own.vital());
  for (const Member& member : craft_.members) tell_of(member.apid(), member.state(), member.vital());
  subsystems_.store(status);
}

void Housekeeping::watch(TimePoint) {
  memory_turn_ = (memory_turn_ + 1) % std::min(told_members, craft_.members.size() + 1);
  std::uint32_t& memory_kb = memory_kb_[memory_turn_];
  if (memory_turn_ == 0) {
    memory_kb = craft_.launcher.resident_kb(0);
    return;
  }
  const Member& subject = craft_.members[memory_turn_ - 1];
  memory_kb = subject.alive() ? craft_.launcher.resident_kb(subject.process()) : 0;
}

/// What the consumer of a link tells of it; nullptr when it has no such link.
const IncomingLink* Housekeeping::consumer_of(const descriptor::MissionLink& link) const noexcept {
  for (const Member& member : craft_.members) {
    if (member.descriptor().name != link.to) continue;
    const VitalPage* vital = member.vital();
    if (vital == nullptr) return nullptr;
    const auto found = std::ranges::find_if(vital->incoming, [&](const IncomingLink& incoming) {
      return incoming.link.load(std::memory_order_relaxed) == link.id;
    });
    return found != vital->incoming.end() ? &*found : nullptr;
  }
  return nullptr;
}

void Housekeeping::show_links() noexcept {
  LinksStatus status;
  const std::size_t told = std::min(craft_.mission.links.size(), told_members);
  for (std::size_t i = 0; i < told; ++i) {
    const std::uint8_t link = craft_.mission.links[i].id;
    status.link[i] = link;
    status.up[i] = parts_.links.graph().is_up(link) ? 1 : 0;
    if (const IncomingLink* seen = consumer_of(craft_.mission.links[i])) {
      status.lost[i] = seen->lost.load(std::memory_order_relaxed);
      status.latency_mean_ns[i] = seen->latency_mean_ns.load(std::memory_order_relaxed);
      status.latency_max_ns[i] = seen->latency_max_ns.load(std::memory_order_relaxed);
    }
    const auto glance = parts_.links.glance(link);
    if (!glance) continue;
    const auto age_us = std::chrono::duration_cast<std::chrono::microseconds>(craft_.now - glance->sampled_at).count();
    status.samples[i] = wrapped(glance->count);
    status.age_us[i] =
        static_cast<std::uint32_t>(std::clamp<std::int64_t>(age_us, 0, std::numeric_limits<std::uint32_t>::max()));
  }
  link_status_.store(status);
}

}  // namespace hirosco::supervisor
