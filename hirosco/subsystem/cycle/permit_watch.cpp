// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/permit_watch.hpp"

#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/pages/supervisor_silence.hpp"

namespace hirosco {

void PermitWatch::take_offered() noexcept {
  const PermitPage* offered = offered_page_.load(std::memory_order_acquire);
  if (offered == page_.load(std::memory_order_relaxed)) return;
  // Only what moves on it from now on is a sign of life.
  heartbeat_ = offered->heartbeat.load(std::memory_order_acquire);
  page_.store(offered, std::memory_order_release);
}

void PermitWatch::begin() noexcept {
  heartbeat_ = page().heartbeat.load(std::memory_order_acquire);
  silent_cycles_ = 0;
}

void PermitWatch::follow(Duration sampling) noexcept { silence_limit_ = supervisor_silence_cycles(sampling); }

void PermitWatch::check() noexcept {
  const std::uint32_t epoch = page().epoch.load(std::memory_order_acquire);
  const bool stopped = page().stop.load(std::memory_order_acquire) != 0;
  const bool operational = parts_.control.state() == State::Operational;
  if (stopped || (operational && (epoch != entered_epoch_ || !page().permits(epoch))))
    parts_.control.inhibit(inhibited_by_stop);
  if (silent_cycles_ > silence_limit_) parts_.control.inhibit(inhibited_by_supervisor);
  permitted_epoch_ = epoch;
  parts_.vital.seen_epoch.store(epoch, std::memory_order_relaxed);
}

/// Once a cycle, and in the cycle: a service loop that is stuck or starved must not keep the actuators going when nobody is
/// left to stop them. The state follows in the service loop: `react_to_silence()` of `service_loop/state_machine.cpp`.
void PermitWatch::listen(bool counts) noexcept {
  const std::uint64_t heartbeat = page().heartbeat.load(std::memory_order_acquire);
  if (std::exchange(heartbeat_, heartbeat) != heartbeat) {
    silent_cycles_ = 0;
    return;
  }
  if (!counts || silent_cycles_ > silence_limit_) return;
  if (++silent_cycles_ <= silence_limit_) return;
  const double cycles = silent_cycles_;
  parts_.reports.raise(descriptor::framework_event::supervisor_silent, {&cycles, 1});
}

void PermitWatch::enter_operational() noexcept { entered_epoch_ = page().epoch.load(std::memory_order_acquire); }

bool PermitWatch::permits() const noexcept {
  return page().stop.load(std::memory_order_acquire) == 0 &&
         page().permits(page().epoch.load(std::memory_order_acquire));
}

}  // namespace hirosco
