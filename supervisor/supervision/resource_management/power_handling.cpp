// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_handling.hpp"

#include <fmt/format.h>

#include "supervisor/supervision/event_handling/reactions.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

void PowerHandling::provide() {
  own_.on_function("SET_POWER_BUDGET", [this](double budget_w) -> Outcome {
    set_budget(budget_w);
    return ok();
  });
}

void PowerHandling::observe() {
  const auto demand_w = [](const descriptor::Subsystem& subject, std::uint8_t id) {
    const auto* configuration = subject.find_configuration(id);
    return configuration != nullptr ? configuration->power_w : 0;
  };
  ledger_.observe(supervisor_apid, own_.state(), demand_w(craft_.mission.supervisor, own_.configuration()), craft_.now);
  for (const Member& subject : craft_.members)
    ledger_.observe(subject.apid(), subject.alive() ? subject.state() : std::nullopt,
                    demand_w(subject.descriptor(), subject.configuration()), craft_.now);
}

void PowerHandling::tell_shortage(std::uint16_t apid, const pus::FailureNotice& notice) {
  OctetReader reader{notice.data()};
  const auto watts = [&] { return reader.get<std::uint32_t>() * 1e-3; };
  const double budget_w = watts(), reserved_w = watts(), requested_w = watts();
  craft_.tell(fmt::format("power short: {} asks for {} W, {} W of {} W are reserved", craft_.name_of(apid), requested_w,
                          reserved_w, budget_w),
              apid);
  own_.announce("POWER_REFUSED", {static_cast<double>(apid), budget_w, reserved_w, requested_w});
  if (Member* subject = craft_.member(apid); subject != nullptr && subject->alive())
    reactions_.react(*subject, "POWER_REFUSED", Severity::Low);
}

void PowerHandling::hear(std::uint16_t, const pus::TelemetryView& report) {
  if (report.service() != 1 || (report.subtype() % 2 != 0 && report.subtype() != 7)) return;
  OctetReader reader{report.source_data()};
  const auto id = reader.get<std::uint32_t>();
  if (reader.good()) ledger_.ended({id, report.destination(), 0});
}

void PowerHandling::watch(TimePoint) {
  observe();
  shed_load();
}

/// FC9 during use. Less than a tenth left: whoever draws stops acting. Less than is reserved: load is shed.
void PowerHandling::set_budget(double budget_w) {
  constexpr double least_margin = 0.1;
  ledger_.set_budget(budget_w);
  set_w_ = budget_w;
  observe();
  const double limit_w = ledger_.budget_mw() * 1e-3, reserved_w = ledger_.reserved_mw() * 1e-3;
  craft_.tell(fmt::format("power budget {} W, {} W are reserved", limit_w, reserved_w), supervisor_apid);
  if (ledger_.overdrawn()) return shed_load();
  if (reserved_w <= (1 - least_margin) * limit_w) return;
  own_.announce("POWER_LOW", {limit_w, reserved_w});
  for (Member& subject : craft_.members)
    if (ledger_.held_mw(subject.apid()) != 0 && !craft_.is_ground_link(subject))
      reactions_.react(subject, "POWER_LOW", Severity::Medium);
}

void PowerHandling::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint8_t>(set_w_ ? 1 : 0)).put(set_w_.value_or(0.0));
}

void PowerHandling::recall(OctetReader& reader) {
  const bool set = reader.get<std::uint8_t>() != 0;
  const auto budget_w = reader.get<double>();
  if (!set) return;
  ledger_.set_budget(budget_w);
  set_w_ = budget_w;
}

/// The last of the mission first, each with its network, until the rest fits; the ground link never.
void PowerHandling::shed_load() {
  // Told once: a mission may have a plan that does nothing about it.
  if (ledger_.newly_overdrawn()) own_.announce("LOAD_SHED", {ledger_.budget_mw() * 1e-3, ledger_.reserved_mw() * 1e-3});
  if (!ledger_.overdrawn() || craft_.shutting_down) return;
  const auto stays_mw = [&] {
    std::uint32_t sum_mw = ledger_.held_mw(supervisor_apid);
    for (const Member& subject : craft_.members)
      if (!subject.recovery.going_down()) sum_mw += ledger_.held_mw(subject.apid());
    return sum_mw;
  };
  for (auto subject = craft_.members.rbegin(); subject != craft_.members.rend() && stays_mw() > ledger_.budget_mw();
       ++subject) {
    if (craft_.is_ground_link(*subject) || subject->recovery.going_down() || ledger_.held_mw(subject->apid()) == 0)
      continue;
    reactions_.react(*subject, "LOAD_SHED", Severity::High);
  }
}

}  // namespace hirosco::supervisor
