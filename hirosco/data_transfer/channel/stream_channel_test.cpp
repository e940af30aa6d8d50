// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/channel/stream_channel.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "hirosco/data_transfer/memory/heap_memory.hpp"

namespace hirosco::testing {
namespace {

/// Two words, of which the first is urgent.
struct TwoWords final : StreamWords {
  TwoWords(StreamFrameKind ours, StreamFrameKind theirs) : told{ours}, heard{theirs} {}
  StreamFrameKind told_kind() const noexcept override { return told; }
  StreamFrameKind heard_kind() const noexcept override { return heard; }
  void tell(OctetWriter& words) noexcept override { words.put(urgent).put(other); }
  std::size_t urgent_octets() const noexcept override { return sizeof urgent; }
  Result<> hear(Octets words) override {
    OctetReader reader{words};
    const auto first = reader.get<std::uint32_t>();
    const auto second = reader.get<std::uint32_t>();
    if (!reader.exhausted()) return fail(ErrorCode::Malformed, "octets of two words");
    urgent_heard.push_back(first);
    other_heard = second;
    return ok();
  }
  StreamFrameKind told, heard;
  std::uint32_t urgent{0}, other{0}, other_heard{0};
  std::vector<std::uint32_t> urgent_heard;
};

struct StreamChannelTest : ::testing::Test {
  StreamChannelTest() {
    auto ends = StreamChannel::make_pair().value();
    here.emplace(std::move(ends.first), ours);
    there.emplace(std::move(ends.second), theirs);
  }
  static std::vector<std::byte> packet(std::size_t octets, int seed) {
    std::vector<std::byte> made(octets);
    for (std::size_t i = 0; i < octets; ++i) made[i] = static_cast<std::byte>(static_cast<int>(i) * 7 + seed);
    return made;
  }
  TwoWords ours{StreamFrameKind::Permit, StreamFrameKind::Vital};
  TwoWords theirs{StreamFrameKind::Vital, StreamFrameKind::Permit};
  std::optional<StreamChannel> here, there;
  MessageBuffer buffer{};
  TimePoint now{std::chrono::seconds{1}};
};

TEST_F(StreamChannelTest, FindsNothingWhereNothingWasSent) {
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::None);
}

TEST_F(StreamChannelTest, CarriesEveryFieldOfAMessageInOrderUpToTheLargestPacket) {
  const std::size_t sizes[]{1, max_packet_octets, 7, 0, 500};
  for (const std::size_t size : sizes)
    ASSERT_TRUE(here->send({MessageKind::GroundTelecommand, 0xDEAD'BEEF, 0x1234, packet(size, 3), {}}));
  for (const std::size_t size : sizes) {
    const auto found = there->receive(buffer).value();
    ASSERT_EQ(found.flow, Flow::New);
    EXPECT_EQ(found.message.kind, MessageKind::GroundTelecommand);
    EXPECT_EQ(found.message.epoch, 0xDEAD'BEEF);
    EXPECT_EQ(found.message.link, 0x1234);
    EXPECT_TRUE(std::ranges::equal(found.message.packet, packet(size, 3))) << size;
  }
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::None);
}

TEST_F(StreamChannelTest, RefusesWhatCannotCross) {
  const auto long_one = packet(max_packet_octets + 1, 0);
  EXPECT_EQ(here->send({.packet = long_one}).error().code, ErrorCode::InvalidArgument);
  EXPECT_STREQ(here->send({.packet = {}, .memory = HeapMemory{}.create("link", 64).value()}).error().text,
               "memory does not cross a stream");
}

TEST_F(StreamChannelTest, SaysSoWhenThePeerDoesNotReadAndWhatWasAcceptedArrives) {
  const auto octets = packet(3000, 1);
  int accepted = 0;
  Result<> sent = ok();
  while (accepted < 100'000 && (sent = here->send({.packet = octets}))) ++accepted;
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, ErrorCode::ResourceExhausted);
  int read = 0;
  for (bool more = true; more; here->step(now)) {
    more = false;
    while (there->receive(buffer).value().flow == Flow::New) ++read, more = true;
  }
  EXPECT_EQ(read, accepted);
  EXPECT_TRUE(here->send({.packet = octets})) << "there is room again";
}

TEST_F(StreamChannelTest, DeliversWhatWasSentBeforeThePeerWentAndThenSaysSo) {
  ASSERT_TRUE(here->send({.packet = packet(9, 1)}));
  here.reset();
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::New);
  EXPECT_EQ(there->receive(buffer).error().code, ErrorCode::Unavailable);
  EXPECT_EQ(there->send({}).error().code, ErrorCode::Unavailable);
  EXPECT_TRUE(there->closed());
}

TEST_F(StreamChannelTest, SeesThatThePeerWentWhereItSendsOnly) {
  ASSERT_TRUE(here->send({.packet = packet(9, 1)}));
  here.reset();
  while (there->send({.packet = packet(100, 1)})) {}
  EXPECT_TRUE(there->closed());
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::New) << "its last words";
}

TEST_F(StreamChannelTest, AnUrgentWordGoesAheadOfTheMessageThatIsSentAfterItChanged) {
  here->step(now);
  ours.urgent = 5;
  ASSERT_TRUE(here->send({.packet = packet(1, 1)}));
  ASSERT_TRUE(here->send({.packet = packet(1, 1)}));
  ASSERT_EQ(there->receive(buffer).value().flow, Flow::New);
  EXPECT_EQ(theirs.urgent_heard, (std::vector<std::uint32_t>{0, 5})) << "and once";
}

TEST_F(StreamChannelTest, OtherWordsGoOnceAPeriod) {
  here->step(now);
  ours.other = 7;
  here->step(now + StreamChannel::words_period - Duration{1});
  there->step(now);
  EXPECT_EQ(theirs.other_heard, 0u);
  here->step(now + StreamChannel::words_period);
  there->step(now);
  EXPECT_EQ(theirs.other_heard, 7u);
  EXPECT_EQ(theirs.urgent_heard.size(), 2u);
}

TEST_F(StreamChannelTest, WordsAreHeardThoughMessagesWaitToBeReceived) {
  ASSERT_TRUE(here->send({.packet = packet(9, 1)}));
  ours.urgent = 5;
  here->step(now);
  there->step(now);
  EXPECT_EQ(theirs.urgent_heard.back(), 5u);
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::New);
}

/// A peer that follows no rule, on the raw socket.
struct StreamChannelAbuse : StreamChannelTest {
  StreamChannelAbuse() {
    auto ends = StreamChannel::make_pair().value();
    raw = std::move(ends.first);
    there.emplace(std::move(ends.second), theirs);
  }
  void say(Octets octets) {
    ASSERT_EQ(::send(raw.get(), octets.data(), octets.size(), MSG_NOSIGNAL), static_cast<ssize_t>(octets.size()));
  }
  [[nodiscard]] static std::vector<std::byte> frame(StreamFrameKind kind, Octets payload) {
    std::vector<std::byte> room(max_stream_frame_octets);
    room.resize(write_stream_frame(room, kind, payload).value().size());
    return room;
  }
  [[nodiscard]] static std::vector<std::byte> message(int kind, int version) {
    std::vector<std::byte> head(envelope::octets);
    head[0] = static_cast<std::byte>(kind);
    head[1] = static_cast<std::byte>(version);
    return frame(StreamFrameKind::Message, head);
  }
  /// Why the stream is read no more; it is closed to both sides then.
  std::string refusal() {
    const auto found = there->receive(buffer);
    if (found) return "nothing is refused";
    EXPECT_EQ(there->receive(buffer).error().code, ErrorCode::Unavailable) << "it is told once";
    EXPECT_EQ(there->send({}).error().code, ErrorCode::Unavailable);
    std::byte octet{};
    EXPECT_EQ(::recv(raw.get(), &octet, 1, MSG_DONTWAIT), 0) << "the peer learns of it";
    return found.error().text + std::string{" "} + std::to_string(found.error().value);
  }
  FileDescriptor raw;
};

TEST_F(StreamChannelAbuse, IsReadOctetByOctet) {
  for (const std::byte octet : message(1, envelope::version)) {
    EXPECT_EQ(there->receive(buffer).value().flow, Flow::None);
    say(Octets{&octet, 1});
  }
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::New);
}

