// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include "supervisor/platform/storage/log_store.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"
#include "supervisor/supervision/testing/retrieval_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::SizeIs;
namespace st129 = pus::st129;

/// The log says nothing of what it does not have any more: pieces beyond its bounds, rows that the owner of a server took out.
struct ShortenedLogTest : RetrievalTest {
  std::function<bool(const LogRecord&)> stays{[](const LogRecord&) { return true; }};
  DirectLogReadings readings{[this](LogQuery query) {
    const std::size_t last = std::exchange(query.last, 100'000);
    auto page = store->read(query);
    auto& records = page->records;
    std::erase_if(records, [this](const LogRecord& record) { return !stays(record); });
    const auto end = records.begin() + static_cast<std::ptrdiff_t>(std::min(last, records.size()));
    if (query.end == LogEnd::Oldest) records.erase(end, records.end());
    else records.erase(records.begin(), records.end() - (end - records.begin()));
    return page;
  }};
  Retrieval retrieval{{craft, parts.own, parts.telemetry, &readings}};

  std::uint32_t missing(OnboardTime from, OnboardTime to, bool housekeeping) {
    retrieval.begin({.id = 1, .source = ground, .ack = 0}, st129::write_retrieve({from, to, housekeeping}));
    constexpr int periods = 20;
    for (int i = 0; i < periods; ++i) {
      wait(10ms);
      retrieval.watch(clock.now());
      own_step();
      if (const Down down = listen(); !down.ends.empty()) return down.ends[0].missing;
    }
    ADD_FAILURE() << "it did not end";
    return 0;
  }
};

TEST_F(ShortenedLogTest, WhatIsGoneFromItsBeginningIsMissingToWhoAsksForTimesBefore) {
  wait(1s);
  const OnboardTime from = clock.onboard();
  say_unheard(10);
  EXPECT_EQ(missing(from, always_after, true), 0U);
  const std::uint64_t last = logged().back().number, first = last - 4;
  stays = [first](const LogRecord& record) { return record.number >= first; };
  const OnboardTime oldest = logged()[first - 1].stored;
  EXPECT_EQ(missing(from, always_after, false), first - 1) << "nobody knows any more which of them were stored before";
  EXPECT_EQ(missing(from, oldest - 1us, true), first - 1) << "of these times not one is there";
  EXPECT_EQ(missing(oldest, always_after, true), first - 1) << "the one before may have been stored at the same time";
  EXPECT_EQ(missing(oldest + 1us, always_after, true), 0U);
  EXPECT_EQ(missing(never_before, log.run() - 1us, true), 0U) << "there was no flight";
}

TEST_F(ShortenedLogTest, WhatIsGoneAltogetherIsMissing) {
  say_unheard(3);
  stays = [](const LogRecord&) { return false; };
  EXPECT_GE(missing(never_before, always_after, true), 3U);
}

TEST_F(ShortenedLogTest, WhatIsGoneFromItsMiddleIsMissingWhereAllIsAskedFor) {
  wait(1s);
  const OnboardTime from = clock.onboard();
  say_unheard(10);
  const std::uint64_t last = logged().back().number;
  stays = [last](const LogRecord& record) { return record.number <= last - 6 || record.number > last - 3; };
  EXPECT_EQ(missing(from, always_after, true), 3U);
}

TEST_F(ShortenedLogTest, WhatAGapTellsOfIsNotCountedTwice) {
  wait(1s);
  const OnboardTime from = clock.onboard();
  say_unheard(10);
  const std::vector<LogRecord> all = logged();
  const std::uint64_t last = all.back().number;
  auto rest = std::make_unique<MemoryDatabase>();
  for (LogRecord record : all) {
    if (record.number > last - 6 && record.number <= last - 3) continue;
    if (record.number == last - 6) {
      record.kind = LogKind::Gap;
      record.packet.clear();
      record.lost = 4;
    }
    ASSERT_TRUE(rest->append(std::span{&record, 1}));
  }
  readings = DirectLogReadings{[&rest](const LogQuery& query) { return rest->read(query); }};
  const OnboardTime to = all.back().stored;
  EXPECT_EQ(missing(from, to, true), 4U);
  EXPECT_EQ(missing(from, to, false), 4U);
}

/// A log in files that keeps 600 KiB.
struct BoundedLogTest : RetrievalTest, ::testing::WithParamInterface<DatabaseStrategy> {
  TestFolder folder;
  std::filesystem::path path{folder.path() / "log.db"};
  DirectLogReadings readings{reader_of(path, {})};
  Retrieval retrieval{{craft, parts.own, parts.telemetry, &readings}};

  st129::RetrievalEnd end_of(const st129::Retrieve& wanted) {
    retrieval.begin({.id = 1, .source = ground, .ack = 0}, st129::write_retrieve(wanted));
    for (;;) {
      wait(10ms);
      retrieval.watch(clock.now());
      own_step();
      if (const Down down = listen(); !down.ends.empty()) return down.ends[0];
    }
  }
  void say_long(int times) {
    set(camera, Offline);
    for (int i = 0; i < times; ++i) report(arm, 17, 2, std::vector<std::byte>(4000));
    set(camera, Operational);
  }
};

TEST_P(BoundedLogTest, WhatWentBeyondItsBoundsIsMissingInTheEndOfARetrieval) {
  constexpr std::uint64_t kilo = 1024;
  const LogLimits bounds{.rotate_octets = 200 * kilo, .keep_octets = 600 * kilo};
  auto files = std::make_unique<LogStore>(GetParam(), path, bounds);
  const LogStore& disk = *files;
  log.switch_to(std::move(files));
  say_long(1);  // stands before the times asked for
  wait(1s);
  const OnboardTime from = clock.onboard();
  say_long(20);
  EXPECT_TRUE(end_of({from, always_after, true}).whole());
  while (disk.turnover().removed_pieces == 0) say_long(10);
  EXPECT_FALSE(end_of({from, always_after, true}).whole());
  EXPECT_FALSE(end_of({from, from + 1ms, false}).whole()) << "not one of it is there";
  wait(1s);
  const OnboardTime late = clock.onboard();
  say_long(3);
  EXPECT_TRUE(end_of({late, always_after, true}).whole());
}

INSTANTIATE_TEST_SUITE_P(Strategies, BoundedLogTest,
                         ::testing::Values(DatabaseStrategy::Sqlite, DatabaseStrategy::Ascii),
                         [](const auto& strategy) { return std::string{to_text(strategy.param)}; });

}  // namespace
}  // namespace hirosco::supervisor
