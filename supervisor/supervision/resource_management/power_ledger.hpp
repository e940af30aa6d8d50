// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/service/service.hpp"
#include "hirosco/utilities/time.hpp"
#include "supervisor/supervision/resource_management/book.hpp"

/// Electrical power (paper 4.3): a subsystem is refused what the budget does not carry, before it is commissioned.
/// Books only: what is promised, to whom. A subsystem counts with the power_W of its configuration from the permission
/// to go to Safe-Operational until it is back in Pre-Operational, Offline or dead. Amounts are in mW.
/// Where the budget is measured (docs/adr/0124) two numbers hold: who asks is granted what is measured, and what is taken is held
/// against what the mission or a telecommand says. So a measurement refuses, and sheds nothing.
namespace hirosco::supervisor {

/// Thread: the supervisor's.
class PowerLedger {
 public:
  /// Empty: not limited.
  explicit PowerLedger(std::optional<double> budget_w);
  void set_budget(double budget_w) noexcept;
  /// Who asks from now on is granted no more than this, nor than the budget; `basis`: why, in words.
  void set_grantable(double grantable_w, std::string basis);

  /// In mW. What `apid` already holds would be replaced, so it does not count.
  [[nodiscard]] std::optional<Shortage> shortage(std::uint16_t apid, double demand_w) const noexcept;
  /// For a permitted telecommand; held until it ended, or until `until` when nobody says, if that is more than its addressee draws by its state.
  void reserve(std::uint16_t apid, double demand_w, const pus::Request& request, TimePoint until);
  // `from` says so: the word of who was asked, or of the supervisor, counts and nobody else's.
  /// It has it, or has begun: it has this long to say how it ended.
  void under_way(std::uint16_t from, const pus::Request& request, TimePoint until) noexcept;
  /// It was completed, refused or failed: from now on the state decides.
  void ended(std::uint16_t from, const pus::Request& request) noexcept;
  /// What it draws by its state and its configuration's demand; without state it is not running.
  void observe(std::uint16_t apid, std::optional<descriptor::State> state, double demand_w, TimePoint now);

  [[nodiscard]] bool limited() const noexcept { return book_.limited(); }
  /// For who asks.
  [[nodiscard]] std::uint32_t budget_mw() const noexcept;
  /// For what is taken.
  [[nodiscard]] std::uint32_t declared_mw() const noexcept { return book_.budget(); }
  /// Why it is what it is, in words; empty: the mission or a telecommand says so.
  [[nodiscard]] const std::string& basis() const noexcept { return basis_; }
  [[nodiscard]] std::uint32_t reserved_mw() const noexcept { return book_.reserved(); }
  [[nodiscard]] std::uint32_t held_mw(std::uint16_t apid) const noexcept { return book_.held(apid); }
  /// More is in use than what is declared carries: it was lowered, or a configuration changed behind a permission.
  [[nodiscard]] bool overdrawn() const noexcept { return book_.overdrawn(); }
  /// True once from when it is overdrawn until it no longer is.
  [[nodiscard]] bool newly_overdrawn() noexcept;

 private:
  /// What is held for a telecommand on its way.
  struct Pending {
    std::uint16_t apid{};
    std::uint32_t demand_mw{};
    pus::Request request;
    TimePoint until{};
    [[nodiscard]] bool is_told_of(std::uint16_t from, const pus::Request& told) const noexcept;
  };
  void forget(std::uint16_t apid);

  Book book_;  ///< in mW
  std::optional<std::uint32_t> grantable_mw_;
  std::string basis_;
  std::vector<Pending> pending_;
  bool overdraft_told_{false};
};

}  // namespace hirosco::supervisor
