// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_commands.hpp"

#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using enum descriptor::State;

namespace st128 = pus::st128;

/// Link 2 goes from HAND, which provides, to ARM, which requires.
struct LinksTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(PreOperational);
    start_supervisor();
  }
  const std::vector<st128::OfferedField> fields{{"ANGLE", Type::Double, 2}};
  template <class Write, class Value>
  void say(std::uint16_t from, std::uint8_t subtype, Write write, const Value& value) {
    std::array<std::byte, 512> buffer{};
    const auto octets = write(MutableOctets{buffer}, std::uint8_t{2}, value);
    report(from, st128::service_type, subtype, Octets{buffer}.first(octets.value()));
  }
  void says(std::uint16_t from, std::uint8_t subtype, st128::Role role) {
    if (subtype != st128::attached)
      return report(from, st128::service_type, subtype, std::array{std::byte{2}, static_cast<std::byte>(role)});
    std::array<std::byte, 64> buffer{};
    const auto octets = st128::write_attached(buffer, {.role = role, .route = {.link = 2}});
    report(from, st128::service_type, subtype, Octets{buffer}.first(octets.value()));
  }
  void bring_up() {
    EXPECT_EQ(call_own("LINK", 2), "") << "it goes on";
    EXPECT_THAT(texts(arm), ElementsAre("TC[128,1]"));
    say(arm, st128::offer, st128::write_offer,
        st128::Offer{.set = "HAND_STATE", .period = 1ms, .terms = {}, .depth = 0, .fields = fields});
    EXPECT_THAT(texts(hand), ElementsAre("TC[128,2]"));
    say(hand, st128::agreement, st128::write_agreement,
        st128::Agreement{LinkMethod::SharedMemory, descriptor::ByteOrder::Little, LinkKind::Latest, 0, 1ms, 1ms,
                         fields});
    EXPECT_THAT(texts(hand), ElementsAre("TC[128,3]"));
    says(hand, st128::attached, st128::Role::Producer);
    EXPECT_THAT(texts(arm), ElementsAre("TC[128,3]"));
    says(arm, st128::attached, st128::Role::Consumer);
    own_step();
    own_step();
  }
};

TEST_F(LinksTest, LinkLeadsTheHandshakeAndEndsWhenBothAreAttached) {
  bring_up();
  EXPECT_EQ(own_end, "done");
  EXPECT_TRUE(parts.graph.is_up(2));
  EXPECT_TRUE(was_told("link 2 HAND.HAND_STATE -> ARM up: "));
}

TEST_F(LinksTest, ALinkThatTheMissionDoesNotHaveIsRefused) {
  EXPECT_EQ(call_own("LINK", 9), to_text(pus::FailureCode::WrongStatus));
}

TEST_F(LinksTest, WhoRefusesItsTelecommandEndsTheHandshake) {
  EXPECT_EQ(call_own("LINK", 2), "");
  verify(arm, received(arm).front().request, 2, pus::FailureCode::WrongState);
  parts.links.watch(clock.now());
  own_step();
  own_step();
  EXPECT_EQ(own_end, to_text(pus::FailureCode::ExecutionError));
  EXPECT_TRUE(
      was_told("link 2 HAND.HAND_STATE -> ARM down: ARM: " + std::string{to_text(pus::FailureCode::WrongState)}));
}

TEST_F(LinksTest, UnlinkEndsWhenBothHaveLetGo) {
  bring_up();
  own_end.clear();
  EXPECT_EQ(call_own("UNLINK", 2), "");
  EXPECT_THAT(texts(arm), ElementsAre("TC[128,4]"));
  EXPECT_THAT(texts(hand), ElementsAre("TC[128,4]"));
  says(arm, st128::detached, st128::Role::Consumer);
  parts.links.watch(clock.now());
  own_step();
  own_step();
  EXPECT_EQ(own_end, "") << "one of them still holds it";
  EXPECT_FALSE(parts.graph.is_up(2));
  says(hand, st128::detached, st128::Role::Producer);
  own_step();
  own_step();
  EXPECT_EQ(own_end, "done");
}

/// UNLINK of link 2 under way, and ARM has let go of it.
struct HalfOfAnUnlink : LinksTest {
  void SetUp() override {
    LinksTest::SetUp();
    bring_up();
    own_end.clear();
    EXPECT_EQ(call_own("UNLINK", 2), "");
    detach = received(hand).front().request;
    static_cast<void>(texts(arm));
    says(arm, st128::detached, st128::Role::Consumer);
  }
  /// How it has ended by now.
  std::string end() {
    parts.links.watch(clock.now());
    own_step();
    own_step();
    return std::exchange(own_end, {});
  }
  std::uint32_t detach{};
};

TEST_F(HalfOfAnUnlink, EndsWhenTheOtherEndIsOfflineThoughItSaidNothing) {
  EXPECT_EQ(end(), "");
  set(hand, Offline);
  EXPECT_EQ(end(), "done");
}

TEST_F(HalfOfAnUnlink, EndsWhenTheOtherEndIsConfiguredForSomethingElse) {
  set(hand, PreOperational, 2);
  EXPECT_EQ(end(), "done");
}

