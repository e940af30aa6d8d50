// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/motion/inverse_kinematics.hpp"

#include <gtest/gtest.h>

#include <random>

#include "robotics/dynamics/testing/robots.hpp"

namespace hirosco::robotics {
namespace {

/// Seven joints, shoulder and wrist of three each and an elbow, 1.2 m long.
[[nodiscard]] Model seven_joints() {
  const Vector3 z = Vector3::UnitZ(), y = Vector3::UnitY();
  ModelDescription description;
  description.base = testing::ball(20, {0, 0, 0}, 3);
  std::optional<std::size_t> parent;
  for (const auto& [axis, height] : {std::pair{z, 0.1}, {y, 0.2}, {z, 0.2}, {y, 0.2}, {z, 0.2}, {y, 0.2}, {z, 0.1}}) {
    auto joint = testing::joint(JointKind::Revolute, axis, {0, 0, height}, testing::ball(1, {0, 0, 0.1}, 0.01), parent);
    joint.limits = {-2.5, 2.5, 2, 50};
    parent = description.joints.size();
    description.joints.push_back(joint);
  }
  description.frames = {{"tip", 6, {Matrix3::Identity(), {0, 0, 0.1}}}};
  return testing::make(description);
}

[[nodiscard]] JointVector bent() {
  JointVector q(7);
  q << 0.3, 0.6, -0.2, 1.2, 0.1, 0.8, -0.4;
  return q;
}

[[nodiscard]] State at(const JointVector& q) {
  State state;
  state.q = q;
  state.qd.setZero(q.size());
  return state;
}

TEST(InverseKinematics, FindsJointsForEveryPlaceThatTheyHaveBeenIn) {
  const auto model = seven_joints();
  Dynamics dynamics{model, Base::Fixed};
  InverseKinematics inverse{model, {0}, {}};
  std::mt19937 random{5};
  std::uniform_real_distribution<double> near{-0.4, 0.4};
  int most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const JointVector there = bent() + JointVector::NullaryExpr(7, [&] { return near(random); });
    dynamics.update(at(there));
    const Pose wanted = dynamics.frame_pose({0});
    JointVector q = bent();
    const auto found = inverse.solve(wanted, bent(), q);
    ASSERT_TRUE(found) << trial;
    most = std::max(most, *found);
    dynamics.update(at(q));
    EXPECT_LT((dynamics.frame_pose({0}).position - wanted.position).norm(), 1e-8);
    EXPECT_LT((dynamics.frame_pose({0}).rotation - wanted.rotation).norm(), 1e-8);
    JointVector again = bent();
    ASSERT_TRUE(inverse.solve(wanted, bent(), again));
    EXPECT_EQ(again, q);
  }
  EXPECT_LE(most, 100);
}

TEST(InverseKinematics, WhatIsOutOfReachIsSaid) {
  const auto model = seven_joints();
  InverseKinematics inverse{model, {0}, {}};
  JointVector q = bent();
  const auto found = inverse.solve({Matrix3::Identity(), {0, 0, 3}}, bent(), q);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::Unavailable);
  EXPECT_TRUE(q.allFinite());
  EXPECT_LE(q.cwiseAbs().maxCoeff(), 2.5);
}

TEST(InverseKinematics, SaysHowFarAPlaceAndASingularPostureAre) {
  const auto model = seven_joints();
  Dynamics dynamics{model, Base::Fixed};
  InverseKinematics inverse{model, {0}, {}};
  EXPECT_GT(inverse.smallest_singular_value(bent()), 0.01);
  EXPECT_LT(inverse.smallest_singular_value(JointVector::Zero(7)), 1e-6) << "stretched out";
  dynamics.update(at(bent()));
  Pose there = dynamics.frame_pose({0});
  there.position.y() += 0.2;
  there.rotation = Eigen::AngleAxisd{0.3, Vector3::UnitZ()} * there.rotation;
  Vector6 wanted = Vector6::Zero();
  wanted[2] = 0.3;
  wanted[4] = 0.2;
  EXPECT_LT((inverse.left(there, bent()) - wanted).norm(), 1e-9);
}

