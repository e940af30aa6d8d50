// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/links.hpp"

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
    report(from, st128::service_type, subtype, std::array{std::byte{2}, static_cast<std::byte>(role)});
  }
  void bring_up() {
    EXPECT_EQ(call_own("LINK", 2), "") << "it goes on";
    EXPECT_THAT(texts(arm), ElementsAre("TC[128,1]"));
    say(arm, st128::offer, st128::write_offer,
        st128::Offer{.set = "HAND_STATE", .period = 1ms, .terms = {}, .fields = fields});
    EXPECT_THAT(texts(hand), ElementsAre("TC[128,2]"));
    say(hand, st128::agreement, st128::write_agreement,
        st128::Agreement{LinkMethod::SharedMemory, descriptor::ByteOrder::Little, LinkKind::Latest, 1ms, 1ms, fields});
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
  says(hand, st128::detached, st128::Role::Producer);
  own_step();
  own_step();
  EXPECT_EQ(own_end, "done");
  EXPECT_FALSE(parts.graph.is_up(2));
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

}  // namespace
}  // namespace hirosco::supervisor
