// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/simulated_devices.hpp"

#include <algorithm>
#include <utility>

#include "simulation/devices/device_arguments.hpp"

namespace hirosco::simulation {

SimulatedDevices::SimulatedDevices(const Parts& parts) {
  for (const auto& described : parts.mission.devices) {
    const auto maker = parts.makers.find(described.executable);
    if (maker == parts.makers.end()) continue;
    auto made = make(parts, described, maker->second);
    if (!made) {
      parts.observer.told(parts.clock.onboard(), "no simulated device " + described.name + ": " + made.error());
      continue;
    }
    SimulatedDevice& device = **made;
    // Settings of a simulated device are lines of its fault script: <Setting name="hand" value="wander"/>.
    for (const auto& [name, value, at] : described.settings)
      if (const auto taken = name == world_setting ? ok() : device.fault(name + " " + value); !taken)
        parts.observer.told(parts.clock.onboard(), "simulated device " + described.name + " does not take '" + name +
                                                       " " + value + "': " + taken.error().text);
    for (const std::string& remark : device.remarks())
      parts.observer.told(parts.clock.onboard(), "simulated device " + described.name + ": " + remark);
    devices_.push_back({&described, std::move(*made)});
  }
}

std::expected<std::unique_ptr<SimulatedDevice>, std::string> SimulatedDevices::make(
    const Parts& parts, const descriptor::SimulatedDevice& described, const MakeDevice& maker) {
  auto wanted = device_arguments(parts.mission, described);
  if (!wanted) return std::unexpected{wanted.error()};
  const auto world = whose_world(parts.mission, described);
  if (world && *world != nullptr) wanted->settings.in_world_of = find((*world)->name);
  if (!world) return std::unexpected{world.error()};
  if (*world != nullptr && wanted->settings.in_world_of == nullptr)
    return std::unexpected{std::string{"its world is not there"}};
  wanted->settings.seed = described.seed * 1000 + parts.seed;
  if (!parts.realtime) wanted->settings.enable_limit = enable_limit_reduced;
  auto made = maker(parts.flows, wanted->address(), wanted->settings);
  if (const auto plugged = made->plug(); !plugged) return std::unexpected{std::string{plugged.error().text}};
  return made;
}

SimulatedDevice* SimulatedDevices::find(std::string_view name) noexcept {
  const auto found =
      std::ranges::find_if(devices_, [&](const Device& device) { return device.described->name == name; });
  return found != devices_.end() ? found->device.get() : nullptr;
}

TimePoint SimulatedDevices::next_wake() const noexcept {
  TimePoint next = TimePoint::max();
  for (const Device& device : devices_) next = std::min(next, device.device->next_wake());
  return next;
}

void SimulatedDevices::step(TimePoint now) {
  for (const Device& device : devices_)
    if (device.device->next_wake() <= now) device.device->step(now);
}

void SimulatedDevices::step_of(std::string_view subsystem, TimePoint now) {
  for (const Device& device : devices_)
    if (device.described->subsystem == subsystem) device.device->step(now);
}

}  // namespace hirosco::simulation
