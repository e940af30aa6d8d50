// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/driven.hpp"
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

inline constexpr const char* self_test_required = " self_test=\"required\"";
inline std::string descriptor_text() {
  return descriptor::file_system()(std::string{folder} + "robot_arm.xml").value();
}

/// robot_arm.xml for another robot. It may act without its self test, which is a step of commissioning and no motion.
inline std::string descriptor_for(std::size_t joints, const std::string& file) {
  std::string text = descriptor_text();
  replace_all(text, self_test_required, "");
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
struct Flown : hirosco::testing::Driven {
  std::size_t n;
  robotics::Model model;
  Plant plant{model};
  JointVector commanded, outside;
  double fastest{0}, largest_share{0};
  std::optional<robot_arm::Measured> told;  ///< in place of the truth

  Flown(std::size_t joints, const std::string& file, double mass_factor = 1)
      : Flown{model_of(file, mass_factor), descriptor_for(joints, file)} {}
  Flown(robotics::Model of, const std::string& descriptor_text)
      : Driven{make_robot_arm(), descriptor_text, "robot-arm"}, n{of.joints().size()}, model{std::move(of)} {
    plant.rotor = 0.1;
    commanded = outside = JointVector::Zero(static_cast<Eigen::Index>(n));
  }
  std::vector<double> play(std::span<const double> torques) override {
    EXPECT_EQ(torques.size(), n);
    commanded = vector_of(torques);
    for (std::size_t i = 0; i < torques.size(); ++i)
      largest_share = std::max(largest_share, std::abs(torques[i]) / model.joints()[i].limits.effort.value());
    if (mode == DeviceMode::Active) plant.step(commanded, 0.001, &outside);
    else plant.place(plant.measured().position);
    fastest = std::max(fastest, plant.measured().velocity.cwiseAbs().maxCoeff());
    const robot_arm::Measured& measured = told ? *told : plant.measured();
    std::vector<double> numbers;
    for (const auto* each : {&measured.position, &measured.velocity, &measured.torque})
      numbers.insert(numbers.end(), each->begin(), each->end());
    return numbers;
  }
  hirosco::testing::Sent ask(const char* function, std::vector<double> numbers) {
    const auto data = pus::encode_call(*rig.descriptor().find_function(function), numbers).value();
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
};

}  // namespace hirosco::robot_arm::testing
