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
using simulation::Vec2;

Plan start_in(const char* mode) {
  return {.edit = [mode](descriptor::Mission& mission) {
    hand_rests(mission);
    mission.start_mode = mode;
  }};
}

struct RokvissFlight : ::testing::Test {
  void commission(Plan plan) {
    flight.emplace(std::move(plan));
    ASSERT_TRUE(flight->commission()) << flight->story().text();
    robot = &flight->device<RobotDevice>("robot");
  }
  simulation::CommandOutcome command(std::string_view function, const std::vector<Value>& arguments = {},
                                     Duration limit = 30s) {
    return flight->craft().command("MANIPULATOR", function, arguments, limit);
  }
  void run(Duration span) { flight->craft().run(span); }

  std::optional<Flight> flight;
  RobotDevice* robot{nullptr};
};

// --- RO4: springs ------------------------------------------------------------------------------------------------------

/// tau_j = J^T k (L - L0) e, e from anchor to tip: written from the notes, with nothing of the model but the angles.
Vec2 spring_torque(const Vec2& q, const Vec2& anchor_m) {
  const double x2 = 0.22 * std::cos(q[0] + q[1]), y2 = 0.22 * std::sin(q[0] + q[1]);
  const double x = 0.25 * std::cos(q[0]) + x2, y = 0.25 * std::sin(q[0]) + y2;
  const double ex = x - anchor_m[0], ey = y - anchor_m[1];
  const double length = std::hypot(ex, ey);
  const double force = 400 * std::max(0.0, length - 0.05) / length;
  // The joints hold the tip against the pull: the torque they show is what the arm does to the spring.
  return {force * (-y * ex + x * ey), force * (-y2 * ex + x2 * ey)};
}

struct Springs : RokvissFlight {
  void hand(const std::string& line) { ASSERT_TRUE(flight->device<JoystickDevice>("joystick").hand(line)); }
  void expect_rest_torque(const Vec2& anchor_m) {
    const Vec2 expected = spring_torque(robot->arm().state().link_rad, anchor_m);
    const Vec2 measured = robot->arm().joint_torque_n_m();
    const double size = std::hypot(expected[0], expected[1]);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(measured[i], expected[i], 1e-3 * size);
  }
};

TEST_F(Springs, TheVerticalOnePullsWithTheForceOfItsStretch) {
  commission(start_in("telepresence"));
  ASSERT_TRUE(robot->fault("friction off"));
  EXPECT_EQ(command("HOOK_SPRING", {1}).failure, FailureCode::NotPermittedNow);
  EXPECT_TRUE(flight->story().has("MANIPULATOR low SPRING_OUT_OF_REACH"));
  hand("cartesian 0 0.0215 1");
  run(3s);
  EXPECT_TRUE(command("HOOK_SPRING", {1}).completed);
  EXPECT_EQ(command("HOOK_SPRING", {1}).failure, FailureCode::WrongStatus);
  EXPECT_LT(std::hypot(robot->arm().spring_force_n()[0], robot->arm().spring_force_n()[1]), 0.2) << "nearly slack";
  hand("cartesian 0 -0.0085 1");
  run(8s);
  expect_rest_torque({0.3275, 0.050});
  EXPECT_GT(std::abs(robot->arm().joint_torque_n_m()[0]), 2.5);
  // Towards the anchor it is slack and without force.
  hand("cartesian 0 0.030 1");
  run(8s);
  EXPECT_EQ(robot->arm().spring_force_n(), (Vec2{}));
  EXPECT_NEAR(robot->arm().joint_torque_n_m()[0], 0, 1e-3);
  EXPECT_TRUE(command("RELEASE_SPRING").completed);
  EXPECT_EQ(command("RELEASE_SPRING").failure, FailureCode::WrongStatus);
  hand("cartesian 0 -0.0085 1");
  run(8s);
  EXPECT_NEAR(robot->arm().joint_torque_n_m()[0], 0, 1e-3) << "released it pulls no more";
}

TEST_F(Springs, TheHorizontalOneIsWithinReachAtHome) {
  commission(start_in("telepresence"));
  ASSERT_TRUE(robot->fault("friction off"));
  EXPECT_TRUE(command("HOOK_SPRING", {2}).completed);
  hand("cartesian 0.008 -0.030 1");
  run(8s);
  ASSERT_LT(robot->arm().contact().penetration_m, 0) << "the rail must not help";
  ASSERT_GT(std::hypot(robot->arm().spring_force_n()[0], robot->arm().spring_force_n()[1]), 2);
  expect_rest_torque({0.280, -0.0215});
}

// --- RO5: programmes on board ------------------------------------------------------------------------------------------

