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

std::vector<std::byte> ping(std::uint16_t count, std::uint16_t source = ground) {
  std::vector<std::byte> buffer(pus::max_telecommand_octets);
  const auto packet = pus::write_telecommand(
      buffer,
      {.apid = joystick, .sequence_count = count, .ack = pus::ack_all, .service = 17, .subtype = 1, .source = source},
      {});
  buffer.resize(packet.value().size());
  return buffer;
}

std::vector<std::byte> report(std::uint16_t on, std::uint8_t subtype, pus::FailureCode code = {},
                              std::uint16_t destination = ground) {
  std::array<std::byte, 6> data{};
  OctetWriter writer{data};
  writer.put(pus::TelecommandView::parse(ping(on, destination))->request_id()).put(static_cast<std::uint16_t>(code));
  std::vector<std::byte> buffer(pus::max_telemetry_octets);
  const auto packet =
      pus::write_telemetry(buffer, {.apid = joystick, .service = 1, .subtype = subtype, .destination = destination},
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

TEST_F(Ends, TheOldestAreForgotten) {
  for (std::uint16_t count = 0; count <= ToldEnds::most; ++count) ASSERT_TRUE(told.goes_down(report(count, 7)));
  EXPECT_TRUE(told.goes_down(unknown(0)));
  EXPECT_FALSE(told.goes_down(unknown(2)));
}

}  // namespace
}  // namespace hirosco::communication
