// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/mujoco/mujoco_device.hpp"
#include "simulation/mujoco/mujoco_robot.hpp"

/// Worlds of MJCF files. The robot's URDF file says which of their joints are its own, and is a world itself, which they are compared with.
namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;
using ::testing::HasSubstr;

constexpr const char* two_rods_urdf = R"(<robot name="rods"><link name="base"/>
  <link name="upper"><inertial><origin xyz="0 0 -0.2"/><mass value="3"/><inertia ixx="0.04" ixy="0" ixz="0" iyy="0.04" iyz="0" izz="0.002"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0 0 -0.2"/><mass value="2"/><inertia ixx="0.03" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.001"/></inertial></link>
  <joint name="one" type="revolute"><origin xyz="0 0 1"/><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="9" effort="20"/></joint>
  <joint name="two" type="revolute"><origin xyz="0 0 -0.4"/><parent link="upper"/><child link="lower"/><axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="9" effort="10"/></joint>
</robot>)";

/// The same rods among other things: a door before them in the file, a ball that falls, a floor.
std::string room(const std::string& more = "", const std::string& of_one = "") {
  return R"(<mujoco><compiler angle="radian" autolimits="true"/><option integrator="RK4"/>)" + more + R"(<worldbody>
  <geom name="floor" type="plane" size="5 5 0.1"/>
  <body name="door" pos="3 0 1"><joint name="hinge" axis="0 0 1" damping="0.5"/><geom type="box" size="0.4 0.02 0.9" mass="20"/></body>
  <body name="ball" pos="0 3 1"><freejoint/><geom type="sphere" size="0.1" mass="1"/></body>
  <body name="upper" pos="0 0 1"><joint name="one" axis="0 1 0" range="-3 3" )" +
         of_one + R"(/><inertial pos="0 0 -0.2" mass="3" diaginertia="0.04 0.04 0.002"/>
    <body name="lower" pos="0 0 -0.4"><joint name="two" axis="0 1 0" range="-3 3"/><inertial pos="0 0 -0.2" mass="2" diaginertia="0.03 0.03 0.001"/></body>
  </body></worldbody></mujoco>)";
}

[[nodiscard]] std::string refused(const std::string& mjcf, const MeshSource& files = {}) {
  const auto made = MujocoRobot::make_in_scene(mjcf, two_rods_urdf, files);
  return made ? "it is taken" : made.error();
}

TEST(MujocoScene, MovesTheRobotAsTheWorldOfItsUrdfFileDoes) {
  auto alone = MujocoRobot::make(two_rods_urdf).value();
  auto in_scene = MujocoRobot::make_in_scene(room(), two_rods_urdf).value();
  for (MujocoRobot* robot : {&alone, &in_scene}) ASSERT_TRUE(robot->place(std::array{1.0, -0.5}));
  for (int i = 0; i < 1000; ++i) {
    for (MujocoRobot* robot : {&alone, &in_scene}) robot->step(std::array{2.0, -1.0}, Brakes::Open, 1ms);
    for (std::size_t joint = 0; joint < 2; ++joint)
      ASSERT_NEAR(in_scene.position(joint), alone.position(joint), 1e-9) << joint << " after " << i << " ms";
  }
  for (int i = 0; i < 1000; ++i)
    for (MujocoRobot* robot : {&alone, &in_scene}) robot->step(std::array{0.0, 0.0}, Brakes::Closed, 1ms);
  for (std::size_t joint = 0; joint < 2; ++joint) EXPECT_NEAR(in_scene.position(joint), alone.position(joint), 1e-6);
  EXPECT_NEAR(in_scene.tip_m()[2], alone.tip_m()[2], 1e-6) << "at the last of its joints";
}

