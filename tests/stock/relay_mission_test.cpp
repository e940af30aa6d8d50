// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

/// The mission relay.xml on virtual time: an operator whose only way to the arm is the ground link's relay.
namespace hirosco {
namespace {

using simulation::JoystickDevice;
using simulation::RobotDevice;

struct RelayMission : ::testing::Test {
  std::optional<simulation::Flight> flown;
  RobotDevice* robot{nullptr};
  JoystickDevice* joystick{nullptr};

  void SetUp() override { fly(); }
  void fly() {
    flown.emplace(simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/stock/relay.xml"});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
    robot = &flown->device<RobotDevice>("robot");
    joystick = &flown->device<JoystickDevice>("joystick");
  }
  [[nodiscard]] double joint_rad() const { return robot->arm().state().link_rad[0]; }
};

TEST_F(RelayMission, TheArmFollowsTheHandLaterByTheWayThere) {
  const auto moves_after_s = [&](double there_and_back_ms) {
    fly();
    EXPECT_TRUE(flown->craft().command("COMMUNICATION", "SET_DELAY", {there_and_back_ms, 0}).completed);
    flown->craft().run(500ms);
    const double before_rad = joint_rad();
    double moved_s = 0;
    const TimePoint began = flown->craft().now();
    flown->craft().on_cycle([&](std::string_view subsystem, TimePoint now) {
      constexpr double seen_rad = 1e-3;
      if (subsystem == "MANIPULATOR" && moved_s == 0 && std::abs(joint_rad() - before_rad) > seen_rad)
        moved_s = seconds(now - began);
    });
    EXPECT_TRUE(joystick->hand("sine 1 0.15 0.5"));
    flown->craft().run(1s);
    return moved_s;
  };
  const double at_once_s = moves_after_s(0), later_s = moves_after_s(200);
  EXPECT_GT(at_once_s, 0);
  EXPECT_NEAR(later_s - at_once_s, 0.1, 5e-3);
}

TEST_F(RelayMission, AnArmWhoseOperatorIsNotHeardAnyMoreRestsByThisMissionsPlan) {
  ASSERT_TRUE(joystick->hand("sine 1 0.15 0.5"));
  flown->craft().run(1s);
  ASSERT_TRUE(flown->craft().command("COMMUNICATION", "SET_DELAY", {20, 1}).completed);
  EXPECT_TRUE(flown->run_until_state("MANIPULATOR", State::SafeOperational, 5s)) << flown->story().text();
  EXPECT_TRUE(flown->story().has("COMMUNICATION medium GROUND_LINK_LOST"));
  EXPECT_EQ(flown->state("JOYSTICK"), State::Operational);
  const double held_rad = joint_rad();
  flown->craft().run(1s);
  EXPECT_NEAR(joint_rad(), held_rad, 1e-4);
}

}  // namespace
}  // namespace hirosco
