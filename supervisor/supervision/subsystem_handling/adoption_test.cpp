// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/adoption.hpp"

#include <set>

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/procedures/steps/hand_over.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

/// What a supervisor that goes on for one that died knows of the stops before it, and of those that died with it.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

/// A supervisor dies, as often as the test wants; the members live on, but for those that have gone with it.
struct AdoptionTest : PartsTest {
  struct Next {
    Next(AdoptionTest& test, std::uint32_t first_epoch)
        : guard{{.clock = test.clock, .flows = test.flows, .first_epoch = first_epoch, .on_finding = {}}},
          parts{{.mission = test.next_mission,
                 .platform = {test.clock, test.memory, test.flows},
                 .launcher = test,
                 .guard = guard,
                 .log = test.log,
                 .open_database = [](DatabaseStrategy) { return nullptr; },
                 .observer = test,
                 .journal = &test.journal,
                 .values = &test.values,
                 .log_readings = &test.log_readings}} {}
    Guard guard;
    SupervisorParts parts;
  };
  std::vector<std::byte> journal_memory = std::vector<std::byte>(std::size_t{1} << 18);
  Journal journal{journal_memory};
  descriptor::Mission next_mission = mission;
  Memory notes{&journal,
               {&parts.adoption, &parts.modes, &parts.links, &parts.telecommands, &parts.safe_all, &parts.own,
                &parts.commanded, &parts.restarts, &parts.power, &parts.replacement, &parts.subscriptions,
                &parts.stored, &parts.ground_loss, &parts.losses}};
  std::set<std::uint16_t> gone;
  std::vector<std::unique_ptr<Next>> nexts;

  std::map<std::uint16_t, NotAdopted> ended_instead;  ///< one of them lives on

  std::expected<AdoptedSubsystem, NotAdopted> adopt(const descriptor::MissionSubsystem& described) override {
    const std::uint16_t apid = described.subsystem.id;
    if (ended_instead.contains(apid)) return std::unexpected{ended_instead[apid]};
    if (gone.contains(apid) || !played.contains(apid)) return std::unexpected{NotAdopted{}};
    PlayedMember& member = played[apid];
    AdoptedSubsystem adopted;
    adopted.epoch = member.permit->epoch;
    adopted.permitted = member.permit->permits(adopted.epoch);
    adopted.stopped = member.permit->stop != 0;
    adopted.permit = memory.create("permit", sizeof(PermitPage)).value();
    adopted.launched.permit = memory.map(adopted.permit, Access::ReadWrite).value();
    member.permit = new (adopted.launched.permit.octets.data()) PermitPage{};
    adopted.launched.vital = {nullptr, {reinterpret_cast<std::byte*>(member.vital), sizeof(VitalPage)}};
    adopted.launched.process = member.process;
    adopted.launched.port = std::make_unique<LocalMemberPort>(std::make_unique<PlayedMember::End>(member.channel),
                                                              adopted.launched.vital, adopted.launched.permit);
    return adopted;
  }
  /// The newest supervisor dies, and another one goes on.
  SupervisorParts& go_on() {
    nexts.push_back(std::make_unique<Next>(*this, 5000 + 1000 * static_cast<std::uint32_t>(nexts.size())));
    SupervisorParts& next = nexts.back()->parts;
    next.craft.now = clock.now();
    next.own.start(next.craft.mode_epoch);
    next.adoption.begin(false);
    next.own.enter_mode(next.craft.mode_epoch);
    return next;
  }
  /// It is as far as it will get by itself: it ends what was begun, and hears what members say.
  void begins_to_hear(SupervisorParts& next) {
    for (const auto& [apid, member] : played) next.adoption.confirmed(apid);
    wait(Adoption::longest_start + 1ms);
    next.craft.now = clock.now();
    next.adoption.watch(clock.now());
    ASSERT_FALSE(next.adoption.waits());
  }
  /// TM[1,subtype] of a member, heard by this supervisor.
  void says(SupervisorParts& next, std::uint16_t apid, const Received& asked, std::uint8_t subtype) {
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    std::array<std::byte, 4> data;
    OctetWriter{data}.put(asked.request);
    const auto packet = pus::write_telemetry(buffer,
                                             {.apid = apid,
                                              .sequence_count = played[apid].reports++,
                                              .service = 1,
                                              .subtype = subtype,
                                              .destination = asked.source},
                                             data);
    ASSERT_TRUE(played[apid].channel.subsystem_end().send({.kind = MessageKind::Packet, .packet = *packet}));
    next.reception.read(*next.craft.member(apid));
  }
  /// TM[1,x] that this supervisor has said itself to anybody but itself since it was asked last: each x with its code, 0 for none.
  std::vector<std::pair<int, int>> told_by(SupervisorParts& next) {
    static_cast<void>(next.own.step(clock.now()));
    std::vector<std::pair<int, int>> found;
    MessageBuffer buffer;
    for (;;) {
      const auto message = next.own.channel().receive(buffer);
      if (!message || message->flow == Flow::None) return found;
      const auto report = pus::TelemetryView::parse(message->message.packet);
      if (!report || report->service() != 1 || report->destination() == supervisor_apid) continue;
      OctetReader reader{report->source_data()};
      static_cast<void>(reader.get<std::uint32_t>());
      found.emplace_back(report->subtype(), report->subtype() % 2 == 0 ? reader.get<std::uint16_t>() : 0);
    }
  }
  /// A stop of everything, to its end; what had acted is safe then.
  void stop_everything() {
    parts.safe_all.asked();
    for (auto& [apid, member] : played) set(apid, SafeOperational);
    for (const TimePoint end = clock.now() + 1s; clock.now() < end; wait(Guard::period)) {
      guard.beat();
      for (auto& [apid, member] : played) {
        ++member.vital->service_steps;
        member.vital->seen_epoch = member.permit->epoch.load();
      }
      static_cast<void>(guard.step(clock.now()));
    }
    parts.safe_all.follow();
    ASSERT_FALSE(parts.safe_all.under_way());
  }
  /// Why ARM's task is not handed over to this one; empty: it would be.
  static std::string against(SupervisorParts& next, std::uint16_t receiver) {
    ProcedureStep step;
    step.subject = arm;
    step.values = {receiver, 1};
    return steps::task::against(step, {next.craft, next.own_telecommands, next.graph, next.restarts, next.under_way,
                                       next.commanded, next.losses, next.waiting});
  }
};