TEST(MujocoScene, HasJointsThatNobodyDrives) {
  auto robot = MujocoRobot::make_in_scene(room(), two_rods_urdf).value();
  ASSERT_EQ(robot.joints(), 2U);
  EXPECT_EQ(robot.joint("one"), 0U);
  EXPECT_FALSE(robot.joint("hinge"));
  const int ball = mj_name2id(&robot.model(), mjOBJ_BODY, "ball");
  for (int i = 0; i < 300; ++i) robot.step(std::array{0.0, 0.0}, Brakes::Closed, 1ms);
  EXPECT_NEAR(robot.data().xpos[3 * ball + 2], 1 - 9.81 / 2 * 0.3 * 0.3, 1e-3) << "it falls";
  EXPECT_EQ(robot.touched().contacts, 0);
  for (int i = 0; i < 2000; ++i) robot.step(std::array{0.0, 0.0}, Brakes::Closed, 1ms);
  EXPECT_NEAR(robot.data().xpos[3 * ball + 2], 0.1, 5e-3) << "and lies";
  EXPECT_EQ(robot.touched().contacts, 0) << "that touches the floor, and not the robot";
  robot.set_mass_factor(2);
  EXPECT_EQ(robot.model().body_mass[ball], 1);
  EXPECT_EQ(robot.model().body_mass[mj_name2id(&robot.model(), mjOBJ_BODY, "lower")], 4);
}

TEST(MujocoScene, GivesEachJointWhatItsDriveThereCanDoAndElseWhatItsUrdfFileSays) {
  const auto efforts = [](const std::string& mjcf) {
    const auto robot = MujocoRobot::make_in_scene(mjcf, two_rods_urdf).value();
    return std::array{robot.effort(0), robot.effort(1)};
  };
  EXPECT_EQ(efforts(room()), (std::array{20.0, 10.0}));
  EXPECT_EQ(efforts(room("", R"(actuatorfrcrange="-7 7")")), (std::array{7.0, 10.0}));
  EXPECT_EQ(efforts(room(R"(<actuator><motor joint="two" gear="50" ctrlrange="-0.1 0.1"/></actuator>)")),
            (std::array{20.0, 5.0}));
  EXPECT_EQ(efforts(room(R"(<actuator><position joint="one" kp="100" forcerange="-12 12"/></actuator>)")),
            (std::array{12.0, 10.0}));
}

TEST(MujocoScene, IsDrivenByTheDeviceAloneWhateverDrivesItHas) {
  auto robot = MujocoRobot::make_in_scene(
                   room(R"(<actuator><position joint="one" kp="1000" ctrlrange="-3 3"/></actuator>)"), two_rods_urdf)
                   .value();
  auto without = MujocoRobot::make_in_scene(room(), two_rods_urdf).value();
  for (MujocoRobot* each : {&robot, &without}) {
    ASSERT_TRUE(each->place(std::array{1.0, 0.0}));
    for (int i = 0; i < 200; ++i) each->step(std::array{0.0, 0.0}, Brakes::Open, 1ms);
  }
  EXPECT_EQ(robot.position(0), without.position(0));
}

TEST(MujocoScene, TakesObstaclesAndLooseBodiesAndGoesOnWhereItWas) {
  auto robot = MujocoRobot::make_in_scene(room(), two_rods_urdf).value();
  const auto height = [&] { return robot.data().xpos[3 * mj_name2id(&robot.model(), mjOBJ_BODY, "ball") + 2]; };
  for (int i = 0; i < 200; ++i) robot.step(std::array{0.0, 0.0}, Brakes::Closed, 1ms);
  const double before = height();
  const auto box = read_obstacle("box", std::array<std::string_view, 4>{"box", "0.2,0.2,0.2", "0,3,0.1", "0.5"});
  ASSERT_TRUE(robot.put(box.value()));
  EXPECT_EQ(height(), before);
  const auto cube = read_body("cube", std::array<std::string_view, 4>{"box", "0.1,0.1,0.1", "0.2", "1,1,1"});
  ASSERT_TRUE(robot.lay(cube.value()));
  for (int i = 0; i < 3000; ++i) robot.step(std::array{0.0, 0.0}, Brakes::Closed, 1ms);
  EXPECT_NEAR(height(), 0.3, 1e-2) << "the ball lies on the box";
  EXPECT_NEAR(robot.body(0).place_m[2], 0.05, 1e-2) << "the cube on the floor";
  EXPECT_THAT(robot.let_float().error(), HasSubstr("file says"));
}

