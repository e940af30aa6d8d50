// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/cycle/cycle.hpp"

/// The cycle's part in stopping an actuator: what it looks at before each output (the supervisor's stop, its permission and its
/// heartbeat; what is lost stands in `lost_inputs.cpp`, all reasons are in `pages/inhibition.hpp`), and what an output is while it is inhibited. What stops one that does not
/// obey is the guard's: `supervisor/guard/guard.hpp`. Every way: docs/safety/stops.md.
namespace hirosco {

void CycleLoop::take_permit() noexcept {
  const PermitPage* offered = offered_permit_.load(std::memory_order_acquire);
  if (offered == permit_.load(std::memory_order_relaxed)) return;
  // Only what moves on it from now on is a sign of life.
  heartbeat_ = offered->heartbeat.load(std::memory_order_acquire);
  permit_.store(offered, std::memory_order_release);
}

void CycleLoop::check_permit() noexcept {
  const std::uint32_t epoch = permit().epoch.load(std::memory_order_acquire);
  const bool stopped = permit().stop.load(std::memory_order_acquire) != 0;
  const bool operational = state_ == State::Operational;
  if (stopped || (operational && (epoch != entered_epoch_ || !permit().permits(epoch)))) inhibit(inhibited_by_stop);
  if (silent_cycles_ > silence_limit_) inhibit(inhibited_by_supervisor);
  permitted_epoch_ = epoch;
  parts_.vital.seen_epoch.store(epoch, std::memory_order_relaxed);
}

/// Once a cycle, and in the cycle: a service loop that is stuck or starved must not keep the actuators going when nobody is
/// left to stop them. The state follows in the service loop: `react_to_silence()` of `service_loop/state_machine.cpp`.
void CycleLoop::listen_to_supervisor(bool counts) noexcept {
  const std::uint64_t heartbeat = permit().heartbeat.load(std::memory_order_acquire);
  if (std::exchange(heartbeat_, heartbeat) != heartbeat) {
    silent_cycles_ = 0;
    return;
  }
  if (!counts || silent_cycles_ > silence_limit_) return;
  if (++silent_cycles_ <= silence_limit_) return;
  const double cycles = silent_cycles_;
  raise(descriptor::framework_event::supervisor_silent, {&cycles, 1});
}

LinkStatus CycleLoop::link_status() const noexcept {
  if (state_ == State::ErrorOperational || (inhibited_ & (inhibited_by_failure | inhibited_by_device)) != 0)
    return LinkStatus::Fault;
  return inhibited_ != 0 ? LinkStatus::Degraded : LinkStatus::Valid;
}

void CycleLoop::write_devices() noexcept {
  const bool active = state_ == State::Operational && inhibited_ == 0;
  // Inhibited means the declared safe output; only Error-Operational brings the device to a controlled stop (decision 22).
  const bool stopping = state_ == State::ErrorOperational;
  // The epoch that was checked in this cycle: an output under an older permission must not carry a newer one.
  const auto telling = state_ == State::Operational ? DeviceSlot::Telling::PutOut : DeviceSlot::Telling::Wish;
  for (DeviceSlot& device : plan_.devices) {
    device.write(permitted_epoch_, active, stopping);
    device.tell(telling);
  }
}

void CycleLoop::write_outputs(TimePoint planned) noexcept {
  write_devices();
  // Old data is not sent as new: nobody else's actuator moves on it either, once it is older than its consumer takes.
  const LinkStatus status = link_status();
  if (awaits_device_ && status != LinkStatus::Fault) return;
  for (LinkOutputSlot& output : plan_.outputs) output.write(planned, status);
}

}  // namespace hirosco
