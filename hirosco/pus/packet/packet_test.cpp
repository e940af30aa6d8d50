// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/packet/packet.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hirosco/pus/testing/vectors.hpp"
#include "hirosco/utilities/crc16.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;

constexpr std::string_view ping = "1873c01900062f1101000073ab";

/// A heap copy of exactly this size, so that a read past its end is seen by the address sanitizer.
Bytes exact(Octets octets) { return Bytes(octets.begin(), octets.end()); }

/// Puts a right error control behind the rest.
Bytes sealed(Bytes packet) {
  const std::uint16_t crc = crc16(Octets{packet}.first(packet.size() - 2));
  packet[packet.size() - 2] = static_cast<std::byte>(crc >> 8);
  packet[packet.size() - 1] = static_cast<std::byte>(crc & 0xFF);
  return packet;
}

TEST(Telecommand, WritesAndReadsTheVectors) {
  for (const char* group : {"tc", "st03", "st05", "st08", "st17", "st20"})
    for (const auto& vector : vectors(group)) {
      if (!vector.fields.contains("app_data")) continue;
      const Bytes data = from_hex(vector.fields.at("app_data").get<std::string>());
      const TelecommandHeader header = telecommand_header(vector.fields);
      Bytes buffer(max_telecommand_octets);
      const auto written = write_telecommand(buffer, header, data);
      ASSERT_TRUE(written.has_value()) << vector.id;
      EXPECT_EQ(to_hex(*written), to_hex(vector.octets)) << vector.id;
      const auto view = TelecommandView::parse(vector.octets);
      ASSERT_TRUE(view.has_value()) << vector.id;
      EXPECT_EQ(view->apid(), header.apid) << vector.id;
      EXPECT_EQ(view->sequence_count(), header.sequence_count) << vector.id;
      EXPECT_EQ(view->ack(), header.ack) << vector.id;
      EXPECT_EQ(view->service(), header.service) << vector.id;
      EXPECT_EQ(view->subtype(), header.subtype) << vector.id;
      EXPECT_EQ(view->source(), header.source) << vector.id;
      EXPECT_EQ(to_hex(view->application_data()), to_hex(data)) << vector.id;
      EXPECT_EQ(view->request_id(), OctetReader{vector.octets}.get<std::uint32_t>()) << vector.id;
    }
}

TEST(Telemetry, WritesAndReadsTheVectors) {
  for (const char* group : {"tm", "st03", "st05", "st17", "st20"})
    for (const auto& vector : vectors(group)) {
      if (!vector.fields.contains("source_data")) continue;
      const Bytes data = from_hex(vector.fields.at("source_data").get<std::string>());
      const TelemetryHeader header = telemetry_header(vector.fields);
      Bytes buffer(max_telemetry_octets);
      const auto written = write_telemetry(buffer, header, data);
      ASSERT_TRUE(written.has_value()) << vector.id;
      EXPECT_EQ(to_hex(*written), to_hex(vector.octets)) << vector.id;
      const auto view = TelemetryView::parse(vector.octets);
      ASSERT_TRUE(view.has_value()) << vector.id;
      EXPECT_EQ(view->apid(), header.apid) << vector.id;
      EXPECT_EQ(view->sequence_count(), header.sequence_count) << vector.id;
      EXPECT_EQ(view->time_status(), header.time_status) << vector.id;
      EXPECT_EQ(view->service(), header.service) << vector.id;
      EXPECT_EQ(view->subtype(), header.subtype) << vector.id;
      EXPECT_EQ(view->message_count(), header.message_count) << vector.id;
      EXPECT_EQ(view->destination(), header.destination) << vector.id;
      EXPECT_EQ(view->time(), header.time) << vector.id;
      EXPECT_EQ(to_hex(view->source_data()), to_hex(data)) << vector.id;
    }
}

TEST(PrimaryHeader, IsReadFromAnySpacePacket) {
  for (const auto& vector : vectors("space_packet")) {
    const auto header = read_primary_header(vector.octets);
    ASSERT_TRUE(header.has_value()) << vector.id;
    EXPECT_EQ(header->version, 0) << vector.id;
    EXPECT_EQ(header->telecommand, vector.fields.at("type") == "tc") << vector.id;
    EXPECT_EQ(header->secondary_header, vector.fields.at("sec_hdr") != 0) << vector.id;
    EXPECT_EQ(header->apid, vector.fields.at("apid")) << vector.id;
    EXPECT_EQ(header->sequence_flags, vector.fields.at("seq_flags")) << vector.id;
    EXPECT_EQ(header->sequence_count, vector.fields.at("seq")) << vector.id;
    EXPECT_EQ(announced_octets(vector.octets), vector.octets.size()) << vector.id;
    EXPECT_FALSE(TelemetryView::parse(vector.octets).has_value()) << vector.id;
    EXPECT_FALSE(TelecommandView::parse(vector.octets).has_value()) << vector.id;
  }
}

