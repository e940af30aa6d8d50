// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/cycle/budget_watch.hpp"
#include "hirosco/subsystem/cycle/link_slots.hpp"
#include "hirosco/subsystem/cycle/loop_meter.hpp"
#include "hirosco/subsystem/cycle/overrun_watch.hpp"
#include "hirosco/subsystem/cycle/realtime_watch.hpp"
#include "hirosco/subsystem/cycle/report_writer.hpp"
#include "hirosco/subsystem/cycle/resource_meter.hpp"
#include "hirosco/subsystem/pages/pages.hpp"

namespace hirosco {

/// Cycle statistics as a parameter of every subsystem: CYCLE_STATS (descriptor/model/framework_parameters.hpp).
struct CycleStatistics {
  std::uint32_t overruns{0};
  float max_us{0.0F};  ///< longest execution since the configuration was applied
  float avg_us{0.0F};  ///< mean over about the last 1,000 cycles
};

/// Where the cycles of a configuration fell, as a parameter of every subsystem: CYCLE_TIMES. Bin 0: below 1 us; bin i:
/// from 2^(i-1) us to below 2^i us; the last one: all above.
struct CycleTimes {
  std::array<std::uint32_t, 16> execution{};  ///< of the cycle's own work
  std::array<std::uint32_t, 16> latency{};  ///< from the planned instant to the start
};

/// What the real-time links brought since they were made, as a parameter of every subsystem: LINK_STATS.
struct LinkStatistics {
  std::uint32_t received{0};
  std::uint32_t lost{0};  ///< samples that came and went between two cycles: gaps of the count
};

/// What each cycle took, and what its links brought: holds it to what its descriptor promises, and tells it in parameters of every
/// subsystem and in the vital page. Thread: the cycle's, where nothing else is said.
class CycleMeter {
 public:
  struct Parts {
    const Clock& clock;
    const LoopRings& rings;
    VitalPage& vital;
    bool realtime;
    const ResourceMeter& resources;
    const LoopMeter& loops;
    ReportWriter& reports;
  };
  explicit CycleMeter(const Parts& parts) : parts_{parts} {}

  /// Another configuration: all but links is counted anew. `spin`: what it may spin away before each cycle, and what its platform lets it.
  /// Realtime: wait-free.
  void begin(const descriptor::Configuration& configuration, Duration spin) noexcept;
  /// Other links. Thread: service, while the cycle rests.
  void begin_links() noexcept;
  /// What the service loop has used of the heap, for HEAP_USES.  Realtime: wait-free. Thread: any.
  void note_service_heap(std::uint64_t uses) noexcept { service_heap_.store(uses, std::memory_order_relaxed); }

  /// Before account(), of a cycle that has spun for so long.  Realtime: wait-free.
  void account_spin(Duration spun) noexcept { budget_.account_spin(spun); }
  /// What real time forbids and this cycle did: told where it is to be.  Realtime: wait-free.
  void hold_to_realtime(const RealtimeUses& of_cycle) noexcept;
  /// One cycle.
  struct Taken {
    Duration execution;  ///< of its own work
    Duration latency;  ///< until it began: from when it was due, or from the sample that started it
    Duration late;  ///< from when it was due to when it began
    std::uint64_t count;  ///< since the configuration was applied, from 1 on
    std::uint32_t inhibited;  ///< bits of Inhibition
  };
  /// At its end.  Realtime: bounded by the links, no allocation, one system call for the thread's processor time.
  void account(const Taken& cycle, std::span<LinkInputSlot> inputs) noexcept;

  [[nodiscard]] Parameter<CycleStatistics>& statistics() noexcept { return statistics_; }
  [[nodiscard]] Parameter<CycleTimes>& times() noexcept { return times_parameter_; }
  [[nodiscard]] Parameter<CycleBudget>& budget() noexcept { return budget_parameter_; }
  [[nodiscard]] Parameter<CycleSpin>& spin() noexcept { return spin_parameter_; }
  [[nodiscard]] Parameter<LinkStatistics>& link_statistics() noexcept { return link_statistics_; }
  [[nodiscard]] Parameter<ResourceStatistics>& resource_statistics() noexcept { return resource_statistics_; }
  [[nodiscard]] Parameter<LoopStatistics>& loop_statistics() noexcept { return loop_statistics_; }
  [[nodiscard]] Parameter<HeapUses>& heap_uses() noexcept { return heap_uses_; }

 private:
  void count_links(std::span<LinkInputSlot> inputs) noexcept;
  void hold_to_budget() noexcept;
  void tell_vital(std::uint32_t inhibited) noexcept;

  Parts parts_;
  Parameter<CycleStatistics> statistics_;
  Parameter<CycleTimes> times_parameter_;
  Parameter<CycleBudget> budget_parameter_;
  Parameter<CycleSpin> spin_parameter_;
  Parameter<LinkStatistics> link_statistics_;
  Parameter<ResourceStatistics> resource_statistics_;
  Parameter<LoopStatistics> loop_statistics_;
  Parameter<HeapUses> heap_uses_;
  std::atomic<std::uint64_t> service_heap_{0};
  std::uint32_t latency_max_ns_{0};
  std::uint32_t execution_max_ns_{0};
  double execution_mean_ns_{0.0};
  CycleTimes times_{};
  Duration spin_{};
  BudgetWatch budget_;
  OverrunWatch overruns_;
  RealtimeWatch realtime_;
};

}  // namespace hirosco
