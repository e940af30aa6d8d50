// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/modes/shutdown.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct ShutdownTest : PartsTest {
  void over() {
    for (int step = 0; step < 2; ++step) parts.shutdown.enforce(clock.now());
  }
};

TEST_F(ShutdownTest, WhoActsIsMadeSafeFirstThenAllGoDownAndTheGroundLinkLast) {
  start_all(Operational);
  set(hand, SafeOperational);
  parts.shutdown.request();
  EXPECT_THAT(texts(hand), IsEmpty()) << "it does not act";
  EXPECT_TRUE(parts.shutdown.waiting_for().find("ARM: SafeOperational") != std::string::npos);
  obey(arm);
  EXPECT_THAT(texts(hand), IsEmpty()) << "the ground link has not answered yet";
  for (const auto& sent : received(camera)) verify(camera, sent.request, 7);
  set(camera, SafeOperational);
  obey(arm);
  EXPECT_EQ(craft.member(arm)->state(), Offline);
  EXPECT_THAT(texts(camera), IsEmpty()) << "the ground sees the others go";
  obey(hand);
  parts.shutdown.enforce(clock.now());
  EXPECT_FALSE(craft.member(arm)->alive());
  EXPECT_FALSE(parts.shutdown.finished());
  obey(camera);
  over();
  EXPECT_TRUE(parts.shutdown.finished());
  EXPECT_FALSE(craft.failed());
  for (const Member& member : craft.members) EXPECT_FALSE(member.alive());
}

TEST_F(ShutdownTest, TheFlightIsOverOneStepAfterTheLastMemberSoThatWhatIsSaidOfThatIsLogged) {
  start_all(Offline);
  parts.shutdown.request();
  parts.shutdown.enforce(clock.now());
  obey(camera);
  parts.shutdown.enforce(clock.now());
  EXPECT_TRUE(parts.shutdown.finished());
  EXPECT_TRUE(was_told("shutdown"));
}

TEST_F(ShutdownTest, WhoAskedForItIsTold) {
  start_all(Offline);
  parts.telecommands.take(
      {.packet = telecommand(supervisor_apid, 8, 1, call_data("SHUTDOWN")), .origin = Origin::ground()});
  EXPECT_TRUE(was_told("shutdown, asked for by telecommand from ground, source id "));
  parts.shutdown.request("SIGTERM (signal 15)");
  EXPECT_FALSE(was_told("SIGTERM")) << "the first has asked";
}

TEST_F(ShutdownTest, WhoDoesNotAnswerIsEndedAfterFiveSecondsAndTheFlightIsNotOrderly) {
  start_all(SafeOperational);
  parts.shutdown.request();
  wait(5s);
  parts.shutdown.enforce(clock.now());
  EXPECT_THAT(killed, IsEmpty());
  wait(1ms);
  over();
  EXPECT_TRUE(parts.shutdown.finished());
  EXPECT_TRUE(craft.failed());
  EXPECT_THAT(killed, ElementsAre(arm + 1000U, hand + 1000U, camera + 1000U));
}

TEST_F(ShutdownTest, WhatWasAskedOfWhoIsEndedHasAnUnknownOutcome) {
  start_all(Offline);
  const auto asked = telecommand(arm, 17, 1, {});
  parts.telecommands.take({.packet = asked, .origin = Origin::ground()});
  parts.shutdown.request();
  parts.shutdown.enforce(clock.now());
  EXPECT_THAT(own_failures(), ElementsAre(static_cast<std::uint16_t>(pus::FailureCode::OutcomeUnknown)));
}

TEST_F(ShutdownTest, WhoAnswersJustBeforeItIsEndedHasAnsweredAndHasNoSecondEnd) {
  start_all(Offline);
  parts.telecommands.take({.packet = telecommand(arm, 17, 1, {}), .origin = Origin::ground()});
  parts.shutdown.request();
  const Received sent = received(arm).at(0);
  std::array<std::byte, 4> request{};
  OctetWriter{request}.put(sent.request);
  std::array<std::byte, pus::max_telemetry_octets> buffer{};
  const auto completed =
      pus::write_telemetry(buffer, {.apid = arm, .service = 1, .subtype = 7, .destination = sent.source}, request);
  ASSERT_TRUE(played[arm].channel.subsystem_end().send({.packet = *completed}));
  parts.shutdown.enforce(clock.now());
  EXPECT_THAT(own_failures(), IsEmpty());
}

TEST_F(ShutdownTest, ItIsAskedForOnce) {
  start_all(Operational);
  parts.shutdown.request();
  static_cast<void>(texts(arm));
  parts.shutdown.request();
  EXPECT_THAT(texts(arm), IsEmpty());
}

}  // namespace
}  // namespace hirosco::supervisor