/// The contour programme with a bump of this height, in the world and on board; contact judged along the way.
struct Programmes : RokvissFlight {
  struct Seen {
    double lowest_n{1e9}, highest_n{0}, torque_n_m{0};
    int cycles{0}, lost{0};
  };
  Seen along_the_contour(double bump_m) {
    Plan plan = start_in("automatic");
    plan.edit = [bump_m, more = plan.edit](descriptor::Mission& mission) {
      more(mission);
      for (auto& member : mission.subsystems)
        for (auto& configuration : member.subsystem.configurations)
          for (auto& initial : configuration.initial)
            if (initial.parameter.text == "SCRIPT.BUMP_HEIGHT") initial.values = {bump_m};
    };
    simulation::ArmParameters arm;
    arm.contour.bump_height_m = bump_m;
    plan.devices["hirosco-sim-robot"] = [arm](FlowFactory& flows, const FlowAddress& address,
                                              const simulation::SimulatedDevice::Settings& settings) {
      return std::make_unique<RobotDevice>(flows, address, settings, arm);
    };
    commission(std::move(plan));
    Seen seen;
    int leg = 0;
    flight->story().on_telemetry = [&](const pus::TelemetryView& packet) {
      if (packet.service() == 1 && packet.subtype() == 5) ++leg;
    };
    flight->craft().on_cycle([&](std::string_view subsystem, TimePoint) {
      if (subsystem != "MANIPULATOR") return;
      seen.torque_n_m = std::max({seen.torque_n_m, std::abs(robot->arm().joint_torque_n_m()[0]),
                                  std::abs(robot->arm().joint_torque_n_m()[1])});
      if (leg != 2) return;
      const double force_n = robot->arm().contact().normal_force_n;
      seen.lowest_n = std::min(seen.lowest_n, force_n);
      seen.highest_n = std::max(seen.highest_n, force_n);
      ++seen.cycles;
      if (force_n <= 0) ++seen.lost;
    });
    const auto outcome = command("RUN_SCRIPT", {1});
    EXPECT_TRUE(outcome.completed);
    EXPECT_EQ(outcome.progress_reports, 4);
    EXPECT_NEAR(seen.cycles, 2000 * (0.115 / 0.020 + 0.25), 10) << "115 mm at 20 mm/s and its ramps";
    return seen;
  }
};

TEST_F(Programmes, TheContourIsFollowedInContactWithoutABump) {
  const Seen seen = along_the_contour(0);
  EXPECT_EQ(seen.lost, 0);
  EXPECT_GT(seen.lowest_n, 17);
  EXPECT_LT(seen.highest_n, 32);
  EXPECT_LT(seen.torque_n_m, 5.5);
  std::cout << "RO5 flat: " << seen.lowest_n << " to " << seen.highest_n << " N, " << seen.torque_n_m << " N m\n";
}

TEST_F(Programmes, TheContourIsFollowedInContactOverTheBump) {
  const Seen seen = along_the_contour(0.010);
  EXPECT_EQ(seen.lost, 0);
  EXPECT_GT(seen.lowest_n, 4);
  EXPECT_LT(seen.highest_n, 42);
  EXPECT_LT(seen.torque_n_m, 5.5);
  std::cout << "RO5 bump: " << seen.lowest_n << " to " << seen.highest_n << " N, " << seen.torque_n_m << " N m\n";
}

TEST_F(Programmes, TheSpringProgrammeHooksPullsAndReleases) {
  commission(start_in("automatic"));
  double largest_n = 0;
  flight->craft().on_cycle([&](std::string_view, TimePoint) {
    const Vec2 force = robot->arm().spring_force_n();
    largest_n = std::max(largest_n, std::hypot(force[0], force[1]));
  });
  const auto outcome = command("RUN_SCRIPT", {2});
  EXPECT_TRUE(outcome.completed);
  EXPECT_EQ(outcome.progress_reports, 4);
  EXPECT_GT(largest_n, 5);
  EXPECT_LE(largest_n, 12.1) << "400 N/m times 30 mm at most";
  EXPECT_FALSE(robot->arm().hooked_spring());
}

TEST_F(Programmes, AreRefusedWhereTheyMakeNoSense) {
  commission(start_in("automatic"));
  ASSERT_TRUE(robot->fault("hook 2"));
  run(10ms);
  EXPECT_EQ(command("RUN_SCRIPT", {1}).failure, FailureCode::WrongStatus) << "a spring is hooked";
  ASSERT_TRUE(robot->fault("release"));
  run(10ms);
  EXPECT_EQ(command("MOVE_TO", {-0.8, 1.6, 1}).failure, FailureCode::WrongMode);
  EXPECT_TRUE(flight->set_mode("standalone").completed);
  EXPECT_EQ(command("RUN_SCRIPT", {1}).failure, FailureCode::WrongMode);
}

