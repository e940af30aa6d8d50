// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/telemetry.hpp"

#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor {
namespace {

using namespace testing;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using enum descriptor::State;

struct TelemetryTest : PartsTest {
  /// Reports that the ground link was given to pass on.
  std::size_t passed_on() {
    parts.telemetry.serve_ground();
    MessageBuffer buffer;
    for (std::size_t count = 0;; ++count) {
      const auto next = played[camera].channel.subsystem_end().receive(buffer);
      if (!next || next->flow == Flow::None) return count;
    }
  }
};

TEST_F(TelemetryTest, EachPacketIsLoggedShownAndGoesToTheGroundLink) {
  start_all(Operational);
  report(arm, 17, 2, {});
  EXPECT_THAT(routed_services, ElementsAre(17));
  EXPECT_EQ(passed_on(), 1U);
  EXPECT_EQ(parts.traffic.counts.telemetry, 1U);
}

TEST_F(TelemetryTest, APacketThatClaimsAnotherSenderIsCountedAndGoesNowhere) {
  start_all(Operational);
  report(arm, 17, 2, {}, 0, hand);
  EXPECT_THAT(routed_services, IsEmpty());
  EXPECT_EQ(passed_on(), 0U);
  EXPECT_EQ(parts.traffic.counts.misdirected, 1U);
  EXPECT_EQ(craft.member(arm)->unreadable, 1U);
}

TEST_F(TelemetryTest, WithoutAGroundLinkItIsLoggedAllTheSame) {
  start_all(Operational);
  set(camera, Offline);
  report(arm, 17, 2, {});
  EXPECT_THAT(routed_services, ElementsAre(17));
  EXPECT_EQ(passed_on(), 0U);
}

TEST_F(TelemetryTest, FailuresAreCountedByTheirCodeThoseOfServicesAndAuthorsTogether) {
  start_all(Operational);
  std::uint16_t count = 0;
  for (std::uint16_t code = 1; code <= 18; ++code)
    for (std::uint16_t times = 0; times < code; ++times)
      verify(arm, ++count, 2, static_cast<pus::FailureCode>(code), 0);
  verify(arm, ++count, 4, pus::FailureCode::ValueNotAcceptable, 0);
  verify(arm, ++count, 8, static_cast<pus::FailureCode>(0x8001), 0);
  verify(arm, ++count, 7, {}, 0);
  EXPECT_THAT(parts.traffic.rejections(),
              ElementsAre(2, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18));
}

}  // namespace
}  // namespace hirosco::supervisor
