// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/device_frame.hpp"

#include <array>
#include <string_view>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "hirosco/utilities/crc16.hpp"

namespace hirosco {
namespace {

using Buffer = std::array<std::byte, max_device_frame_octets>;
constexpr std::array a_payload{std::byte{0xAA}, std::byte{0xBB}, std::byte{0xCC}};

DeviceCommand a_command() { return {DeviceMode::Active, 0x01020304, 0xFFFFFFFF, 10'000, a_payload}; }

TEST(Crc16, GivesThePublishedCheckValue) {
  constexpr std::string_view digits = "123456789";  // check value 0x29B1 of CRC-16/CCITT-FALSE
  EXPECT_EQ(crc16(std::as_bytes(std::span{digits})), 0x29B1);
}

TEST(Crc16, GoesOnOverPieces) {
  const auto whole = std::as_bytes(std::span{std::string_view{"123456789"}});
  EXPECT_EQ(crc16(whole.subspan(4), crc16(whole.first(4))), 0x29B1);
}

TEST(DeviceFrame, HasItsDeclaredLayout) {
  Buffer buffer{};
  const auto frame = write_command(buffer, a_command());
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->size(), device_frame_overhead_octets + a_payload.size());
  constexpr std::array<unsigned, 20> header{0x44, 0x48, 1, 1, 4, 3, 2,    1,    0xFF, 0xFF,
                                            0xFF, 0xFF, 0, 0, 3, 0, 0x10, 0x27, 0,    0};
  for (std::size_t i = 0; i < header.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>((*frame)[i]), header[i]) << i;
}

TEST(DeviceFrame, BringsACommandBack) {
  Buffer buffer{};
  const auto read = read_command(write_command(buffer, a_command()).value());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mode, DeviceMode::Active);
  EXPECT_EQ(read->epoch, 0x01020304U);
  EXPECT_EQ(read->sequence, 0xFFFFFFFFU);
  EXPECT_EQ(read->watchdog_us, 10'000U);
  EXPECT_TRUE(std::ranges::equal(read->payload, a_payload));
}

TEST(DeviceFrame, BringsAStatusBack) {
  Buffer buffer{};
  const DeviceStatus status{7, 8, device_flag::watchdog_tripped | device_flag::torque_saturated, a_payload};
  const auto read = read_status(write_status(buffer, status).value());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->epoch, 7U);
  EXPECT_EQ(read->sequence, 8U);
  EXPECT_EQ(read->flags, 0b1001);
  EXPECT_TRUE(std::ranges::equal(read->payload, a_payload));
}

TEST(DeviceFrame, RefusesEverySingleBitError) {
  Buffer buffer{};
  const std::size_t size = write_command(buffer, a_command()).value().size();
  for (std::size_t bit = 0; bit < size * 8; ++bit) {
    Buffer damaged = buffer;
    damaged[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8);
    EXPECT_FALSE(read_command(Octets{damaged}.first(size))) << "bit " << bit;
  }
}

TEST(DeviceFrame, RefusesEveryOtherLength) {
  Buffer buffer{};
  const std::size_t size = write_command(buffer, a_command()).value().size();
  for (std::size_t length = 0; length <= buffer.size(); ++length)
    EXPECT_EQ(read_command(Octets{buffer}.first(length)).has_value(), length == size) << length;
}

TEST(DeviceFrame, RefusesTheOtherKind) {
  Buffer buffer{};
  EXPECT_FALSE(read_status(write_command(buffer, a_command()).value()));
  EXPECT_FALSE(read_command(write_status(buffer, {}).value()));
}

TEST(DeviceFrame, TellsAnIntactFrameOfAnotherVersionByItsKindWhateverElseItSays) {
  for (const std::size_t size : {device_frame_overhead_octets, device_frame_overhead_octets + a_payload.size()}) {
    Buffer buffer{};
    ASSERT_TRUE(write_command(buffer, a_command()));
    for (unsigned kind = 0; kind < 256; ++kind) {
      const auto read =
          read_command(testing::sealed_as(static_cast<std::uint8_t>(kind), MutableOctets{buffer}.first(size)));
      const bool known = kind == 1 || kind == 2;
      const bool whole = size > device_frame_overhead_octets;
      ASSERT_EQ(read.has_value(), kind == 1 && whole) << kind;
      if (read) continue;
      EXPECT_EQ(read.error().code, known ? ErrorCode::Malformed : ErrorCode::Mismatch) << kind;
      if (!known) {
        EXPECT_EQ(read.error().value, kind);
        buffer[5] ^= std::byte{1};
        EXPECT_EQ(read_command(Octets{buffer}.first(size)).error().code, ErrorCode::Malformed) << "it is not intact";
        buffer[5] ^= std::byte{1};
      }
    }
  }
}

TEST(DeviceFrame, RefusesAModeThatDoesNotExist) {
  Buffer buffer{};
  DeviceCommand command = a_command();
  command.mode = static_cast<DeviceMode>(3);
  const auto read = read_command(write_command(buffer, command).value());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().value, 3);
}

TEST(DeviceFrame, RefusesAPayloadAboveItsLimitAndASmallBuffer) {
  std::array<std::byte, max_device_payload_octets + 1> too_much{};
  std::array<std::byte, 2 * max_device_frame_octets> room{};
  DeviceCommand command = a_command();
  command.payload = too_much;
  EXPECT_EQ(write_command(room, command).error().code, ErrorCode::OutOfRange);
  command.payload = Octets{too_much}.first(max_device_payload_octets);
  EXPECT_TRUE(write_command(room, command));
  for (std::size_t length = 0; length < device_frame_overhead_octets + a_payload.size(); ++length)
    EXPECT_EQ(write_command(MutableOctets{room}.first(length), a_command()).error().code, ErrorCode::ResourceExhausted);
}

}  // namespace
}  // namespace hirosco
