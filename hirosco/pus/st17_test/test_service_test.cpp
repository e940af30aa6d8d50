// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st17_test/test_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "hirosco/pus/testing/played_self_test.hpp"
#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using ::testing::ElementsAre;

struct Ping : ::testing::Test {
  RecordingSink sink;
  Verification verification{sink};
  PlayedSelfTest self_test;
  TestService service{verification, sink, self_test};
};

TEST_F(Ping, IsAnsweredToItsSource) {
  send(service, 1, "");
  ASSERT_EQ(sink.reports.size(), 4U);
  for (const auto& report : sink.reports) EXPECT_EQ(report.destination, test_source);
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.3 180ac001", "17.2", "1.7 180ac001"));
}

TEST_F(Ping, IsAnsweredWithoutVerificationWhenNoneIsAskedFor) {
  send(service, 1, "", 0);
  EXPECT_THAT(sink.take(), ElementsAre("17.2"));
}

TEST_F(Ping, OfTheVectorsGivesTheReplyOfTheVectors) {
  handle(service, vector_of("tc", "TC-01").octets);
  ASSERT_EQ(sink.reports.size(), 4U);
  const auto reply = vector_of("tm", "TM-01");
  Bytes buffer(64);
  const auto packet = write_telemetry(buffer, telemetry_header(reply.fields), sink.reports[2].data);
  EXPECT_EQ(to_hex(packet.value()), to_hex(reply.octets));
}

TEST_F(Ping, WithDataIsRejected) {
  handle(service, vector_of("negative", "NEG-16").octets);
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac02d0008"));
}

TEST_F(Ping, OfAnUnknownSubtypeIsRejectedWithServiceAndSubtype) {
  handle(service, vector_of("negative", "NEG-15").octets);
  send(service, 3, "000a");
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac02c00071163", "1.2 180ac00100071103"));
}

using SelfTestRequest = Ping;

TEST_F(SelfTestRequest, IsAcceptedAndHandedOnToWhoeverRunsIt) {
  send(service, TestService::run_self_test, "");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001")) << "who runs it says the rest";
  ASSERT_EQ(self_test.asked.size(), 1U);
  EXPECT_EQ(self_test.asked.front().source, test_source);
}

TEST_F(SelfTestRequest, ThatIsRefusedHasNotStarted) {
  self_test.refusal = FailureNotice{FailureCode::WrongState}.with(std::uint8_t{5});
  send(service, TestService::run_self_test, "");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.4 180ac001000a05"));
}

TEST_F(SelfTestRequest, WithDataIsRejected) {
  send(service, TestService::run_self_test, "00");
  send(service, TestService::report_self_test, "00");
  EXPECT_THAT(sink.take(), ElementsAre("1.2 180ac0010008", "1.2 180ac0010008"));
  EXPECT_TRUE(self_test.asked.empty());
}

TEST_F(SelfTestRequest, OfItsOutcomeIsAnsweredWithWhatIsKnown) {
  send(service, TestService::report_self_test, "");
  EXPECT_THAT(sink.take(), ElementsAre("1.1 180ac001", "1.3 180ac001",
                                       "17.129 00"
                                       "00"
                                       "00000000000000"
                                       "0000"
                                       "0000000000000000"
                                       "00",
                                       "1.7 180ac001"));
  self_test.newest = {.outcome = SelfTestOutcome::Failed,
                      .configuration = 2,
                      .at = OnboardTime{std::chrono::milliseconds{1'000'500}},
                      .code = FailureCode::ExecutionError,
                      .number = -3,
                      .reason = "no"};
  send(service, TestService::report_self_test, "", 0);
  EXPECT_THAT(sink.take(), ElementsAre("17.129 02"
                                       "02"
                                       "000003e8800000"
                                       "0202"
                                       "fffffffffffffffd"
                                       "02"
                                       "6e6f"));
}

TEST(SelfTestReport, CutsWordsThatAreLongerThanAReasonMayBe) {
  SelfTestRecord record{.outcome = SelfTestOutcome::Failed};
  record.reason = std::string(300, 'a');
  std::array<std::byte, max_self_test_octets> room;
  const Octets data = write_self_test(room, record);
  EXPECT_EQ(data.size(), 1 + 1 + cuc_octets + 2 + 8 + 1 + FailureNotice::max_reason_text_octets);
  EXPECT_EQ(data[data.size() - FailureNotice::max_reason_text_octets - 1],
            std::byte{FailureNotice::max_reason_text_octets});
}

TEST(SelfTestRequests, AreForSafeOperationalWhereTheModeOpensThemWhileAPingIsForEverybody) {
  const ServiceKind& kind = *standard_service(TestService::service_type);
  for (int state = 0; state < 10; ++state)
    EXPECT_EQ((kind.request(TestService::run_self_test)->states >> state & 1) != 0,
              static_cast<descriptor::State>(state) == descriptor::State::SafeOperational);
  EXPECT_EQ(kind.needs_of(TestService::run_self_test), Needs::Nothing);
  EXPECT_EQ(kind.needs_of(TestService::report_self_test), Needs::Nothing);
  EXPECT_EQ(kind.needs_of(TestService::are_you_alive), Needs::Essential);
  EXPECT_EQ(kind.needs_of(99), Needs::Essential) << "as its service";
}

}  // namespace
}  // namespace hirosco::pus
