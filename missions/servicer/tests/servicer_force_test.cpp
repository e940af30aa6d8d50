// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "hirosco/descriptor/read/read.hpp"
#include "missions/servicer/scenarios/servicer_craft.hpp"
#include "subsystems/robot_arm/testing/sensing.hpp"

/// The servicer's arm with a sensor of force and moment at its tip (docs/adr/0245), in the world, with the noise of the base's pose: its device tells what the world's tip feels.
namespace hirosco::simulation {
namespace {

/// Of a sensor for tender things: 20 N and 2 N m, of which 6 N and 0.6 N m are a contact.
[[nodiscard]] std::string with_tender_sensor() {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.xml"};
  std::string text = robot_arm::testing::with_force_sensor_on_a_floating_base(descriptor::file_system()(file).value());
  for (const auto& [from, to] :
       {std::pair<std::string_view, std::string_view>{R"(init="100" minimum="100" maximum="100")",
                                                      R"(init="20" minimum="20" maximum="20")"},
        {R"(init="10" minimum="10" maximum="10")", R"(init="2" minimum="2" maximum="2")"}})
    text.replace(text.find(from), from.size(), to);
  return text;
}
[[nodiscard]] ServicerOptions feeling_in(const char* mode) {
  return {.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/servicer/mission.xml",
          .mode = mode,
          .files = {{"floating_arm.xml", with_tender_sensor()}},
          .arm_settings = {{"force_sensor", "on", {}}}};
}
[[nodiscard]] bool told(ServicerCraft& craft, std::string_view words) { return craft.flight().story().has(words); }
[[nodiscard]] std::string story(ServicerCraft& craft) { return craft.flight().story().text(); }
/// Of the first contact of its wrist.
[[nodiscard]] double felt_n(ServicerCraft& craft) {
  const std::string text = story(craft);
  constexpr std::string_view words = "WRIST_CONTACT FORCE=";
  const auto at = text.find(words);
  return at == std::string::npos ? NAN : std::atof(text.c_str() + at + words.size());
}
[[nodiscard]] bool fault(ServicerCraft& craft, std::string_view line) {
  return craft.flight().device<MujocoDevice>("arm").fault(line).has_value();
}
/// As long the other way as it was pushed: little momentum is left, with which the craft would drift on and its tool lag.
void push_back(ServicerCraft& craft, std::string_view line, double seconds) {
  ASSERT_TRUE(fault(craft, line));
  craft.run(seconds);
  ASSERT_TRUE(fault(craft, "push 0 0 0"));
}
[[nodiscard]] CommandOutcome moves_tool(ServicerCraft& craft, double x_m, double seconds) {
  return craft.craft().command("MCS", "MOVE_TOOL", {x_m, 0.0, 0.0, seconds}, 60s);
}

/// A load in orbit weighs nothing, and what it takes to accelerate it is little: none of it is a contact.
TEST(ServicerWrist, FeelsNothingOfItsOwnWaysNorOfWhatItCarriesInEachLaw) {
  for (const char* mode : {"joints", "track", "approach"}) {
    ServicerCraft craft{feeling_in(mode)};
    ASSERT_TRUE(fault(craft, "payload 20"));
    ASSERT_TRUE(craft.craft().command("MCS", "SET_PAYLOAD", {20.0, 0.0, 0.0, 0.0}, 2s).completed) << story(craft);
    EXPECT_TRUE(moves_tool(craft, 0.05, 8).completed) << mode << '\n' << story(craft);
    EXPECT_FALSE(told(craft, "CONTACT")) << mode << '\n' << story(craft);
    EXPECT_FALSE(told(craft, "FORCE_SENSOR_LOST")) << mode;
  }
}

/// 9 N, of which no joint feels as much as would stop it: the motion ends, and the arm stands.
TEST(ServicerWrist, FeelsWhoPushesItsToolBeforeAnyJointDoesAndStands) {
  ServicerCraft craft{feeling_in("track")};
  const double began_s = craft.begin("MOVE_TOOL", {0.1, 0.0, 0.0, 8.0});
  craft.run(3);
  ASSERT_TRUE(fault(craft, "push -9 0 0"));
  craft.run(0.2);
  EXPECT_TRUE(told(craft, "MCS low WRIST_CONTACT")) << story(craft);
  EXPECT_NEAR(felt_n(craft), 9, 0.5) << "as hard as its world pushes";
  EXPECT_FALSE(told(craft, "MCS low CONTACT")) << story(craft);
  ASSERT_NO_FATAL_FAILURE(push_back(craft, "push 9 0 0", 0.2));
  craft.run(began_s + 10 - craft.time_s());
  EXPECT_FALSE(told(craft, "MOTION_DONE"));
  EXPECT_LT(craft.fastest_joint_rad_s(), 0.01) << "it stands, but for the noise of the pose";
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u);
  EXPECT_EQ(craft.flight().state("MCS"), State::Operational);
}

TEST(ServicerWrist, GoesBackByTheWayItCameForWhomItsWristMeets) {
  ServicerCraft craft{feeling_in("track")};
  ASSERT_TRUE(craft.craft().command("MCS", "SET_CONTACT", {Value{Number{std::uint8_t{3}}}, Value{0.3}}, 2s).completed);
  static_cast<void>(craft.begin("MOVE_TOOL", {0.1, 0.0, 0.0, 8.0}));
  craft.run(4);
  ASSERT_TRUE(fault(craft, "push -9 0 0"));
  craft.run(0.1);
  ASSERT_TRUE(fault(craft, "push 0 0 0"));
  craft.run(10);
  EXPECT_TRUE(told(craft, "MCS low WRIST_CONTACT")) << story(craft);
  EXPECT_TRUE(told(craft, "MCS info RETRACTED")) << story(craft);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u);
}

TEST(ServicerWrist, LeavesTheWatchToItsJointsWhereItTellsNothing) {
  ServicerCraft craft{feeling_in("track")};
  ASSERT_TRUE(fault(craft, "force_sensor silent"));
  craft.run(0.2);
  EXPECT_TRUE(told(craft, "MCS low FORCE_SENSOR_LOST")) << story(craft);
  ASSERT_TRUE(fault(craft, "push -9 0 0"));
  craft.run(0.3);
  EXPECT_FALSE(told(craft, "WRIST_CONTACT")) << story(craft);
  ASSERT_NO_FATAL_FAILURE(push_back(craft, "push 9 0 0", 0.3));
  craft.run(2);
  EXPECT_TRUE(moves_tool(craft, 0.02, 4).completed) << story(craft);
  ASSERT_TRUE(fault(craft, "push -40 0 0"));
  craft.run(0.2);
  EXPECT_TRUE(told(craft, "MCS low CONTACT")) << story(craft);
}

}  // namespace
}  // namespace hirosco::simulation
