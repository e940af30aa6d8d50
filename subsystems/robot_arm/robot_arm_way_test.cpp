// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "robotics/shapes/collision.hpp"
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

/// A ball that a turn of the first joint grazes, some tenths of a millimetre nearer than CLEARANCE_LIMIT and for a few mrad.
struct Grazed {
  robotics::Clearance clearance;
  JointVector start;
  double height_m, azimuth;  ///< of the tool at start

  Grazed(const robotics::Model& model, const std::string& file, const JointVector& at, const robotics::Vector3& tool)
      : clearance{model, robotics::read_collision_shapes(file, descriptor::file_system()(file).value(),
                                                         descriptor::file_system())
                             .value.value()
                             .hulls},
        start{at},
        height_m{tool.z()},
        azimuth{std::atan2(tool.y(), tool.x())} {
    clearance.set_limit(0.01);
  }
  robotics::Vector3 put(double radius_m, double turn) {
    const robotics::Vector3 there{radius_m * std::cos(azimuth + turn), radius_m * std::sin(azimuth + turn), height_m};
    clearance.keep_out(std::array{robotics::Capsule{there, there, 0.05}});
    return there;
  }
  [[nodiscard]] bool is_near(double turn) {
    JointVector posture = start;
    posture[0] += turn;
    return !clearance.keeps_limits(posture);
  }
  /// Those turns beside this one that are too near.
  std::vector<double> near(double turn) {
    std::vector<double> found;
    for (double beside = -0.2; beside <= 0.2; beside += 1e-3)
      if (is_near(turn + beside)) found.push_back(turn + beside);
    return found;
  }
  /// Where a ball is grazed in the middle of that turn.
  robotics::Vector3 at(double turn) {
    double inside = 0.6, outside = 1.2;
    while (outside - inside > 1e-4) {
      const double between = (inside + outside) / 2;
      static_cast<void>(put(between, turn));
      (near(turn).empty() ? outside : inside) = between;
    }
    inside -= 2e-4;  // for no fewer mrad than an arm goes in some cycles
    static_cast<void>(put(inside, turn));
    const std::vector<double> found = near(turn);
    return put(inside, 2 * turn - (found.front() + found.back()) / 2);
  }
};

/// The watch of the way sees it, which looks ahead in each cycle.
TEST_F(RobotArmWay, ThatSomebodyIsInBetweenTwoPosturesThatAreLookedAtIsGoneUntilBeforeHim) {
  constexpr double whole = 2.4, looks = 64, between_two = 20.5 / looks * whole;
  Grazed grazed{flown.model, file, start, tool_at(start)};
  const robotics::Vector3 ball = grazed.at(between_two);
  ASSERT_TRUE(grazed.is_near(between_two));
  for (int i = 1; i <= looks; ++i) ASSERT_FALSE(grazed.is_near(i / looks * whole)) << i;
  keep_out(ball);
  operate();
  const auto request = flown.move_j(turned(whole));
  flown.cycle(longest_judged);
  EXPECT_EQ(flown.rig.outcome(request), "1 3");
  flown.finish(request);
  EXPECT_THAT(flown.rig.outcome(request), StartsWith("1 3 8:800a"));
  EXPECT_EQ(flown.rig.events(too_near), 1);
  flown.cycle(1000);
  EXPECT_LT(flown.off(turned(between_two)), 0.1) << "it rests before him";
  EXPECT_LT(flown.plant.measured().position[0], turned(between_two)[0] + 0.01);
}

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