struct Expected {
  const char* id;
  bool discard;
  int code;      ///< -1: the packet itself is whole, the failure is found further on
  std::string_view data;
};

TEST(Telecommand, RefusesTheNegativeVectorsWithTheirCode) {
  constexpr Expected table[] = {
      {"NEG-01", false, 5, ""},     {"NEG-02", false, 5, ""},     {"NEG-03", true, 3, ""},
      {"NEG-04", false, 4, ""},     {"NEG-05", true, 3, ""},      {"NEG-06", false, 3, ""},
      {"NEG-07", false, 12, ""},    {"NEG-08", false, 2, "0007"}, {"NEG-09", false, 2, "0005"},
      {"NEG-10", false, 2, "0006"}, {"NEG-11", true, 3, ""},      {"NEG-12", false, 2, "0000"},
      {"NEG-13", false, -1, ""},    {"NEG-14", false, -1, ""},    {"NEG-15", false, -1, ""},
      {"NEG-16", false, -1, ""},    {"NEG-17", false, -1, ""},    {"NEG-18", true, 3, ""}};
  const auto all = vectors("negative");
  ASSERT_EQ(all.size(), std::size(table));
  for (const auto& expected : table) {
    const auto packet = vector_of("negative", expected.id).octets;
    EXPECT_EQ(to_be_discarded(packet), expected.discard) << expected.id;
    const auto view = TelecommandView::parse(packet);
    ASSERT_EQ(view.has_value(), expected.code < 0) << expected.id;
    if (view) continue;
    EXPECT_EQ(static_cast<int>(view.error().code()), expected.code) << expected.id;
    EXPECT_EQ(to_hex(view.error().data()), expected.data) << expected.id;
  }
}

TEST(Telecommand, RefusesEverySingleBitError) {
  const Bytes good = from_hex(ping);
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes damaged = good;
    damaged[bit / 8] ^= static_cast<std::byte>(0x80 >> bit % 8);
    EXPECT_FALSE(TelecommandView::parse(damaged).has_value()) << "bit " << bit;
  }
}

TEST(Telemetry, RefusesEverySingleBitError) {
  const Bytes good = vector_of("tm", "TM-04").octets;
  for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
    Bytes damaged = good;
    damaged[bit / 8] ^= static_cast<std::byte>(0x80 >> bit % 8);
    EXPECT_FALSE(TelemetryView::parse(damaged).has_value()) << "bit " << bit;
  }
}

TEST(Telecommand, HasEveryLengthFromThirteenToItsLimit) {
  const Bytes data(max_telecommand_octets);
  Bytes buffer(max_telecommand_octets + 10);
  for (std::size_t length = 0; length <= max_telecommand_octets; length += length < 100 ? 1 : 37) {
    const auto packet = write_telecommand(buffer, {.apid = 10}, Octets{data}.first(length));
    ASSERT_EQ(packet.has_value(), length + 13 <= max_telecommand_octets) << length;
    if (!packet) continue;
    EXPECT_EQ(packet->size(), length + 13);
    EXPECT_EQ(announced_octets(*packet), packet->size());
    EXPECT_EQ(TelecommandView::parse(exact(*packet)).value().application_data().size(), length);
  }
  EXPECT_TRUE(write_telecommand(buffer, {.apid = 10}, Octets{data}.first(max_telecommand_octets - 13)).has_value());
  EXPECT_FALSE(write_telecommand(buffer, {.apid = 10}, Octets{data}.first(max_telecommand_octets - 12)).has_value());
}

TEST(Telemetry, HasEveryLengthFromTwentyTwoToItsLimit) {
  const Bytes data(max_telemetry_octets);
  Bytes buffer(max_telemetry_octets + 10);
  for (std::size_t length = 0; length < 100; ++length) {
    const auto packet = write_telemetry(buffer, {.apid = 10}, Octets{data}.first(length));
    EXPECT_EQ(TelemetryView::parse(exact(packet.value())).value().source_data().size(), length);
  }
  EXPECT_TRUE(write_telemetry(buffer, {.apid = 10}, Octets{data}.first(max_telemetry_octets - 22)).has_value());
  EXPECT_FALSE(write_telemetry(buffer, {.apid = 10}, Octets{data}.first(max_telemetry_octets - 21)).has_value());
}

