// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

namespace hirosco::testing {

/// A subsystem and its one device, which is all numbers (DOUBLE, little endian) and which the test plays: each cycle is an exchange.
struct Driven {
  std::unique_ptr<Subsystem> author;
  Rig rig;
  std::unique_ptr<DataFlow> device;
  DeviceMode mode{};  ///< of the last command

  /// The device is reached at this address of shared memory.
  Driven(std::unique_ptr<Subsystem> subsystem, const std::string& descriptor_text, std::string address)
      : author{std::move(subsystem)},
        rig{*author, descriptor_text},
        device{std::move(rig.flows.open({Transfer::SharedMemory, std::move(address)}, FlowSide::Device)).value()} {}
  virtual ~Driven() = default;

  /// What the device is told, in `mode`, and what it answers.
  virtual std::vector<double> play(std::span<const double> commanded) = 0;

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    OctetReader reader{command.payload, std::endian::little};
    std::vector<double> commanded;
    while (reader.remaining() > 0) commanded.push_back(reader.get<double>());
    const std::vector<double> told = play(commanded);
    std::vector<std::byte> payload(sizeof(double) * told.size());
    OctetWriter writer{payload, std::endian::little};
    for (const double number : told) writer.put(number);
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(device->send(status.value()));
  }
  void command(State state) {
    const auto request = rig.set_state(state);
    cycle(5);
    ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state) << ": " << ::testing::PrintToString(rig.explanations);
  }
  /// Up to Operational, where what it puts out is obeyed.
  void operate() {
    rig.bring_to(State::PreOperational, 1);
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
    ASSERT_EQ(rig.inhibited(), 0u);
    ASSERT_EQ(mode, DeviceMode::Active);
  }
  /// Sets all numbers (DOUBLE) of a parameter by TC[20,3].
  void write(std::string_view name, double value) {
    const descriptor::SubsystemDescriptor& descriptor = rig.descriptor();
    const auto its = std::ranges::find(descriptor.parameters, name, [](const auto& each) { return each.field.name; });
    ASSERT_NE(its, descriptor.parameters.end()) << name;
    const auto request = rig.set_with(name, std::vector<std::optional<Value>>(its->field.values(), value));
    cycle(3);
    ASSERT_EQ(rig.outcome(request), "1 3 7") << name;
  }
  /// A number (DOUBLE) as TM[20,2] tells it.
  double told_number(std::string_view name) {
    const descriptor::SubsystemDescriptor& its = rig.descriptor();
    const auto found = std::ranges::find(its.parameters, name, [](const auto& each) { return each.field.name; });
    if (found == its.parameters.end()) throw std::runtime_error{"no parameter " + std::string{name}};
    std::vector<std::byte> data(1 + 4);
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{its.id, found->field.type, found->id}.wire());
    static_cast<void>(rig.send(20, 1, data));
    cycle(3);
    double number = 0;
    for (const auto& each : rig.telemetry)
      if (each.service == 20 && each.subtype == 2) number = OctetReader{Octets{each.data}.last(8)}.get<double>();
    return number;
  }
  /// Cycles until a request has ended.
  int finish(Sent request, int most = 30'000) {
    int cycles = 0;
    while (rig.outcome(request).find_first_of("78") == std::string::npos && cycles < most) cycle(10), cycles += 10;
    return cycles;
  }
};

}  // namespace hirosco::testing