TEST_F(Programmes, AHookThatFindsNoSpringAbortsTheProgramme) {
  Plan plan = start_in("automatic");
  simulation::ArmParameters arm;
  arm.hook_reach_m = 0;  // the real spring is out of reach although the controller believes it is there
  plan.devices["hirosco-sim-robot"] = [arm](FlowFactory& flows, const FlowAddress& address,
                                            const simulation::SimulatedDevice::Settings& settings) {
    return std::make_unique<RobotDevice>(flows, address, settings, arm);
  };
  commission(std::move(plan));
  const auto outcome = command("RUN_SCRIPT", {2});
  EXPECT_FALSE(outcome.completed);
  EXPECT_EQ(outcome.failure, FailureCode::DeviceError);
  EXPECT_EQ(flight->state("MANIPULATOR"), State::Operational);
  EXPECT_TRUE(command("HOME").completed) << "and the arm is free for the next command";
}

// --- FC2: temperature --------------------------------------------------------------------------------------------------

struct Heat : RokvissFlight {
  void commission_hot() {
    commission(start_in("telepresence"));
    flight->story().on_line = [this](std::string_view line) {
      if (line.find("TEMPERATURE_") != line.npos) times_s.push_back(seconds(flight->craft().now() - began));
    };
  }
  TimePoint began{};
  std::vector<double> times_s;
};

TEST_F(Heat, AJointThatHoldsATorqueWarmsUpAsTheClosedFormSays) {
  commission_hot();
  ASSERT_TRUE(robot->fault("friction off"));
  ASSERT_TRUE(flight->device<JoystickDevice>("joystick").hand("cartesian 0.02959 0 1"));
  run(8s);
  const double torque_n_m = std::abs(robot->arm().joint_torque_n_m()[1]);
  EXPECT_NEAR(torque_n_m, 11.5, 0.05) << "the hold of the closed form, just below the limit of 12";
  // From the ambient temperature, 20 times as fast as nature.
  ASSERT_TRUE(robot->fault("temperature 2 20"));
  ASSERT_TRUE(robot->fault("thermal_accel 20"));
  began = flight->craft().now();
  run(25s);
  const auto reaches_s = [&](double celsius) {
    const double rise = 4 * 0.12 * torque_n_m * torque_n_m;
    return -240 * std::log(1 - (celsius - 20) / rise);
  };
  ASSERT_GE(times_s.size(), 2U);
  EXPECT_NEAR(times_s[0] * 20, reaches_s(55), 0.2);
  EXPECT_NEAR(times_s[1] * 20, reaches_s(70), 0.2);
  EXPECT_NEAR(reaches_s(55), 192.4, 3);
  EXPECT_NEAR(reaches_s(70), 371.9, 8);
  EXPECT_EQ(
      flight->story().missing_in_order({"MANIPULATOR low TEMPERATURE_WARNING",
                                        "MANIPULATOR medium TEMPERATURE_CRITICAL", "MANIPULATOR to SafeOperational"}),
      "");
  EXPECT_EQ(flight->state("MANIPULATOR"), State::SafeOperational);
  // It cools, and an operator brings it back.
  EXPECT_LT(robot->arm().temperature_c()[1], 55);
  EXPECT_TRUE(flight->set_state("MANIPULATOR", State::Operational).completed);
  run(100ms);
  EXPECT_EQ(flight->inhibited("MANIPULATOR"), 0U);
}

TEST_F(Heat, StillTooHotItIsSentBackToSafeOperational) {
  commission_hot();
  ASSERT_TRUE(robot->fault("temperature 1 72"));
  ASSERT_TRUE(flight->run_until_state("MANIPULATOR", State::SafeOperational, 1s));
  run(100ms);
  static_cast<void>(flight->set_state("MANIPULATOR", State::Operational));
  run(500ms);
  EXPECT_EQ(flight->state("MANIPULATOR"), State::SafeOperational);
  EXPECT_EQ(flight->story().count("TEMPERATURE_CRITICAL"), 4U) << "told twice, and a plan named it twice";
}

TEST_F(Heat, TheMaximumShutsTheNetworkDown) {
  commission_hot();
  ASSERT_TRUE(robot->fault("temperature 1 82"));
  EXPECT_TRUE(flight->run_until_state("MANIPULATOR", State::Offline, 2s));
  EXPECT_TRUE(flight->run_until_state("JOYSTICK", State::Offline, 2s));
  EXPECT_TRUE(flight->story().has("MANIPULATOR high TEMPERATURE_MAXIMUM"));
}

}  // namespace
}  // namespace hirosco::testing
