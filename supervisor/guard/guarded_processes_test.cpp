// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/testing/guard_rig.hpp"

/// A guard goes on for one that died with its supervisor (docs/adr/0093).
namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::camera;
using testing::GuardTest;
using testing::hand;
using testing::Life;
using namespace std::chrono_literals;

struct GuardAdoption : GuardTest {
  KeeperPage kept;
  Guard next{{.clock = clock, .flows = flows, .first_epoch = 5000, .notes = {mission, kept}, .on_finding = {}}};
  std::map<std::uint16_t, PermitPage*> pages;

  /// The guard before has let go of its flows; this one finds ARM as it is.
  std::string_view adopt(std::uint16_t apid, std::string_view against = {}) {
    const Life& life = lives[apid];
    AdoptedSubsystem adopted;
    adopted.epoch = life.permit->epoch.load();
    adopted.permitted = life.permit->permits(adopted.epoch);
    adopted.stopped = life.permit->stop.load() != 0;
    adopted.launched.vital = life.vital_memory;
    adopted.launched.permit = memory.map(memory.create("page", sizeof(PermitPage)).value(), Access::ReadWrite).value();
    adopted.launched.grip = life.process;
    pages[apid] = new (adopted.launched.permit.octets.data()) PermitPage{};
    for (const auto& described : mission.subsystems)
      if (described.subsystem.id == apid && !next.holds(apid)) {
        EXPECT_TRUE(next.add(described, apid == camera));
      }
    return next.adopt(apid, adopted, against);
  }
  [[nodiscard]] bool permits(std::uint16_t apid) { return pages[apid]->permits(pages[apid]->epoch.load()); }
  void operational(std::uint16_t apid) {
    cycling(apid);
    ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
    run(20ms);
    lives[apid].vital->seen_epoch = lives[apid].permit->epoch.load();
  }
};

TEST_F(GuardAdoption, WhoWasPermittedGoesOnUnderTheEpochThatItHad) {
  operational(hand);
  const auto epoch = lives[hand].permit->epoch.load();
  EXPECT_EQ(adopt(hand), "");
  EXPECT_TRUE(permits(hand));
  EXPECT_EQ(pages[hand]->epoch.load(), epoch);
  static_cast<void>(next.step(clock.now()));
  EXPECT_TRUE(permits(hand));
  lives[hand].vital->state = static_cast<std::uint32_t>(State::SafeOperational);
  static_cast<void>(next.step(clock.now()));
  EXPECT_FALSE(permits(hand)) << "for the stay in Operational that it was given for";
}

TEST_F(GuardAdoption, NobodyWhoWasNotPermittedIsAndNobodyGetsAnEpochBelowTheOneItHad) {
  cycling(hand);
  EXPECT_EQ(adopt(hand), "it was not permitted");
  EXPECT_FALSE(permits(hand));
  EXPECT_GE(pages[hand]->epoch.load(), lives[hand].permit->epoch.load());
}

TEST_F(GuardAdoption, WhatStandsAgainstItStopsItUnderAHigherEpoch) {
  const auto refuse = [&](const char* what, auto change, std::string_view against = {}) {
    lives.erase(hand);
    start(hand);
    operational(hand);
    change();
    const auto epoch = lives[hand].permit->epoch.load();
    EXPECT_EQ(adopt(hand, against), what);
    EXPECT_FALSE(permits(hand)) << what;
    EXPECT_GT(pages[hand]->epoch.load(), epoch) << what;
    EXPECT_EQ(pages[hand]->stop.load(), 1u) << what;
    next.forget(hand);
  };
  refuse("a stop was under way", [] {}, "a stop was under way");
  refuse("it is not Operational",
         [&] { lives[hand].vital->state = static_cast<std::uint32_t>(State::ErrorOperational); });
  refuse("it inhibits its actuators itself", [&] { lives[hand].vital->inhibited = inhibited_by_link; });
  refuse("it has not seen its permit of now", [&] { lives[hand].vital->seen_epoch = 17; });
}

TEST_F(GuardAdoption, OfAPageThatNobodyWroteTheEpochIsNotTakenOver) {
  operational(hand);
  const auto seen = lives[hand].permit->epoch.load();
  // A supervisor between the two died before its guard had written on the page that it had made.
  lives[hand].permit = new (lives[hand].permit_memory.octets.data()) PermitPage{};
  EXPECT_EQ(adopt(hand), "it was not permitted");
  EXPECT_GT(pages[hand]->epoch.load(), seen) << "no device would hear of it";
  ASSERT_TRUE(next.release(hand, next.fences(hand)));
  EXPECT_GT(pages[hand]->epoch.load(), 5000u);
  EXPECT_TRUE(permits(hand));
}

