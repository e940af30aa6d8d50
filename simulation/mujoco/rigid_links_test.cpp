// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/rigid_links.hpp"

#include <array>
#include <chrono>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/mujoco/mujoco_robot.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;

/// A slab on a hinge at its origin, and an antenna that is fixed beside it, turned and without a moment about one of its axes.
[[nodiscard]] std::string slab(const char* antenna, const char* carried_by = "slab") {
  return fmt::format(
      R"(<robot name="slab"><link name="base"/><link name="slab"><inertial><origin xyz="0.1 0 0"/><mass value="2"/>
    <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="slab"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="9" effort="9"/></joint>
  <link name="antenna"><inertial><mass value="1"/>{}</inertial></link>
  <joint name="screw" type="fixed"><parent link="{}"/><child link="antenna"/><origin xyz="0 0.5 0" rpy="0 {:.17g} 0"/></joint></robot>)",
      antenna, carried_by, std::numbers::pi / 2);
}
// What is about its x is about z of the slab, but for the sign.
constexpr const char* impossible = R"(<inertia ixx="0.006" ixy="0" ixz="0" iyy="0.004" iyz="0" izz="-0.001"/>)";

TEST(RigidLinks, AreOneBodyWhereOneOfThemAloneIsNone) {
  auto robot = MujocoRobot::make(slab(impossible));
  ASSERT_TRUE(robot) << robot.error();
  robot->set_gravity(0, 0, 0);
  for (int i = 0; i < 100; ++i) robot->step(std::array{0.5}, MujocoRobot::Brakes::Open, 1ms);
  const double about_hinge = 0.04 + 2 * 0.1 * 0.1 + 0.006 + 1 * 0.5 * 0.5;
  EXPECT_NEAR(robot->velocity(0), 0.1 * 0.5 / about_hinge, 1e-6);
}

TEST(RigidLinks, WeighWhatTheyWeighWhereTheyAre) {
  auto robot = MujocoRobot::make(slab(impossible)).value();
  robot.set_gravity(0, -10, 0);
  for (int i = 0; i < 500; ++i) robot.step(std::array{0.0}, MujocoRobot::Brakes::Closed, 1ms);
  EXPECT_NEAR(std::abs(robot.torque(0)), 2 * 10 * 0.1, 1e-3) << "the antenna stands above the hinge";
}

TEST(RigidLinks, ThatStandAreNobodysLoad) {
  EXPECT_TRUE(
      MujocoRobot::make(slab(R"(<inertia ixx="1e-9" ixy="0" ixz="0" iyy="1e-9" iyz="0" izz="1e-9"/>)", "base")));
}

TEST(RigidLinks, ThatAreNoBodyTogetherAreRefused) {
  EXPECT_FALSE(MujocoRobot::make(slab(R"(<inertia ixx="5" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>)")));
}

/// Two hinges that meet at the origin, about z and y, with a cross between them; the second one moves the slab, if there is any.
[[nodiscard]] std::string universal(const char* cross, bool with_slab = true) {
  return fmt::format(
      R"(<robot name="universal"><link name="base"/><link name="cross">{}</link>
  <joint name="yaw" type="revolute"><parent link="base"/><child link="cross"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="9" effort="9"/></joint>{}</robot>)",
      cross,
      with_slab ? R"(
  <joint name="pitch" type="revolute"><parent link="cross"/><child link="slab"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="9" effort="9"/></joint>
  <link name="slab"><inertial><origin xyz="0.1 0 0"/><mass value="2"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.04"/></inertial></link>)"
                : "");
}
constexpr const char* point =
    R"(<inertial><mass value="0.5"/><origin xyz="0 0.2 0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>)";

TEST(RigidLinks, OfNothingBetweenTwoJointsHinderNobody) {
  constexpr double about_z = 0.04 + 2 * 0.1 * 0.1, about_y = 0.03 + 2 * 0.1 * 0.1;
  constexpr const char* none =
      R"(<inertial><mass value="0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>)";
  for (const char* cross : {"", none}) {
    auto robot = MujocoRobot::make(universal(cross));
    ASSERT_TRUE(robot) << robot.error();
    robot->set_gravity(0, 0, 0);
    for (int i = 0; i < 100; ++i) robot->step(std::array{0.5, 0.0}, MujocoRobot::Brakes::Open, 1ms);
    EXPECT_NEAR(robot->velocity(0), 0.1 * 0.5 / about_z, 1e-6);
    EXPECT_NEAR(robot->velocity(1), 0, 1e-6);
    ASSERT_TRUE(robot->place(std::array{0.0, 0.0}));
    for (int i = 0; i < 10; ++i) robot->step(std::array{0.0, 0.5}, MujocoRobot::Brakes::Open, 1ms);
    EXPECT_NEAR(robot->velocity(1), 0.01 * 0.5 / about_y, 1e-6);
  }
}

TEST(RigidLinks, ThatArePointsBetweenTwoJointsWeighWhatTheyWeighWhereTheyAre) {
  auto robot = MujocoRobot::make(universal(point));
  ASSERT_TRUE(robot) << robot.error();
  robot->set_gravity(0, 0, 0);
  for (int i = 0; i < 100; ++i) robot->step(std::array{0.5, 0.0}, MujocoRobot::Brakes::Open, 1ms);
  EXPECT_NEAR(robot->velocity(0), 0.1 * 0.5 / (0.04 + 2 * 0.1 * 0.1 + 0.5 * 0.2 * 0.2), 1e-6);
}

TEST(RigidLinks, ThatAreNothingAndCarryNothingAreRefused) {
  EXPECT_FALSE(MujocoRobot::make(universal("", false)));
  EXPECT_FALSE(MujocoRobot::make(universal(point, false)));
}

TEST(RigidLinks, BetweenTwoJointsThatAreABodyWithWhatIsFixedToThemAreLeftAsTheyAre) {
  std::string text = universal("");
  text.insert(
      text.rfind("</robot>"),
      R"(<link name="motor"><inertial><mass value="1"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial></link>
  <joint name="screw" type="fixed"><parent link="cross"/><child link="motor"/></joint>)");
  auto tree = xml::read_tree(text).value();
  fill_links_between(tree);
  EXPECT_TRUE(tree.children[1].children.empty());
  EXPECT_TRUE(MujocoRobot::make(text));
}

TEST(RigidLinks, OfWhichEachIsABodyAreLeftAsTheyAre) {
  const std::string text = slab(R"(<inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/>)");
  auto tree = xml::read_tree(text).value();
  join_impossible_links(tree);
  ASSERT_EQ(tree.children[3].name, "link");
  EXPECT_EQ(tree.children[3].children.size(), 1u);
  EXPECT_EQ(tree.children[1].children[0].children[1].find("value")->value, "2");
}

}  // namespace
}  // namespace hirosco::simulation
