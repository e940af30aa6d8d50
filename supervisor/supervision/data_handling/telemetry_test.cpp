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

TEST_F(TelemetryTest, FailuresAreCountedByTheirCodeThoseOfAuthorsTogether) {
  start_all(Operational);
  verify(arm, 1, 4, pus::FailureCode::WrongMode, 0);
  verify(arm, 2, 8, static_cast<pus::FailureCode>(0x8001), 0);
  verify(arm, 3, 7, {}, 0);
  EXPECT_EQ(parts.traffic.rejections()[static_cast<std::size_t>(pus::FailureCode::WrongMode)], 1U);
  EXPECT_EQ(parts.traffic.rejections()[0], 1U);
}

}  // namespace
}  // namespace hirosco::supervisor
