// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/cycle_inputs.hpp"

#include <algorithm>

/// What the cycle does about a link that is lost: one that is required or made (`link_slots.cpp` says when) is told as NAME_STALE, medium
/// severity, and inhibits the actuators unless its absence is held over. What becomes of a lost device stands in `device_inputs.cpp`, what inhibited
/// means for an output in `actuator_gate.cpp`, `write_outputs()`. From there on it is the supervisor's (`supervision/event_handling/`): Safe-Operational,
/// where no plan of the mission says otherwise; of a link that the mission gives `on_loss`, `link_losses.cpp` decides instead.
namespace hirosco {
namespace {
void judge(VitalPage& page, std::size_t place, LinkJudgement judgement) noexcept {
  if (place < page.judged.size()) page.judged[place].store(judgement, std::memory_order_relaxed);
}
}  // namespace

void CycleInputs::begin() {
  input_was_stale_.assign(parts_.plan.inputs.size(), 0);
  const auto starts = std::ranges::find_if(parts_.plan.inputs, [](const auto& input) { return input.terms().starts; });
  starter_.reset();
  if (starts != parts_.plan.inputs.end()) starter_ = static_cast<std::size_t>(starts - parts_.plan.inputs.begin());
  parts_.devices.begin();
  for (auto& judged : parts_.vital.judged) judged.store(link_not_judged, std::memory_order_relaxed);
}

void CycleInputs::read(TimePoint started, bool counts) noexcept {
  // Passes by itself: with the first answer of a device or of its fall-back, or the first good sample of a slower producer, which are
  // no old data.
  parts_.control.clear_awaited();
  read_links(started, counts);
  parts_.devices.read(counts);
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

}  // namespace hirosco
