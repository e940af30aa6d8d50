// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/replacement.hpp"

#include <array>
#include <string>
#include <vector>

#include "hirosco/pus/st05_event/event_service.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct ReplacementTest : PartsTest {
  std::expected<bool, StartRefusal> ready{true};
  std::vector<std::string> used, dropped;  ///< by ARM
  int starts{0};
  int starts_that_fail{0};
  [[nodiscard]] std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem&,
                                                          const std::string&) override {
    return ready;
  }
  void use(const descriptor::MissionSubsystem&, const std::string& version) override { used.push_back(version); }
  void drop(const descriptor::MissionSubsystem&, const std::string& version) override { dropped.push_back(version); }
  [[nodiscard]] Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override {
    ++starts;
    if (starts_that_fail-- > 0) return fail(ErrorCode::SystemFailure, "new process", 11);
    return PartsTest::launch(subsystem);
  }
  void SetUp() override {
    PartsTest::SetUp();
    start_all(Offline);
    starts = 0;
  }
  [[nodiscard]] Outcome replace(std::uint16_t apid = arm, std::string_view version = "2") {
    return parts.replacement.replace(apid, version, 30s, Call{});
  }
  void watch() { parts.replacement.watch(clock.now()); }
  /// The process that was let go ends, and what is to come comes.
  void ends_and_begins() {
    watch();
    ends[played[arm].process] = {};
    watch();
    ends.clear();
    watch();
    if (craft.member(arm)->alive()) set(arm, Offline);
  }
  void on_trial() {
    ASSERT_EQ(replace().kind, Outcome::Kind::Running);
    ends_and_begins();
    ASSERT_THAT(used, ElementsAre("2"));
  }
};

TEST_F(ReplacementTest, AnotherOneIsStartedInOfflineOnTrialWhileTheOthersGoOn) {
  set(hand, Operational);
  const std::uint64_t fences = craft.guard.fences(hand);
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  watch();
  EXPECT_FALSE(craft.member(arm)->alive()) << "it has been let go";
  watch();
  EXPECT_EQ(starts, 0) << "and is not there twice";
  EXPECT_EQ(parts.processes.start(arm).error().code, ErrorCode::Unavailable) << "nor does anybody else start it";
  ends[played[arm].process] = {};
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_EQ(starts, 1);
  EXPECT_THAT(used, ElementsAre("2"));
  EXPECT_TRUE(was_told("ARM runs version 2: CONFIRM within 30 s keeps it"));
  EXPECT_FALSE(was_told("died"));
  EXPECT_THAT(texts(hand), IsEmpty());
  EXPECT_EQ(craft.guard.fences(hand), fences);
}

TEST_F(ReplacementTest, WhatWasSetOfTheProcessBeforeIsNotThatOfTheOneInItsPlace) {
  descriptor::Plan plan;
  plan.name = "back";
  plan.event = "PROCESS_DIED";
  plan.steps = {{"restart", {3, 60, 0, static_cast<std::int64_t>(Operational)}}};
  craft.mission.plans.push_back(plan);
  const std::array event_7{std::byte{1}, std::byte{0}, std::byte{7}};
  const auto packet =
      telecommand(arm, pus::EventService::service_type, pus::EventService::disable_reports, Octets{event_7});
  const auto silences = *pus::TelecommandView::parse(packet);
  parts.commanded.forwarded(arm, silences, Origin::ground(0));
  verify(arm, silences.request_id(), 7, {}, silences.source());
  ASSERT_THAT(parts.commanded.of(arm).silent_events(), ElementsAre(7));
  on_trial();
  EXPECT_THAT(parts.commanded.of(arm).silent_events(), IsEmpty());
}

TEST_F(ReplacementTest, OneThatIsDownIsStartedInAnotherVersion) {
  craft.member(arm)->died();
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  watch();
  watch();
  EXPECT_EQ(starts, 1);
  EXPECT_THAT(used, ElementsAre("2"));
}

TEST_F(ReplacementTest, AFileThatIsStillBeingReadIsWaitedForByNobodyAndNotForEver) {
  ready = false;
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
  ready = true;
  ends_and_begins();
  EXPECT_THAT(used, ElementsAre("2"));
  ready = false;
  ASSERT_EQ(replace(hand).kind, Outcome::Kind::Running);
  wait(61s);
  watch();
  EXPECT_EQ(replace(hand).kind, Outcome::Kind::Running) << "the first is over";
}

TEST_F(ReplacementTest, WhatTheManifestRefusesChangesNothing) {
  ready =
      std::unexpected{StartRefusal{{ErrorCode::Mismatch, "its digest is not the one in the manifest"}, "arm@2 has 12"}};
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  watch();
  EXPECT_TRUE(was_told("ARM stays the mission's own version: arm@2 has 12"));
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_THAT(used, IsEmpty());
  ready = true;
  EXPECT_EQ(replace().kind, Outcome::Kind::Running);
}

TEST_F(ReplacementTest, IsRefusedOutsideOfflineForTheGroundLinkAndWhereThereIsNothingToDo) {
  set(arm, PreOperational);
  EXPECT_EQ(replace().code, pus::FailureCode::WrongStatus);
  set(arm, Offline);
  EXPECT_EQ(replace(camera).code, pus::FailureCode::NotPermittedNow);
  EXPECT_EQ(replace(99).code, pus::FailureCode::UnknownIdentifier);
  EXPECT_EQ(replace(arm, "../2").code, pus::FailureCode::ValueNotAcceptable);
  EXPECT_EQ(replace(arm, "").code, pus::FailureCode::ValueNotAcceptable);
  EXPECT_EQ(parts.replacement.confirm(arm).code, pus::FailureCode::WrongStatus);
  EXPECT_EQ(parts.replacement.take_back(arm, {}).code, pus::FailureCode::WrongStatus);
  EXPECT_EQ(replace().kind, Outcome::Kind::Running);
  EXPECT_EQ(replace().code, pus::FailureCode::WrongStatus) << "one at a time";
  craft.shutting_down = true;
  EXPECT_EQ(replace(hand).code, pus::FailureCode::NotPermittedNow);
}

