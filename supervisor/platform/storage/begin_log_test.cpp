// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/begin_log.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"
#include "supervisor/platform/storage/testing/batches.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/platform/storage/testing/test_folder.hpp"

/// How a log begins, and where another one goes on with it.
namespace hirosco::supervisor {
namespace {

TEST(BeginLog, TheFirstRecordIsAnActionOfTheSupervisorItself) {
  const SystemClock clock;
  auto memory = std::make_shared<MemoryDatabase>();
  ThreadedPacketLog log{clock, std::make_unique<Shared>(memory), {}};
  begin_log(log);
  EXPECT_EQ(why_not_begun(log, clock, long_enough), std::nullopt);
  const auto records = all_of(*memory);
  ASSERT_EQ(records.size(), 1U) << "on the disk when that was said";
  EXPECT_EQ(records[0].number, 1U);
  EXPECT_EQ(records[0].kind, LogKind::Action);
  EXPECT_EQ(records[0].source, pus::supervisor_apid);
  EXPECT_EQ(records[0].peer, pus::supervisor_apid);
  EXPECT_EQ(records[0].note, Note{"log begins"});
}

TEST(BeginLog, ADiskThatDoesNotAnswerIsSaidSo) {
  const SystemClock clock;
  auto stall = std::make_shared<Stall>();
  ThreadedPacketLog log{
      clock, std::make_unique<StalledDatabase>(stall, std::make_shared<MemoryDatabase>()), {.flush_limit = 1ms}};
  begin_log(log);
  stall->reached.wait();
  EXPECT_EQ(why_not_begun(log, clock, 1ms), "the disk of the log does not answer");
  stall->release.count_down();
}

TEST(BeginLog, AFailureOfWhichItsStoreTellsNoTroubleIsNotTakenForABegin) {
  const SystemClock clock;
  ThreadedPacketLog log{clock, std::make_unique<BreakingDatabase>(0, std::make_shared<MemoryDatabase>()), {}};
  begin_log(log);
  EXPECT_TRUE(why_not_begun(log, clock, 1ms));
}

TEST(BeginLog, OneThatSomebodyElseHoldsIsAwaited) {
  const SystemClock clock;
  auto hold = std::make_shared<HeldDatabase::Hold>();
  hold->tries = 3;
  ThreadedPacketLog log{clock, std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()), {}};
  begin_log(log);
  EXPECT_EQ(why_not_begun(log, clock, long_enough), std::nullopt);
  EXPECT_LT(hold->tries, 0) << "it was asked until it was free";
}

struct ResumedLog : ::testing::Test {
  TestFolder folder;
  std::filesystem::path path = folder.path() / "log.db";
  const OnboardTime run{Duration{7}};  // of batch_of()