TEST(MujocoScene, ReadsFilesThroughItsSourceAloneWhereItsCompilerSaysTheyAre) {
  const std::string with_mesh = room(
      R"(<compiler meshdir="shapes"/><asset><mesh file="parts/block.obj"/><texture type="2d" name="wood" file="wood.png"/>
    <material name="oak" texture="wood"/></asset>)");
  const std::string placed = [&] {
    std::string text = with_mesh;
    return text.insert(text.find("<body name=\"door\""),
                       R"(<body pos="2 2 0"><geom type="mesh" mesh="block" material="oak"/></body>)");
  }();
  std::vector<std::string> asked;
  const auto source = [&](const std::string& file) -> std::expected<std::string, std::string> {
    asked.push_back(file);
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  };
  const auto robot = MujocoRobot::make_in_scene(placed, two_rods_urdf, source);
  ASSERT_TRUE(robot) << robot.error();
  EXPECT_EQ(robot->model().nmesh, 1);
  EXPECT_THAT(asked, ::testing::Each("shapes/parts/block.obj")) << "what is for eyes is not asked for";
  EXPECT_THAT(refused(placed), HasSubstr("nobody reads files"));
  EXPECT_THAT(refused(placed, [](const std::string&) { return std::unexpected{std::string{"is not there"}}; }),
              HasSubstr("shapes/parts/block.obj: is not there"));
}

TEST(MujocoScene, IsRefusedWithTheReasonWhereItIsNoWorldOfThisRobot) {
  EXPECT_THAT(refused("<mujoco><worldbody/></mujoco>"), HasSubstr("no joint 'one'"));
  EXPECT_THAT(refused("<mujoco><worldbody><body><joint name='two'/><geom size='1'/></body></worldbody></mujoco>"),
              HasSubstr("its joints: two"));
  EXPECT_THAT(
      refused("<mujoco><worldbody><body><joint name='one' type='ball'/><geom size='1'/></body></worldbody></mujoco>"),
      HasSubstr("'one' neither turns"));
  EXPECT_THAT(refused(two_rods_urdf), HasSubstr("<robot> is no MJCF file"));
  EXPECT_THAT(refused("<mujoco>\n<include file='other.xml'/></mujoco>"), HasSubstr("line 2: <include> is not read"));
  EXPECT_THAT(refused(room(R"(<asset><mesh file="../../secret.obj"/></asset>)")), HasSubstr("is not beside the file"));
  EXPECT_THAT(refused("<mujoco"), HasSubstr("line 1"));
  EXPECT_THAT(refused(room("<worldbody><body><geom/></body></worldbody>")), HasSubstr("MuJoCo: "));
}

TEST(MujocoScene, IsNamedByTheMissionAndReadWhenTheDeviceStarts) {
  const std::string folder = ::testing::TempDir();
  std::ofstream{folder + "two_rods.urdf"} << two_rods_urdf;
  std::ofstream{folder + "room.xml"} << room();
  LocalFlows flows;
  const auto device = [&](const std::string& world) {
    return MujocoDevice{
        flows,
        {Transfer::SharedMemory, "device of " + world},
        {.cycle = 1ms, .files = {{"MODEL_FILE", folder + "two_rods.urdf"}, {"WORLD_FILE", folder + world}}}};
  };
  MujocoDevice made = device("room.xml");
  ASSERT_TRUE(made.plug());
  EXPECT_TRUE(made.fault("WORLD_FILE room.xml"));
  EXPECT_GE(mj_name2id(&made.robot().model(), mjOBJ_BODY, "door"), 0);
  for (const Duration at : {1000ms, 1010ms}) made.step(TimePoint{at});
  EXPECT_EQ(made.fault("WORLD_FILE room.xml").error().code, ErrorCode::NotPermitted) << "it runs";
  MujocoDevice nowhere = device("nowhere.xml");
  const auto plugged = nowhere.plug();
  ASSERT_FALSE(plugged);
  EXPECT_THAT(plugged.error().text, HasSubstr("nowhere.xml"));
}

}  // namespace
}  // namespace hirosco::simulation
