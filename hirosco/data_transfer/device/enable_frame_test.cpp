// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/enable_frame.hpp"

#include <array>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco {
namespace {

using EnableBuffer = std::array<std::byte, enable_frame_octets>;
constexpr EnableCommand an_enable{1, 0x01020304, 0xFFFFFFFE};

TEST(EnableFrame, HasItsDeclaredLayout) {
  EnableBuffer buffer{};
  const auto frame = write_enable_command(buffer, an_enable);
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->size(), enable_frame_octets);
  constexpr std::array<unsigned, 14> expected{0x45, 0x48, 0x33, 1, 0, 0, 4, 3, 2, 1, 0xFE, 0xFF, 0xFF, 0xFF};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>((*frame)[i]), expected[i]) << i;
}

TEST(EnableFrame, BringsACommandBack) {
  EnableBuffer buffer{};
  const auto read = read_enable_command(write_enable_command(buffer, an_enable).value());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->enabled, 1);
  EXPECT_EQ(read->epoch, 0x01020304U);
  EXPECT_EQ(read->sequence, 0xFFFFFFFEU);
}

TEST(EnableFrame, BringsAStatusBack) {
  EnableBuffer buffer{};
  const EnableStatus status{DeviceOutput::Holding, device_flag::watchdog_tripped, 7, 8};
  const auto read = read_enable_status(write_enable_status(buffer, status).value());
  ASSERT_TRUE(read);
  EXPECT_EQ(read->output, DeviceOutput::Holding);
  EXPECT_EQ(read->flags, device_flag::watchdog_tripped);
  EXPECT_EQ(read->epoch, 7U);
  EXPECT_EQ(read->sequence, 8U);
}

TEST(EnableFrame, RefusesEveryOneTwoAndThreeBitErrorOfBothKinds) {
  for (const EnableCommand& command : {an_enable, EnableCommand{0, 1, 1}}) {
    EnableBuffer buffer{};
    ASSERT_TRUE(write_enable_command(buffer, command));
    constexpr std::size_t bits = enable_frame_octets * 8;
    const std::size_t third = hirosco::testing::one_in(std::size_t{5});
    const auto flip = [&](std::size_t bit) { buffer[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8); };
    for (std::size_t a = 0; a < bits; ++a) {
      flip(a);
      EXPECT_FALSE(read_enable_command(buffer)) << a;
      EXPECT_FALSE(read_enable_status(buffer)) << a;
      for (std::size_t b = a + 1; b < bits; ++b) {
        flip(b);
        EXPECT_FALSE(read_enable_command(buffer)) << a << ' ' << b;
        for (std::size_t c = b + 1; c < bits; c += third) {
          flip(c);
          EXPECT_FALSE(read_enable_command(buffer)) << a << ' ' << b << ' ' << c;
          flip(c);
        }
        flip(b);
      }
      flip(a);
    }
    EXPECT_TRUE(read_enable_command(buffer));
  }
}

TEST(EnableFrame, RefusesEveryOtherLength) {
  std::array<std::byte, 2 * enable_frame_octets> buffer{};
  ASSERT_TRUE(write_enable_command(buffer, an_enable));
  for (std::size_t length = 0; length <= buffer.size(); ++length)
    EXPECT_EQ(read_enable_command(Octets{buffer}.first(length)).has_value(), length == enable_frame_octets) << length;
}

TEST(EnableFrame, RefusesTheOtherKindAndADeviceFrame) {
  EnableBuffer buffer{};
  EXPECT_FALSE(read_enable_status(write_enable_command(buffer, an_enable).value()));
  EXPECT_FALSE(read_enable_command(write_enable_status(buffer, {}).value()));
  std::array<std::byte, max_device_frame_octets> room{};
  for (std::size_t octets = 0; octets < 32; ++octets) {
    const std::array<std::byte, 32> payload{};
    const DeviceCommand command{DeviceMode::Active, 1, 1, 0, Octets{payload}.first(octets)};
    EXPECT_FALSE(read_enable_command(write_command(room, command).value()));
  }
}

TEST(EnableFrame, RefusesWhatIsNeitherGivenNorWithdrawn) {
  EnableBuffer buffer{};
  for (unsigned value = 0; value < 256; ++value) {
    const auto frame = write_enable_command(buffer, {static_cast<std::uint8_t>(value), 1, 1});
    EXPECT_EQ(read_enable_command(frame.value()).has_value(), value < 2) << value;
  }
  for (unsigned value = 0; value < 256; ++value) {
    const auto frame = write_enable_status(buffer, {static_cast<DeviceOutput>(value), 0, 1, 1});
    EXPECT_EQ(read_enable_status(frame.value()).has_value(), value < 4) << value;
  }
}

TEST(EnableFrame, RefusesASmallBuffer) {
  EnableBuffer buffer{};
  for (std::size_t length = 0; length < enable_frame_octets; ++length)
    EXPECT_EQ(write_enable_command(MutableOctets{buffer}.first(length), an_enable).error().code,
              ErrorCode::ResourceExhausted);
}

TEST(EnableFrame, TellsAnIntactFrameOfAnotherVersionByItsKind) {
  EnableBuffer buffer{};
  ASSERT_TRUE(write_enable_command(buffer, an_enable));
  for (unsigned kind = 0; kind < 256; ++kind) {
    const auto read = read_enable_command(testing::sealed_as(static_cast<std::uint8_t>(kind), buffer));
    if (read) continue;
    const bool known = kind == 0x33 || kind == 0x4C;
    EXPECT_EQ(read.error().code, known ? ErrorCode::Malformed : ErrorCode::Mismatch) << kind;
    EXPECT_EQ(read.error().value, kind);
    buffer[5] ^= std::byte{1};
    EXPECT_EQ(read_enable_command(buffer).error().code, ErrorCode::Malformed) << "it is not intact";
    buffer[5] ^= std::byte{1};
  }
}

}  // namespace
}  // namespace hirosco