TEST(Telecommand, RefusesZerosOfEveryLength) {
  for (std::size_t length = 0; length <= 100; ++length)
    EXPECT_FALSE(TelecommandView::parse(Bytes(length)).has_value()) << length;
  for (const std::size_t length : {4095U, 4096U, 4097U, 65542U})
    EXPECT_FALSE(TelecommandView::parse(Bytes(length)).has_value()) << length;
}

TEST(Telecommand, RefusesEveryTruncationAndExtension) {
  const Bytes whole = vector_of("tc", "TC-08").octets;
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(TelecommandView::parse(exact(Octets{whole}.first(length))).has_value()) << length;
  Bytes longer = whole;
  longer.emplace_back();
  EXPECT_EQ(TelecommandView::parse(longer).error().code(), FailureCode::IllegalLength);
}

TEST(Telecommand, RefusesEveryLyingLengthFieldEvenWithARightChecksum) {
  const Bytes good = from_hex(ping);
  for (unsigned length = 0; length <= 0xFFFF; length += length < 64 ? 1 : 251) {
    if (length + 7 == good.size()) continue;
    Bytes lying = good;
    lying[4] = static_cast<std::byte>(length >> 8);
    lying[5] = static_cast<std::byte>(length & 0xFF);
    const auto view = TelecommandView::parse(sealed(lying));
    ASSERT_FALSE(view.has_value()) << length;
    EXPECT_EQ(view.error().code(), FailureCode::IllegalLength) << length;
    EXPECT_EQ(OctetReader{view.error().data()}.get<std::uint16_t>(), length);
  }
}

TEST(Telecommand, ChecksInTheOrderOfTheTailoring) {
  // Damaged in all ways at once, then repaired one by one from the front.
  Bytes packet = from_hex("3010402800ff1f1101000073ab");
  const auto code = [&packet] { return static_cast<int>(TelecommandView::parse(packet).error().code()); };
  EXPECT_TRUE(to_be_discarded(packet));
  packet[0] = std::byte{0x10};
  EXPECT_FALSE(to_be_discarded(packet));
  EXPECT_EQ(code(), 2);
  packet[5] = std::byte{6};
  EXPECT_EQ(code(), 3);
  packet[0] = std::byte{0x18};
  EXPECT_EQ(code(), 12);
  packet[2] = std::byte{0xC0};
  EXPECT_EQ(code(), 5);
  packet = sealed(packet);
  EXPECT_EQ(code(), 4);
  packet[6] = std::byte{0x2F};
  EXPECT_TRUE(TelecommandView::parse(sealed(packet)).has_value());
}

TEST(Telecommand, SurvivesRandomOctets) {
  std::mt19937 random{2};
  for (int round = 0; round < 20000; ++round) {
    Bytes noise(random() % 64);
    for (auto& octet : noise) octet = static_cast<std::byte>(random());
    if (noise.size() > 6 && round % 2 == 0) {
      noise[0] = std::byte{0x18};
      noise[2] |= std::byte{0xC0};
      noise[4] = {};
      noise[5] = static_cast<std::byte>(noise.size() - 7);
      if (noise.size() >= 13) noise = sealed(noise);
    }
    if (const auto view = TelecommandView::parse(noise)) {
      EXPECT_EQ(view->application_data().size() + 13, noise.size());
    }
    if (const auto view = TelemetryView::parse(noise)) {
      EXPECT_EQ(view->source_data().size() + 22, noise.size());
    }
  }
}

TEST(Packets, AreNotWrittenForApidsOfIdlePacketsOrIntoSmallBuffers) {
  Bytes buffer(22);
  EXPECT_EQ(write_telecommand(buffer, {.apid = 2047}, {}).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(write_telemetry(buffer, {.apid = 2047}, {}).error().code, ErrorCode::OutOfRange);
  EXPECT_TRUE(write_telemetry(buffer, {.apid = 2046}, {}).has_value());
  EXPECT_EQ(write_telemetry(MutableOctets{buffer}.first(21), {.apid = 1}, {}).error().code,
            ErrorCode::ResourceExhausted);
  EXPECT_EQ(write_telecommand(MutableOctets{buffer}.first(12), {.apid = 1}, {}).error().code,
            ErrorCode::ResourceExhausted);
}

TEST(Packets, WrapTheSequenceCountAtFourteenBits) {
  Bytes buffer(32);
  const auto packet = write_telecommand(buffer, {.apid = 1, .sequence_count = 16384 + 5}, {});
  EXPECT_EQ(TelecommandView::parse(packet.value()).value().sequence_count(), 5);
}

}  // namespace
}  // namespace hirosco::pus
