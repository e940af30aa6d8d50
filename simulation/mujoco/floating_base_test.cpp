// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <fstream>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/mujoco/base_device.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;
using Brakes = MujocoRobot::Brakes;
using Vector = FloatingBase::Vector;

constexpr double base_kg_m2 = 40, arm_kg = 10;

/// A box with an arm that turns about z above its centre of mass.
std::string craft() {
  return R"(<robot name="craft"><link name="hull"><inertial><mass value="100"/>
    <inertia ixx="40" ixy="0" ixz="0" iyy="40" iyz="0" izz="40"/></inertial></link>
    <joint name="turn" type="revolute"><origin xyz="0 0 0"/><parent link="hull"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="20"/></joint>
    <link name="arm"><inertial><origin xyz="0 0 0"/><mass value="10"/>
    <inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="2"/></inertial></link></robot>)";
}
MujocoRobot floating() {
  auto robot = MujocoRobot::make(craft()).value();
  robot.set_gravity(0, 0, 0);
  EXPECT_TRUE(robot.let_float());
  return robot;
}
constexpr std::array no_drive{0.0};

TEST(FloatingBase, IsTurnedByItsWheelsAndTheyTakeUpWhatItGets) {
  auto robot = floating();
  robot.base().drive({0, 0.2, 0}, {});
  for (int i = 0; i < 2000; ++i) robot.step(no_drive, Brakes::Closed, 1ms);
  // With closed brakes hull and arm are one; what the wheel has across its axis is in the hull's own figure.
  EXPECT_NEAR(robot.base().rate_rad_s(robot.data())[1], 0.2 * 2 / (base_kg_m2 + 2), 1e-9);
  EXPECT_NEAR(robot.base().wheels_n_m_s(robot.data())[1], -0.4, 1e-9);
  const auto all = robot.base().momentum(robot.model(), robot.data());
  for (const double each : all.angular_n_m_s) EXPECT_NEAR(each, 0, 1e-9);
}

TEST(FloatingBase, IsTurnedByThrustersInItsOwnAxesAndThatIsMomentumFromOutside) {
  auto robot = floating();
  robot.set_in_motion({0, 0, 0, 0, 0, 0}, no_drive);
  robot.base().drive({}, {0, 0, 5});
  for (int i = 0; i < 1000; ++i) robot.step(no_drive, Brakes::Closed, 1ms);
  const auto all = robot.base().momentum(robot.model(), robot.data());
  EXPECT_NEAR(all.angular_n_m_s[2], FloatingBase::thruster_torque_n_m, 1e-9) << "held to what they have";
}

TEST(FloatingBase, GivesWayToItsArm) {
  auto robot = floating();
  const std::array torque{1.0};
  for (int i = 0; i < 1000; ++i) robot.step(torque, Brakes::Open, 1ms);
  // Equal and opposite: the hull turns back by 2 / 40 of what the arm turns, both in inertial axes.
  const double hull = robot.base().rate_rad_s(robot.data())[2];
  EXPECT_NEAR(hull, -1.0 / base_kg_m2, 1e-9);
  EXPECT_NEAR(robot.velocity(0) + hull, 1.0 / 2, 1e-9);
}

TEST(FloatingBase, WheelsThatAreFullGiveNothingMore) {
  auto robot = floating();
  robot.base().set_wheels(robot.data(), {7.9, 0, 0});
  robot.base().drive({-1, 0, 0}, {});
  for (int i = 0; i < 2000; ++i) robot.step(no_drive, Brakes::Closed, 1ms);
  // 0.25 N m for 0.4 s.
  EXPECT_NEAR(robot.base().wheels_n_m_s(robot.data())[0], FloatingBase::wheel_momentum_n_m_s, 1e-3);
  robot.base().drive({1, 0, 0}, {});
  for (int i = 0; i < 400; ++i) robot.step(no_drive, Brakes::Closed, 1ms);
  EXPECT_NEAR(robot.base().wheels_n_m_s(robot.data())[0], 7.9, 1e-3);
}

TEST(FloatingBase, KeepsMomentumAndEnergyWhileEverythingTumbles) {
  auto robot = floating();
  robot.set_in_motion({0.1, -0.2, 0.15, 0.01, 0, -0.02}, std::array{0.3});
  const auto begun = robot.base().momentum(robot.model(), robot.data());
  const double energy_j = robot.kinetic_energy_j();
  for (int i = 0; i < 5000; ++i) robot.step(no_drive, Brakes::Open, 1ms);
  const auto now = robot.base().momentum(robot.model(), robot.data());
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(now.angular_n_m_s[i], begun.angular_n_m_s[i], 1e-8);
    EXPECT_NEAR(now.linear_n_s[i], begun.linear_n_s[i], 1e-8);
  }
  EXPECT_NEAR(robot.kinetic_energy_j(), energy_j, 1e-9);
  EXPECT_NEAR(robot.model().body_subtreemass[0], 100 + arm_kg, 1e-9);
}

/// Both subsystems' sides, by hand.
struct BaseDeviceTest : ::testing::Test {
  static std::string file() {
    const std::string path = ::testing::TempDir() + "floating_craft.urdf";
    std::ofstream{path} << craft();
    return path;
  }
  LocalFlows flows;
  MujocoDevice joints{flows, {Transfer::SharedMemory, "joints"}, {.cycle = 1ms, .files = {{"MODEL_FILE", file()}}}};
  BaseDevice base{flows,
                  {Transfer::SharedMemory, "wheels"},
                  {.cycle = 10ms,
                   .seed = 7,
                   .endnode = "WHEELS",
                   .further = {{"SENSORS", {{Transfer::SharedMemory, "sensors"}}}},
                   .in_world_of = &joints}};
  std::unique_ptr<DataFlow> wheels, sensors;
  TimePoint now{1s};
  std::uint32_t sequence{0};

