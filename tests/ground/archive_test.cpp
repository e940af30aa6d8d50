// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdio>

#include "tests/ground/station.hpp"

/// The archive beside a flight: a lock, a restart.
namespace hirosco::testing {
namespace {

using simulation::Flight;

class GroundArchive : public ::testing::Test {
 protected:
  GroundArchive() { std::remove(file.c_str()); }
  ~GroundArchive() override { std::remove(file.c_str()); }
  const std::string file = ::testing::TempDir() + "ground-archive.db";
};

TEST_F(GroundArchive, ThatSomebodyLocksKeepsNoPageFromHearingOfATelecommand) {
  Flight flight{rokviss()};
  Station station{flight, file};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  Page page;
  station.session().pages().opened(page, true);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  station.post("/api/commands", {{"subsystem", "JOYSTICK"}, {"function", "PING"}});
  station.run(1s);
  std::string stages;
  for (const json& message : page.of_type("command")) stages += message["stage"].get<std::string>() + " ";
  EXPECT_EQ(stages, "sent accepted started completed ");
  EXPECT_GT(station.get("/api/status")["link"]["archive_failures"], 0);
  sqlite3_close(other);
  EXPECT_EQ(station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}})["stage"], "completed");
}

TEST_F(GroundArchive, ARestartedGatewayStillKnowsAndFetchesWhatWasSaidInItsAbsence) {
  Flight flight{rokviss()};
  std::size_t events = 0;
  {
    Station station{flight, file};
    ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
    events = station.get("/api/events?limit=1000")["events"].size();
    EXPECT_EQ(station.command("JOYSTICK", "SET_FORCE_SCALE", {{"SCALE", 0.05}})["stage"], "completed");
  }
  flight.craft().run(2s);
  Station station{flight, file};
  Page page;
  station.session().pages().opened(page, true);
  ASSERT_TRUE(station.run_until([&] { return !page.of_type("filled").empty(); }));
  EXPECT_GE(station.get("/api/events?limit=1000")["events"].size(), events);
  EXPECT_EQ(station.get("/api/commands")["commands"][0]["stage"], "completed");
  const json history = station.get("/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&last=60");
  EXPECT_EQ(history["gaps"].size(), 0U);
  EXPECT_GE(history["t"].size(), 10U);
  double before = history["t"][0], longest = 0;
  for (const json& t : history["t"]) longest = std::max(longest, t.get<double>() - std::exchange(before, t));
  EXPECT_LT(longest, 0.6) << "as often as ever";
}

TEST_F(GroundArchive, AGatewayThatEndsWhileItFetchesIsFollowedByOneThatFetchesTheRest) {
  Flight flight{rokviss()};
  ASSERT_TRUE(flight.craft().run_until([&] { return flight.craft().supervisor().commissioned(); }, 60s));
  flight.craft().run(2s);
  const auto gaps = [](Station& station) { return station.get("/api/timeline?from=0&to=4000000000")["gaps"].size(); };
  {
    Station station{flight, file};
    Page page;
    station.session().pages().opened(page, true);
    ASSERT_TRUE(station.run_until([&] { return !page.of_type("gap").empty(); }));
    EXPECT_GE(gaps(station), 1U) << "it has not asked yet";
    station.session().pages().closed(page);
  }
  Station station{flight, file};
  EXPECT_TRUE(station.run_until([&] { return gaps(station) == 0; }))
      << station.get("/api/timeline?from=0&to=4000000000")["gaps"];
}

}  // namespace
}  // namespace hirosco::testing
