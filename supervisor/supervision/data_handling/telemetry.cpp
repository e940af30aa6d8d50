// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telemetry.hpp"

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"

namespace hirosco::supervisor {

namespace {
constexpr Duration loss_period = 1s;
}

Channel* Telemetry::to_ground() {
  const Member* link = craft_.ground_link();
  return link != nullptr && link->alive() && link->state() != State::Offline ? link->channel() : nullptr;
}

bool Telemetry::take(std::uint16_t from, Octets packet) {
  const auto report = pus::TelemetryView::parse(packet);
  if (!report || report->apid() != from) return false;
  ++traffic_.counts.telemetry;
  if (pus::st129::is_retrieved(*report)) {
    // It stands in the log, and whoever is on board has heard it.
    if (Channel* link = to_ground()) ground_.send(*link, packet, GroundRoute::Kind::Report, craft_.now);
    return true;
  }
  const bool event = report->service() == 5 && report->subtype() <= 4;
  static_cast<void>(craft_.log.append({.kind = event ? LogKind::Event : LogKind::Telemetry,
                                       .source = from,
                                       .peer = report->destination(),
                                       .packet = packet}));
  craft_.observer.routed(*report);
  if (Channel* link = to_ground()) ground_.send(*link, packet, GroundRoute::kind_of(*report), craft_.now);
  for (Hearer* hearer : hearers_) hearer->hear(from, *report);
  return true;
}

void Telemetry::serve_ground() {
  if (Channel* link = to_ground()) ground_.flush(*link, craft_.now);
  else ground_.clear();
  const GroundRoute::Lost lost = ground_.lost();
  if (lost == lost_told_ || craft_.now < next_loss_told_) return;
  traffic_.counts.housekeeping_lost = lost.housekeeping;
  traffic_.counts.reports_lost = lost.reports;
  own_.announce("TELEMETRY_LOST", {static_cast<double>(lost.housekeeping - lost_told_.housekeeping),
                                   static_cast<double>(lost.reports - lost_told_.reports)});
  lost_told_ = lost;
  next_loss_told_ = craft_.now + loss_period;
}

}  // namespace hirosco::supervisor
