// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <numbers>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/mujoco/mujoco_scene.hpp"
#include "simulation/mujoco/mujoco_urdf.hpp"
#include "simulation/mujoco/part_device.hpp"

/// Robots of several files in one world: what each is moved by, and how they meet.
namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;
using ::testing::HasSubstr;

constexpr const char* cube_shape = R"(<box size="0.2 0.2 0.2"/>)";
constexpr const char* cube_mesh = R"(<mesh filename="cube.obj"/>)";

/// A cube of 0.2 m that slides along x. Whatever its file is, its link and joint have the same names.
std::string cube_slider(double mass_kg, const std::string& shape = cube_shape) {
  return R"(<robot name="slider"><link name="base"/><link name="cube"><inertial><mass value=")" +
         std::to_string(mass_kg) +
         R"("/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
    <collision><geometry>)" +
         shape + R"(</geometry></collision></link><joint name="slide" type="prismatic"><parent link="base"/>
    <child link="cube"/><axis xyz="1 0 0"/><limit lower="-5" upper="5" velocity="9" effort="200"/></joint></robot>)";
}
/// A rod that swings about y.
constexpr const char* mounted_pendulum = R"(<robot name="pendulum"><link name="base"/>
  <link name="cube"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0"
  izz="0.1"/></inertial></link><joint name="slide" type="revolute"><parent link="base"/><child link="cube"/>
  <axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="9" effort="50"/></joint></robot>)";

std::expected<std::string, std::string> cube_of_obj(const std::string&) {
  return "v -.1 -.1 -.1\nv .1 -.1 -.1\nv -.1 .1 -.1\nv .1 .1 -.1\nv -.1 -.1 .1\nv .1 -.1 .1\nv -.1 .1 .1\nv .1 .1 .1\n"
         "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6\n";
}

/// Half a metre away, and slides towards the first one.
const Mount opposite{.name = "left", .place_m = {0.5, 0, 0}, .turned_rad = {0, 0, std::numbers::pi}};

MujocoSpec spec_of(const std::string& urdf, std::string_view mark = {}) {
  return spec_of_urdf(urdf, cube_of_obj, mark).value();
}
/// Two of them, without gravity.
MujocoRobot world_of_two(const std::string& first, const std::string& second, const Mount& at = opposite) {
  auto robot = MujocoRobot::make(spec_of(first)).value();
  robot.set_gravity(0, 0, 0);
  EXPECT_EQ(robot.mount(spec_of(second, "left_"), at), 1u);
  return robot;
}
void run_both(MujocoRobot& robot, double first, double second, int milliseconds) {
  for (int i = 0; i < milliseconds; ++i) {
    robot.drive(0, first, Brakes::Open);
    robot.drive(1, second, Brakes::Open);
    robot.step(1ms);
  }
}

TEST(MountedRobot, MovesByItsOwnDriveAsItDoesAloneAndItsNamesAreKeptApart) {
  auto both = MujocoRobot::make(spec_of(cube_slider(1))).value();
  ASSERT_EQ(both.mount(spec_of(mounted_pendulum, "left_"), {.name = "left", .place_m = {0, 3, 0}}), 1u);
  ASSERT_EQ(both.robots(), 2u);
  EXPECT_EQ(both.joints(0), 1u);
  EXPECT_EQ(both.joints(1), 1u);
  EXPECT_EQ(both.joint("slide"), 0u);
  EXPECT_EQ(both.joint("left/slide"), 1u);
  EXPECT_EQ(both.effort(1), 50);
  auto slides = MujocoRobot::make(cube_slider(1)).value();
  auto swings = MujocoRobot::make(mounted_pendulum).value();
  ASSERT_TRUE(swings.place(std::array{1.0}));
  ASSERT_TRUE(both.place(std::array{1.0}, 1));
  for (int i = 0; i < 1000; ++i) {
    run_both(both, 0.5, 2, 1);
    slides.step(std::array{0.5}, Brakes::Open, 1ms);
    swings.step(std::array{2.0}, Brakes::Open, 1ms);
    ASSERT_NEAR(both.position(0), slides.position(0), 1e-9) << i;
    ASSERT_NEAR(both.position(1), swings.position(0), 1e-9) << i;
  }
  EXPECT_GT(both.position(0), 0.2);
}

