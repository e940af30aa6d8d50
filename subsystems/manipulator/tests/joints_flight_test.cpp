// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "subsystems/manipulator/testing/described_arm.hpp"

/// hirosco-arm as a program that a mission names: loaded, commissioned and flown on virtual time, with any number of joints, judged by what its
/// world tells.
namespace hirosco {
namespace {

using manipulator::testing::described_arm;
using manipulator::testing::home_rad;

const std::filesystem::path folder{HIROSCO_SOURCE_DIR "/subsystems/manipulator/tests"};
constexpr std::size_t joints_of_the_file = 6;
constexpr Duration watchdog = std::chrono::milliseconds{10};  // as STANDALONE declares it
constexpr double move_s = 2.0, tolerance_rad = 0.005, rests_rad_s = 2e-3;

struct JointsFlight {
  std::optional<simulation::Flight> flown;

  void fly(const std::string& mission, std::map<std::string, std::string> files,
           std::function<void(descriptor::Mission&)> edit = {}) {
    flown.emplace(simulation::Plan{.mission = folder / mission, .edit = std::move(edit), .files = std::move(files)});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  simulation::SimulatedDevice& device(std::string_view name) { return *flown->craft().device(name); }
  double word(std::string_view name, const std::string& wanted) {
    const std::string words = " " + device(name).truth();
    const auto at = words.find(" " + wanted + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + wanted.size() + 2);
  }
  /// Of each joint.
  std::vector<double> told(std::string_view name, const std::string& wanted) {
    std::vector<double> found;
    const auto joints = static_cast<std::size_t>(word(name, "joints"));
    for (std::size_t i = 1; i <= joints; ++i) found.push_back(word(name, wanted + std::to_string(i)));
    return found;
  }
  /// Of all motors and links.
  double fastest_rad_s(std::string_view name) {
    double most = 0;
    for (const char* wanted : {"qd", "motor_qd"})
      for (const double rate : told(name, wanted)) most = std::max(most, std::abs(rate));
    return most;
  }
  /// Each joint another way, all nearly as fast as they may.
  static std::vector<double> goal_of(std::size_t joints) {
    std::vector<double> goal;
    for (std::size_t i = 0; i < joints; ++i) {
      const double way = 0.6 + 0.05 * static_cast<double>(i % manipulator::testing::different);
      goal.push_back(home_rad(i) + (i % 2 == 0 ? -way : way));
    }
    return goal;
  }
  static std::vector<double> home_of(std::size_t joints) {
    std::vector<double> home;
    for (std::size_t i = 0; i < joints; ++i) home.push_back(home_rad(i));
    return home;
  }
  simulation::CommandOutcome move_to(std::string_view subsystem, const std::vector<double>& goal,
                                     Duration limit = 10s) {
    std::vector<Value> numbers(goal.begin(), goal.end());
    numbers.emplace_back(move_s);
    return flown->craft().command(subsystem, "MOVE_TO", numbers, limit);
  }
  void expect_reaches(std::string_view subsystem, std::string_view name, const std::vector<double>& goal) {
    const auto outcome = move_to(subsystem, goal);
    EXPECT_TRUE(outcome.completed) << flown->story().text();
    EXPECT_EQ(outcome.progress_reports, 1);
    expect_at(name, goal);
    EXPECT_EQ(flown->inhibited(subsystem), 0U) << flown->story().text();
  }
  void expect_at(std::string_view name, const std::vector<double>& where) {
    const auto now = told(name, "q");
    ASSERT_EQ(now.size(), where.size());
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(now[i], where[i], tolerance_rad) << "joint " << i + 1;
  }
  /// Sets out, and is where it is fastest.
  void be_under_way(std::string_view subsystem, std::string_view name, const std::vector<double>& goal) {
    ASSERT_TRUE(move_to(subsystem, goal, 1s).started) << flown->story().text();
    ASSERT_TRUE(device(name).active());
    ASSERT_GT(fastest_rad_s(name), 0.5);
  }
  /// By itself, once its command is taken away: at rest within what is declared, held by its brakes then, and nothing drives it any more.
  void expect_stops(std::string_view name, Duration noticed_after) {
    const Duration declared = device(name).settings().stop_within, step = std::chrono::milliseconds{1};
    ASSERT_GT(declared, Duration{0});
    const auto begun = told(name, "q");
    Duration rests_after{};
    for (Duration past{}; past < noticed_after + declared; past += step) {
      flown->craft().run(step);
      if (fastest_rad_s(name) > rests_rad_s) rests_after = past + step;
    }
    flown->craft().run(step);
    std::cout << fmt::format("  {} rests after {:.0f} ms, {:.0f} ms are declared\n", name, 1e3 * seconds(rests_after),
                             1e3 * seconds(declared));
    EXPECT_LT(fastest_rad_s(name), rests_rad_s);
    EXPECT_EQ(device(name).output(), DeviceOutput::Holding);
    const auto where = told(name, "q");
    for (std::size_t i = 0; i < where.size(); ++i) EXPECT_GT(std::abs(where[i] - begun[i]), 1e-3) << "it coasted";
    const auto push = [&](double n_m) {
      for (std::size_t i = 1; i <= where.size(); ++i) {
        ASSERT_TRUE(device(name).fault(fmt::format("push {} {}", i, n_m)));
      }
    };
    constexpr double pushed_n_m = 20, gives_way_rad = 0.02;  // gears and brakes, 4000 N m/rad each
    for (int i = 0; i < 1000; ++i) {
      flown->craft().run(step);
      if (i == 200) push(pushed_n_m);
      if (i == 700) {
        const auto pushed = told(name, "q");
        for (std::size_t k = 0; k < where.size(); ++k)
          EXPECT_NEAR(pushed[k], where[k], gives_way_rad) << "joint " << k + 1;
        push(0);
      }
      ASSERT_FALSE(device(name).drives()) << i << " ms later\n" << flown->story().text();
    }
    const auto later = told(name, "q");
    for (std::size_t i = 0; i < where.size(); ++i) EXPECT_NEAR(later[i], where[i], 1e-3) << "joint " << i + 1;
  }
  /// An operator brings up again what a fault took down.
  void fly_again(std::string_view subsystem, std::string_view name, const std::vector<double>& goal) {
    flown->craft().run(3s);
    ASSERT_EQ(flown->state(subsystem), State::Offline) << flown->story().text();
    ASSERT_FALSE(device(name).drives()) << "nothing of it came back by itself";
    ASSERT_TRUE(flown->set_mode("operation").completed) << flown->story().text();
    ASSERT_EQ(flown->state(subsystem), State::Operational);
    expect_reaches(subsystem, name, goal);
  }
};

struct AnyJoints : ::testing::TestWithParam<std::size_t>, JointsFlight {
  const std::size_t n = GetParam();
  const std::vector<double> goal = goal_of(n), home = home_of(n);

