// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

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