/// A disk that takes nothing, from now on.
struct OverAFullDisk : AdoptionTest {
  std::shared_ptr<HeldDatabase::Hold> hold = std::make_shared<HeldDatabase::Hold>();
  void SetUp() override {
    AdoptionTest::SetUp();
    start_all(SafeOperational);
    ASSERT_TRUE(notes.note());
    hold->tries = 1'000'000;
    log.switch_to(std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()));
  }
};

TEST_F(OverAFullDisk, ASupervisorThatGoesOnIsOperationalAndReadsWhatIsSaid) {
  SupervisorParts& next = go_on();
  ASSERT_TRUE(next.adoption.waits());
  for (int step = 0; step < 200 && next.adoption.waits(); ++step) {
    wait(1ms);
    next.craft.now = clock.now();
    next.telecommands.forward_durable();
    static_cast<void>(next.own.step(clock.now()));
    next.reception.read_own();
  }
  EXPECT_FALSE(next.adoption.waits()) << next.commissioning.waiting_for();
  EXPECT_EQ(next.own.state(), Operational);
  EXPECT_FALSE(next.craft.failed());
  EXPECT_FALSE(next.craft.taking_over) << "what it says of itself from now on waits for the disk as ever";
}

constexpr const char* hand_was_stopped = "HAND was stopped, and nobody has let it go since";

TEST_F(AdoptionTest, WhoWasStoppedBeforeTakesOverNothingHoweverManySupervisorsDie) {
  start_all(SafeOperational);
  stop_everything();
  ASSERT_TRUE(notes.note());
  for (int death = 0; death < 3; ++death) {
    SupervisorParts& next = go_on();
    EXPECT_EQ(against(next, hand), hand_was_stopped) << death;
    EXPECT_EQ(against(next, camera), "") << "the ground link was spared";
    ASSERT_TRUE(next.memory.note());
  }
}