  void SetUp() override {
    if (n == joints_of_the_file) return fly("mission.xml", {});
    fly("mission.xml", {{"arm.xml", described_arm(n)}},
        [this](descriptor::Mission& mission) { mission.devices.at(0).settings.at(0).value = std::to_string(n); });
  }
};

TEST_P(AnyJoints, AreCommissionedAndReachTheirGoalsInTheWorld) {
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  EXPECT_EQ(flown->inhibited("ARM"), 0U);
  ASSERT_EQ(told("arm", "q").size(), n);
  expect_at("arm", home);
  expect_reaches("ARM", "arm", goal);
  EXPECT_TRUE(flown->craft().command("ARM", "HOME", {}, 10s).completed) << flown->story().text();
  expect_at("arm", home);
  EXPECT_EQ(flown->story().count("ARM info MOTION_DONE"), 2U) << flown->story().text();
}

TEST_P(AnyJoints, ThatAreUnpluggedInMotionStopAsDeclaredAndFlyAgainWhenTheyAreAskedTo) {
  ASSERT_NO_FATAL_FAILURE(be_under_way("ARM", "arm", goal));
  ASSERT_TRUE(device("arm").fault("unplug"));
  ASSERT_NO_FATAL_FAILURE(expect_stops("arm", Duration{0}));
  EXPECT_TRUE(flown->story().has("ARM high ROBOT_LOST")) << flown->story().text();
  const auto now = told("arm", "q");
  for (std::size_t i = 0; i < n; ++i) EXPECT_GT(std::abs(now[i] - goal[i]), 0.1) << "it did not arrive";
  ASSERT_TRUE(device("arm").fault("plug"));
  fly_again("ARM", "arm", goal);
}

TEST_P(AnyJoints, WhoseControlIsKilledInMotionStopAsDeclaredAndFlyAgainWhenTheyAreAskedTo) {
  ASSERT_NO_FATAL_FAILURE(be_under_way("ARM", "arm", goal));
  flown->craft().kill("ARM");
  ASSERT_NO_FATAL_FAILURE(expect_stops("arm", watchdog));
  EXPECT_TRUE(flown->story().has("PROCESS_DIED")) << flown->story().text();
  fly_again("ARM", "arm", home);
}

INSTANTIATE_TEST_SUITE_P(Joints, AnyJoints, ::testing::Values(1, joints_of_the_file, 7, 16));

/// The mission of this folder with a second arm, of one joint: the same program twice.
struct TwoArms : ::testing::Test, JointsFlight {
  const std::vector<double> goal = goal_of(joints_of_the_file), wrist_goal = goal_of(1);

