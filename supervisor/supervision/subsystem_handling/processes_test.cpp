// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/processes.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

struct ProcessesTest : PartsTest {
  std::vector<std::string> lacks;
  const char* not_held{""};  ///< what of those that are started no manifest holds
  const char* not_kept{""};  ///< why the keeper does not hold them
  std::map<std::uint32_t, std::string_view> not_taken;  ///< by the keeper, which says so later
  [[nodiscard]] std::string_view take_not_kept(std::uint32_t process) override {
    return std::exchange(not_taken[process], {});
  }
  const char* open{""};  ///< why those that are started are in no sandbox
  [[nodiscard]] std::vector<std::string> isolation_lacks() const override { return lacks; }
  std::string not_asked{};  ///< of isolation
  [[nodiscard]] std::string isolation_not_asked() const override { return not_asked; }
  std::string reached{};  ///< beyond what is its own, by ARM
  [[nodiscard]] std::string left_open(const descriptor::MissionSubsystem& subsystem) const override {
    return subsystem.subsystem.id == arm ? reached : "";
  }
  std::optional<StartRefusal> refusal;  ///< by the manifest
  [[nodiscard]] std::optional<StartRefusal> refuse(const descriptor::MissionSubsystem&) override { return refusal; }
  int starts_that_fail{0};  ///< from now on
  [[nodiscard]] Result<LaunchedSubsystem> launch(const descriptor::MissionSubsystem& subsystem) override {
    if (starts_that_fail-- > 0) return fail(ErrorCode::SystemFailure, "new process", 11);
    auto launched = PartsTest::launch(subsystem);
    if (launched) launched->not_isolated = open;
    if (launched) launched->not_held = not_held;
    if (launched) launched->not_kept = not_kept;
    return launched;
  }
  void dies(std::uint16_t apid) {
    ends[played[apid].process] = {.by_signal = true, .value = 9};
    parts.processes.watch(clock.now());
    ends.clear();
  }
};

TEST_F(ProcessesTest, EachIsStartedInTheOrderOfTheMission) {
  parts.processes.start_all();
  EXPECT_THAT(story, ElementsAre("started ARM", "started HAND", "started CAMERA"));
  for (const Member& member : craft.members) EXPECT_TRUE(member.alive());
}

TEST_F(ProcessesTest, WhatASandboxCannotNarrowDownIsToldOnceForEachAtTheStart) {
  reached = "all that listens by UDP";
  craft.mission.isolation_required = true;
  parts.processes.start_all();
  EXPECT_THAT(
      story, ElementsAre("started ARM",
                         "ARM is isolated but for what its endnodes and links need: it reaches all that listens by UDP",
                         "started HAND", "started CAMERA"));
}

/// The test writes the word as the system does.
struct ProcessEndsTest : ProcessesTest {
  static constexpr std::uint32_t held = 0x8000'1267, marked = 0xC000'0000;
  void word(std::uint16_t apid, std::uint32_t value) {
    played[apid].vital->life = value;
    guard.life_changed(apid);
  }
  void SetUp() override {
    ProcessesTest::SetUp();
    start_all(Operational);
    parts.graph.set_up(linked, true);
    for (const std::uint16_t apid : {arm, hand, camera}) {
      ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
      word(apid, held);
    }
    parts.processes.watch(clock.now());
  }
  static constexpr std::uint8_t linked = 2;  ///< from HAND to ARM
};

TEST_F(ProcessEndsTest, WhomADeathWouldStopTheGuardStopsBeforeTheSupervisorHasHeardOfIt) {
  word(hand, marked);
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_FALSE(guard.fenced(camera));
  EXPECT_FALSE(craft.member(hand)->closed_at);
}

