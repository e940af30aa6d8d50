// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hirosco/utilities/module.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

/// What the module of a simulated device tells: how it is made, and the fault lines that its kind understands besides those
/// of every device. Its program is made of the same (device_main.cpp).
struct DeviceModule {
  std::unique_ptr<SimulatedDevice> (*make)(FlowFactory&, const FlowAddress&, const SimulatedDevice::Settings&);
  std::span<const FaultLine> faults{};
};

template <class Device>
[[nodiscard]] std::unique_ptr<SimulatedDevice> make_device(FlowFactory& flows, const FlowAddress& address,
                                                           const SimulatedDevice::Settings& settings) {
  return std::make_unique<Device>(flows, address, settings);
}

template <class Device>
inline constexpr DeviceModule device_content{make_device<Device>, Device::fault_lines};
/// `const hirosco::Module* hirosco_module() noexcept { return &hirosco::simulation::device_module<Lamp>; }`
/// Device::fault_lines is an array of FaultLine.
template <class Device>
inline constexpr Module device_module{.kind = ModuleKind::SimulatedDevice, .content = &device_content<Device>};

/// Loads the module of the program of this name. In words why there is none.
[[nodiscard]] std::expected<const DeviceModule*, std::string> load_device(std::string_view program);

}  // namespace hirosco::simulation
