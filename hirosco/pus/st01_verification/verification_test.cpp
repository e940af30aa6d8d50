// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/st01_verification/instructions.hpp"
#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Sends the report of this subtype, with the arguments that a vector's fields give.
void report(Verification& verification, std::uint8_t subtype, const Request& request, const nlohmann::json& fields) {
  FailureNotice notice;
  if (!fields.at("code").is_null()) {
    notice = FailureNotice{static_cast<FailureCode>(fields.at("code").get<std::uint16_t>())};
    notice.with(Octets{from_hex(fields.at("failure_data").get<std::string>())});
  }
  const std::uint16_t step = fields.at("step").is_null() ? std::uint16_t{0} : fields.at("step").get<std::uint16_t>();
  switch (subtype) {
    case 1: return verification.accepted(request);
    case 2: return verification.rejected(request, notice);
    case 3: return verification.started(request);
    case 4: return verification.start_failed(request, notice);
    case 5: return verification.progressed(request, step);
    case 6: return verification.progress_failed(request, step, notice);
    case 7: return verification.completed(request);
    case 8: return verification.completion_failed(request, notice);
    case 10: return verification.routing_failed(request, notice);
    default: FAIL() << "subtype " << int{subtype};
  }
}

TEST(Verification, ReproducesTheVectorsOfAllNineReports) {
  for (const auto& vector : vectors("st01")) {
    const auto view = TelemetryView::parse(vector.octets);
    ASSERT_TRUE(view.has_value()) << vector.id;
    RecordingSink sink;
    Verification verification{sink};
    const auto id =
        static_cast<std::uint32_t>(std::stoul(vector.fields.at("request_id").get<std::string>(), nullptr, 16));
    report(verification, view->subtype(), {id, view->destination(), ack_all}, vector.fields);
    ASSERT_EQ(sink.reports.size(), 1U) << vector.id;
    TelemetryHeader header = telemetry_header(vector.fields);
    header.service = sink.reports[0].service;
    header.subtype = sink.reports[0].subtype;
    Bytes buffer(64);
    EXPECT_EQ(to_hex(write_telemetry(buffer, header, sink.reports[0].data).value()), to_hex(vector.octets))
        << vector.id;
  }
}

TEST(Verification, ReportsSuccessOnlyWhereItIsAskedFor) {
  for (unsigned ack = 0; ack < 16; ++ack) {
    RecordingSink sink;
    Verification verification{sink};
    const Request request{1, 0, static_cast<std::uint8_t>(ack)};
    verification.accepted(request);
    verification.started(request);
    verification.progressed(request, 1);
    verification.completed(request);
    std::vector<int> subtypes;
    for (const auto& one : sink.reports) subtypes.push_back(one.subtype);
    std::vector<int> asked;
    for (int stage = 0; stage < 4; ++stage)
      if ((ack >> stage & 1) != 0) asked.push_back(2 * stage + 1);
    EXPECT_EQ(subtypes, asked) << ack;
  }
}

TEST(Verification, ReportsFailureAlways) {
  RecordingSink sink;
  Verification verification{sink};
  const Request request{0x180AC005, 9, 0};
  verification.rejected(request, FailureNotice{FailureCode::UnknownService}.with(std::uint8_t{0xFA}));
  verification.start_failed(request, FailureNotice{FailureCode::Busy});
  verification.progress_failed(request, 2, FailureNotice{FailureCode::Timeout});
  verification.completion_failed(request, FailureNotice{FailureCode::Aborted});
  verification.routing_failed(request, FailureNotice{FailureCode::UnknownApid});
  EXPECT_EQ(sink.reports[0].destination, 9);
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac0050006fa", "1.4 180ac0050108", "1.6 180ac00500020203",
                                       "1.8 180ac0050204", "1.10 180ac0050001"));
}

struct Instructions : ::testing::Test {
  RecordingSink sink;
  Verification verification{sink};
  Request request{0x180AC001, 0, ack_all};
  std::vector<std::size_t> executed;
  void run(std::size_t count, std::size_t bad_from) {
    run_instructions(
        verification, request, count,
        [bad_from](std::size_t i) -> std::optional<FailureNotice> {
          if (i < bad_from) return std::nullopt;
          return instruction_failure(FailureCode::UnknownIdentifier, i, 77);
        },
        [this](std::size_t i) { executed.push_back(i); });
  }
};

TEST_F(Instructions, StartAndCompleteWhenAllAreValid) {
  run(2, 2);
  EXPECT_THAT(executed, ElementsAre(0, 1));
  EXPECT_THAT(sink.take(), ElementsAre("1.3 180ac001", "1.7 180ac001"));
}

TEST_F(Instructions, ExecuteTheValidOnesAndEndInPartWhenSomeAreNot) {
  run(3, 1);
  EXPECT_THAT(executed, ElementsAre(0));
  EXPECT_THAT(sink.take(),
              ElementsAre("1.4 180ac0010101010000004d", "1.4 180ac0010101020000004d", "1.8 180ac00102010102"));
}

TEST_F(Instructions, EndWithTheStartFailuresWhenNoneIsValid) {
  run(1, 0);
  EXPECT_THAT(executed, IsEmpty());
  EXPECT_THAT(sink.take(), ElementsAre("1.4 180ac0010101000000004d"));
}

}  // namespace
}  // namespace hirosco::pus
