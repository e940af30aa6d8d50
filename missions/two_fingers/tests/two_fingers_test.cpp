// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hirosco/pus/packet/failure_code.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

/// The mission two_fingers on virtual time, judged by what its world tells, which shares nothing with the gripper but a file.
namespace hirosco {
namespace {

struct TwoFingers : ::testing::Test {
  std::optional<simulation::Flight> flown;

  /// `differs`: how the world differs from the mission's own.
  void fly(const std::vector<std::string>& differs = {}) {
    flown.emplace(
        simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/two_fingers/mission.xml",
                         .subsystems = {},
                         .devices = {}});
    for (const std::string& line : differs) does(line);
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  simulation::SimulatedDevice& gripper() { return *flown->craft().device("gripper"); }
  void does(const std::string& line) {
    const auto taken = gripper().fault(line);
    ASSERT_TRUE(taken) << line << ": " << taken.error().text;
  }
  double truth(const std::string& name) {
    const std::string words = " " + gripper().truth();
    const auto at = words.find(" " + name + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + name.size() + 2);
  }
  double pressed_n() { return truth("body_box_pressed_n") / 2; }
  double width_m() { return 2 * truth("q1"); }
  simulation::CommandOutcome grip(double force_n, double speed_m_s = 0.05) {
    return flown->craft().command("GRIPPER", "GRIP", {force_n, speed_m_s}, 20s);
  }
  /// It holds the box with 20 N, and the table is gone.
  void lift() {
    fly();
    const auto outcome = grip(20);
    ASSERT_TRUE(outcome.completed) << flown->story().text();
    EXPECT_EQ(outcome.progress_reports, 1);
    does("obstacle_table none");
  }
  static std::uint16_t code(const simulation::CommandOutcome& outcome) {
    return static_cast<std::uint16_t>(outcome.failure.value_or(pus::FailureCode{}));
  }
};

TEST(TwoFingersPage, ShowsTheGripperThatFlies) {
  const auto text = [](const char* file) {
    return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / file).value();
  };
  EXPECT_EQ(text("missions/two_fingers/page/robot_gripper.urdf"), text("subsystems/robot_gripper/robot_gripper.urdf"));
}

TEST_F(TwoFingers, ClosesOnALooseBoxAndHoldsItWithTheForceThatItWasToldHoweverMuchFrictionThereIs) {
  double most_off = 0;
  for (const char* friction : {"friction 0", "friction 1", "friction 3"}) {
    fly({friction});
    for (const double force_n : {10.0, 30.0, 8.0}) {
      EXPECT_TRUE(grip(force_n).completed) << flown->story().text();
      flown->craft().run(300ms);
      const double off = std::abs(pressed_n() - force_n) / force_n;
      most_off = std::max(most_off, off);
      EXPECT_LT(off, 0.05) << friction << ": " << force_n << " N";
    }
    EXPECT_NEAR(width_m(), 0.06, 1e-3);
    EXPECT_EQ(flown->inhibited("GRIPPER"), 0u);
  }
  std::cout << fmt::format("  force within {:.1f} %\n", 100 * most_off);
}

TEST_F(TwoFingers, WhatItHoldsStaysWhenTheTableGoesAndSomebodyShakesIt) {
  ASSERT_NO_FATAL_FAILURE(lift());
  flown->craft().run(1s);
  const std::array before{truth("body_box_x"), truth("body_box_y"), truth("body_box_z")};
  double most_m = 0;
  for (const char* line : {"pull_box 0 0 -10", "pull_box 0 12 0", "pull_box 5 -10 5", "gravity 0 0 -19.6",
                           "gravity 9.81 0 0", "gravity 0 0 -9.81", "pull_box 0 0 0"}) {
    does(line);
    flown->craft().run(500ms);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string name = fmt::format("body_box_{}", "xyz"[i]);
      most_m = std::max(most_m, std::abs(truth(name) - before[i]));
    }
  }
  std::cout << fmt::format("  moved {:.2f} mm, pressed with {:.2f} N then\n", 1e3 * most_m, pressed_n());
  EXPECT_LT(most_m, 2e-3);
  EXPECT_FALSE(flown->story().has("OBJECT_LOST")) << flown->story().text();
}

