// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using simulation::JoystickDevice;
using simulation::RobotDevice;

/// RO6: a force scale of 0.08 and a hand that intends 32.5 mm from home, 20 mm beyond the rail, within 1 s.
class HardContact : public ::testing::Test {
 protected:
  static void raise_limits(descriptor::Mission& mission) {
    for (auto& member : mission.subsystems)
      for (auto& parameter : member.subsystem.parameters)
        if (parameter.field.name == "TORQUE_LIMIT" || parameter.field.name == "TORQUE_HARD") parameter.init = {100.0};
  }
  void commission(bool limits_raised) {
    flight.emplace(Plan{.edit = [=](descriptor::Mission& mission) {
      hand_rests(mission);
      if (limits_raised) raise_limits(mission);
    }});
    ASSERT_TRUE(flight->commission()) << flight->story().text();
    ASSERT_TRUE(command("SET_FORCE_SCALE", 0.08));
  }
  bool command(std::string_view function, double argument) {
    return flight->craft().command("JOYSTICK", function, {argument}).completed;
  }
  void press() {
    const auto& robot = flight->device<RobotDevice>("robot");
    flight->craft().on_cycle([this, &robot](std::string_view subsystem, TimePoint) {
      if (subsystem != "MANIPULATOR") return;
      force_n = robot.arm().contact().normal_force_n;
      peak_n = std::max(peak_n, force_n);
      ++cycles;
      if (force_n <= 0) ++lost;
    });
    ASSERT_TRUE(flight->device<JoystickDevice>("joystick").hand("cartesian 0.0325 0 1"));
    flight->craft().run(4s);
    cycles = lost = 0;
    flight->craft().run(2s);
  }
  [[nodiscard]] double lost_share() const { return lost / cycles; }

  std::optional<Flight> flight;
  double force_n{0}, peak_n{0}, cycles{0}, lost{0};
};

TEST_F(HardContact, BouncesWithoutPassivityControl) {
  commission(true);
  press();
  EXPECT_GT(lost_share(), 0.5);
  EXPECT_GT(peak_n, 400);
}

TEST_F(HardContact, RestsOnTheRailWithPassivityControl) {
  commission(true);
  ASSERT_TRUE(command("PASSIVITY", 1));
  press();
  EXPECT_EQ(lost, 0);
  EXPECT_LT(peak_n, 80);
  EXPECT_NEAR(force_n, 33.3, 0.333);
  EXPECT_TRUE(flight->story().has("JOYSTICK info PASSIVITY_ACTIVE"));
}

TEST_F(HardContact, CalmsDownWhenPassivityIsCommandedWhileItBounces) {
  commission(true);
  press();
  ASSERT_TRUE(command("PASSIVITY", 1));
  flight->craft().run(2s);
  cycles = lost = 0;
  flight->craft().run(2s);
  EXPECT_EQ(lost, 0);
}

TEST_F(HardContact, EndsInSafeOperationalWithTheNormalLimits) {
  commission(false);
  press();
  EXPECT_TRUE(flight->story().has("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED"));
  EXPECT_EQ(flight->state("MANIPULATOR"), State::SafeOperational);
  EXPECT_EQ(flight->state("JOYSTICK"), State::Operational);
}

TEST(Feel, TheCraftStartsInCoupledFeelWithItsForceScaleAndPassivity) {
  Flight flight{{.edit = [](descriptor::Mission& mission) {
    hand_rests(mission);
    mission.start_mode = "feel";
  }}};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  ASSERT_TRUE(flight.device<JoystickDevice>("joystick").hand("cartesian 0.0226 0 1"));
  flight.craft().run(4s);
  const auto& robot = flight.device<RobotDevice>("robot");
  ASSERT_GT(robot.arm().contact().normal_force_n, 10);
  EXPECT_NEAR(flight.device<JoystickDevice>("joystick").motor_torque_n_m()[1],
              -0.05 * robot.arm().joint_torque_n_m()[1], 1e-4);
}

TEST(Feel, WithoutARobotToFeelPassivityIsRefused) {
  Flight flight{{.edit = [](descriptor::Mission& mission) {
    hand_rests(mission);
    mission.start_mode = "standalone";
  }}};
  ASSERT_TRUE(flight.commission()) << flight.story().text();
  EXPECT_EQ(flight.craft().command("JOYSTICK", "PASSIVITY", {1}).failure, pus::FailureCode::NotPermittedNow);
}

}  // namespace
}  // namespace hirosco::testing