TEST(MountedRobot, IsTouchedByTheFirstOneAndBothFeelIt) {
  auto robot = world_of_two(cube_slider(1), cube_slider(2));
  for (int i = 0; i < 2000; ++i) {
    robot.drive(0, 10, Brakes::Open);
    robot.drive(1, 0, Brakes::Closed);
    robot.step(1ms);
  }
  EXPECT_NEAR(robot.position(0), 0.3, 3e-3) << "it stands at the other one";
  EXPECT_NEAR(robot.position(1), 0, 3e-3) << "which its brakes hold";
  for (const std::size_t number : {0u, 1u}) {
    EXPECT_GT(robot.touched(number).contacts, 0) << number;
    EXPECT_NEAR(robot.touched(number).normal_n, 10, 0.2) << number;
  }
  EXPECT_NEAR(robot.torque(1), 10, 0.2) << "what holds it its own sensor has";
}

TEST(MountedRobot, IsPushedAwayWithWhatTheFirstOneLoses) {
  auto robot = world_of_two(cube_slider(1), cube_slider(2));
  run_both(robot, 10, 0, 100);
  const double before_n_s = robot.velocity(0);
  EXPECT_NEAR(before_n_s, 1, 0.01);
  run_both(robot, 0, 0, 600);
  EXPECT_LT(robot.velocity(1), -0.1) << "along its own axis, which points at the other one";
  EXPECT_NEAR(robot.velocity(0) - 2 * robot.velocity(1), before_n_s, 1e-3) << "momentum is conserved";
}

TEST(MountedRobot, MeetsTheOthersByTheHullsOfItsMeshes) {
  for (const char* first : {cube_shape, cube_mesh})
    for (const char* second : {cube_shape, cube_mesh}) {
      auto robot = world_of_two(cube_slider(1, first), cube_slider(2, second));
      run_both(robot, 5, 5, 500);
      EXPECT_GT(robot.touched(0).contacts, 0) << first << second;
    }
}

/// A cube of 0.2 m that slides on a carriage from 0.5 m towards the one that stands at its base.
TEST(MountedRobot, MeetsItselfByPiecesOfItsMeshesAndTheOthersDoNot) {
  const auto chain = [](const char* shape) {
    const auto link = [&](const char* name, const std::string& more) {
      return std::string{"<link name='"} + name + R"('><inertial><mass value="1"/>
        <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>)" +
             more + "</link>";
    };
    const auto slide = [](const char* name, const char* parent, const char* child) {
      return std::string{"<joint name='"} + name + "' type='prismatic'><parent link='" + parent + "'/><child link='" +
             child + "'/><axis xyz='1 0 0'/><limit lower='-5' upper='5' velocity='9' effort='200'/></joint>";
    };
    const std::string geometry = std::string{"<geometry>"} + shape + "</geometry></collision>";
    return "<robot name='chain'><link name='base'><collision>" + geometry + "</link>" + link("carriage", "") +
           link("cube", "<collision><origin xyz='0.5 0 0'/>" + geometry) + slide("first", "base", "carriage") +
           slide("second", "carriage", "cube") + "</robot>";
  };
  for (const char* shape : {cube_shape, cube_mesh}) {
    auto robot = world_of_two(cube_slider(1, cube_mesh), chain(shape), {.name = "left", .place_m = {0, 3, 0}});
    ASSERT_TRUE(robot.left_out(1).empty()) << robot.left_out(1).front();
    for (int i = 0; i < 1500; ++i) {
      for (const std::size_t joint : {1u, 2u}) robot.drive(joint, -5, Brakes::Open);
      robot.step(1ms);
    }
    EXPECT_NEAR(robot.position(1) + robot.position(2), -0.3, 0.01) << shape;
    EXPECT_GT(robot.touched(1).contacts, 0) << shape;
    EXPECT_EQ(robot.touched(0).contacts, 0) << shape;
  }
}

