// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/actuator_gate.hpp"

/// The cycle's part in stopping an actuator: what an output is while it is inhibited. What the cycle looks at before each output (the supervisor's
/// stop, its permission and its heartbeat) stands in `permit_watch.cpp`, what is lost in `device_inputs.cpp` and `cycle_inputs.cpp`; all reasons are in
/// `pages/inhibition.hpp`. What stops one that does not obey is the guard's: `supervisor/guard/guard.hpp`. Every way: docs/safety/stops.md.
namespace hirosco {

ActuatorGate::ActuatorGate(const Parts& parts) : parts_{parts} {
  for (const descriptor::Device& device : parts_.descriptor.devices)
    if (device.actuator && !device.output.empty()) outputs_.push_back(std::make_unique<OutputParameter>(device));
}

void ActuatorGate::begin() noexcept {
  for (const auto& output : outputs_) {
    output->clear();
    for (DeviceSlot& slot : parts_.plan.devices)
      if (&slot.device() == &output->device()) slot.output().show_in(output.get());
  }
}

LinkStatus ActuatorGate::link_status() const noexcept {
  const ControlState& control = parts_.control;
  if (control.state() == State::ErrorOperational ||
      (control.inhibited() & (inhibited_by_failure | inhibited_by_device)) != 0)
    return LinkStatus::Fault;
  return control.inhibited() != 0 ? LinkStatus::Degraded : LinkStatus::Valid;
}

void ActuatorGate::write_devices() noexcept {
  const bool active = parts_.control.active();
  // Inhibited means the declared safe output; only Error-Operational brings the device to a controlled stop (decision 22).
  const bool stopping = parts_.control.state() == State::ErrorOperational;
  // The epoch that was checked in this cycle: an output under an older permission must not carry a newer one.
  const std::uint32_t epoch = parts_.permit.checked_epoch();
  const auto telling =
      parts_.control.state() == State::Operational ? OutputPayload::Telling::PutOut : OutputPayload::Telling::Wish;
  for (DeviceSlot& device : parts_.plan.devices) {
    device.write(epoch, active, stopping);
    device.output().tell(telling);
  }
}

void ActuatorGate::write_outputs(TimePoint planned) noexcept {
  write_devices();
  // Old data is not sent as new: nobody else's actuator moves on it either, once it is older than its consumer takes.
  const LinkStatus status = link_status();
  if (parts_.device_inputs.awaits_device() && status != LinkStatus::Fault) return;
  for (LinkOutputSlot& output : parts_.plan.outputs) output.write(planned, status);
}

}  // namespace hirosco