TEST_F(ProcessEndsTest, OfWhomALinkThatWasLetGoJoinedNobodyElseIsStopped) {
  parts.graph.forget(linked);
  parts.processes.watch(clock.now());
  word(hand, marked);
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(ProcessEndsTest, WhoLivesOnAlthoughItsEndWasToldIsEndedAfterASecond) {
  word(hand, marked);
  parts.processes.take_guard_findings();
  EXPECT_EQ(craft.member(hand)->closed_at, clock.now());
  wait(1s);
  parts.processes.watch(clock.now());
  EXPECT_TRUE(killed.empty());
  wait(1ms);
  parts.processes.watch(clock.now());
  EXPECT_THAT(killed, ElementsAre(played[hand].process));
}

TEST_F(ProcessesTest, WhatKeepsNobodyFromOthersIsToldAndRefusedWhereTheMissionWantsIt) {
  lacks = {"files are open to all"};
  parts.processes.start_all();
  EXPECT_EQ(story.front(), "subsystems are not isolated as they should be: files are open to all");
  EXPECT_TRUE(craft.member(arm)->alive()) << "told, and flown";
  craft.member(arm)->died();
  craft.mission.isolation_required = true;
  EXPECT_FALSE(parts.processes.start(arm));
  EXPECT_TRUE(was_told("cannot start ARM: the mission wants it isolated, and files are open to all"));
  lacks.clear();
  EXPECT_TRUE(parts.processes.start(arm));
}

TEST_F(ProcessesTest, WhatAMissionDoesNotAskForIsToldAndKeepsNobodyFromFlying) {
  not_asked = "subsystems are all of the user who flies";
  craft.mission.isolation_required = true;
  parts.processes.start_all();
  EXPECT_EQ(story.front(), not_asked);
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(ProcessesTest, OneThatIsInNoSandboxIsToldAndEndedWhereTheMissionWantsIt) {
  open = "it is a script";
  EXPECT_TRUE(parts.processes.start(arm));
  EXPECT_TRUE(was_told("ARM is not isolated: it is a script"));
  craft.mission.isolation_required = true;
  EXPECT_FALSE(parts.processes.start(hand));
  EXPECT_THAT(killed, ElementsAre(played[hand].process));
}

TEST_F(ProcessesTest, WhatTheManifestRefusesIsToldAndNotStartedUntilItIsInOrder) {
  refusal = StartRefusal{{ErrorCode::Mismatch, "its digest is not the one in the manifest"}, "arm has the SHA-256 12"};
  const auto started = parts.processes.start(arm);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::Mismatch);
  EXPECT_TRUE(was_told("cannot start ARM: arm has the SHA-256 12"));
  EXPECT_TRUE(played.empty()) << "nothing was launched";
  start_supervisor();
  EXPECT_TRUE(was_told("SUPERVISOR low PROGRAM_REFUSED APID=10"));
  refusal.reset();
  EXPECT_TRUE(parts.processes.start(arm));
}

TEST_F(ProcessesTest, TheGroundThatAsksForTheStartOfWhatIsRefusedIsToldWhy) {
  refusal = StartRefusal{{ErrorCode::Mismatch, "its digest is not the one in the manifest"}, ""};
  parts.processes.start_all();
  const auto asked = telecommand(arm, 8, 1, call_data("SET_STATE", 0));
  parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  parts.telecommands.forward_durable();
  EXPECT_THAT(own_failures(), ElementsAre(static_cast<std::uint16_t>(pus::FailureCode::ExecutionError)));
  refusal.reset();
  parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  parts.telecommands.forward_durable();
  EXPECT_THAT(own_failures(), ElementsAre());
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(ProcessesTest, WhatOfAnExecutableTheManifestDoesNotHoldIsTold) {
  not_held = "it is a script, whose interpreter is another file";
  EXPECT_TRUE(parts.processes.start(arm));
  EXPECT_TRUE(was_told("not all of ARM is in the manifest: it is a script, whose interpreter is another file"));
}

TEST_F(ProcessesTest, WhomTheKeeperDoesNotHoldIsTold) {
  not_kept = "the keeper takes nothing";
  EXPECT_TRUE(parts.processes.start(arm));
  EXPECT_TRUE(was_told("ARM ends with this supervisor, should that die: the keeper takes nothing"));
}

TEST_F(ProcessesTest, WhomTheKeeperHadNoRoomForIsToldOnceWhenThatIsKnown) {
  constexpr const char* line = "ARM ends with this supervisor, should that die: the keeper has no room";
  parts.processes.start_all();
  parts.processes.watch(clock.now());
  EXPECT_FALSE(was_told("ends with this supervisor"));
  not_taken[played[arm].process] = "the keeper has no room";
  for (int time = 0; time < 3; ++time) parts.processes.watch(clock.now());
  EXPECT_EQ(std::ranges::count(story, line), 1);
  EXPECT_FALSE(was_told("HAND ends with this supervisor"));
}

TEST_F(ProcessesTest, WhoIsNotInTheStartListIsStartedWhenTheGroundAsks) {
  mission.subsystems[1].starts = craft.mission.subsystems[1].starts = false;
  parts.processes.start_all();
  EXPECT_THAT(story, ElementsAre("started ARM", "HAND is not started with the flight: SET_STATE Offline starts it",
                                 "started CAMERA"));
  EXPECT_FALSE(craft.member(hand)->alive());
  EXPECT_FALSE(craft.failed());
  const auto asked = telecommand(hand, 8, 1, call_data("SET_STATE", 0));
  parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  parts.telecommands.forward_durable();
  EXPECT_TRUE(craft.member(hand)->alive());
}

TEST_F(ProcessesTest, ADeathIsToldWithItsKindAndItsNetworkGoesDown) {
  start_all(Operational);
  dies(arm);
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_TRUE(was_told("ARM died: signal 9"));
  EXPECT_TRUE(was_told("network {ARM} to ErrorOperational and down"));
}

TEST_F(ProcessesTest, WhatTheDeadHadBegunHasAnUnknownOutcome) {
  start_all(Operational);
  const auto asked = telecommand(arm, 17, 1, {});
  parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  dies(arm);
  EXPECT_THAT(own_failures(), ElementsAre(static_cast<std::uint16_t>(pus::FailureCode::OutcomeUnknown)));
}

TEST_F(ProcessesTest, WhoLivesOnWithItsChannelClosedIsFencedAndEndedAfterASecond) {
  start_all(Operational);
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  played[arm].channel.close_subsystem_end();
  parts.reception.read(*craft.member(arm));
  EXPECT_TRUE(guard.fenced(arm));
  wait(1s);
  parts.processes.watch_closed();
  EXPECT_TRUE(killed.empty());
  wait(1ms);
  parts.processes.watch_closed();
  EXPECT_THAT(killed, ElementsAre(played[arm].process));
}

TEST_F(ProcessesTest, WithWhoClosesItsChannelItsNetworkIsFencedAtOnce) {
  start_all(Operational);
  parts.graph.set_up(2, true);
  for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  played[hand].channel.close_subsystem_end();
  parts.reception.read(*craft.member(hand));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(craft.member(hand)->alive()) << "before it has ended";
  EXPECT_FALSE(was_told("network {"));
}

TEST_F(ProcessesTest, WhoClosesItsChannelFencesNobodyWhomItsPlanLetsGoOn) {
  start_all(Operational);
  parts.graph.set_up(2, true);
  descriptor::Plan alone;
  alone.name = "alone";
  alone.event = descriptor::event_of_death;
  alone.steps = {{"log"}};
  craft.mission.plans = {alone};
  for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  played[hand].channel.close_subsystem_end();
  parts.reception.read(*craft.member(hand));
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(ProcessesTest, OneThatIsDueIsStartedAgainButNotWhileTheFlightEnds) {
  start_all(Operational);
  dies(hand);
  ASSERT_TRUE(parts.restarts.plan(hand, {.limit = 3, .within = 60s, .pause = 100ms}, clock.now()));
  parts.processes.watch(clock.now());
  EXPECT_FALSE(craft.member(hand)->alive());
  wait(100ms);
  craft.shutting_down = true;
  parts.processes.watch(clock.now());
  EXPECT_FALSE(craft.member(hand)->alive());
  craft.shutting_down = false;
  ASSERT_TRUE(parts.restarts.plan(hand, {.limit = 3, .within = 60s, .pause = 100ms}, clock.now()));
  wait(200ms);
  parts.processes.watch(clock.now());
  EXPECT_TRUE(craft.member(hand)->alive());
}

TEST_F(ProcessesTest, AStartThatFailsIsTriedAgainWithAPauseThatDoubles) {
  start_all(Operational);
  for (const std::uint16_t apid : {hand, camera}) {
    dies(apid);
    ASSERT_TRUE(parts.restarts.plan(apid, {.limit = 1, .within = 600s, .pause = 100ms}, clock.now()));
    starts_that_fail = 3;
    // Tried after 100, 200, 400 and 800 ms.
    for (const Duration pause : {100ms, 200ms, 400ms, 800ms}) {
      EXPECT_FALSE(craft.member(apid)->alive());
      wait(pause - 1ms);
      parts.processes.watch(clock.now());
      EXPECT_FALSE(craft.member(apid)->alive());
      wait(1ms);
      parts.processes.watch(clock.now());
    }
    EXPECT_TRUE(craft.member(apid)->alive()) << craft.name_of(apid);
  }
  EXPECT_TRUE(was_told("cannot start HAND: new process"));
  EXPECT_FALSE(craft.failed());
}

/// ARM is down for good: its plan, which starts nobody, is over.
struct WhoStaysDown : ProcessesTest {
  struct Report {
    int subtype{};
    std::uint16_t code{};
    bool operator==(const Report&) const = default;
  };
  void SetUp() override {
    ProcessesTest::SetUp();
    start_all(Operational);
    dies(arm);
    ASSERT_FALSE(craft.member(arm)->alive());
    static_cast<void>(reports());
  }
  /// What the supervisor reported on requests since it was asked last.
  std::vector<Report> reports() {
    struct Ear final : Hearer {
      void hear(std::uint16_t, const pus::TelemetryView& heard) override {
        if (heard.service() != 1) return;
        OctetReader reader{heard.source_data()};
        static_cast<void>(reader.get<std::uint32_t>());
        const bool failure = heard.subtype() % 2 == 0;
        all.push_back({heard.subtype(), failure ? reader.get<std::uint16_t>() : std::uint16_t{0}});
      }
      std::vector<Report> all;
    } ear;
    Telemetry listening{craft, parts.own, parts.traffic, parts.ground_route, {&ear}};
    static_cast<void>(parts.own.step(clock.now()));
    MessageBuffer buffer;
    for (;;) {
      const auto next = parts.own.channel().receive(buffer);
      if (!next || next->flow == Flow::None) return ear.all;
      if (next->message.kind == MessageKind::Packet)
        static_cast<void>(listening.take(supervisor_apid, next->message.packet));
    }
  }
  void ask_for(descriptor::State state, Origin origin = Origin::ground()) {
    const auto packet = telecommand(arm, 8, 1, call_data("SET_STATE", static_cast<int>(state)));
    parts.telecommands.take({.packet = packet, .origin = origin});
    parts.telecommands.forward_durable();
  }
};

TEST_F(WhoStaysDown, IsStartedBySetStateOfflineAgainAndAgainAndTheGroundIsToldHowThatEnded) {
  for (int time = 0; time < 10; ++time) {
    ask_for(Offline);
    EXPECT_TRUE(craft.member(arm)->alive()) << time;
    EXPECT_EQ(craft.member(arm)->state(), Offline);
    EXPECT_TRUE(guard.fenced(arm) || !played[arm].permit->permits(played[arm].permit->epoch.load()));
    EXPECT_THAT(reports(), ElementsAre(Report{1}, Report{3}, Report{7})) << time;
    ask_for(PreOperational);
    EXPECT_THAT(texts(arm), ElementsAre(to(PreOperational))) << "it is commanded as ever";
    dies(arm);
    static_cast<void>(reports());
  }
}

TEST_F(WhoStaysDown, HearsNothingElseAndTheRefusalSaysWhatHelps) {
  ask_for(PreOperational);
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_THAT(reports(), ElementsAre(Report{10, static_cast<std::uint16_t>(pus::FailureCode::UnknownApid)}));
}

TEST_F(WhoStaysDown, AndCannotBeStartedIsReportedAsFailedAndMayBeAskedForAgain) {
  starts_that_fail = 1;
  ask_for(Offline);
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_THAT(reports(), ElementsAre(Report{1}, Report{3},
                                     Report{8, static_cast<std::uint16_t>(pus::FailureCode::ExecutionError)}));
  ask_for(Offline);
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(WhoStaysDown, IsNotStartedOnTheWayDown) {
  craft.shutting_down = true;
  ask_for(Offline);
  EXPECT_THAT(reports(), ElementsAre(Report{2, static_cast<std::uint16_t>(pus::FailureCode::NotPermittedNow)}));
  EXPECT_FALSE(craft.member(arm)->alive());
}

TEST_F(WhoStaysDown, IsStartedOnceWhatWasAskedIsOnTheDiskUnlessTheModeIsAnotherThen) {
  const auto hold = std::make_shared<HeldDatabase::Hold>();
  log.switch_to(std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()));
  const auto let_go = [&] {
    hold->tries = 0;
    craft.tell("the disk works");
    parts.telecommands.forward_durable();
  };
  hold->tries = 1'000'000;
  ask_for(Offline);
  ++craft.mode_epoch;
  let_go();
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_THAT(reports(), ElementsAre(Report{2, static_cast<std::uint16_t>(pus::FailureCode::NotPermittedNow)}));
  hold->tries = 1'000'000;
  ask_for(Offline);
  EXPECT_FALSE(craft.member(arm)->alive());
  let_go();
  EXPECT_TRUE(craft.member(arm)->alive());
}

TEST_F(WhoStaysDown, AndIsStartedByItsPlanMeanwhileIsNotStartedTwice) {
  const auto hold = std::make_shared<HeldDatabase::Hold>();
  log.switch_to(std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()));
  hold->tries = 1'000'000;
  ASSERT_TRUE(parts.restarts.plan(arm, {.limit = 1, .within = 60s, .pause = 1ms}, clock.now()));
  ask_for(Offline);
  wait(1ms);
  parts.processes.watch(clock.now());
  ASSERT_TRUE(craft.member(arm)->alive());
  const auto starts = std::ranges::count(story, "started ARM");
  hold->tries = 0;
  craft.tell("the disk works");
  parts.telecommands.forward_durable();
  EXPECT_EQ(std::ranges::count(story, "started ARM"), starts);
  EXPECT_THAT(reports(), ElementsAre(Report{1}, Report{3}, Report{7}));
}

TEST_F(ProcessesTest, AFlightWhoseFirstStartsFailIsNotOrderly) {
  starts_that_fail = 1;
  parts.processes.start_all();
  EXPECT_TRUE(craft.failed());
}

TEST_F(ProcessesTest, OneWhoseDevicesTheGuardCannotInhibitDoesNotFlyUntilItCan) {
  descriptor::Device motor;
  motor.name = "MOTOR";
  motor.actuator = true;
  motor.enable = descriptor::Endnode{};
  motor.enable->address = "motor-enable";
  craft.mission.subsystems[1].subsystem.devices = {motor};
  auto other = flows.open({motor.enable->transfer, motor.enable->address}, FlowSide::Subsystem);
  ASSERT_TRUE(other) << "somebody else has it";
  parts.processes.start_all();
  EXPECT_FALSE(craft.member(hand)->alive());
  EXPECT_EQ(played.count(hand), 0u);
  EXPECT_TRUE(craft.member(arm)->alive());
  EXPECT_TRUE(was_told("cannot hold the second inhibit of HAND's devices: "));
  EXPECT_TRUE(craft.failed());
  EXPECT_FALSE(parts.processes.start(hand));
  EXPECT_EQ(played.count(hand), 0u);
  other->reset();
  EXPECT_TRUE(parts.processes.start(hand));
  EXPECT_TRUE(craft.member(hand)->alive());
  EXPECT_TRUE(guard.release(hand, guard.fences(hand))) << "the guard has it";
}

/// HAND acts for two seconds; the second inhibit of its MOTOR answers with these octets, or not at all.
struct SecondInhibitTest : ProcessesTest {
  void act(Octets answer);
};

void SecondInhibitTest::act(Octets answer) {
  descriptor::Device motor;
  motor.name = "MOTOR";
  motor.actuator = true;
  motor.enable = descriptor::Endnode{};
  motor.enable->address = "motor-enable";
  auto& subsystem = craft.mission.subsystems[1].subsystem;
  subsystem.devices = {descriptor::Device{}, motor};
  subsystem.configurations[0].devices.emplace_back().device = 1;
  start_all(Operational);
  played[hand].vital->configuration = subsystem.configurations[0].id;
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  const auto plays = flows.open({motor.enable->transfer, motor.enable->address}, FlowSide::Device).value();
  for (const TimePoint end = clock.now() + 2s; clock.now() < end; clock.advance(Guard::period)) {
    for (auto& [apid, member] : played) ++member.vital->service_steps;
    if (!answer.empty()) static_cast<void>(plays->send(answer));
    static_cast<void>(guard.step(clock.now()));
  }
  parts.processes.take_guard_findings();
}

TEST_F(SecondInhibitTest, WhoActsThoughItDoesNotAnswerIsToldOfWithItsDeviceAndWhereItWasLookedFor) {
  act({});
  EXPECT_TRUE(was_told("HAND: the second inhibit of its device MOTOR does not answer at shared_memory motor-enable "));
  EXPECT_TRUE(was_told("without it the device never moves; its driver has to listen there"));
  EXPECT_TRUE(was_told("HAND to SafeOperational because of INHIBIT_SILENT")) << ::testing::PrintToString(story);
}

TEST_F(SecondInhibitTest, WhoseAnswersAreOfAnotherVersionIsToldOfByThatNameAndPlannedForAlike) {
  std::array<std::byte, enable_frame_octets> frame{};
  ASSERT_TRUE(write_enable_status(frame, {}));
  act(hirosco::testing::sealed_as(0x5A, frame));
  EXPECT_TRUE(
      was_told("HAND: the second inhibit of its device MOTOR is of another version, build both from one hirosco"));
  EXPECT_TRUE(was_told("HAND to SafeOperational because of INHIBIT_SILENT")) << ::testing::PrintToString(story);
}

}  // namespace
}  // namespace hirosco::supervisor