TEST_F(ReplacementTest, WhoLeavesOfflineBeforeItsFileIsReadIsNotTouched) {
  ready = false;
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  set(arm, Operational);
  ready = true;
  watch();
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_THAT(used, IsEmpty());
}

TEST_F(ReplacementTest, ConfirmedItStaysWhateverHappensThen) {
  on_trial();
  set(arm, Operational);
  EXPECT_EQ(parts.replacement.confirm(arm).kind, Outcome::Kind::Done);
  wait(60s);
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
  parts.replacement.died(arm);
  EXPECT_THAT(used, ElementsAre("2"));
  EXPECT_THAT(dropped, IsEmpty());
}

TEST_F(ReplacementTest, NotConfirmedInItsTimeItGoesBackByItself) {
  on_trial();
  wait(29s);
  watch();
  EXPECT_THAT(used, ElementsAre("2"));
  wait(2s);
  watch();
  EXPECT_TRUE(was_told("ARM was not confirmed as version 2 in its time"));
  watch();
  ends_and_begins();
  EXPECT_THAT(used, ElementsAre("2", ""));
  EXPECT_TRUE(was_told("ARM runs the mission's own version again"));
  EXPECT_THAT(dropped, ElementsAre("2"));
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(ReplacementTest, NotConfirmedAndCyclingItIsTakenDownByTheMissionsPlanFirst) {
  on_trial();
  set(arm, Operational);
  wait(31s);
  watch();
  EXPECT_TRUE(was_told("network {ARM} to ErrorOperational and down"));
  watch();
  EXPECT_TRUE(craft.member(arm)->alive()) << "it has its time for that";
  EXPECT_THAT(killed, IsEmpty());
  set(arm, Offline);
  watch();
  ends_and_begins();
  EXPECT_THAT(used, ElementsAre("2", ""));
}

TEST_F(ReplacementTest, WhatDoesNotGoDownIsEndedAndStillFallsBack) {
  on_trial();
  set(arm, Operational);
  wait(31s);
  watch();
  wait(11s);
  watch();
  EXPECT_THAT(killed, Contains(played[arm].process));
  ends[played[arm].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  ends.clear();
  EXPECT_THAT(used, ElementsAre("2", "")) << "whoever starts it next";
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(ReplacementTest, WhatDiesOnTrialFallsBack) {
  on_trial();
  ends[played[arm].process] = {.by_signal = false, .value = 3};
  parts.processes.watch(clock.now());
  ends.clear();
  EXPECT_TRUE(was_told("ARM died as version 2, which was not confirmed: the mission's own version is next"));
  watch();
  EXPECT_THAT(used, ElementsAre("2", "", ""));
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_EQ(replace().kind, Outcome::Kind::Running) << "it may be tried again";
}

TEST_F(ReplacementTest, WhatCannotEvenBeStartedFallsBack) {
  starts_that_fail = 1;
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  ends_and_begins();
  EXPECT_THAT(used, ElementsAre("2", ""));
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(ReplacementTest, IsTakenBackByCommandOnTrialAndAfter) {
  on_trial();
  set(arm, Operational);
  EXPECT_EQ(parts.replacement.take_back(arm, {}).code, pus::FailureCode::WrongStatus);
  set(arm, Offline);
  EXPECT_EQ(parts.replacement.take_back(arm, {}).kind, Outcome::Kind::Running);
  ends_and_begins();
  EXPECT_THAT(used, ElementsAre("2", ""));
  EXPECT_EQ(replace().kind, Outcome::Kind::Running);
  ends_and_begins();
  EXPECT_EQ(parts.replacement.confirm(arm).kind, Outcome::Kind::Done);
  EXPECT_EQ(parts.replacement.take_back(arm, {}).kind, Outcome::Kind::Running);
  ends_and_begins();
  EXPECT_THAT(used, ElementsAre("2", "", "2", ""));
}

TEST_F(ReplacementTest, WhatIsGoneBackToIsWaitedForWhileItIsBeingReadButNotForEver) {
  on_trial();
  ASSERT_EQ(parts.replacement.take_back(arm, {}).kind, Outcome::Kind::Running);
  ready = false;
  ends_and_begins();
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_EQ(parts.processes.start(arm).error().code, ErrorCode::Unavailable) << "nor does anybody else start it";
  ready = true;
  watch();
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_THAT(used, ElementsAre("2", ""));
  set(arm, Offline);
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  ends_and_begins();
  ASSERT_EQ(parts.replacement.take_back(arm, {}).kind, Outcome::Kind::Running);
  ready = false;
  ends_and_begins();
  EXPECT_FALSE(craft.member(arm)->alive());
  wait(61s);
  watch();
  EXPECT_TRUE(craft.member(arm)->alive()) << "whoever launches says why where it cannot";
}

TEST_F(ReplacementTest, AProcessThatDoesNotEndIsEnded) {
  ASSERT_EQ(replace().kind, Outcome::Kind::Running);
  watch();
  wait(900ms);
  watch();
  EXPECT_THAT(killed, IsEmpty());
  wait(200ms);
  watch();
  EXPECT_THAT(killed, Contains(played[arm].process));
}

}  // namespace
}  // namespace hirosco::supervisor
