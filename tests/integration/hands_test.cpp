// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using pus::FailureCode;
using simulation::JoystickDevice;
using simulation::RobotDevice;

struct Hands : ::testing::Test {
  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  simulation::CommandOutcome command(std::string_view function, const std::vector<Value>& arguments) {
    return flight.craft().command("JOYSTICK", function, arguments);
  }
  [[nodiscard]] simulation::JoystickHandle& handle() { return flight.device<JoystickDevice>("joystick").handle(); }

  Flight flight{{}};  // its simulated hand wanders
};

TEST_F(Hands, TheWanderingHandGivesWayToACommandedOneAndTakesOverAgain) {
  ASSERT_TRUE(command("SET_HAND", {1}).completed);
  double fastest_rad_s = 0;
  flight.craft().on_cycle([&](std::string_view, TimePoint) {
    fastest_rad_s = std::max(fastest_rad_s, std::abs(handle().rate_rad_s()[0]));
  });
  ASSERT_TRUE(command("HAND", {0, 0}).completed);
  flight.craft().run(2s);
  const auto home = flight.device<RobotDevice>("robot").arm().state().link_rad;
  // A slow wave, 25 commands in each second.
  fastest_rad_s = 0;
  for (int k = 0; k <= 50; ++k) {
    ASSERT_TRUE(command("HAND", {-0.1 * std::sin(0.05 * k), 0}).completed);
    flight.craft().run(30ms);
  }
  EXPECT_LT(fastest_rad_s, 0.5) << "commands of 50 Hz are no jumps for the handle";
  // A jump of a page's is none for the hand.
  fastest_rad_s = 0;
  ASSERT_TRUE(command("HAND", {0.1, 0}).completed);
  ASSERT_TRUE(command("HAND", {-0.1, 0}).completed);
  flight.craft().run(2s);
  EXPECT_LT(fastest_rad_s, 0.9) << "0.6 rad/s and what the softness of the arm adds";
  EXPECT_EQ(flight.inhibited("MANIPULATOR"), 0U);
  EXPECT_NEAR(handle().angle_rad()[0], -0.1, 0.01);
  EXPECT_NEAR(flight.device<RobotDevice>("robot").arm().state().link_rad[0] - home[0], -0.1, 0.01);
  EXPECT_FALSE(flight.device<JoystickDevice>("joystick").hand("hold 0 0")) << "two masters would be one too many";

  ASSERT_TRUE(command("SET_HAND", {0}).completed);
  const auto before = handle().angle_rad();
  flight.craft().run(5s);
  EXPECT_GT(std::hypot(handle().angle_rad()[0] - before[0], handle().angle_rad()[1] - before[1]), 0.002);
}

TEST_F(Hands, AreRefusedWithAReasonWhereTheyMakeNoSense) {
  EXPECT_EQ(command("HAND", {0.1, 0}).failure, FailureCode::WrongStatus) << "the simulated hand is on the handle";
  EXPECT_EQ(command("SET_HAND", {2}).failure, FailureCode::NotPermittedNow) << "nobody is there to lay a hand on it";
  ASSERT_TRUE(flight.set_mode("automatic").completed);
  EXPECT_EQ(command("SET_HAND", {1}).failure, FailureCode::WrongMode);
  ASSERT_TRUE(flight.set_mode("telepresence").completed);
  ASSERT_TRUE(flight.set_state("JOYSTICK", State::SafeOperational).completed);
  EXPECT_EQ(command("SET_HAND", {1}).failure, FailureCode::WrongState);
}

}  // namespace
}  // namespace hirosco::testing
