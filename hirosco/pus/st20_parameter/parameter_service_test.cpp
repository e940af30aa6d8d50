// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st20_parameter/parameter_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Parameters in memory; a value that begins with ff is not acceptable, id 5 is read-only, id 6 cannot be read.
struct Values final : ParameterAccess {
  std::map<std::uint32_t, Bytes> values{{0x00010001, from_hex("03e8")},
                                        {0x00010002, from_hex("3fc00000")},
                                        {5, from_hex("05")},
                                        {6, from_hex("06")},
                                        {7, Bytes(4000)}};
  std::optional<FailureCode> no_room;
  int groups{0};
  int snapshots{0};
  void begin_report() override { ++snapshots; }
  std::expected<std::size_t, ErrorCode> read(std::uint32_t id, MutableOctets value) override {
    if (id == 6) return std::unexpected{ErrorCode::Unavailable};
    std::ranges::copy(values.at(id), value.begin());
    return values.at(id).size();
  }
  std::size_t size_of(std::uint32_t id) override { return values.contains(id) ? values.at(id).size() : 0; }
  std::expected<void, FailureCode> check_write(std::uint32_t id, Octets value) override {
    if (id == 5) return std::unexpected{FailureCode::NotPermittedNow};
    if (value[0] == std::byte{0xFF}) return std::unexpected{FailureCode::ValueNotAcceptable};
    return {};
  }
  std::expected<void, FailureCode> submit_write(std::span<const Write> writes, const Request&) override {
    if (no_room) return std::unexpected{*no_room};
    ++groups;
    for (const auto& write : writes) values[write.id] = Bytes(write.value.begin(), write.value.end());
    return {};
  }
};

struct ParameterRequests : ::testing::Test {
  void SetUp() override {
    sink.value_octets = [this](std::uint32_t id) { return std::optional{values.size_of(id)}; };
  }
  RecordingSink sink;
  Verification verification{sink};
  Values values;
  ParameterService service{values, verification, sink};
};

TEST_F(ParameterRequests, ReportValuesAsInTheVectors) {
  handle(service, vector_of("st20", "ST20-A").octets);
  EXPECT_THAT(
      sink.take(),
      ElementsAre("1.1 180ac08a", "20.2 " + vector_of("st20", "ST20-B").fields.at("source_data").get<std::string>(),
                  "1.7 180ac08a"));
  EXPECT_EQ(values.snapshots, 1);
}

TEST_F(ParameterRequests, SetAValueAsInTheVector) {
  handle(service, vector_of("st20", "ST20-C").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac08c", "1.3 180ac08c", "1.7 180ac08c"));
  EXPECT_EQ(to_hex(values.values[0x00010002]), "40000000");
}

TEST_F(ParameterRequests, ReportTheKnownOnesAndRejectTheOthers) {
  send(service, 1,
       "03"
       "000100ff"
       "00010001"
       "00000006");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac001010100000100ff", "1.4 180ac001010702",
                                       "20.2 010001000103e8", "1.8 180ac00102010102"));
}

TEST_F(ParameterRequests, SendNoReportWhenNoneIsKnown) {
  send(service, 1,
       "01"
       "00000063");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac00101010000000063"));
}

TEST_F(ParameterRequests, RejectWhatDoesNotFitOnePacket) {
  send(service, 1,
       "02"
       "00000007"
       "00000007",
       0);
  ASSERT_EQ(sink.reports.size(), 3U);
  EXPECT_EQ(sink.reports[0].text(), "1.4 180ac001010401");
  EXPECT_EQ(sink.reports[1].data.size(), 4005U);
  EXPECT_EQ(sink.reports[2].text(), "1.8 180ac00102010101");
}

TEST_F(ParameterRequests, SetNothingWhenAnyIdIsUnknown) {
  send(service, 3,
       "02"
       "00010001"
       "1234"
       "00000063"
       "01");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac00101010100000063"));
  EXPECT_EQ(to_hex(values.values[0x00010001]), "03e8");
}

TEST_F(ParameterRequests, SetAllValuesOfARequestAsOneGroup) {
  send(service, 3,
       "02"
       "00010001"
       "1234"
       "00010002"
       "40000000");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.3 180ac001", "1.7 180ac001"));
  EXPECT_EQ(values.groups, 1);
}

TEST_F(ParameterRequests, SetNoneWhenAnyIsRefusedAndNameEachThatIs) {
  send(service, 3,
       "03"
       "00010001"
       "1234"
       "00000005"
       "01"
       "00010002"
       "ff000000");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac00101070100000005", "1.4 180ac00101050200010002"));
  EXPECT_EQ(values.groups, 0);
  EXPECT_EQ(to_hex(values.values[0x00010001]), "03e8");
  EXPECT_EQ(to_hex(values.values[0x00010002]), "3fc00000");
}

TEST_F(ParameterRequests, FailToStartWhenTheCycleCannotTakeThem) {
  values.no_room = FailureCode::Busy;
  send(service, 3,
       "01"
       "00010001"
       "1234");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac0010108"));
}

TEST_F(ParameterRequests, FailToStartWhenTheyAreMoreThanTheCycleEverTakes) {
  values.no_room = FailureCode::CapacityExceeded;
  send(service, 3,
       "02"
       "00010001"
       "1234"
       "00010002"
       "40000000");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac001010401"));
}

TEST_F(ParameterRequests, AreRejectedAtEveryWrongLength) {
  const std::string set =
      "02"
      "00010001"
      "1234"
      "00010002"
      "40000000";
  for (std::size_t octets = 0; octets < set.size() / 2; ++octets) {
    send(service, 3, set.substr(0, 2 * octets));
    EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac0010008")) << octets;
  }
  send(service, 3, set + "00");
  send(service, 1,
       "02"
       "00010001");
  send(service, 3, "00");
  send(service, 1, "00");
  send(service, 4, "");
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac0010008", "1.2 180ac0010008", "1.2 180ac00100090000",
                                       "1.2 180ac00100090000", "1.2 180ac00100071404"));
}

}  // namespace
}  // namespace hirosco::pus
