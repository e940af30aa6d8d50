// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/archive/archive.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>

/// The archive file itself: its limit, damage, a full disk, other files.
namespace hirosco::ground {
namespace {

constexpr OnboardTime first_time{std::chrono::seconds{2'145'916'900}};

class AnArchive : public ::testing::Test {
 protected:
  AnArchive() { std::remove(file.c_str()); }
  ~AnArchive() override { std::remove(file.c_str()); }
  const std::string file = ::testing::TempDir() + "archive-test.db";
};

TEST_F(AnArchive, AFloodOfEventsDoesNotGrowItBeyondItsLimit) {
  constexpr std::int64_t limit = 1 << 20;
  auto archive = Archive::open(file, limit);
  ASSERT_TRUE(archive);
  const std::string text(200, 'x');
  const std::vector<std::byte> octets(100);
  for (int second = 0; second < 200; ++second) {
    for (int i = 0; i < 100; ++i) {
      const OnboardTime t = first_time + second * 1s + i * 1ms;
      (*archive)->add(StoredPacket{.t = t, .apid = 11, .service = 5, .subtype = 1, .octets = {}}, octets);
      (*archive)->add(StoredEvent{.t = t, .subsystem = "A", .name = "B", .text = text, .values = "{}"});
    }
    (*archive)->keep_within_limit();
  }
  EXPECT_LT(std::filesystem::file_size(file), 2 * limit);
  const auto newest = (*archive)->events({.span = {}, .text = {}, .limit = 1});
  ASSERT_EQ(newest.size(), 1U);
  EXPECT_EQ(newest[0].t, first_time + 199s + 99ms);
  const auto extent = (*archive)->extent();
  ASSERT_TRUE(extent);
  EXPECT_GT(extent->from, first_time + 1s);
  EXPECT_EQ(extent->to, first_time + 199s + 99ms);
  EXPECT_EQ((*archive)->failures(), 0U);
}

TEST_F(AnArchive, ThatIsDamagedSaysSoAndAnswersWithWhatItHas) {
  const std::vector<std::byte> octets(500);
  {
    auto archive = Archive::open(file);
    ASSERT_TRUE(archive);
    for (int i = 0; i < 1000; ++i)
      (*archive)->add(StoredPacket{.t = first_time + i * 1s, .apid = 10, .sid = 1, .octets = {}}, octets);
  }
  std::fstream disk{file, std::ios::in | std::ios::out | std::ios::binary};
  const std::string junk(300'000, '\xA5');
  disk.seekp(100'000);
  disk << junk;
  disk.close();
  auto archive = Archive::open(file);
  ASSERT_TRUE(archive);
  std::size_t read = 0;
  (*archive)->packets({}, [&](const StoredPacket&) { return ++read > 0; });
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

TEST_F(AnArchive, CountsWhatAFullDiskRefusesAndGoesOnWhenThereIsRoomAgain) {
  auto archive = Archive::open(file);
  ASSERT_TRUE(archive);
  const auto tell = [&](OnboardTime t) {
    (*archive)->add(StoredEvent{.t = t, .subsystem = "A", .name = "B", .text = "C", .values = "{}"});
    (*archive)->commit();
  };
  {
    const FullDisk full{200'000};
    for (int i = 0; i < 1000; ++i) tell(first_time + i * 1s);
    EXPECT_GT((*archive)->failures(), 0U);
  }
  tell(first_time + 1h);
  archive->reset();
  archive = Archive::open(file);
  ASSERT_TRUE(archive);
  const auto kept = (*archive)->events({.span = {}, .text = {}});
  ASSERT_FALSE(kept.empty());
  EXPECT_EQ(kept.front().t, first_time + 1h);
  EXPECT_EQ((*archive)->failures(), 0U);
}

TEST_F(AnArchive, OfAnotherVersionOrOfSomethingElseIsLeftAsItIs) {
  const auto set = [&](const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
  };
  const auto refused = [&] {
    const auto archive = Archive::open(file);
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

}  // namespace
}  // namespace hirosco::ground
