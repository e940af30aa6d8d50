// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st17_test/test_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/pus/testing/recording_sink.hpp"

namespace hirosco::pus {
namespace {
using namespace testing;
using ::testing::ElementsAre;

struct Ping : ::testing::Test {
  RecordingSink sink;
  Verification verification{sink};
  TestService service{verification, sink};
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

}  // namespace
}  // namespace hirosco::pus
