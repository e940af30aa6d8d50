// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/own_telecommands.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct OwnTelecommandsTest : PartsTest {
  std::vector<std::string> ends;
  void SetUp() override {
    PartsTest::SetUp();
    start_all(SafeOperational);
  }
  std::uint32_t send() {
    parts.own_telecommands.command(
        arm, "SET_STATE", static_cast<double>(PostOperational),
        [this](bool success, const std::string& why) { ends.push_back(success ? "done" : why); });
    const auto sent = received(arm);
    return sent.empty() ? 0 : sent.front().request;
  }
  std::uint32_t send_long() {
    parts.own_telecommands.send(
        arm, 17, 1, {}, {}, [this](bool, const std::string& why) { ends.push_back(why); }, 600s);
    const auto sent = received(arm);
    return sent.empty() ? 0 : sent.front().request;
  }
};

TEST_F(OwnTelecommandsTest, ItsSenderHearsOfItsCompletion) {
  const auto request = send();
  verify(arm, request, 1);
  EXPECT_THAT(ends, IsEmpty());
  verify(arm, request, 7);
  verify(arm, request, 7);
  EXPECT_THAT(ends, ElementsAre("done"));
}

TEST_F(OwnTelecommandsTest, ItsSenderHearsWhyItFailed) {
  verify(arm, send(), 4, pus::FailureCode::WrongState);
  EXPECT_THAT(ends, ElementsAre(std::string{to_text(pus::FailureCode::WrongState)}));
  EXPECT_TRUE(was_told("ARM SET_STATE 7 failed: "));
}

TEST_F(OwnTelecommandsTest, AStepThatFailedIsNoEnd) {
  const auto request = send();
  verify(arm, request, 1);
  std::array<std::byte, 8> data;
  OctetWriter writer{data};
  writer.put(request).put(std::uint16_t{1}).put(static_cast<std::uint16_t>(pus::FailureCode::ExecutionError));
  report(arm, 1, 6, writer.written(), supervisor_apid);
  EXPECT_THAT(ends, IsEmpty());
  verify(arm, request, 7);
  EXPECT_THAT(ends, ElementsAre("done"));
}

TEST_F(OwnTelecommandsTest, ItsSenderHearsTheWordsAndTheNumberOfAnAuthor) {
  const auto request = send();
  std::array<std::byte, 4 + 2 + pus::FailureNotice::max_data_octets> data;
  OctetWriter writer{data};
  const auto fail_with = [&](const char* words, std::int64_t number) {
    pus::FailureNotice notice{pus::FailureCode::ExecutionError};
    notice.because({ErrorCode::Internal, number, words});
    writer.put(request).put(static_cast<std::uint16_t>(notice.code())).put(notice.data());
    report(arm, 1, 8, writer.written(), supervisor_apid);
  };
  fail_with("sensor\nis broken", 42);
  EXPECT_THAT(ends, ElementsAre("execution error: sensor?is broken 42"));
  EXPECT_TRUE(was_told("ARM SET_STATE 7 failed: execution error: sensor?is broken 42"));
}

TEST_F(OwnTelecommandsTest, WhatTakesItsTimeIsWaitedForThatMuchLonger) {
  const auto request = send_long();
  wait(10s);
  for (int again = 0; again < 3; ++again) verify(arm, request, 3);
  wait(605s - 1ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_THAT(ends, IsEmpty());
  wait(1ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_THAT(ends, ElementsAre("begun, and not completed within 615 s"));
}

TEST_F(OwnTelecommandsTest, WhatTakesItsTimeAndHasNotBegunIsWaitedForNoLonger) {
  const auto request = send_long();
  verify(arm, request, 1);
  verify(hand, request, 3);
  wait(15s);
  parts.own_telecommands.watch(clock.now());
  EXPECT_THAT(ends, ElementsAre("no answer"));
}

TEST_F(OwnTelecommandsTest, ABeginIsAskedForWhereItCounts) {
  const auto asked = [this](Duration takes) {
    parts.own_telecommands.send(arm, 17, 1, {}, {}, nullptr, takes);
    MessageBuffer buffer;
    const auto next = played[arm].channel.subsystem_end().receive(buffer);
    const auto telecommand = pus::TelecommandView::parse(next->message.packet);
    return telecommand ? pus::request_of(*telecommand).ack : std::uint8_t{0};
  };
  EXPECT_EQ(asked(Duration{0}), pus::ack_acceptance | pus::ack_completion);
  EXPECT_EQ(asked(1s), pus::ack_acceptance | pus::ack_start | pus::ack_completion);
}

TEST_F(OwnTelecommandsTest, AReportToSomebodyElseEndsNothing) {
  verify(arm, send(), 7, {}, 0);
  EXPECT_THAT(ends, IsEmpty());
}

TEST_F(OwnTelecommandsTest, OneThatNobodyAnswersEndsAfterFifteenSeconds) {
  send();
  wait(15s - 1ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_THAT(ends, IsEmpty());
  wait(1ms);
  parts.own_telecommands.watch(clock.now());
  EXPECT_THAT(ends, ElementsAre("no answer"));
}

TEST_F(OwnTelecommandsTest, WhoHasDiedAnswersAtOnce) {
  send();
  parts.own_telecommands.fail_all_to(hand, "process died");
  EXPECT_THAT(ends, IsEmpty());
  parts.own_telecommands.fail_all_to(arm, "process died");
  EXPECT_THAT(ends, ElementsAre("process died"));
}

TEST_F(OwnTelecommandsTest, AFunctionThatNobodyHasFailsAtOnce) {
  parts.own_telecommands.command(arm, "DANCE", std::nullopt,
                                 [this](bool, const std::string& why) { ends.push_back(why); });
  EXPECT_THAT(ends, ElementsAre("unknown function"));
}

TEST_F(OwnTelecommandsTest, OnlyWhoWasCommandedOrTheSupervisorTellsItsEnd) {
  const auto request = send();
  verify(hand, request, 7);
  verify(hand, request, 8, pus::FailureCode::WrongState);
  EXPECT_THAT(ends, IsEmpty()) << "HAND says that ARM has done it";
  verify(arm, request, 7);
  EXPECT_THAT(ends, ElementsAre("done"));
}

}  // namespace
}  // namespace hirosco::supervisor
