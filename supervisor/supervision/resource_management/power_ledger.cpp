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

void PowerLedger::set_budget(double budget_w) noexcept { budget_mw_ = milliwatts(budget_w); }

std::optional<PowerShortage> PowerLedger::shortage(std::uint16_t apid, double demand_w) const noexcept {
  const std::uint32_t requested = milliwatts(demand_w);
  if (!limited() || requested == 0) return std::nullopt;
  const std::uint32_t others = reserved_mw() - held_mw(apid);
  if (others + requested <= *budget_mw_) return std::nullopt;
  return PowerShortage{.budget_mw = *budget_mw_, .reserved_mw = others, .requested_mw = requested};
}

void PowerLedger::reserve(std::uint16_t apid, double demand_w, const pus::Request& request, TimePoint until) {
  Reservation& reservation = of(apid);
  reservation.demand_mw = milliwatts(demand_w);
  reservation.pending = request;
  reservation.until = until;
}

void PowerLedger::ended(const pus::Request& request) noexcept {
  for (Reservation& reservation : reservations_)
    if (reservation.pending && reservation.pending->id == request.id && reservation.pending->source == request.source)
      reservation.pending.reset();
}

void PowerLedger::observe(std::uint16_t apid, std::optional<State> state, double demand_w, TimePoint now) {
  if (state && in_use(*state)) {
    Reservation& reservation = of(apid);
    reservation.demand_mw = milliwatts(demand_w);
    reservation.pending.reset();
    return;
  }
  std::erase_if(reservations_, [&](const Reservation& reservation) {
    if (reservation.apid != apid) return false;
    const bool on_its_way = state.has_value() && reservation.pending.has_value() && now <= reservation.until;
    return !on_its_way;
  });
}

std::uint32_t PowerLedger::reserved_mw() const noexcept {
  std::uint32_t sum_mw = 0;
  for (const Reservation& reservation : reservations_) sum_mw += reservation.demand_mw;
  return sum_mw;
}

std::uint32_t PowerLedger::held_mw(std::uint16_t apid) const noexcept {
  const auto found = std::ranges::find(reservations_, apid, &Reservation::apid);
  return found == reservations_.end() ? 0 : found->demand_mw;
}

bool PowerLedger::newly_overdrawn() noexcept {
  const bool told = std::exchange(overdraft_told_, overdrawn());
  return overdraft_told_ && !told;
}

PowerLedger::Reservation& PowerLedger::of(std::uint16_t apid) {
  const auto found = std::ranges::find(reservations_, apid, &Reservation::apid);
  if (found != reservations_.end()) return *found;
  return reservations_.emplace_back(Reservation{.apid = apid, .demand_mw = 0, .pending = std::nullopt, .until = {}});
}

}  // namespace hirosco::supervisor