TEST_F(TwoFingers, TellsThatWhatItHeldIsGoneAndStandsThere) {
  ASSERT_NO_FATAL_FAILURE(lift());
  does("body_box none");
  flown->craft().run(1s);
  EXPECT_EQ(flown->story().count("GRIPPER low OBJECT_LOST"), 1u) << flown->story().text();
  EXPECT_GT(width_m(), 0.05);
  EXPECT_LT(std::abs(truth("qd1")), 1e-4);
  EXPECT_EQ(flown->state("GRIPPER"), State::Operational);
  EXPECT_EQ(code(grip(20)), 0x8005) << "nothing met";
  EXPECT_TRUE(flown->craft().command("GRIPPER", "OPEN", {0.2}, 10s).completed) << flown->story().text();
}

TEST_F(TwoFingers, LetsGoOfItWhenItOpensAndAtNothingElse) {
  ASSERT_NO_FATAL_FAILURE(lift());
  const double held_m = truth("body_box_z");
  ASSERT_TRUE(flown->set_state("GRIPPER", State::SafeOperational).completed) << flown->story().text();
  flown->craft().run(2s);
  EXPECT_NEAR(truth("body_box_z"), held_m, 1e-3) << "its brakes hold it";
  std::cout << fmt::format("  the brakes press with {:.2f} N, slipped {:.2f} mm\n", pressed_n(),
                           1e3 * (held_m - truth("body_box_z")));
  ASSERT_TRUE(flown->set_state("GRIPPER", State::Operational).completed) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_NEAR(truth("body_box_z"), held_m, 1e-3);
  EXPECT_NEAR(pressed_n(), 20, 1);
  ASSERT_TRUE(flown->craft().command("GRIPPER", "STOP", {}, 5s).completed) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_NEAR(truth("body_box_z"), held_m, 2e-3);
  ASSERT_TRUE(flown->set_state("GRIPPER", State::SafeOperational).completed);
  ASSERT_TRUE(flown->set_state("GRIPPER", State::Operational).completed);
  EXPECT_FALSE(flown->story().has("OBJECT_LOST")) << flown->story().text();
  EXPECT_TRUE(flown->craft().command("GRIPPER", "OPEN", {0.1}, 10s).completed) << flown->story().text();
  EXPECT_TRUE(flown->story().has("OBJECT_RELEASED"));
  EXPECT_LT(truth("body_box_z"), held_m - 0.5) << "it fell";
}

TEST_F(TwoFingers, AnUnpluggedGripperGoesOnHolding) {
  ASSERT_NO_FATAL_FAILURE(lift());
  const double held_m = truth("body_box_z");
  does("unplug");
  ASSERT_TRUE(flown->run_until_state("GRIPPER", State::Offline, 5s)) << flown->story().text();
  flown->craft().run(1s);
  EXPECT_NEAR(truth("body_box_z"), held_m, 2e-3);
}

TEST_F(TwoFingers, DoesNotPressByWidth) {
  fly();
  EXPECT_EQ(code(flown->craft().command("GRIPPER", "MOVE_TO", {0.03, 0.1}, 10s)), 0x8004) << flown->story().text();
  flown->craft().run(500ms);
  EXPECT_LT(pressed_n(), 5);
  EXPECT_EQ(flown->state("GRIPPER"), State::Operational);
}

TEST_F(TwoFingers, GivesTheSameOctetsTwice) {
  std::array<std::vector<supervisor::LogRecord>, 2> records;
  for (auto& each : records) {
    ASSERT_NO_FATAL_FAILURE(lift());
    does("pull_box 0 5 0");
    flown->craft().run(500ms);
    each = flown->records();
  }
  EXPECT_GT(records[0].size(), 50u);
  EXPECT_TRUE(records[0] == records[1]);
}

}  // namespace
}  // namespace hirosco
