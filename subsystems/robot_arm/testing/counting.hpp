// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/flown.hpp"
#include "subsystems/robot_arm/testing/homing.hpp"

/// An arm whose joints do not know their zero when they are switched on (docs/adr/0208), in orbit; a test is its device.
namespace hirosco::robot_arm::testing {

inline constexpr std::uint16_t not_referenced = 1070, under_gravity = 1071;
inline constexpr std::uint8_t works_by_position = 1, homes = 3;
inline constexpr std::size_t counted_joints = 6;
/// Six joints have been found, one by one.
inline constexpr const char* all_found = "1 3 5:0001 5:0002 5:0003 5:0004 5:0005 5:0006 7";

[[nodiscard]] inline std::string homed_file() { return std::string{folder} + "robot_arm.urdf"; }
[[nodiscard]] inline std::string homed_arm() {
  return with_homing(descriptor_for(counted_joints, homed_file()), homing_numbers());
}

/// Its encoders count from where they were switched on; frames end with a flag of each joint.
struct Counting : Flown {
  std::array<double, counted_joints> mark{};  ///< where it is, as the joint truly stands
  std::array<double, counted_joints> ahead{0.7, -1.3, 2.1, 0.4, -2.5, 1.1};  ///< of what is told a joint is
  std::array<bool, counted_joints> has_mark{true, true, true, true, true, true}, knows{}, takes{};
  std::optional<double> wall;  ///< beyond this the fifth joint meets something
  JointVector told_position;
  bool was_active{false};  ///< its brakes were open, in any cycle

  explicit Counting(const std::string& descriptor_text) : Flown{model_of(homed_file()), descriptor_text} {
    plant.set_gravity({0, 0, 0});
  }
  void exchange_once() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = device->receive(frame);
    if (!found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    mode = command.mode;
    was_active = was_active || mode == DeviceMode::Active;
    OctetReader reader{command.payload, std::endian::little};
    std::vector<double> torques;
    for (std::size_t i = 0; i < counted_joints; ++i) torques.push_back(reader.get<double>());
    for (bool& each : takes) each = reader.get<std::uint8_t>() == 1;
    const std::vector<double> told_now = measured_after(torques);
    std::vector<std::byte> payload(sizeof(double) * told_now.size() + counted_joints);
    OctetWriter writer{payload, std::endian::little};
    for (const double number : told_now) writer.put(number);
    for (const bool each : knows) writer.put(static_cast<std::uint8_t>(each ? 1 : 0));
    std::array<std::byte, max_device_frame_octets> answer{};
    static_cast<void>(
        device->send(write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload}).value()));
  }
  std::vector<double> measured_after(const std::vector<double>& torques) {
    const JointVector before = plant.measured().position;
    constexpr double stiffness_n_m_rad = 2000;
    outside[4] = wall && before[4] > *wall ? -stiffness_n_m_rad * (before[4] - *wall) : 0;
    std::vector<double> numbers = play(torques);
    const JointVector& here = plant.measured().position;
    for (std::size_t i = 0; i < counted_joints; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (takes[i] && has_mark[i] && (before[k] - mark[i]) * (here[k] - mark[i]) <= 0) knows[i] = true, ahead[i] = 0;
      numbers[i] -= ahead[i];
    }
    told_position = vector_of(std::span{numbers}.first(counted_joints));
    return numbers;
  }
  void lose_power() {
    knows.fill(false);
    ahead.fill(0.9);
  }
  void know_all_zeros() {
    knows.fill(true);
    ahead.fill(0);
  }
  void fly(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange_once();
    }
    rig.service();
  }
  /// Steps have numbers, too.
  [[nodiscard]] bool has_ended(hirosco::testing::Sent request) const {
    const std::string outcome = rig.outcome(request);
    return outcome.ends_with(" 7") || outcome.find(" 8:") != outcome.npos || outcome.find(" 4:") != outcome.npos;
  }
  std::string asked(hirosco::testing::Sent request, int most = 30'000) {
    while (!has_ended(request) && most-- > 0) fly();
    return rig.outcome(request);
  }
  std::string asked(const char* function) { return asked(rig.call(function)); }
  [[nodiscard]] const descriptor::Parameter& parameter(std::string_view name) const {
    const auto& all = rig.descriptor().parameters;
    return *std::ranges::find(all, name, [](const auto& each) { return std::string_view{each.field.name}; });
  }
  /// HOMING with this TORQUE, by TC[20,3].
  std::string write_torque(const std::array<double, counted_joints>& torque_n_m) {
    const auto& its = parameter("HOMING");
    std::vector<std::byte> data(1 + 4 + its.octets());
    OctetWriter writer{data};
    writer.put(std::uint8_t{1}).put(ParameterId{rig.descriptor().id, its.field.type, its.id}.wire());
    for (const int joint : {6, 5, 4, 3, 2, 1}) writer.put(static_cast<std::uint8_t>(joint));
    for (const double rad_s : {0.1, 0.1, -0.1, 0.1, 0.1, -0.1}) writer.put(rad_s);
    for (const double most : torque_n_m) writer.put(most);
    for (std::size_t i = 0; i < counted_joints; ++i) writer.put(0.4);
    return asked(rig.send(20, 3, data), 10);
  }
  /// Of one octet, as TM[20,2] tells it last.
  int told_octet(std::string_view name) {
    const auto& its = parameter(name);
    std::vector<std::byte> data(1 + 4);
    OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{rig.descriptor().id, its.field.type, its.id}.wire());
    static_cast<void>(rig.send(20, 1, data));
    fly(3);
    int told_last = -1;
    for (const auto& each : rig.telemetry)
      if (each.service == 20 && each.subtype == 2) told_last = std::to_integer<int>(each.data.back());
    return told_last;
  }
  [[nodiscard]] double fastest_joint() const { return plant.measured().velocity.cwiseAbs().maxCoeff(); }
};

