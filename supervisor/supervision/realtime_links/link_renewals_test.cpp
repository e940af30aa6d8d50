// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_renewals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using enum descriptor::State;

namespace st128 = pus::st128;

/// Link 2 goes from HAND, which provides, to ARM, which requires. Configuration 1 of both has the set, and 2 of HAND has it, too, or not.
struct LinkRenewalsTest : ::testing::Test {
  LinkRenewals renewals;
  descriptor::MissionLink link;
  descriptor::SubsystemDescriptor hand_described, arm_described;
  LinkRenewals::End from, to;

  void SetUp() override {
    link.id = 2;
    link.from = "HAND";
    link.to = "ARM";
    link.provides = "STATE";
    link.requires_ = "WANTED";
    for (const std::uint8_t id : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}}) {
      descriptor::Configuration provider, requirer;
      provider.name = requirer.name = "C" + std::to_string(id);
      provider.id = requirer.id = id;
      if (id != 3) provider.provides.emplace_back().name = "STATE";
      if (id != 3) requirer.requires_.emplace_back().name = "WANTED";
      hand_described.configurations.push_back(std::move(provider));
      arm_described.configurations.push_back(std::move(requirer));
    }
    from = {.described = &hand_described, .there = true, .settled = true, .configuration = 0};
    to = {.described = &arm_described, .there = true, .settled = true, .configuration = 1};
    renewals.left(2, arm);
  }
  LinkRenewals::Next judge() { return renewals.judge(link, from, to).next; }
};
using Next = LinkRenewals::Next;

TEST_F(LinkRenewalsTest, WaitForAConfigurationInForceAtBothEnds) {
  EXPECT_EQ(judge(), Next::Wait);
  from.configuration = 2;
  from.settled = false;
  EXPECT_EQ(judge(), Next::Wait) << "on its way";
  from.settled = true;
  EXPECT_EQ(judge(), Next::Establish);
}

TEST_F(LinkRenewalsTest, AreTriedOnceForAPairOfConfigurations) {
  from.configuration = 2;
  EXPECT_EQ(judge(), Next::Establish);
  EXPECT_EQ(judge(), Next::Wait);
  from.configuration = 1;
  EXPECT_EQ(judge(), Next::Establish) << "another one";
  from.configuration = 0;
  EXPECT_EQ(judge(), Next::Wait);
  from.configuration = 1;
  EXPECT_EQ(judge(), Next::Establish) << "left and taken again";
}

TEST_F(LinkRenewalsTest, AreRefusedWithTheNameOfWhatIsLacking) {
  from.configuration = 3;
  EXPECT_EQ(renewals.judge(link, from, to).why, "configuration C3 of HAND does not provide STATE");
  from.configuration = 1;
  to.configuration = 3;
  const auto judged = renewals.judge(link, from, to);
  EXPECT_EQ(judged.next, Next::Refused);
  EXPECT_EQ(judged.why, "configuration C3 of ARM does not require WANTED");
  to.configuration = 1;
  EXPECT_EQ(judge(), Next::Establish) << "it waits for a configuration that has it";
}

TEST_F(LinkRenewalsTest, AreOverWhenAnEndIsGoneOrTheLinkIsSomebodyElsesMatter) {
  from.there = false;
  EXPECT_EQ(judge(), Next::Over);
  from.there = true;
  from.configuration = 1;
  renewals.drop(2);
  EXPECT_EQ(judge(), Next::Wait);
  EXPECT_FALSE(renewals.waits(2));
}

TEST_F(LinkRenewalsTest, KnowWhoHoldsOnUntilItHasLetGo) {
  EXPECT_EQ(renewals.holder(2), arm);
  renewals.let_go(2, hand);
  EXPECT_EQ(renewals.holder(2), arm);
  renewals.let_go(2, arm);
  EXPECT_EQ(renewals.holder(2), 0);
  EXPECT_TRUE(renewals.waits(2));
}

