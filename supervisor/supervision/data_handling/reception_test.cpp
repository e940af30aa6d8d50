// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/reception.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct ReceptionTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    for (const std::uint16_t apid : {arm, hand}) ASSERT_TRUE(guard.release(apid, guard.fences(apid)));
  }
  void send(std::uint16_t from, MessageKind kind, Octets octets) {
    ASSERT_TRUE(played[from].channel.subsystem_end().send({.kind = kind, .packet = octets}));
  }
  void read(std::uint16_t from) { parts.reception.read(*craft.member(from)); }
  [[nodiscard]] std::uint32_t unreadable(std::uint16_t apid) { return craft.member(apid)->unreadable; }
  const std::vector<std::byte> ping = telecommand(arm, 17, 1, {});
};

TEST_F(ReceptionTest, OnlyTheGroundLinkBringsWhatGroundSent) {
  send(hand, MessageKind::GroundTelecommand, ping);
  read(hand);
  EXPECT_THAT(texts(arm), IsEmpty());
  EXPECT_EQ(unreadable(hand), 1U);
  send(camera, MessageKind::GroundTelecommand, ping);
  read(camera);
  EXPECT_THAT(texts(arm), ElementsAre("TC[17,1]"));
}

TEST_F(ReceptionTest, DamageIsCountedAndWhatFollowsIsRead) {
  const std::array damaged{std::byte{1}, std::byte{2}};
  send(hand, MessageKind::Packet, damaged);
  report(hand, 17, 2, {});
  EXPECT_EQ(unreadable(hand), 1U);
  EXPECT_THAT(routed_services, ElementsAre(17));
}

TEST_F(ReceptionTest, WhatCouldNotBeReadIsToldOnceASecondWithItsCountTheLastOfADeadOneAtOnce) {
  const std::array damaged{std::byte{1}};
  Member& member = *craft.member(hand);
  const auto damage = [&](int times) {
    for (int i = 0; i < times; ++i) send(hand, MessageKind::Packet, damaged);
    read(hand);
    parts.reception.tell_unreadable(member);
  };
  damage(1);
  damage(2);
  EXPECT_THAT(story, ::testing::Contains("HAND: 1 messages could not be read"));
  EXPECT_FALSE(was_told("HAND: 2 messages"));
  wait(1s);
  damage(1);
  EXPECT_TRUE(was_told("HAND: 3 messages could not be read"));
  damage(1);
  parts.reception.tell_last_unreadable(member);
  EXPECT_EQ(story.back(), "HAND: 1 messages could not be read");
}

/// Its peer was built apart.
struct ForeignChannel final : Channel {
  Result<> send(const Message&) override { return ok(); }
  Result<Found> receive(MessageBuffer&) override {
    if (said++ > 0) return Found{};
    return fail(ErrorCode::Mismatch, "another version; build both from one hirosco", 2);
  }
  int said{0};
};

TEST_F(ReceptionTest, WhoSpeaksAnotherVersionIsRefusedByNameAndItIsToldWhatToDo) {
  Member& member = *craft.member(hand);
  auto launched = launch(member.described()).value();
  launched.port =
      std::make_unique<LocalMemberPort>(std::make_unique<ForeignChannel>(), launched.vital, launched.permit);
  member.started(std::move(launched));
  read(hand);
  parts.reception.tell_unreadable(member);
  EXPECT_EQ(story.back(), "HAND: 1 messages could not be read: another version; build both from one hirosco (2)");
}

TEST_F(ReceptionTest, WhoCanBeNeitherCommandedNorHeardIsStoppedAtOnce) {
  ASSERT_FALSE(guard.fenced(hand));
  played[hand].channel.close_subsystem_end();
  read(hand);
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_EQ(craft.member(hand)->closed_at, clock.now());
  EXPECT_FALSE(guard.fenced(arm));
}

/// One message could not be read; those behind it can.
struct DamagedChannel final : Channel {
  explicit DamagedChannel(std::unique_ptr<Channel> rest) : rest_{std::move(rest)} {}
  Result<> send(const Message& message) override { return rest_->send(message); }
  Result<Found> receive(MessageBuffer& buffer) override {
    if (std::exchange(damaged_, false)) return fail(ErrorCode::Malformed, "message of the control channel");
    return rest_->receive(buffer);
  }

 private:
  std::unique_ptr<Channel> rest_;
  bool damaged_{true};
};

