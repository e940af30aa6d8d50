// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

/// What a simulated device is to be, as the descriptor of its subsystem says.
struct DeviceArguments {
  descriptor::Endnode endnode{};
  std::optional<descriptor::Endnode> enable{};
  /// Byte order, cycle (of the fastest configuration that uses it), stop, fall-backs, further endnodes and power switch; the
  /// seed is the caller's.
  SimulatedDevice::Settings settings{};

  [[nodiscard]] FlowAddress address() const;
  /// The same for the command line of its program (device_shell.hpp), without seed, control socket and settings.
  [[nodiscard]] std::vector<std::string> arguments() const;
};

/// In words why there can be none: it is not used, or its configurations do not agree on where and how it speaks.
[[nodiscard]] std::expected<DeviceArguments, std::string> device_arguments(const descriptor::Mission& mission,
                                                                           const descriptor::SimulatedDevice& device);

}  // namespace hirosco::simulation
