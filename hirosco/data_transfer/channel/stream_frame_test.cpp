// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/stream_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace hirosco {
namespace {

using FrameOctets = std::vector<std::byte>;

[[nodiscard]] FrameOctets framed_octets(StreamFrameKind kind, Octets head, Octets rest = {}) {
  FrameOctets buffer(max_stream_frame_octets);
  const auto written = write_stream_frame(buffer, kind, head, rest);
  if (!written) return {};
  buffer.resize(written->size());
  return buffer;
}
[[nodiscard]] FrameOctets octets_from(std::initializer_list<int> values) {
  FrameOctets made;
  for (const int value : values) made.push_back(static_cast<std::byte>(value));
  return made;
}

TEST(StreamFrame, IsMagicVersionKindLengthPayloadAndACheckSum) {
  // CRC-16/CCITT-FALSE of the eight octets before it, by a foreign tool (Python's binascii.crc_hqx with 0xFFFF).
  EXPECT_EQ(framed_octets(StreamFrameKind::Vital, octets_from({0xAA}), octets_from({0xBB})),
            octets_from({0x48, 0x4D, 2, 2, 0, 2, 0xAA, 0xBB, 0xAB, 0x74}));
}

TEST(StreamFrame, IsReadAsItWasWrittenWithItsSuccessorBehindIt) {
  FrameOctets stream = framed_octets(StreamFrameKind::Message, octets_from({1, 2}), octets_from({3}));
  const std::size_t first = stream.size();
  const FrameOctets second = framed_octets(StreamFrameKind::Permit, {});
  stream.insert(stream.end(), second.begin(), second.end());
  const auto found = read_stream_frame(stream).value().value();
  EXPECT_EQ(found.kind, StreamFrameKind::Message);
  EXPECT_TRUE(std::ranges::equal(found.payload, octets_from({1, 2, 3})));
  EXPECT_EQ(found.octets, first);
  const auto next = read_stream_frame(Octets{stream}.subspan(first)).value().value();
  EXPECT_EQ(next.kind, StreamFrameKind::Permit);
  EXPECT_TRUE(next.payload.empty());
}

TEST(StreamFrame, ThatIsShortWaitsForTheRestWhereverItIsCut) {
  const FrameOctets whole = framed_octets(StreamFrameKind::Message, octets_from({1, 2, 3, 4}));
  for (std::size_t octets = 0; octets < whole.size(); ++octets) {
    const auto found = read_stream_frame(Octets{whole}.first(octets));
    ASSERT_TRUE(found) << octets;
    EXPECT_FALSE(found->has_value()) << octets;
  }
}

TEST(StreamFrame, OfAnotherVersionIsRefusedByNameBeforeAnythingElseOfItIsBelieved) {
  for (const int version : {0, stream_frame_version + 1, 255}) {
    const auto refused = read_stream_frame(octets_from({0x48, 0x4D, version}));
    ASSERT_FALSE(refused) << version;
    EXPECT_EQ(refused.error().code, ErrorCode::Mismatch);
    EXPECT_EQ(refused.error().value, version);
    EXPECT_STREQ(refused.error().text, "another version of a member's stream; build both from one hirosco");
  }
}

TEST(StreamFrame, SaysWhatIsWrongWithADamagedOne) {
  const auto why = [](FrameOctets damaged) { return std::string{read_stream_frame(damaged).error().text}; };
  EXPECT_EQ(why(octets_from({0x48, 0x4E})), "beginning of a frame");
  EXPECT_EQ(why(octets_from({0x48, 0x4D, 2, 0})), "kind of frame");
  EXPECT_EQ(why(octets_from({0x48, 0x4D, 2, 4})), "kind of frame");
  EXPECT_EQ(why(octets_from({0x48, 0x4D, 2, 1, 0xFF, 0xFF})), "octets of frame");
  FrameOctets sum = framed_octets(StreamFrameKind::Message, octets_from({1, 2}));
  sum.back() ^= std::byte{1};
  EXPECT_EQ(why(sum), "check sum of frame");
}

TEST(StreamFrame, DoesNotPassWithAnyBitFlipped) {
  const FrameOctets whole = framed_octets(StreamFrameKind::Permit, octets_from({1, 2, 3, 4, 5, 6, 7, 8}));
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    FrameOctets flipped = whole;
    flipped[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    const auto found = read_stream_frame(flipped);
    EXPECT_TRUE(!found || !*found) << bit;  // a longer one waits for octets that never fit its check sum
  }
}

TEST(StreamFrame, NeverLeavesWhatWasReceivedWhateverThatIs) {
  std::mt19937 random{66};
  std::uniform_int_distribution octet{0, 255};
  for (int round = 0; round < 20'000; ++round) {
    FrameOctets stream = framed_octets(StreamFrameKind::Vital, FrameOctets(static_cast<std::size_t>(octet(random))));
    for (int damage = octet(random) % 4; damage > 0; --damage)
      stream[static_cast<std::size_t>(octet(random)) % std::min<std::size_t>(stream.size(), 12)] =
          static_cast<std::byte>(octet(random));
    stream.resize(static_cast<std::size_t>(octet(random)) % (stream.size() + 1));
    const auto found = read_stream_frame(stream);
    if (!found || !*found) continue;
    EXPECT_LE((*found)->octets, stream.size());
    EXPECT_EQ((*found)->payload.size() + stream_frame_extra_octets, (*found)->octets);
  }
}

TEST(StreamFrame, ThatHasNoRoomIsNotWritten) {
  std::array<std::byte, 12> small{};
  EXPECT_EQ(write_stream_frame(small, StreamFrameKind::Message, FrameOctets(5)).error().code,
            ErrorCode::ResourceExhausted);
  EXPECT_TRUE(write_stream_frame(small, StreamFrameKind::Message, FrameOctets(4)));
  FrameOctets large(2 * max_stream_frame_octets);
  EXPECT_TRUE(write_stream_frame(large, StreamFrameKind::Message, FrameOctets(max_stream_frame_payload)));
  EXPECT_EQ(write_stream_frame(large, StreamFrameKind::Message, FrameOctets(max_stream_frame_payload), FrameOctets(1))
                .error()
                .code,
            ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace hirosco
