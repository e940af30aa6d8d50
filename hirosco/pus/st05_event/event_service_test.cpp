// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st05_event/event_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using descriptor::Severity;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

descriptor::Field field(Type type, std::uint16_t count = 1) {
  descriptor::Field made;
  made.type = type;
  made.count = count;
  return made;
}

struct Events : ::testing::Test {
  std::vector<descriptor::Event> declared{
      {"A", 17, Severity::Info, {}, {}},
      {"B", 18, Severity::Low, {field(Type::Uint16)}, {}},
      {"C", 19, Severity::Medium, {field(Type::Float), field(Type::Uint8)}, {}},
      {"D", 20, Severity::High, {field(Type::Uint32)}, {}},
  };
  RecordingSink sink;
  Verification verification{sink};
  EventService service{declared, verification, sink};
};

TEST_F(Events, AreReportedAsInTheVectorsWithTheirSeverityAsSubtype) {
  const std::vector<double> values[] = {{}, {500}, {-2.5, 7}, {4294967295}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto vector = vector_of("st05", "ST05-R" + std::to_string(i + 1));
    Bytes buffer(16);
    const auto data = encode_arguments(declared[i], values[i], buffer);
    ASSERT_TRUE(service.raise(declared[i].id, data.value()).has_value());
    const Report report = sink.reports.at(0);
    EXPECT_EQ(report.subtype, static_cast<std::uint8_t>(i + 1));
    EXPECT_EQ(to_hex(report.data), vector.fields.at("source_data").get<std::string>()) << vector.id;
    Bytes packet(64);
    EXPECT_EQ(to_hex(write_telemetry(packet, telemetry_header(vector.fields), report.data).value()),
              to_hex(vector.octets));
    sink.reports.clear();
  }
}

TEST_F(Events, AreSilentWhileDisabledAndSpeakAgainWhenEnabled) {
  handle(service, vector_of("st05", "ST05-A").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac06e", "1.7 180ac06e"));
  EXPECT_TRUE(service.raise(17, {}).has_value());
  EXPECT_THAT(sink.take(), IsEmpty());
  EXPECT_FALSE(service.report_enabled(17));
  send(service, 5, "010011", 0);
  EXPECT_TRUE(service.raise(17, {}).has_value());
  EXPECT_THAT(sink.take(), ElementsAre("5.1 0011"));
}

TEST_F(Events, AreSwitchedWithoutATelecommandAndAReport) {
  service.set_reported(17, false);
  service.set_reported(99, false);
  EXPECT_THAT(sink.take(), IsEmpty());
  EXPECT_FALSE(service.report_enabled(17));
  EXPECT_TRUE(service.report_enabled(18));
  service.set_reported(17, true);
  EXPECT_TRUE(service.report_enabled(17));
}

TEST_F(Events, ListTheDisabledOnesAsInTheVector) {
  send(service, 7, "", 0);
  EXPECT_THAT(sink.take(), ElementsAre("5.8 00"));
  send(service, 6, "0200110012", 0);
  send(service, 7, "", 0);
  EXPECT_THAT(sink.take(),
              ElementsAre("5.8 " + vector_of("st05", "ST05-B").fields.at("source_data").get<std::string>()));
}

TEST_F(Events, ThatAreUnknownAreRejectedAloneInAList) {
  send(service, 6, "0200110063");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac00101010100000063", "1.8 180ac00102010101"));
  EXPECT_FALSE(service.report_enabled(17));
}

TEST_F(Events, RefuseListsOfTheWrongLengthOrWithoutElements) {
  send(service, 6, "");
  send(service, 6, "00");
  send(service, 5, "02001100");
  send(service, 5, "01001100");
  send(service, 7, "00");
  send(service, 9, "");
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac0010008", "1.2 180ac00100090000", "1.2 180ac0010008",
                                       "1.2 180ac0010008", "1.2 180ac0010008", "1.2 180ac00100070509"));
}

TEST_F(Events, AreNotRaisedUnknownOrWithDataOfAnotherLength) {
  EXPECT_EQ(service.raise(99, {}).error().code, ErrorCode::NotFound);
  EXPECT_EQ(service.raise(18, {}).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(service.raise(17, from_hex("00")).error().code, ErrorCode::Mismatch);
  EXPECT_THAT(sink.take(), IsEmpty());
}

TEST_F(Events, SplitALongListOfDisabledOnesIntoSeveralReports) {
  std::vector<descriptor::Event> many;
  for (std::uint16_t id = 1; id <= 300; ++id) many.push_back({"E", id, Severity::Info, {}, {}});
  EventService large{many, verification, sink};
  for (const int first : {1, 151}) {
    Bytes list(1 + 2 * 150);
    OctetWriter writer{list};
    writer.put(std::uint8_t{150});
    for (int i = 0; i < 150; ++i) writer.put(static_cast<std::uint16_t>(first + i));
    send(large, 6, Octets{list}, 0);
  }
  send(large, 7, "", 0);
  ASSERT_EQ(sink.reports.size(), 2U);
  EXPECT_EQ(sink.reports[0].data.size(), 1U + 2 * 255);
  EXPECT_EQ(sink.reports[1].data.size(), 1U + 2 * 45);
}

TEST(EventArguments, HoldValuesAtTheEndsOfTheirType) {
  const descriptor::Event event{"E", 1, Severity::Low, {field(Type::Uint8), field(Type::Int16, 2)}, {}};
  Bytes buffer(5);
  const std::vector<double> values{1e9, -1e9, 2.9};
  EXPECT_EQ(to_hex(encode_arguments(event, values, buffer).value()), "ff80000002");
}

TEST(EventArguments, AreRefusedInAnotherNumberOrWithoutRoom) {
  const descriptor::Event event{"E", 1, Severity::Low, {field(Type::Double)}, {}};
  Bytes buffer(7);
  const std::vector<double> values{1, 2};
  EXPECT_EQ(encode_arguments(event, values, buffer).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(encode_arguments(event, std::span{values}.first(1), buffer).error().code, ErrorCode::ResourceExhausted);
}

}  // namespace
}  // namespace hirosco::pus
