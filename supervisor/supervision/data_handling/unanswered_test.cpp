// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/unanswered.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "supervisor/supervision/testing/small_mission.hpp"

namespace hirosco::supervisor {
namespace {

using testing::arm;
using testing::hand;

struct UnansweredTest : ::testing::Test {
  Unanswered unanswered;
  std::array<std::byte, 64> buffer{};

  std::uint32_t forward(std::uint16_t apid, std::uint16_t count, std::uint8_t ack = pus::ack_all) {
    const auto packet = pus::write_telecommand(
        buffer, {.apid = apid, .sequence_count = count, .ack = ack, .service = 17, .subtype = 1, .source = 7}, {});
    const auto telecommand = pus::TelecommandView::parse(*packet).value();
    unanswered.forwarded(apid, telecommand, TimePoint{});
    return telecommand.request_id();
  }
  void report(std::uint16_t apid, std::uint8_t subtype, std::uint32_t id, std::uint16_t destination = 7) {
    std::array<std::byte, 8> data{};
    OctetWriter writer{data};
    writer.put(id);
    const auto packet = pus::write_telemetry(
        buffer, {.apid = apid, .service = 1, .subtype = subtype, .destination = destination}, writer.written());
    unanswered.reported(pus::TelemetryView::parse(*packet).value());
  }
};

TEST_F(UnansweredTest, WhatDidNotEndIsKnownWhenItsAddresseeDies) {
  const auto first = forward(arm, 1);
  const auto second = forward(arm, 2);
  forward(hand, 3);
  report(arm, 1, first);
  report(arm, 3, first);
  const auto taken = unanswered.take(arm);
  ASSERT_EQ(taken.size(), 2u);
  EXPECT_EQ(taken[0].id, first);
  EXPECT_EQ(taken[1].id, second);
  EXPECT_EQ(taken[0].source, 7);
  EXPECT_TRUE(unanswered.take(arm).empty());
  EXPECT_EQ(unanswered.size(), 1u);
}

TEST_F(UnansweredTest, CompletionAndEveryFinalFailureEndIt) {
  for (const std::uint8_t subtype : std::array<std::uint8_t, 5>{2, 4, 7, 8, 10}) {
    const auto id = forward(arm, subtype);
    report(arm, subtype, id);
    EXPECT_EQ(unanswered.size(), 0u) << int{subtype};
  }
}

TEST_F(UnansweredTest, AFailedStepAndTheReportsOfOthersDoNot) {
  const auto id = forward(arm, 1);
  report(arm, 6, id);
  report(arm, 7, id, 8);
  report(hand, 7, id);
  report(arm, 7, id + 1);
  EXPECT_EQ(unanswered.size(), 1u);
}

TEST_F(UnansweredTest, WhoAsksForNoReportOfTheEndWaitsForNone) {
  forward(arm, 1, 0);
  EXPECT_EQ(unanswered.size(), 0u);
  const auto id = forward(arm, 2, pus::ack_acceptance);
  EXPECT_EQ(unanswered.size(), 1u);
  report(arm, 1, id);
  EXPECT_EQ(unanswered.size(), 0u);
}

// --- beyond this supervisor (docs/adr/0093) ------------------------------------------------------------------------------

struct UnansweredBeyond : UnansweredTest {
  /// What a supervisor that goes on knows of it.
  Unanswered next() {
    std::vector<std::byte> octets(4096);
    OctetWriter writer{octets};
    unanswered.note(writer);
    EXPECT_TRUE(writer.good());
    Unanswered recalled;
    OctetReader reader{writer.written()};
    recalled.recall(reader);
    EXPECT_TRUE(reader.exhausted());
    return recalled;
  }
  static pus::TelemetryView end_of(std::uint32_t id, std::array<std::byte, 64>& buffer) {
    std::array<std::byte, 4> data{};
    OctetWriter{data}.put(id);
    return pus::TelemetryView::parse(
               *pus::write_telemetry(buffer, {.apid = arm, .service = 1, .subtype = 7, .destination = 7}, data))
        .value();
  }
};

TEST_F(UnansweredBeyond, WhatIsUnderWayIsKnownAndEndsByItsReport) {
  const auto id = forward(arm, 1);
  unanswered.counted(arm, 100, TimePoint{});
  Unanswered later = next();
  EXPECT_EQ(later.size(), 1u);
  later.counted(arm, 101, TimePoint{10s});
  EXPECT_TRUE(later.take_doubtful(TimePoint{60s}).empty()) << "no packet is missing";
  later.reported(end_of(id, buffer));
  EXPECT_EQ(later.size(), 0u);
}

TEST_F(UnansweredBeyond, AnEndThatWasHeardAndNotToldIsTaken) {
  const auto id = forward(arm, 1);
  report(arm, 7, id);
  const auto settled = next().take_settled();
  ASSERT_EQ(settled.size(), 1u);
  EXPECT_EQ(settled[0].id, id);
}

TEST_F(UnansweredBeyond, AnEndThatWasToldIsNot) {
  report(arm, 7, forward(arm, 1));
  unanswered.delivered();
  EXPECT_TRUE(next().take_settled().empty());
}

TEST_F(UnansweredBeyond, WhereAPacketIsMissingTheEndIsUnknownAfterItsTimeAndALaterOneContradictsIt) {
  const auto id = forward(arm, 1);
  const auto of_another = forward(hand, 2);
  unanswered.counted(arm, 100, TimePoint{});
  unanswered.counted(hand, 7, TimePoint{});
  Unanswered later = next();
  later.counted(arm, 103, TimePoint{10s});
  later.counted(hand, 8, TimePoint{10s});
  EXPECT_TRUE(later.take_doubtful(TimePoint{10s} + Unanswered::doubt - 1ms).empty()) << "it may come yet";
  const auto taken = later.take_doubtful(TimePoint{10s} + Unanswered::doubt);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].id, id);
  EXPECT_TRUE(later.contradicts(end_of(id, buffer)));
  EXPECT_FALSE(later.contradicts(end_of(of_another, buffer)));
}

