// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <iostream>

#include "simulation/mujoco/mujoco_robot.hpp"

/// Bodies that move by themselves, beside closed forms.
namespace hirosco::simulation::bodies {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;

/// A pair of fingers of 0.2 kg that close along x towards each other: 0 is closed, at 0.1 each pad is 0.1 m from the middle.
std::string fingers() {
  const auto finger = [](const char* name, const char* axis, const char* pad) {
    return std::string{"<link name='"} + name +
           "'><inertial><mass value='0.2'/><inertia ixx='1e-4' ixy='0' ixz='0' iyy='1e-4' iyz='0' "
           "izz='1e-4'/></inertial>"
           "<collision><origin xyz='" +
           pad + " 0 0'/><geometry><box size='0.02 0.04 0.04'/></geometry></collision></link><joint name='" + name +
           "_slide' type='prismatic'><parent link='base'/><child link='" + name + "'/><axis xyz='" + axis +
           " 0 0'/><limit lower='0' upper='0.1' velocity='1' effort='40'/></joint>";
  };
  return "<robot name='fingers'><link name='base'/>" + finger("left", "-1", "-0.01") + finger("right", "1", "0.01") +
         "</robot>";
}
constexpr std::array open{0.1, 0.1};
constexpr std::array undriven{0.0, 0.0};
constexpr double box_kg = 0.5, side_m = 0.06;

LooseBody box(double z_m = 0, double friction = 0.8) {
  return {{"box", {.kind = ShapeKind::Box, .sizes = {side_m, 0.05, 0.1}, .place_m = {0, 0, z_m}}, friction}, box_kg};
}
void run(MujocoRobot& robot, std::span<const double> drives, int milliseconds, Brakes brakes = Brakes::Open) {
  for (int i = 0; i < milliseconds; ++i) robot.step(drives, brakes, 1ms);
}

TEST(MujocoBodies, ABodyFallsFreelyAndRestsOnAPlane) {
  auto robot = MujocoRobot::make(fingers()).value();
  ASSERT_TRUE(robot.place(open));
  ASSERT_TRUE(robot.lay(box()));
  ASSERT_TRUE(robot.put({"floor", {.kind = ShapeKind::Plane, .place_m = {0, 0, -0.5}}, 0.5}));
  run(robot, undriven, 200);
  EXPECT_NEAR(robot.body(0).place_m[2], -9.81 * 0.2 * 0.2 / 2, 1e-6);
  EXPECT_NEAR(robot.body(0).velocity_m_s[2], -9.81 * 0.2, 1e-6);
  run(robot, undriven, 2000);
  EXPECT_NEAR(robot.body(0).place_m[2], -0.45, 1e-3);
  EXPECT_EQ(robot.touched().contacts, 0) << "what lies on the floor is nothing that touches the robot";
}

TEST(MujocoBodies, APairOfFingersHoldsABodyWithTheForceOfTheirDrivesWhileFrictionCarriesIt) {
  auto robot = MujocoRobot::make(fingers()).value();
  robot.set_gravity(0, 0, 0);
  ASSERT_TRUE(robot.place(open));
  ASSERT_TRUE(robot.lay(box()));
  constexpr double force_n = 10;
  run(robot, std::array{-force_n, -force_n}, 1500);
  EXPECT_NEAR(robot.body(0).pressed_n, 2 * force_n, 0.02 * force_n);
  EXPECT_NEAR(robot.position(0) + robot.position(1), side_m, 1e-3);
  const double before_m = robot.body(0).place_m[2];
  robot.set_gravity(0, 0, -9.81);
  run(robot, std::array{-force_n, -force_n}, 5000);
  const double slipped_m = before_m - robot.body(0).place_m[2];
  RecordProperty("slipped_um", static_cast<int>(1e6 * slipped_m));
  std::cout << "  slipped " << 1e3 * slipped_m << " mm in 5 s\n";
  EXPECT_LT(slipped_m, 1e-3) << "2 x 0.8 x 10 N carry 4.9 N";
  // 2 x 0.8 x 2.5 N do not.
  run(robot, std::array{-2.5, -2.5}, 300);
  EXPECT_LT(robot.body(0).place_m[2], before_m - 0.01);
}

TEST(MujocoBodies, ClosedBrakesGoOnHoldingWhatWasHeld) {
  auto robot = MujocoRobot::make(fingers()).value();
  robot.set_gravity(0, 0, 0);
  ASSERT_TRUE(robot.place(open));
  ASSERT_TRUE(robot.lay(box()));
  run(robot, std::array{-10.0, -10.0}, 1500);
  robot.set_gravity(0, 0, -9.81);
  const double before_m = robot.body(0).place_m[2];
  run(robot, undriven, 5000, Brakes::Closed);
  std::cout << "  pressed with " << robot.body(0).pressed_n / 2 << " N, slipped "
            << 1e3 * (before_m - robot.body(0).place_m[2]) << " mm in 5 s\n";
  EXPECT_GT(robot.body(0).pressed_n / 2, 9);
  EXPECT_LT(std::abs(robot.body(0).place_m[2] - before_m), 1e-3);
}

TEST(MujocoBodies, AForceAtItsCentreMovesItUntilItIsTakenBack) {
  auto robot = MujocoRobot::make(fingers()).value();
  robot.set_gravity(0, 0, 0);
  ASSERT_TRUE(robot.place(open));
  ASSERT_TRUE(robot.lay(box()));
  ASSERT_TRUE(robot.pull("box", {0, 1, 0}));
  EXPECT_FALSE(robot.pull("ball", {0, 1, 0}));
  run(robot, undriven, 500);
  EXPECT_NEAR(robot.body(0).velocity_m_s[1], 0.5 / box_kg, 1e-6);
  ASSERT_TRUE(robot.put({"post", {.kind = ShapeKind::Sphere, .sizes = {0.1}, .place_m = {3, 0, 0}}})) << "goes on";
  EXPECT_NEAR(robot.body(0).velocity_m_s[1], 0.5 / box_kg, 1e-6);
  run(robot, undriven, 100);
  EXPECT_NEAR(robot.body(0).velocity_m_s[1], 0.6 / box_kg, 1e-6);
  robot.let_go_of_bodies();
  run(robot, undriven, 100);
  EXPECT_NEAR(robot.body(0).velocity_m_s[1], 0.6 / box_kg, 1e-6);
}

TEST(MujocoBodies, IsNeverPutIntoWhatIsThereNorWhatIsThereIntoIt) {
  auto robot = MujocoRobot::make(fingers()).value();
  const auto refused = robot.lay(box());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("' stands in body 'box', "), std::string::npos) << refused.error();
  EXPECT_EQ(robot.bodies(), 0U);
  ASSERT_TRUE(robot.place(open));
  ASSERT_TRUE(robot.lay(box()));
  EXPECT_FALSE(robot.place(undriven)) << "fingers would close on nothing else";
  EXPECT_EQ(robot.position(0), 0.1);
  const auto into = robot.put({"wall", {.kind = ShapeKind::Box, .sizes = {0.05, 1, 0.2}, .place_m = {0, 0, 0.1}}});
  ASSERT_FALSE(into);
  EXPECT_NE(into.error().find("body 'box' stands in obstacle 'wall', "), std::string::npos) << into.error();
  LooseBody other = box(0.05);
  other.standing.name = "other";
  EXPECT_FALSE(robot.lay(other));
  EXPECT_EQ(robot.bodies(), 1U);
  EXPECT_FALSE(robot.take_body_away("other"));
  ASSERT_TRUE(robot.take_body_away("box"));
  EXPECT_TRUE(robot.place(undriven));
}

