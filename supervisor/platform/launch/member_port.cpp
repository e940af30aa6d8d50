// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/launch/member_port.hpp"

#include <utility>

namespace hirosco::supervisor {

MemberStatistics statistics_of(const VitalPage& page) noexcept {
  const auto read = [](const auto& word) { return word.load(std::memory_order_relaxed); };
  MemberStatistics found;
  found.inhibited = read(page.inhibited);
  found.realtime = read(page.realtime) != 0;
  found.cycling = read(page.cycling) != 0;
  found.period_ns = read(page.period_ns);
  found.cycles = read(page.cycles);
  found.overruns = read(page.overruns);
  found.missed = read(page.missed);
  found.latency_max_ns = read(page.latency_max_ns);
  found.execution_mean_ns = read(page.execution_mean_ns);
  found.inhibited_at_cycle = read(page.inhibited_at_cycle);
  for (std::size_t i = 0; i < found.incoming.size(); ++i) {
    const IncomingLink& link = page.incoming[i];
    found.incoming[i] = {read(link.link),      read(link.lost),   read(link.latency_mean_ns), read(link.latency_max_ns),
                         read(link.jitter_ns), read(link.age_us), read(page.judged[i])};
  }
  return found;
}

MemberPort::MemberPort(Channel& channel, Mapping vital, Mapping permit) noexcept
    : channel_{channel}, vital_memory_{std::move(vital)}, permit_memory_{std::move(permit)} {
  if (vital_memory_.octets.size() >= sizeof(VitalPage))
    vital_ = reinterpret_cast<const VitalPage*>(vital_memory_.octets.data());
  if (permit_memory_.octets.size() >= sizeof(PermitPage))
    permit_ = reinterpret_cast<PermitPage*>(permit_memory_.octets.data());
}

const VitalPage* MemberPort::vital() const noexcept {
  return vital_ != nullptr && vital_->magic == page_magic && vital_->version == page_version ? vital_ : nullptr;
}

std::optional<State> MemberPort::state() const noexcept {
  const VitalPage* page = vital();
  if (page == nullptr) return std::nullopt;
  const std::uint32_t state = page->state.load(std::memory_order_acquire);
  if (state > static_cast<std::uint32_t>(State::SoftwareDeinit)) return std::nullopt;
  return static_cast<State>(state);
}

std::uint8_t MemberPort::configuration() const noexcept {
  const VitalPage* page = vital();
  return page != nullptr ? static_cast<std::uint8_t>(page->configuration.load(std::memory_order_relaxed)) : 0;
}

std::optional<MemberStatistics> MemberPort::statistics() const noexcept {
  const VitalPage* page = vital();
  if (page == nullptr) return std::nullopt;
  return statistics_of(*page);
}

MemberLatencies MemberPort::latencies(std::size_t place) const noexcept {
  MemberLatencies found;
  const VitalPage* page = vital();
  if (page == nullptr || place >= page->latencies.size()) return found;
  const LinkLatencies& told = page->latencies[place];
  found.period_ns = told.period_ns.load(std::memory_order_relaxed);
  for (std::size_t bin = 0; bin < latency_bins; ++bin)
    found.counts[bin] = told.counts[bin].load(std::memory_order_relaxed);
  return found;
}

std::uint64_t MemberPort::stopped_at_cycle() const noexcept {
  return permit_ != nullptr ? permit_->stopped_at_cycle.load(std::memory_order_relaxed) : 0;
}

void MemberPort::enter_mode(std::uint32_t epoch) noexcept {
  if (permit_ != nullptr) permit_->mode_epoch.store(epoch, std::memory_order_release);
}

void MemberPort::beat(std::uint64_t heartbeat, TimePoint now) {
  if (permit_ != nullptr) permit_->heartbeat.store(heartbeat, std::memory_order_release);
  take_across(now);
  channel_.step(now);
}

LocalMemberPort::LocalMemberPort(std::unique_ptr<Channel> channel, Mapping vital, Mapping permit) noexcept
    : MemberPort{*channel, std::move(vital), std::move(permit)}, channel_{std::move(channel)} {}

}  // namespace hirosco::supervisor
