// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/part_device.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <vector>

#include "hirosco/data_transfer/device/local_flows.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;

/// A rod that turns about z, and a finger that slides along it; nothing weighs on either.
std::string rod_with_finger() {
  return R"(<robot name="rod"><link name="base"/>
    <joint name="turn" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="20"/></joint>
    <link name="rod"><inertial><mass value="10"/><inertia ixx="2" ixy="0" ixz="0" iyy="2" iyz="0" izz="2"/></inertial></link>
    <joint name="slide" type="prismatic"><parent link="rod"/><child link="finger"/><axis xyz="1 0 0"/>
    <limit lower="-0.5" upper="0.5" velocity="1" effort="10"/></joint>
    <link name="finger"><inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
    </robot>)";
}

/// Both subsystems' sides, by hand.
struct PartDeviceTest : ::testing::Test {
  static std::string file() {
    const std::string path = ::testing::TempDir() + "rod_with_finger.urdf";
    std::ofstream{path} << rod_with_finger();
    return path;
  }
  LocalFlows flows;
  MujocoDevice arm{flows, {Transfer::SharedMemory, "rod"}, {.cycle = 1ms, .files = {{"MODEL_FILE", file()}}}};
  PartDevice finger{
      flows,
      {Transfer::SharedMemory, "finger"},
      {.cycle = 1ms, .stop = SimulatedDevice::Stop::Controlled, .stop_within = 20ms, .in_world_of = &arm}};
  std::unique_ptr<DataFlow> to_arm, to_finger;
  TimePoint now{1s};
  std::uint32_t sequence{0};

  void begin() {
    ASSERT_TRUE(arm.plug());
    ASSERT_TRUE(arm.fault("gravity 0 0 0"));
    ASSERT_TRUE(finger.plug());
    ASSERT_TRUE(finger.fault("joints slide"));
    to_arm = flows.open({Transfer::SharedMemory, "rod"}, FlowSide::Subsystem).value();
    to_finger = flows.open({Transfer::SharedMemory, "finger"}, FlowSide::Subsystem).value();
  }
  void send(DataFlow& flow, DeviceMode mode, double torque) {
    std::array<std::byte, 8> payload{};
    OctetWriter{payload, std::endian::little}.put(torque);
    std::array<std::byte, max_device_frame_octets> buffer;
    ASSERT_TRUE(flow.send(
        write_command(buffer,
                      {.mode = mode, .epoch = 1, .sequence = ++sequence, .watchdog_us = 5000, .payload = payload})
            .value()));
  }
  std::vector<double> hear(DataFlow& flow) {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = flow.receive(buffer);
    EXPECT_TRUE(received && received->flow == Flow::New);
    const auto status = read_status(Octets{buffer}.first(received->octets)).value();
    OctetReader reader{status.payload, std::endian::little};
    std::vector<double> told;
    while (reader.remaining() > 0) told.push_back(reader.get<double>());
    return told;
  }
  void step() {
    now += 1ms;
    arm.step(now);
    finger.step(now);
  }
  const MujocoRobot& world() { return std::as_const(arm).robot(); }
};

TEST_F(PartDeviceTest, EachOfTheTwoDrivesAndTellsItsOwnJoints) {
  begin();
  std::vector<double> of_arm, of_finger;
  for (int i = 0; i < 101; ++i) {
    send(*to_arm, DeviceMode::Active, 0);
    send(*to_finger, DeviceMode::Active, 2);
    step();
    of_arm = hear(*to_arm);
    of_finger = hear(*to_finger);
  }
  ASSERT_EQ(of_arm.size(), 3u);
  ASSERT_EQ(of_finger.size(), 3u);
  // 2 N on 1 kg for 0.1 s: what was taken in one cycle acts from the next one on.
  EXPECT_NEAR(of_finger[1], 0.2, 1e-3);
  EXPECT_EQ(of_finger[0], world().position(1));
  EXPECT_NEAR(of_arm[1], 0, 1e-9);
  EXPECT_THAT(finger.truth(), ::testing::HasSubstr("q1="));
}

TEST_F(PartDeviceTest, WhoSaysNothingHasClosedBrakesAndTheOtherOneGoesOn) {
  begin();
  for (int i = 0; i < 100; ++i) {
    send(*to_arm, DeviceMode::Active, 1);
    send(*to_finger, DeviceMode::Active, 2);
    step();
  }
  EXPECT_GT(world().velocity(1), 0.1);
  for (int i = 0; i < 100; ++i) {
    send(*to_arm, DeviceMode::Active, 1);
    step();
  }
  EXPECT_TRUE(finger.watchdog_tripped());
  EXPECT_EQ(finger.output(), DeviceOutput::Holding);
  EXPECT_LT(std::abs(world().velocity(1)), 1e-3);
  const double rate_rad_s = world().velocity(0);
  send(*to_arm, DeviceMode::Active, 1);
  step();
  EXPECT_GT(world().velocity(0), rate_rad_s);
}

