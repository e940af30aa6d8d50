// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "supervisor/supervision/testing/adoption_rig.hpp"

/// How ground hears the end of a SAFE_ALL whose supervisor dies: once where it is known that it was not told, and else again, with a mark ahead of it
/// (docs/adr/0243). Whole flights, with a ground link that keeps back the second one: tests/integration.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct EndOfAStop : AdoptionTest {
  static constexpr const char* mark = "END_TOLD_AGAIN";
  std::vector<std::string> said;  ///< to ground, of the end of its stop

  void routed(const pus::TelemetryView& packet) override {
    AdoptionTest::routed(packet);
    if (packet.service() != 1 || packet.destination() != asker || packet.subtype() < 7) return;
    said.push_back("TM[1," + std::to_string(packet.subtype()) + "]");
  }
  void told(OnboardTime at, std::string_view line) override {
    AdoptionTest::told(at, line);
    if (line.find(mark) != std::string_view::npos) said.emplace_back(mark);
  }
  void SetUp() override {
    AdoptionTest::SetUp();
    start_all(Operational);
    start_supervisor();
    craft.remembers = [this] { EXPECT_TRUE(notes.note()); };
    parts.telecommands.take(
        {.packet = telecommand(supervisor_apid, 8, 1, call_data("SAFE_ALL")), .origin = Origin::ground()});
    own_step();
    ASSERT_TRUE(parts.safe_all.under_way());
  }
  /// All have stopped, as the guard of this one sees.
  void all_have_stopped(Guard& sees) {
    for (auto& [apid, member] : played) set(apid, SafeOperational);
    for (const TimePoint end = clock.now() + 1s; clock.now() < end; wait(Guard::period)) {
      sees.beat();
      for (auto& [apid, member] : played) {
        ++member.vital->service_steps;
        member.vital->seen_epoch = member.permit->epoch.load();
      }
      static_cast<void>(sees.step(clock.now()));
    }
  }
  void ends() {
    all_have_stopped(guard);
    parts.safe_all.follow();
    own_step();
  }
  /// Another one goes on, until it is as far as it will get by itself.
  SupervisorParts& goes_on() {
    said.clear();
    story.clear();
    SupervisorParts& next = go_on();
    comes_up(next);
    return next;
  }
  /// It is Operational itself, and ends what was begun.
  void comes_up(SupervisorParts& next) {
    for (const auto& [apid, member] : played) next.adoption.confirmed(apid);
    for (int round = 0; round < 100 && next.adoption.waits(); ++round) speaks(next);
    ASSERT_FALSE(next.adoption.waits());
    ASSERT_EQ(next.own.state(), Operational);
    speaks(next);
  }
  void speaks(SupervisorParts& next) {
    for (int step = 0; step < 5; ++step) {
      wait(1ms);
      next.craft.now = clock.now();
      next.telecommands.forward_durable();
      static_cast<void>(next.own.step(clock.now()));
      next.reception.read_own();
    }
  }
  void stops(SupervisorParts& next) {
    all_have_stopped(nexts.back()->guard);
    next.safe_all.follow();
    speaks(next);
  }
  [[nodiscard]] bool carried_out_again() const {
    return was_told("a stop that the supervisor before had not ended: every actuator inhibited");
  }
  static constexpr std::uint16_t asker = 7;
};

TEST_F(EndOfAStop, IsToldOnceAndWithoutAMarkWhereItHadNoneYet) {
  SupervisorParts& next = goes_on();
  EXPECT_TRUE(carried_out_again());
  EXPECT_THAT(said, IsEmpty());
  stops(next);
  EXPECT_THAT(said, ElementsAre("TM[1,7]"));
}

TEST_F(EndOfAStop, IsNotedBeforeItIsToldAndToldAgainBehindItsMarkWhereItMayHaveLeft) {
  ends();
  EXPECT_THAT(said, ElementsAre("TM[1,7]"));
  SupervisorParts& next = goes_on();
  EXPECT_FALSE(carried_out_again()) << "it had ended: who was let go since goes on";
  EXPECT_FALSE(next.safe_all.under_way());
  EXPECT_THAT(said, ElementsAre(mark, "TM[1,7]"));
  for (const auto& [apid, member] : played)
    EXPECT_EQ(nexts.back()->guard.fenced(apid), apid != camera) << apid << ": it stays stopped";
}

