// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "missions/servicer/scenarios/servicer_craft.hpp"

/// The servicer's arm as springs hold it, torques drive it, and limits of force stop it (docs/adr/0235), in the world, with the noise of the base's pose.
namespace hirosco::simulation {
namespace {

using Place = ServicerCraft::Place;

[[nodiscard]] ServicerOptions servicer_in(const char* mode) {
  return {.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "missions/servicer/mission.xml", .mode = mode};
}
[[nodiscard]] double apart_m(const Place& one, const Place& other) {
  return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
}
/// Whoever pushes is no contact from now on.
void meet_nobody(ServicerCraft& craft) {
  ASSERT_TRUE(craft.craft().command("MCS", "SET_CONTACT", {Value{Number{std::uint8_t{0}}}, Value{0.3}}, 2s).completed)
      << craft.flight().story().text();
}

/// Pushed by 4 N for half a second, and for as long the other way, so that little momentum is left: springs bring the tool back to where it was in inertial axes, while the base is turned.
TEST(ServicerSprings, BringTheToolBackInInertialAxesThoughTheBaseHasTurned) {
  ServicerCraft craft{servicer_in("track")};
  ASSERT_NO_FATAL_FAILURE(meet_nobody(craft));
  ASSERT_TRUE(craft.craft().command("MCS", "IMPEDANCE_L", {300.0, 15.0, 0.9}, 2s).completed)
      << craft.flight().story().text();
  craft.run(2);
  const Place from = craft.tool_m();
  auto& arm = craft.flight().device<MujocoDevice>("arm");
  ASSERT_TRUE(arm.fault("push 0 4 0"));
  double farthest = 0;
  craft.each_cycle([&] { farthest = std::max(farthest, apart_m(craft.tool_m(), from)); });
  craft.run(0.5);
  ASSERT_TRUE(arm.fault("push 0 -4 0"));
  craft.run(0.5);
  ASSERT_TRUE(arm.fault("push 0 0 0"));
  craft.run(5);
  craft.each_cycle([] {});
  std::cout << "  pushed away by " << 1e3 * farthest << " mm, left " << 1e3 * apart_m(craft.tool_m(), from)
            << " mm, base turned by " << craft.base_deg() << " deg\n";
  EXPECT_GT(farthest, 5e-3);
  EXPECT_LT(apart_m(craft.tool_m(), from), 4e-3);
  EXPECT_GT(craft.base_deg(), 0.2);
  ASSERT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.02, 0.0, 0.0, 3.0}, 20s).completed)
      << craft.flight().story().text();
  craft.run(3);
  EXPECT_NEAR(craft.tool_m()[0] - from[0], 0.02, 4e-3);
  ASSERT_TRUE(craft.craft().command("MCS", "POSITION_CONTROL", {}, 2s).completed) << craft.flight().story().text();
  craft.run(2);
  EXPECT_NEAR(craft.tool_m()[0] - from[0], 0.02, 6e-3);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u);
}

/// The least limits: the noise of the pose presses on nobody, whoever pushes harder is told, and brakes hold the arm.
TEST(ServicerForce, IsWithinTheLeastLimitsOnItsOwnWaysAndBeyondThemItIsStopped) {
  ServicerCraft craft{servicer_in("track")};
  ASSERT_NO_FATAL_FAILURE(meet_nobody(craft));
  ASSERT_TRUE(craft.craft().command("MCS", "SET_FORCE_LIMIT", {10.0}, 2s).completed) << craft.flight().story().text();
  ASSERT_TRUE(craft.craft().command("MCS", "SET_POWER_LIMIT", {10.0, 1.0}, 2s).completed);
  EXPECT_TRUE(craft.craft().command("MCS", "MOVE_TOOL", {0.05, 0.0, 0.03, 4.0}, 20s).completed)
      << craft.flight().story().text();
  craft.run(3);
  EXPECT_FALSE(craft.flight().story().has("EXCEEDED")) << craft.flight().story().text();
  ASSERT_TRUE(craft.flight().device<MujocoDevice>("arm").fault("push -15 0 0"));
  craft.run(0.3);
  EXPECT_TRUE(craft.flight().story().has("TOOL_FORCE_EXCEEDED")) << craft.flight().story().text();
  EXPECT_NE(craft.flight().inhibited("MCS"), 0u);
}

TEST(ServicerDrive, TurnsAJointByATorqueAndTheBaseTheOtherWay) {
  ServicerCraft craft{servicer_in("joints")};
  const double from = craft.robot().position(0);
  EXPECT_TRUE(craft.craft().command("MCS", "TORQUE_J", {4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.8}, 10s).completed)
      << craft.flight().story().text();
  EXPECT_GT(craft.robot().position(0) - from, 0.02);
  craft.run(1);
  EXPECT_LT(craft.fastest_joint_rad_s(), 2e-3);
  EXPECT_LT(craft.momentum_n_m_s(), 1e-6);
  EXPECT_GT(craft.base_deg(), 0.01);
  ASSERT_TRUE(
      craft.craft().command("MCS", "IMPEDANCE_J", {400.0, 400.0, 400.0, 400.0, 20.0, 20.0, 2.0, 0.9}, 2s).completed)
      << craft.flight().story().text();
  const double stands = craft.robot().position(0);
  craft.run(2);
  EXPECT_NEAR(craft.robot().position(0), stands, 1e-3);
  EXPECT_EQ(craft.flight().inhibited("MCS"), 0u);
}

}  // namespace
}  // namespace hirosco::simulation
