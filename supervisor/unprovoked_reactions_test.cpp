// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/unprovoked_reactions.hpp"

#include <gtest/gtest.h>

namespace hirosco::supervisor {
namespace {

struct Nobody final : Observer {
  void told(OnboardTime, std::string_view) override {}
  void routed(const pus::TelemetryView&) override {}
};

class ReactionCauses : public ::testing::Test {
 protected:
  ReactionCauses() { clock.advance(std::chrono::hours{1}); }
  void tell(std::string_view line) { causes.told(clock.onboard(), line); }

  ManualClock clock;
  Nobody nobody;
  UnprovokedReactions causes{clock, nobody};
};

TEST_F(ReactionCauses, AreMissedOfANetworkThatGoesDownAndOfAnEventOfHighSeverityOnly) {
  tell("ARM medium TORQUE_LIMIT_EXCEEDED");
  tell("plan limit: ARM to Safe-Operational because of TORQUE_LIMIT_EXCEEDED");
  EXPECT_TRUE(causes.uncommanded().empty());
  tell("ARM high SENSOR_BROKEN");
  tell("plan broken: ARM to Post-Operational because of SENSOR_BROKEN");
  EXPECT_EQ(causes.uncommanded().size(), 1U);
  tell("plan died: network {ARM, HAND}");
  EXPECT_EQ(causes.uncommanded().size(), 2U);
}

TEST_F(ReactionCauses, AreFoundInAStopBySomebodyForAsLongAsThatMayHaveEffects) {
  tell("stop by signal or local socket: every actuator inhibited");
  clock.advance(UnprovokedReactions::limit);
  tell("plan died: network {ARM, HAND}");
  EXPECT_TRUE(causes.uncommanded().empty());
  clock.advance(std::chrono::milliseconds{1});
  tell("plan died: network {ARM, HAND}");
  EXPECT_EQ(causes.uncommanded().size(), 1U);
}

}  // namespace
}  // namespace hirosco::supervisor
