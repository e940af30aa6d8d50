// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/driven.hpp"
#include "subsystems/robot_arm/floating/floating_arm.hpp"
#include "subsystems/robot_arm/testing/ball.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// A floating arm as its subsystem, in JOINTS, where it takes its base as standing: here it does, and a test is its device.
namespace hirosco::robot_arm::testing {

inline const std::string floating_folder = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/";

[[nodiscard]] inline std::string floating_descriptor() {
  std::string text = descriptor::file_system()(floating_folder + "floating_arm.xml").value();
  constexpr std::string_view file = "value=\"floating_arm.urdf\"";
  for (auto at = text.find(file); at != std::string::npos; at = text.find(file, at + 1))
    text.insert(at + std::string_view{"value=\""}.size(), floating_folder);
  return text;
}

struct FlownFloating : hirosco::testing::Driven {
  robotics::Model model = model_of(floating_folder + "floating_arm.urdf");
  Plant plant{model};
  double fastest{0};

  explicit FlownFloating(const std::string& descriptor_text = floating_descriptor())
      : Driven{make_floating_arm(), descriptor_text, "mcs-arm"} {
    plant.set_gravity(robotics::Vector3::Zero());
    plant.step_s = 250e-6;
  }
  std::vector<double> play(std::span<const double> torques) override {
    if (mode == DeviceMode::Active) plant.step(vector_of(torques), 0.001);
    else plant.place(plant.measured().position);
    const Measured& measured = plant.measured();
    fastest = std::max(fastest, measured.velocity.cwiseAbs().maxCoeff());
    std::vector<double> numbers;
    for (const auto* each : {&measured.position, &measured.velocity, &measured.torque})
      numbers.insert(numbers.end(), each->begin(), each->end());
    return numbers;
  }
  [[nodiscard]] double off(const JointVector& where) const {
    return (plant.measured().position - where).cwiseAbs().maxCoeff();
  }
};

struct FloatingWay : ::testing::Test {
  static constexpr std::uint16_t too_near_event = 2111;
  FlownFloating flown;
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  JointVector folded = vector_of(std::array{0.107, 0.76, -0.327, -1.758, -0.059, 2.35, -0.005});

  void begin(const JointVector& at) {
    flown.plant.place(at);
    flown.operate();
  }
  /// From `ready`, about the first joint.
  [[nodiscard]] JointVector turned(double by) const {
    JointVector posture = ready;
    posture[0] += by;
    return posture;
  }
  [[nodiscard]] robotics::Vector3 tool_at(const JointVector& posture) const {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = posture, .qd = JointVector::Zero(7)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value()).position;
  }
  [[nodiscard]] robotics::Vector3 tool() const { return tool_at(flown.plant.measured().position); }
  hirosco::testing::Sent move_tool(double x, double y, double z, double duration_s) {
    const auto request = flown.rig.call("MOVE_TOOL", {x, y, z, duration_s});
    flown.cycle(3);
    return request;
  }
  hirosco::testing::Sent move_joint(const JointVector& goal, double duration_s) {
    const auto request =
        flown.rig.call("MOVE_JOINT", {goal[0], goal[1], goal[2], goal[3], goal[4], goal[5], goal[6], duration_s});
    flown.cycle(3);
    return request;
  }
  void keep_out(const robotics::Vector3& there) { keep_out_ball(flown, there); }
  [[nodiscard]] static std::string hex_of(const std::string& words) {
    return hirosco::testing::hex(std::as_bytes(std::span{words}));
  }
  void expect_refused(hirosco::testing::Sent request, const char* pair) {
    flown.cycle(70);
    EXPECT_THAT(flown.rig.outcome(request), ::testing::StartsWith("1 3 8:8009")) << pair;
    EXPECT_THAT(flown.rig.outcome(request), ::testing::HasSubstr(hex_of(pair)));
    flown.cycle(500);
    EXPECT_LT(flown.fastest, 1e-6) << "nothing has moved";
    EXPECT_EQ(flown.rig.events(too_near_event), 0);
    EXPECT_EQ(flown.rig.inhibited(), 0u);
  }
};

}  // namespace hirosco::robot_arm::testing
