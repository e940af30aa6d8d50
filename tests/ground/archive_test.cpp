// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <fstream>

#include "tests/ground/station.hpp"

/// The archive file itself: its limit, damage, a full disk, a lock, a restart.
namespace hirosco::testing {
namespace {

using simulation::Flight;

class GroundArchive : public ::testing::Test {
 protected:
  GroundArchive() { std::remove(file.c_str()); }
  ~GroundArchive() override { std::remove(file.c_str()); }
  const std::string file = ::testing::TempDir() + "ground-archive.db";
};

TEST_F(GroundArchive, AFloodOfEventsDoesNotGrowItBeyondItsLimit) {
  constexpr std::int64_t limit = 1 << 20;
  auto archive = ground::Archive::open(file, limit);
  ASSERT_TRUE(archive);
  const std::string text(200, 'x');
  const std::vector<std::byte> octets(100);
  for (int second = 0; second < 200; ++second) {
    for (int i = 0; i < 100; ++i) {
      const OnboardTime t = noon + second * 1s + i * 1ms;
      (*archive)->add(ground::StoredPacket{.t = t, .apid = 11, .service = 5, .subtype = 1, .octets = {}}, octets);
      (*archive)->add(ground::StoredEvent{.t = t, .subsystem = "A", .name = "B", .text = text, .values = "{}"});
    }
    (*archive)->keep_within_limit();
  }
  EXPECT_LT(std::filesystem::file_size(file), 2 * limit);
  const auto newest = (*archive)->events({.span = {}, .text = {}, .limit = 1});
  ASSERT_EQ(newest.size(), 1U);
  EXPECT_EQ(newest[0].t, noon + 199s + 99ms);
  const auto extent = (*archive)->extent();
  ASSERT_TRUE(extent);
  EXPECT_GT(extent->from, noon + 1s);
  EXPECT_EQ(extent->to, noon + 199s + 99ms);
  EXPECT_EQ((*archive)->failures(), 0U);
}

TEST_F(GroundArchive, ThatIsDamagedSaysSoAndAnswersWithWhatItHas) {
  const std::vector<std::byte> octets(500);
  {
    auto archive = ground::Archive::open(file);
    ASSERT_TRUE(archive);
    for (int i = 0; i < 1000; ++i)
      (*archive)->add(ground::StoredPacket{.t = noon + i * 1s, .apid = 10, .sid = 1, .octets = {}}, octets);
  }
  std::fstream disk{file, std::ios::in | std::ios::out | std::ios::binary};
  const std::string junk(300'000, '\xA5');
  disk.seekp(100'000);
  disk << junk;
  disk.close();
  auto archive = ground::Archive::open(file);
  ASSERT_TRUE(archive);
  std::size_t read = 0;
  (*archive)->packets({}, [&](const ground::StoredPacket&) { return ++read > 0; });
  EXPECT_LT(read, 1000U);
  EXPECT_GT((*archive)->failures(), 0U);
}

/// Files grow no further than this while it lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t octets) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit full{octets, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST_F(GroundArchive, CountsWhatAFullDiskRefusesAndGoesOnWhenThereIsRoomAgain) {
  auto archive = ground::Archive::open(file);
  ASSERT_TRUE(archive);
  const auto tell = [&](OnboardTime t) {
    (*archive)->add(ground::StoredEvent{.t = t, .subsystem = "A", .name = "B", .text = "C", .values = "{}"});
    (*archive)->commit();
  };
  {
    const FullDisk full{200'000};
    for (int i = 0; i < 1000; ++i) tell(noon + i * 1s);
    EXPECT_GT((*archive)->failures(), 0U);
  }
  tell(noon + 1h);
  archive->reset();
  archive = ground::Archive::open(file);
  ASSERT_TRUE(archive);
  const auto kept = (*archive)->events({.span = {}, .text = {}});
  ASSERT_FALSE(kept.empty());
  EXPECT_EQ(kept.front().t, noon + 1h);
  EXPECT_EQ((*archive)->failures(), 0U);
}

TEST_F(GroundArchive, ThatSomebodyLocksKeepsNoPageFromHearingOfATelecommand) {
  Flight flight{rokviss()};
  Station station{flight, file};
  ASSERT_TRUE(station.run_until([&] { return flight.craft().supervisor().commissioned(); }));
  Page page;
  station.session().opened(page, true);
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

TEST_F(GroundArchive, OfAnotherVersionOrOfSomethingElseIsLeftAsItIs) {
  const auto set = [&](const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
  };
  const auto refused = [&] {
    const auto archive = ground::Archive::open(file);
    return archive ? std::string{} : std::string{archive.error().text};
  };
  EXPECT_EQ(refused(), "");
  EXPECT_EQ(refused(), "");
  set("PRAGMA user_version = 2");
  EXPECT_EQ(refused(), "the archive was written by another version of hirosco");
  set("PRAGMA user_version = 1; PRAGMA application_id = 1213354819");  // a log of ours
  EXPECT_EQ(refused(), "this is a database of something else, not an archive");
  // One from before marks were written is taken, and marked.
  set("PRAGMA user_version = 0; PRAGMA application_id = 0");
  EXPECT_EQ(refused(), "");
  set("PRAGMA user_version = 2");
  EXPECT_NE(refused(), "");
}

TEST_F(GroundArchive, ARestartedGatewayStillKnowsAndShowsItsAbsenceAsAGap) {
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
  station.run(500ms);
  EXPECT_GE(station.get("/api/events?limit=1000")["events"].size(), events);
  EXPECT_EQ(station.get("/api/commands")["commands"][0]["stage"], "completed");
  const json history = station.get("/api/history?parameter=MANIPULATOR.TIP_FORCE[0]&last=60");
  ASSERT_EQ(history["gaps"].size(), 1U);
  EXPECT_GE(history["t"].size(), 10U);
}

}  // namespace
}  // namespace hirosco::testing
