// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/power_supply/power_supply.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/subsystem/testing/rig.hpp"
#include "subsystems/power_supply/power_rule.hpp"

namespace hirosco {
namespace {

constexpr std::uint8_t nominal = 1, payload = 2;
constexpr std::uint16_t bus_low = 2302, load_shed = 2303, eclipse_begins = 2304, eclipse_ends = 2305;

/// The closed form of the design, angles and all: 200 W committed, 260 W asked for.
TEST(PowerRule, CarriesAnArmUpToTheAnglesOfTheDesignAndNeverInEclipse) {
  constexpr double committed_w = 200, arm_w = 260;
  const auto carries = [&](double angle_deg, double charge, bool eclipse = false) {
    return power_supply::available_w(
               {}, {.array_w = 900, .sun_angle_deg = angle_deg, .eclipse = eclipse, .charge = charge}) >=
           committed_w + arm_w;
  };
  EXPECT_TRUE(carries(69.8, 0.9));
  EXPECT_FALSE(carries(69.9, 0.9));
  EXPECT_TRUE(carries(59.2, 0.4)) << "40 % is low";
  EXPECT_FALSE(carries(59.3, 0.4));
  EXPECT_TRUE(carries(69.8, 0.401));
  for (const double angle_deg : {0.0, 30.0, 69.0}) EXPECT_FALSE(carries(angle_deg, 1, true));
  EXPECT_FALSE(carries(120, 1)) << "the sun is behind it";
  EXPECT_EQ(power_supply::available_w({}, {.array_w = 300, .sun_angle_deg = 0, .charge = 0}), 300)
      << "cells that are lost are seen in what is measured";
}

/// The test plays the unit: array, battery and outlets.
struct PowerSupplyTest : ::testing::Test {
  const std::filesystem::path file{HIROSCO_SOURCE_DIR "/subsystems/power_supply/power_supply.xml"};
  std::unique_ptr<Subsystem> supply = make_power_supply();
  testing::Rig rig{*supply, descriptor::file_system()(file).value()};
  std::unique_ptr<DataFlow> unit =
      std::move(rig.flows.open({Transfer::SharedMemory, "power-unit"}, FlowSide::Device)).value();
  double array_w{900}, angle_deg{0}, charge{0.9}, platform_w{200}, payload_w{0};
  std::uint8_t eclipse{0};
  bool silent{false};
  std::optional<std::uint8_t> payload_on;

  void exchange() {
    std::array<std::byte, max_device_frame_octets> frame{};
    const auto found = unit->receive(frame);
    if (silent || !found || found->flow != Flow::New) return;
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    OctetReader reader{command.payload, std::endian::little};
    payload_on = reader.get<std::uint8_t>();
    constexpr double bus_v = 28;
    std::array<std::byte, max_device_payload_octets> data{};
    OctetWriter writer{data, std::endian::little};
    writer.put(array_w).put(angle_deg).put(charge).put(bus_v).put(platform_w / bus_v).put(payload_w / bus_v);
    writer.put(eclipse);
    static_cast<void>(unit->send(
        write_status(frame, {.epoch = 1, .sequence = command.sequence, .payload = writer.written()}).value()));
  }
  void cycle(int count = 1) {
    for (int i = 0; i < count; ++i) {
      rig.service();
      rig.cycle();
      exchange();
    }
    rig.service();
  }
  void operate(std::uint8_t configuration) {
    rig.bring_to(State::PreOperational, configuration);
    cycle(3);
    for (const State state : {State::SafeOperational, State::Operational}) {
      const auto request = rig.set_state(state);
      cycle(5);
      ASSERT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
    }
  }
  /// Of the newest report of structure 4731.
  double told(std::string_view name) {
    cycle(30);
    const pus::HousekeepingDecoder decoder{rig.descriptor()};
    for (auto report = rig.telemetry.rbegin(); report != rig.telemetry.rend(); ++report) {
      if (report->service != 3) continue;
      const auto values = decoder.decode(report->data).value();
      for (const auto& value : values)
        if (value.name == name) return value.values[0];
    }
    return -1;
  }
};

TEST_F(PowerSupplyTest, TellsWhatThereIsFromPreOperationalOn) {
  rig.bring_to(State::PreOperational, nominal);
  EXPECT_NEAR(told("BUDGET_W"), 1050, 1e-9);
  angle_deg = 60;
  charge = 0.4;
  EXPECT_NEAR(told("BUDGET_W"), 450, 1e-9);
  EXPECT_NEAR(told("LOADS.SUM"), 200, 1e-9);
  eclipse = 1;
  charge = 0.9;
  EXPECT_NEAR(told("BUDGET_W"), 150, 1e-9);
}

TEST_F(PowerSupplyTest, WithoutItsUnitItDoesNotKnow) {
  rig.bring_to(State::PreOperational, nominal);
  EXPECT_NEAR(told("BUDGET_W"), 1050, 1e-9);
  silent = true;
  EXPECT_TRUE(std::isnan(told("BUDGET_W")));
}

TEST_F(PowerSupplyTest, SwitchesThePayloadsOutletByItsConfigurationAlone) {
  operate(nominal);
  EXPECT_EQ(payload_on, 0);
  const auto request = rig.configure(payload);
  cycle(3);
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  EXPECT_EQ(payload_on, 1) << "without a break";
  const auto safe = rig.set_state(State::SafeOperational);
  cycle(3);
  EXPECT_EQ(rig.outcome(safe), "1 3 7");
  EXPECT_EQ(payload_on, 1) << "a stop takes nobody's supply away";
}

TEST_F(PowerSupplyTest, TellsOnceThatLoadsDrawMoreThanThereIsUntilThatIsOver) {
  operate(payload);
  payload_w = 260;
  angle_deg = 69.5;  // 465 W against 460
  cycle(4);
  EXPECT_EQ(rig.heard(bus_low), 0);
  eclipse = 1;
  cycle(4);
  EXPECT_EQ(rig.heard(bus_low), 1);
  EXPECT_EQ(rig.heard(eclipse_begins), 1);
  EXPECT_EQ(rig.heard(load_shed), 0) << "the battery carries it for now";
  eclipse = 0;
  angle_deg = 0;
  cycle(4);
  EXPECT_EQ(rig.heard(eclipse_ends), 1);
  angle_deg = 72;
  cycle(4);
  EXPECT_EQ(rig.heard(bus_low), 2);
}

TEST_F(PowerSupplyTest, ABatteryThatIsNearlyEmptyAndFeedsLoadsIsCritical) {
  operate(nominal);
  charge = 0.19;
  cycle(4);
  EXPECT_EQ(rig.heard(load_shed), 0) << "the array feeds them";
  eclipse = 1;
  cycle(4);
  EXPECT_EQ(rig.heard(load_shed), 1);
}

}  // namespace
}  // namespace hirosco