/// The program of both is late, and the commands of one later still.
TEST_F(PartDeviceTest, AStepThatTheWatchdogOfOneForgivesPassesInTheWorldOfBoth) {
  begin();
  for (const bool arm_starves : {true, false}) {
    for (int i = 0; i < 10; ++i) {
      send(*to_arm, DeviceMode::Active, 0);
      send(*to_finger, DeviceMode::Active, 2);
      step();
    }
    const SimulatedDevice& starved = arm_starves ? static_cast<const SimulatedDevice&>(arm) : finger;
    const auto lived = starved.cycles();
    const double speed_m_s = world().velocity(1);
    for (int i = 0; i < 5; ++i) {
      now += 4ms;
      if (arm_starves) send(*to_finger, DeviceMode::Active, 2);
      else send(*to_arm, DeviceMode::Active, 0);
      arm.step(now);
      finger.step(now);
      ASSERT_TRUE(arm.active() && finger.active()) << "forgiven";
    }
    EXPECT_GE(starved.cycles(), lived + 5) << (arm_starves ? "the arm" : "the finger");
    EXPECT_GT(world().velocity(1), speed_m_s + 8e-3) << "2 N on 1 kg for 5 ms and more";
  }
}

TEST_F(PartDeviceTest, OneAloneHasItsWorldStandInAStepThatItsWatchdogForgives) {
  ASSERT_TRUE(arm.plug());
  ASSERT_TRUE(arm.fault("gravity 0 0 0"));
  to_arm = flows.open({Transfer::SharedMemory, "rod"}, FlowSide::Subsystem).value();
  const auto drive_both = [this] {
    std::array<std::byte, 16> payload{};
    OctetWriter{payload, std::endian::little}.put(1.0).put(2.0);
    std::array<std::byte, max_device_frame_octets> buffer;
    const DeviceCommand command{
        .mode = DeviceMode::Active, .epoch = 1, .sequence = ++sequence, .watchdog_us = 5000, .payload = payload};
    ASSERT_TRUE(to_arm->send(write_command(buffer, command).value()));
  };
  for (int i = 0; i < 10; ++i) {
    drive_both();
    arm.step(now += 1ms);
  }
  const auto lived = arm.cycles();
  const double where_m = world().position(1);
  ASSERT_GT(where_m, 0);
  for (int i = 0; i < 5; ++i) {
    arm.step(now += 4ms);
    ASSERT_TRUE(arm.active()) << "forgiven";
    ASSERT_EQ(world().position(1), where_m) << i;
  }
  EXPECT_EQ(arm.cycles(), lived);
  drive_both();
  arm.step(now += 1ms);
  EXPECT_GT(world().position(1), where_m);
}

TEST_F(PartDeviceTest, IsOnlyInAWorldOfSuchADevice) {
  const auto plugged = finger.plug();
  ASSERT_FALSE(plugged);
  EXPECT_EQ(plugged.error().code, ErrorCode::Unavailable);
  EXPECT_FALSE(finger.fault("joints slide"));
}

TEST_F(PartDeviceTest, TakesJointsThatAreThereOnceBeforeItRunsAndSaysSoWhereItHasNone) {
  ASSERT_TRUE(arm.plug());
  ASSERT_TRUE(finger.plug());
  EXPECT_EQ(finger.remarks().size(), 1u);
  for (const char* line : {"joints", "joints thumb", "joints slide,slide", "joints turn,slide", "posture 1,2"})
    EXPECT_FALSE(finger.fault(line)) << line;
  ASSERT_TRUE(finger.fault("joints slide"));
  EXPECT_TRUE(finger.remarks().empty());
  EXPECT_FALSE(finger.fault("joints turn"));
  PartDevice late{flows, {Transfer::SharedMemory, "late"}, {.cycle = 1ms, .in_world_of = &arm}};
  ASSERT_TRUE(late.plug());
  EXPECT_FALSE(late.fault("joints slide")) << "somebody else's";
  arm.step(now);
  arm.step(now += 2ms);
  EXPECT_EQ(late.fault("joints turn").error().code, ErrorCode::NotPermitted);
}

}  // namespace
}  // namespace hirosco::simulation
