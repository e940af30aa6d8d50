// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/device_inputs.hpp"

#include <array>

/// The reaction to a lost device begins here. When it is lost says `device_slot.cpp`; one that has another endnode falls back to that first,
/// told as NAME_FALL_BACK. A lost one inhibits the actuators in Safe-Operational and Operational and is told as NAME_LOST, high severity, in
/// each state. What inhibited means for an output stands in `actuator_gate.cpp`, `write_outputs()`.
/// From there on it is the supervisor's (`supervision/event_handling/`): `reactions.cpp` hears the event, `plan_choice.cpp` finds the plan of
/// the mission or, without one, that of the severity, and `procedures/steps/` act: `shut_down_network` for high.
namespace hirosco {
namespace {
constexpr unsigned reason_shift = 16;
}  // namespace

void DeviceInputs::begin() noexcept {
  awaits_device_ = false;
  awaits_first_answer_.store(!parts_.plan.devices.empty(), std::memory_order_relaxed);
  never_answered_.store(0, std::memory_order_relaxed);
}

std::optional<DeviceInputs::NeverAnswered> DeviceInputs::never_answered() const noexcept {
  const std::uint32_t told = never_answered_.load(std::memory_order_relaxed);
  if (told == 0) return std::nullopt;
  return NeverAnswered{static_cast<std::uint16_t>(told - 1), static_cast<descriptor::DeviceLoss>(told >> reason_shift)};
}

void DeviceInputs::read(bool counts) noexcept {
  ControlState& control = parts_.control;
  awaits_device_ = false;
  bool awaits_first = false;
  for (std::size_t i = 0; i < parts_.plan.devices.size(); ++i) {
    DeviceSlot& device = parts_.plan.devices[i];
    device.read(control.controlling(), counts);
    awaits_first = awaits_first || device.awaits_first();
    awaits_device_ = awaits_device_ || device.awaits() || device.awaits_first();
    if (device.holds_back() || (control.controlling() && device.awaits_first()))
      control.inhibit(inhibited_while_awaited);
    else if (!device.alive() && control.controlling()) control.inhibit(inhibited_by_device);
    if (device.just_fell_back()) tell_fall_back(i);
    if (device.just_lost()) lose(i);
  }
  awaits_first_answer_.store(awaits_first, std::memory_order_release);
}

void DeviceInputs::tell_fall_back(std::size_t device) noexcept {
  const DeviceSlot& slot = parts_.plan.devices[device];
  const std::array arguments{static_cast<double>(slot.loss().reason), static_cast<double>(slot.left()),
                             static_cast<double>(slot.taken()), static_cast<double>(slot.times_fallen_back())};
  parts_.reports.raise(parts_.plan.fell_back_events[device], arguments);
}

void DeviceInputs::lose(std::size_t device) noexcept {
  const DeviceSlot& slot = parts_.plan.devices[device];
  parts_.self_test.lose_device(static_cast<std::int64_t>(device));
  const DeviceSlot::Loss loss = slot.loss();
  if (slot.never_heard() && never_answered_.load(std::memory_order_relaxed) == 0) {
    const auto index = static_cast<std::uint32_t>(&slot.device() - parts_.descriptor.devices.data());
    never_answered_.store((index + 1) | (static_cast<std::uint32_t>(loss.reason) << reason_shift),
                          std::memory_order_relaxed);
  }
  const std::array arguments{static_cast<double>(loss.reason), static_cast<double>(loss.silent_cycles),
                             static_cast<double>(loss.damaged), static_cast<double>(loss.wrong_size)};
  parts_.reports.raise(parts_.plan.device_lost_events[device], arguments);
}

}  // namespace hirosco
