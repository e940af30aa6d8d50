// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "hirosco/descriptor/model/service_list.hpp"
#include "hirosco/utilities/time.hpp"

namespace hirosco {

/// What the steps of each loop of services take (docs/adr/0096) beside what its descriptor promises, as a parameter of every subsystem:
/// LOOP_STATS. By loop, in the order of the descriptor; from its start on.
struct LoopStatistics {
  std::array<float, descriptor::max_service_loops> budget_us{};  ///< in force; 0 = none is declared
  std::array<float, descriptor::max_service_loops>
      longest_us{};  ///< of the processor in one step; 0 where time is virtual
  std::array<std::uint64_t, descriptor::max_service_loops> exceeded{};  ///< steps that took more than the budget
  std::array<std::uint64_t, descriptor::max_service_loops>
      missed{};  ///< steps that were due before the one before had ended
};

/// Counts it: each loop in its own place, whoever tells it reads.
class LoopMeter {
 public:
  explicit LoopMeter(std::span<const descriptor::ServiceLoop> loops) noexcept;
  [[nodiscard]] bool any() const noexcept { return loops_ != 0; }
  /// What its steps are held to from now on.  Realtime: wait-free. Thread: the service loop.
  void promise(std::size_t place, Duration budget) noexcept;
  /// One step of the loop at this place took `used`, and for `missed` others it was too late.
  /// Realtime: wait-free. Thread: that loop's.
  void account(std::size_t place, Duration used, std::uint64_t missed) noexcept;
  /// Realtime: wait-free. Thread: any.
  [[nodiscard]] LoopStatistics statistics() const noexcept;

 private:
  struct Place {
    std::atomic<std::int64_t> budget_ns{0};
    std::atomic<std::int64_t> longest_ns{0};
    std::atomic<std::uint64_t> exceeded{0};
    std::atomic<std::uint64_t> missed{0};
  };
  std::array<Place, descriptor::max_service_loops> places_;
  std::size_t loops_{0};
};

}  // namespace hirosco
