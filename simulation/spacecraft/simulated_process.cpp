// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_process.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>

namespace hirosco::simulation {
namespace {

template <class Page>
[[nodiscard]] Mapping mapping_of(const std::shared_ptr<Page>& page) {
  return {page, {reinterpret_cast<std::byte*>(page.get()), sizeof(Page)}};
}

}  // namespace

SimulatedProcess::SimulatedProcess(const descriptor::MissionSubsystem& described, std::string version,
                                   std::unique_ptr<Subsystem> author, Platform platform)
    : described_{described},
      version_{std::move(version)},
      author_{std::move(author)},
      clock_{platform.clock},
      channels_{described.subsystem.resources.channel_kb.value_or(ChannelPair::default_capacity)},
      vital_{std::make_shared<VitalPage>()},
      permit_{std::make_shared<PermitPage>()},
      service_wake_{platform.clock.now()} {
  const Platform around{.clock = clock_,
                        .memory = platform.memory,
                        .flows = platform.flows,
                        .realtime = platform.realtime,
                        .explain = std::move(platform.explain),
                        .links = platform.links,
                        .read_again = [this, changes = descriptor::changes_of(described)](std::string_view text) {
                          return descriptor::read_again(described_.subsystem, text, changes);
                        }};
  engine_.emplace(*author_, described.subsystem, around, channels_.subsystem_end(), *vital_, *permit_);
  for (std::size_t i = 0; i < engine_->own_loops(); ++i)
    loop_wakes_.push_back(service_wake_ + engine_->own_loop(i).in_force().period);
}

Mapping SimulatedProcess::vital_memory() const { return mapping_of(vital_); }
Mapping SimulatedProcess::permit_memory() const { return mapping_of(permit_); }

// --- its loops ---------------------------------------------------------------------------------------------------------

TimePoint SimulatedProcess::own_loops_due() const noexcept {
  TimePoint due = never;
  for (std::size_t i = 0; i < loop_wakes_.size() && runs(); ++i) due = std::min(due, own_loop_due(i));
  return due;
}

/// Another configuration may have made it due sooner.
TimePoint SimulatedProcess::own_loop_due(std::size_t loop) const noexcept {
  return engine_->own_loop(loop).due(loop_wakes_[loop]);
}

void SimulatedProcess::step_service(TimePoint now) {
  service_wake_ = engine_->service_step(now);
  const auto demand = engine_->cycle_demand();
  if (demand.wanted && !cycling_) {
    cycling_ = true;
    cycle_wake_ = now + demand.period;
  } else if (!demand.wanted && !cycling_) {
    engine_->cycle_parked(demand.ticket);
  }
  if (!engine_->finished()) return;
  end_ = supervisor::ProcessEnd{};
  engine_.reset();
  channels_.close_subsystem_end();
}

bool SimulatedProcess::step_cycle() {
  const auto demand = engine_->cycle_demand();
  if (!demand.wanted) {
    engine_->cycle_parked(demand.ticket);
    cycling_ = false;
    cycle_wake_ = never;
    return false;
  }
  if (strained_cycles_ > 0) {
    --strained_cycles_;
    clock_.begin(cycle_takes_);
  }
  cycle_wake_ = engine_->cycle_step(cycle_wake_);
  clock_.end();
  return true;
}

void SimulatedProcess::step_own_loops(TimePoint now) {
  for (std::size_t i = 0; i < loop_wakes_.size() && runs(); ++i)
    if (own_loop_due(i) <= now) loop_wakes_[i] = engine_->own_loop_step(i, loop_wakes_[i]);
}

void SimulatedProcess::wake_cycle(TimePoint now) noexcept {
  if (!lives() || !cycling_) return;
  const CycleWait wait = engine_->cycle_wait();
  if (wait.arrived()) cycle_wake_ = std::min(cycle_wake_, std::max(wait.earliest, now));
}

// --- what can happen to it -----------------------------------------------------------------------------------------------

void SimulatedProcess::kill() {
  if (end_) return;
  constexpr int killed = 9;
  end_ = supervisor::ProcessEnd{true, killed};
  engine_.reset();
  author_.reset();  // with all that it holds, as the end of a process takes it
  channels_.close_subsystem_end();
}

void SimulatedProcess::spin(TimePoint now) noexcept {
  spinning_ = true;
  spins_since_ = now;
}

void SimulatedProcess::call_spin_off() noexcept {
  if (!cycling_) spinning_ = false;
}

void SimulatedProcess::strain(int cycles, Duration takes) noexcept {
  strained_cycles_ = cycles;
  cycle_takes_ = takes;
}

bool SimulatedProcess::send(Octets packet) {
  const std::uint32_t known_stop = newest_permit().newest_stop.load(std::memory_order_acquire);
  return channels_.subsystem_end().send({.epoch = known_stop, .packet = packet}).has_value();
}

}  // namespace hirosco::simulation
