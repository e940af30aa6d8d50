// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_keeper.hpp"

#include <utility>

#include "supervisor/keeper/kept_endnodes.hpp"

namespace hirosco::simulation {

SimulatedKeeper::SimulatedKeeper(const Parts& parts) : revives_after_{parts.revives_after} {
  if (!revives_after_) return;
  journal_memory_.resize(parts.journal_octets);
  journal_.emplace(journal_memory_);
  std::vector<FlowAddress> endnodes;
  for (auto& endnode : supervisor::kept_endnodes(parts.mission)) endnodes.push_back(std::move(endnode.address));
  bridge_.emplace(*page_, parts.flows, std::move(endnodes));
}

void SimulatedKeeper::count_start() {
  page_->starts.fetch_add(1);
  stops_.emplace(*page_);
  if (journal_) journal_.emplace(journal_memory_);  // in each process one
}

std::optional<TimePoint> SimulatedKeeper::lose_supervisor(TimePoint now, std::optional<Duration> pause) {
  if (!bridge_) return std::nullopt;
  bridge_->begin_at(now);
  return now + pause.value_or(*revives_after_);
}

TimePoint SimulatedKeeper::step(TimePoint now) {
  static_cast<void>(bridge_->step(now));
  return now + supervisor::InhibitBridge::pace;
}

void SimulatedKeeper::give_back(TimePoint now) {
  page_->wants_inhibits.store(page_->starts.load() + 1);
  static_cast<void>(bridge_->step(now));
}

}  // namespace hirosco::simulation
