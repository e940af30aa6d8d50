// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/testing/guard_rig.hpp"

/// Stops have numbers, and nobody is let go before the supervisor has heard of what stopped it (docs/adr/0156).
namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::camera;
using testing::GuardTest;
using testing::hand;

using enum GuardFinding::Kind;

struct NewestStop : GuardTest {
  [[nodiscard]] std::uint32_t on_page(std::uint16_t apid) { return lives[apid].permit->newest_stop.load(); }
  [[nodiscard]] bool lets_go(std::uint16_t apid) { return guard.release(apid, guard.fences(apid)); }
};

TEST_F(NewestStop, RisesWithEachStopOfEverythingAndWithNoOther) {
  std::uint32_t before = guard.newest_stop();
  EXPECT_NE(before, 0u);
  guard.fence(arm);
  EXPECT_EQ(guard.newest_stop(), before);
  for (const auto& stop : std::initializer_list<std::function<void()>>{
           [&] { guard.stop_all(); }, [&] { guard.stop_all(StopAsked); }, [&] { guard.void_what_was_said(); },
           [&] {  // the supervisor stands still
             clock.advance(2s);
             for (int i = 0; i < 500; ++i) {
               clock.advance(Guard::period);
               static_cast<void>(guard.step(clock.now()));
             }
           }}) {
    stop();
    EXPECT_EQ(guard.newest_stop(), before + 1);
    before = guard.newest_stop();
    for (const std::uint16_t apid : {arm, hand, camera}) EXPECT_EQ(on_page(apid), before) << apid;
  }
  start(hand);
  EXPECT_EQ(on_page(hand), before) << "who is started knows it from the begin on";
}

TEST_F(NewestStop, OfASupervisorThatStandsStillVoidsWhatWasSaidBeforeItOfTheGroundLinkToo) {
  run(20ms);
  const std::uint32_t said_under = guard.newest_stop();
  for (const std::uint16_t apid : {arm, hand, camera}) EXPECT_FALSE(guard.was_stopped_since(apid, said_under)) << apid;
  for (int i = 0; i < 250; ++i) {
    clock.advance(Guard::period);
    static_cast<void>(guard.step(clock.now()));
  }
  ASSERT_EQ(guard.newest_stop(), said_under + 1);
  for (const std::uint16_t apid : {arm, hand, camera}) {
    EXPECT_TRUE(guard.was_stopped_since(apid, said_under)) << apid;
    EXPECT_FALSE(guard.was_stopped_since(apid, guard.newest_stop())) << apid;
  }
}

TEST_F(NewestStop, GoesOnWithTheOneThatTheGuardBeforeHadWritten) {
  for (int i = 0; i < 3; ++i) guard.stop_all();
  Guard next{{.clock = clock, .flows = flows, .first_epoch = 5000, .on_finding = {}}};
  std::map<std::uint16_t, PermitPage*> pages;
  for (const auto& described : mission.subsystems) {
    const std::uint16_t apid = described.subsystem.id;
    if (apid == arm) continue;  // its device listens to the guard before
    ASSERT_TRUE(next.add(described, apid == camera));
    AdoptedSubsystem adopted;
    adopted.launched.vital = lives[apid].vital_memory;
    adopted.launched.permit = memory.map(memory.create("page", sizeof(PermitPage)).value(), Access::ReadWrite).value();
    pages[apid] = new (adopted.launched.permit.octets.data()) PermitPage{};
    if (apid == hand) pages[apid]->newest_stop = on_page(hand);
    static_cast<void>(next.adopt(apid, adopted, {}));
  }
  EXPECT_EQ(next.newest_stop(), guard.newest_stop()) << "what they have said since the last stop is not void by this";
  for (const auto& [apid, page] : pages) EXPECT_EQ(page->newest_stop.load(), guard.newest_stop()) << apid;
}

TEST_F(NewestStop, NobodyIsLetGoBeforeTheSupervisorHasHeardOfWhatStoppedIt) {
  const std::map<std::string, std::function<void()>> ways{
      {"a key", [&] { guard.stop_all(StopAsked); }},
      {"a death", [&] { guard.life_changed(arm); }},
      {"a death of whom it falls with", [&] { guard.life_changed(hand); }},
  };
  for (const auto& [way, stop] : ways) {
    for (const std::uint16_t apid : {arm, hand}) {
      start(apid);
      lives[apid].vital->life = 12;
      guard.life_changed(apid);  // it is held from now on
    }
    guard.falls_with(hand, {arm});
    static_cast<void>(guard.take_findings());
    ASSERT_TRUE(lets_go(arm)) << way;
    for (const std::uint16_t apid : {arm, hand}) lives[apid].vital->life = 0;
    stop();
    EXPECT_FALSE(may_move(arm)) << way;
    cycling(arm);
    run(400ms);  // what stops has stopped
    EXPECT_FALSE(lets_go(arm)) << way;
    static_cast<void>(guard.take_findings());
    EXPECT_TRUE(lets_go(arm)) << way << ": a plan or somebody else decides";
  }
}

TEST_F(NewestStop, NoFindingIsLostBehindAThousandUntakenOnes) {
  for (int i = 0; i < 2'000; ++i) guard.stop_all(StopAsked);
  cycling(arm);
  run(1s, {hand, camera});
  const auto found = guard.take_findings();
  EXPECT_LT(found.size(), 1'100u);
  EXPECT_TRUE(std::ranges::any_of(found, [](const auto& each) { return each.apid == arm && each.kind == CycleHangs; }));
}

}  // namespace
}  // namespace hirosco::supervisor