/// The same in the supervisor: HAND leaves its configuration while link 2 is up.
struct RenewedLinks : PartsTest {
  const std::vector<st128::OfferedField> fields{{"ANGLE", Type::Double, 2}};
  void SetUp() override {
    PartsTest::SetUp();
    for (auto& member : craft.mission.subsystems)
      if (member.subsystem.name == "HAND")
        member.subsystem.configurations[0].provides.emplace_back().name = "HAND_STATE";
    start_all(PreOperational);
    start_supervisor();
    set(arm, PreOperational, 2);
    EXPECT_EQ(call_own("LINK", 2), "");
    answer();
    own_step();
    own_step();
    ASSERT_EQ(std::exchange(own_end, {}), "done");
    ASSERT_TRUE(parts.graph.is_up(2));
  }
  template <class Write, class Value>
  void say(std::uint16_t from, std::uint8_t subtype, Write write, const Value& value) {
    std::array<std::byte, 512> buffer{};
    const auto octets = write(MutableOctets{buffer}, std::uint8_t{2}, value);
    report(from, st128::service_type, subtype, Octets{buffer}.first(octets.value()));
  }
  void attached(std::uint16_t from, st128::Role role) {
    std::array<std::byte, 64> buffer{};
    const auto octets = st128::write_attached(buffer, {.role = role, .route = {.link = 2}});
    report(from, st128::service_type, st128::attached, Octets{buffer}.first(octets.value()));
  }
  void detached(std::uint16_t from, st128::Role role) {
    report(from, st128::service_type, st128::detached, std::array{std::byte{2}, static_cast<std::byte>(role)});
  }
  void offers() {
    EXPECT_THAT(texts(arm), ElementsAre("TC[128,1]"));
    say(arm, st128::offer, st128::write_offer,
        st128::Offer{.set = "HAND_STATE", .period = 1ms, .terms = {}, .depth = 0, .fields = fields});
    EXPECT_THAT(texts(hand), ElementsAre("TC[128,2]"));
  }
  /// Both ends in a handshake that goes well.
  void answer(Duration producers_period = 1ms) {
    offers();
    say(hand, st128::agreement, st128::write_agreement,
        st128::Agreement{LinkMethod::SharedMemory, descriptor::ByteOrder::Little, LinkKind::Latest, 0, producers_period,
                         1ms, fields});
    EXPECT_THAT(texts(hand), ElementsAre("TC[128,3]"));
    attached(hand, st128::Role::Producer);
    EXPECT_THAT(texts(arm), ElementsAre("TC[128,3]"));
    attached(arm, st128::Role::Consumer);
  }
  void leaves() {
    set(hand, PostOperational, 1);
    detached(hand, st128::Role::Producer);
    set(hand, PreOperational, 0);
    look();
    ASSERT_FALSE(parts.graph.is_up(2));
  }
  void look() {
    wait(10ms);
    parts.links.watch(clock.now());
  }
};

TEST_F(RenewedLinks, AreNegotiatedAnewWithTheConfigurationThatIsInForceNow) {
  leaves();
  EXPECT_THAT(texts(arm), IsEmpty()) << "nothing to negotiate with";
  set(hand, PreOperational, 1);
  look();
  answer(4ms);
  EXPECT_TRUE(parts.graph.is_up(2));
  EXPECT_TRUE(was_told("up: shared_memory, little endian, latest, 250 Hz to 1000 Hz"));
  look();
  EXPECT_THAT(texts(arm), IsEmpty()) << "once";
}

TEST_F(RenewedLinks, ThatAreRefusedNameTheFieldAndTheOldAgreementIsTakenBack) {
  leaves();
  set(hand, PreOperational, 1);
  look();
  offers();
  say(hand, st128::refusal, st128::write_refusal,
      st128::Refusal{4, "field ANGLE: consumer DOUBLE[2], producer DOUBLE[3]"});
  EXPECT_TRUE(was_told("link 2 HAND.HAND_STATE -> ARM down: field ANGLE: consumer DOUBLE[2], producer DOUBLE[3]"));
  EXPECT_THAT(texts(arm), ElementsAre("TC[128,4]")) << "it held the link as it was";
  for (int i = 0; i < 5; ++i) look();
  EXPECT_THAT(texts(arm), IsEmpty()) << "with the same configurations it would be the same";
}

TEST_F(RenewedLinks, AreNotThoseThatWereUnlinked) {
  EXPECT_EQ(call_own("UNLINK", 2), "");
  static_cast<void>(texts(arm));
  detached(arm, st128::Role::Consumer);
  detached(hand, st128::Role::Producer);
  for (int i = 0; i < 5; ++i) look();
  EXPECT_THAT(texts(arm), IsEmpty());
}

TEST_F(RenewedLinks, AreNotThoseOfWhoDied) {
  leaves();
  ends[played[hand].process] = {.by_signal = true, .value = 9};
  parts.processes.watch(clock.now());
  for (int i = 0; i < 5; ++i) look();
  EXPECT_THAT(texts(arm), ::testing::Not(::testing::Contains("TC[128,1]")));
}

TEST_F(RenewedLinks, LetACommandToMakeThemJoin) {
  leaves();
  set(hand, PreOperational, 1);
  look();
  EXPECT_EQ(call_own("LINK", 2), "") << "it goes on";
  answer();
  own_step();
  own_step();
  EXPECT_EQ(std::exchange(own_end, {}), "done");
  EXPECT_TRUE(parts.graph.is_up(2));
}

TEST_F(RenewedLinks, ThatAreUpAgainHaveDoneWhatACommandToMakeThemAsksFor) {
  leaves();
  set(hand, PreOperational, 1);
  look();
  answer();
  EXPECT_EQ(call_own("LINK", 2), "done");
  EXPECT_EQ(call_own("LINK", 2), to_text(pus::FailureCode::WrongStatus)) << "once";
}

}  // namespace
}  // namespace hirosco::supervisor
