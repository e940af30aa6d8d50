// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/mujoco/lent_device.hpp"

namespace hirosco::simulation {
namespace {

using namespace std::chrono_literals;

/// The test is the subsystem and the world.
struct LentDeviceTest : ::testing::Test {
  LocalFlows flows;
  FlowAddress address{Transfer::SharedMemory, "part"};
  LentDevice device{flows, address, {.cycle = 1ms, .stop = SimulatedDevice::Stop::Controlled, .stop_within = 100ms}};
  std::unique_ptr<DataFlow> flow;
  Lender world = Lender::open(flows, "part", 2).value();
  TimePoint now{1s};
  std::uint32_t sequence{0};
  std::array<double, 6> told{};
  LentCommand heard;

  void SetUp() override {
    ASSERT_TRUE(device.plug());
    ASSERT_TRUE(device.fault("borrow part 2"));
    flow = flows.open(address, FlowSide::Subsystem).value();
  }
  void world_tells(double position) { world.tell({.position = {position, 2}, .velocity = {3, 4}, .torque = {5, 6}}); }
  void exchange(DeviceMode mode, std::array<double, 2> torque = {}) {
    std::array<std::byte, 16> payload{};
    OctetWriter{payload, std::endian::little}.put(torque[0]).put(torque[1]);
    std::array<std::byte, max_device_frame_octets> buffer{};
    ASSERT_TRUE(flow->send(
        write_command(buffer, {.mode = mode, .epoch = 1, .sequence = ++sequence, .payload = payload}).value()));
    device.step(now += 1ms);
    heard = world.hear();
    const auto received = flow->receive(buffer);
    ASSERT_TRUE(received && received->flow == Flow::New);
    const auto status = read_status(Octets{buffer}.first(received->octets)).value();
    ASSERT_EQ(status.payload.size(), 48u);
    OctetReader reader{status.payload, std::endian::little};
    for (double& number : told) number = reader.get<double>();
  }
};

TEST_F(LentDeviceTest, HandsTorquesToTheWorldAndItsSensorsBack) {
  world_tells(1);
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, {7, std::nan("")}));
  EXPECT_EQ(heard.mode, DeviceMode::Active);
  EXPECT_EQ(heard.torques[0], 7);
  EXPECT_EQ(heard.torques[1], 0) << "what is no number is none";
  EXPECT_EQ(told, (std::array<double, 6>{1, 2, 3, 4, 5, 6}));
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Off));
  EXPECT_EQ(heard.mode, DeviceMode::Stop) << "slows down first";
}

TEST_F(LentDeviceTest, WithoutAWorldItsSensorsAreNoNumbers) {
  world_tells(1);
  for (std::uint32_t i = 0; i + 1 < lent_silence_cycles; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active));
  EXPECT_EQ(told[0], 1);
  for (int i = 0; i < 2; ++i) ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active));
  for (const double number : told) EXPECT_TRUE(std::isnan(number));
  world_tells(2);
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active));
  EXPECT_EQ(told[0], 2);
}

TEST_F(LentDeviceTest, OfABorrowerThatSaysNothingTheWorldClosesTheBrakes) {
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, {7, 7}));
  for (std::uint32_t i = 0; i < lent_silence_cycles; ++i) heard = world.hear();
  EXPECT_EQ(heard.mode, DeviceMode::Off);
  EXPECT_EQ(heard.torques[0], 0);
}

TEST_F(LentDeviceTest, ItsOwnWatchdogStopsItsJoints) {
  ASSERT_NO_FATAL_FAILURE(exchange(DeviceMode::Active, {7, 7}));
  for (int i = 0; i < 200; ++i) {
    device.step(now += 1ms);
    heard = world.hear();
  }
  EXPECT_TRUE(device.watchdog_tripped());
  EXPECT_EQ(heard.mode, DeviceMode::Off);
}

TEST_F(LentDeviceTest, HasOneWorldAndSaysWhatItDoesNotTake) {
  for (const char* line : {"borrow part 2", "borrow", "borrow part 0", "borrow part 17", "posture 1,2"})
    EXPECT_FALSE(device.fault(line)) << line;
}

}  // namespace
}  // namespace hirosco::simulation
