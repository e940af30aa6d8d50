// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include <array>

#include "hirosco/subsystem/cycle/cycle.hpp"

/// What a cycle does about a device or a required link that is lost: it inhibits the actuators and raises the event, by which the
/// supervisor's event handling takes down the whole network.
namespace hirosco {

void CycleLoop::read_inputs(TimePoint started) noexcept {
  for (std::size_t i = 0; i < plan_.inputs.size(); ++i) {
    LinkInputSlot& input = plan_.inputs[i];
    input.read(started);
    const bool stale = controlling() && input.stale() && (input.attached() || input.terms().required);
    if (stale && input.terms().missing == descriptor::MissingPolicy::Inhibit) inhibit(inhibited_by_link);
    if (stale && !input.ended() && input_was_stale_[i] == 0) {
      const double age = input.port()->age_cycles();
      raise(plan_.input_stale_events[i], {&age, 1});
    }
    input_was_stale_[i] = stale ? 1 : 0;
  }
  for (std::size_t i = 0; i < plan_.devices.size(); ++i) {
    DeviceSlot& device = plan_.devices[i];
    device.read(controlling());
    if (!device.alive() && controlling()) inhibit(inhibited_by_device);
    if (!device.just_lost()) continue;
    end_self_test(self_test_.lose_device(static_cast<std::int64_t>(i)));
    const DeviceSlot::Loss loss = device.loss();
    const std::array arguments{static_cast<double>(loss.reason), static_cast<double>(loss.silent_cycles),
                               static_cast<double>(loss.damaged), static_cast<double>(loss.wrong_size)};
    raise(plan_.device_lost_events[i], arguments);
  }
}

}  // namespace hirosco