TEST_F(GuardAdoption, WhoCyclesUnpermittedKeepsTheEpochThatItLooksAt) {
  cycling(hand);
  run(20ms);
  const auto epoch = lives[hand].permit->epoch.load();
  ASSERT_EQ(lives[hand].vital->seen_epoch.load(), epoch);
  EXPECT_EQ(adopt(hand), "it was not permitted");
  EXPECT_EQ(pages[hand]->epoch.load(), epoch) << "it looks at its old page for a while, and is not ended for that";
}

TEST_F(GuardAdoption, WhoMayHaveLostItsRealTimeToTheGuardBeforeIsGivenItBackWithItsFirstRelease) {
  cycling(hand);
  adopt(hand);
  lives[hand].process->realtime = false;
  ASSERT_TRUE(next.release(hand, next.fences(hand)));
  EXPECT_TRUE(lives[hand].process->realtime);
  lives[hand].process->realtime = false;
  ASSERT_TRUE(next.release(hand, next.fences(hand)));
  EXPECT_FALSE(lives[hand].process->realtime) << "once: this guard knows what it has taken itself";
}

TEST_F(GuardAdoption, WhoIsStoppedAndPermittedAtOnceIsStopped) {
  operational(hand);
  lives[hand].permit->stop = 1;  // nobody writes both: the page is damaged
  const auto epoch = lives[hand].permit->epoch.load();
  EXPECT_EQ(adopt(hand), "it was stopped");
  EXPECT_FALSE(permits(hand));
  EXPECT_EQ(pages[hand]->stop.load(), 1u);
  EXPECT_GT(pages[hand]->epoch.load(), epoch);
}

TEST_F(GuardAdoption, WhoHasNoPagesOrIsNobodyOfTheMissionIsNotPermitted) {
  AdoptedSubsystem without_pages;
  without_pages.permitted = true;
  without_pages.epoch = 1;
  EXPECT_EQ(next.adopt(hand, without_pages, {}), "it has no pages") << "nobody yet";
  ASSERT_TRUE(next.add(mission.subsystems[1], false));
  EXPECT_EQ(next.adopt(hand, without_pages, {}), "it has no pages");
  EXPECT_FALSE(next.release(hand, next.fences(hand)));
}

TEST_F(GuardAdoption, AStopOfTheGuardBeforeHolds) {
  operational(hand);
  guard.fence(hand);
  EXPECT_EQ(adopt(hand), "it was not permitted");
  EXPECT_FALSE(permits(hand));
  EXPECT_EQ(pages[hand]->stop.load(), 1u);
}

TEST_F(GuardAdoption, APageWithRoomBehindItIsOneAndOneThatIsTooShortIsNone) {
  const auto pages_of = [&](std::size_t vital_octets, std::size_t permit_octets) {
    LaunchedSubsystem launched;
    launched.vital = memory.map(memory.create("page", vital_octets).value(), Access::ReadWrite).value();
    launched.permit = memory.map(memory.create("page", permit_octets).value(), Access::ReadWrite).value();
    new (launched.permit.octets.data()) PermitPage{};
    if (vital_octets >= sizeof(VitalPage)) new (launched.vital.octets.data()) VitalPage{};
    return launched;
  };
  const auto taken = [&](const LaunchedSubsystem& launched) {
    guard.forget(hand);
    guard.started(hand, launched);
    return guard.release(hand, guard.fences(hand));
  };
  EXPECT_TRUE(taken(pages_of(sizeof(VitalPage) + 64, sizeof(PermitPage) + 64)));
  EXPECT_FALSE(taken(pages_of(sizeof(VitalPage) - 1, sizeof(PermitPage))));
  EXPECT_TRUE(taken(pages_of(sizeof(VitalPage), sizeof(PermitPage))));
}

TEST_F(GuardAdoption, AFenceOfItReachesWhoGoesOn) {
  operational(hand);
  ASSERT_EQ(adopt(hand), "");
  next.fence(hand);
  EXPECT_FALSE(permits(hand));
  EXPECT_TRUE(next.fenced(hand));
}

/// Its service loop, which would read of the new page, wants the processor of a busy computer.
TEST_F(GuardAdoption, WhoWasStoppedAndHasNotReadOfItsNewPageYetIsNotTakenForOneWhosePageIsDamaged) {
  operational(hand);
  ASSERT_EQ(adopt(hand, "a stop was under way"), "a stop was under way");
  // Its cycle makes its steps, and sees the epoch of the page before.
  const auto cycles_by = [&](Duration span) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; clock.advance(Guard::period)) {
      next.beat();
      ++lives[hand].vital->cycles;
      ++lives[hand].vital->service_steps;
      static_cast<void>(next.step(clock.now()));
    }
  };
  cycles_by(10s);
  EXPECT_THAT(next.take_findings(), ::testing::IsEmpty()) << "whether that is too long is not the guard's to say";
  EXPECT_FALSE(permits(hand));
  EXPECT_FALSE(lives[hand].process->killed);
  lives[hand].vital->seen_epoch = pages[hand]->epoch.load();
  next.looks_at_its_page(hand);
  cycles_by(1s);
  EXPECT_THAT(next.take_findings(), ::testing::IsEmpty());
  ASSERT_TRUE(next.release(hand, next.fences(hand)));
  cycles_by(1s);
  const auto found = next.take_findings();
  ASSERT_EQ(found.size(), 1U) << "from then on it is to see what is written there";
  EXPECT_EQ(found[0].kind, GuardFinding::Kind::PageDamaged);
}

