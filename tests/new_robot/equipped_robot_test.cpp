// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"
#include "tools/new_folder/robot.hpp"

/// An arm with fingers of which `hirosco new robot --homing --wrist-sensor` makes a folder, flown on virtual time with nothing edited, judged by what its world tells.
namespace hirosco::tools {
namespace {

namespace fs = std::filesystem;

struct EquippedRobot : ::testing::Test {
  fs::path folder = fs::temp_directory_path() / fmt::format("hirosco-equipped-robot-{}", ::getpid());
  std::optional<NewRobot> robot;
  std::optional<simulation::Flight> flown;

  void fly(const Equipment& equipment) {
    const auto judged = judge_robot(fs::path{HIROSCO_SOURCE_DIR} / "missions/arm_and_fingers/page/arm_and_fingers.urdf",
                                    descriptor::file_system(), "palm", "left_slide");
    ASSERT_TRUE(judged.robot);
    robot = judged.robot;
    const auto name = new_name("made").value();
    const auto made = make_folder(fs::path{HIROSCO_SOURCE_DIR} / "templates/robot", folder / "made", name,
                                  parts_of(*robot, name, equipment));
    ASSERT_TRUE(made) << made.error();
    flown.emplace(simulation::Plan{.mission = folder / "made/mission.xml"});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  void TearDown() override {
    flown.reset();
    fs::remove_all(folder);
  }
  simulation::SimulatedDevice& arm() { return *flown->craft().device("made"); }
  [[nodiscard]] double told(const std::string& what) {
    const std::string words = " " + arm().truth(), name = " " + what + "=";
    const auto at = words.find(name);
    return at == std::string::npos ? NAN : std::atof(words.c_str() + at + name.size());
  }
  /// How far the joint that is farthest off is from the goal of its README, in its world.
  [[nodiscard]] double off_goal() {
    double most = 0;
    for (std::size_t i = 0; i < robot->goal.size(); ++i)
      most = std::max(most, std::abs(told(fmt::format("q{}", i + 1)) - robot->goal[i]));
    return most;
  }
  [[nodiscard]] bool goes_to_its_goal() {
    std::vector<Value> numbers(robot->goal.begin(), robot->goal.end());
    numbers.emplace_back(0.5);
    return flown->craft().command("MADE", "MOVE_J", numbers, 60s).completed;
  }
};

TEST_F(EquippedRobot, FindsItsZerosWhereItIsMadeThenWorksAndFeelsAtItsWrist) {
  ASSERT_NO_FATAL_FAILURE(fly({.homing = true, .wrist_sensor = true}));
  EXPECT_FALSE(flown->set_mode("operation").completed) << "it does not know its zeros yet";
  ASSERT_TRUE(flown->set_mode("homing").completed) << flown->story().text();
  ASSERT_TRUE(flown->craft().command("MADE", "HOME", {}, 60s).completed) << flown->story().text();
  for (std::size_t i = 0; i < robot->goal.size(); ++i) EXPECT_EQ(told(fmt::format("referenced_{}", i + 1)), 1) << i;
  ASSERT_TRUE(flown->set_mode("operation").completed) << flown->story().text();
  ASSERT_TRUE(goes_to_its_goal()) << flown->story().text();
  EXPECT_LT(off_goal(), 1e-3) << "where it says that it is it is";
  ASSERT_TRUE(arm().fault(fmt::format("push 0 0 -{}", 0.5 * robot->wrist_range_n)));
  flown->craft().run(200ms);
  EXPECT_TRUE(flown->story().has("MADE low WRIST_CONTACT")) << flown->story().text();
  EXPECT_FALSE(flown->story().has("MADE low CONTACT")) << "joints feel no third of what they would stop for";
  EXPECT_EQ(flown->state("MADE_GRIPPER"), State::Operational);
  ASSERT_TRUE(arm().fault("encoders forget"));
  flown->craft().run(1s);
  EXPECT_TRUE(flown->story().has("MADE medium NOT_REFERENCED")) << flown->story().text();
}

TEST_F(EquippedRobot, HasASensorOnTheGroundWhereItWeighsSomething) {
  ASSERT_NO_FATAL_FAILURE(fly({.wrist_sensor = true}));
  ASSERT_TRUE(goes_to_its_goal()) << flown->story().text();
  EXPECT_LT(off_goal(), 1e-3);
  EXPECT_FALSE(flown->story().has("CONTACT")) << "what it weighs itself is none\n" << flown->story().text();
  ASSERT_TRUE(arm().fault(fmt::format("push 0 0 -{}", 0.5 * robot->wrist_range_n)));
  flown->craft().run(200ms);
  EXPECT_TRUE(flown->story().has("MADE low WRIST_CONTACT")) << flown->story().text();
  ASSERT_TRUE(arm().fault("force_sensor silent"));
  flown->craft().run(200ms);
  EXPECT_TRUE(flown->story().has("MADE low FORCE_SENSOR_LOST")) << flown->story().text();
}

}  // namespace
}  // namespace hirosco::tools