TEST_F(EndOfAStop, IsToldAgainWhereItsSupervisorDiesBetweenTheNoteAndTheReport) {
  int notes_left = 1;
  craft.remembers = [&] {
    if (notes_left-- > 0) {
      EXPECT_TRUE(notes.note());
    }
  };
  all_have_stopped(guard);
  parts.safe_all.follow();
  static_cast<void>(goes_on());
  EXPECT_THAT(said, ElementsAre(mark, "TM[1,7]"));
}

TEST_F(EndOfAStop, IsToldByNobodyMoreOnceItHasLeft) {
  ends();
  parts.safe_all.delivered();
  craft.remember();
  static_cast<void>(goes_on());
  EXPECT_FALSE(carried_out_again());
  EXPECT_THAT(said, IsEmpty());
}

TEST_F(EndOfAStop, IsToldByEachThatGoesOnUntilItHasLeft) {
  ends();
  for (int death = 0; death < 3; ++death) {
    SupervisorParts& next = goes_on();
    EXPECT_THAT(said, ElementsAre(mark, "TM[1,7]")) << death;
    ASSERT_TRUE(next.memory.note());
  }
  nexts.back()->parts.safe_all.delivered();
  ASSERT_TRUE(nexts.back()->parts.memory.note());
  static_cast<void>(goes_on());
  EXPECT_THAT(said, IsEmpty());
}

TEST_F(EndOfAStop, IsOwedAlsoByOneThatDiesBeforeItCanTell) {
  ends();
  said.clear();
  for (int death = 0; death < 3; ++death) ASSERT_TRUE(go_on().memory.note());
  EXPECT_THAT(said, IsEmpty());
  static_cast<void>(goes_on());
  EXPECT_THAT(said, ElementsAre(mark, "TM[1,7]"));
}

TEST_F(EndOfAStop, WithoutAGroundLinkIsOwedToOneThatGoesOnWithOne) {
  parts.safe_all.ground_hears(false);
  ends();
  parts.safe_all.delivered();
  craft.remember();
  static_cast<void>(goes_on());
  EXPECT_THAT(said, ElementsAre(mark, "TM[1,7]"));
}

TEST_F(EndOfAStop, IsToldAgainByTheSameOneWhereItsLinkWasLostBeforeItLeft) {
  ends();
  said.clear();
  parts.safe_all.ground_hears(false);
  parts.safe_all.delivered();
  parts.safe_all.ground_hears(true);
  own_step();
  EXPECT_THAT(said, ElementsAre(mark, "TM[1,7]"));
  parts.safe_all.delivered();
  said.clear();
  parts.safe_all.ground_hears(false);
  parts.safe_all.ground_hears(true);
  own_step();
  EXPECT_THAT(said, IsEmpty());
}

TEST_F(EndOfAStop, ThatWasAFailureIsToldAsThatAgain) {
  for (auto& [apid, member] : played) set(apid, SafeOperational);
  // ARM says nothing of its cycle.
  for (const TimePoint end = clock.now() + 3s; clock.now() < end && parts.safe_all.under_way(); wait(Guard::period)) {
    guard.beat();
    for (auto& [apid, member] : played)
      if (apid != arm) member.vital->seen_epoch = member.permit->epoch.load();
    static_cast<void>(guard.step(clock.now()));
    parts.safe_all.follow();
  }
  own_step();
  ASSERT_EQ(said.size(), 1U);
  const std::string first = said[0];
  static_cast<void>(goes_on());
  EXPECT_THAT(said, ElementsAre(mark, first));
}

TEST_F(EndOfAStop, IsToldOnTheWayDownToo) {
  parts.shutdown.request("the test");
  craft.remember();
  SupervisorParts& next = goes_on();
  ASSERT_TRUE(next.craft.shutting_down);
  stops(next);
  EXPECT_THAT(said, ElementsAre("TM[1,7]"));
}

/// Somebody at the computer stops everything beside ground: each is told as what it is, once.
TEST_F(EndOfAStop, IsToldOnceThoughALocalStopCoincidesWithTheDeathAndThatIsToldToo) {
  said.clear();
  story.clear();
  nexts.push_back(std::make_unique<Next>(*this, 5000));
  SupervisorParts& next = nexts.back()->parts;
  next.craft.now = clock.now();
  next.own.start(next.craft.mode_epoch);
  next.adoption.begin(true);
  comes_up(next);
  stops(next);
  EXPECT_THAT(said, ElementsAre("TM[1,7]"));
  EXPECT_EQ(std::ranges::count_if(story, [](const auto& line) { return line.find("LOCAL_STOP") != std::string::npos; }),
            1);
}

}  // namespace
}  // namespace hirosco::supervisor
