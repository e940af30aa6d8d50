// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/retrieval.hpp"

#include "supervisor/supervision/testing/retrieval_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace st129 = pus::st129;

TEST_F(RetrievalTest, WhatNobodyHeardComesDownAsItWasSentInOrderAndUnderItsNumbers) {
  say_unheard(30);
  ask({never_before, always_after, true});
  EXPECT_THAT(listen().verdicts, ElementsAre("1.7 of 0")) << "it is begun";
  std::vector<std::vector<std::byte>> sent;
  std::vector<std::uint64_t> numbers;
  for (const LogRecord& record : logged())
    if (record.kind == LogKind::Telemetry && record.source == arm) {
      sent.push_back(record.packet);
      numbers.push_back(record.number);
    }
  ASSERT_THAT(sent, SizeIs(30));
  const Down down = go_on();
  std::vector<std::vector<std::byte>> of_arm;
  std::vector<std::uint64_t> their_numbers;
  for (std::size_t i = 0; i < down.packets.size(); ++i) {
    if (pus::TelemetryView::parse(down.packets[i])->apid() != arm) continue;
    of_arm.push_back(down.packets[i]);
    their_numbers.push_back(down.numbers[i]);
  }
  EXPECT_EQ(of_arm, sent);
  EXPECT_EQ(their_numbers, numbers);
  ASSERT_THAT(down.ends, SizeIs(1));
  EXPECT_TRUE(down.ends[0].whole()) << down.ends[0].why;
  EXPECT_EQ(down.ends[0].reports, down.packets.size());
}

TEST_F(RetrievalTest, WhatComesDownAgainIsNotLoggedAgainAndNobodyOnBoardHearsIt) {
  say_unheard(5);
  routed_services.clear();
  ask({never_before, always_after, true});
  EXPECT_GE(go_on().packets.size(), 5U);
  for (const LogRecord& record : logged()) {
    const auto label = label_of(record.packet);
    EXPECT_FALSE(!label.telecommand && label.service == 129 && label.subtype == st129::retrieved);
  }
  EXPECT_EQ(std::ranges::count(routed_services, 129), 1) << "its end";
}

TEST_F(RetrievalTest, OnlyWhatWasStoredInTheTimesAskedForComes) {
  say_unheard(3);
  const OnboardTime from = clock.onboard() + 1ms;
  wait(5ms);
  say_unheard(4);
  const OnboardTime to = clock.onboard();
  wait(5ms);
  say_unheard(2);
  ask({from, to, true});
  const Down down = go_on();
  EXPECT_THAT(down.packets, SizeIs(4));
  EXPECT_EQ(down.ends.at(0).reports, 4U);
}

TEST_F(RetrievalTest, HousekeepingComesIfItIsAskedFor) {
  const OnboardTime from = clock.onboard() + 500us;
  say_unheard(3, 3, 25);
  say_unheard(2);
  const OnboardTime to = clock.onboard();
  wait(1ms);
  ask({from, to, false});
  EXPECT_THAT(go_on().packets, SizeIs(2));
  ask({from, to, true});
  EXPECT_THAT(go_on().packets, SizeIs(5));
}

TEST_F(RetrievalTest, MoreThanAPageComesInPiecesAndNotMoreThanEightAtOnce) {
  constexpr int many = 3 * static_cast<int>(Retrieval::page_records);
  const OnboardTime from = clock.onboard();
  say_unheard(many);
  ask({from, clock.onboard(), true});
  const Down down = go_on(many);
  EXPECT_EQ(down.packets.size(), static_cast<std::size_t>(many));
  EXPECT_TRUE(std::ranges::is_sorted(down.numbers));
  EXPECT_EQ(std::ranges::adjacent_find(down.numbers), down.numbers.end()) << "each once";
  EXPECT_EQ(down.most_at_once, Retrieval::most_at_once);
  EXPECT_THAT(down.ends, SizeIs(1));
}

