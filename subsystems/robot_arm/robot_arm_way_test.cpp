// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/way_out.hpp"

/// A straight way of joints is judged before the arm goes (docs/adr/0209).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct RobotArmWay : robot_arm::testing::WayOut {
  static constexpr int too_near = 1026;
  static constexpr int longest_judged = 65;  ///< cycles, at 1 kHz

  /// MOTION.PROGRESS, the last of the structure's numbers.
  [[nodiscard]] double told_progress() { return flown.told_number("MOTION"); }
  /// A MOVE_P to where the tip is in that posture, which from `start` is the nearest one.
  hirosco::testing::Sent move_p(const JointVector& posture) {
    robotics::Dynamics dynamics{flown.model, robotics::Base::Fixed};
    dynamics.update({.q = posture, .qd = JointVector::Zero(6)});
    const robotics::Pose tip = dynamics.frame_pose(flown.model.find_frame("tool").value());
    const robotics::Vector3& at = tip.position;
    const robotics::Quaternion turned{tip.rotation};
    return flown.ask("MOVE_P", {at.x(), at.y(), at.z(), turned.w(), turned.x(), turned.y(), turned.z(), 0.5});
  }
};

TEST_F(RobotArmWay, ThatSomebodyIsInIsToldWithThePairAndWhereAndNothingMoves) {
  keep_out(tool_at(turned(0.4)));
  operate();
  const auto request = flown.move_j(turned(0.8));
  flown.cycle(longest_judged);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:800a"));
  EXPECT_THAT(flown.rig.outcome(request), HasSubstr(hex_of("and a volume to keep out of")));
  const double where = told_progress();
  EXPECT_GT(where, 0);
  EXPECT_LT(where, 0.5) << "before the middle, where the ball is";
  flown.cycle(500);
  EXPECT_LT(flown.off(start), 1e-3);
  EXPECT_EQ(flown.rig.events(too_near), 0) << "it was not stopped on its way";
  const auto next = flown.move_j(turned(-0.4));
  flown.finish(next);
  EXPECT_EQ(flown.rig.outcome(next), done);
  EXPECT_EQ(told_progress(), 1) << "of the motion that was gone";
}

TEST_F(RobotArmWay, OfAPoseIsJudgedAsThatOfJoints) {
  keep_out(tool_at(turned(0.3)));
  operate();
  const auto request = move_p(turned(0.6));
  flown.cycle(50 + longest_judged);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:800a"));
  EXPECT_EQ(flown.rig.events(too_near), 0);
  EXPECT_LT(flown.off(start), 1e-3);
}

/// Judged in 64 cycles; 50 later it has come by a thousandth.
TEST_F(RobotArmWay, ThatIsFreeIsGoneAMomentLaterHoweverFarItIs) {
  operate();
  const auto request = flown.move_j(turned(2.4));
  flown.cycle(120);
  EXPECT_GT(flown.off(start), 1e-4) << "it moves";
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), done);
}

/// The ball stands 7 mm before the flange, with all other links farther from it on one side.
TEST_F(RobotArmWay, AwayFromWhoIsTooNearAlreadyIsGoneAndNotThroughHim) {
  keep_out(tool_at(turned(0.1)));
  operate();
  const auto through = flown.move_j(turned(0.6));
  flown.cycle(longest_judged);
  EXPECT_THAT(flown.rig.outcome(through), StartsWith("1 3 8:800a"));
  const auto away = flown.move_j(turned(-0.6));
  flown.finish(away);
  EXPECT_EQ(flown.rig.outcome(away), done);
  EXPECT_EQ(flown.rig.events(too_near), 0);
}

TEST_F(RobotArmWay, IsGoneByNobodyWhoIsToldToHoldOrToStopWhileItIsJudged) {
  operate();
  for (const char* function : {"HOLD", "STOP"}) {
    const auto motion = flown.move_j(turned(2.4));
    flown.cycle(10);
    const auto busy = flown.move_j(start);
    const auto end = flown.rig.call(function);
    flown.finish(end);
    EXPECT_THAT(flown.rig.outcome(busy), StartsWith("1 4:0108")) << function;
    EXPECT_EQ(flown.rig.outcome(end), "1 3 7") << function;
    EXPECT_EQ(flown.rig.outcome(motion), aborted) << function;
    flown.cycle(500);
    EXPECT_LT(flown.off(start), 1e-3) << function;
  }
  EXPECT_EQ(flown.rig.inhibited(), inhibited_by_author) << "STOP ends in brakes";
}

}  // namespace
}  // namespace hirosco
