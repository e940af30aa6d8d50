// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "simulation/mujoco/mujoco_robot.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;

/// A point of 2 kg on a rod of 0.5 m.
std::string pendulum(const std::string& dynamics = "") {
  return R"(<robot name="pendulum"><link name="world"/><joint name="swing" type="revolute"><parent link="world"/><child link="rod"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="9" effort="20"/>)" +
         dynamics + R"(</joint><link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
    <inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial>
    <visual><geometry><mesh filename="package://not/here.stl"/></geometry></visual></link></robot>)";
}
constexpr double inertia_kg_m2 = 2 * 0.5 * 0.5 + 1e-6, weight_n_m = 2 * 9.81 * 0.5;
constexpr std::array none{0.0};

TEST(MujocoRobot, KeepsTheEnergyOfAPendulum) {
  auto robot = MujocoRobot::make(pendulum()).value();
  ASSERT_TRUE(robot.place(std::array{1.0}));
  const auto energy = [&] {
    return inertia_kg_m2 * robot.velocity(0) * robot.velocity(0) / 2 - weight_n_m * std::cos(robot.position(0));
  };
  const double before = energy();
  for (int i = 0; i < 5000; ++i) {
    robot.step(none, Brakes::Open, 1ms);
    ASSERT_NEAR(energy(), before, 1e-8);
  }
}

TEST(MujocoRobot, SwingsAsLongAsTheEllipticIntegralSays) {
  auto robot = MujocoRobot::make(pendulum()).value();
  ASSERT_TRUE(robot.place(std::array{1.0}));
  // Half a period: from rest to rest.
  const double half_s = 2 * std::sqrt(inertia_kg_m2 / weight_n_m) * std::comp_ellint_1(std::sin(0.5));
  int cycles = 0;
  do {
    robot.step(none, Brakes::Open, 1ms);
    ++cycles;
  } while (robot.velocity(0) < 0);
  EXPECT_NEAR(cycles * 0.001, half_s, 0.002);
}

