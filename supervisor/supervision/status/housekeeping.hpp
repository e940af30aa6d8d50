// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/parameter/parameter.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/traffic.hpp"
#include "supervisor/supervision/interfaces.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/realtime_links/links.hpp"
#include "supervisor/supervision/resource_management/power_ledger.hpp"

namespace hirosco::supervisor {

/// What the supervisor tells of itself and of all others in its housekeeping (structures 4701 and 4702 of supervisor.xml).
/// Thread: the supervisor's.
class Housekeeping final : public Watch {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    const Links& links;
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
  [[nodiscard]] const IncomingLink* consumer_of(const descriptor::MissionLink& link) const noexcept;

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
  /// What ground is told of everybody (housekeeping 4702); where a mission has more, only the first.
  static constexpr std::size_t told_members = 16;
  struct SubsystemsStatus {
    std::array<std::uint16_t, told_members> apid{};
    std::array<std::uint8_t, told_members> state{};  ///< 255 = not running
    std::array<std::uint8_t, told_members> configuration{};
    std::array<std::uint8_t, told_members> inhibited{};  ///< bits of Inhibition
    std::array<std::uint32_t, told_members> cycles{};
    std::array<std::uint32_t, told_members> overruns{};
    std::array<std::uint32_t, told_members> missed{};
    std::array<std::uint32_t, told_members> latency_max_ns{};
    std::array<std::uint32_t, told_members> execution_mean_ns{};
    std::array<std::uint32_t, told_members> memory_kb{};
  };
  std::array<std::uint32_t, told_members> memory_kb_{};  ///< in the order of subsystems_
  std::size_t memory_turn_{0};
  Parameter<SubsystemsStatus> subsystems_;
  struct LinksStatus {
    std::array<std::uint8_t, told_members> link{};
    std::array<std::uint8_t, told_members> up{};
    std::array<std::uint32_t, told_members> samples{};
    std::array<std::uint32_t, told_members> age_us{};
    std::array<std::uint32_t, told_members> lost{};
    std::array<std::uint32_t, told_members> latency_mean_ns{};
    std::array<std::uint32_t, told_members> latency_max_ns{};
  };
  Parameter<LinksStatus> link_status_;
};

}  // namespace hirosco::supervisor
