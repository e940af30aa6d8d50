// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/parameter/parameter.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/traffic.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/realtime_links/link_commands.hpp"
#include "supervisor/supervision/resource_management/power_ledger.hpp"
#include "supervisor/supervision/status/rows.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// What the supervisor tells of itself and of all others in its housekeeping (structures 4701 to 4704 of supervisor.xml).
/// Thread: the supervisor's.
class Housekeeping final : public Watch {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    const LinkCommands& links;
    const PowerLedger& power;
    const Traffic& traffic;
  };
  explicit Housekeeping(const Parts& parts) : parts_{parts}, craft_{parts.craft} {}

  void provide();
  /// In its cycle: no allocation.
  void show() noexcept;
  /// Asks the operating system, which no cycle does; each member in its turn.
  void watch(TimePoint now) override;

 private:
  void show_members() noexcept;
  void show_links() noexcept;
  [[nodiscard]] MemberRow status_of(std::uint16_t apid, std::optional<State> state,
                                    const std::optional<MemberStatistics>& statistics,
                                    std::uint8_t configuration) const noexcept;
  [[nodiscard]] LinkRow status_of(const descriptor::MissionLink& link) const noexcept;
  /// What the consumer of a link tells of it.
  void add_consumer(const descriptor::MissionLink& link, LinkRow& status) const noexcept;

  Parts parts_;
  Craft& craft_;
  Parameter<std::uint8_t> mode_;
  struct LinkCounts {
    std::uint32_t up{0};
    std::uint32_t defined{0};
  };
  Parameter<LinkCounts> links_;
  Parameter<Traffic::Rejections> rejections_;
  Parameter<Traffic::Counts> counts_;
  struct Power {
    float budget_w{0};  ///< 0 = not limited
    float reserved_w{0};
  };
  Parameter<Power> power_;
  std::array<std::uint32_t, descriptor::most_status_rows> memory_kb_{};  ///< of each row of members_
  std::size_t memory_turn_{0};
  Parameter<MemberRows> members_;
  Parameter<LinkRows> link_rows_;
  Parameter<LinkQualityRows> link_quality_;
  Parameter<LinkLatencyRows> link_latency_;
};

}  // namespace hirosco::supervisor
