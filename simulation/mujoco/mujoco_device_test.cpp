// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <fstream>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/mujoco/mujoco_device.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t joints = 2;

/// Two rods that hang on each other and swing.
std::string rods() {
  constexpr const char* mass =
      R"(<inertial><origin xyz="0 0 0.2"/><mass value="3"/><inertia ixx="0.04" ixy="0" ixz="0" iyy="0.04" iyz="0"
    izz="0.002"/></inertial>)";
  constexpr const char* swings = R"(<axis xyz="0 1 0"/><limit lower="-3" upper="3" velocity="5" effort="60"/>
    <dynamics damping="0.2" friction="0.5"/>)";
  std::string text = R"(<robot name="rods"><link name="base"/><link name="upper">)";
  text += std::string{mass} +
          R"(<collision><origin xyz="0 0 0.4"/><geometry><sphere radius="0.03"/></geometry></collision></link>
    <link name="lower">)" +
          mass + R"(<collision><geometry><mesh filename="lower.stl"/></geometry></collision></link>
    <joint name="one" type="revolute"><parent link="base"/><child link="upper"/>)" +
          swings + R"(</joint>
    <joint name="two" type="revolute"><origin xyz="0 0 0.4"/><parent link="upper"/><child link="lower"/>)" +
          swings + "</joint></robot>";
  const std::string file = ::testing::TempDir() + "rods.urdf";
  std::ofstream{file} << text;
  return file;
}

/// The subsystem's side, by hand.
struct MujocoDeviceTest : ::testing::Test {
  LocalFlows flows;
  FlowAddress address{Transfer::SharedMemory, "device"};
  MujocoDevice device{flows,
                      address,
                      {.cycle = 1ms,
                       .stop = SimulatedDevice::Stop::Controlled,
                       .stop_within = 500ms,
                       .files = {{"MODEL_FILE", rods()}}}};
  std::unique_ptr<DataFlow> flow;
  TimePoint now{1s};
  std::uint32_t sequence{0};
  std::vector<double> told;

  void SetUp() override {
    ASSERT_TRUE(device.plug());
    ASSERT_TRUE(device.fault("posture 0.5,0.7"));
    flow = flows.open(address, FlowSide::Subsystem).value();
  }
  void exchange(DeviceMode mode, const std::array<double, joints>& torque = {}) {
    std::array<std::byte, 8 * joints> payload{};
    OctetWriter writer{payload, std::endian::little};
    for (const double value : torque) writer.put(value);
    std::array<std::byte, max_device_frame_octets> frame;
    ASSERT_TRUE(flow->send(write_command(frame, {mode, 1, ++sequence, 0, payload}).value()));
    device.step(now += 1ms);
    const auto received = flow->receive(frame);
    ASSERT_TRUE(received && received->flow == Flow::New);
    const auto status = read_status(Octets{frame}.first(received->octets));
    ASSERT_TRUE(status);
    ASSERT_EQ(status->payload.size(), 24 * joints);
    OctetReader reader{status->payload, std::endian::little};
    told.clear();
    for (std::size_t i = 0; i < 3 * joints; ++i) told.push_back(reader.get<double>());
  }
  double fastest() const {
    double most = 0;
    for (std::size_t i = 0; i < joints; ++i) most = std::max(most, std::abs(device.robot().velocity(i)));
    return most;
  }
};

TEST_F(MujocoDeviceTest, TellsWhereItStandsAndStaysThereWithoutACommand) {
  const std::array posture{0.5, 0.7};
  for (int i = 0; i < 5000; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Off));
  for (std::size_t i = 0; i < joints; ++i) EXPECT_NEAR(told[i], posture[i], 1e-3) << i;
  EXPECT_FALSE(device.drives());
}

TEST_F(MujocoDeviceTest, FallsWhenItIsActiveAndItsDrivesGiveNothing) {
  for (int i = 0; i < 300; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active));
  EXPECT_GT(fastest(), 0.5);
}

TEST_F(MujocoDeviceTest, ComesToRestByItselfWithinItsTimeWhenItsCommandsEnd) {
  for (int i = 0; i < 300; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, {40, 5}));
  EXPECT_GT(fastest(), 0.5);
  for (int i = 0; i < 510 + 10; ++i) device.step(now += 1ms);
  EXPECT_TRUE(device.watchdog_tripped());
  EXPECT_LT(fastest(), 0.01);
}

TEST_F(MujocoDeviceTest, GivesNoMoreThanEachJointsEffort) {
  ASSERT_TRUE(device.fault("friction 0"));
  exchange(DeviceMode::Active, {1e6, -1e6});
  for (std::size_t i = 0; i < joints; ++i) EXPECT_LE(std::abs(told[2 * joints + i]), device.robot().effort(i) + 1e-9);
}

TEST_F(MujocoDeviceTest, SaysWhatItDoesNotTake) {
  for (const char* line :
       {"posture 1", "posture 1,x", "rotors 1,-1", "rotors 1,1001", "mass 0", "payload -1", "friction", "gravity 1 2",
        "dance", "obstacle_ sphere 1 9,9,9", "obstacle_a", "obstacle_a none", "obstacle_a sphere 1 9,9", "softness 0"})
    EXPECT_FALSE(device.fault(line)) << line;
  EXPECT_TRUE(device.fault("rotors 0,1000")) << "the heaviest that `hirosco new robot` guesses";
}

