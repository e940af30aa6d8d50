// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/utilities/time.hpp"
#include "tools/hirosco/resource_marks.hpp"

namespace hirosco::tools {

/// What the supervisor's housekeeping says of everybody's process, share of the processor of cycles and electrical power: as it is, and
/// the most.
class CraftBooks {
 public:
  /// The mission outlives it.
  explicit CraftBooks(const descriptor::Mission& mission) : mission_{mission} {}
  /// The values of one of the supervisor's reports, in any order of their times.
  void hear(std::span<const pus::HousekeepingValue> values, OnboardTime at);
  /// False also where nothing was told of it.
  [[nodiscard]] bool runs(std::uint16_t apid) const;
  /// Whether there is a process, its share of the core of its cycle that its budgets promise, in whole percent (docs/adr/0007, 0234),
  /// and the power that is promised to it, in whole W, as its state and configuration say; of the supervisor processes, cycles and power of
  /// the craft. Without what is not accounted.
  [[nodiscard]] std::vector<ResourceRow> rows(const descriptor::SubsystemDescriptor& member) const;

 private:
  struct Member {
    bool runs{false};
    bool has_run{false};
    double power_w{0};
    double most_power_w{0};
    double share{0};  ///< of the core of its cycle
    double most_share{0};
  };
  using Shares = std::map<std::optional<std::uint16_t>, double>;  ///< of cores; empty: of all who name none
  [[nodiscard]] Shares shares_now() const;
  void add_of_all(std::vector<ResourceRow>& rows) const;
  void take_row(std::uint16_t apid, std::uint64_t state, std::uint8_t configuration, bool newest);

  const descriptor::Mission& mission_;
  std::map<std::uint16_t, Member> members_;
  OnboardTime told_at_{};
  OnboardTime power_at_{};
  std::optional<double> budget_w_, reserved_w_;
  double most_reserved_w_{0};
  std::uint64_t most_running_{0};
  Shares most_shares_;  ///< of all at once
};

}  // namespace hirosco::tools