TEST_F(ReceptionTest, WhoseMessageTheChannelCannotReadIsHeardOnAndNeitherClosedNorStopped) {
  Member& member = *craft.member(hand);
  auto launched = launch(member.described()).value();
  auto rest = std::make_unique<PlayedMember::End>(played[hand].channel);
  launched.port = std::make_unique<LocalMemberPort>(std::make_unique<DamagedChannel>(std::move(rest)), launched.vital,
                                                    launched.permit);
  guard.started(hand, launched);
  member.started(std::move(launched));
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  report(hand, 17, 2, {});
  EXPECT_EQ(unreadable(hand), 1U);
  EXPECT_THAT(routed_services, ElementsAre(17));
  EXPECT_EQ(member.closed_at, std::nullopt);
  EXPECT_FALSE(guard.fenced(hand));
}

/// The operating system has taken its socket.
struct LostChannel final : Channel {
  explicit LostChannel(int& looked) : looked_{looked} {}
  Result<> send(const Message&) override { return fail(ErrorCode::SystemFailure, "send on control channel"); }
  Result<Found> receive(MessageBuffer&) override {
    ++looked_;
    return fail(ErrorCode::SystemFailure, "receive on control channel");
  }

 private:
  int& looked_;
};

TEST_F(ReceptionTest, AChannelThatTheSystemRefusesThriceInARowIsClosedAndTriedOnceAStep) {
  Member& member = *craft.member(hand);
  int looked = 0;
  auto launched = launch(member.described()).value();
  launched.port =
      std::make_unique<LocalMemberPort>(std::make_unique<LostChannel>(looked), launched.vital, launched.permit);
  member.started(std::move(launched));
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  for (int step = 1; step <= 2; ++step) {
    read(hand);
    EXPECT_EQ(looked, step) << "more would take the time of all others";
    EXPECT_FALSE(guard.fenced(hand));
  }
  read(hand);
  EXPECT_TRUE(guard.fenced(hand));
  EXPECT_EQ(member.closed_at, clock.now());
  EXPECT_EQ(unreadable(hand), 3U);
}

TEST_F(ReceptionTest, TheGroundWaitsWhileItsTelecommandsAreNotAnswered) {
  const Member& ground = *craft.member(camera);
  for (std::uint16_t count = 0; count < 128; ++count) {
    EXPECT_TRUE(parts.reception.reads(ground)) << count;
    parts.telecommands.take({.packet = ping, .origin = Origin::ground()});
    if (count == 0) verify(arm, pus::TelecommandView::parse(ping)->request_id(), 7, {}, 7);
  }
  parts.telecommands.take({.packet = ping, .origin = Origin::ground()});
  EXPECT_FALSE(parts.reception.reads(ground));
  EXPECT_TRUE(parts.reception.reads(*craft.member(hand))) << "what members say is read";
  wait(1ms);
  EXPECT_TRUE(parts.reception.reads(ground)) << "the addressee stands still, and SAFE_ALL may be behind it";
}

// --- what was said before a stop --------------------------------------------------------------------------------------------

struct SaidBeforeAStop : ReceptionTest {
  const std::vector<std::byte> go = telecommand(arm, 8, 1, call_data("SET_STATE", static_cast<int>(Operational)));

  void SetUp() override {
    ReceptionTest::SetUp();
    for (const auto& link : craft.mission.links) parts.graph.set_up(link.id, true);
    set(arm, SafeOperational, 2);
    guard.fence(arm);
  }
  [[nodiscard]] std::uint32_t number_on_page(std::uint16_t apid) { return played[apid].permit->newest_stop.load(); }
  /// Whether the arm is let go by what ground said when this was the newest stop that its link knew, which is read now.
  [[nodiscard]] bool lets_go(std::uint32_t known) {
    static_cast<void>(played[camera].channel.subsystem_end().send(
        {.kind = MessageKind::GroundTelecommand, .epoch = known, .packet = go}));
    read(camera);
    return !guard.fenced(arm);
  }
  /// The guard looks, and all live and obey.
  void guard_looks(Duration span, bool supervisor_beats) {
    for (const TimePoint end = clock.now() + span; clock.now() < end; wait(Guard::period)) {
      if (supervisor_beats) guard.beat();
      for (auto& [apid, member] : played) {
        ++member.vital->cycles;
        ++member.vital->service_steps;
        member.vital->seen_epoch = member.permit->epoch.load();
      }
      static_cast<void>(guard.step(clock.now()));
    }
  }
};

TEST_F(SaidBeforeAStop, WithoutOneItLetsGo) {
  EXPECT_TRUE(lets_go(number_on_page(camera)));
  guard.fence(arm);
  EXPECT_TRUE(lets_go(0)) << "where nothing was stopped nobody has to know of a stop";
}