  void store(int number, const std::vector<LogRecord>& records, DatabaseStrategy strategy = DatabaseStrategy::Sqlite) {
    const auto opened = open_database(strategy, piece_path(path, strategy, number));
    ASSERT_TRUE(opened) << opened.error().text;
    ASSERT_TRUE((*opened)->append(records));
  }
  [[nodiscard]] LogResumption noted(std::uint64_t last, std::uint64_t durable) const {
    return {.run = run, .last = last, .durable = durable};
  }
  /// Of `lost` numbers from there on.
  [[nodiscard]] static std::vector<LogRecord> gap(std::uint64_t number, std::uint32_t lost) {
    auto batch = batch_of(number, number);
    batch[0].kind = LogKind::Gap;
    batch[0].lost = lost;
    return batch;
  }
};

TEST_F(ResumedLog, WithoutALogIsWhatWasNoted) {
  const LogResumption found = resumption_of(path, noted(13, 4));
  EXPECT_EQ(found.run, run);
  EXPECT_EQ(found.last, 13U);
  EXPECT_EQ(found.durable, 4U);
}

TEST_F(ResumedLog, IsDurableAsFarAsTheDiskHasItAndGivesNoNumberAgain) {
  store(1, batch_of(1, 10));
  EXPECT_EQ(resumption_of(path, noted(13, 4)).durable, 10U);
  EXPECT_EQ(resumption_of(path, noted(13, 4)).last, 13U) << "given out, and not on the disk";
  EXPECT_EQ(resumption_of(path, noted(9, 4)).last, 10U) << "more reached the disk than was noted as given out";
}

TEST_F(ResumedLog, BelievesWhatWasNotedWhereTheDiskHasLess) {
  store(1, batch_of(1, 10));
  EXPECT_EQ(resumption_of(path, noted(20, 15)).durable, 15U) << "its file may have been taken away";
}

TEST_F(ResumedLog, ReachesToTheEndOfAGap) {
  store(1, batch_of(1, 10));
  store(1, gap(11, 5));
  EXPECT_EQ(resumption_of(path, noted(20, 4)).durable, 15U);
}

TEST_F(ResumedLog, IsOfNoOtherRun) {
  auto others = batch_of(1, 50);
  for (LogRecord& record : others) record.run = OnboardTime{Duration{8}};
  store(1, batch_of(1, 3));
  store(1, others);
  EXPECT_EQ(resumption_of(path, noted(5, 2)).durable, 3U);
}

TEST_F(ResumedLog, LooksAtTheTwoNewestPiecesWhateverTheirStrategy) {
  store(1, batch_of(1, 10));
  store(2, batch_of(11, 20), DatabaseStrategy::Ascii);
  EXPECT_EQ(resumption_of(path, noted(30, 4)).durable, 20U);
  store(3, {});
  EXPECT_EQ(resumption_of(path, noted(30, 4)).durable, 20U) << "nothing has reached the newest yet";
  store(4, {});
  EXPECT_EQ(resumption_of(path, noted(30, 4)).durable, 4U) << "what is older would have been noted long ago";
}

TEST_F(ResumedLog, LooksAtTheEndOfATextOnly) {
  constexpr std::uint64_t many = 20'000;
  store(1, batch_of(1, many), DatabaseStrategy::Ascii);
  const auto piece = piece_path(path, DatabaseStrategy::Ascii, 1);
  const auto octets = std::filesystem::file_size(piece);
  ASSERT_GT(octets, std::uint64_t{2} << 20) << "more than is looked at";
  EXPECT_EQ(resumption_of(path, noted(30, 4)).durable, many);
  const auto tail = [&](std::uint64_t of_it) {
    const auto opened = open_database(DatabaseStrategy::Ascii, piece, DatabaseAccess::Read);
    return (*opened)->read({.last = 2 * many, .tail_octets = of_it})->records;
  };
  EXPECT_EQ(tail(0).size(), many);
  EXPECT_EQ(tail(2 * octets).size(), many);
  const auto newest = tail(octets / 2);
  EXPECT_NEAR(static_cast<double>(newest.size()), many / 2.0, many / 10.0);
  EXPECT_EQ(newest.back().number, many);
}

/// A server: reached or not.
struct AskedDatabase final : Database {
  explicit AskedDatabase(ErrorCode code) : code_{code} {}

 private:
  Result<> do_append(std::span<const LogRecord>) override { return ok(); }
  Result<LogPage> do_read(const LogQuery&) override { return fail(code_, "asked"); }
  [[nodiscard]] std::string_view do_strategy() const noexcept override { return "asked"; }
  ErrorCode code_;
};

TEST_F(ResumedLog, IsToldByItsDatabaseAsSoonAsThatCanBeReached) {
  MemoryDatabase memory;
  ASSERT_TRUE(memory.append(batch_of(1, 10)));
  EXPECT_EQ(resumption_in(memory, noted(13, 4))->durable, 10U);
  EXPECT_EQ(resumption_in(memory, noted(13, 4))->last, 13U);
  AskedDatabase away{ErrorCode::Unavailable};
  EXPECT_FALSE(resumption_in(away, noted(13, 4)));
  AskedDatabase nothing_there{ErrorCode::NotFound};
  EXPECT_EQ(resumption_in(nothing_there, noted(13, 4))->durable, 4U) << "that is an answer";
}

TEST_F(ResumedLog, PassesOverAPieceThatCannotBeRead) {
  store(1, batch_of(1, 10));
  std::ofstream{piece_path(path, DatabaseStrategy::Sqlite, 2)} << std::string(5000, 'x');
  EXPECT_EQ(resumption_of(path, noted(30, 4)).durable, 10U);
}

}  // namespace
}  // namespace hirosco::supervisor