/// ARM holds over what HAND sends, of which two supervisors know one after the other.
struct WhatIsHeldOverMeanwhile : AdoptionTest {
  static constexpr std::uint8_t into_arm = 2;  ///< link
  static constexpr Duration held_for = 700ms;
  void SetUp() override {
    AdoptionTest::SetUp();
    craft.mission.links[1].on_loss = descriptor::OnLoss::Hold;
    craft.mission.links[1].hold = held_for;
    next_mission = craft.mission;
    start_all(Operational);
    set(arm, Operational, 2);
    parts.graph.set_up(into_arm, true);
    judges(link_stale);
    parts.own.start(craft.mode_epoch);
    parts.losses.lost(into_arm);
    ASSERT_TRUE(was_told(lost));
    story.clear();
    ASSERT_TRUE(notes.note());
  }
  void judges(LinkJudgement judgement) {
    played[arm].vital->incoming[0].link = into_arm;
    played[arm].vital->judged[0] = judgement;
  }
  void after(Duration span, SupervisorParts& next) {
    wait(span);
    next.craft.now = clock.now();
    next.losses.watch(clock.now());
  }
  static constexpr const char* lost = "ARM has lost HAND_STATE of HAND: hold";
  static constexpr const char* down = "ARM: HAND_STATE did not come back in time";
};

TEST_F(WhatIsHeldOverMeanwhile, EndsWithItsTimeHoweverManySupervisorsDie) {
  for (int death = 0; death < 3; ++death) {
    SupervisorParts& next = go_on();
    after(200ms, next);
    EXPECT_FALSE(was_told(down));
    ASSERT_TRUE(next.memory.note());
  }
  after(held_for - 3 * 200ms, go_on());
  EXPECT_TRUE(was_told(down));
  EXPECT_FALSE(was_told(lost)) << "it was told";
}

TEST_F(WhatIsHeldOverMeanwhile, IsBackUnderASupervisorThatHasNeverSeenItsLink) {
  SupervisorParts& next = go_on();
  after(200ms, next);
  ASSERT_FALSE(next.links.can_look(into_arm));
  judges(link_valid);
  after(200ms, next);
  after(1h, next);
  EXPECT_FALSE(was_told(down));
}

TEST_F(AdoptionTest, WhoHasJustBegunOrWasLetGoIsFreeUnderTheNextSupervisor) {
  start_all(SafeOperational);
  ASSERT_TRUE(notes.note());
  EXPECT_EQ(against(go_on(), hand), "");
}

TEST_F(AdoptionTest, WhomTheGuardStoppedAfterTheLastNoteWasStopped) {
  start_all(SafeOperational);
  ASSERT_TRUE(notes.note());
  guard.fence(hand);
  EXPECT_EQ(against(go_on(), hand), hand_was_stopped);
}

TEST_F(AdoptionTest, OfWhomNothingIsKnownItIsNotKnownThatItWasFree) {
  start_all(SafeOperational);
  EXPECT_EQ(against(go_on(), hand), hand_was_stopped);
}

TEST_F(AdoptionTest, WhoDiedWithTheSupervisorWasStoppedByThatAndIsNotFreeAsANewProcess) {
  start_all(SafeOperational);
  ASSERT_TRUE(notes.note());
  gone = {hand};
  SupervisorParts& next = go_on();
  next.processes.found_dead(*next.craft.member(hand));
  ASSERT_TRUE(next.processes.start(hand));
  set(hand, Offline);
  EXPECT_EQ(against(next, hand), hand_was_stopped);
}

TEST_F(AdoptionTest, TheDevicesOfWhoDiedWithTheSupervisorAreAskedInAStop) {
  descriptor::Device motor;
  motor.name = "MOTOR";
  motor.actuator = true;
  motor.stop_within = 500ms;
  motor.enable = descriptor::Endnode{};
  motor.enable->address = "motor-enable";
  next_mission.subsystems[0].subsystem.devices = {motor};
  start_all(Operational);
  ASSERT_TRUE(notes.note());
  gone = {arm};
  go_on();
  Guard& next = nexts.back()->guard;
  static_cast<void>(next.step(clock.now()));
  const auto stop = next.stop_all();
  static_cast<void>(next.step(clock.now()));
  EXPECT_FALSE(next.stop_outcome(stop)) << "it may be in the middle of its stop";
  wait(2s);
  for (int step = 0; step < 400 && !next.stop_outcome(stop); ++step, wait(Guard::period))
    static_cast<void>(next.step(clock.now()));
  const auto answers = next.stop_outcome(stop);
  ASSERT_TRUE(answers);
  const auto answer = std::ranges::find(*answers, arm, &StopAnswer::apid);
  ASSERT_NE(answer, answers->end());
  EXPECT_EQ(answer->name, "MOTOR");
  EXPECT_FALSE(answer->stopped) << "it was not heard";
}

