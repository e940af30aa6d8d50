// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/power_frame.hpp"

#include <array>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "hirosco/utilities/testing/slice.hpp"

namespace hirosco {
namespace {

using PowerBuffer = std::array<std::byte, power_frame_octets>;
constexpr PowerCommand switch_on{true, std::chrono::milliseconds{0x0102}, 0xFFFFFFFE};

TEST(PowerFrame, HasItsDeclaredLayout) {
  PowerBuffer buffer{};
  const auto frame = write_power_command(buffer, switch_on);
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->size(), power_frame_octets);
  constexpr std::array<unsigned, 10> expected{0x50, 0x48, 0x96, 1, 2, 1, 0xFE, 0xFF, 0xFF, 0xFF};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>((*frame)[i]), expected[i]) << i;
}

TEST(PowerFrame, BringsCommandAndStatusBack) {
  PowerBuffer buffer{};
  const auto command = read_power_command(write_power_command(buffer, switch_on).value());
  ASSERT_TRUE(command);
  EXPECT_TRUE(command->on);
  EXPECT_EQ(command->off_after, std::chrono::milliseconds{0x0102});
  EXPECT_EQ(command->sequence, 0xFFFFFFFEU);
  EXPECT_FALSE(read_power_command(write_power_command(buffer, {.on = false}).value())->on);
  const auto status = read_power_status(write_power_status(buffer, {true, 8}).value());
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->on);
  EXPECT_EQ(status->sequence, 8U);
  EXPECT_FALSE(read_power_command(buffer)) << "a status is no command";
}

TEST(PowerFrame, RefusesEveryOneTwoAndThreeBitErrorOfBothKinds) {
  PowerBuffer buffer{};
  constexpr std::size_t bits = power_frame_octets * 8;
  const std::size_t third = hirosco::testing::one_in(std::size_t{5});
  const auto flip = [&](std::size_t bit) { buffer[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8); };
  const auto nothing = [&] { return !read_power_command(buffer) && !read_power_status(buffer); };
  for (const bool command : {true, false}) {
    ASSERT_TRUE(command ? write_power_command(buffer, switch_on) : write_power_status(buffer, {false, 1}));
    for (std::size_t a = 0; a < bits; ++a) {
      flip(a);
      EXPECT_TRUE(nothing()) << a;
      for (std::size_t b = a + 1; b < bits; ++b) {
        flip(b);
        EXPECT_TRUE(nothing()) << a << ' ' << b;
        for (std::size_t c = b + 1; c < bits; c += third) {
          flip(c);
          EXPECT_TRUE(nothing()) << a << ' ' << b << ' ' << c;
          flip(c);
        }
        flip(b);
      }
      flip(a);
    }
  }
}

TEST(PowerFrame, NeedsATimeThatItCanSayAndRoom) {
  PowerBuffer buffer{};
  EXPECT_FALSE(write_power_command(buffer, {.on = true, .off_after = {}}));
  EXPECT_FALSE(write_power_command(buffer, {.on = true, .off_after = std::chrono::milliseconds{65'536}}));
  EXPECT_TRUE(write_power_command(buffer, {.on = true, .off_after = std::chrono::milliseconds{65'535}}));
  EXPECT_FALSE(write_power_command(MutableOctets{buffer}.first(power_frame_octets - 1), switch_on));
  EXPECT_FALSE(read_power_command(Octets{buffer}.first(power_frame_octets - 1)));
  std::array<std::byte, enable_frame_octets> enable{};
  EXPECT_FALSE(read_power_command(write_enable_command(enable, {1, 1, 1}).value()));
}

TEST(PowerFrame, TellsAnIntactFrameOfAnotherVersionByItsKind) {
  PowerBuffer buffer{};
  ASSERT_TRUE(write_power_command(buffer, switch_on));
  for (unsigned kind = 0; kind < 256; ++kind) {
    const auto read = read_power_command(testing::sealed_as(static_cast<std::uint8_t>(kind), buffer));
    if (read) continue;
    const bool known = kind == 0x96 || kind == 0xE9;
    EXPECT_EQ(read.error().code, known ? ErrorCode::Malformed : ErrorCode::Mismatch) << kind;
    EXPECT_EQ(read.error().value, kind);
    buffer[5] ^= std::byte{1};
    EXPECT_EQ(read_power_command(buffer).error().code, ErrorCode::Malformed) << "it is not intact";
    buffer[5] ^= std::byte{1};
  }
}

}  // namespace
}  // namespace hirosco