TEST(MountedRobot, IsPlacedWeighedAndPushedByItselfWhileTheOthersGoOn) {
  auto robot = world_of_two(cube_slider(1), cube_slider(2), {.name = "left", .place_m = {0, 2, 0}});
  run_both(robot, 1, 0, 100);
  const double where_m = robot.position(0), fast_m_s = robot.velocity(0);
  ASSERT_TRUE(robot.place(std::array{0.7}, 1));
  EXPECT_EQ(robot.position(0), where_m);
  EXPECT_EQ(robot.velocity(0), fast_m_s);
  EXPECT_EQ(robot.position(1), 0.7);
  ASSERT_TRUE(robot.put({"ball", {.kind = ShapeKind::Sphere, .sizes = {0.1}, .place_m = {0, -2, 0}}, 0.5}));
  EXPECT_EQ(robot.velocity(0), fast_m_s);
  EXPECT_EQ(robot.position(1), 0.7);
  robot.set_mass_factor(2, 1);
  robot.push(8, 0, 0, 1);
  run_both(robot, 0, 0, 100);
  EXPECT_NEAR(robot.velocity(0), fast_m_s, 1e-9);
  EXPECT_NEAR(robot.velocity(1), 8.0 / 4 * 0.1, 1e-6);
  EXPECT_NEAR(robot.tip_m(1)[0], robot.position(1), 1e-9);
  EXPECT_NEAR(robot.tip_m(1)[1], 2, 1e-9);
}

TEST(MountedRobot, IsNotPutIntoAnotherOneNorUnderANameThatIsTaken) {
  auto robot = world_of_two(cube_slider(1), cube_slider(2));
  const auto placed = robot.place(std::array{0.4}, 1);
  ASSERT_FALSE(placed);
  EXPECT_THAT(placed.error(), HasSubstr("left/cube"));
  EXPECT_EQ(robot.position(1), 0) << "it stands where it stood";
  const auto again = robot.mount(spec_of(cube_slider(3), "more_"), opposite);
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error(), HasSubstr("'left/'"));
  for (std::size_t more = 2; more < most_robots; ++more) {
    const Mount at{.name = "r" + std::to_string(more), .place_m = {0, 5.0 * static_cast<double>(more), 0}};
    ASSERT_EQ(robot.mount(spec_of(cube_slider(1), at.name + "_"), at), more);
  }
  EXPECT_THAT(robot.mount(spec_of(cube_slider(1), "last_"), {.name = "last", .place_m = {9, 9, 9}}).error(),
              HasSubstr("8 robots"));
  run_both(robot, 1, 0, 10);
  EXPECT_GT(robot.velocity(0), 0) << "the world is as it was";
}

TEST(MountedRobot, OfAnMjcfFileMayFloatAndKeepsItsContacts) {
  auto robot = MujocoRobot::make(spec_of(cube_slider(1))).value();
  robot.set_gravity(0, 0, 0);
  auto client = spec_of_scene(R"(<mujoco><option gravity="0 0 -3"/><worldbody><body name="client"><freejoint/>
    <geom type="sphere" size="0.1" mass="3" solref="0.01 1"/></body></worldbody></mujoco>)",
                              {}, {}, "client_");
  ASSERT_TRUE(client) << client.error();
  ASSERT_EQ(robot.mount(std::move(*client), {.name = "client", .place_m = {0.5, 0, 0}}), 1u);
  const int body = mj_name2id(&robot.model(), mjOBJ_BODY, "client/client");
  ASSERT_GT(body, 0);
  EXPECT_EQ(robot.model().geom_solref[mjNREF * robot.model().body_geomadr[body]], 0.01);
  for (int i = 0; i < 500; ++i) robot.step(std::array{5.0}, Brakes::Open, 1ms);
  EXPECT_GT(robot.data().xpos[3 * body], 0.52) << "it was pushed away";
  EXPECT_NEAR(robot.data().xpos[3 * body + 2], 0, 1e-6) << "gravity is the world's";
}