TEST_F(AdoptionTest, WhoWasEndedInsteadHasDiedOfThat) {
  start_all(SafeOperational);
  ASSERT_TRUE(notes.note());
  ended_instead[hand] = {.why = "no descriptor is left"};
  SupervisorParts& next = go_on();
  EXPECT_EQ(std::ranges::count(story, "cannot go on with HAND: no descriptor is left; it is ended"), 1);
  EXPECT_TRUE(nexts.back()->guard.holds(hand)) << "its devices are asked in a stop";
  next.processes.found_dead(*next.craft.member(hand));
  EXPECT_EQ(std::ranges::count(story, "HAND died: signal 9"), 1);
  EXPECT_TRUE(next.processes.start(hand));
}

TEST_F(AdoptionTest, WhoWasEndedInsteadAndHasNotGoneHangsAndNoOtherIsStartedBesideIt) {
  start_all(SafeOperational);
  ASSERT_TRUE(notes.note());
  constexpr std::uint32_t leaving = 77;
  ended_instead[hand] = {.why = "no descriptor is left", .process = leaving};
  SupervisorParts& next = go_on();
  next.processes.found_dead(*next.craft.member(hand));
  EXPECT_EQ(std::ranges::count(story, "HAND hangs: it was ended and has not gone"), 1);
  for (int time = 0; time < 3; ++time) {
    next.processes.watch(clock.now());
    EXPECT_FALSE(next.processes.start(hand));
  }
  EXPECT_EQ(std::ranges::count(story, "HAND died: signal 9"), 0);
  ends[leaving] = {.by_signal = true, .value = 9};
  for (int time = 0; time < 3; ++time) next.processes.watch(clock.now());
  EXPECT_EQ(std::ranges::count(story, "HAND died: signal 9"), 1);
  EXPECT_TRUE(next.processes.start(hand));
}

TEST_F(AdoptionTest, WhoWasNeverStartedIsNotHeld) {
  craft.mission.subsystems[1].starts = false;
  next_mission.subsystems[1].starts = false;
  start_all(SafeOperational);
  ASSERT_FALSE(played.contains(hand));
  ASSERT_TRUE(notes.note());
  go_on();
  EXPECT_FALSE(nexts.back()->guard.holds(hand));
}

/// Telecommands of the ground wait for the disk, and leave (docs/adr/0190).
struct WhatLeavesMeanwhile : AdoptionTest {
  std::shared_ptr<HeldDatabase::Hold> hold = std::make_shared<HeldDatabase::Hold>();
  int lives_for{1000};  ///< so many notes; then it has died
  const int refused = 2, failed = 8;
  const std::pair<int, int> refused_now{refused, static_cast<int>(pus::FailureCode::NotPermittedNow)};
  const std::pair<int, int> unknown{failed, static_cast<int>(pus::FailureCode::OutcomeUnknown)};

  void SetUp() override {
    AdoptionTest::SetUp();
    start_all(Operational);
    log.switch_to(std::make_unique<HeldDatabase>(hold, std::make_shared<MemoryDatabase>()));
    craft.remembers = [this] {
      if (lives_for-- <= 0) return;
      EXPECT_TRUE(notes.note());
    };
    hold->tries = 1'000'000;
  }
  void ground_says(int times = 1) {
    const auto move = telecommand(arm, 8, 1, call_data("MOVE_TO"));
    for (int time = 0; time < times; ++time) parts.telecommands.take({.packet = move, .origin = Origin::ground()});
    craft.remember();
  }
  /// All that waits is on the disk, and leaves; the supervisor dies behind the last of them.
  std::vector<Received> leaves() {
    hold->tries = 0;
    craft.tell("the disk works");
    lives_for = 1;
    parts.telecommands.forward_durable();
    return received(arm);
  }
};

TEST_F(WhatLeavesMeanwhile, IsRefusedWhereItStillWaited) {
  ground_says();
  hold->tries = 0;
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(told_by(next), ElementsAre(refused_now));
  EXPECT_THAT(texts(arm), ::testing::Not(::testing::Contains("MOVE_TO")));
}