TEST_F(RetrievalTest, WhatIsSaidNowGoesFirstAndIsNotWaitedForStepByStep) {
  constexpr std::size_t unheard = 20, steps = 10;
  say_unheard(unheard);
  ask({never_before, always_after, true});
  static_cast<void>(listen());
  parts.retrieval.watch(clock.now());  // a page is read
  own_step();
  std::vector<std::uint64_t> numbers = listen().numbers;
  ASSERT_LT(numbers.size(), unheard);
  for (std::size_t i = 0; i < steps; ++i) {
    report(arm, 17, 2, {});  // what is said now, in each step
    ASSERT_TRUE(parts.telemetry.ground().waiting());
    parts.retrieval.watch(clock.now());
    own_step();
    parts.telemetry.serve_ground();
    bool live = false;
    MessageBuffer buffer;
    for (;;) {
      const auto next = played[camera].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) break;
      const auto heard = pus::TelemetryView::parse(next->message.packet);
      live |= heard && heard->apid() == arm;
      if (!heard || !st129::is_retrieved(*heard)) continue;
      EXPECT_TRUE(live) << "what is said now is ahead";
      numbers.push_back(st129::read_retrieved(heard->source_data())->number);
    }
    EXPECT_TRUE(live);
  }
  EXPECT_GE(numbers.size(), unheard);
}

TEST_F(RetrievalTest, ALinkThatDoesNotTakeAllIsNotFilled) {
  say_unheard(20);
  ask({never_before, always_after, true});
  static_cast<void>(listen());
  parts.retrieval.watch(clock.now());  // a page is read
  while (!parts.telemetry.ground().behind()) {
    report(arm, 17, 2, {});
    parts.telemetry.serve_ground();
  }
  parts.retrieval.watch(clock.now());
  EXPECT_THAT(listen().numbers, IsEmpty());
  EXPECT_GE(go_on().numbers.size(), 20U);
}

TEST_F(RetrievalTest, AnotherGroundWaitsAndTheSameOneAsksAnew) {
  say_unheard(100);
  ask({never_before, always_after, true}, ground);
  static_cast<void>(go_on(3));
  ask({never_before, always_after, true}, other_ground);
  const auto busy = std::to_string(static_cast<int>(pus::FailureCode::Busy));
  EXPECT_THAT(listen().verdicts, ElementsAre("1.4 of 1 " + busy));
  ask({never_before, always_after, true}, ground);
  const Down down = go_on();
  ASSERT_THAT(down.ends, SizeIs(2));
  EXPECT_EQ(down.ends[0].why, "asked anew");
  EXPECT_EQ(down.ends[0].request % pus::sequence_counts, 0U) << "the first one's";
  EXPECT_EQ(down.ends[1].request % pus::sequence_counts, 2U);
  EXPECT_TRUE(down.ends[1].whole());
  ask({never_before, always_after, true}, other_ground);
  EXPECT_THAT(go_on().ends, SizeIs(1));
}

TEST_F(RetrievalTest, WhatFindsNoRoomInAReportIsLeftOutAndCounted) {
  const OnboardTime from = clock.onboard();
  set(camera, Offline);
  report(arm, 17, 2, std::vector<std::byte>(st129::max_retrieved_octets - pus::telemetry_overhead_octets));
  report(arm, 17, 2, std::vector<std::byte>(st129::max_retrieved_octets - pus::telemetry_overhead_octets + 1));
  set(camera, Operational);
  ask({from, clock.onboard(), true});
  const Down down = go_on();
  EXPECT_THAT(down.packets, ElementsAre(SizeIs(st129::max_retrieved_octets)));
  ASSERT_THAT(down.ends, SizeIs(1));
  EXPECT_EQ(down.ends[0].reports, 1U);
  EXPECT_EQ(down.ends[0].left_out, 1U);
}

TEST_F(RetrievalTest, WhatWentWithADeletedLogIsMissingWhereverItBegan) {
  wait(10s);
  const OnboardTime from = clock.onboard();
  say_unheard(3);
  const std::vector<LogRecord> all = logged();
  LogRecord gap = all.front();
  gap.kind = LogKind::Gap;
  gap.packet.clear();
  gap.lost = static_cast<std::uint32_t>(all.size() - gap.number + 1);
  ASSERT_LT(gap.stored, from);
  auto anew = std::make_unique<MemoryDatabase>();
  ASSERT_TRUE(anew->append(std::span{&gap, 1}));
  store = anew.get();
  log.switch_to(std::move(anew));
  ask({from, always_after, true});
  EXPECT_EQ(go_on().ends.at(0).missing, gap.lost);
}

TEST_F(RetrievalTest, WhatIsNoRangeOfTimesIsRefused) {
  const auto field = std::to_string(static_cast<int>(pus::FailureCode::IllegalField));
  ask({clock.onboard(), clock.onboard() - 1s, true});
  ask_with({});
  EXPECT_THAT(listen().verdicts, ElementsAre("1.2 of 0 " + field, "1.2 of 1 " + field));
}