TEST_F(GuardAdoption, WhoseCycleStandsStillOnTheWayToItsNewPageHangs) {
  operational(hand);
  ASSERT_EQ(adopt(hand, "a stop was under way"), "a stop was under way");
  for (const TimePoint end = clock.now() + 300ms; clock.now() < end; clock.advance(Guard::period)) {
    ++lives[hand].vital->service_steps;
    static_cast<void>(next.step(clock.now()));
  }
  const auto found = next.take_findings();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].kind, GuardFinding::Kind::CycleHangs);
}

TEST_F(GuardTest, WhoseProcessHasEndedIsHeldByNobodyAnyMore) {
  ASSERT_EQ(lives[hand].process.use_count(), 2);
  guard.forget(hand);
  EXPECT_EQ(lives[hand].process.use_count(), 1) << "its number may be another process' by now";
}

TEST_F(GuardTest, WhoIsPermittedAndWhoseDeviceSaysThatItDoesNotActHasStoppedByItself) {
  cycling(arm);
  EXPECT_FALSE(guard.has_stopped_by_itself(99)) << "nobody of the mission";
  ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
  run(20ms, {arm, hand, camera}, std::nullopt);
  EXPECT_FALSE(guard.has_stopped_by_itself(arm)) << "its device has said nothing";
  for (const auto output : {DeviceOutput::Active, DeviceOutput::Stopping, DeviceOutput::Holding, DeviceOutput::Off}) {
    run(20ms, {arm, hand, camera}, output);
    EXPECT_EQ(guard.has_stopped_by_itself(arm), output != DeviceOutput::Active) << static_cast<int>(output);
  }
  guard.fence(arm);
  EXPECT_FALSE(guard.has_stopped_by_itself(arm)) << "the guard stopped it";
}

/// What the guard notes for whoever would go on telling a device in its place.
struct Notes : GuardTest {
  KeeperPage kept;
  std::unique_ptr<DataFlow> device;
  descriptor::Mission noted = [this] {
    auto made = mission;
    made.subsystems[0].subsystem.devices[0].enable->address = "noted-enable";
    return made;
  }();
  Guard notes{{.clock = clock, .flows = flows, .first_epoch = 1000, .notes = {noted, kept}, .on_finding = {}}};

  void SetUp() override {
    GuardTest::SetUp();
    ASSERT_TRUE(notes.add(noted.subsystems[0], false));
    LaunchedSubsystem launched;
    launched.vital = lives[arm].vital_memory;
    launched.permit = lives[arm].permit_memory;
    launched.grip = lives[arm].process;
    notes.started(arm, launched);
    cycling(arm);
  }
};

TEST_F(Notes, SayWhatADeviceWasToldLast) {
  static_cast<void>(notes.step(clock.now()));
  EXPECT_FALSE(kept.inhibits[0].enabled());
  ASSERT_TRUE(notes.release(arm, notes.fences(arm)));
  static_cast<void>(notes.step(clock.now()));
  EXPECT_TRUE(kept.inhibits[0].enabled());
  EXPECT_EQ(kept.inhibits[0].epoch.load(), lives[arm].permit->epoch.load());
}

TEST_F(Notes, OfTheGuardBeforeLetADeviceHearNoNumberAgain) {
  kept.inhibits[0].sequence = 4711;
  descriptor::Mission later = noted;
  later.subsystems[0].subsystem.devices[0].enable->address = "later-enable";
  Guard next{{.clock = clock, .flows = flows, .first_epoch = 1000, .notes = {later, kept}, .on_finding = {}}};
  device = flows.open({Transfer::SharedMemory, "later-enable"}, FlowSide::Device).value();
  ASSERT_TRUE(next.add(later.subsystems[0], false));
  static_cast<void>(next.step(clock.now()));
  std::array<std::byte, enable_frame_octets> frame;
  ASSERT_EQ(device->receive(frame).value().flow, Flow::New);
  EXPECT_EQ(read_enable_command(frame).value().sequence, 4712u) << "what it has heard is no command";
}

TEST_F(Notes, AreVoidWithTheFenceAndNotWithTheNextStep) {
  ASSERT_TRUE(notes.release(arm, notes.fences(arm)));
  static_cast<void>(notes.step(clock.now()));
  notes.fence(arm);
  EXPECT_FALSE(kept.inhibits[0].enabled());
}

}  // namespace
}  // namespace hirosco::supervisor