TEST_F(SaidBeforeAStop, AMotionThatSomebodySaidBeforeItIsNotCarriedOutWhenAnotherHasLetGo) {
  set(arm, Operational, 2);
  const auto move = telecommand(arm, 8, 1, call_data("MOVE_TO"));
  const auto asked = telecommand(arm, 17, 1, {});
  const auto say = [&](Octets packet, std::uint32_t known) {
    static_cast<void>(played[camera].channel.subsystem_end().send(
        {.kind = MessageKind::GroundTelecommand, .epoch = known, .packet = packet}));
    read(camera);
    return texts(arm);
  };
  const std::uint32_t before = number_on_page(camera);
  EXPECT_THAT(say(move, before), ElementsAre("MOVE_TO"));
  parts.safe_all.carry_out({});
  guard_looks(1s, true);
  set(arm, SafeOperational, 2);
  ASSERT_TRUE(lets_go(number_on_page(camera)));
  set(arm, Operational, 2);
  static_cast<void>(texts(arm));
  EXPECT_THAT(say(move, before), IsEmpty());
  EXPECT_THAT(say(move, 0), IsEmpty());
  EXPECT_THAT(say(asked, 0), ElementsAre("TC[17,1]")) << "a look harms nobody";
  EXPECT_THAT(say(move, number_on_page(camera)), ElementsAre("MOVE_TO"));
}

TEST_F(SaidBeforeAStop, WhoWasNotStoppedHearsWhatIsForItWhateverNumberItWasSaidUnder) {
  set(arm, Operational, 2);
  const auto move = telecommand(arm, 8, 1, call_data("MOVE_TO"));
  const std::uint32_t before = number_on_page(camera);
  guard.void_what_was_said();  // as behind a supervisor that died, where anybody else was stopped
  static_cast<void>(played[camera].channel.subsystem_end().send(
      {.kind = MessageKind::GroundTelecommand, .epoch = before, .packet = move}));
  read(camera);
  EXPECT_THAT(texts(arm), ElementsAre("MOVE_TO"));
  set(arm, SafeOperational, 2);
  EXPECT_FALSE(lets_go(before));
}

TEST_F(SaidBeforeAStop, ItLetsNobodyGoHoweverLateItIsReadAndWhatIsSaidSinceDoes) {
  const std::uint32_t before = number_on_page(camera);
  parts.safe_all.carry_out({});
  guard_looks(1s, true);
  EXPECT_FALSE(lets_go(before));
  EXPECT_FALSE(lets_go(0)) << "who does not know of any stop may have spoken before it";
  EXPECT_TRUE(lets_go(number_on_page(camera)));
}

TEST_F(SaidBeforeAStop, OfAKeyThatIsPressedBesideTheSupervisorToo) {
  const std::uint32_t before = number_on_page(camera);
  guard.stop_all(GuardFinding::Kind::StopAsked);
  guard_looks(1s, true);
  EXPECT_FALSE(lets_go(before));
  EXPECT_FALSE(lets_go(number_on_page(camera))) << "the supervisor is still to hear of it";
  parts.processes.take_guard_findings();
  guard_looks(1s, true);
  EXPECT_TRUE(lets_go(number_on_page(camera)));
}

TEST_F(SaidBeforeAStop, OfTheSupervisorThatStoodStillInTheMiddleOfItsStepToo) {
  guard_looks(20ms, true);
  const std::uint32_t before = number_on_page(camera);
  guard_looks(Guard::supervisor_limit + 20ms, false);
  EXPECT_FALSE(lets_go(before));
  EXPECT_FALSE(lets_go(number_on_page(camera))) << "the stop is not heard of yet";
  const std::uint64_t fences = guard.fences(arm);
  parts.processes.take_guard_findings();
  EXPECT_TRUE(was_told("the supervisor itself stood still"));
  EXPECT_GT(guard.fences(arm), fences) << "what was begun in that step knows of no fence of after it";
  EXPECT_FALSE(lets_go(before));
  guard_looks(20ms, true);
  EXPECT_TRUE(lets_go(number_on_page(camera)));
}

TEST_F(SaidBeforeAStop, EachMemberIsToldItsNumberAndDamageOfThatDoesNotLast) {
  parts.safe_all.carry_out({});
  for (const auto& [apid, member] : played) EXPECT_EQ(number_on_page(apid), guard.newest_stop()) << apid;
  played[camera].permit->newest_stop = 77;
  guard_looks(Guard::period, true);
  EXPECT_EQ(number_on_page(camera), guard.newest_stop());
}

}  // namespace
}  // namespace hirosco::supervisor
