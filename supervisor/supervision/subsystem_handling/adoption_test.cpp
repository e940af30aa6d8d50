// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/adoption.hpp"

#include "supervisor/platform/storage/testing/test_databases.hpp"
#include "supervisor/supervision/testing/adoption_rig.hpp"

/// What a supervisor that goes on for one that died knows of the stops before it, and of those that died with it.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

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

/// There are versions of all.
struct VersionsMeanwhile : AdoptionTest {
  [[nodiscard]] std::expected<bool, StartRefusal> prepare(const descriptor::MissionSubsystem&,
                                                          const std::string&) override {
    return true;
  }
};

TEST_F(VersionsMeanwhile, WhatIsTakenBackBeforeThisOneIsOperationalHasNotDied) {
  start_all(Offline);
  const auto process_ends = [this](SupervisorParts& supervisor) {
    ends[played[arm].process] = {};
    supervisor.replacement.watch(clock.now());
    ends.clear();
    supervisor.replacement.watch(clock.now());
  };
  ASSERT_EQ(parts.replacement.replace(arm, "2", 30s, Call{}).kind, Outcome::Kind::Running);
  parts.replacement.watch(clock.now());
  process_ends(parts);
  ASSERT_TRUE(was_told("ARM runs version 2: CONFIRM within 30 s keeps it"));
  set(arm, Offline);
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = go_on();
  for (int step = 0; step < 2; ++step) next.replacement.watch(clock.now());
  ASSERT_FALSE(next.craft.member(arm)->alive()) << "it has been let go";
  begins_to_hear(next);
  EXPECT_FALSE(was_told("ARM died: exit code 0"));
  process_ends(next);
  EXPECT_TRUE(was_told("ARM runs the mission's own version again"));
  EXPECT_TRUE(next.craft.member(arm)->alive());
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

TEST_F(AdoptionTest, WhoWasPermittedAndDidNotActYetWasStoppedByNobody) {
  start_all(SafeOperational);
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  ASSERT_TRUE(notes.note());
  SupervisorParts& next = go_on();
  EXPECT_EQ(against(next, hand), "");
  EXPECT_TRUE(next.craft.guard.fenced(hand)) << "that permission is void";
}

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

/// How often it was read.
struct CountedReads final : ValueStore {
  explicit CountedReads(ValueStore& store) : inner{store} {}
  TwoCopies read(std::string_view subsystem) override {
    ++reads;
    return inner.read(subsystem);
  }
  void keep(std::string_view subsystem, ValueCopy copy) override { inner.keep(subsystem, std::move(copy)); }
  std::vector<KeptOutcome> take_outcomes() override { return inner.take_outcomes(); }
  ValueStore& inner;
  int reads{0};
};

TEST_F(AdoptionTest, WhoGoesOnReadsStoredValuesInItsFirstStepWhenItsGuardRunsAndNotBefore) {
  descriptor::Parameter gain;
  gain.field.name = "GAIN";
  gain.field.type = Type::Uint16;
  gain.id = 1;
  gain.init = {Number{5}};
  gain.persistent = true;
  next_mission.subsystems[0].subsystem.parameters.push_back(gain);
  start_all(SafeOperational);
  ASSERT_TRUE(notes.note());
  CountedReads counted{values};
  Guard next_guard{{.clock = clock, .flows = flows, .first_epoch = 9000, .on_finding = {}}};
  Supervisor next{{.mission = next_mission,
                   .platform = {clock, memory, flows},
                   .launcher = *this,
                   .guard = next_guard,
                   .log = log,
                   .open_database = [](DatabaseStrategy) { return nullptr; },
                   .observer = *this,
                   .journal = &journal,
                   .values = &counted,
                   .log_readings = &log_readings}};
  next.adopt(false);
  EXPECT_EQ(counted.reads, 0) << "a disk that stands still would hold it up before anybody guards";
  for (int step = 0; step < 3; ++step) {
    wait(1ms);
    static_cast<void>(next.step(clock.now()));
    EXPECT_EQ(counted.reads, 1);
  }
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

}  // namespace
}  // namespace hirosco::supervisor
