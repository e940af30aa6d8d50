// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <string>

#include "supervisor/supervision/testing/parts_rig.hpp"

/// The time of a link that is held over runs out while the mode changes (docs/adr/0242). ARM acts in COUPLED on the set of HAND, which says nothing
/// any more, and could do without it in ALONE; LAMP has nothing to do with either. Whole flights: tests/integration/link_losses_test.cpp.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using enum descriptor::State;

constexpr std::uint16_t lamp = 13;
constexpr std::uint8_t into_arm = 2;
constexpr std::uint8_t alone = 1, coupled = 2;  // configurations
constexpr int by_itself = 3, lit = 4;  // modes
constexpr Duration held_for = 700ms;

descriptor::Mission held_mission() {
  auto made = parts_mission();
  made.links = {made.links[1]};
  made.links[0].on_loss = descriptor::OnLoss::Hold;
  made.links[0].hold = held_for;
  auto another = made.subsystems[1];
  another.subsystem.name = "LAMP";
  another.subsystem.id = lamp;
  made.subsystems.push_back(another);
  descriptor::Configuration without;
  without.name = "ALONE";
  without.id = alone;
  made.subsystems[0].subsystem.configurations.push_back(without);
  descriptor::Mode mode;
  mode.name = "by_itself";
  mode.id = by_itself;
  mode.commission = {{.subsystem = "ARM", .configuration = "ALONE", .state = Operational, .at = {}},
                     {.subsystem = "HAND", .configuration = "ONLY", .state = Operational, .at = {}},
                     {.subsystem = "LAMP", .configuration = "ONLY", .state = Operational, .at = {}}};
  made.modes.push_back(mode);
  mode.name = "lit";
  mode.id = lit;
  mode.commission[0].configuration = "COUPLED";
  mode.establish = {into_arm};
  made.modes.push_back(mode);
  return made;
}

struct HeldInAChange : PartsTest {
  HeldInAChange() : PartsTest{held_mission()} {}
  void SetUp() override {
    PartsTest::SetUp();
    start_all(SafeOperational);
    start_supervisor();
    set(arm, Operational, coupled);
    set(hand, Operational);
    for (const std::uint16_t apid : {arm, hand}) {
      static_cast<void>(guard.release(apid, guard.fences(apid)));
      craft.member(apid)->fences_when_free = guard.fences(apid);
    }
    parts.graph.set_up(into_arm, true);
    judges(link_stale);
    watch();
    ASSERT_TRUE(was_told("ARM has lost HAND_STATE of HAND: hold"));
  }
  /// Everything anew, as nothing had happened.
  static void again(auto* self) {
    self->TearDown();
    std::destroy_at(self);
    std::construct_at(self);
    self->SetUp();
  }
  void judges(LinkJudgement judgement) {
    played[arm].vital->incoming[0].link = into_arm;
    played[arm].vital->judged[0] = judgement;
  }
  void watch() { parts.losses.watch(clock.now()); }
  void time_is_over() {
    wait(held_for);
    watch();
  }
  void begin(int mode) {
    parts.own_telecommands.command(supervisor_apid, "SET_MODE", mode,
                                   [this](bool success, const std::string& why) { end = success ? "done" : why; });
    for (int step = 0; step < 40 && craft.changing_to == nullptr && end.empty(); ++step) own_step();
  }
  /// So many telecommands are obeyed, one after another; whoever comes next has been told, and has not answered. False: there is no such.
  bool obey(int number) {
    for (int obeyed = 0;; ++obeyed) {
      for (int step = 0; step < 5; ++step) own_step();
      for (const std::uint16_t apid : {arm, hand, lamp})
        for (const Received& each : received(apid)) open[apid].push_back(each);
      const auto next = std::ranges::find_if(open, [](const auto& entry) { return !entry.second.empty(); });
      if (next == open.end()) return false;
      if (obeyed == number) return true;
      answer(next->first);
      watch();
    }
  }
  void answer(std::uint16_t apid) {
    const Received each = open[apid].front();
    open[apid].erase(open[apid].begin());
    const auto argument = [&] { return std::stoi(each.text.substr(each.text.find(' ') + 1)); };
    if (each.text.starts_with("SET_STATE "))
      set(apid, static_cast<State>(argument()), craft.member(apid)->configuration());
    if (each.text.starts_with("CONFIGURE ")) played[apid].vital->configuration = static_cast<std::uint8_t>(argument());
    verify(apid, each.request, 7);
  }
  [[nodiscard]] bool acts(std::uint16_t apid) {
    return craft.member(apid)->state() == Operational && played[apid].permit->stop.load() == 0;
  }
  std::map<std::uint16_t, std::vector<Received>> open;  ///< that nobody has answered
  std::string end;  ///< of the change
  static constexpr int all = 1000;
};

