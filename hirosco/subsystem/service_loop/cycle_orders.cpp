// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include "hirosco/subsystem/service_loop/cycle_orders.hpp"

namespace hirosco {

void CycleOrders::want() noexcept {
  ++generation_;
  vital_.cycling.store(1, std::memory_order_release);
  wanted_.store(true, std::memory_order_release);
}

void CycleOrders::rest() noexcept {
  if (!wanted()) return;
  rest_ticket_.fetch_add(1, std::memory_order_release);
  wanted_.store(false, std::memory_order_release);
}

bool CycleOrders::rests() const noexcept {
  return !wanted() && parked_ticket_.load(std::memory_order_acquire) == rest_ticket_.load(std::memory_order_relaxed);
}

CycleOrders::Order CycleOrders::order() const noexcept {
  Order order{.wanted = wanted_.load(std::memory_order_acquire)};
  order.ticket = rest_ticket_.load(std::memory_order_acquire);
  if (order.wanted) order.generation = generation_;
  return order;
}

void CycleOrders::parked(std::uint32_t ticket) noexcept {
  // Told by who rests, not by who ordered it: one that spins after the order is watched until it is ended. Once for a
  // ticket: with that the next configuration may have begun.
  if (parked_ticket_.load(std::memory_order_relaxed) == ticket) return;
  vital_.cycling.store(0, std::memory_order_release);
  parked_ticket_.store(ticket, std::memory_order_release);
}

}  // namespace hirosco