TEST(Mounts, AreReadFromWordsOrRefusedWithWhatIsWrong) {
  const auto read = [](std::vector<std::string_view> words) { return read_mount(words); };
  const auto full = read({"left", "1,-2,0.5", "0,0,1.5"});
  ASSERT_TRUE(full) << full.error();
  EXPECT_EQ(full->prefix(), "left/");
  EXPECT_EQ(full->place_m, (std::array{1.0, -2.0, 0.5}));
  EXPECT_EQ(full->turned_rad, (std::array{0.0, 0.0, 1.5}));
  EXPECT_TRUE(read({"left", "0,0,0"}));
  EXPECT_THAT(read({"left"}).error(), HasSubstr("write NAME X,Y,Z"));
  EXPECT_THAT(read({"le/ft", "0,0,0"}).error(), HasSubstr("'le/ft' names no robot"));
  EXPECT_THAT(read({"left", "0,0"}).error(), HasSubstr("has 2 numbers, not 3"));
  EXPECT_THAT(read({"left", "0,0,2000"}).error(), HasSubstr("is not within"));
  EXPECT_THAT(read({"left", "0,0,0", "7,0,0"}).error(), HasSubstr("the turn '7,0,0'"));
}

/// Two subsystems' sides, by hand.
struct MountedDevice : ::testing::Test {
  static std::string file(const std::string& name, const std::string& urdf) {
    const std::string path = ::testing::TempDir() + name;
    std::ofstream{path} << urdf;
    return path;
  }
  LocalFlows flows;
  MujocoDevice first{flows,
                     {Transfer::SharedMemory, "one"},
                     {.cycle = 1ms, .files = {{"MODEL_FILE", file("one.urdf", cube_slider(1))}}}};
  PartDevice second{flows,
                    {Transfer::SharedMemory, "two"},
                    {.cycle = 1ms,
                     .stop = SimulatedDevice::Stop::Controlled,
                     .stop_within = 20ms,
                     .files = {{"MODEL_FILE", file("two.urdf", cube_slider(2))}},
                     .in_world_of = &first}};
  std::unique_ptr<DataFlow> to_first, to_second;
  TimePoint now{1s};
  std::uint32_t sequence{0};

  void begin(const std::string& mount) {
    ASSERT_TRUE(first.plug());
    ASSERT_TRUE(first.fault("gravity 0 0 0"));
    ASSERT_TRUE(second.plug());
    const auto mounted = second.fault(mount);
    ASSERT_TRUE(mounted) << mounted.error().text;
    to_first = flows.open({Transfer::SharedMemory, "one"}, FlowSide::Subsystem).value();
    to_second = flows.open({Transfer::SharedMemory, "two"}, FlowSide::Subsystem).value();
  }
  void send(DataFlow& flow, double force) {
    std::array<std::byte, 8> payload{};
    OctetWriter{payload, std::endian::little}.put(force);
    std::array<std::byte, max_device_frame_octets> buffer;
    ASSERT_TRUE(flow.send(
        write_command(
            buffer,
            {.mode = DeviceMode::Active, .epoch = 1, .sequence = ++sequence, .watchdog_us = 5000, .payload = payload})
            .value()));
  }
  /// Position, velocity, force.
  std::array<double, 3> hear(DataFlow& flow) {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = flow.receive(buffer);
    EXPECT_TRUE(received && received->flow == Flow::New);
    OctetReader reader{read_status(Octets{buffer}.first(received->octets)).value().payload, std::endian::little};
    std::array<double, 3> told{};
    for (double& number : told) number = reader.get<double>();
    EXPECT_TRUE(reader.exhausted());
    return told;
  }
  void step() {
    now += 1ms;
    first.step(now);
    second.step(now);
  }
  const MujocoRobot& world() { return std::as_const(first).robot(); }
};