TEST_F(HeldInAChange, DoesNotEndOneWhoseModeDoesWithoutItAtWhicheverStepItsTimeIsOver) {
  int steps = 0;
  for (bool under_way = true; under_way; ++steps) {
    SCOPED_TRACE(steps);
    again(this);
    begin(by_itself);
    ASSERT_NE(craft.changing_to, nullptr) << end;
    under_way = obey(steps);
    time_is_over();
    EXPECT_FALSE(craft.member(arm)->configuration() == coupled && acts(arm)) << "it acts with what is lost";
    static_cast<void>(obey(all));
    EXPECT_EQ(end, "done");
    EXPECT_EQ(craft.mode->name, "by_itself");
    EXPECT_EQ(craft.changing_to, nullptr);
    for (const std::uint16_t apid : {arm, hand, lamp}) EXPECT_TRUE(acts(apid)) << apid;
    EXPECT_FALSE(craft.member(arm)->recovery.running());
    ASSERT_LT(steps, 50);
  }
  EXPECT_GT(steps, 10);
}

TEST_F(HeldInAChange, StopsWhoIsStillActingAtItsTimeAndSaysSo) {
  begin(by_itself);
  EXPECT_TRUE(acts(arm));
  time_is_over();
  EXPECT_FALSE(acts(arm));
  EXPECT_TRUE(was_told("ARM: HAND_STATE did not come back in time: it is stopped, and the change of mode goes on"));
}

TEST_F(HeldInAChange, LetsNobodyGoWhomSomebodyElseHasStoppedBesides) {
  for (const bool before : {true, false}) {
    SCOPED_TRACE(before ? "before it" : "behind it");
    again(this);
    begin(by_itself);
    if (before) guard.fence(arm);
    time_is_over();
    if (!before) guard.fence(arm);
    static_cast<void>(obey(all));
    EXPECT_FALSE(acts(arm));
    EXPECT_NE(end, "done");
    EXPECT_EQ(craft.mode->name, "open");
    EXPECT_EQ(craft.changing_to, nullptr);
  }
}

TEST_F(HeldInAChange, EndsOneWhoseModeNeedsItAtWhicheverStepItsTimeIsOverAndNamesTheLink) {
  int steps = 0;
  for (bool under_way = true; under_way; ++steps) {
    SCOPED_TRACE(steps);
    again(this);
    begin(lit);
    ASSERT_TRUE(was_told("moves LAMP")) << "and nobody else";
    under_way = obey(steps);
    const bool entered = craft.changing_to == nullptr;
    EXPECT_EQ(entered, !under_way);
    time_is_over();
    static_cast<void>(obey(all));
    EXPECT_EQ(end, entered ? "done" : "execution error: mode lit not reached: link 2; hirosco log");
    EXPECT_EQ(craft.mode->name, entered ? "lit" : "open");
    EXPECT_EQ(craft.changing_to, nullptr);
    EXPECT_FALSE(acts(arm));
    EXPECT_EQ(acts(lamp), entered) << "who was moved is stopped";
    EXPECT_EQ(craft.member(arm)->state(), Offline) << "with its own network";
    EXPECT_EQ(was_told("the change to mode lit stopped: link 2: ARM: HAND_STATE did not come back in time"), !entered);
    ASSERT_LT(steps, 50);
  }
  EXPECT_GT(steps, 4);
}

TEST_F(HeldInAChange, IsOverForWhoIsBeyondItsStopAndWhatItMissesThenIsAnotherLoss) {
  begin(by_itself);
  ASSERT_TRUE(obey(3));
  ASSERT_NE(craft.member(arm)->state(), Operational);
  watch();
  // As it would be in a mode that makes the link again, and still nothing comes.
  set(arm, Operational, coupled);
  wait(held_for);
  story.clear();
  watch();
  EXPECT_TRUE(was_told("ARM has lost HAND_STATE of HAND: hold")) << "it has its whole time";
  EXPECT_NE(craft.changing_to, nullptr);
  time_is_over();
  EXPECT_EQ(craft.changing_to, nullptr);
  EXPECT_TRUE(was_told("the change to mode by_itself stopped: link 2: ARM: HAND_STATE did not come back in time"));
  EXPECT_EQ(craft.mode->name, "open");
}

TEST_F(HeldInAChange, IsBackInItsTimeAsIfNothingHadHappened) {
  begin(lit);
  ASSERT_TRUE(obey(1));
  judges(link_valid);
  watch();
  time_is_over();
  static_cast<void>(obey(all));
  EXPECT_EQ(end, "done");
  for (const std::uint16_t apid : {arm, hand, lamp}) EXPECT_TRUE(acts(apid)) << apid;
}

}  // namespace
}  // namespace hirosco::supervisor
