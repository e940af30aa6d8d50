// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/judgement.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

/// What is judged besides the rules of permission_test.cpp: who speaks, and how the craft stands. The question before sending is asked in
/// supervision_service_test.cpp.
namespace hirosco::supervisor {
namespace {

using namespace testing;
using pus::FailureCode;
using enum descriptor::State;

struct JudgementTest : PartsTest {
  void SetUp() override {
    PartsTest::SetUp();
    start_all(Operational);
    for (const auto& link : craft.mission.links) parts.graph.set_up(link.id, true);
  }
  /// Why it is refused; empty: it is permitted.
  [[nodiscard]] std::optional<FailureCode> refused(const std::vector<std::byte>& packet,
                                                   const Origin& origin = Origin::ground()) const {
    const auto decision = parts.judgement.judge(pus::TelecommandView::parse(packet).value(), origin);
    return decision ? std::nullopt : std::optional{decision.error().code()};
  }
  static std::vector<std::byte> from(std::uint16_t source, std::uint16_t apid, std::string_view function) {
    std::vector<std::byte> octets(pus::max_telecommand_octets);
    const auto packet = pus::write_telecommand(
        octets, {.apid = apid, .ack = pus::ack_all, .service = 8, .subtype = 1, .source = source}, call_data(function));
    octets.resize(packet.value().size());
    return octets;
  }
  const std::vector<std::byte> go = telecommand(arm, 8, 1, call_data("SET_STATE", static_cast<int>(Operational)));
};

TEST_F(JudgementTest, NobodySpeaksUnderTheNameOfAnotherButForAStopOfTheCraft) {
  EXPECT_EQ(refused(from(0, arm, "MOVE_TO")), std::nullopt);
  EXPECT_EQ(refused(from(hand, arm, "MOVE_TO")), FailureCode::ForeignSource);
  EXPECT_EQ(refused(from(hand, supervisor_apid, "SAFE_ALL")), std::nullopt);
}

TEST_F(JudgementTest, WhoHasFailedCommandsNobodyButTowardsSafety) {
  auto& members = craft.mission.subsystems;
  descriptor::Commands commands;
  commands.subsystem = "ARM";
  commands.apid = arm;
  commands.functions = {"MOVE_TO", "BRAKE"};
  std::ranges::find(members, hand, [](const auto& member) { return member.subsystem.id; })->subsystem.commands = {
      commands};
  EXPECT_EQ(refused(from(hand, arm, "MOVE_TO"), Origin::subsystem(hand)), std::nullopt);
  set(hand, ErrorOperational);
  EXPECT_EQ(refused(from(hand, arm, "MOVE_TO"), Origin::subsystem(hand)), FailureCode::WrongState);
  EXPECT_EQ(refused(from(hand, arm, "BRAKE"), Origin::subsystem(hand)), std::nullopt);
}

TEST_F(JudgementTest, NobodyIsLetGoOnTheWayDown) {
  set(arm, SafeOperational, 2);
  EXPECT_EQ(refused(go), std::nullopt);
  craft.shutting_down = true;
  EXPECT_EQ(refused(go), FailureCode::NotPermittedNow);
}

TEST_F(JudgementTest, NobodyIsLetGoWhoCannotHearOfAStopAnyMore) {
  set(arm, SafeOperational, 2);
  craft.member(arm)->closed_at = craft.now;
  EXPECT_EQ(refused(go), FailureCode::WrongState);
}

TEST_F(JudgementTest, WhatTheAddresseeCannotDoInItsStateIsRefused) {
  set(arm, SafeOperational, 2);
  EXPECT_EQ(refused(from(0, arm, "MOVE_TO")), FailureCode::WrongState);
}

}  // namespace
}  // namespace hirosco::supervisor
