// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/robot_arm/robot_arm.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// An arm as its subsystem, with a test as its device.
namespace hirosco::robot_arm::testing {

inline constexpr const char* folder = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/";

inline void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// A chain whose axes are x, y, z in turn, ever lighter.
inline std::string chain(std::size_t joints) {
  std::string text = "<robot name='chain'><link name='base'/>";
  std::string below = "base";
  for (std::size_t i = 1; i <= joints; ++i) {
    const std::string link = i == joints ? "tool" : "link" + std::to_string(i);
    const char* axis = i % 3 == 1 ? "1 0 0" : i % 3 == 2 ? "0 1 0" : "0 0 1";
    text += "<joint name='j" + std::to_string(i) + "' type='revolute'><origin xyz='0 0.02 0.1'/><parent link='" +
            below + "'/><child link='" + link + "'/><axis xyz='" + axis +
            "'/><limit lower='-2' upper='2' velocity='2' effort='200'/><dynamics damping='0.2' friction='0.1'/></joint>"
            "<link name='" +
            link +
            "'><inertial><origin xyz='0.01 0 0.05'/><mass value='0.5'/><inertia ixx='0.004' ixy='0' ixz='0' "
            "iyy='0.004' iyz='0' "
            "izz='0.003'/></inertial></link>";
    below = link;
  }
  return text + "</robot>";
}

inline std::string descriptor_text() {
  return descriptor::file_system()(std::string{folder} + "robot_arm.xml").value();
}

/// robot_arm.xml for another robot.
inline std::string descriptor_for(std::size_t joints, const std::string& file) {
  std::string text = descriptor_text();
  std::string safe, rotors;
  for (std::size_t i = 0; i < joints; ++i) safe += i == 0 ? "0" : " 0", rotors += i == 0 ? "0.1" : " 0.1";
  replace_all(text, "init=\"0.5 0.5 0.4 0.1 0.1 0.1\"", "init=\"" + rotors + "\"");
  replace_all(text, "safe=\"0 0 0 0 0 0\"", "safe=\"" + safe + "\"");
  replace_all(text, "count=\"6\"", "count=\"" + std::to_string(joints) + "\"");
  replace_all(text, "value=\"robot_arm.urdf\"", "value=\"" + file + "\"");
  return text;
}

inline std::string file_with(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::path{::testing::TempDir()} / name;
  std::ofstream{path} << text;
  return path.string();
}

/// The test plays the device: the robot itself, brakes that hold it, and whatever is done to it.
struct Flown {
  std::size_t n;
  std::string file;
  std::unique_ptr<Subsystem> arm = make_robot_arm();
  hirosco::testing::Rig rig{*arm, descriptor_for(n, file)};
  std::unique_ptr<DataFlow> device =
      std::move(rig.flows.open({Transfer::SharedMemory, "robot-arm"}, FlowSide::Device)).value();
  robotics::Model model;
  Plant plant{model};
  JointVector commanded, outside;
  DeviceMode mode{};
  double fastest{0}, largest_share{0};
  std::optional<robot_arm::Measured> told;  ///< in place of the truth

  Flown(std::size_t joints, std::string urdf, double mass_factor = 1)
      : n{joints}, file{std::move(urdf)}, model{model_of(file, mass_factor)} {
    plant.rotor = 0.1;
    commanded = outside = JointVector::Zero(static_cast<Eigen::Index>(n));
  }
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
    ASSERT_EQ(command.payload.size(), 8 * n);
    OctetReader reader{command.payload, std::endian::little};
    for (Eigen::Index i = 0; i < commanded.size(); ++i) {
      commanded[i] = reader.get<double>();
      largest_share = std::max(
          largest_share, std::abs(commanded[i]) / model.joints()[static_cast<std::size_t>(i)].limits.effort.value());
    }
    if (mode == DeviceMode::Active) plant.step(commanded, 0.001, &outside);
    else plant.place(plant.measured().position);
    fastest = std::max(fastest, plant.measured().velocity.cwiseAbs().maxCoeff());
    std::vector<std::byte> payload(24 * n);
    OctetWriter writer{payload, std::endian::little};
    const robot_arm::Measured& measured = told ? *told : plant.measured();
    for (const auto* numbers : {&measured.position, &measured.velocity, &measured.torque})
      for (const double number : *numbers) writer.put(number);
    std::array<std::byte, max_device_frame_octets> answer{};
    const auto status = write_status(answer, {.epoch = 1, .sequence = command.sequence, .payload = payload});
    static_cast<void>(device->send(status.value()));
  }
  void command(State state) {
    const auto request = rig.set_state(state);
    cycle(5);
    ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state) << ": " << ::testing::PrintToString(rig.explanations);
  }
  void operate() {
    rig.bring_to(State::PreOperational, 1);
    cycle(5);
    command(State::SafeOperational);
    command(State::Operational);
    ASSERT_EQ(rig.inhibited(), 0u);
    ASSERT_EQ(mode, DeviceMode::Active);
  }
  hirosco::testing::Sent ask(const char* function, std::vector<double> numbers) {
    const auto data = pus::encode_call(*rig.subsystem.descriptor().find_function(function), numbers).value();
    std::vector<std::byte> octets(data.begin(), data.end());
    return rig.send(8, 1, octets);
  }
  hirosco::testing::Sent move_j(const JointVector& goal, double speed = 1) {
    std::vector<double> numbers(goal.begin(), goal.end());
    numbers.push_back(speed);
    return ask("MOVE_J", numbers);
  }
  [[nodiscard]] double off(const JointVector& goal) const {
    return (plant.measured().position - goal).cwiseAbs().maxCoeff();
  }
  /// Cycles until a request has ended.
  int finish(hirosco::testing::Sent request, int most = 30'000) {
    int cycles = 0;
    while (rig.outcome(request).find_first_of("78") == std::string::npos && cycles < most) cycle(10), cycles += 10;
    return cycles;
  }
};

}  // namespace hirosco::robot_arm::testing