TEST_F(MujocoDeviceTest, SaysWhatIsWrongWithAnObstacle) {
  const auto refused = device.fault("obstacle_ball sphere 0.1 9,9 0.5");
  ASSERT_FALSE(refused);
  EXPECT_STREQ(refused.error().text,
               "the place '9,9' has 2 numbers, not 3; write sphere RADIUS X,Y,Z [FRICTION [ROLL,PITCH,YAW]]");
}

TEST_F(MujocoDeviceTest, IsHeldByAWallThatItsDrivesPressAgainstAndTellsIt) {
  // The upper rod lies on the floor's edge beside it; the lower one has no shape.
  ASSERT_TRUE(device.fault("friction 0") && device.fault("gravity 0 0 0") && device.fault("posture 0.5,0"));
  ASSERT_TRUE(device.fault("softness 0.005"));
  ASSERT_TRUE(device.fault("obstacle_wall box 0.1,1,1 0.3,0,0 0.3"));
  for (int i = 0; i < 1500; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, {20, 0}));
  EXPECT_LT(told[0], 0.8);
  EXPECT_NE(device.truth().find(" contacts=1 "), std::string::npos) << device.truth();
  ASSERT_TRUE(device.fault("obstacle_wall none"));
  for (int i = 0; i < 300; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, {20, 0}));
  EXPECT_GT(told[0], 1);
}

TEST_F(MujocoDeviceTest, TellsWhichShapesAreNotInItsWorld) {
  EXPECT_EQ(device.remarks(),
            std::vector<std::string>{"its world leaves out a shape of link 'lower': lower.stl does not exist"});
}

/// Its frames end with a flag of each joint, in both directions.
TEST(MujocoDevice, WithEncodersThatCountTellsWhoKnowsItsZeroAndForgetsItWithoutPower) {
  LocalFlows flows;
  const FlowAddress address{Transfer::SharedMemory, "device"};
  MujocoDevice device{flows, address, {.cycle = 1ms, .files = {{"MODEL_FILE", rods()}}}};
  ASSERT_TRUE(device.plug());
  for (const char* wrong : {"encoders 0.55", "encoders 0.55,x", "encoders 0.55,0.8 0", "encoders forget"})
    EXPECT_FALSE(device.fault(wrong)) << wrong;
  for (const char* line : {"posture 0.5,0.7", "gravity 0 0 0", "friction 0", "encoders 0.55,0.8 0.25,-1"})
    ASSERT_TRUE(device.fault(line)) << line;
  const auto flow = std::move(flows.open(address, FlowSide::Subsystem).value());
  TimePoint now{1s};
  std::uint32_t sequence = 0;
  std::array<double, 3 * joints> told{};
  std::array<std::uint8_t, joints> knows{};
  const auto exchange = [&](DeviceMode mode, double torque) {
    std::array<std::byte, 9 * joints> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(torque).put(0.0).put(std::uint8_t{1}).put(std::uint8_t{0});
    std::array<std::byte, max_device_frame_octets> frame;
    ASSERT_TRUE(flow->send(write_command(frame, {mode, 1, ++sequence, 0, payload}).value()));
    device.step(now += 1ms);
    const auto received = flow->receive(frame);
    ASSERT_TRUE(received && received->flow == Flow::New);
    const auto status = read_status(Octets{frame}.first(received->octets));
    ASSERT_TRUE(status);
    ASSERT_EQ(status->payload.size(), 25 * joints);
    OctetReader reader{status->payload, std::endian::little};
    for (double& number : told) number = reader.get<double>();
    for (std::uint8_t& flag : knows) flag = reader.get<std::uint8_t>();
  };
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Off, 0));
  EXPECT_NEAR(told[0], 0.25, 1e-6);
  EXPECT_NEAR(told[1], -1, 1e-6);
  EXPECT_EQ(knows, (std::array<std::uint8_t, joints>{0, 0}));
  EXPECT_FALSE(device.fault("encoders 0.55,0.8")) << "it flies";
  for (int i = 0; i < 2000 && knows[0] == 0; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, 5));
  EXPECT_EQ(knows, (std::array<std::uint8_t, joints>{1, 0}));
  EXPECT_NEAR(told[0], device.robot().position(0), 1e-12);
  EXPECT_NEAR(told[0], 0.55, 0.01);
  EXPECT_NE(device.truth().find("referenced_1=1 referenced_2=0 "), std::string::npos) << device.truth();
  ASSERT_TRUE(device.fault("reboot"));
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Off, 0));
  EXPECT_EQ(knows, (std::array<std::uint8_t, joints>{0, 0}));
  EXPECT_NEAR(told[0], 0.25, 0.01);
}

TEST(MujocoDevice, WithoutAFileOrWithOneThatIsNoneIsNotPluggedIn) {
  LocalFlows flows;
  using Files = std::map<std::string, std::string>;
  for (const Files& files : {Files{}, Files{{"MODEL_FILE", "nowhere.urdf"}}, Files{{"MODEL_FILE", __FILE__}}}) {
    MujocoDevice device{flows, {Transfer::SharedMemory, "device"}, {.files = files}};
    const auto plugged = device.plug();
    ASSERT_FALSE(plugged);
    EXPECT_NE(std::string{plugged.error().text}, "");
  }
}

TEST_F(MujocoDeviceTest, SaysWhichEngineReckonsItsWorld) {
  EXPECT_EQ(device.engine(), std::string{"MuJoCo-"} + mj_versionString());
  EXPECT_EQ(mj_version(), mjVERSION_HEADER) << "its library is that of its headers";
}

}  // namespace
}  // namespace hirosco::simulation
