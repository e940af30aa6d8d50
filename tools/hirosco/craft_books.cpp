// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/craft_books.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "hirosco/descriptor/model/cores.hpp"
#include "hirosco/descriptor/model/status_rows.hpp"

namespace hirosco::tools {
namespace {

using descriptor::State;

/// What was taken is never told as less.
[[nodiscard]] std::uint64_t whole_watts(double watts) noexcept {
  constexpr double noise = 1e-3;  // of a number of 32 bits
  return static_cast<std::uint64_t>(std::max(0.0, std::ceil(watts - noise)));
}

/// Where a configuration is in use, as the supervisor's ledger counts it.
[[nodiscard]] bool draws(std::uint64_t state) noexcept {
  return state >= static_cast<std::uint64_t>(State::SafeOperational) &&
         state <= static_cast<std::uint64_t>(State::PostOperational);
}

[[nodiscard]] bool runs_cycles(std::uint64_t state) noexcept {
  return state >= static_cast<std::uint64_t>(State::PreOperational) &&
         state <= static_cast<std::uint64_t>(State::ErrorOperational);
}

[[nodiscard]] std::uint64_t whole_percent(double share) noexcept {
  constexpr double noise = 1e-9;
  return static_cast<std::uint64_t>(std::max(0.0, std::ceil(100 * share - noise)));
}

/// The greatest of what its configurations promise.
[[nodiscard]] double greatest_share(const descriptor::SubsystemDescriptor& subsystem) noexcept {
  double most = descriptor::cycle_share(subsystem, nullptr);
  for (const auto& configuration : subsystem.configurations)
    most = std::max(most, descriptor::cycle_share(subsystem, &configuration));
  return most;
}

/// Where somebody names cores it says of which.
[[nodiscard]] std::string share_attribute(std::optional<std::uint16_t> core) {
  return core ? "cycles_percent of core " + std::to_string(*core) : "cycles_percent";
}

[[nodiscard]] const pus::HousekeepingValue* find_value(std::span<const pus::HousekeepingValue> values,
                                                       std::string_view structure, std::string_view member) {
  const std::string name = std::string{structure} + "." + std::string{member};
  const auto found = std::ranges::find(values, name, &pus::HousekeepingValue::name);
  return found != values.end() && !found->values.empty() ? &*found : nullptr;
}

}  // namespace

void CraftBooks::take_row(std::uint16_t apid, std::uint64_t state, std::uint8_t configuration, bool newest) {
  const auto* described = mission_.find_member(apid);
  if (described == nullptr) return;
  const bool runs = state <= static_cast<std::uint64_t>(State::SoftwareDeinit);
  const auto* in_force = described->find_configuration(configuration);
  const double power_w = runs && draws(state) && in_force != nullptr ? in_force->power_w : 0;
  const double share = runs ? descriptor::cycle_share(*described, runs_cycles(state) ? in_force : nullptr) : 0;
  Member& member = members_[apid];
  member.has_run |= runs;
  member.most_power_w = std::max(member.most_power_w, power_w);
  member.most_share = std::max(member.most_share, share);
  if (!newest) return;
  member.runs = runs;
  member.power_w = power_w;
  member.share = share;
}

void CraftBooks::hear(std::span<const pus::HousekeepingValue> values, OnboardTime at) {
  const auto* apids = find_value(values, descriptor::subsystem_rows, "APID");
  const auto* states = find_value(values, descriptor::subsystem_rows, "STATE");
  const auto* configurations = find_value(values, descriptor::subsystem_rows, "CONFIGURATION");
  if (apids != nullptr && states != nullptr && configurations != nullptr) {
    const bool newest = at >= told_at_;
    if (newest) told_at_ = at;
    const std::size_t rows = std::min({apids->values.size(), states->values.size(), configurations->values.size()});
    for (std::size_t i = 0; i < rows; ++i)
      if (const auto apid = static_cast<std::uint16_t>(apids->values[i]); apid != 0)
        take_row(apid, static_cast<std::uint64_t>(states->values[i]),
                 static_cast<std::uint8_t>(configurations->values[i]), newest);
    std::uint64_t running = 0;
    for (const auto& [apid, member] : members_) running += apid != mission_.supervisor.id && member.runs ? 1 : 0;
    most_running_ = std::max(most_running_, running);
    for (const auto& [core, share] : shares_now()) most_shares_[core] = std::max(most_shares_[core], share);
  }
  const auto* budget = find_value(values, "POWER", "BUDGET");
  const auto* reserved = find_value(values, "POWER", "RESERVED");
  if (budget == nullptr || reserved == nullptr) return;
  most_reserved_w_ = std::max(most_reserved_w_, reserved->values[0]);
  if (at < power_at_) return;
  power_at_ = at;
  budget_w_ = budget->values[0];
  reserved_w_ = reserved->values[0];
}

bool CraftBooks::runs(std::uint16_t apid) const {
  const auto found = members_.find(apid);
  return found != members_.end() && found->second.runs;
}

CraftBooks::Shares CraftBooks::shares_now() const {
  Shares shares;
  for (const auto& member : mission_.subsystems)
    if (const auto found = members_.find(member.subsystem.id); found != members_.end())
      shares[core_of(mission_, member)] += found->second.share;
  return shares;
}

/// Of all subsystems: what the mission limits of processes, and the cores that their cycles share.
void CraftBooks::add_of_all(std::vector<ResourceRow>& rows) const {
  std::uint64_t running = 0;
  Shares promised;
  for (const auto& member : mission_.subsystems) {
    double& most = promised[core_of(mission_, member)];
    most = std::max(most, greatest_share(member.subsystem));
  }
  for (const auto& [apid, member] : members_) running += apid != mission_.supervisor.id && member.runs ? 1 : 0;
  if (const auto most = amount_of(mission_.budget, descriptor::Resource::Processes)) {
    rows.push_back({"processes of all", *most, most_running_});
    if (!members_.empty()) rows.back().now = running;
  }
  const auto of = [](const Shares& shares, std::optional<std::uint16_t> core) {
    const auto found = shares.find(core);
    return whole_percent(found != shares.end() ? found->second : 0);
  };
  const Shares now = shares_now();
  for (const auto& [core, most] : promised) {
    if (most <= 0) continue;
    rows.push_back({share_attribute(core), 100, of(most_shares_, core)});
    if (!members_.empty()) rows.back().now = of(now, core);
  }
}

std::vector<ResourceRow> CraftBooks::rows(const descriptor::SubsystemDescriptor& subsystem) const {
  const auto found = members_.find(subsystem.id);
  const Member member = found != members_.end() ? found->second : Member{};
  std::vector<ResourceRow> rows;
  rows.push_back({"processes", 1, member.has_run ? 1U : 0U});
  if (found != members_.end()) rows.back().now = member.runs ? 1 : 0;
  if (subsystem.id == mission_.supervisor.id) add_of_all(rows);
  else if (const double most = greatest_share(subsystem); most > 0) {
    const auto* const flown = mission_.find_subsystem(subsystem.id);
    rows.push_back({share_attribute(flown != nullptr ? core_of(mission_, *flown) : std::nullopt), whole_percent(most),
                    whole_percent(member.most_share)});
    if (found != members_.end()) rows.back().now = whole_percent(member.share);
  }
  ResourceRow power{.attribute = "power_W"};
  if (subsystem.id == mission_.supervisor.id) {
    if (!reserved_w_) return rows;
    if (*budget_w_ > 0) power.declared = whole_watts(*budget_w_);
    power.now = whole_watts(*reserved_w_);
    power.high = whole_watts(most_reserved_w_);
  } else {
    double most_w = 0;
    for (const auto& configuration : subsystem.configurations) most_w = std::max(most_w, configuration.power_w);
    if (most_w <= 0) return rows;
    power.declared = whole_watts(most_w);
    power.high = whole_watts(member.most_power_w);
    if (found != members_.end()) power.now = whole_watts(member.power_w);
  }
  rows.push_back(std::move(power));
  return rows;
}

}  // namespace hirosco::tools
