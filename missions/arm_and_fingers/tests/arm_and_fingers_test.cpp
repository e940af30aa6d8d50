// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/spacecraft/observed_flight.hpp"

/// The mission arm_and_fingers on virtual time: two subsystems and two devices, one robot in one world.
namespace hirosco {
namespace {

constexpr std::array start{0.2, 0.3, 1.2, 0.070796, -1.570796, 0.0};
constexpr std::array lifted{0.9, 0.1, 1.0, 0.470796, -1.570796, 0.5};

struct ArmAndFingers : ::testing::Test {
  std::optional<simulation::Flight> flown;

  void fly() {
    flown.emplace(
        simulation::Plan{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/arm_and_fingers/mission.xml",
                         .subsystems = {},
                         .devices = {}});
    ASSERT_TRUE(flown->commission()) << flown->story().text();
  }
  void does(const char* device, const std::string& line) {
    const auto taken = flown->craft().device(device)->fault(line);
    ASSERT_TRUE(taken) << line << ": " << taken.error().text;
  }
  double truth(const char* device, const std::string& name) {
    const std::string words = " " + flown->craft().device(device)->truth();
    const auto at = words.find(" " + name + "=");
    return at == words.npos ? NAN : std::atof(words.c_str() + at + name.size() + 2);
  }
  double pressed_n() { return truth("arm", "body_box_pressed_n") / 2; }
  bool move_j(const std::array<double, 6>& goal) {
    std::vector<Value> numbers(goal.begin(), goal.end());
    numbers.emplace_back(0.5);
    return flown->craft().command("ARM", "MOVE_J", numbers, 70s).completed;
  }
  bool grips() { return flown->craft().command("GRIPPER", "GRIP", {20.0, 0.05}, 20s).completed; }
};

[[nodiscard]] std::string text_of(const char* file) {
  return descriptor::file_system()(std::filesystem::path{HIROSCO_SOURCE_DIR} / file).value();
}

/// Without comments, and with what may differ put back.
[[nodiscard]] std::string plain(std::string text, std::initializer_list<std::pair<std::string, std::string>> back) {
  for (auto at = text.find("<!--"); at != std::string::npos; at = text.find("<!--"))
    text.erase(at, text.find("-->", at) + 3 - at);
  for (const auto& [from, to] : back)
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  return text;
}

TEST(ArmAndFingersDescriptors, AreThoseOfTheSubsystemsButForTheRobotAndItsAddresses) {
  EXPECT_EQ(plain(text_of("missions/arm_and_fingers/arm.xml"),
                  {{"page/arm_and_fingers.urdf", "robot_arm.urdf"},
                   {"\n      <Setting name=\"FIXED\" value=\"left_slide\"/>", ""},
                   {"handed-arm", "robot-arm"}}),
            plain(text_of("subsystems/robot_arm/robot_arm.xml"), {}));
  EXPECT_EQ(plain(text_of("missions/arm_and_fingers/gripper.xml"),
                  {{"page/arm_and_fingers.urdf", "robot_gripper.urdf"},
                   {"\n      <Setting name=\"FINGERS\" value=\"left_slide\"/>", ""},
                   {"handed-gripper", "robot-gripper"}}),
            plain(text_of("subsystems/robot_gripper/robot_gripper.xml"), {}));
}

TEST_F(ArmAndFingers, TheGripperTakesABoxAndTheArmCarriesItAway) {
  fly();
  ASSERT_TRUE(grips()) << flown->story().text();
  EXPECT_NEAR(pressed_n(), 20, 1);
  const double before_m = truth("arm", "body_box_z"), tip_before_m = truth("arm", "tip_z");
  ASSERT_TRUE(move_j(lifted)) << flown->story().text();
  const double up_m = truth("arm", "body_box_z") - before_m, slipped_m = up_m - (truth("arm", "tip_z") - tip_before_m);
  std::cout << fmt::format("  lifted {:.1f} mm, slipped {:.2f} mm, pressed with {:.2f} N\n", 1e3 * up_m,
                           1e3 * slipped_m, pressed_n());
  EXPECT_NEAR(up_m, 0.166, 3e-3);
  EXPECT_NEAR(pressed_n(), 20, 1);
  EXPECT_FALSE(flown->story().has("OBJECT_LOST")) << flown->story().text();
  EXPECT_EQ(flown->inhibited("ARM"), 0u);
  does("arm", "body_box none");
  flown->craft().run(500ms);
  EXPECT_TRUE(flown->story().has("GRIPPER low OBJECT_LOST")) << flown->story().text();
  EXPECT_TRUE(move_j(start)) << flown->story().text();
}

TEST_F(ArmAndFingers, AnUnpluggedGripperIsHeldByItsBrakesInTheArmsWorldAndTheArmGoesOn) {
  fly();
  ASSERT_TRUE(grips()) << flown->story().text();
  does("gripper", "unplug");
  ASSERT_TRUE(flown->run_until_state("GRIPPER", State::Offline, 5s)) << flown->story().text();
  EXPECT_TRUE(move_j(lifted)) << flown->story().text();
  EXPECT_GT(truth("arm", "body_box_z"), 0.4) << "it was carried along";
}

TEST_F(ArmAndFingers, GivesTheSameOctetsTwice) {
  std::array<std::vector<supervisor::LogRecord>, 2> records;
  for (auto& each : records) {
    fly();
    EXPECT_TRUE(grips());
    each = flown->records();
  }
  EXPECT_GT(records[0].size(), 50u);
  EXPECT_TRUE(records[0] == records[1]);
}

}  // namespace
}  // namespace hirosco