TEST_F(RetrievalTest, NoSubsystemFillsTheDownlink) {
  ask_with(st129::write_retrieve({never_before, always_after, true}), hand, MessageKind::Packet, hand);
  const auto refused = std::to_string(static_cast<int>(pus::FailureCode::NotDeclared));
  EXPECT_THAT(listen().verdicts, ElementsAre("1.2 of 0 " + refused));
  EXPECT_THAT(go_on().ends, IsEmpty());
}

/// A disk that does what the test says.
struct PlayedLog final : LogReadings {
  Result<> begin(const LogQuery& query) override {
    ++begun;
    asked = query;
    const bool its_first = query.last == 1 && query.end == LogEnd::Oldest;
    if (its_first) next = LogPage{.records = {{.number = 1}}};
    return ok();
  }
  std::optional<Result<LogPage>> outcome() override { return std::exchange(next, std::nullopt); }
  int begun{0};
  LogQuery asked;  ///< last
  std::optional<Result<LogPage>> next;
};

struct SlowRetrievalTest : RetrievalTest {
  PlayedLog disk;
  Retrieval retrieval{{craft, parts.own, parts.telemetry, &disk}};
  void begin() {
    retrieval.begin({.id = 1, .source = ground, .ack = 0}, st129::write_retrieve({never_before, always_after, true}));
  }
  Down step() {
    wait(10ms);
    retrieval.watch(clock.now());
    own_step();
    return listen();
  }
  /// With the look for the log's first record behind it.
  Down last_step() {
    EXPECT_THAT(step().ends, IsEmpty());
    return step();
  }
};

TEST_F(SlowRetrievalTest, AskedAnewWhileADiskStandsStillItReadsNothingBesideAndDropsWhatComesLate) {
  begin();
  static_cast<void>(step());
  ASSERT_EQ(disk.begun, 1);
  begin();
  static_cast<void>(step());
  EXPECT_EQ(disk.begun, 1) << "one page at a time";
  LogPage late;
  late.records = {{.run = log.run(), .number = 1, .kind = LogKind::Telemetry, .packet = {std::byte{1}}}};
  disk.next = late;
  EXPECT_THAT(step().packets, IsEmpty()) << "nobody wants it any more";
  static_cast<void>(step());
  EXPECT_EQ(disk.begun, 2);
  disk.next = late;
  EXPECT_THAT(step().packets, SizeIs(1));
}

TEST_F(SlowRetrievalTest, AskedAnewTwiceWhileADiskStandsStillTheLateOneIsStillNobodys) {
  begin();
  static_cast<void>(step());
  begin();
  begin();
  LogPage late;
  late.records = {{.run = log.run(), .number = 1, .kind = LogKind::Telemetry, .packet = {std::byte{1}}}};
  disk.next = late;
  EXPECT_THAT(step().packets, IsEmpty()) << "it is the page of the first question";
  EXPECT_EQ(disk.begun, 2) << "and the last one is read";
}

TEST_F(SlowRetrievalTest, WhatTheLogLacksAndWhatIsDamagedIsCounted) {
  begin();
  static_cast<void>(step());
  disk.next = LogPage{.records = {}, .damaged = 3};
  static_cast<void>(step());
  EXPECT_EQ(disk.asked.kind, LogKind::Gap);
  LogPage page;
  page.records = {{.run = log.run(), .number = 1, .kind = LogKind::Gap, .lost = 12}};
  page.damaged = 3;
  disk.next = page;
  const Down down = last_step();
  EXPECT_THAT(down.ends, ElementsAre(st129::RetrievalEnd{.request = 1, .missing = 12, .damaged = 3}));
  EXPECT_FALSE(down.ends.at(0).whole());
}

/// Numbers 11 to 110 went with the log, from 100 s on; asked is for what came from 200 s on.
struct GapBeforeTest : SlowRetrievalTest {
  static constexpr OnboardTime first_lost{100s}, from{200s};
  LogRecord gap{.run = log.run(), .number = 11, .stored = first_lost, .kind = LogKind::Gap, .lost = 100};
  LogRecord report{.run = log.run(), .stored = from - 1s, .kind = LogKind::Telemetry, .packet = {std::byte{1}}};

