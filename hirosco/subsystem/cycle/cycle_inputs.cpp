// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/cycle_inputs.hpp"

#include <algorithm>
#include <array>

/// What the cycle does about an input that is lost: a device (`device_slot.cpp` says when; one that has another endnode
/// falls back to that first, told as NAME_FALL_BACK) inhibits the actuators and is told as NAME_LOST, high severity; a link that is required
/// or made (`link_slots.cpp`) is told as NAME_STALE, medium, and inhibits unless its absence is held over. What inhibited means for an output stands in `actuator_gate.cpp`, `write_outputs()`.
/// From there on it is the supervisor's (`supervision/event_handling/`): `reactions.cpp` hears the event, `plan_choice.cpp`
/// finds the plan of the mission or, without one, that of the severity, and `procedures/steps/` act: `shut_down_network` for
/// high, `set_state` to Safe-Operational for medium. Of a link that the mission gives `on_loss`, `link_losses.cpp` decides instead.
namespace hirosco {
namespace {
constexpr unsigned reason_shift = 16;

void judge(VitalPage& page, std::size_t place, LinkJudgement judgement) noexcept {
  if (place < page.judged.size()) page.judged[place].store(judgement, std::memory_order_relaxed);
}
}  // namespace

void CycleInputs::begin() {
  input_was_stale_.assign(parts_.plan.inputs.size(), 0);
  const auto starts = std::ranges::find_if(parts_.plan.inputs, [](const auto& input) { return input.terms().starts; });
  starter_.reset();
  if (starts != parts_.plan.inputs.end()) starter_ = static_cast<std::size_t>(starts - parts_.plan.inputs.begin());
  awaits_device_ = false;
  awaits_first_answer_.store(!parts_.plan.devices.empty(), std::memory_order_relaxed);
  never_answered_.store(0, std::memory_order_relaxed);
  for (auto& judged : parts_.vital.judged) judged.store(link_not_judged, std::memory_order_relaxed);
}

std::optional<CycleInputs::NeverAnswered> CycleInputs::never_answered() const noexcept {
  const std::uint32_t told = never_answered_.load(std::memory_order_relaxed);
  if (told == 0) return std::nullopt;
  return NeverAnswered{static_cast<std::uint16_t>(told - 1), static_cast<descriptor::DeviceLoss>(told >> reason_shift)};
}

void CycleInputs::read(TimePoint started, bool counts) noexcept {
  // Passes by itself: with the first answer of a device or of its fall-back, or the first good sample of a slower producer, which are
  // no old data.
  parts_.control.clear_awaited();
  read_links(started, counts);
  read_devices(counts);
}

void CycleInputs::read_links(TimePoint started, bool counts) noexcept {
  ControlState& control = parts_.control;
  for (std::size_t i = 0; i < parts_.plan.inputs.size(); ++i) {
    LinkInputSlot& input = parts_.plan.inputs[i];
    input.read(started, counts);
    const bool inhibits = input.terms().missing == descriptor::MissingPolicy::Inhibit;
    if (input.awaits_first(control.controlling(), counts)) {
      if (inhibits) control.inhibit(inhibited_while_awaited);
      judge(parts_.vital, i, link_not_judged);
      continue;
    }
    const bool stale = control.controlling() && input.stale() && (input.attached() || input.terms().required);
    if (stale && inhibits) control.inhibit(inhibited_by_link);
    // Ahead of the event: who hears that must not find here what held before.
    judge(parts_.vital, i, stale ? link_stale : input.stale() ? link_not_judged : link_valid);
    if (stale && !input.ended() && input_was_stale_[i] == 0) {
      const double age = input.port()->age_cycles();
      parts_.reports.raise(parts_.plan.input_stale_events[i], {&age, 1});
    }
    input_was_stale_[i] = stale ? 1 : 0;
  }
}

void CycleInputs::read_devices(bool counts) noexcept {
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
    if (device.just_fell_back()) {
      const std::array arguments{static_cast<double>(device.loss().reason), static_cast<double>(device.left()),
                                 static_cast<double>(device.taken()), static_cast<double>(device.times_fallen_back())};
      parts_.reports.raise(parts_.plan.fell_back_events[i], arguments);
    }
    if (!device.just_lost()) continue;
    parts_.self_test.lose_device(static_cast<std::int64_t>(i));
    const DeviceSlot::Loss loss = device.loss();
    if (device.never_heard() && never_answered_.load(std::memory_order_relaxed) == 0) {
      const auto index = static_cast<std::uint32_t>(&device.device() - parts_.descriptor.devices.data());
      never_answered_.store((index + 1) | (static_cast<std::uint32_t>(loss.reason) << reason_shift),
                            std::memory_order_relaxed);
    }
    const std::array arguments{static_cast<double>(loss.reason), static_cast<double>(loss.silent_cycles),
                               static_cast<double>(loss.damaged), static_cast<double>(loss.wrong_size)};
    parts_.reports.raise(parts_.plan.device_lost_events[i], arguments);
  }
  awaits_first_answer_.store(awaits_first, std::memory_order_release);
}

}  // namespace hirosco
