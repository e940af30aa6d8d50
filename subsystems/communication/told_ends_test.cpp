// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/communication/told_ends.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::communication {
namespace {

constexpr std::uint16_t joystick = 11, ground = 0;

std::vector<std::byte> ping(std::uint16_t count, std::uint16_t source = ground, std::uint16_t to = joystick) {
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const auto packet = pus::write_telecommand(
      buffer, {.apid = to, .sequence_count = count, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = source},
      {});
  buffer.resize(packet.value().size());
  return buffer;
}

std::vector<std::byte> report(std::uint16_t on, std::uint8_t subtype, pus::FailureCode code = {},
                              std::uint16_t destination = ground, std::uint16_t by = joystick) {
  std::array<std::byte, 6> data{};
  OctetWriter writer{data};
  writer.put(pus::TelecommandView::parse(ping(on, destination, by))->request_id())
      .put(static_cast<std::uint16_t>(code));
  std::vector<std::byte> buffer(pus::max_telemetry_octets);
  const auto packet =
      pus::write_telemetry(buffer, {.apid = by, .service = 1, .subtype = subtype, .destination = destination},
                           Octets{data}.first(subtype % 2 == 0 ? 6 : 4));
  buffer.resize(packet.value().size());
  return buffer;
}
std::vector<std::byte> unknown(std::uint16_t on, std::uint16_t destination = ground) {
  return report(on, 8, pus::FailureCode::OutcomeUnknown, destination);
}

struct Ends : ::testing::Test {
  ToldEnds told;
};

TEST_F(Ends, AnOutcomeIsNotToldAsUnknownOnceItIsKnown) {
  for (const std::uint8_t end : std::array<std::uint8_t, 5>{2, 4, 7, 8, 10}) {
    EXPECT_TRUE(told.goes_down(report(end, end, pus::FailureCode::ExecutionError)));
    EXPECT_FALSE(told.goes_down(unknown(end)));
  }
}

TEST_F(Ends, WhatIsKnownOfNobodyIsToldAsUnknown) {
  EXPECT_TRUE(told.goes_down(report(3, 1)));
  EXPECT_TRUE(told.goes_down(report(3, 3)));
  EXPECT_TRUE(told.goes_down(unknown(3))) << "accepted and begun, but not ended";
}

TEST_F(Ends, AnotherTelecommandOrSenderIsAnotherMatter) {
  ASSERT_TRUE(told.goes_down(report(3, 7)));
  EXPECT_TRUE(told.goes_down(unknown(4)));
  EXPECT_TRUE(told.goes_down(unknown(3, 2)));
}

TEST_F(Ends, ARequestIdThatComesAgainHasAnEndOfItsOwn) {
  ASSERT_TRUE(told.goes_down(report(3, 7)));
  told.went_up(ping(3));
  EXPECT_TRUE(told.goes_down(unknown(3)));
  EXPECT_FALSE(told.goes_down(unknown(3)));
}

TEST_F(Ends, EveryOtherReportGoesDownAsOftenAsItComes) {
  ASSERT_TRUE(told.goes_down(report(3, 7)));
  EXPECT_TRUE(told.goes_down(report(3, 7)));
  EXPECT_TRUE(told.goes_down(report(3, 8, pus::FailureCode::ExecutionError)));
  std::vector<std::byte> damaged = unknown(3);
  damaged.back() ^= std::byte{1};
  EXPECT_TRUE(told.goes_down(damaged)) << "not ours to judge";
}

TEST_F(Ends, OfTheSupervisorIsNotToldTwiceAlikeAndIsToldWhereItIsAnother) {
  const auto by_supervisor = [](std::uint8_t subtype, pus::FailureCode code = {}) {
    return report(3, subtype, code, ground, pus::supervisor_apid);
  };
  told.went_up(ping(3, ground, pus::supervisor_apid));
  EXPECT_TRUE(told.goes_down(by_supervisor(7)));
  EXPECT_FALSE(told.goes_down(by_supervisor(7))) << "by the next supervisor";
  EXPECT_TRUE(told.goes_down(by_supervisor(8, pus::FailureCode::DeviceError))) << "it does not hold any more";
  EXPECT_FALSE(told.goes_down(by_supervisor(8, pus::FailureCode::DeviceError)));
  EXPECT_TRUE(told.goes_down(by_supervisor(7))) << "and it does again";
  told.went_up(ping(3, ground, pus::supervisor_apid));
  EXPECT_TRUE(told.goes_down(by_supervisor(7))) << "of another telecommand";
}

TEST_F(Ends, OfTheSupervisorAreToldAsOftenAsTelecommandsWentUpAndOfThoseThatDidNotAsOftenAsTheyCome) {
  const auto end = report(3, 7, {}, ground, pus::supervisor_apid);
  for (int client = 0; client < 2; ++client) told.went_up(ping(3, ground, pus::supervisor_apid));
  EXPECT_TRUE(told.goes_down(end));
  EXPECT_TRUE(told.goes_down(end)) << "of the other client, which counts alike";
  EXPECT_FALSE(told.goes_down(end));
  const auto of_subsystem = report(4, 7, {}, joystick, pus::supervisor_apid);
  for (int time = 0; time < 3; ++time) EXPECT_TRUE(told.goes_down(of_subsystem)) << "ground did not send it";
}

TEST_F(Ends, OfTwoThatCountAlikeTheOneWithoutAnEndIsToldAsUnknownAndNoThird) {
  for (int client = 0; client < 2; ++client) told.went_up(ping(3));
  EXPECT_TRUE(told.goes_down(report(3, 7)));
  EXPECT_TRUE(told.goes_down(unknown(3)));
  EXPECT_FALSE(told.goes_down(unknown(3)));
}

TEST_F(Ends, OfADamagedTelecommandThatWentUpStandAgainstNothing) {
  ASSERT_TRUE(told.goes_down(report(3, 7)));
  auto damaged = ping(3);
  damaged.back() ^= std::byte{1};
  told.went_up(damaged);
  EXPECT_TRUE(told.goes_down(unknown(3)));
}

TEST_F(Ends, TheOldestAreForgottenAndNoneThatIsYounger) {
  for (std::uint16_t count = 0; count <= ToldEnds::kept; ++count) ASSERT_TRUE(told.goes_down(report(count, 7)));
  for (std::uint16_t count = 1; count <= ToldEnds::kept; ++count) ASSERT_FALSE(told.goes_down(unknown(count))) << count;
  EXPECT_TRUE(told.goes_down(unknown(0)));
}

TEST_F(Ends, AddresseesWhoseCountsAreAlikeAreRememberedSideBySide) {
  constexpr std::uint16_t manipulator = 10;
  for (std::uint16_t count = 0; count < 500; ++count)
    for (const std::uint16_t to : {joystick, manipulator})
      ASSERT_TRUE(told.goes_down(report(count, 7, {}, ground, to)));
  for (std::uint16_t count = 0; count < 500; ++count)
    for (const std::uint16_t to : {joystick, manipulator})
      ASSERT_FALSE(told.goes_down(report(count, 8, pus::FailureCode::OutcomeUnknown, ground, to)))
          << to << ' ' << count;
}

}  // namespace
}  // namespace hirosco::communication
