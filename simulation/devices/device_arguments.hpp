// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/model/mission.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

/// What a simulated device is to be, as the descriptor of its subsystem says.
struct DeviceArguments {
  descriptor::Endnode endnode{};
  std::optional<descriptor::Endnode> enable{};
  /// Byte order, cycle (of the fastest configuration that uses it), whether it is an actuator, stop, fall-backs, further endnodes and power switch; the
  /// seed is the caller's.
  SimulatedDevice::Settings settings{};

  [[nodiscard]] FlowAddress address() const;
  /// The same for the command line of its program (device_shell.hpp), without seed, control socket and settings.
  [[nodiscard]] std::vector<std::string> arguments() const;
};

/// In words why there can be none: it is not used, or its configurations do not agree on where and how it speaks.
[[nodiscard]] std::expected<DeviceArguments, std::string> device_arguments(const descriptor::Mission& mission,
                                                                           const descriptor::SimulatedDevice& device);

/// <Setting name="world" value="NAME"/> of a simulated device: it is in the world of that other one (docs/adr/0120), which stands before
/// it, has the same executable and a world of its own. It is no line of its fault script.
inline constexpr std::string_view world_setting = "world";
/// In the command line of a device's program: what follows is another device of its world.
inline constexpr const char* beside_word = "--beside";
/// That other one; null: its world is its own. In words why it is none.
[[nodiscard]] std::expected<const descriptor::SimulatedDevice*, std::string> whose_world(
    const descriptor::Mission& mission, const descriptor::SimulatedDevice& device);

}  // namespace hirosco::simulation
