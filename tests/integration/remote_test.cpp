// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "tests/integration/flight.hpp"

namespace hirosco::testing {
namespace {

using pus::FailureCode;
using simulation::JoystickDevice;
using simulation::RobotDevice;

/// Of the independent loop (missions/rokviss/tests/independent_loop_test.cpp), with friction and a hand that takes 3 s.
constexpr double undelayed_n = 45.80;

struct Remote : ::testing::Test {
  void commission(const char* mode = "remote") {
    flight.emplace(Plan{.edit = [mode](descriptor::Mission& mission) {
      hand_rests(mission);
      mission.start_mode = mode;
    }});
    ASSERT_TRUE(flight->commission()) << flight->story().text();
    robot = &flight->device<RobotDevice>("robot");
    joystick = &flight->device<JoystickDevice>("joystick");
  }
  simulation::CommandOutcome command(std::string_view subsystem, std::string_view function,
                                     const std::vector<Value>& arguments) {
    return flight->craft().command(subsystem, function, arguments);
  }
  /// RO7: the hand intends 22.6 mm from home in 3 s; contact is judged from 4 s on, the force as the mean of the eighth
  /// second: it still relaxes, as friction gives way slowly, also where nothing is delayed.
  void press() {
    flight->craft().on_cycle([this](std::string_view subsystem, TimePoint) {
      if (subsystem != "MANIPULATOR") return;
      for (const double torque : robot->arm().joint_torque_n_m()) peak_n_m = std::max(peak_n_m, std::abs(torque));
      ++cycles;
      sum_n += robot->arm().contact().normal_force_n;
      if (robot->arm().contact().normal_force_n <= 0) ++lost;
    });
    ASSERT_TRUE(joystick->hand("cartesian 0.0226 0 3"));
    flight->craft().run(4s);
    cycles = lost = 0;
    flight->craft().run(3s);
    const double before_n = sum_n, cycles_before = cycles;
    flight->craft().run(1s);
    end_force_n = (sum_n - before_n) / (cycles - cycles_before);
  }