TEST(MujocoRobot, HoldsWithClosedBrakesWhatItsDrivesCouldHoldTwice) {
  for (const auto& [payload_kg, holds] : {std::pair{0.0, true}, {5.9, true}, {6.5, false}}) {
    auto robot = MujocoRobot::make(pendulum()).value();
    ASSERT_TRUE(robot.place(std::array{std::numbers::pi / 2}));
    // The payload hangs at the rod's origin, where it weighs nothing: gravity grows instead.
    robot.set_gravity(0, 0, -9.81 * (1 + payload_kg / 2));
    for (int i = 0; i < 10'000; ++i) robot.step(none, Brakes::Closed, 1ms);
    if (holds) {
      EXPECT_NEAR(robot.position(0), std::numbers::pi / 2, 1e-3) << "for ten seconds";
      EXPECT_NEAR(std::abs(robot.torque(0)), weight_n_m * (1 + payload_kg / 2), 1e-2);
    } else {
      EXPECT_LT(robot.position(0), std::numbers::pi / 2 - 0.2);
    }
  }
}

/// Of what hangs there and pushes, in the axes of the tip; brakes hold it.
TEST(MujocoRobot, TellsTheForceAtItsTipAsASensorThereWould) {
  auto robot = MujocoRobot::make(pendulum()).value();
  ASSERT_TRUE(robot.set_tip("rod"));
  ASSERT_TRUE(robot.place(std::array{0.3}));
  robot.set_payload(2);
  robot.push(5, 7, 0);
  for (int i = 0; i < 100; ++i) robot.step(none, Brakes::Closed, 1ms);
  const double turned = robot.position(0);
  const std::array<double, 3> base{5, 7, -2 * 9.81};
  const auto told = robot.tip_force();
  EXPECT_NEAR(told[0], std::cos(turned) * base[0] - std::sin(turned) * base[2], 0.05);
  EXPECT_NEAR(told[1], base[1], 0.05);
  EXPECT_NEAR(told[2], std::sin(turned) * base[0] + std::cos(turned) * base[2], 0.05);
  for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(told[i], 0, 0.05) << i;
}

TEST(MujocoRobot, HasTheDryFrictionOfItsFileAndMoreWhereThatIsWanted) {
  auto robot = MujocoRobot::make(pendulum("<dynamics damping='0' friction='3'/>")).value();
  robot.set_gravity(0, 0, 0);
  for (int i = 0; i < 1000; ++i) robot.step(std::array{2.9}, Brakes::Open, 1ms);
  EXPECT_LT(std::abs(robot.position(0)), 1e-3) << "sticks";
  ASSERT_TRUE(robot.place(none));
  for (int i = 0; i < 200; ++i) robot.step(std::array{4.0}, Brakes::Open, 1ms);
  EXPECT_NEAR(robot.velocity(0), 1.0 / inertia_kg_m2 * 0.2, 0.01) << "slips";
  EXPECT_NEAR(robot.torque(0), 1.0, 1e-2) << "the sensor is behind friction";
  ASSERT_TRUE(robot.place(none));
  robot.set_friction(1, 2);
  for (int i = 0; i < 1000; ++i) robot.step(std::array{4.0}, Brakes::Open, 1ms);
  EXPECT_LT(std::abs(robot.position(0)), 2e-3);
}

TEST(MujocoRobot, DampsAsItsFileSays) {
  auto robot = MujocoRobot::make(pendulum("<dynamics damping='2' friction='0'/>")).value();
  robot.set_gravity(0, 0, 0);
  for (int i = 0; i < 250; ++i) robot.step(std::array{1.0}, Brakes::Open, 1ms);
  EXPECT_NEAR(robot.velocity(0), 0.5 * (1 - std::exp(-2 / inertia_kg_m2 * 0.25)), 1e-6);
}

TEST(MujocoRobot, AcceleratesRotorsBesidesLinksAndFeelsTheLinksAlone) {
  auto robot = MujocoRobot::make(pendulum()).value();
  robot.set_gravity(0, 0, 0);
  robot.set_rotors(std::array{0.3});
  for (int i = 0; i < 100; ++i) robot.step(std::array{4.0}, Brakes::Open, 1ms);
  const double acceleration = 4.0 / (inertia_kg_m2 + 0.3);
  EXPECT_NEAR(robot.velocity(0), 0.1 * acceleration, 1e-6);
  EXPECT_NEAR(robot.torque(0), inertia_kg_m2 * acceleration, 1e-6);
}

TEST(MujocoRobot, IsHeavierWhereThatIsWanted) {
  auto robot = MujocoRobot::make(pendulum()).value();
  ASSERT_TRUE(robot.place(std::array{0.5}));
  robot.set_mass_factor(1.1);
  EXPECT_NEAR(robot.position(0), 0.5, 1e-12);
  for (int i = 0; i < 3000; ++i) robot.step(none, Brakes::Closed, 1ms);
  EXPECT_NEAR(std::abs(robot.torque(0)), 1.1 * weight_n_m * std::sin(0.5), 1e-2);
}

TEST(MujocoRobot, CarriesAPayloadAtTheLinkThatIsItsTip) {
  std::string text = pendulum();
  // The first end of the file is none that moves.
  text.insert(text.find("<joint"),
              R"(<link name="post"/><joint name="nail" type="fixed"><parent link="world"/><child link="post"/></joint>
    <link name="tool"/><joint name="flange" type="fixed"><parent link="rod"/><child link="tool"/><origin xyz="0 0 -1"/></joint>)");
  auto robot = MujocoRobot::make(text).value();
  ASSERT_TRUE(robot.place(std::array{std::numbers::pi / 2}));
  EXPECT_FALSE(robot.set_tip("nowhere"));
  ASSERT_TRUE(robot.set_tip("tool"));
  EXPECT_NEAR(robot.position(0), std::numbers::pi / 2, 1e-12) << "it stays where it is";
  EXPECT_NEAR(robot.tip_m()[0], -1, 1e-9);
  robot.set_payload(0.5);
  for (int i = 0; i < 3000; ++i) robot.step(none, Brakes::Closed, 1ms);
  EXPECT_NEAR(std::abs(robot.torque(0)), weight_n_m + 0.5 * 9.81, 1e-2);
}

TEST(MujocoRobot, TakesNamesThatHaveMarkupInThem) {
  for (const std::string name : {"c&quot;d", "a&amp;b", "a&lt;b", "a&amp;lt;b", "c'd", "c&#9;d", "two words"}) {
    std::string text = pendulum();
    for (const std::string wanted : {"\"rod\"", "\"swing\""})
      for (auto at = text.find(wanted); at != std::string::npos; at = text.find(wanted))
        text.replace(at, wanted.size(), "\"" + wanted.substr(1, 1) + name + "\"");
    auto robot = MujocoRobot::make(text);
    ASSERT_TRUE(robot) << name << ": " << robot.error();
    EXPECT_EQ(robot->joints(), 1u) << name;
  }
  std::string text = pendulum();
  for (auto at = text.find("\"rod\""); at != std::string::npos; at = text.find("\"rod\""))
    text.replace(at, 5, "\"r&quot;&lt;&amp;lt;\"");
  auto robot = MujocoRobot::make(text);
  ASSERT_TRUE(robot) << robot.error();
  EXPECT_TRUE(robot->set_tip("r\"<&lt;")) << "by its name as the file means it";
}

TEST(MujocoRobot, RefusesInWordsWhatItCannotMove) {
  EXPECT_FALSE(MujocoRobot::make("no file"));
  std::string text = pendulum();
  text.insert(text.find("<axis"), "<mimic joint='other'/>");
  EXPECT_FALSE(MujocoRobot::make(text)) << "of nobody";
}

TEST(MujocoRobot, MovesWhatMimicsAJointWithIt) {
  // Two equal sliders without gravity, the second twice as fast the other way: the first feels 1 + 2 * 2 masses.
  const std::string body =
      R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>)";
  const std::string limit = R"(<axis xyz="1 0 0"/><limit lower="-9" upper="9" velocity="9" effort="20"/>)";
  auto robot =
      MujocoRobot::make(R"(<robot name="r"><link name="a"/><link name="b">)" + body + R"(<link name="c">)" + body +
                        R"(<joint name="one" type="prismatic"><parent link="a"/><child link="b"/>)" + limit +
                        R"(</joint><joint name="two" type="prismatic"><parent link="a"/><child link="c"/>)" + limit +
                        R"(<mimic joint="one" multiplier="-2"/></joint></robot>)");
  ASSERT_TRUE(robot) << robot.error();
  ASSERT_EQ(robot->joints(), 1u);
  robot->set_gravity(0, 0, 0);
  for (int i = 0; i < 500; ++i) robot->step(std::array{5.0}, Brakes::Open, 1ms);
  EXPECT_NEAR(robot->velocity(0), 0.5, 0.01);
  // Put somewhere, it stands there with what follows it: nothing pulls it back.
  ASSERT_TRUE(robot->place(std::array{1.0}));
  for (int i = 0; i < 100; ++i) robot->step(none, Brakes::Open, 1ms);
  EXPECT_NEAR(robot->position(0), 1, 1e-9);
}

