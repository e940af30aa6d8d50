// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/thermal/thermal_unit.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "hirosco/data_transfer/device/local_flows.hpp"

namespace hirosco::simulation {
namespace {

constexpr std::size_t zones = 3;

struct ThermalUnitTest : ::testing::Test {
  LocalFlows flows;
  FlowAddress address{Transfer::SharedMemory, "thermal"};
  SimulatedDevice::Settings settings{.cycle = std::chrono::milliseconds{100},
                                     .watchdog = std::chrono::milliseconds{500}};
  ThermalUnit unit{flows, address, settings};
  std::unique_ptr<DataFlow> flow;
  TimePoint now{};
  std::uint32_t sequence{0};
  std::array<float, zones> t_c{};
  float drawn_w{0};

  void SetUp() override {
    // What radiates nothing and gets nothing keeps its heat: what is left is the heaters'.
    for (const char* line : {"zones 3", "radiating_m2 0", "inside_w 0", "sunlit_w 0", "neighbours_w_k 0",
                             "capacities_j_k 100,200,400", "heaters_w 10,20,40", "keeps -12 -8", "temperatures 0"})
      ASSERT_TRUE(unit.fault(line)) << line;
    ASSERT_TRUE(unit.plug());
    flow = flows.open(address, FlowSide::Subsystem).value();
  }
  void command(std::array<std::uint8_t, zones> on, std::array<std::uint8_t, zones> line = {1, 1, 1}, bool own = false) {
    std::array<std::byte, 2 * zones + 1> payload{};
    OctetWriter writer{payload, std::endian::little};
    for (const auto each : on) writer.put(each);
    for (const auto each : line) writer.put(each);
    writer.put(static_cast<std::uint8_t>(own ? 1 : 0));
    std::array<std::byte, max_device_frame_octets> buffer{};
    static_cast<void>(flow->send(write_command(buffer, {DeviceMode::Active, 1, ++sequence, 0, payload}).value()));
    unit.step(now += settings.cycle);
    const auto found = flow->receive(buffer);
    ASSERT_TRUE(found && found->flow == Flow::New);
    const auto status = read_status(Octets{buffer}.first(found->octets)).value();
    OctetReader reader{status.payload, std::endian::little};
    for (float& each : t_c) each = reader.get<float>();
    drawn_w = reader.get<float>();
    ASSERT_TRUE(reader.exhausted());
  }
  void command_for(int cycles, std::array<std::uint8_t, zones> on, std::array<std::uint8_t, zones> line = {1, 1, 1}) {
    for (int i = 0; i < cycles; ++i) command(on, line);
  }
};

/// P t / C, of each zone by itself.
TEST_F(ThermalUnitTest, AHeaterWarmsItsZoneByItsPower) {
  command_for(100, {1, 0, 1});
  EXPECT_NEAR(unit.temperature_c(0), 10.0 * 10 / 100, 1e-9);
  EXPECT_NEAR(unit.temperature_c(1), 0, 1e-12);
  EXPECT_NEAR(unit.temperature_c(2), 40.0 * 10 / 400, 1e-9);
  EXPECT_FLOAT_EQ(t_c[0], 1);
  EXPECT_FLOAT_EQ(drawn_w, 50);
}

TEST_F(ThermalUnitTest, ItsWorldRunsFasterWhereItIsToldSo) {
  ASSERT_TRUE(unit.fault("faster 50"));
  command_for(2, {1, 0, 0});
  EXPECT_NEAR(unit.temperature_c(0), 10.0 * 0.2 * 50 / 100, 1e-9);
}

TEST_F(ThermalUnitTest, TheSunWarmsUntilTheEclipse) {
  ASSERT_TRUE(unit.fault("sunlit_w 4"));
  command_for(10, {0, 0, 0});
  EXPECT_NEAR(unit.temperature_c(0), 4.0 / 100, 1e-9);
  ASSERT_TRUE(unit.fault("eclipse on"));
  command_for(10, {0, 0, 0});
  EXPECT_NEAR(unit.temperature_c(0), 4.0 / 100, 1e-9);
}

TEST_F(ThermalUnitTest, ASwitchThatDoesNotOpenHeatsUntilItsLineIsTaken) {
  ASSERT_TRUE(unit.fault("heater 1 stuck_on"));
  command({0, 0, 0});
  EXPECT_FLOAT_EQ(drawn_w, 20);
  command({0, 0, 0}, {1, 0, 1});
  EXPECT_FLOAT_EQ(drawn_w, 0);
  ASSERT_TRUE(unit.fault("heater 1 stuck_off"));
  command({1, 1, 0});
  EXPECT_FLOAT_EQ(drawn_w, 10);
  ASSERT_TRUE(unit.fault("heal"));
  command({1, 1, 0});
  EXPECT_FLOAT_EQ(drawn_w, 30);
}

TEST_F(ThermalUnitTest, ItsSensorsFailOneByOne) {
  ASSERT_TRUE(unit.fault("temperatures 12"));
  ASSERT_TRUE(unit.fault("sensor 0 dead"));
  ASSERT_TRUE(unit.fault("sensor 1 stuck"));
  ASSERT_TRUE(unit.fault("sensor_offset 2 -7"));
  ASSERT_TRUE(unit.fault("temperatures 20"));
  command({0, 0, 0});
  EXPECT_FLOAT_EQ(t_c[0], -273.15F);
  EXPECT_FLOAT_EQ(t_c[1], 12);
  EXPECT_FLOAT_EQ(t_c[2], 13);
  ASSERT_TRUE(unit.fault("sensor 1 well"));
  command({0, 0, 0});
  EXPECT_FLOAT_EQ(t_c[1], 20);
}

TEST_F(ThermalUnitTest, NoiseIsOfTheSeedAndOfTheSizeThatIsTold) {
  ASSERT_TRUE(unit.fault("noise 0.5"));
  double sum = 0;
  constexpr int rounds = 400;
  for (int i = 0; i < rounds; ++i) {
    command({0, 0, 0});
    sum += double{t_c[0]} * t_c[0];
  }
  EXPECT_NEAR(std::sqrt(sum / rounds), 0.5, 0.06);
}

TEST_F(ThermalUnitTest, KeepsItsZonesByItselfWhileNobodySpeaksToIt) {
  ASSERT_TRUE(unit.fault("temperatures -20"));
  command_for(10, {0, 0, 0});
  EXPECT_EQ(unit.drawn_w(), 0) << "who speaks decides";
  for (int i = 0; i < 12; ++i) unit.step(now += settings.cycle);
  EXPECT_EQ(unit.drawn_w(), 70) << "its watchdog has tripped";
  for (int i = 0; i < 3000; ++i) unit.step(now += settings.cycle);
  for (std::size_t i = 0; i < zones; ++i) {
    EXPECT_GT(unit.temperature_c(i), -12);
    EXPECT_LT(unit.temperature_c(i), -7.9);
  }
}

TEST_F(ThermalUnitTest, KeepsThemToldSoTooAndNeverWithoutALine) {
  ASSERT_TRUE(unit.fault("temperatures -20"));
  command({0, 0, 0}, {1, 0, 1}, true);
  command({0, 0, 0}, {1, 0, 1}, true);
  EXPECT_FLOAT_EQ(drawn_w, 50);
}

TEST_F(ThermalUnitTest, UnderstandsEachOfItsFaultLinesAndRefusesOthers) {
  for (const FaultLine& each : ThermalUnit::fault_lines) {
    ASSERT_TRUE(unit.fault("zones 12"));
    EXPECT_TRUE(unit.fault(each.line)) << each.line;
  }
  for (const char* line :
       {"sensor 12 dead", "sensor 1.5 dead", "sensor 1 odd", "heater 1", "heater 1 odd", "eclipse maybe", "zones 0",
        "zones 13", "noise -1", "heaters_w 1,2", "heaters_w 1,x", "heaters_w ,", "capacities_j_k 0", "keeps -8 -12",
        "faster 2000", "moon 1", "heaters_w 1,1,1,1,1,1,1,1,1,1,1,1,1"})
    EXPECT_FALSE(unit.fault(line)) << line;
}

}  // namespace
}  // namespace hirosco::simulation
