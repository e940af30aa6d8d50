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
  book_.hold(apid, milliwatts(demand_w));
  pending_.push_back({apid, request, until});
}

void PowerLedger::ended(const pus::Request& request) noexcept {
  std::erase_if(pending_, [&](const Pending& pending) {
    return pending.request.id == request.id && pending.request.source == request.source;
  });
}

void PowerLedger::observe(std::uint16_t apid, std::optional<State> state, double demand_w, TimePoint now) {
  if (state && in_use(*state)) {
    book_.hold(apid, milliwatts(demand_w));
    return forget(apid);
  }
  const auto found = std::ranges::find(pending_, apid, &Pending::apid);
  const bool on_its_way = state.has_value() && found != pending_.end() && now <= found->until;
  if (on_its_way) return;
  book_.hold(apid, 0);
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
