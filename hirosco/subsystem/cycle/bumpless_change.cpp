// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/bumpless_change.hpp"

#include <utility>

namespace hirosco {

/// Whether it may be: the guard, the second inhibit and the state are asked in the cycle, as it is taken over there.
const char* BumplessChange::why_not(const Reconfiguration& wanted) const noexcept {
  if (parts_.plan.configuration != wanted.from) return "another configuration is in force";
  if (!parts_.control.controlling()) return "neither Safe-Operational nor Operational";
  if (parts_.self_test.running()) return "a self test runs";
  const bool permitted = parts_.permit.permits();
  if (parts_.control.state() == State::Operational && (!permitted || parts_.control.inhibited() != 0))
    return "the actuators are inhibited";
  return nullptr;
}

bool BumplessChange::begin(Reconfiguration& wanted, TimePoint planned) noexcept {
  const auto refuse = [&](const Error& why) {
    parts_.reports.explain({.kind = ReportKind::NotReconfigured, .index = wanted.to->id}, why);
    return false;
  };
  if (const char* const why = why_not(wanted)) return refuse({ErrorCode::NotPermitted, why});
  if (const auto set = wanted.set_values(parts_.dictionary); !set) return refuse(set.error());
  const Cycle cycle{.planned = planned,
                    .period = wanted.to->sampling,
                    .count = 0,
                    .state = parts_.control.state(),
                    .first = false,
                    .active = parts_.control.state() == State::Operational};
  if (const auto taken = parts_.author.bumpless(*wanted.from, *wanted.to, cycle); !taken) {
    wanted.restore_values(parts_.dictionary);
    return refuse(taken.error());
  }
  parts_.plan.configuration = wanted.to;
  parts_.plan.sampler = wanted.sampler;
  for (DeviceSlot& device : parts_.plan.devices) device.follow(wanted.to->sampling);
  for (LinkInputSlot& input : parts_.plan.inputs) input.follow(wanted.to->sampling);
  taken_over_ = &wanted;
  return true;
}

void BumplessChange::end() noexcept {
  const Reconfiguration* const taken = std::exchange(taken_over_, nullptr);
  if (taken == nullptr) return;
  const bool active = parts_.control.active();
  for (DeviceSlot& device : parts_.plan.devices) {
    if (!active || !device.output().would_jump(parts_.descriptor, *taken->terms)) continue;
    parts_.control.inhibit(inhibited_by_failure);
    const Error why{ErrorCode::OutOfRange, "an output jumps where the configuration changes"};
    parts_.reports.explain({.kind = ReportKind::NotReconfigured, .index = taken->to->id}, why);
    return parts_.reports.explain(
        {.kind = ReportKind::NodeFailed, .index = static_cast<std::uint16_t>(parts_.control.state())}, why);
  }
  parts_.reports.report(ReportKind::Reconfigured, taken->to->id, {});
}

}  // namespace hirosco