TEST_F(MountedDevice, EachMovesItsOwnRobotAndTheyMeet) {
  begin("mount left 0.5,0,0 0,0,3.14159265");
  std::array<double, 3> of_first{}, of_second{};
  for (int i = 0; i < 101; ++i) {
    send(*to_first, 2);
    send(*to_second, 6);
    step();
    of_first = hear(*to_first);
    of_second = hear(*to_second);
  }
  EXPECT_NEAR(of_first[1], 0.2, 5e-3) << "2 N on 1 kg";
  EXPECT_NEAR(of_second[1], 0.3, 5e-3) << "6 N on 2 kg";
  EXPECT_EQ(of_second[0], world().position(1));
  EXPECT_EQ(world().touched(0).contacts, 0);
  bool both_touch = false;
  for (int i = 0; i < 500; ++i) {
    send(*to_first, 2);
    send(*to_second, 6);
    step();
    both_touch = both_touch || (world().touched(0).contacts > 0 && world().touched(1).contacts > 0);
  }
  EXPECT_TRUE(both_touch);
  EXPECT_THAT(second.truth(), HasSubstr("q1="));
  EXPECT_THAT(second.truth(), HasSubstr("contact_n="));
  EXPECT_THAT(first.truth(), ::testing::Not(HasSubstr("q2="))) << "the other's joints are the other's to tell";
}

TEST_F(MountedDevice, WhoSaysNothingIsHeldByItsOwnBrakesAndTheOtherGoesOn) {
  begin("mount left 0,3,0");
  for (int i = 0; i < 100; ++i) {
    send(*to_first, 1);
    send(*to_second, 6);
    step();
  }
  EXPECT_GT(world().velocity(1), 0.2);
  for (int i = 0; i < 100; ++i) {
    send(*to_first, 1);
    step();
  }
  EXPECT_TRUE(second.watchdog_tripped());
  EXPECT_LT(std::abs(world().velocity(1)), 1e-3);
  EXPECT_GT(world().velocity(0), 0.15);
}

TEST_F(MountedDevice, TakesTheLinesOfItsRobotOnceItIsThereAndIsMountedOnceBeforeItRuns) {
  ASSERT_TRUE(first.plug());
  ASSERT_TRUE(second.plug());
  EXPECT_EQ(second.remarks().size(), 1u) << "it has none yet";
  EXPECT_FALSE(second.fault("posture 0.1"));
  for (const char* line : {"mount", "mount left", "mount left 0,0", "mount left 0,0,0 1", "mount l/r 0,0,0"})
    EXPECT_EQ(second.fault(line).error().code, ErrorCode::InvalidArgument) << line;
  ASSERT_TRUE(second.fault("mount left 0.5,0,0 0,0,3.14159265"));
  EXPECT_TRUE(second.remarks().empty());
  EXPECT_EQ(second.fault("mount more 2,0,0").error().code, ErrorCode::AlreadyExists);
  EXPECT_EQ(second.fault("joints left/slide").error().code, ErrorCode::AlreadyExists);
  for (const char* line : {"posture 0.1", "rotors 0.5", "mass 1.1", "inertia 1.1", "friction 1 2", "payload 2",
                           "tip cube", "push 1 0 0", "noise 0.1", "MODEL_FILE two.urdf"})
    EXPECT_TRUE(second.fault(line)) << line;
  EXPECT_FALSE(second.fault("posture 0.1,0.2"));
  EXPECT_FALSE(second.fault("posture 0.4")) << "it would stand in the other one";
  EXPECT_FALSE(second.fault("gravity 0 0 0")) << "the world is the other device's";
  EXPECT_EQ(world().position(0), 0);
  EXPECT_EQ(world().position(1), 0.1);
  PartDevice late{flows, {Transfer::SharedMemory, "late"}, {.cycle = 1ms, .in_world_of = &first}};
  ASSERT_TRUE(late.plug());
  EXPECT_EQ(late.fault("mount third 5,0,0").error().code, ErrorCode::NotFound) << "it has no file";
  first.step(now);
  first.step(now += 2ms);
  PartDevice later{flows,
                   {Transfer::SharedMemory, "later"},
                   {.cycle = 1ms, .files = second.settings().files, .in_world_of = &first}};
  ASSERT_TRUE(later.plug());
  EXPECT_EQ(later.fault("mount third 5,0,0").error().code, ErrorCode::NotPermitted);
}