TEST(MujocoBodies, ARobotBesideBodiesThatItDoesNotTouchMovesWithTheSameBits) {
  auto alone = MujocoRobot::make(fingers()).value();
  auto beside = MujocoRobot::make(fingers()).value();
  for (MujocoRobot* robot : {&alone, &beside}) {
    ASSERT_TRUE(robot->place(open));
    robot->set_mass_factor(1.3);
    run(*robot, std::array{-1.0, -2.0}, 50);
  }
  ASSERT_TRUE(beside.lay(box(3)));
  ASSERT_TRUE(beside.take_body_away("box"));
  for (MujocoRobot* robot : {&alone, &beside}) run(*robot, std::array{-1.0, -2.0}, 50);
  EXPECT_EQ(alone.position(0), beside.position(0));
  EXPECT_EQ(alone.velocity(1), beside.velocity(1));
}

TEST(MujocoBodies, TakesEightBodiesAndWeighsEachAsItWasSaid) {
  auto robot = MujocoRobot::make(fingers()).value();
  robot.set_mass_factor(2);
  LooseBody ball{{"", {.kind = ShapeKind::Sphere, .sizes = {0.05}}}, 0.25};
  for (std::size_t i = 0; i < most_bodies; ++i) {
    ball.standing.name = std::to_string(i);
    ball.standing.shape.place_m = {1.0 + 0.2 * static_cast<double>(i), 0, 0};
    ASSERT_TRUE(robot.lay(ball));
  }
  ASSERT_TRUE(robot.lay(ball)) << "one of the same name in place of another";
  robot.set_gravity(0, 0, 0);
  ASSERT_TRUE(robot.pull("7", {0, 0, 1}));
  run(robot, undriven, 100);
  EXPECT_NEAR(robot.body(7).velocity_m_s[2], 0.1 / 0.25, 1e-6) << "the factor is of links";
  ball.standing.name = "one more";
  ball.standing.shape.place_m = {5, 0, 0};
  EXPECT_FALSE(robot.lay(ball));
}

TEST(MujocoBodies, AreReadAsObstaclesWithTheirMass) {
  const auto read = [](std::vector<std::string_view> words) { return read_body("box", words); };
  const auto body = read({"box", "0.1,0.2,0.3", "2.5", "1,2,3", "0.7", "0,0,1.5"});
  ASSERT_TRUE(body) << body.error();
  EXPECT_EQ(body->mass_kg, 2.5);
  EXPECT_EQ(body->standing.friction, 0.7);
  EXPECT_EQ(body->standing.shape.turned_rad[2], 1.5);
  for (const auto& [words, why] :
       {std::pair{std::vector<std::string_view>{"plane", "1", "0,0,0"},
                  "'plane' is no shape of a body: box, cylinder or sphere"},
        {{"sphere", "0.1", "0,0,0"},
         "3 words are not those of a sphere: write sphere RADIUS MASS X,Y,Z [FRICTION [ROLL,PITCH,YAW]]"},
        {{"sphere", "0.1", "0", "0,0,0"}, "the mass '0' is not within 0.001 to 10000"}}) {
    const auto refused = read(words);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error(), why);
  }
}

}  // namespace
}  // namespace hirosco::simulation::bodies