TEST(InverseKinematics, JointsMoveTheTipAndWhatIsLeftOverGoesToThePosture) {
  const auto model = seven_joints();
  for (const Base base : {Base::Fixed, Base::Free}) {
    Dynamics dynamics{model, base};
    const InverseKinematics inverse{model, {0}, {}};
    dynamics.update(at(bent()));
    Vector6 twist;
    twist << 0.1, -0.05, 0.02, 0.01, 0.03, -0.02;
    JointVector posture = bent(), still, drawn;
    inverse.rates(dynamics, twist, bent(), bent(), still);
    posture[0] += 0.5;
    inverse.rates(dynamics, twist, bent(), posture, drawn);
    Jacobian jacobian;
    ASSERT_TRUE(dynamics.generalised_jacobian({0}, jacobian));
    EXPECT_LT((jacobian * still - twist).norm(), 1e-12);
    EXPECT_LT((jacobian * drawn - twist).norm(), 1e-12);
    EXPECT_GT((drawn - still).dot(posture - bent()), 1e-3);
  }
}

TEST(InverseKinematics, GoesOnUntilWhatIsLeftOverIsAsNearToThePostureAsThePlacePermits) {
  const auto model = seven_joints();
  Dynamics dynamics{model, Base::Fixed};
  InverseKinematics inverse{model, {0}, {.posture_gain = 0.5, .settled = 1e-8}}, soon{model, {0}, {}};
  JointVector posture = bent(), q = bent(), still = bent();
  posture[0] += 0.4;
  posture[2] -= 0.4;
  dynamics.update(at(bent()));
  const Pose there = dynamics.frame_pose({0});
  ASSERT_TRUE(soon.solve(there, posture, still));
  EXPECT_EQ(still, bent()) << "the tip is in its place";
  ASSERT_TRUE(inverse.solve(there, posture, q));
  EXPECT_LT(inverse.left(there, q).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((posture - q).norm(), (posture - bent()).norm() - 1e-3);
  JointVector qd;
  dynamics.update(at(q));
  inverse.rates(dynamics, Vector6::Zero(), q, posture, qd);
  EXPECT_LT(qd.cwiseAbs().maxCoeff(), 1e-7) << "and nothing of it is left";
}

TEST(InverseKinematics, JointsStaySlowAtASingularity) {
  const auto model = seven_joints();
  Dynamics dynamics{model, Base::Fixed};
  const InverseKinematics inverse{model, {0}, {}};
  JointVector stretched = JointVector::Zero(7), qd;
  for (const double angle : {0.0, 1e-6, 1e-3, 1e-2}) {
    stretched[3] = angle;
    dynamics.update(at(stretched));
    Vector6 twist = Vector6::Zero();
    twist[5] = -0.1;
    inverse.rates(dynamics, twist, stretched, stretched, qd);
    EXPECT_LT(qd.cwiseAbs().maxCoeff(), 0.1 / (2 * 0.1) * 4) << angle;
  }
}

TEST(InverseKinematics, NoJointGoesBeyondItsLimitAndOthersDoItsPart) {
  const auto model = seven_joints();
  Dynamics dynamics{model, Base::Fixed};
  const InverseKinematics inverse{model, {0}, {}};
  JointVector q = bent(), qd, free;
  Vector6 twist;
  twist << 0.0, 0.1, 0.0, 0.05, 0.0, -0.05;
  dynamics.update(at(q));
  inverse.rates(dynamics, twist, q, q, free);
  const int first = 3;
  ASSERT_GT(std::abs(free[first]), 1e-2);
  // The same arm, whose elbow has come to its end: by limits that are there.
  q[first] = free[first] > 0 ? 2.5 : -2.5;
  dynamics.update(at(q));
  inverse.rates(dynamics, twist, q, q, free);
  Jacobian jacobian;
  dynamics.jacobian({0}, jacobian);
  Vector6 outward = jacobian.col(first) * (q[first] > 0 ? 0.3 : -0.3);
  inverse.rates(dynamics, outward, q, q, qd);
  EXPECT_EQ(qd[first], 0);
  EXPECT_TRUE(qd.allFinite());
  inverse.rates(dynamics, -outward, q, q, qd);
  EXPECT_GT(std::abs(qd[first]), 0.01);
}

}  // namespace
}  // namespace hirosco::robotics
