// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/own_subsystem.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace hirosco::supervisor {

OwnSubsystem::OwnSubsystem(const descriptor::SubsystemDescriptor& described, const Platform& platform, Author& author)
    : author_{author},
      vital_{std::make_unique<VitalPage>()},
      permit_{std::make_unique<PermitPage>()},
      runner_{*this, described, platform, channels_.subsystem_end(), *vital_, *permit_} {}

Result<Step> OwnSubsystem::software_init() {
  runner_.introduction().uses_all_events();
  author_.provide(*this);
  return done;
}

void OwnSubsystem::start(std::uint32_t mode_epoch) {
  permit_->release();
  permit_->mode_epoch.store(mode_epoch);
  permit_->heartbeat.store(1);
}

void OwnSubsystem::note(OctetWriter& writer) const { writer.put(std::as_bytes(std::span{&vital_->counters, 1})); }

void OwnSubsystem::recall(OctetReader& reader) {
  const Octets counters = reader.get(sizeof(pus::CounterBlock));
  if (reader.good()) std::memcpy(&vital_->counters, counters.data(), counters.size());
}

void OwnSubsystem::keep_silent(const std::set<std::uint16_t>& events) {
  for (const descriptor::Event& event : runner_.descriptor().events)
    if (!event.safety && events.contains(event.id)) runner_.reports().event_service().set_reported(event.id, false);
}

TimePoint OwnSubsystem::step(TimePoint now) {
  const TimePoint wake = runner_.service_step(now);
  const auto demand = runner_.cycle_demand();
  if (demand.wanted && !cycles_) next_cycle_ = now;
  cycles_ = demand.wanted;
  if (!demand.wanted) {
    runner_.cycle_parked(demand.ticket);
    return wake;
  }
  if (now >= next_cycle_) next_cycle_ = runner_.cycle_step(next_cycle_);
  return std::min(wake, next_cycle_);
}

}  // namespace hirosco::supervisor
