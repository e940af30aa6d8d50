// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <deque>

#include "subsystems/robot_arm/floating/soft_law.hpp"
#include "subsystems/robot_arm/testing/free_plant.hpp"

/// Springs of an arm whose base gives way, on a craft that nothing holds (docs/adr/0235).
namespace hirosco::robot_arm {
namespace {

struct FloatingSprings : ::testing::Test {
  robotics::Model model = testing::model_of(testing::floating_folder + "floating_arm.urdf");
  std::vector<JointBounds> bounds = testing::bounds_of(model);
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  testing::FreePlant plant{model};
  FloatingModel known{model, model.find_frame("tool").value()};
  SoftLaw law;
  SoftGoal goal;
  ToolLaw axes{ToolLaw::InertialTrack};

  void begin(const JointVector& at, const JointVector& wanted) {
    plant.place(at);
    ASSERT_TRUE(known.update({}, wanted));
    goal.joints = {wanted, JointVector::Zero(7), JointVector::Zero(7)};
    goal.tool = {known.tool()};
    ASSERT_TRUE(known.update(plant.base(), at));
  }
  /// Cycles of a millisecond, and so many more until a torque is there.
  template <class Each>
  void hold(LawKind kind, int cycles, std::size_t late, const Each& each) {
    std::deque<JointVector> way;
    for (int i = 0; i < cycles; ++i) {
      ASSERT_TRUE(known.update(plant.base(), plant.measured().position));
      way.push_back(law.torque(kind, axes, known, plant.measured(), goal, bounds, 50));
      plant.step(way.front(), 0.001);
      if (way.size() > late) way.pop_front();
      each();
    }
  }
  [[nodiscard]] double kinetic() const {
    const JointVector& rates = plant.measured().velocity;
    return 0.5 * rates.dot(known.inertia() * rates);
  }
};

/// Somebody pushes at the tool: each joint gives way by what it feels of that by its stiffness.
TEST_F(FloatingSprings, OfJointsGiveWayByWhatActsOnEachByItsStiffness) {
  const JointVector stiffness = vector_of(std::array{400.0, 400.0, 400.0, 400.0, 40.0, 40.0, 10.0});
  law.set({.joint_n_m_rad = stiffness, .damping_ratio = 1});
  ASSERT_NO_FATAL_FAILURE(begin(ready, ready));
  plant.push_n = {4, -3, 2};
  ASSERT_NO_FATAL_FAILURE(hold(LawKind::JointImpedance, 3000, 0, [] {}));
  const robotics::Vector3 pushed = plant.base().rotation.transpose() * plant.push_n;
  FloatingModel there{model, model.find_frame("tool").value()};
  ASSERT_TRUE(there.update({}, plant.measured().position));
  const JointVector expected = (there.tool_of_free().bottomRows<3>().transpose() * pushed).cwiseQuotient(stiffness);
  const JointVector way = plant.measured().position - ready;
  EXPECT_GT(expected.cwiseAbs().maxCoeff(), 0.01);
  // The push also turns the craft on, which takes a little itself.
  EXPECT_LT((way - expected).cwiseAbs().maxCoeff(), 0.1 * expected.cwiseAbs().maxCoeff());
}

/// In inertial axes, whatever the base does meanwhile; nothing is put in, so energy goes.
TEST_F(FloatingSprings, OfTheToolBringItBackInInertialAxesAndTakeEnergyOnly) {
  law.set({.joint_n_m_rad = JointVector::Zero(7), .tool_n_m = 300, .tool_n_m_rad = 30, .damping_ratio = 0.7});
  JointVector off = ready;
  off[1] += 0.05, off[3] -= 0.05, off[5] += 0.05;
  ASSERT_NO_FATAL_FAILURE(begin(off, ready));
  const double begun_m = (goal.tool.pose.position - known.tool().position).norm();
  EXPECT_GT(begun_m, 0.02);
  const auto energy = [&] {
    const robotics::Vector3 left = goal.tool.pose.position - known.tool().position;
    double turned = 0;
    for (int axis = 0; axis < 3; ++axis)
      turned += 0.5 * (1 - known.tool().rotation.col(axis).dot(goal.tool.pose.rotation.col(axis)));
    return kinetic() + 0.5 * 300 * left.squaredNorm() + 30 * turned;
  };
  double before = energy(), most = 0;
  ASSERT_NO_FATAL_FAILURE(hold(LawKind::ToolImpedance, 8000, 0, [&] {
    ASSERT_TRUE(known.update(plant.base(), plant.measured().position));
    const double now = energy();
    most = std::max(most, now - before);
    before = now;
  }));
  EXPECT_LT(most, 1e-5) << "of which a millisecond's delay may give a little";
  EXPECT_LT((goal.tool.pose.position - known.tool().position).norm(), 1e-3);
  EXPECT_LT(rotation_between(known.tool().rotation, goal.tool.pose.rotation).norm(), 2e-3);
  EXPECT_GT(rotation_between(plant.base().rotation, robotics::Matrix3::Identity()).norm(), 1e-4) << "it has turned";
  EXPECT_LT(plant.measured().velocity.cwiseAbs().maxCoeff(), 1e-3);
}

/// As a solver of such pairs has it.
TEST_F(FloatingSprings, SwingAsTheirStiffnessAndWhatItMovesHaveIt) {
  ASSERT_TRUE(known.update({}, ready));
  const Impedance impedance{.joint_n_m_rad = vector_of(std::array{400.0, 300.0, 400.0, 200.0, 40.0, 20.0, 10.0}),
                            .tool_n_m = 500,
                            .tool_n_m_rad = 20};
  const Eigen::MatrixXd joints = impedance.joint_n_m_rad.asDiagonal();
  Eigen::VectorXd each(6);
  each << 20, 20, 20, 500, 500, 500;
  const Eigen::MatrixXd tool = known.tool_of_free().transpose() * each.asDiagonal() * known.tool_of_free();
  const auto fastest = [&](const Eigen::MatrixXd& springs) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver{springs, Eigen::MatrixXd{known.inertia()}};
    return std::sqrt(solver.eigenvalues().maxCoeff());
  };
  EXPECT_NEAR(law.swings_rad_s(LawKind::JointImpedance, axes, impedance, known), fastest(joints), 1e-6);
  EXPECT_NEAR(law.swings_rad_s(LawKind::ToolImpedance, axes, impedance, known), fastest(tool), 1e-6);
  std::cout << "  " << fastest(joints) << " and " << fastest(tool) << " rad/s\n";
  known.carry({}, {20, {0, 0, 0.1}});
  ASSERT_TRUE(known.update({}, ready));
  EXPECT_GE(law.swings_rad_s(LawKind::JointImpedance, axes, impedance, known), fastest(joints) * (1 - 1e-9))
      << "lost, it moves no more than before";
}

/// 40 rad/s, the fastest that are permitted, with the least ratio, and torques two cycles late.
TEST_F(FloatingSprings, AreStableAsStiffAsTheyMayBe) {
  ASSERT_TRUE(known.update({}, ready));
  Impedance impedance{.joint_n_m_rad = vector_of(std::array{400.0, 300.0, 400.0, 200.0, 40.0, 20.0, 10.0}),
                      .damping_ratio = 0.3};
  const double is = law.swings_rad_s(LawKind::JointImpedance, axes, impedance, known);
  impedance.joint_n_m_rad *= 40 * 40 / (is * is);
  law.set(impedance);
  JointVector off = ready;
  off[6] += 0.01, off[4] -= 0.01, off[0] += 0.01;
  ASSERT_NO_FATAL_FAILURE(begin(off, ready));
  ASSERT_NO_FATAL_FAILURE(hold(LawKind::JointImpedance, 20'000, 2, [] {}));
  EXPECT_LT((plant.measured().position - ready).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT(plant.measured().velocity.cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace hirosco::robot_arm
