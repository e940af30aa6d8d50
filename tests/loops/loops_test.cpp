// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "hirosco/parameter/type.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "simulation/spacecraft/observed_flight.hpp"
#include "supervisor/supervision/data_handling/permission_table.hpp"

/// The catalogue of this folder on virtual time: its loop, the services of its configurations, and going from one to another.
namespace hirosco {
namespace {

using pus::FailureCode;

struct Loops : ::testing::Test {
  simulation::Flight flight{{.mission = std::filesystem::path{HIROSCO_SOURCE_DIR} / "tests/loops/mission.xml",
                             .subsystems = {},
                             .devices = {}}};

  void SetUp() override { ASSERT_TRUE(flight.commission()) << flight.story().text(); }
  simulation::CommandOutcome count() { return flight.craft().command("CATALOGUE", "COUNT", {}); }
  simulation::CommandOutcome configure(std::string_view name) { return flight.configure("CATALOGUE", name); }
  /// `data` of TC[20,subtype]; how it ended.
  simulation::Flight::Verdict values(std::uint8_t subtype, std::initializer_list<std::uint32_t> words) {
    std::array<std::byte, 64> data;
    OctetWriter writer{data};
    writer.put(std::uint8_t{1});
    for (const std::uint32_t word : words) writer.put(word);
    std::array<std::byte, pus::max_telecommand_octets> packet;
    const auto written = pus::write_telecommand(packet,
                                                {.apid = catalogue,
                                                 .sequence_count = ++sent,
                                                 .ack = pus::ack_all,
                                                 .service = 20,
                                                 .subtype = subtype,
                                                 .source = 7},
                                                writer.written());
    return flight.send(written.value());
  }
  /// Asked for ten times they come in the steps of a loop of this period, one after the other.
  void expect_told_each(Duration period) {
    constexpr Duration on_the_way = 12ms;
    std::vector<TimePoint> told;
    flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
      if (report.service() == 20 && report.subtype() == 2) told.push_back(flight.craft().now());
    };
    for (int i = 0; i < 10; ++i) {
      EXPECT_EQ(values(1, {page}).subtype, 7) << flight.story().text();
      flight.craft().run(17ms);
    }
    flight.story().on_telemetry = nullptr;
    ASSERT_EQ(told.size(), 10U);
    for (const TimePoint each : told) {
      const Duration beside = (each - told.front()) % period;
      EXPECT_LT(std::min(beside, period - beside), on_the_way);
    }
    for (std::size_t i = 1; i < told.size(); ++i) {
      EXPECT_GT(told[i] - told[i - 1], period - on_the_way);
      EXPECT_LT(told[i] - told[i - 1], 3 * period);
    }
  }
  static constexpr std::uint16_t catalogue = 24;
  static constexpr std::uint32_t page = ParameterId{catalogue, Type::Uint32, 2}.wire();
  std::uint16_t sent{0};

  std::uint64_t cycles_in(Duration span) {
    const std::uint64_t before = flight.cycles("CATALOGUE");
    flight.craft().run(span);
    return flight.cycles("CATALOGUE") - before;
  }
};

TEST_F(Loops, AServiceAnswersFromItsOwnLoopWhatTheCycleSaw) {
  std::vector<std::uint32_t> counted;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() != 200 || report.subtype() != 3) return;
    OctetReader reader{report.source_data()};
    counted.push_back(reader.get<std::uint32_t>());
  };
  flight.craft().run(1s);
  EXPECT_TRUE(count().completed) << flight.story().text();
  flight.craft().run(1s);
  EXPECT_TRUE(count().completed);
  ASSERT_EQ(counted.size(), 2U);
  EXPECT_GT(counted[0], 200U);
  EXPECT_NEAR(counted[1] - counted[0], 250, 10) << "a second at 4 ms, as its loop had it 20 ms ago at most";
}

/// Set in one loop, at a boundary of the cycle, and in force in the other loop.
TEST_F(Loops, ValuesAreSetInALoopOfTheirOwnForTheArchiveInItsLoop) {
  std::vector<std::uint32_t> counted;
  flight.story().on_telemetry = [&](const pus::TelemetryView& report) {
    if (report.service() != 200 || report.subtype() != 3) return;
    OctetReader reader{report.source_data()};
    counted.push_back(reader.get<std::uint32_t>());
  };
  EXPECT_EQ(values(3, {page, 100}).subtype, 7) << flight.story().text();
  flight.craft().run(1s);
  EXPECT_TRUE(count().completed);
  EXPECT_NE(values(3, {page, 101}).subtype, 7) << "outside of its range";
  ASSERT_EQ(counted.size(), 1U);
  EXPECT_GT(counted[0], 0U);
  EXPECT_EQ(counted[0] % 100, 0U) << "in whole pages";
  EXPECT_FALSE(flight.story().has("CATALOGUE medium")) << flight.story().text();
}

