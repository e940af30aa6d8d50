// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "hirosco/subsystem/pages/pages.hpp"

namespace hirosco {

/// What the service loop tells the thread of the cycle: to cycle, or to rest; and whether it does rest.
class CycleOrders {
 public:
  explicit CycleOrders(VitalPage& vital) : vital_{vital} {}

  // --- the service loop ------------------------------------------------------------------------------------------------
  /// A configuration was prepared for it.
  void want() noexcept;
  void rest() noexcept;
  [[nodiscard]] bool wanted() const noexcept { return wanted_.load(std::memory_order_relaxed); }
  /// Nothing of a configuration is in use by the cycle.
  [[nodiscard]] bool rests() const noexcept;

  // --- the cycle's thread ----------------------------------------------------------------------------------------------
  struct Order {
    bool wanted{false};
    std::uint32_t generation{0};  ///< rises with every new configuration
    /// Of the newest order to rest: goes back with parked(), also when the cycle was wanted and called off again
    /// before its thread could see it.
    std::uint32_t ticket{0};
  };
  /// The service loop may look, too.  Realtime: wait-free.
  [[nodiscard]] Order order() const noexcept;
  /// It has seen that no cycle is wanted and rests.  Realtime: wait-free.
  void parked(std::uint32_t ticket) noexcept;

 private:
  VitalPage& vital_;
  std::atomic<bool> wanted_{false};
  // A late answer to an earlier order must not pass for one to the newest: orders to rest are numbered.
  std::atomic<std::uint32_t> rest_ticket_{0};
  std::atomic<std::uint32_t> parked_ticket_{0};
  std::uint32_t generation_{0};
};

}  // namespace hirosco
