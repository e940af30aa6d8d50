// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "simulation/devices/simulated_device.hpp"

namespace hirosco::simulation {

using MakeDevice =
    std::function<std::unique_ptr<SimulatedDevice>(FlowFactory&, const FlowAddress&, const SimulatedDevice::Settings&)>;

/// The process around a simulated device: reads the command line, opens the flow, steps the device when a frame comes or
/// is overdue, serves the control socket; ends on SIGTERM, SIGINT or when its standard input, a pipe, is closed.
///   --transfer shared_memory|unix|udp|tcp|serial|message_queue --address NAME [--seed N] [--control PATH] [--cycle-us 500] [--set NAME=VALUE]...
///   [--byte-order little|big] [--actuator] [--stop drop|controlled|hold] [--stop-within-ms N]
///   [--enable-transfer TRANSFER --enable-address NAME] [--fall-back TRANSFER=ADDRESS]... [--power TRANSFER=ADDRESS]
///   [--endnode NAME] [--further NAME,little|big,TRANSFER=ADDRESS...]...
///   [--beside ...]: the same words for another device in the first one's world
/// Each setting is carried out as the line "NAME VALUE" of SimulatedDevice::fault at the start.
[[nodiscard]] int run_device(int argc, char** argv, const char* name, const MakeDevice& make);

}  // namespace hirosco::simulation