TEST_F(StreamChannelAbuse, WithFramesOfAnotherVersionIsRefusedByName) {
  auto foreign = frame(StreamFrameKind::Permit, std::array<std::byte, 8>{});
  foreign[2] = std::byte{stream_frame_version + 1};
  say(foreign);
  EXPECT_EQ(refusal(), "another version of a member's stream; build both from one hirosco 3");
}

TEST_F(StreamChannelAbuse, WithMessagesOfAnotherVersionIsRefusedByName) {
  say(message(1, 9));
  EXPECT_EQ(refusal(), "another version of the control channel; build both from one hirosco 9");
}

TEST_F(StreamChannelAbuse, WithAMessageOfNoKindIsRefused) {
  say(message(0, envelope::version));
  EXPECT_EQ(refusal(), "kind of message 0");
}

TEST_F(StreamChannelAbuse, WithAMessageThatIsTooShortIsRefused) {
  say(frame(StreamFrameKind::Message, std::array<std::byte, 7>{}));
  EXPECT_EQ(refusal(), "message is too short 0");
}

TEST_F(StreamChannelAbuse, WithWordsThatAreNoneIsRefused) {
  say(frame(StreamFrameKind::Permit, std::array<std::byte, 7>{}));
  EXPECT_EQ(refusal(), "octets of two words 0");
}

TEST_F(StreamChannelAbuse, WithWordsOfItsOwnSideIsRefused) {
  say(frame(StreamFrameKind::Vital, std::array<std::byte, 8>{}));
  EXPECT_EQ(refusal(), "frame of the other side 2");
}

TEST_F(StreamChannelAbuse, DamagedIsRefusedAfterWhatCameBeforeIt) {
  say(message(1, envelope::version));
  say(packet(20, 1));
  EXPECT_EQ(there->receive(buffer).value().flow, Flow::New);
  EXPECT_EQ(refusal(), "beginning of a frame 264");
}

TEST_F(StreamChannelAbuse, ThatEndsWithinAFrameSaysSo) {
  say(Octets{message(1, envelope::version)}.first(9));
  raw.reset();
  const auto found = there->receive(buffer);
  ASSERT_FALSE(found);
  EXPECT_STREQ(found.error().text, "the stream ended within a frame");
}

}  // namespace
}  // namespace hirosco::testing
