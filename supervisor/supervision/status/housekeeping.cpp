// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/status/housekeeping.hpp"

#include <algorithm>
#include <limits>

namespace hirosco::supervisor {
namespace {

/// Counters on the wire are of 32 bits and start again from 0.
[[nodiscard]] std::uint32_t wrapped(std::uint64_t count) noexcept { return static_cast<std::uint32_t>(count); }

}  // namespace

void Housekeeping::provide() {
  parts_.own.publish("MODE", mode_);
  parts_.own.publish("LINKS", links_);
  parts_.own.publish("REJECTIONS", rejections_);
  parts_.own.publish("COUNTS", counts_);
  parts_.own.publish(descriptor::subsystem_rows, members_);
  parts_.own.publish(descriptor::link_rows, link_rows_);
  parts_.own.publish(descriptor::link_quality_rows, link_quality_);
  parts_.own.publish(descriptor::link_latency_rows, link_latency_);
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

MemberRow Housekeeping::status_of(std::uint16_t apid, std::optional<State> state,
                                  const std::optional<MemberStatistics>& statistics,
                                  std::uint8_t configuration) const noexcept {
  MemberRow status;
  status.apid = apid;
  if (state) status.state = static_cast<std::uint8_t>(*state);
  if (!statistics) return status;
  status.configuration = configuration;
  status.inhibited = static_cast<std::uint8_t>(statistics->inhibited);
  status.cycles = wrapped(statistics->cycles);
  status.overruns = wrapped(statistics->overruns);
  status.missed = wrapped(statistics->missed);
  status.latency_max_ns = statistics->latency_max_ns;
  status.execution_mean_ns = statistics->execution_mean_ns;
  return status;
}

void Housekeeping::show_members() noexcept {
  MemberRows rows;
  std::size_t place = 0;
  const auto tell = [&](MemberRow status) {
    if (place == rows.apid.size()) return;  // of a mission that no reader has seen
    status.memory_kb = memory_kb_[place];
    put(rows, place++, status);
  };
  tell(
      status_of(craft_.mission.supervisor.id, parts_.own.state(), parts_.own.statistics(), parts_.own.configuration()));
  for (const Member& member : craft_.members)
    tell(status_of(member.apid(), member.state(), member.statistics(), member.configuration()));
  members_.store(rows);
}

void Housekeeping::watch(TimePoint) {
  memory_turn_ = (memory_turn_ + 1) % std::min(memory_kb_.size(), craft_.members.size() + 1);
  std::uint32_t& memory_kb = memory_kb_[memory_turn_];
  if (memory_turn_ == 0) {
    memory_kb = craft_.launcher.resident_kb(0);
    return;
  }
  const Member& subject = craft_.members[memory_turn_ - 1];
  memory_kb = subject.alive() ? craft_.launcher.resident_kb(subject.process()) : 0;
}

void Housekeeping::add_consumer(const descriptor::MissionLink& link, LinkRow& status) const noexcept {
  for (const Member& member : craft_.members) {
    if (member.descriptor().name != link.to) continue;
    const auto statistics = member.statistics();
    if (!statistics) return;
    const auto& incoming = statistics->incoming;
    const auto found = std::ranges::find(incoming, link.id, &MemberStatistics::Incoming::link);
    if (found != incoming.end()) {
      status.lost = found->lost;
      status.latency_mean_ns = found->latency_mean_ns;
      status.latency_max_ns = found->latency_max_ns;
      status.jitter_ns = found->jitter_ns;
      status.age_at_use_us = found->age_us;
      status.latencies = member.latencies(static_cast<std::size_t>(found - incoming.begin()));
      return;
    }
    return;
  }
}

LinkRow Housekeeping::status_of(const descriptor::MissionLink& link) const noexcept {
  LinkRow status;
  status.link = link.id;
  status.up = parts_.links.graph().is_up(link.id) ? 1 : 0;
  add_consumer(link, status);
  if (status.up != 0 && !parts_.links.can_look(link.id)) status.samples = status.age_us = LinkRow::not_told;
  const auto glance = parts_.links.glance(link.id);
  if (!glance) return status;
  const auto age_us = std::chrono::duration_cast<std::chrono::microseconds>(craft_.now - glance->sampled_at).count();
  status.samples = wrapped(glance->count);
  status.age_us =
      static_cast<std::uint32_t>(std::clamp<std::int64_t>(age_us, 0, std::numeric_limits<std::uint32_t>::max()));
  return status;
}

void Housekeeping::show_links() noexcept {
  LinkRows rows;
  const std::size_t told = std::min(craft_.mission.links.size(), rows.link.size());
  LinkQualityRows quality;
  LinkLatencyRows latency;
  for (std::size_t i = 0; i < told; ++i) {
    const LinkRow status = status_of(craft_.mission.links[i]);
    put(rows, i, status);
    put(quality, i, status);
    put(latency, i, status);
  }
  link_rows_.store(rows);
  link_quality_.store(quality);
  link_latency_.store(latency);
}

}  // namespace hirosco::supervisor