TEST_F(UnansweredBeyond, CountsWrapAndALaterGapIsNoMatterOfThoseBefore) {
  static_cast<void>(forward(arm, 1));
  unanswered.counted(arm, 16'383, TimePoint{});
  Unanswered later = next();
  later.counted(arm, 0, TimePoint{10s});
  later.counted(arm, 5, TimePoint{11s});
  EXPECT_TRUE(later.take_doubtful(TimePoint{60s}).empty());
}

TEST_F(UnansweredBeyond, OneThatMayNotHaveLeftIsUnknownAfterItsTimeUnlessItsAddresseeSaysAnything) {
  constexpr std::uint32_t silent = 1;
  const std::array<std::uint8_t, 6> words{1, 2, 3, 5, 6, 7};
  for (const std::uint8_t subtype : words) unanswered.was_leaving(arm, {100U + subtype, 7, pus::ack_all});
  unanswered.was_leaving(arm, {silent, 7, 0});
  unanswered = next();
  EXPECT_TRUE(unanswered.take_doubtful(TimePoint{1h}).empty()) << "nobody could have been heard yet";
  unanswered.hears_from(TimePoint{1h});
  for (const std::uint8_t subtype : words) report(arm, subtype, 100U + subtype);
  EXPECT_TRUE(unanswered.take_doubtful(TimePoint{1h} + Unanswered::doubt - 1ms).empty());
  const auto taken = unanswered.take_doubtful(TimePoint{1h} + Unanswered::doubt);
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_EQ(taken[0].id, silent);
  EXPECT_EQ(unanswered.size(), words.size() - 2) << "but for those that have ended";
}

TEST_F(UnansweredBeyond, ARequestOfTheSupervisorItselfIsKnownUntilItsEndWasHeard) {
  const auto packet = pus::write_telecommand(
      buffer, {.apid = arm, .sequence_count = 1, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = 1}, {});
  const auto telecommand = pus::TelecommandView::parse(*packet).value();
  const auto id = telecommand.request_id();
  unanswered.forwarded(arm, telecommand, TimePoint{});
  const auto taken = next().take(arm);
  ASSERT_EQ(taken.size(), 1u) << "its addressee was killed before it could answer, and the log has no end of it";
  EXPECT_EQ(taken[0].id, id);
  report(arm, 7, id, 1);
  EXPECT_EQ(next().size(), 0u) << "the supervisor that died has heard it";
}

}  // namespace
}  // namespace hirosco::supervisor
