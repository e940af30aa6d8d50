// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/simulated_device.hpp"

/// For tests of devices whose command begins with two torques.
namespace hirosco::simulation {

struct Status {
  DeviceStatus head;
  std::vector<std::byte> payload;
  [[nodiscard]] double value(std::size_t index) const {
    OctetReader reader{payload, std::endian::little};
    (void)reader.get(8 * index);
    return reader.get<double>();
  }
};

/// The subsystem's side of a device, by hand.
template <class Device>
class Bench {
 public:
  explicit Bench(const SimulatedDevice::Settings& settings = {}) : device{flows, address, settings} {
    EXPECT_TRUE(device.plug());
    flow = flows.open(address, FlowSide::Subsystem).value();
  }
  void command(DeviceMode mode, std::uint32_t epoch, double torque_1 = 0, double torque_2 = 0,
               std::uint32_t watchdog_us = 0) {
    std::array<std::byte, Device::command_octets> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(torque_1).put(torque_2);
    std::ranges::copy(beyond_torque, payload.begin() + 16);
    std::array<std::byte, max_device_frame_octets> buffer;
    (void)flow->send(write_command(buffer, {mode, epoch, ++sequence, watchdog_us, payload}).value());
  }
  /// What follows the torques in a command's payload.
  std::array<std::byte, Device::command_octets - 16> beyond_torque{};
  /// One cycle later.
  void step() { device.step(now += device.settings().cycle); }
  void active(double torque_1 = 0, std::uint32_t epoch = 1) {
    command(DeviceMode::Active, epoch, torque_1);
    step();
  }
  /// Newest frame as it came; empty when none did.
  std::vector<std::byte> raw() {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = flow->receive(buffer);
    if (!received || received->flow != Flow::New) return {};
    return {buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(received->octets)};
  }
  std::optional<Status> status() {
    const auto frame = raw();
    const auto read = read_status(frame);
    if (!read) return std::nullopt;
    return Status{*read, {read->payload.begin(), read->payload.end()}};
  }

  LocalFlows flows;
  FlowAddress address{Transfer::SharedMemory, "device"};
  Device device;
  std::unique_ptr<DataFlow> flow;
  TimePoint now{};
  std::uint32_t sequence{0};
};

}  // namespace hirosco::simulation
