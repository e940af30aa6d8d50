// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_arguments.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

namespace hirosco::simulation {
namespace {

FlowAddress address_of(const descriptor::Endnode& endnode) { return {endnode.transfer, endnode.address}; }

SimulatedDevice::Stop stop_of(descriptor::StopKind kind) {
  switch (kind) {
    case descriptor::StopKind::Drop: break;
    case descriptor::StopKind::Controlled: return SimulatedDevice::Stop::Controlled;
    case descriptor::StopKind::Hold: return SimulatedDevice::Stop::Hold;
  }
  return SimulatedDevice::Stop::Drop;
}

const char* text_of(SimulatedDevice::Stop stop) {
  switch (stop) {
    case SimulatedDevice::Stop::Drop: break;
    case SimulatedDevice::Stop::Controlled: return "controlled";
    case SimulatedDevice::Stop::Hold: return "hold";
  }
  return "drop";
}

template <class Unit>
std::string count_of(Duration span) {
  return std::to_string(std::chrono::duration_cast<Unit>(span).count());
}

}  // namespace

FlowAddress DeviceArguments::address() const { return address_of(endnode); }

std::vector<std::string> DeviceArguments::arguments() const {
  std::vector<std::string> words{"--transfer",       std::string{to_text(endnode.transfer)},
                                 "--address",        endnode.address,
                                 "--byte-order",     settings.byte_order == std::endian::big ? "big" : "little",
                                 "--cycle-us",       count_of<std::chrono::microseconds>(settings.cycle),
                                 "--stop",           text_of(settings.stop),
                                 "--stop-within-ms", count_of<std::chrono::milliseconds>(settings.stop_within)};
  if (enable)
    words.insert(words.end(),
                 {"--enable-transfer", std::string{to_text(enable->transfer)}, "--enable-address", enable->address});
  return words;
}

std::expected<DeviceArguments, std::string> device_arguments(const descriptor::Mission& mission,
                                                             const descriptor::SimulatedDevice& device) {
  const auto* member = mission.find_subsystem(device.subsystem);
  if (member == nullptr) return std::unexpected{fmt::format("there is no subsystem {}", device.subsystem)};
  const descriptor::Subsystem& subsystem = member->subsystem;
  const auto found = std::ranges::find(subsystem.devices, device.device, &descriptor::Device::name);
  if (found == subsystem.devices.end())
    return std::unexpected{fmt::format("{} has no device {}", device.subsystem, device.device)};
  DeviceArguments made{.enable = found->enable};
  const descriptor::Configuration* first = nullptr;
  for (const auto& configuration : subsystem.configurations)
    for (const auto& use : configuration.devices) {
      if (&subsystem.devices[use.device] != &*found) continue;
      if (first == nullptr) made.endnode = use.endnode;
      const bool same = use.endnode.transfer == made.endnode.transfer && use.endnode.address == made.endnode.address &&
                        use.endnode.byte_order == made.endnode.byte_order;
      if (!same)
        return std::unexpected{
            fmt::format("configurations {} and {} of {} have different endnodes for {}, and it has one", first->name,
                        configuration.name, device.subsystem, device.device)};
      made.settings.cycle =
          first == nullptr ? configuration.sampling : std::min(made.settings.cycle, configuration.sampling);
      if (first == nullptr) first = &configuration;
    }
  if (first == nullptr)
    return std::unexpected{fmt::format("no configuration of {} uses {}", device.subsystem, device.device)};
  made.settings.byte_order =
      made.endnode.byte_order == descriptor::ByteOrder::Big ? std::endian::big : std::endian::little;
  made.settings.stop = stop_of(found->stop);
  made.settings.stop_within = found->stop_within;
  if (made.enable) made.settings.enable = address_of(*made.enable);
  return made;
}

}  // namespace hirosco::simulation
