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

#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/ball.hpp"
#include "subsystems/robot_arm/testing/flown.hpp"
#include "subsystems/robot_arm/testing/stored_path.hpp"

namespace hirosco::robot_arm::testing {

/// An arm that is to come out of where it is (docs/adr/0199).
struct WayOut : ::testing::Test {
  std::string file = std::string{folder} + "robot_arm.urdf";
  Flown flown{6, file};
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  const std::string done = "1 3 5:0001 7", aborted = "1 3 8:0204";

  void SetUp() override {
    flown.plant.place(start);
    flown.rig.bring_to(State::PreOperational, 1);
    flown.cycle(5);
    flown.command(State::SafeOperational);
  }
  hirosco::testing::Sent write_path(const std::vector<JointVector>& postures) {
    return robot_arm::testing::write_path(flown, postures);
  }
  void store(const std::vector<JointVector>& postures) {
    ASSERT_EQ(flown.rig.outcome(write_path(postures)), "1 3 7") << ::testing::PrintToString(flown.rig.explanations);
  }
  void operate() {
    flown.command(State::Operational);
    ASSERT_EQ(flown.mode, DeviceMode::Active);
  }
  [[nodiscard]] JointVector turned(double by, double twisted = 0) const {
    JointVector posture = start;
    posture[0] += by;
    posture[5] += twisted;
    return posture;
  }
  std::string check() {
    const auto request = flown.rig.call("CHECK_ABORT");
    flown.finish(request);
    return flown.rig.outcome(request);
  }
  [[nodiscard]] static std::string hex_of(const std::string& words) {
    return hirosco::testing::hex(std::as_bytes(std::span{words}));
  }
  [[nodiscard]] robotics::Vector3 tool_at(const JointVector& q) {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = q, .qd = JointVector::Zero(6)});
    return dynamics.frame_pose(flown.model.find_frame("tool").value()).position;
  }
  void keep_out(const robotics::Vector3& there) { keep_out_ball(flown, there); }
  std::string stands() {
    flown.cycle(1000);
    const JointVector where = flown.plant.measured().position;
    flown.cycle(500);
    return flown.off(where) < 1e-3 ? "it stands" : "it moves";
  }
};

}  // namespace hirosco::robot_arm::testing
