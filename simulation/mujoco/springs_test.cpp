// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/mujoco/mujoco_device.hpp"

/// Gears that give way, against closed forms.
namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;
using ::testing::HasSubstr;

/// A point of 2 kg on a rod of 0.5 m, which swings about y.
constexpr const char* sprung_pendulum =
    R"(<robot name="pendulum"><link name="base"/><joint name="swing" type="revolute">
  <parent link="base"/><child link="rod"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="9" effort="20"/></joint>
  <link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0"
  izz="1e-6"/></inertial></link></robot>)";
constexpr double sprung_link_kg_m2 = 2 * 0.5 * 0.5 + 1e-6, sprung_rotor_kg_m2 = 0.3, hung_n_m = 2 * 9.81 * 0.5;
constexpr std::array sprung_rotor{sprung_rotor_kg_m2};

MujocoRobot with_spring(double stiffness, double damping = 0) {
  auto robot = MujocoRobot::make(sprung_pendulum).value();
  robot.set_rotors(sprung_rotor);
  const auto done = robot.give_way(std::array{stiffness}, std::array{damping});
  EXPECT_TRUE(done) << done.error();
  return robot;
}

TEST(Springs, GiveWayToWhatHangsOnThemWhileTheDriveIsHeld) {
  constexpr double stiffness = 500;
  auto robot = with_spring(stiffness);
  ASSERT_TRUE(robot.gives_way(0));
  ASSERT_TRUE(robot.place(std::array{std::numbers::pi / 2}));
  EXPECT_EQ(robot.position(0), std::numbers::pi / 2) << "its sensor is at its drive";
  const double sagged = robot.given_way(0);
  EXPECT_NEAR(std::abs(sagged), hung_n_m * std::sin(std::numbers::pi / 2 + sagged) / stiffness, 1e-6);
  for (int i = 0; i < 1000; ++i) robot.step(std::array{0.0}, Brakes::Closed, 1ms);
  EXPECT_NEAR(robot.given_way(0), sagged, 1e-4) << "it was put where it rests";
  EXPECT_NEAR(std::abs(robot.torque(0)), hung_n_m, 0.02) << "the torque sensor has what the spring has";
  EXPECT_LT(std::abs(robot.data().qvel[1]), 1e-2);
}

TEST(Springs, SwingBetweenDriveAndLinkAsTheirInertiasSay) {
  constexpr double stiffness = 200, driven_n_m = 4;
  auto robot = with_spring(stiffness);
  robot.set_gravity(0, 0, 0);
  const double rate = std::sqrt(stiffness * (1 / sprung_rotor_kg_m2 + 1 / sprung_link_kg_m2));
  for (int i = 1; i <= 300; ++i) {
    robot.step(std::array{driven_n_m}, Brakes::Open, 1ms);
    const double in_spring =
        driven_n_m * sprung_link_kg_m2 / (sprung_link_kg_m2 + sprung_rotor_kg_m2) * (1 - std::cos(rate * 1e-3 * i));
    ASSERT_NEAR(robot.torque(0), in_spring, 1e-3) << i << " ms";
    ASSERT_NEAR(robot.given_way(0), -in_spring / stiffness, 1e-5) << i << " ms";
  }
}

TEST(Springs, ComeToRestByTheirDamping) {
  constexpr double driven_n_m = 4;
  auto robot = with_spring(200, 4);
  robot.set_gravity(0, 0, 0);
  for (int i = 0; i < 800; ++i) robot.step(std::array{driven_n_m}, Brakes::Open, 1ms);
  EXPECT_NEAR(robot.torque(0), driven_n_m * sprung_link_kg_m2 / (sprung_link_kg_m2 + sprung_rotor_kg_m2), 0.01);
}

TEST(Springs, StayWhereAnObstacleComesAndKeepTheirSwing) {
  auto robot = with_spring(200), other = with_spring(200);
  for (MujocoRobot* each : {&robot, &other}) {
    each->set_gravity(0, 0, 0);
    for (int i = 0; i < 50; ++i) each->step(std::array{4.0}, Brakes::Open, 1ms);
  }
  ASSERT_TRUE(other.put({"far", {.kind = ShapeKind::Sphere, .sizes = {0.1}, .place_m = {5, 0, 0}}, 0.5}));
  EXPECT_EQ(other.given_way(0), robot.given_way(0));
  for (int i = 0; i < 50; ++i)
    for (MujocoRobot* each : {&robot, &other}) each->step(std::array{4.0}, Brakes::Open, 1ms);
  EXPECT_EQ(other.given_way(0), robot.given_way(0));
  EXPECT_EQ(other.position(0), robot.position(0));
}

TEST(Springs, AreRefusedWhereTheWorldCannotReckonWithThem) {
  const auto refused = [](MujocoRobot robot, double stiffness) {
    const auto done = robot.give_way(std::array{stiffness}, {});
    const double position = robot.position(0);
    robot.step(std::array{1.0}, Brakes::Open, 1ms);
    EXPECT_NE(robot.position(0), position) << "it goes on as it was";
    return done ? "it is taken" : done.error();
  };
  EXPECT_THAT(refused(MujocoRobot::make(sprung_pendulum).value(), 200), HasSubstr("rotors before springs"));
  const auto with_rotor = [] {
    auto robot = MujocoRobot::make(sprung_pendulum).value();
    robot.set_rotors(sprung_rotor);
    return robot;
  };
  auto stiff = with_rotor();
  EXPECT_THAT(stiff.give_way(std::array{1e6}, {}).error(), HasSubstr("'swing' would swing with 2309 rad/s"));
  EXPECT_FALSE(stiff.gives_way(0));
  EXPECT_EQ(refused(std::move(stiff), 200), "it is taken") << "a softer one is";
  auto placed = with_rotor();
  ASSERT_TRUE(placed.place(std::array{0.5}));
  EXPECT_THAT(refused(std::move(placed), 200), HasSubstr("before it is put into a posture"));
  EXPECT_THAT(refused(with_spring(200), 100), HasSubstr("gives way already"));
  EXPECT_EQ(refused(with_rotor(), 0), "it is taken") << "and nothing gives way";
}

TEST(Springs, AreASettingOfTheDevice) {
  const std::string file = ::testing::TempDir() + "springs.urdf";
  std::ofstream{file} << sprung_pendulum;
  LocalFlows flows;
  MujocoDevice device{flows, {Transfer::SharedMemory, "springs"}, {.cycle = 1ms, .files = {{"MODEL_FILE", file}}}};
  ASSERT_TRUE(device.plug());
  EXPECT_THAT(device.truth(), ::testing::Not(HasSubstr("spring_")));
  EXPECT_THAT(device.fault("springs 500").error().text, HasSubstr("rotors before springs"));
  ASSERT_TRUE(device.fault("rotors 0.3"));
  for (const char* line :
       {"springs", "springs 1,2", "springs -1", "springs 500 1,2", "springs 500 -1", "springs 500 1 1"})
    EXPECT_FALSE(device.fault(line)) << line;
  ASSERT_TRUE(device.fault("springs 500 1"));
  ASSERT_TRUE(device.fault("posture 1.5708"));
  EXPECT_FALSE(device.fault("rotors 0")) << "nothing would be on the drive's side";
  EXPECT_THAT(device.truth(), HasSubstr("spring_1="));
  EXPECT_GT(std::abs(device.robot().given_way(0)), 0.01);
}

}  // namespace
}  // namespace hirosco::simulation
