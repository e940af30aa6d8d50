// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "hirosco/data_transfer/realtime_link.hpp"
#include "supervisor/supervisor.hpp"

/// What the supervisor tells of itself and of all others in its housekeeping. In its cycle: no allocation.
namespace hirosco::supervisor {
namespace {

constexpr std::uint8_t not_running = 255;

/// Counters on the wire are of 32 bits and start again from 0.
[[nodiscard]] std::uint32_t wrapped(std::uint64_t count) noexcept { return static_cast<std::uint32_t>(count); }

}  // namespace

Result<> Supervisor::show(const Cycle&) noexcept {
  mode_parameter_.store(mode_->id);
  links_parameter_.store({static_cast<std::uint32_t>(links_.graph().up_count()),
                          static_cast<std::uint32_t>(links_.graph().defined_count())});
  rejections_parameter_.store(rejections_);
  counts_parameter_.store(counts_);
  constexpr float watts = 1e-3F;
  power_parameter_.store(
      {static_cast<float>(power_.budget_mw()) * watts, static_cast<float>(power_.reserved_mw()) * watts});
  show_members();
  show_links();
  return ok();
}

void Supervisor::show_members() noexcept {
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
  tell_of(mission_.supervisor.id, engine_.state(), own_vital_.get());
  for (const Member& member : members_) tell_of(member.apid(), member.state(), member.vital());
  subsystems_parameter_.store(status);
}

/// Asks the operating system, which no cycle does; each member in its turn.
void Supervisor::watch_memory() {
  memory_turn_ = (memory_turn_ + 1) % std::min(told_members, members_.size() + 1);
  std::uint32_t& memory_kb = memory_kb_[memory_turn_];
  if (memory_turn_ == 0) {
    memory_kb = parts_.launcher.resident_kb(0);
    return;
  }
  const Member& subject = members_[memory_turn_ - 1];
  memory_kb = subject.alive() ? parts_.launcher.resident_kb(subject.process()) : 0;
}

/// What the consumer of a link tells of it; nullptr when it has no such link.
const IncomingLink* Supervisor::consumer_of(const descriptor::MissionLink& link) const noexcept {
  for (const Member& member : members_) {
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

void Supervisor::show_links() noexcept {
  LinksStatus status;
  const std::size_t told = std::min(mission_.links.size(), told_members);
  for (std::size_t i = 0; i < told; ++i) {
    const std::uint8_t link = mission_.links[i].id;
    status.link[i] = link;
    status.up[i] = links_.graph().is_up(link) ? 1 : 0;
    if (const IncomingLink* seen = consumer_of(mission_.links[i])) {
      status.lost[i] = seen->lost.load(std::memory_order_relaxed);
      status.latency_mean_ns[i] = seen->latency_mean_ns.load(std::memory_order_relaxed);
      status.latency_max_ns[i] = seen->latency_max_ns.load(std::memory_order_relaxed);
    }
    const auto watched = watched_links_.find(link);
    if (watched == watched_links_.end()) continue;
    const auto glance = glance_at_link(watched->second.octets);
    if (!glance) continue;
    const auto age_us = std::chrono::duration_cast<std::chrono::microseconds>(now_ - glance->sampled_at).count();
    status.samples[i] = wrapped(glance->count);
    status.age_us[i] =
        static_cast<std::uint32_t>(std::clamp<std::int64_t>(age_us, 0, std::numeric_limits<std::uint32_t>::max()));
  }
  link_status_parameter_.store(status);
}

}  // namespace hirosco::supervisor
