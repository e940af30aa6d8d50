// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/cycle_meter.hpp"

#include <algorithm>
#include <bit>

#include "hirosco/descriptor/model/framework_events.hpp"

namespace hirosco {
namespace {

/// Bin of CycleTimes.
std::size_t bin_of(Duration span) noexcept {
  constexpr std::int64_t ns_per_us = 1000;
  const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(span.count() / ns_per_us, 0));
  return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(us)), CycleTimes{}.execution.size() - 1);
}

}  // namespace

void CycleMeter::begin(const descriptor::Configuration& configuration, Duration spin) noexcept {
  overruns_.begin(configuration, parts_.realtime);
  latency_max_ns_ = 0;
  execution_max_ns_ = 0;
  execution_mean_ns_ = 0.0;
  times_ = {};
  statistics_.store({});
  times_parameter_.store({});
  spin_ = spin;
  budget_.begin(configuration, parts_.realtime, spin);
  realtime_.begin(configuration.shortest());
  budget_parameter_.store(budget_.told());
  spin_parameter_.store(budget_.told_spin());
}

void CycleMeter::begin_links() noexcept {
  link_statistics_.store({});
  for (IncomingLink& page : parts_.vital.incoming) page.link.store(0, std::memory_order_relaxed);
}

void CycleMeter::count_links(std::span<LinkInputSlot> inputs) noexcept {
  LinkStatistics sum;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    LinkInputSlot& input = inputs[i];
    if (i < parts_.vital.incoming.size()) {
      input.tell(parts_.vital.incoming[i]);
      input.tell(parts_.vital.latencies[i]);
    }
    sum.received += static_cast<std::uint32_t>(input.port()->received());
    sum.lost += static_cast<std::uint32_t>(input.port()->lost());
  }
  link_statistics_.store(sum);
}

void CycleMeter::account(const Taken& cycle, std::span<LinkInputSlot> inputs) noexcept {
  latency_max_ns_ = std::max(latency_max_ns_, clamped_ns(cycle.latency));
  execution_max_ns_ = std::max(execution_max_ns_, clamped_ns(cycle.execution));
  constexpr double weight = 1e-3;
  execution_mean_ns_ += weight * (static_cast<double>(cycle.execution.count()) - execution_mean_ns_);

  ++times_.execution[bin_of(cycle.execution)];
  ++times_.latency[bin_of(cycle.latency)];
  times_parameter_.store(times_);
  count_links(inputs);
  hold_to_budget();
  // They change slowly and are many words: not in each cycle.
  constexpr std::uint64_t cycles_between = 16;
  if (cycle.count % cycles_between == 1) {
    resource_statistics_.store(parts_.resources.statistics());
    heap_uses_.store(
        {realtime_.sum().heap, service_heap_.load(std::memory_order_relaxed), RealtimeScope::hook_present()});
  }
  if (cycle.count % cycles_between == 2 && parts_.loops.any()) loop_statistics_.store(parts_.loops.statistics());

  if (overruns_.account(cycle.execution, cycle.late)) {
    const double row = overruns_.in_a_row();
    parts_.reports.raise(descriptor::framework_event::cycle_overruns, {&row, 1});
  }

  statistics_.store({static_cast<std::uint32_t>(overruns_.count()), static_cast<float>(execution_max_ns_) * 1e-3F,
                     static_cast<float>(execution_mean_ns_ * 1e-3)});
  tell_vital(cycle.inhibited);
}

void CycleMeter::tell_vital(std::uint32_t inhibited) noexcept {
  VitalPage& vital = parts_.vital;
  if (inhibited != 0 && vital.inhibited.load(std::memory_order_relaxed) == 0)
    vital.inhibited_at_cycle.store(vital.cycles.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  vital.inhibited.store(inhibited, std::memory_order_relaxed);
  vital.overruns.store(overruns_.count(), std::memory_order_relaxed);
  vital.latency_max_ns.store(latency_max_ns_, std::memory_order_relaxed);
  vital.execution_max_ns.store(execution_max_ns_, std::memory_order_relaxed);
  vital.execution_mean_ns.store(static_cast<std::uint32_t>(execution_mean_ns_), std::memory_order_relaxed);
  vital.lost_reports.store(static_cast<std::uint32_t>(parts_.rings.dropped()), std::memory_order_relaxed);
  vital.cycles.fetch_add(1, std::memory_order_release);
}

void CycleMeter::hold_to_budget() noexcept {
  if (budget_.account(parts_.clock.processor())) {
    const std::array<double, 2> told{static_cast<double>(budget_.in_a_row()), double{budget_.told().longest_us}};
    parts_.reports.raise(descriptor::framework_event::cycle_over_budget, told);
  }
  budget_parameter_.store(budget_.told());
  if (spin_ != Duration{}) spin_parameter_.store(budget_.told_spin());
}

void CycleMeter::hold_to_realtime(const RealtimeUses& of_cycle) noexcept {
  if (!realtime_.account(of_cycle)) return;
  const RealtimeUses& sum = realtime_.sum();
  const std::array<double, 3> told{static_cast<double>(sum.heap), static_cast<double>(sum.locks),
                                   static_cast<double>(sum.outputs)};
  parts_.reports.raise(descriptor::framework_event::cycle_not_realtime, told);
}

}  // namespace hirosco