  std::optional<Flight> flight;
  RobotDevice* robot{nullptr};
  JoystickDevice* joystick{nullptr};
  double peak_n_m{0}, cycles{0}, lost{0}, sum_n{0}, end_force_n{0};
};

TEST_F(Remote, EveryDeviceAndSubsystemMakesItsCyclesWhateverTheRatioOfTheirPeriods) {
  for (const char* mode : {"remote", "telepresence"}) {
    commission(mode);
    const auto made = [&] {
      return std::vector<double>{static_cast<double>(robot->cycles()), static_cast<double>(joystick->cycles()),
                                 static_cast<double>(flight->cycles("MANIPULATOR")),
                                 static_cast<double>(flight->cycles("JOYSTICK")),
                                 static_cast<double>(flight->cycles("COMMUNICATION"))};
    };
    const auto before = made();
    flight->craft().run(10s);
    const auto after = made();
    const bool remote = std::string_view{mode} == "remote";
    const std::vector<double> expected{20'000, 20'000, 20'000, remote ? 5'000.0 : 20'000.0, remote ? 5'000.0 : 1'000.0};
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(after[i] - before[i], expected[i], 1) << mode << ' ' << i;
  }
}

TEST_F(Remote, WithPassivityTheDelayedHandRestsOnTheRail) {
  for (const double delay_ms : {20.0, 30.0, 60.0}) {
    commission();
    ASSERT_TRUE(command("COMMUNICATION", "SET_DELAY", {delay_ms, 0}).completed);
    peak_n_m = 0;
    press();
    std::cout << fmt::format(
        "RO7 {} ms, passivity on: contact lost {:.1f} %, peak torque {:.2f} N m, end force {:.2f} N\n", delay_ms,
        100 * lost / cycles, peak_n_m, end_force_n);
    EXPECT_EQ(lost, 0);
    EXPECT_LT(peak_n_m, 12);
    EXPECT_NEAR(end_force_n, undelayed_n, 0.01 * undelayed_n);
    EXPECT_EQ(flight->state("MANIPULATOR"), State::Operational);
  }
}

TEST_F(Remote, WithoutPassivityItBouncesUntilTheTorqueLimitTrips) {
  for (const double delay_ms : {20.0, 30.0, 60.0}) {
    commission();
    ASSERT_TRUE(command("COMMUNICATION", "SET_DELAY", {delay_ms, 0}).completed);
    ASSERT_TRUE(command("JOYSTICK", "PASSIVITY", {0}).completed);
    press();
    EXPECT_GT(peak_n_m, 12) << delay_ms;
    EXPECT_TRUE(flight->story().has("MANIPULATOR medium TORQUE_LIMIT_EXCEEDED")) << delay_ms;
    EXPECT_EQ(flight->state("MANIPULATOR"), State::SafeOperational);
  }
}

TEST_F(Remote, TheLossesOfTheRealLinkDoNotShow) {
  commission();
  ASSERT_TRUE(command("COMMUNICATION", "SET_DELAY", {30, 0.001}).completed);
  press();
  EXPECT_EQ(lost, 0);
  EXPECT_NEAR(end_force_n, undelayed_n, 0.01 * undelayed_n);
}

TEST_F(Remote, AnEndOfTheLinkHoldsTheRobotAndIsTold) {
  commission();
  ASSERT_TRUE(joystick->hand("sine 1 0.15 0.5"));
  flight->craft().run(2s);
  ASSERT_TRUE(command("COMMUNICATION", "SET_DELAY", {20, 1}).completed);
  flight->craft().run(1s);
  const auto held = robot->arm().state().link_rad;
  flight->craft().run(2s);
  EXPECT_NEAR(robot->arm().state().link_rad[0], held[0], 1e-4);
  EXPECT_EQ(joystick->motor_torque_n_m(), (simulation::Vec2{}));
  EXPECT_TRUE(flight->story().has("COMMUNICATION medium GROUND_LINK_LOST"));
  ASSERT_TRUE(command("COMMUNICATION", "SET_DELAY", {20, 0}).completed);
  double fastest_rad_s = 0;
  flight->craft().on_cycle([&](std::string_view, TimePoint) {
    fastest_rad_s = std::max(fastest_rad_s, std::abs(robot->arm().state().link_rad_s[0]));
  });
  flight->craft().run(2s);
  EXPECT_TRUE(flight->story().has("COMMUNICATION info GROUND_LINK_RESTORED"));
  EXPECT_LT(fastest_rad_s, 0.8) << "it follows from where the hand is now, at 0.47 rad/s and what its start adds";
}

TEST_F(Remote, AnUnpluggedJoystickTakesTheNetworkDownButNotTheGroundLink) {
  commission();
  ASSERT_TRUE(joystick->fault("unplug"));
  EXPECT_TRUE(flight->run_until_state("MANIPULATOR", State::Offline, 2s));
  EXPECT_TRUE(flight->run_until_state("JOYSTICK", State::Offline, 2s));
  EXPECT_TRUE(flight->story().has("network {MANIPULATOR, JOYSTICK} to ErrorOperational and down"));
  EXPECT_EQ(flight->state("COMMUNICATION"), State::Operational);
}

TEST_F(Remote, AGroundLinkWhoseSetsAreGoneWithItComesBackWithoutThem) {
  commission();
  flight->craft().kill("COMMUNICATION");
  flight->craft().run(2s);
  EXPECT_TRUE(flight->story().has("the ground link is back")) << flight->story().text();
  EXPECT_FALSE(flight->story().has("the ground link did not come back"));
  EXPECT_EQ(flight->state("COMMUNICATION"), State::Operational);
  EXPECT_TRUE(command("SUPERVISOR", "SAFE_ALL", {}).completed);
}

TEST_F(Remote, ADelayIsRefusedWhereNoSetsTravelOverTheGroundLink) {
  commission("telepresence");
  EXPECT_EQ(command("COMMUNICATION", "SET_DELAY", {20, 0}).failure, FailureCode::WrongMode);
  ASSERT_TRUE(flight->set_mode("commissioning").completed);
  ASSERT_TRUE(flight->enter_mode("remote").completed);
  EXPECT_EQ(command("COMMUNICATION", "SET_DELAY", {20, 0}).failure, FailureCode::NotPermittedNow);
}

/// From one configuration of the craft to the next by telecommands of the ground, without a restart.
struct Switching : Remote {
  void done(const simulation::CommandOutcome& outcome, const std::string& what) {
    ASSERT_TRUE(outcome.completed) << what << ": "
                                   << (outcome.failure ? std::string{to_text(*outcome.failure)} : "no answer") << "\n"
                                   << flight->story().text();
  }
  void switch_to(const std::string& mode) {
    done(flight->set_mode("commissioning"), "commissioning");
    const auto& commission = flight->mission().find_mode(mode)->commission;
    for (const char* name : {"MANIPULATOR", "JOYSTICK", "COMMUNICATION"}) {
      if (flight->state(name) == State::Operational) done(flight->set_state(name, State::SafeOperational), "safe");
      if (flight->state(name) == State::SafeOperational) done(flight->set_state(name, State::PostOperational), "post");
      if (flight->state(name) != State::PreOperational) done(flight->set_state(name, State::PreOperational), "pre");
    }
    for (const auto& step : commission) done(flight->configure(step.subsystem, step.configuration), step.configuration);
    for (const auto link : flight->mission().find_mode(mode)->establish)
      done(command("SUPERVISOR", "LINK", {static_cast<double>(link)}), "link");
    for (const State state : {State::SafeOperational, State::Operational})
      for (const auto& step : commission) done(flight->set_state(step.subsystem, state), step.subsystem);
    done(flight->set_mode(mode), mode);
  }
};

TEST_F(Switching, AllFiveConfigurationsFollowOneAnotherInOneFlight) {
  commission("telepresence");
  for (const char* mode : {"feel", "remote", "automatic", "standalone", "remote", "telepresence"}) {
    ASSERT_NO_FATAL_FAILURE(switch_to(mode)) << mode;
    flight->craft().run(200ms);
    for (const auto& step : flight->mission().find_mode(mode)->commission) {
      EXPECT_EQ(flight->state(step.subsystem), State::Operational) << mode << " " << step.subsystem;
      EXPECT_EQ(flight->inhibited(step.subsystem), 0U) << mode << " " << step.subsystem;
    }
  }
  const auto before = robot->arm().state().link_rad;
  ASSERT_TRUE(joystick->hand("hold 0.1 0"));
  flight->craft().run(2s);
  EXPECT_NEAR(robot->arm().state().link_rad[0] - before[0], 0.1, 5e-3) << "and the robot follows the hand as at first";
}

}  // namespace
}  // namespace hirosco::testing
