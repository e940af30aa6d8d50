// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "hirosco/pus/testing/report_shape.hpp"

namespace hirosco::pus::st129 {
namespace {

constexpr std::array small_packet{std::byte{1}, std::byte{2}};

ModePreview small() { return {.mode = 3, .against = {"ARM is down"}, .steps = {{1, 10, "Pre"}, {2, 258, ""}}}; }

TEST(ModePreview, StandsAsItsShapeSaysOctetByOctet) {
  std::vector<std::byte> buffer(max_preview_octets);
  const Octets written = write_mode_preview(buffer, small());
  std::vector<int> octets;
  for (const std::byte each : written) octets.push_back(std::to_integer<int>(each));
  const std::vector<int> expected{3,   1, 11, 'A', 'R', 'M', ' ', 'i', 's', ' ', 'd', 'o', 'w',
                                  'n', 2, 1,  0,   10,  3,   'P', 'r', 'e', 2,   1,   2,   0};
  EXPECT_EQ(octets, expected);
}

TEST(ModePreview, IsReadAsItWasWrittenAndNothingElseIs) {
  std::vector<std::byte> buffer(max_preview_octets);
  const Octets written = write_mode_preview(buffer, small());
  const auto read = read_mode_preview(written);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->mode, 3);
  EXPECT_EQ(read->against, small().against);
  ASSERT_EQ(read->steps.size(), 2U);
  EXPECT_EQ(read->steps[0].what, "Pre");
  EXPECT_EQ(read->steps[1].subject, 258);
  for (std::size_t octets = 0; octets < written.size(); ++octets)
    EXPECT_FALSE(read_mode_preview(written.first(octets))) << octets;
  std::vector<std::byte> longer{written.begin(), written.end()};
  longer.push_back(std::byte{0});
  EXPECT_FALSE(read_mode_preview(longer));
}

TEST(ModePreview, StepsThatFindNoRoomAreLeftOutAndNotCountedReasonsStay) {
  ModePreview preview = small();
  preview.steps.assign(300, {1, 10, std::string(100, 'x')});
  std::vector<std::byte> buffer(max_preview_octets);
  const auto read = read_mode_preview(write_mode_preview(buffer, preview));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->against.size(), 1U);
  EXPECT_EQ(read->steps.size(), (max_preview_octets - 15) / 104);
  preview.steps.assign(300, {1, 10, ""});
  EXPECT_EQ(read_mode_preview(write_mode_preview(buffer, preview))->steps.size(), 255U);
}

TEST(Retrieve, StandsAsItsShapeSaysOctetByOctet) {
  const OnboardTime second{std::chrono::seconds{0x0102'0304}};
  const auto data = write_retrieve({second, second + 500ms, false});
  std::vector<int> octets;
  for (const std::byte each : data) octets.push_back(std::to_integer<int>(each));
  EXPECT_EQ(octets, (std::vector<int>{1, 2, 3, 4, 0, 0, 0, 1, 2, 3, 4, 0x80, 0, 0, 0}));
  EXPECT_EQ(read_retrieve(data), (Retrieve{second, second + 500ms, false}));
}

TEST(Retrieve, WhatIsShorterLongerOrNeitherYesNorNoIsNone) {
  const auto data = write_retrieve({});
  ASSERT_TRUE(read_retrieve(data));
  for (std::size_t octets = 0; octets < data.size(); ++octets) EXPECT_FALSE(read_retrieve(Octets{data}.first(octets)));
  std::vector<std::byte> other{data.begin(), data.end()};
  other.back() = std::byte{2};
  EXPECT_FALSE(read_retrieve(other));
  other.back() = std::byte{1};
  other.push_back(std::byte{0});
  EXPECT_FALSE(read_retrieve(other));
}

TEST(Retrieved, IsANumberAndThePacketAsItWas) {
  const std::vector<std::byte> packet(max_retrieved_octets, std::byte{7});
  std::array<std::byte, max_telemetry_octets> buffer;
  const auto read = read_retrieved(write_retrieved(buffer, {0x0102'0304'0506'0708, packet}));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->number, 0x0102'0304'0506'0708U);
  EXPECT_TRUE(std::ranges::equal(read->packet, packet));
  EXPECT_EQ(buffer[7], std::byte{8}) << "the number's last octet";
  const std::vector<std::byte> longer(max_retrieved_octets + 1);
  EXPECT_TRUE(write_retrieved(buffer, {1, longer}).empty()) << "it would not fit into a report";
  EXPECT_FALSE(read_retrieved(Octets{packet}.first(7)));
}

TEST(RetrievalEnd, IsWholeOnlyIfNothingIsMissing) {
  const RetrievalEnd whole{.reports = 300}, early{.reports = 2, .why = "asked anew"};
  EXPECT_TRUE(whole.whole());
  EXPECT_FALSE(early.whole());
  EXPECT_FALSE((RetrievalEnd{.left_out = 1}.whole()));
  EXPECT_FALSE((RetrievalEnd{.missing = 1}.whole()));
  EXPECT_FALSE((RetrievalEnd{.damaged = 1}.whole()));
  for (const RetrievalEnd& end : {whole, early, RetrievalEnd{5, 1, 2, 3, 4, "x"}}) {
    const auto data = write_retrieval_end(end);
    EXPECT_EQ(read_retrieval_end(data), end);
    EXPECT_FALSE(read_retrieval_end(Octets{data}.first(data.size() - 1)));
  }
}

TEST(Supervision, WritesEveryReportAndReadsEveryRequestInItsShape) {
  std::array<std::byte, max_telemetry_octets> buffer;
  const auto unlike = [](std::uint8_t subtype, Octets data) {
    return testing::unlike_its_shape(service_type, subtype, data);
  };
  EXPECT_EQ(unlike(mode_preview, write_mode_preview(buffer, small())), "");
  EXPECT_EQ(unlike(plan_preview, write_plan_preview(buffer, {10, 3, 2, 1, "p", {"why"}, {{1, 10, "Pre"}}})), "");
  EXPECT_EQ(unlike(descriptor_problem, write_descriptor_problem({10, 1, "a.xml", 2, 3, "E0104", "what", "hint"})), "");
  EXPECT_EQ(unlike(retrieved, write_retrieved(buffer, {7, small_packet})), "");
  EXPECT_EQ(unlike(retrieval_end, write_retrieval_end({5, 1, 2, 3, 4, "x"})), "");
  const auto differs = [](std::uint8_t subtype, Octets data) {
    return testing::ShapeWalk{data, {}}.differs_from(service_kind.request(subtype)->data);
  };
  EXPECT_EQ(differs(subscribe, write_subscribed({10, Subscribed::What::Event, 3})), "");
  EXPECT_EQ(differs(unsubscribe, write_subscribed({10, Subscribed::What::Structure, 3})), "");
  EXPECT_EQ(differs(retrieve, write_retrieve({})), "");
}

}  // namespace
}  // namespace hirosco::pus::st129
