// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/author/subsystem.hpp"
#include "tests/integration/flight.hpp"

/// A heater whose limit is a parameter of the power bus (docs/adr/0103): in force in its cycle, told in its own housekeeping, and
/// what its descriptor says while the bus is not heard.
namespace hirosco::testing {
namespace {

constexpr auto heated_mission_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Mission name="HEATED">
  <Supervisor descriptor="../../supervisor/supervisor.xml">
    <Database strategy="sqlite" path="log/heated.db"/>
    <Ground subsystem="COMMUNICATION" telemetry="127.0.0.1:10015" telecommand="127.0.0.1:10025"/>
  </Supervisor>
  <Subsystem executable="hirosco-communication" descriptor="../../subsystems/communication/communication.xml"/>
  <Subsystem executable="bus" descriptor="bus.xml"/>
  <Subsystem executable="heater" descriptor="heater.xml"><Subscribes subsystem="POWER" to="BUS"/></Subsystem>
  <Modes initial="open" start="open">
    <Mode name="open">
      <Commission subsystem="COMMUNICATION" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="BUS" configuration="NOMINAL" state="Operational"/>
      <Commission subsystem="HEATER" configuration="NOMINAL" state="Operational"/>
      <Permit subsystem="*" functions="*"/>
      <Permit subsystem="*" services="3 5 17 20" parameters="BUDGET"/>
    </Mode>
  </Modes>
  <Recovery><Plan name="note"><When severity="low info"/><Do action="log"/></Plan></Recovery>
</Mission>
)";

constexpr auto bus_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="BUS" id="20">
  <ParamRef name="COUNT" id="0" type="UINT32"/>
  <StructRef name="BUDGET" id="0" writable="Operational">
    <StructRef name="HEATING" id="1">
      <ParamRef name="POWER" id="0" type="DOUBLE" unit="W" minimum="0" maximum="500" init="120"/>
    </StructRef>
  </StructRef>
  <Configuration name="NOMINAL" id="1" sampling_us="10000">
    <HKService id="4801" interval="10"><SampledOnce><ParamRef name="COUNT"/><ParamRef name="BUDGET"/></SampledOnce></HKService>
  </Configuration>
</Subsystem>
)";

constexpr auto heater_text = R"(<?xml version="1.0" encoding="UTF-8"?>
<Subsystem name="HEATER" id="21">
  <Subscribes subsystem="POWER" housekeeping="4801"/>
  <ParamRef name="MOST" id="1" type="DOUBLE" unit="W" minimum="0" maximum="200" init="5" from="POWER.BUDGET.HEATING.POWER" age_ms="250"/>
  <Configuration name="NOMINAL" id="1" sampling_us="10000">
    <HKService id="4901" interval="10"><SampledOnce><ParamRef name="MOST"/></SampledOnce></HKService>
  </Configuration>
</Subsystem>
)";

struct HeatingBudget {
  double heating_w;
};

class PowerBus final : public Subsystem {
  Result<Step> software_init() override {
    publish("COUNT", count_);
    publish("BUDGET", budget_);
    return done;
  }
  Parameter<std::uint32_t> count_;
  Parameter<HeatingBudget> budget_;
};

class Heater final : public Subsystem {
 public:
  explicit Heater(double& most_w) : most_w_{most_w} {}

 private:
  Result<Step> software_init() override {
    publish("MOST", most_);
    return done;
  }
  Result<> operational(const Cycle&) noexcept override {
    most_w_ = most_.load();
    return ok();
  }
  double& most_w_;  ///< as its cycle has it
  Parameter<double> most_;
};

struct Heated : ::testing::Test {
  Heated() {
    flight.story().on_telemetry = [this](const pus::TelemetryView& report) {
      OctetReader reader{report.source_data()};
      const auto id = reader.get<std::uint16_t>();
      if (report.apid() == 21 && report.service() == 3 && id == 4901) told_w = reader.get<double>();
      if (report.apid() == 21 && report.service() == 5 && id == 0xF00A) ++unknown_events;
    };
  }
  void commission() { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  bool budget(double watts) {
    const bool done = flight.craft().command("BUS", "SET:BUDGET.HEATING", {watts}, 1s).completed;
    flight.craft().run(300ms);
    return done;
  }

  double most_w{-1};
  double told_w{-1};
  int unknown_events{0};
  Flight flight{{.mission = "hello",  // its folder: the texts stand in for the files there
                 .subsystems = {{"bus", [] { return std::make_unique<PowerBus>(); }},
                                {"heater", [this] { return std::make_unique<Heater>(most_w); }}},
                 .files = {{"mission.xml", heated_mission_text}, {"bus.xml", bus_text}, {"heater.xml", heater_text}},
                 .revives_after = std::chrono::milliseconds{300}}};
};

TEST_F(Heated, ALimitIsThatOfTheOtherInTheCycleAndInItsOwnHousekeeping) {
  commission();
  flight.craft().run(300ms);
  EXPECT_EQ(most_w, 120);
  EXPECT_EQ(told_w, 120);
  ASSERT_TRUE(budget(80));
  EXPECT_EQ(most_w, 80);
  EXPECT_EQ(told_w, 80);
  EXPECT_EQ(unknown_events, 0);
}

TEST_F(Heated, WhileTheOtherIsNotHeardItIsWhatTheDescriptorSaysAndThatIsTold) {
  commission();
  ASSERT_TRUE(budget(80));
  flight.craft().kill("BUS");
  flight.craft().run(200ms);
  EXPECT_EQ(most_w, 80) << "it is not as old as that yet";
  flight.craft().run(1s);
  EXPECT_EQ(most_w, 5);
  EXPECT_EQ(unknown_events, 1) << "once";
}

/// Whoever hears has been told so once, and asks no more (docs/adr/0168).
TEST_F(Heated, AfterEachDeathOfASupervisorTheOtherIsHeardOn) {
  commission();
  for (const double watts : {80.0, 60.0, 40.0}) {
    flight.craft().kill_supervisor();
    flight.craft().run(3s);
    ASSERT_TRUE(budget(watts)) << flight.story().text();
    EXPECT_EQ(most_w, watts) << flight.story().text();
  }
}

TEST_F(Heated, WhatIsOutsideItsOwnRangeIsNotTaken) {
  commission();
  ASSERT_TRUE(budget(80));
  ASSERT_TRUE(budget(400)) << "the bus may, the heater knows no more than 200 W";
  flight.craft().run(300ms);
  EXPECT_EQ(most_w, 5);
  EXPECT_EQ(unknown_events, 1);
  ASSERT_TRUE(budget(90));
  EXPECT_EQ(most_w, 90) << "heard again";
}

TEST_F(Heated, NoTelecommandSetsIt) {
  commission();
  std::array<std::byte, 13> data;
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{21, Type::Double, 1}.wire()).put(7.0);
  std::array<std::byte, 64> buffer;
  const auto packet =
      pus::write_telecommand(buffer, {.apid = 21, .ack = pus::ack_all, .service = 20, .subtype = 3, .source = 7}, data);
  ASSERT_TRUE(packet);
  EXPECT_NE(flight.send(*packet).subtype, 7);
}

}  // namespace
}  // namespace hirosco::testing