TEST(MujocoRobot, EndsOfRangesHoldALightFingerThatIsDrivenAgainstThem) {
  auto robot =
      MujocoRobot::make(R"(<robot name="finger"><link name="palm"/><link name="tip"><inertial><mass value="0.1"/>
    <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
    <joint name="slide" type="prismatic"><parent link="palm"/><child link="tip"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.04" velocity="1" effort="20"/></joint></robot>)")
          .value();
  ASSERT_TRUE(robot.place(std::array{0.03}));
  double farthest_m = 0;
  for (int i = 0; i < 500; ++i) {
    robot.step(std::array{10.0}, Brakes::Open, 1ms);
    farthest_m = std::max(farthest_m, robot.position(0));
  }
  // 100 m/s2 by (2 ms)^2 are 0.4 mm, and it comes with 1.4 m/s.
  EXPECT_GT(robot.position(0), 0.0399);
  EXPECT_LT(robot.position(0), 0.0405) << "20 ms would be centimetres";
  EXPECT_LT(farthest_m, 0.043);
}

TEST(MujocoRobot, TakesTheOrderOfJointsFromTheFile) {
  const auto robot = MujocoRobot::make(R"(<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><link name="c"><inertial><mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="second" type="prismatic"><parent link="b"/><child link="c"/><limit lower="0" upper="1" velocity="1" effort="7"/></joint>
    <joint name="first" type="continuous"><parent link="a"/><child link="b"/><limit velocity="1" effort="3"/></joint></robot>)");
  ASSERT_TRUE(robot) << robot.error();
  EXPECT_EQ(robot->joints(), 2u);
  EXPECT_EQ(robot->effort(0), 7);
  EXPECT_EQ(robot->effort(1), 3);
}

}  // namespace
}  // namespace hirosco::simulation
