// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include <array>

#include "hirosco/subsystem/cycle/cycle.hpp"

/// The cycle reads its inputs, and what it does about one that is lost: a device (`device_slot.cpp` says when; one that has another endnode
/// falls back to that first, told as NAME_FALL_BACK) inhibits the actuators and is told as NAME_LOST, high severity; a link that is required
/// or made (`link_slots.cpp`) is told as NAME_STALE, medium, and inhibits unless its absence is held over. What inhibited means for an output stands in `actuator_gate.cpp`, `write_outputs()`.
/// From there on it is the supervisor's (`supervision/event_handling/`): `reactions.cpp` hears the event, `plan_choice.cpp`
/// finds the plan of the mission or, without one, that of the severity, and `procedures/steps/` act: `shut_down_network` for
/// high, `set_state` to Safe-Operational for medium. Of a link that the mission gives `on_loss`, `link_losses.cpp` decides instead.
namespace hirosco {
namespace {
constexpr unsigned reason_shift = 16;
}

std::optional<CycleLoop::NeverAnswered> CycleLoop::never_answered() const noexcept {
  const std::uint32_t told = never_answered_.load(std::memory_order_relaxed);
  if (told == 0) return std::nullopt;
  return NeverAnswered{static_cast<std::uint16_t>(told - 1), static_cast<descriptor::DeviceLoss>(told >> reason_shift)};
}

void CycleLoop::read_inputs(TimePoint started, bool counts) noexcept {
  // Passes by itself: with the first answer of a device or of its fall-back, or the first good sample of a slower producer, which are
  // no old data.
  inhibited_ &= ~static_cast<std::uint32_t>(inhibited_while_awaited);
  for (std::size_t i = 0; i < plan_.inputs.size(); ++i) {
    LinkInputSlot& input = plan_.inputs[i];
    input.read(started, counts);
    const bool inhibits = input.terms().missing == descriptor::MissingPolicy::Inhibit;
    if (input.awaits_first(controlling(), counts)) {
      if (inhibits) inhibit(inhibited_while_awaited);
      continue;
    }
    const bool stale = controlling() && input.stale() && (input.attached() || input.terms().required);
    if (stale && inhibits) inhibit(inhibited_by_link);
    if (stale && !input.ended() && input_was_stale_[i] == 0) {
      const double age = input.port()->age_cycles();
      raise(plan_.input_stale_events[i], {&age, 1});
    }
    input_was_stale_[i] = stale ? 1 : 0;
  }
  awaits_device_ = false;
  bool awaits_first = false;
  for (std::size_t i = 0; i < plan_.devices.size(); ++i) {
    DeviceSlot& device = plan_.devices[i];
    device.read(controlling(), counts);
    awaits_first = awaits_first || device.awaits_first();
    awaits_device_ = awaits_device_ || device.awaits() || device.awaits_first();
    if (device.holds_back() || (controlling() && device.awaits_first())) inhibit(inhibited_while_awaited);
    else if (!device.alive() && controlling()) inhibit(inhibited_by_device);
    if (device.just_fell_back()) {
      const std::array arguments{static_cast<double>(device.loss().reason), static_cast<double>(device.left()),
                                 static_cast<double>(device.taken()), static_cast<double>(device.times_fallen_back())};
      raise(plan_.fell_back_events[i], arguments);
    }
    if (!device.just_lost()) continue;
    end_self_test(self_test_.lose_device(static_cast<std::int64_t>(i)));
    const DeviceSlot::Loss loss = device.loss();
    if (device.never_heard() && never_answered_.load(std::memory_order_relaxed) == 0) {
      const auto index = static_cast<std::uint32_t>(&device.device() - parts_.descriptor.devices.data());
      never_answered_.store((index + 1) | (static_cast<std::uint32_t>(loss.reason) << reason_shift),
                            std::memory_order_relaxed);
    }
    const std::array arguments{static_cast<double>(loss.reason), static_cast<double>(loss.silent_cycles),
                               static_cast<double>(loss.damaged), static_cast<double>(loss.wrong_size)};
    raise(plan_.device_lost_events[i], arguments);
  }
  awaits_first_answer_.store(awaits_first, std::memory_order_release);
}

}  // namespace hirosco
