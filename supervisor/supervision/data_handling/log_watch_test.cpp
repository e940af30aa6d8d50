// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/log_watch.hpp"

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

constexpr std::string_view hold_text;  // what a held database tells of its trouble

struct LogWatchTest : PartsTest {
  std::size_t times_told(std::string_view line) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(story, [&](const std::string& each) { return each.find(line) != std::string::npos; }));
  }
  void look() { parts.log_watch.watch(clock.now()); }
};

TEST_F(LogWatchTest, ALogThatWorksIsNotSpokenOf) {
  craft.tell("a line");
  look();
  EXPECT_THAT(story, ElementsAre("a line"));
}

TEST_F(LogWatchTest, ThatTheLogFailsIsSaidOnceAndThatItWorksAgain) {
  log.switch_to(std::make_unique<BreakingDatabase>(0, open_database(DatabaseStrategy::Memory, {}).value()));
  craft.tell("a line");
  look();
  look();
  EXPECT_EQ(times_told("log storage fails"), 1U);
  log.switch_to(open_database(DatabaseStrategy::Memory, {}).value());
  craft.tell("a line");
  look();
  look();
  EXPECT_EQ(times_told("log storage works"), 1U);
}

TEST_F(LogWatchTest, ALogThatFailsIsAnEventOnceThoughItsStoreKnowsOfNoTrouble) {
  parts.own.start(craft.mode_epoch);
  own_step();
  log.switch_to(std::make_unique<BreakingDatabase>(0, open_database(DatabaseStrategy::Memory, {}).value()));
  craft.tell("a line");
  for (int i = 0; i < 3; ++i) {
    look();
    own_step();
  }
  EXPECT_EQ(times_told("SUPERVISOR medium LOG_STORE"), 1U);
}

TEST_F(LogWatchTest, ATroubleOfTheStoreIsSaidOnceWithItsCauseAndTheNextOnlyASecondLater) {
  auto hold = std::make_shared<HeldDatabase::Hold>();
  log.switch_to(std::make_unique<HeldDatabase>(hold, open_database(DatabaseStrategy::Memory, {}).value()));
  craft.tell("a line");
  look();
  const auto times = [&] { return std::ranges::count(story, hold_text); };
  hold->troubles = 1;
  look();
  look();
  EXPECT_EQ(times(), 1);
  hold->troubles = 2;
  look();
  EXPECT_EQ(times(), 1);
  wait(1s);
  look();
  EXPECT_EQ(times(), 2);
}

TEST_F(LogWatchTest, WhatHadNoRoomWhileTheLogFailedIsAnEventWhenItWorksAgain) {
  parts.own.start(craft.mode_epoch);
  own_step();
  auto hold = std::make_shared<HeldDatabase::Hold>();
  log.switch_to(std::make_unique<HeldDatabase>(hold, open_database(DatabaseStrategy::Memory, {}).value()));
  hold->tries = 1'000'000;
  hold->troubles = 1;
  craft.tell("a line");
  look();
  const std::uint64_t before = log.counters().refused;
  while (log.counters().refused < before + 3) static_cast<void>(log.append({.kind = LogKind::Action, .packet = {}}));
  hold->tries = 0;
  hold->troubles = 0;
  static_cast<void>(log.append({.kind = LogKind::Action, .packet = {}}));
  const std::uint64_t lost = log.counters().refused;
  for (int i = 0; i < 2; ++i) {
    look();
    own_step();
  }
  EXPECT_EQ(times_told("SUPERVISOR low LOG_RESUMED LOST=" + std::to_string(lost)), 1U);
  EXPECT_EQ(times_told("log storage works: " + std::to_string(lost) + " records had no room meanwhile"), 1U);
}

TEST_F(LogWatchTest, APieceThatIsBegunOrRemovedIsAnEventOnceWithItsCounts) {
  parts.own.start(craft.mode_epoch);
  own_step();
  auto hold = std::make_shared<HeldDatabase::Hold>();
  log.switch_to(std::make_unique<HeldDatabase>(hold, open_database(DatabaseStrategy::Memory, {}).value()));
  look();
  hold->turnover = {
      .begun = 2, .removed_pieces = 1, .removed_octets = 500, .removed_records = 40, .newest_removed = "a.db"};
  for (int i = 0; i < 2; ++i) {
    look();
    own_step();
  }
  EXPECT_EQ(times_told("SUPERVISOR info LOG_ROTATED PIECES=2"), 1U);
  EXPECT_EQ(times_told("SUPERVISOR low LOG_REMOVED PIECES=1 RECORDS=40"), 1U);
  EXPECT_EQ(
      times_told("log: 1 oldest piece removed as keep_MB says, up to a.db, 500 octets, 40 records of this flight"), 1U);
}

TEST_F(LogWatchTest, ATelecommandThatWaitsForTheDiskForASecondIsAFailure) {
  start_all(Operational);
  auto hold = std::make_shared<HeldDatabase::Hold>();
  hold->tries = 1'000'000;
  log.switch_to(std::make_unique<HeldDatabase>(hold, open_database(DatabaseStrategy::Memory, {}).value()));
  const auto move = telecommand(arm, 8, 1, call_data("MOVE_TO"));
  parts.telecommands.take({.packet = move, .origin = Origin::ground()});
  EXPECT_TRUE(parts.telecommands.waiting_since());
  EXPECT_THAT(texts(arm), IsEmpty());
  wait(1s);
  look();
  EXPECT_EQ(times_told("log storage fails"), 0U);
  wait(1ms);
  look();
  EXPECT_EQ(times_told("log storage fails: telecommands that must be durable are held back"), 1U);
}

TEST_F(LogWatchTest, AnotherDatabaseIsTakenByTelecommandAndOneThatCannotBeOpenedIsNot) {
  start_supervisor();
  EXPECT_EQ(call_own("SET_DATABASE", 1), to_text(pus::FailureCode::ExecutionError));
  EXPECT_EQ(log.counters().switches, 0U);
  next_database = open_database(DatabaseStrategy::Memory, {}).value();
  EXPECT_EQ(call_own("SET_DATABASE", 1), "done");
  EXPECT_EQ(log.counters().switches, 1U);
  EXPECT_EQ(times_told("log switched to"), 1U);
}

}  // namespace
}  // namespace hirosco::supervisor