  void SetUp() override {
    SlowRetrievalTest::SetUp();
    constexpr int beyond_the_gap = 200;
    for (int i = 0; i < beyond_the_gap; ++i) static_cast<void>(log.append({.kind = LogKind::Action, .note = "said"}));
  }
  st129::RetrievalEnd end_where(const LogRecord& stands_before) {
    retrieval.begin({.id = 1, .source = ground, .ack = 0}, st129::write_retrieve({from, always_after, true}));
    static_cast<void>(step());
    disk.next = LogPage{};
    static_cast<void>(step());
    EXPECT_EQ(disk.asked.stored_from, OnboardTime::min()) << "a gap has the times of its first record";
    disk.next = LogPage{.records = {gap}};
    EXPECT_THAT(step().ends, IsEmpty());
    EXPECT_EQ(disk.asked.stored_to, from - 1ns);
    EXPECT_EQ(disk.asked.last, 1U);
    disk.next = LogPage{.records = {stands_before}};
    const Down down = last_step();
    EXPECT_THAT(down.ends, SizeIs(1));
    return down.ends.empty() ? st129::RetrievalEnd{} : down.ends[0];
  }
};

TEST_F(GapBeforeTest, WhatIsLostFromItOnIsMissing) {
  report.number = 80;
  EXPECT_EQ(end_where(report).missing, 30U);
}

TEST_F(GapBeforeTest, AllOfItMayBeMissingWhereItStandsJustBefore) { EXPECT_EQ(end_where(gap).missing, 100U); }

TEST_F(GapBeforeTest, WhatIsOverBeforeIsNotAskedFor) {
  report.number = 111;
  EXPECT_TRUE(end_where(report).whole());
}

TEST_F(GapBeforeTest, OneWithOthersInBetweenReachesAsFarAsItSays) {
  gap.lost = 20;
  gap.note = "no room before the database, up to number 90";
  report.number = 80;
  EXPECT_EQ(end_where(report).missing, 10U);
  report.number = 50;
  EXPECT_EQ(end_where(report).missing, 20U) << "no more than are lost";
}

TEST_F(SlowRetrievalTest, AGapThatBeginsAfterTheQuestionIsNoneOfIt) {
  begin();
  static_cast<void>(step());
  disk.next = LogPage{};
  static_cast<void>(step());
  disk.next = LogPage{
      .records = {{.run = log.run(), .number = 1'000'000, .stored = clock.onboard(), .kind = LogKind::Gap, .lost = 5}}};
  EXPECT_TRUE(last_step().ends.at(0).whole());
}

/// Takes nothing, and says so.
struct DeafDatabase final : Database {
  Result<> do_append(std::span<const LogRecord>) override { return fail(ErrorCode::Unavailable, "the disk is asleep"); }
  Result<LogPage> do_read(const LogQuery&) override { return LogPage{}; }
  std::string_view do_strategy() const noexcept override { return "deaf"; }
};

TEST_F(SlowRetrievalTest, WhatIsNotOnTheDiskInTimeIsNoWholeAnswer) {
  log.switch_to(std::make_unique<DeafDatabase>());
  begin();
  EXPECT_THAT(step().ends, IsEmpty());
  EXPECT_EQ(disk.begun, 0) << "what was said just before would be missing";
  wait(Retrieval::disk_patience);
  const Down down = step();
  ASSERT_THAT(down.ends, SizeIs(1));
  EXPECT_EQ(down.ends[0].why, "what was said last is not on the disk yet");
  EXPECT_FALSE(down.ends[0].whole());
}

TEST_F(SlowRetrievalTest, ALogThatIsFullRefusesTheQuestion) {
  log.switch_to(std::make_unique<DeafDatabase>());
  while (log.append({.kind = LogKind::Action, .note = "fills it"}) != 0) {}
  begin();
  const Down down = step();
  EXPECT_THAT(down.ends, IsEmpty());
  EXPECT_EQ(disk.begun, 0);
  EXPECT_THAT(down.verdicts, ElementsAre("1.4 of 1 " + std::to_string(static_cast<int>(pus::FailureCode::QueueFull))));
}

TEST_F(SlowRetrievalTest, ALogThatCannotBeReadEndsItInWords) {
  begin();
  static_cast<void>(step());
  disk.next = fail(ErrorCode::SystemFailure, "no such disk");
  const Down down = step();
  ASSERT_THAT(down.ends, SizeIs(1));
  EXPECT_EQ(down.ends[0].why, "the log cannot be read: no such disk");
  begin();
  static_cast<void>(step());
  EXPECT_EQ(disk.begun, 2) << "and the next one is tried";
}

}  // namespace
}  // namespace hirosco::supervisor