struct CountingArm : ::testing::Test {
  Counting arm;
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});

  explicit CountingArm(const std::string& text = homed_arm()) : arm{text} {
    constexpr std::array sides{1.0, 1.0, -1.0, 1.0, 1.0, -1.0};
    for (std::size_t i = 0; i < counted_joints; ++i)
      arm.mark.at(i) = start[static_cast<Eigen::Index>(i)] + 0.05 * sides.at(i);
    arm.plant.place(start);
  }
  void enter(State state) {
    const auto request = arm.rig.set_state(state);
    arm.fly(5);
    ASSERT_EQ(arm.rig.outcome(request), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
  }
  void bring_up(std::uint8_t configuration) {
    arm.rig.bring_to(State::PreOperational, configuration);
    arm.fly(5);
    enter(State::SafeOperational);
    arm.fly(5);
  }
  void operate(std::uint8_t configuration = homes) {
    ASSERT_NO_FATAL_FAILURE(bring_up(configuration));
    ASSERT_NO_FATAL_FAILURE(enter(State::Operational));
    ASSERT_EQ(arm.rig.inhibited(), 0u);
    ASSERT_EQ(arm.mode, DeviceMode::Active);
  }
  void act_by(std::uint8_t configuration) {
    enter(State::SafeOperational);
    enter(State::PreOperational);
    const auto configured = arm.rig.configure(configuration);
    arm.fly(20);
    ASSERT_EQ(arm.rig.outcome(configured), "1 3 7") << ::testing::PrintToString(arm.rig.explanations);
    enter(State::SafeOperational);
    arm.fly(5);
    enter(State::Operational);
  }
  [[nodiscard]] static std::string hex_of(const std::string& words) {
    return hirosco::testing::hex(std::as_bytes(std::span{words}));
  }
  /// Of a failure: the joint's number, then words.
  [[nodiscard]] static std::string of_joint(int joint, const std::string& words) {
    return "000000000000000" + std::to_string(joint) + hex_of(words);
  }
  [[nodiscard]] std::string self_tested() { return arm.asked(arm.rig.send(17, 128, {}), 200); }
  void stands() {
    arm.fly(600);
    const JointVector there = arm.plant.measured().position;
    arm.fly(300);
    EXPECT_LT(arm.off(there), 1e-3);
    EXPECT_EQ(arm.rig.inhibited(), 0u);
  }
  /// Until it looks with this joint, from 1, and has come to its speed.
  void until_looks_with(std::size_t joint) {
    for (int i = 0; i < 20'000 && !arm.takes.at(joint - 1); ++i) arm.fly();
    ASSERT_TRUE(arm.takes.at(joint - 1));
    arm.fly(200);
    ASSERT_FALSE(arm.knows.at(joint - 1));
  }
};

}  // namespace hirosco::robot_arm::testing
