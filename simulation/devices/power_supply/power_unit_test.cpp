// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/power_supply/power_unit.hpp"

#include <gtest/gtest.h>

#include <array>

#include "hirosco/data_transfer/device/local_flows.hpp"

namespace hirosco::simulation {
namespace {

struct PowerUnitTest : ::testing::Test {
  LocalFlows flows;
  FlowAddress address{Transfer::SharedMemory, "unit"};
  SimulatedDevice::Settings settings{.cycle = std::chrono::milliseconds{50},
                                     .watchdog = std::chrono::milliseconds{200}};
  PowerUnit unit{flows, address, settings};
  std::unique_ptr<DataFlow> flow;
  TimePoint now{};
  std::uint32_t sequence{0};

  void SetUp() override {
    ASSERT_TRUE(unit.plug());
    flow = flows.open(address, FlowSide::Subsystem).value();
  }
  void command(std::uint8_t payload_on, std::uint32_t epoch = 1) {
    const std::array payload{std::byte{payload_on}};
    std::array<std::byte, max_device_frame_octets> buffer{};
    static_cast<void>(flow->send(write_command(buffer, {DeviceMode::Active, epoch, ++sequence, 0, payload}).value()));
    unit.step(now += settings.cycle);
  }
};

TEST_F(PowerUnitTest, ChargesInTheSunAndGivesWhatIsLackingInEclipse) {
  ASSERT_TRUE(unit.fault("charge 0.5"));
  ASSERT_TRUE(unit.fault("sun_angle 60"));
  command(0);
  const double begun = unit.charge();
  for (int i = 0; i < 20; ++i) command(0);
  EXPECT_NEAR((unit.charge() - begun) * 600 * 3600, 250, 1e-6) << "450 W less 200 W for a second";
  ASSERT_TRUE(unit.fault("eclipse on"));
  const double full = unit.charge();
  for (int i = 0; i < 20; ++i) command(1);
  EXPECT_NEAR((full - unit.charge()) * 600 * 3600, 460, 1e-6);
  ASSERT_TRUE(unit.fault("heal"));
  EXPECT_NEAR(unit.array_w(), 450, 1e-9);
}

TEST_F(PowerUnitTest, WithoutSunAndChargeNothingFeedsTheLoads) {
  ASSERT_TRUE(unit.fault("charge 0"));
  EXPECT_GT(unit.bus_v(), 20) << "the array does";
  ASSERT_TRUE(unit.fault("eclipse on"));
  EXPECT_EQ(unit.bus_v(), 0);
}

TEST_F(PowerUnitTest, KeepsItsOutletsWhoeverIsSilent) {
  command(1);
  EXPECT_TRUE(unit.payload_on());
  for (int i = 0; i < 20; ++i) unit.step(now += settings.cycle);
  EXPECT_TRUE(unit.payload_on()) << "its watchdog has nothing to stop";
  command(0);
  EXPECT_TRUE(unit.payload_on()) << "whoever was silent begins anew";
  command(0, 2);
  EXPECT_FALSE(unit.payload_on());
}

TEST_F(PowerUnitTest, UnderstandsEachOfItsFaultLinesAndRefusesOthers) {
  for (const FaultLine& each : PowerUnit::fault_lines) EXPECT_TRUE(unit.fault(each.line)) << each.line;
  for (const char* line : {"eclipse", "eclipse maybe", "charge 1.1", "sun_angle 181", "array x", "moon 1"})
    EXPECT_FALSE(unit.fault(line)) << line;
}

}  // namespace
}  // namespace hirosco::simulation
