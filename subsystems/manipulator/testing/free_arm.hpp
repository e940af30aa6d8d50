// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/manipulator/testing/described_arm.hpp"

namespace hirosco::manipulator::testing {

/// An arm in a rig, whose device the test plays: each joint is a motor that moves freely, and its sensor tells the load that it is given.
struct FreeArm {
  static constexpr double motor_inertia_kg_m2 = 1.28, cycle_s = 0.0005;

  FreeArm(std::unique_ptr<Subsystem> made, std::size_t joints, const std::string& descriptor)
      : n{joints}, arm{std::move(made)}, rig{*arm, descriptor} {
    for (std::size_t i = 0; i < n; ++i) position_rad.push_back(home_rad(i));
  }
  FreeArm(std::unique_ptr<Subsystem> made, std::size_t joints)
      : FreeArm{std::move(made), joints, described_arm(joints)} {}

  std::size_t n;
  std::unique_ptr<Subsystem> arm;
  hirosco::testing::Rig rig;
  std::unique_ptr<DataFlow> device =
      std::move(rig.flows.open({Transfer::SharedMemory, "arm"}, FlowSide::Device)).value();
  hirosco::testing::Rig::Partner handle;
  std::vector<double> handle_rad = std::vector<double>(n);
  std::vector<double> position_rad, speed_rad_s = std::vector<double>(n), load_n_m = std::vector<double>(n);
  std::vector<double> commanded_n_m = std::vector<double>(n);
  double largest_n_m{0};
  std::uint8_t tool{0};  ///< what it is told to hold
  std::uint8_t holds{0};
  bool grips{false};  ///< it holds what it is told to
  DeviceMode mode{};
  std::vector<std::vector<double>> path;  ///< of every cycle

  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      if (handle.writer) sample_handle();
      rig.service();
      rig.cycle();
      exchange();
      path.push_back(position_rad);
    }
    rig.service();
  }
  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    ASSERT_EQ(command.payload.size(), 8 * n + 1);
    OctetReader reader{command.payload, std::endian::little};
    for (std::size_t i = 0; i < n; ++i) {
      commanded_n_m[i] = reader.get<double>();
      largest_n_m = std::max(largest_n_m, std::abs(commanded_n_m[i]));
      // Off, a brake holds it.
      speed_rad_s[i] = mode == DeviceMode::Active
                           ? speed_rad_s[i] + (commanded_n_m[i] - load_n_m[i]) / motor_inertia_kg_m2 * cycle_s
                           : 0.0;
      position_rad[i] += speed_rad_s[i] * cycle_s;
    }
    tool = reader.get<std::uint8_t>();
    if (grips) holds = tool;
    std::vector<std::byte> payload(5 * 8 * n + 4 * n + 1);
    OctetWriter writer{payload, std::endian::little};
    for (const auto* numbers : {&position_rad, &speed_rad_s, &position_rad, &speed_rad_s, &load_n_m})
      for (const double number : *numbers) writer.put(number);
    for (std::size_t i = 0; i < n; ++i) writer.put(20.0F);
    writer.put(holds);
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(device->send(status.value()));
  }
  void sample_handle() {
    std::vector<std::byte> payload(16 * n + 1);
    OctetWriter writer{payload, std::endian::little};
    for (const double angle : handle_rad) writer.put(angle);
    for (std::size_t i = 0; i < n; ++i) writer.put(0.0);
    writer.put(std::uint8_t{1});
    handle.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  }
  void command(State state) {
    const auto request = rig.set_state(state);
    cycle(5);
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  /// Configuration 2 has a handle with as many axes.
  void operate(std::uint8_t configuration = 1) {
    rig.bring_to(State::PreOperational, configuration);
    const auto count = static_cast<std::uint16_t>(n);
    if (configuration == 2)
      handle =
          rig.attach(1, pus::st128::Role::Consumer, "HANDLE_STATE",
                     {{"POSITION", Type::Double, count}, {"VELOCITY", Type::Double, count}, {"ENABLE", Type::Uint8, 1}},
                     nullptr, 500us);
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
    ASSERT_EQ(rig.inhibited(), 0u);
    ASSERT_EQ(mode, DeviceMode::Active);
  }
  hirosco::testing::Sent move_to(const std::vector<double>& goal_rad, double duration_s) {
    std::vector<double> numbers = goal_rad;
    numbers.push_back(duration_s);
    const auto data = pus::encode_call(*rig.descriptor().find_function("MOVE_TO"), numbers).value();
    std::vector<std::byte> octets(data.begin(), data.end());
    return rig.send(8, 1, octets);
  }
  /// Every joint another way, of another sign than its neighbours'.
  [[nodiscard]] std::vector<double> elsewhere() const {
    std::vector<double> goal = position_rad;
    for (std::size_t i = 0; i < n; ++i) goal[i] += (i % 2 == 0 ? -0.1 : 0.08) * static_cast<double>(i % different + 1);
    return goal;
  }
  void expect_at(const std::vector<double>& where_rad, double tolerance_rad) const {
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(position_rad[i], where_rad[i], tolerance_rad) << "joint " << i + 1;
  }
};

}  // namespace hirosco::manipulator::testing
