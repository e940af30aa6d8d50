// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/imager/readout.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hirosco::imager {
namespace {

constexpr std::uint32_t number = 7;

PacketHead packet_of(std::uint16_t packet, std::uint16_t packets, std::uint32_t start, std::uint32_t pixels) {
  return {.image = number, .packets = packets, .packet = packet, .start = start, .pixels = pixels, .octets = 2};
}

/// The example of Apple's technical note 1023.
TEST(PackBits, UnpacksTheExampleOfItsAuthors) {
  const std::vector<std::uint8_t> packed{0xFE, 0xAA, 0x02, 0x80, 0x00, 0x2A, 0xFD, 0xAA,
                                         0x03, 0x80, 0x00, 0x2A, 0x22, 0xF7, 0xAA};
  const std::vector<std::uint8_t> expected{0xAA, 0xAA, 0xAA, 0x80, 0x00, 0x2A, 0xAA, 0xAA, 0xAA, 0xAA, 0x80, 0x00,
                                           0x2A, 0x22, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA, 0xAA};
  std::vector<std::uint8_t> unpacked(expected.size());
  EXPECT_TRUE(unpack(packed, std::as_writable_bytes(std::span{unpacked})));
  EXPECT_EQ(unpacked, expected);
}

TEST(PackBits, RefusesWhatEndsInBetweenAndWhatMakesMoreOrLessThanItSays) {
  std::array<std::byte, 6> room{};
  const auto unpacks = [&](std::vector<std::uint8_t> coded, std::size_t pixels) {
    const bool did = unpack(coded, MutableOctets{room}.first(pixels));
    return did && room.back() == std::byte{0};
  };
  EXPECT_TRUE(unpacks({0xFD, 1, 128, 0, 9}, 5));
  EXPECT_FALSE(unpacks({0xFD, 1}, 5)) << "four are no five";
  EXPECT_FALSE(unpacks({0xFB, 1}, 5)) << "six are no five";
  EXPECT_FALSE(unpacks({0x05, 1, 2, 3, 4, 5, 6}, 5));
  EXPECT_FALSE(unpacks({0x04, 1, 2, 3, 4}, 5)) << "one is missing";
  EXPECT_FALSE(unpacks({0xFC}, 5)) << "which one?";
  EXPECT_FALSE(unpacks({}, 5));
  EXPECT_TRUE(unpacks({}, 0));
}

struct ReadoutTest : ::testing::Test {
  Readout readout;
  ReadoutTest() { readout.begin(number, 100); }
  Readout::Heard hear(const PacketHead& head) {
    const Readout::Heard heard = readout.look(head);
    if (heard == Readout::Heard::Wanted) readout.took(head);
    return heard;
  }
};

TEST_F(ReadoutTest, AsksForTheFirstUntilItIsToldHowManyThereAreThenForEachThatIsMissing) {
  EXPECT_EQ(readout.ask(), 0);
  EXPECT_EQ(readout.ask(), 0);
  EXPECT_EQ(hear(packet_of(0, 4, 0, 25)), Readout::Heard::Wanted);
  EXPECT_EQ(readout.ask(), 1);
  EXPECT_EQ(readout.ask(), 2) << "before 1 has come";
  EXPECT_EQ(hear(packet_of(1, 4, 25, 25)), Readout::Heard::Wanted);
  EXPECT_EQ(readout.ask(), 3);
  EXPECT_EQ(hear(packet_of(3, 4, 75, 25)), Readout::Heard::Wanted);
  EXPECT_EQ(readout.ask(), 2) << "its answer was lost";
  EXPECT_FALSE(readout.complete());
  EXPECT_EQ(hear(packet_of(2, 4, 50, 25)), Readout::Heard::Wanted);
  EXPECT_TRUE(readout.complete());
  EXPECT_EQ(readout.got(), 4);
}

TEST_F(ReadoutTest, TakesAPacketOnceAndNoneOfAnotherImage) {
  EXPECT_EQ(hear(packet_of(0, 2, 0, 50)), Readout::Heard::Wanted);
  EXPECT_EQ(hear(packet_of(0, 2, 0, 50)), Readout::Heard::Nothing);
  PacketHead other = packet_of(1, 2, 50, 50);
  other.image = 6;
  EXPECT_EQ(hear(other), Readout::Heard::Nothing);
  other.image = 0;
  EXPECT_EQ(hear(other), Readout::Heard::Nothing);
  EXPECT_EQ(readout.got(), 1);
}

TEST_F(ReadoutTest, BelievesNoPacketThatCannotBe) {
  const auto wrong = [&](PacketHead head) { return hear(head) == Readout::Heard::Wrong; };
  EXPECT_TRUE(wrong(packet_of(0, 0, 0, 10)));
  EXPECT_TRUE(wrong(packet_of(2, 2, 0, 10)));
  EXPECT_TRUE(wrong(packet_of(0, 1201, 0, 10)));
  EXPECT_TRUE(wrong(packet_of(0, 2, 0, 0)));
  EXPECT_TRUE(wrong(packet_of(0, 2, 0, 101)));
  EXPECT_TRUE(wrong(packet_of(0, 2, 60, 41)));
  EXPECT_TRUE(wrong(packet_of(0, 2, 0xFFFF'FFFF, 10))) << "the sum would wrap";
  PacketHead long_one = packet_of(0, 2, 0, 50);
  long_one.octets = packet_octets + 1;
  EXPECT_TRUE(wrong(long_one));
  EXPECT_EQ(hear(packet_of(0, 2, 0, 50)), Readout::Heard::Wanted);
  EXPECT_TRUE(wrong(packet_of(1, 3, 50, 50))) << "there were two";
}

TEST_F(ReadoutTest, PacketsThatDoNotCoverTheImageAreNone) {
  hear(packet_of(0, 2, 0, 50));
  hear(packet_of(1, 2, 50, 49));
  EXPECT_FALSE(readout.complete());
}

TEST(ImageWindow, SaysWhyItCannotBe) {
  const auto problem = [](Window window) {
    const char* why = window.problem(1024, 768);
    return std::string{why == nullptr ? "" : why};
  };
  EXPECT_EQ(problem({0, 0, 1024, 768, 1}), "");
  EXPECT_EQ(problem({1000, 700, 24, 68, 4}), "");
  EXPECT_EQ(problem({1000, 0, 25, 68, 1}), "the window ends beyond the sensor's columns");
  EXPECT_EQ(problem({0, 768, 24, 1, 1}), "the window ends beyond the sensor's rows");
  EXPECT_EQ(problem({0, 0, 24, 0, 1}), "an empty window");
  EXPECT_EQ(problem({0, 0, 24, 24, 0}), "an empty window");
  EXPECT_EQ(problem({0, 0, 24, 25, 2}), "the binning does not divide the window");
  EXPECT_NE((Window{0, 0, 2048, 1024, 1}.problem(4096, 4096)), nullptr);
  EXPECT_EQ((Window{0, 0, 2048, 2048, 2}.problem(4096, 4096)), nullptr);
}

}  // namespace
}  // namespace hirosco::imager