  void SetUp() override {
    std::string text = descriptor::file_system()(folder / "mission.xml").value();
    const auto add_before = [&text](const std::string& line, const std::string& more) {
      const auto at = text.find(line);
      ASSERT_NE(at, text.npos) << line;
      text.insert(at, more);
    };
    add_before("<SimulatedDevice ", R"(<Subsystem executable="hirosco-arm" name="WRIST" id="21" descriptor="wrist.xml">
      <Device name="ROBOT" address="wrist" enable="wrist-enable"/></Subsystem>
    )");
    add_before("<Modes ",
               R"(<SimulatedDevice name="wrist" executable="hirosco-sim-joints" subsystem="WRIST" device="ROBOT">
      <Setting name="joints" value="1"/></SimulatedDevice>)");
    add_before(R"(<Permit subsystem="ARM")",
               R"(<Commission subsystem="WRIST" configuration="STANDALONE" state="Operational"/>
      <Permit subsystem="WRIST" functions="MOVE_TO"/>)");
    fly("mission.xml", {{"mission.xml", text}, {"wrist.xml", described_arm(1)}});
  }
};

TEST_F(TwoArms, OfOneProgramHaveEachTheirOwnNumberOfJoints) {
  ASSERT_EQ(told("arm", "q").size(), joints_of_the_file);
  ASSERT_EQ(told("wrist", "q").size(), 1U);
  ASSERT_NO_FATAL_FAILURE(be_under_way("ARM", "arm", goal));
  expect_reaches("WRIST", "wrist", wrist_goal);
  expect_at("arm", goal);
}

TEST_F(TwoArms, OfOneProgramDoNotStopForEachOther) {
  ASSERT_NO_FATAL_FAILURE(be_under_way("ARM", "arm", goal));
  ASSERT_TRUE(device("wrist").fault("unplug"));
  flown->craft().run(5s);
  EXPECT_EQ(flown->state("WRIST"), State::Offline) << flown->story().text();
  EXPECT_EQ(flown->state("ARM"), State::Operational);
  expect_at("arm", goal);
}

}  // namespace
}  // namespace hirosco
