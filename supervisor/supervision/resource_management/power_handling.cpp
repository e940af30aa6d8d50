// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_handling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/telecommand/waiting_for_disk.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

void PowerHandling::provide() {
  own_.on_function("SET_POWER_BUDGET", [this](double budget_w) -> Outcome {
    set_budget(budget_w);
    return ok();
  });
}

void PowerHandling::observe() {
  const auto demand_w = [](const descriptor::SubsystemDescriptor& subject, std::uint8_t id) {
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
  craft_.tell(fmt::format("power short: {} asks for {} W, {} W of {} W are reserved{}{}", craft_.name_of(apid),
                          requested_w, reserved_w, budget_w, ledger_.basis().empty() ? "" : ": ", ledger_.basis()),
              apid);
  own_.announce("POWER_REFUSED", {static_cast<double>(apid), budget_w, reserved_w, requested_w});
  // A plan that asks for power may be refused itself, here within its first step: it fails by that, and begins neither itself anew nor another.
  if (std::exchange(answering_, true)) return;
  if (Member* subject = craft_.member(apid); subject != nullptr && subject->alive())
    reactions_.react(*subject, "POWER_REFUSED", Severity::Low);
  answering_ = false;
}

void PowerHandling::hear(std::uint16_t from, const pus::TelemetryView& report) {
  if (measured_ && measured_->hear(from, report, craft_.now)) follow_measurement();
  if (report.service() != 1) return;
  OctetReader reader{report.source_data()};
  const pus::Request request{reader.get<std::uint32_t>(), report.destination(), 0};
  if (!reader.good()) return;
  constexpr std::uint8_t completed = 7, failed_step = 6;  // after which it goes on
  const std::uint8_t subtype = report.subtype();
  const bool failed = subtype % 2 == 0 && subtype != failed_step;
  if (failed || subtype == completed) ledger_.ended(from, request);
  else ledger_.under_way(from, request, craft_.now + WaitingForDisk::limit);
}

void PowerHandling::watch(TimePoint) {
  follow_measurement();
  observe();
  shed_load();
}

/// FC9 during use. Less than a tenth left: whoever draws stops acting. Less than is reserved: load is shed.
void PowerHandling::set_budget(double budget_w) {
  constexpr double least_margin = 0.1;
  ledger_.set_budget(budget_w);
  set_w_ = budget_w;
  observe();
  const double limit_w = ledger_.declared_mw() * 1e-3, reserved_w = ledger_.reserved_mw() * 1e-3;
  craft_.tell(fmt::format("power budget {} W, {} W are reserved", limit_w, reserved_w), supervisor_apid);
  if (ledger_.overdrawn()) return shed_load();
  if (reserved_w <= (1 - least_margin) * limit_w) return;
  own_.announce("POWER_LOW", {limit_w, reserved_w});
  for (Member& subject : craft_.members)
    if (ledger_.held_mw(subject.apid()) != 0 && !craft_.is_ground_link(subject))
      reactions_.react(subject, "POWER_LOW", Severity::Medium);
}

void PowerHandling::measure() {
  const auto& measured = craft_.mission.power_measured;
  if (!measured) return;
  measured_.emplace(*measured);
  craft_.power_known = [this] { return measured_->watts().has_value(); };
  ledger_.set_grantable(craft_.mission.power_least_w, basis());
}

/// What is known decides what is granted, never less than what the mission says; what is not known is told when that begins.
void PowerHandling::follow_measurement() {
  if (!measured_) return;
  const Member* who = std::as_const(craft_).member(craft_.mission.power_measured->apid);
  if (who == nullptr || !who->alive()) measured_->gone();
  measured_->watch(craft_.now);
  const double least_w = craft_.mission.power_least_w;
  const auto watts = measured_->watts();
  ledger_.set_grantable(std::max(least_w, std::min(watts.value_or(0), craft_.mission.power_budget_w.value_or(0))),
                        basis());
  const bool was_known = std::exchange(known_, watts.has_value());
  if (was_known == known_ || craft_.shutting_down) return;
  craft_.tell(watts ? fmt::format("power budget {} W: {}", *watts, basis())
                    : fmt::format("{}: no more than {} W are granted from now on", basis(), least_w),
              supervisor_apid);
  if (!watts) own_.announce("POWER_UNMEASURED", {static_cast<double>(craft_.mission.power_measured->apid), least_w});
}

std::string PowerHandling::basis() const {
  const std::string& name = craft_.mission.power_measured->name;
  using enum MeasuredBudget::Doubt;
  switch (measured_->doubt()) {
    case None: break;
    case NeverHeard: return name + " was never heard";
    case Old: return name + " was not heard in its time";
    case Gone: return name + " is not measured: who measures it does not run";
    case NoNumber: return name + " is not known to who measures it";
  }
  return name + " measures it";
}

void PowerHandling::note(OctetWriter& writer) const {
  writer.put(static_cast<std::uint8_t>(set_w_ ? 1 : 0)).put(set_w_.value_or(0.0));
}

void PowerHandling::recall(OctetReader& reader) {
  const bool set = reader.get<std::uint8_t>() != 0;
  const auto budget_w = reader.get<double>();
  if (!set || !reader.good()) return;
  ledger_.set_budget(budget_w);
  set_w_ = budget_w;
}

/// The last of the mission first, each with its network, until the rest fits; the ground link never, nor who measures the budget, without
/// whom nobody would know of any power.
void PowerHandling::shed_load() {
  // Told once: a mission may have a plan that does nothing about it.
  if (ledger_.newly_overdrawn())
    own_.announce("LOAD_SHED", {ledger_.declared_mw() * 1e-3, ledger_.reserved_mw() * 1e-3});
  if (!ledger_.overdrawn() || craft_.shutting_down) return;
  const auto stays_mw = [&] {
    std::uint32_t sum_mw = ledger_.held_mw(supervisor_apid);
    for (const Member& subject : craft_.members)
      if (!subject.recovery.going_down()) sum_mw += ledger_.held_mw(subject.apid());
    return sum_mw;
  };
  const auto& measured = craft_.mission.power_measured;
  const auto stays = [&](const Member& subject) {
    return craft_.is_ground_link(subject) || (measured && measured->apid == subject.apid());
  };
  for (auto subject = craft_.members.rbegin(); subject != craft_.members.rend() && stays_mw() > ledger_.declared_mw();
       ++subject) {
    if (stays(*subject) || subject->recovery.going_down() || ledger_.held_mw(subject->apid()) == 0) continue;
    reactions_.react(*subject, "LOAD_SHED", Severity::High);
  }
}

}  // namespace hirosco::supervisor