  void float_it() {
    ASSERT_TRUE(joints.plug());
    ASSERT_TRUE(joints.fault("gravity 0 0 0"));
    ASSERT_TRUE(joints.fault("base free"));
    ASSERT_TRUE(base.plug());
    wheels = flows.open({Transfer::SharedMemory, "wheels"}, FlowSide::Subsystem).value();
    sensors = flows.open({Transfer::SharedMemory, "sensors"}, FlowSide::Subsystem).value();
  }
  void send(DataFlow& flow, DeviceMode mode, std::span<const double> numbers) {
    std::array<std::byte, max_device_payload_octets> payload;
    OctetWriter writer{payload, std::endian::little};
    for (const double number : numbers) writer.put(number);
    std::array<std::byte, max_device_frame_octets> buffer;
    ASSERT_TRUE(flow.send(write_command(buffer, {mode, 1, ++sequence, 50'000, writer.written()}).value()));
  }
  std::vector<double> hear(DataFlow& flow, std::size_t numbers) {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = flow.receive(buffer);
    EXPECT_TRUE(received && received->flow == Flow::New);
    const auto status = read_status(Octets{buffer}.first(received->octets)).value();
    EXPECT_EQ(status.payload.size(), 8 * numbers);
    OctetReader reader{status.payload, std::endian::little};
    std::vector<double> told;
    for (std::size_t i = 0; i < numbers; ++i) told.push_back(reader.get<double>());
    return told;
  }
  /// 10 ms, of which both devices know by their own clocks.
  void run() {
    for (int i = 0; i < 10; ++i) {
      now += 1ms;
      joints.step(now);
      base.step(now);
    }
  }
};

TEST_F(BaseDeviceTest, IsRefusedInAWorldWhoseBaseStands) {
  ASSERT_TRUE(joints.plug());
  const auto plugged = base.plug();
  ASSERT_FALSE(plugged);
  EXPECT_EQ(plugged.error().code, ErrorCode::Unavailable);
}

TEST_F(BaseDeviceTest, TellsAtEachEndnodeWhatIsItsAndTurnsTheBaseOfTheOtherDevicesWorld) {
  float_it();
  const std::array torque{0.0, 0.0, 0.2, 0.0, 0.0, 0.0};
  std::vector<double> stored, where;
  for (int i = 0; i < 101; ++i) {
    send(*wheels, DeviceMode::Active, torque);
    send(*sensors, DeviceMode::Active, {});
    run();
    stored = hear(*wheels, 3);
    where = hear(*sensors, 13);
  }
  EXPECT_NEAR(stored[2], -0.2, 0.01);
  EXPECT_NEAR(where[9], 0.2 / (base_kg_m2 + 2), 5e-4) << "rate about z";
  EXPECT_NEAR(where[3], 1, 1e-3) << "w of its orientation";
  // Nobody commands it any more: its watchdog takes the torque away, what is stored stays.
  run();
  for (int i = 0; i < 10; ++i) run();
  const auto after = joints.robot().base().wheels_n_m_s(joints.robot().data());
  run();
  EXPECT_TRUE(base.watchdog_tripped());
  EXPECT_NEAR(joints.robot().base().wheels_n_m_s(joints.robot().data())[2], after[2], 1e-12);
}

TEST_F(BaseDeviceTest, MeasuresWithTheNoiseThatItIsGiven) {
  float_it();
  ASSERT_TRUE(base.fault("position_noise 0.001"));
  ASSERT_TRUE(base.fault("attitude_noise 0.003"));
  double places = 0, turns = 0;
  constexpr int samples = 400;
  for (int i = 0; i < samples; ++i) {
    send(*sensors, DeviceMode::Active, {});
    run();
    const auto where = hear(*sensors, 13);
    for (std::size_t k = 0; k < 3; ++k) places += where[k] * where[k];
    for (std::size_t k = 4; k < 7; ++k) turns += 4 * where[k] * where[k];
  }
  EXPECT_NEAR(std::sqrt(places / (3 * samples)), 0.001, 1e-4);
  EXPECT_NEAR(std::sqrt(turns / (3 * samples)) * 180 / 3.14159265358979, 0.003, 3e-4);
  EXPECT_FALSE(base.fault("wheels 9,0,0"));
}

/// In frames that are new, with a noise that would otherwise never be the same twice.
TEST_F(BaseDeviceTest, GoesOnTellingWhatItToldLastWhileItIsStuck) {
  float_it();
  ASSERT_TRUE(base.fault("position_noise 0.001"));
  const auto told = [&] {
    send(*sensors, DeviceMode::Active, {});
    run();
    return hear(*sensors, 13);
  };
  const auto first = told();
  EXPECT_NE(told(), first);
  const auto last = told();
  ASSERT_TRUE(base.fault("stuck on"));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(told(), last) << i;
  ASSERT_TRUE(base.fault("stuck off"));
  EXPECT_NE(told(), last);
  ASSERT_TRUE(base.fault("stuck on"));
  ASSERT_TRUE(base.fault("heal"));
  ASSERT_TRUE(base.fault("position_noise 0.001"));
  EXPECT_NE(told(), last);
  EXPECT_FALSE(base.fault("stuck"));
  EXPECT_FALSE(base.fault("stuck always"));
}

}  // namespace
}  // namespace hirosco::simulation
