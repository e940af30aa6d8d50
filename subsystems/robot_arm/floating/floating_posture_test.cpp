// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "subsystems/robot_arm/floating/tool_way.hpp"
#include "subsystems/robot_arm/testing/floating.hpp"

/// A posture to which joints go that a tool of a floating arm leaves free (docs/adr/0235).
namespace hirosco {
namespace {

using robot_arm::FloatingModel;
using robot_arm::JointVector;
using robot_arm::ToolLaw;
using ::testing::StartsWith;

struct FloatingPosture : robot_arm::testing::FloatingWay {
  JointVector preferred = ready;

  /// Where joints come to that go 0.4 rad together, and the tool (and the base, where that is kept) as little as that may be: an elbow that is elsewhere.
  [[nodiscard]] JointVector elsewhere(ToolLaw law) const {
    FloatingModel its{flown.model, flown.model.find_frame("tool").value()};
    JointVector posture = ready, last = JointVector::Zero(7);
    for (int i = 0; i < 40; ++i) {
      EXPECT_TRUE(its.update({}, posture));
      FloatingModel::Twists rows = law == ToolLaw::FixedBase ? its.tool_of_fixed() : its.tool_of_free();
      if (law == ToolLaw::AttitudeHold) rows.topRows<3>() = its.base().topRows<3>();
      const Eigen::JacobiSVD<Eigen::MatrixXd> solver{Eigen::MatrixXd{rows}, Eigen::ComputeFullV};
      JointVector along = solver.matrixV().col(6);
      if (along.dot(last) < 0) along = -along;
      posture += 0.01 * along;
      last = along;
    }
    return posture;
  }
  /// Where a way of the tool of 0.1 m ends by this law: joints, and what the tool is off by.
  struct Ended {
    JointVector joints;
    double off_m{0};
    double turned{0};  ///< rad, of the base
  };
  [[nodiscard]] Ended ended(ToolLaw law, double gain_per_s) const {
    const auto tip = flown.model.find_frame("tool").value();
    FloatingModel its{flown.model, tip};
    EXPECT_TRUE(its.update({}, ready));
    const robotics::Pose begun = its.tool();
    robot_arm::ToolWay way{flown.model, tip};
    const auto bounds = robot_arm::testing::bounds_of(flown.model);
    robot_arm::ToolWay::Plan plan;
    plan.law = law;
    plan.position = ready;
    plan.tool = begun;
    plan.offset_m = {0.1, 0, 0};
    plan.duration_s = 20;
    plan.preferred = {preferred, gain_per_s};
    way.begin(plan);
    robot_arm::BaseEstimate base;
    base.stand_still();
    base.take({0, 0, 0}, robotics::Quaternion::Identity());
    JointVector last = ready;
    while (way.step(bounds)) {
      EXPECT_TRUE(its.update({base.orientation().toRotationMatrix(), base.position_m()}, last));
      if (law != ToolLaw::FixedBase) base.go_on(its.base() * (way.posture() - last), 1);
      last = way.posture();
    }
    EXPECT_TRUE(its.update({base.orientation().toRotationMatrix(), base.position_m()}, last));
    robotics::Vector3 goal = begun.position;
    goal.x() += 0.1;
    return {last, (its.tool().position - goal).norm(),
            robot_arm::rotation_between(robotics::Matrix3::Identity(), base.orientation().toRotationMatrix()).norm()};
  }
};

TEST_F(FloatingPosture, IsNearerBehindAWayWhoseToolIsWhereItWasToBe) {
  for (const ToolLaw law : {ToolLaw::FixedBase, ToolLaw::InertialTrack, ToolLaw::AttitudeHold}) {
    preferred = elsewhere(law);
    const Ended without = ended(law, 0), with = ended(law, 1);
    const auto off = [&](const Ended& its) { return (its.joints - preferred).norm(); };
    EXPECT_LT(off(with), 0.7 * off(without)) << static_cast<int>(law);
    EXPECT_LT(with.off_m, 2e-3) << static_cast<int>(law);
    EXPECT_LT(without.off_m, 2e-3) << static_cast<int>(law);
    if (law == ToolLaw::AttitudeHold) {
      EXPECT_LT(with.turned, 1e-3) << "and the base is unturned";
    }
  }
}

TEST_F(FloatingPosture, OfWhichNothingIsSaidMovesNothing) {
  const Ended one = ended(ToolLaw::InertialTrack, 0);
  preferred = elsewhere(ToolLaw::InertialTrack);
  EXPECT_EQ(ended(ToolLaw::InertialTrack, 0).joints, one.joints);
}

TEST_F(FloatingPosture, IsGoneToWhileTheToolMovesAndNoFartherWhereItStands) {
  preferred = elsewhere(ToolLaw::FixedBase);
  flown.plant.place(ready);
  flown.rig.bring_to(State::PreOperational, 1);
  flown.cycle(5);
  std::vector<std::optional<Value>> joints;
  for (const double each : preferred) joints.emplace_back(each);
  const auto written = flown.rig.set_with("POSTURE", joints);
  flown.cycle(3);
  ASSERT_EQ(flown.rig.outcome(written), "1 3 7");
  flown.write("POSTURE_GAIN", 1);
  flown.command(State::SafeOperational);
  flown.command(State::Operational);
  const double before = (ready - preferred).norm();
  flown.cycle(2000);
  EXPECT_NEAR((flown.plant.measured().position - preferred).norm(), before, 1e-3) << "it stands";
  robotics::Vector3 goal = tool();
  goal.x() += 0.05;
  const auto motion = move_tool(0.05, 0, 0, 15);
  flown.finish(motion);
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 7");
  EXPECT_LT((tool() - goal).norm(), 1.5e-3);
  const double behind = (flown.plant.measured().position - preferred).norm();
  EXPECT_LT(behind, 0.6 * before);
  flown.cycle(2000);
  EXPECT_NEAR((flown.plant.measured().position - preferred).norm(), behind, 2e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

}  // namespace
}  // namespace hirosco