TEST_F(MountedDevice, IsAsItsMjcfFileSaysWhereItsMissionNamesOne) {
  const std::string scene =
      file("two.xml", R"(<mujoco><worldbody><geom name="bench" type="box" size="0.1 0.1 0.1" pos="0 1 0"/>
    <body name="cube"><joint name="slide" type="slide" axis="1 0 0" actuatorfrcrange="-3 3"/>
    <geom type="box" size="0.1 0.1 0.1" mass="4"/></body></worldbody></mujoco>)");
  ASSERT_TRUE(first.plug());
  ASSERT_TRUE(first.fault("gravity 0 0 0"));
  PartDevice other{flows,
                   {Transfer::SharedMemory, "other"},
                   {.cycle = 1ms,
                    .files = {{"MODEL_FILE", file("two.urdf", cube_slider(2))}, {"WORLD_FILE", scene}},
                    .in_world_of = &first}};
  ASSERT_TRUE(other.plug());
  EXPECT_TRUE(other.fault("WORLD_FILE two.xml")) << "as the setting of the mission that it is";
  const auto mounted = other.fault("mount left 0.5,0,0 0,0,3.14159265");
  ASSERT_TRUE(mounted) << mounted.error().text;
  EXPECT_EQ(world().effort(1), 3) << "what its drive can do there";
  EXPECT_GE(mj_name2id(&world().model(), mjOBJ_GEOM, "left/bench"), 0) << "with all that stands there";
  EXPECT_EQ(world().model().body_mass[mj_name2id(&world().model(), mjOBJ_BODY, "left/cube")], 4);
  for (int i = 0; i < 100; ++i) {
    first.robot().drive(1, 9, Brakes::Open);
    first.robot().step(1ms);
  }
  EXPECT_NEAR(world().velocity(1), 3.0 / 4 * 0.1, 1e-6) << "9 N are held to them";
  PartDevice wrong{flows,
                   {Transfer::SharedMemory, "wrong"},
                   {.cycle = 1ms,
                    .files = {{"MODEL_FILE", file("two.urdf", cube_slider(2))}, {"WORLD_FILE", "nowhere.xml"}},
                    .in_world_of = &first}};
  ASSERT_TRUE(wrong.plug());
  EXPECT_EQ(wrong.fault("mount third 5,0,0").error().code, ErrorCode::NotFound);
}

TEST_F(MountedDevice, MayHandJointsOverToAThirdOne) {
  const std::string two_joints = file("two_joints.urdf", R"(<robot name="r"><link name="base"/>
    <link name="a"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <link name="b"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
    <joint name="turn" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="9"/></joint>
    <joint name="slide" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="9"/></joint></robot>)");
  ASSERT_TRUE(first.plug());
  PartDevice arm{flows,
                 {Transfer::SharedMemory, "arm"},
                 {.cycle = 1ms, .files = {{"MODEL_FILE", two_joints}}, .in_world_of = &first}};
  PartDevice gripper{flows, {Transfer::SharedMemory, "gripper"}, {.cycle = 1ms, .in_world_of = &first}};
  ASSERT_TRUE(arm.plug() && gripper.plug());
  ASSERT_TRUE(arm.fault("mount left 0,2,0"));
  EXPECT_FALSE(gripper.fault("joints slide,left/slide")) << "of two robots";
  EXPECT_FALSE(gripper.fault("joints left/turn,left/slide")) << "all of one";
  ASSERT_TRUE(gripper.fault("joints left/slide"));
  EXPECT_THAT(gripper.truth(), ::testing::Not(HasSubstr("q2=")));
  EXPECT_THAT(arm.truth(), HasSubstr("q2=")) << "its truth is of the whole robot";
}

}  // namespace
}  // namespace hirosco::simulation