TEST_F(WhatLeavesMeanwhile, IsNotRefusedWhereItsAddresseeCarriesItOut) {
  ground_says();
  const auto left = leaves();
  ASSERT_EQ(left.size(), 1u);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  says(next, arm, left[0], 1);
  wait(1h);
  next.telecommands.watch(clock.now());
  EXPECT_THAT(told_by(next), IsEmpty()) << "it takes its time";
  const auto under_way = next.unanswered.size();
  says(next, arm, left[0], 7);
  EXPECT_EQ(next.unanswered.size(), under_way - 1);
  EXPECT_THAT(told_by(next), IsEmpty());
}

TEST_F(WhatLeavesMeanwhile, IsToldAsUnknownOnceWhereNobodyTellsOfItHoweverManySupervisorsDie) {
  ground_says();
  const auto left = leaves();
  for (int death = 0; death < 3; ++death) ASSERT_TRUE(go_on().memory.note());
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  for (const Duration after : {Duration{Unanswered::doubt - 1ms}, Duration{1ms}, Duration{1h}}) {
    wait(after);
    next.telecommands.watch(clock.now());
    if (after == 1ms) EXPECT_THAT(told_by(next), ElementsAre(unknown));
    else EXPECT_THAT(told_by(next), IsEmpty()) << after / 1ms;
  }
  says(next, arm, left[0], 7);
  EXPECT_TRUE(was_told("ARM tells the end of a telecommand that was told as unknown"));
}

TEST_F(WhatLeavesMeanwhile, IsNotedBeforeTheFirstOfManyHasLeftAndBehindTheLast) {
  ground_says(20);
  std::vector<std::size_t> left_at_notes;
  craft.remembers = [&] { left_at_notes.push_back(received(arm).size()); };
  static_cast<void>(leaves());
  EXPECT_THAT(left_at_notes, ElementsAre(0u, 20u));
  parts.telecommands.forward_durable();
  EXPECT_EQ(left_at_notes.size(), 2u) << "nothing waits";
}

TEST_F(WhatLeavesMeanwhile, WasGivenToSomebodyWhoIsGone) {
  ground_says();
  EXPECT_EQ(leaves().size(), 1u);
  gone = {arm};
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  EXPECT_THAT(told_by(next), ElementsAre(unknown)) << "at once";
}

TEST_F(AdoptionTest, WhatASubsystemHasAskedForIsAnsweredToItUnderTheNextSupervisor) {
  for (descriptor::Mission* flown : {&craft.mission, &next_mission})
    for (auto& member : flown->subsystems)
      if (member.subsystem.id == hand)
        member.subsystem.commands = {{.subsystem = "ARM", .functions = {"MOVE_TO", "BRAKE"}, .at = {}, .apid = arm}};
  start_all(Operational);
  craft.remembers = [this] { EXPECT_TRUE(notes.note()); };
  std::vector<Received> asked;
  for (const char* name : {"MOVE_TO", "BRAKE"}) {
    std::array<std::byte, pus::max_telecommand_octets> buffer;
    const auto packet = pus::write_telecommand(buffer,
                                               {.apid = arm,
                                                .sequence_count = static_cast<std::uint16_t>(asked.size()),
                                                .ack = pus::ack_all,
                                                .service = 8,
                                                .subtype = 1,
                                                .source = hand},
                                               call_data(name));
    ASSERT_TRUE(played[hand].channel.subsystem_end().send({.kind = MessageKind::Packet, .packet = *packet}));
    parts.reception.read(*craft.member(hand));
    for (const Received& each : received(arm)) asked.push_back(each);
  }
  ASSERT_EQ(asked.size(), 2u);
  SupervisorParts& next = go_on();
  begins_to_hear(next);
  for (const Received& each : asked) says(next, arm, each, 7);
  std::vector<int> heard;
  MessageBuffer buffer;
  for (;;) {
    const auto found = played[hand].channel.subsystem_end().receive(buffer);
    if (!found || found->flow == Flow::None) break;
    if (const auto report = pus::TelemetryView::parse(found->message.packet)) heard.push_back(report->subtype());
  }
  EXPECT_THAT(heard, ElementsAre(7, 7));
}

}  // namespace
}  // namespace hirosco::supervisor