TEST_F(HalfOfAnUnlink, EndsWhenTheOtherEndDies) {
  ends[played[hand].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  EXPECT_EQ(end(), "done");
}

TEST_F(HalfOfAnUnlink, FailsWhenTheOtherEndRefuses) {
  verify(hand, detach, 4, pus::FailureCode::UnknownIdentifier);
  EXPECT_EQ(end(), "execution error: an end has not let go of link 2");
}

TEST_F(HalfOfAnUnlink, FailsInTimeWhenTheOtherEndSaysNothing) {
  EXPECT_EQ(end(), "");
  wait(2100ms);
  EXPECT_EQ(end(), "timeout: an end has not let go of link 2");
}

TEST_F(HalfOfAnUnlink, RefusesALinkMeanwhileAndSaysWhy) {
  std::string how;
  parts.own_telecommands.command(supervisor_apid, "LINK", 2,
                                 [&](bool success, const std::string& why) { how = success ? "done" : why; });
  for (int step = 0; step < 50 && how.empty(); ++step) own_step();
  EXPECT_EQ(how, "wrong status: an end has not let go since UNLINK of link 2");
  const auto reason = pus::reason_in(Octets{last_routed[1]}.subspan(6));
  ASSERT_TRUE(reason);
  EXPECT_EQ(reason->text, "an end has not let go since UNLINK of link");
  EXPECT_EQ(reason->number, 2);
  says(hand, st128::detached, st128::Role::Producer);
  EXPECT_EQ(end(), "done");
  bring_up();
  EXPECT_EQ(own_end, "done");
}

TEST_F(LinksTest, WhatIsNotUpCannotBeTakenDown) {
  EXPECT_EQ(call_own("UNLINK", 2), to_text(pus::FailureCode::WrongStatus));
}

TEST_F(LinksTest, TheLinksOfWhoIsGoneAreDown) {
  bring_up();
  parts.links.forget(hand);
  EXPECT_FALSE(parts.graph.is_up(2));
  EXPECT_TRUE(was_told("link 2 HAND.HAND_STATE -> ARM down: "));
}

/// HAND and ARM are joined by link 2, and HAND alone says that it has left.
struct LinkOfWhichOneEndHasLeft : LinksTest {
  void SetUp() override {
    LinksTest::SetUp();
    bring_up();
    for (const std::uint16_t apid : {arm, hand}) set(apid, Operational);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    says(hand, st128::detached, st128::Role::Producer);
    ASSERT_FALSE(parts.graph.is_up(2));
  }
  void dies(std::uint16_t apid) {
    ends[played[apid].process] = {.by_signal = true, .value = 9};
    parts.processes.watch(clock.now());
    ends.clear();
  }
  void look() {
    wait(10ms);
    parts.links.watch(clock.now());
  }
};

TEST_F(LinkOfWhichOneEndHasLeft, TheDeathOfThatEndFencesTheOneThatHoldsOn) {
  look();
  dies(hand);
  EXPECT_TRUE(guard.fenced(arm));
  EXPECT_TRUE(was_told("network {ARM, HAND} to ErrorOperational and down"));
}

TEST_F(LinkOfWhichOneEndHasLeft, TheDeathOfTheOneThatHoldsOnFencesThatEnd) {
  ASSERT_TRUE(guard.release(hand, guard.fences(hand)));
  dies(arm);
  EXPECT_TRUE(guard.fenced(hand));
}

TEST_F(LinkOfWhichOneEndHasLeft, OnceBothHaveSaidSoADeathHarmsNobodyElse) {
  says(arm, st128::detached, st128::Role::Consumer);
  dies(hand);
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(LinkOfWhichOneEndHasLeft, OnceEitherIsOfflineADeathHarmsNobodyElse) {
  set(hand, Offline);
  look();
  set(hand, Operational);
  dies(hand);
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(LinkOfWhichOneEndHasLeft, OnceItIsConfiguredForSomethingElseADeathHarmsNobodyElse) {
  set(hand, PreOperational, 0);
  look();
  EXPECT_THAT(parts.graph.network_of(arm), ElementsAre(arm, hand)) << "without a configuration it may come back";
  set(hand, Operational, 2);
  look();
  dies(hand);
  EXPECT_FALSE(guard.fenced(arm));
}

TEST_F(LinkOfWhichOneEndHasLeft, WhoDiedAndWasStartedAnewIsJoinedToNobody) {
  dies(hand);
  ASSERT_TRUE(parts.restarts.plan(hand, {.limit = 1, .within = 60s, .pause = 1ms}, clock.now()));
  wait(1ms);
  parts.processes.watch(clock.now());
  ASSERT_TRUE(craft.member(hand)->alive());
  EXPECT_THAT(parts.graph.network_of(hand), ElementsAre(hand));
  EXPECT_THAT(parts.graph.network_of(arm), ElementsAre(arm));
}

TEST_F(LinkOfWhichOneEndHasLeft, MadeAnewItIsHeldByBothUntilBothHaveSaidSoAgain) {
  for (const std::uint16_t apid : {arm, hand}) set(apid, PreOperational);
  own_end.clear();
  static_cast<void>(texts(arm));
  bring_up();
  says(arm, st128::detached, st128::Role::Consumer);
  look();
  EXPECT_THAT(parts.graph.network_of(arm), ElementsAre(arm, hand));
  says(hand, st128::detached, st128::Role::Producer);
  EXPECT_THAT(parts.graph.network_of(arm), ElementsAre(arm));
}

}  // namespace
}  // namespace hirosco::supervisor
