// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/stream_framing.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace hirosco {
namespace {

using Stream = std::vector<std::byte>;

std::vector<std::byte> octets(std::size_t count, unsigned seed) {
  std::mt19937 random{seed};
  std::vector<std::byte> made(count);
  for (std::byte& each : made) each = static_cast<std::byte>(random());
  return made;
}

void append(Stream& stream, const std::vector<std::byte>& frame) {
  std::array<std::byte, max_streamed_octets> buffer;
  const Octets streamed = write_streamed(buffer, frame);
  ASSERT_EQ(streamed.size(), frame.size() + stream_overhead_octets);
  stream.insert(stream.end(), streamed.begin(), streamed.end());
}

struct Found {
  std::vector<std::vector<std::byte>> frames;
  std::uint32_t damaged{0};
};
/// What comes of a stream that arrives in pieces of at most `piece`.
Found read(StreamDeframer& deframer, Octets stream, std::size_t piece) {
  Found found;
  while (!stream.empty()) {
    const MutableOctets room = deframer.room();
    const std::size_t taken = std::min({piece, room.size(), stream.size()});
    EXPECT_GT(taken, 0U) << "no room";
    if (taken == 0) break;
    std::ranges::copy(stream.first(taken), room.begin());
    deframer.received(taken);
    stream = stream.subspan(taken);
    while (const auto frame = deframer.next()) found.frames.emplace_back(frame->begin(), frame->end());
    found.damaged += deframer.take_damaged();
  }
  return found;
}
Found read(Octets stream, std::size_t piece) {
  StreamDeframer deframer;
  return read(deframer, stream, piece);
}

/// The octets of docs/interfaces/devices.md, by hand: CRC-16/CCITT-FALSE of 48 53 02 00 and of DE AD from another implementation.
TEST(StreamFraming, IsWrittenAsItsPageSays) {
  std::array<std::byte, 16> buffer;
  const std::array frame{std::byte{0xDE}, std::byte{0xAD}};
  const Octets streamed = write_streamed(buffer, frame);
  const std::array<unsigned, 10> expected{0x48, 0x53, 0x02, 0x00, 0x63, 0x0E, 0xDE, 0xAD, 0x60, 0x4F};
  ASSERT_EQ(streamed.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<unsigned>(streamed[i]), expected[i]) << i;
}

TEST(StreamFraming, RefusesWhatIsTooLongOrFindsNoRoom) {
  std::array<std::byte, max_streamed_octets + 1> buffer;
  EXPECT_TRUE(write_streamed(buffer, octets(max_frame_octets + 1, 1)).empty());
  EXPECT_TRUE(write_streamed(MutableOctets{buffer}.first(17), octets(10, 1)).empty());
  EXPECT_EQ(write_streamed(MutableOctets{buffer}.first(18), octets(10, 1)).size(), 18U);
  EXPECT_TRUE(write_streamed(MutableOctets{buffer}.first(3), {}).empty());
}

TEST(StreamFraming, WholeFramesComeOutHoweverTheStreamIsCutUp) {
  Stream stream;
  std::vector<std::vector<std::byte>> sent;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{60}, max_frame_octets, std::size_t{22},
                                  max_frame_octets, max_frame_octets, max_frame_octets, std::size_t{7}}) {
    sent.push_back(octets(count, static_cast<unsigned>(count)));
    append(stream, sent.back());
  }
  for (const std::size_t piece : {1U, 2U, 5U, 63U, 1000U, 100'000U}) {
    const Found found = read(stream, piece);
    EXPECT_EQ(found.frames, sent) << piece;
    EXPECT_EQ(found.damaged, 0U);
  }
}

/// Every single octet of three frames, changed, lost or one too many: at most two of them are gone, those that come are whole, and
/// the damage is counted.
TEST(StreamFraming, FindsItsPlaceAgainAfterDamageOfAnyOctet) {
  Stream whole;
  std::vector<std::vector<std::byte>> sent;
  for (unsigned i = 0; i < 6; ++i) append(whole, sent.emplace_back(octets(40, i)));
  const std::size_t of_three = 3 * (40 + stream_overhead_octets);
  for (std::size_t at = 0; at < of_three; ++at)
    for (const int kind : {0, 1, 2}) {
      Stream stream = whole;
      const auto place = stream.begin() + static_cast<std::ptrdiff_t>(at);
      if (kind == 0) *place ^= std::byte{0x10};
      else if (kind == 1) stream.erase(place);
      else stream.insert(place, std::byte{0x48});
      const Found found = read(stream, 17);
      EXPECT_GE(found.frames.size(), kind == 2 ? 5U : 4U) << at << " " << kind;
      EXPECT_LE(found.damaged, 2U);
      if (found.frames.size() < sent.size() || kind == 2) {
        EXPECT_GE(found.damaged, 1U) << at << " " << kind;
      }
      for (const auto& frame : found.frames)
        EXPECT_NE(std::ranges::find(sent, frame), sent.end()) << "an invented frame";
      EXPECT_TRUE(std::ranges::equal(std::span{found.frames}.last(2), std::span{sent}.last(2))) << at << " " << kind;
    }
}

TEST(StreamFraming, NoNoiseIsAFrame) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Stream stream = octets(20'000, seed);
    const std::vector<std::byte> frame = octets(60, seed);
    append(stream, frame);
    const Found found = read(stream, 300);
    ASSERT_EQ(found.frames.size(), 1U);
    EXPECT_EQ(found.frames[0], frame);
    EXPECT_EQ(found.damaged, 1U) << "one place, however long";
  }
}

/// Heads inside of heads, each of which promises the longest frame: what looks into each anew would check an octet a hundred times.
TEST(StreamFraming, HostileHeadsAreCheckedTwiceAtMostAndLoseNoMoreThanThemselves) {
  Stream stream;
  std::array<std::byte, max_streamed_octets> buffer;
  const std::vector<std::byte> longest(max_frame_octets);
  const Octets head = write_streamed(buffer, longest).first(stream_head_octets);
  for (int i = 0; i < 2000; ++i) stream.insert(stream.end(), head.begin(), head.end());
  stream.resize(stream.size() + 2 * max_streamed_octets);  // all that was promised has come
  const std::vector<std::byte> frame = octets(60, 1);
  append(stream, frame);
  const Found found = read(stream, 4096);
  ASSERT_EQ(found.frames.size(), 1U);
  EXPECT_EQ(found.frames[0], frame);
}

TEST(StreamFraming, AnotherStreamBeginsWithoutTheRestOfTheOneBefore) {
  StreamDeframer deframer;
  Stream stream;
  append(stream, octets(40, 1));
  EXPECT_TRUE(read(deframer, Octets{stream}.first(20), 20).frames.empty());
  deframer.restart();
  const Found found = read(deframer, stream, 100);
  EXPECT_EQ(found.frames.size(), 1U);
  EXPECT_EQ(found.damaged, 0U);
}

}  // namespace
}  // namespace hirosco