/// At the period that the descriptor gives to their loop, whenever they are asked for.
TEST_F(Loops, ValuesAreToldAtThePeriodOfTheirLoop) { expect_told_each(50ms); }

/// In the configuration that says another one, and again behind it (docs/adr/0207).
TEST_F(Loops, ValuesAreToldAtThePeriodThatTheConfigurationInForceSays) {
  ASSERT_TRUE(configure("LAZY").completed) << flight.story().text();
  expect_told_each(200ms);
  ASSERT_TRUE(configure("CALM").completed);
  expect_told_each(50ms);
  EXPECT_EQ(flight.craft().vital("CATALOGUE")->missed.load(), 0U);
  EXPECT_FALSE(flight.story().has("CATALOGUE medium")) << flight.story().text();
}

TEST_F(Loops, GoesTenTimesFromOneConfigurationToAnotherInOperationalWithoutALateOrMissingCycle) {
  for (int round = 0; round < 5; ++round) {
    EXPECT_TRUE(configure("QUICK").completed) << flight.story().text();
    EXPECT_EQ(cycles_in(1s), 500U);
    EXPECT_TRUE(configure("CALM").completed);
    EXPECT_EQ(cycles_in(1s), 250U);
  }
  const VitalPage& vital = *flight.craft().vital("CATALOGUE");
  EXPECT_EQ(vital.missed.load(), 0U);
  EXPECT_EQ(flight.state("CATALOGUE"), State::Operational);
  EXPECT_FALSE(flight.story().has("CATALOGUE medium")) << flight.story().text();
  EXPECT_FALSE(flight.story().has("CATALOGUE high")) << flight.story().text();
}

/// Where time is virtual nobody is late, so nobody spins; what it would take is reckoned all the same.
TEST_F(Loops, APreciseConfigurationIsReckonedWithItsSpinAndCyclesOnTheSameGrid) {
  EXPECT_TRUE(configure("FINE").completed) << flight.story().text();
  EXPECT_EQ(cycles_in(1s), 500U);
  const auto full = configure("FULL");
  EXPECT_EQ(full.failure, FailureCode::NotPermittedNow) << "1,000 us of work and 990 of spin leave its loop too little";
  EXPECT_EQ(full.failure_subtype, 2);
  EXPECT_EQ(cycles_in(1s), 500U);
}

TEST_F(Loops, AsksForPowerAndForTheTimeOfAllCyclesBefore) {
  const auto greedy = configure("GREEDY");
  EXPECT_EQ(greedy.failure, FailureCode::PowerShort);
  EXPECT_EQ(greedy.failure_subtype, 2);
  const auto takes_long = configure("LONG");
  EXPECT_EQ(takes_long.failure, FailureCode::NotPermittedNow);
  EXPECT_EQ(takes_long.failure_subtype, 2);
  EXPECT_EQ(cycles_in(1s), 250U) << "nothing has happened";
  EXPECT_TRUE(configure("QUICK").completed);
}

TEST_F(Loops, RefusesAServiceThatTheConfigurationInForceLeavesOutAndTellsItBefore) {
  EXPECT_TRUE(count().completed);
  ASSERT_TRUE(configure("ALONE").completed);
  flight.craft().run(100ms);
  const auto refused = count();
  EXPECT_EQ(refused.failure, FailureCode::UnknownService);
  EXPECT_EQ(refused.failure_subtype, 2) << "by who permits, before it is sent";
  ASSERT_TRUE(configure("CALM").completed);
  flight.craft().run(100ms);
  EXPECT_TRUE(count().completed);
}

TEST_F(Loops, StandInTheTableOfPermission) {
  const auto rows = supervisor::permission_table(flight.mission(), *flight.mission().find_mode("operation"));
  const auto count = std::ranges::find(rows, "ARCHIVE COUNT", &supervisor::PermissionRow::request);
  ASSERT_NE(count, rows.end());
  EXPECT_EQ(count->not_in, std::vector<std::string>{"ALONE"});
  EXPECT_EQ(count->permitted, 0b111000) << "in its states";
  EXPECT_EQ(std::ranges::count_if(rows, [](const auto& row) { return !row.not_in.empty() && row.service != 200; }), 0);
}

}  // namespace
}  // namespace hirosco
