// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hirosco::supervisor {
namespace {

using descriptor::State;

[[nodiscard]] std::uint32_t milliwatts(double watts) noexcept {
  return static_cast<std::uint32_t>(std::lround(watts * 1e3));
}

/// Where a configuration is in use: devices are given back in Post-Operational, so that still counts.
[[nodiscard]] bool in_use(State state) noexcept {
  return state == State::SafeOperational || state == State::Operational || state == State::ErrorOperational ||
         state == State::PostOperational;
}

}  // namespace

PowerLedger::PowerLedger(std::optional<double> budget_w) {
  if (budget_w) set_budget(*budget_w);
}

void PowerLedger::set_budget(double budget_w) noexcept { book_.set_budget(milliwatts(budget_w)); }

void PowerLedger::set_grantable(double grantable_w, std::string basis) {
  grantable_mw_ = milliwatts(grantable_w);
  basis_ = std::move(basis);
}

std::uint32_t PowerLedger::budget_mw() const noexcept {
  return grantable_mw_ ? std::min(*grantable_mw_, book_.budget()) : book_.budget();
}

std::optional<Shortage> PowerLedger::shortage(std::uint16_t apid, double demand_w) const noexcept {
  return limited() ? book_.shortage(apid, milliwatts(demand_w), budget_mw()) : std::nullopt;
}

void PowerLedger::reserve(std::uint16_t apid, double demand_w, const pus::Request& request, TimePoint until) {
  forget(apid);
  const std::uint32_t demand_mw = milliwatts(demand_w);
  book_.hold(apid, demand_mw);
  pending_.push_back({apid, demand_mw, request, until});
}

bool PowerLedger::Pending::is_told_of(std::uint16_t from, const pus::Request& told) const noexcept {
  return request.id == told.id && request.source == told.source && (from == apid || from == pus::supervisor_apid);
}

void PowerLedger::under_way(std::uint16_t from, const pus::Request& request, TimePoint until) noexcept {
  for (Pending& pending : pending_)
    if (pending.is_told_of(from, request)) pending.until = until;
}

void PowerLedger::ended(std::uint16_t from, const pus::Request& request) noexcept {
  std::erase_if(pending_, [&](const Pending& pending) { return pending.is_told_of(from, request); });
}

void PowerLedger::observe(std::uint16_t apid, std::optional<State> state, double demand_w, TimePoint now) {
  const std::uint32_t drawn_mw = state && in_use(*state) ? milliwatts(demand_w) : 0;
  const auto found = std::ranges::find(pending_, apid, &Pending::apid);
  const bool on_its_way = state.has_value() && found != pending_.end() && now <= found->until;
  // Who acts and is on its way into a configuration that draws more has not gone over yet.
  if (on_its_way && found->demand_mw > drawn_mw) return book_.hold(apid, found->demand_mw);
  book_.hold(apid, drawn_mw);
  forget(apid);
}

bool PowerLedger::newly_overdrawn() noexcept {
  const bool told = std::exchange(overdraft_told_, overdrawn());
  return overdraft_told_ && !told;
}

void PowerLedger::forget(std::uint16_t apid) {
  std::erase_if(pending_, [&](const Pending& pending) { return pending.apid == apid; });
}

}  // namespace hirosco::supervisor
