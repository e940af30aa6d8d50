// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/motion/point_to_point.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hirosco::robotics {
namespace {

[[nodiscard]] JointVector numbers(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}
[[nodiscard]] double time_of(double way, const MotionLimits& limits) {
  return PointToPoint::plan(numbers({1}), numbers({1 + way}), {&limits, 1}).value().duration_s();
}

TEST(PointToPoint, TakesTheTimeOfEachOfTheFourClosedForms) {
  // Everything is reached: 1 s of velocity, as long to and from it.
  EXPECT_DOUBLE_EQ(time_of(12, {4, 2, 4}), 12.0 / 4 + 4.0 / 2 + 2.0 / 4);
  // Not the acceleration: ramps of 1 s.
  EXPECT_DOUBLE_EQ(time_of(-8, {2, 5, 2}), 4 * 1 + (8.0 / 2 - 2));
  // Not the velocity: d = a (ramp + steady)(2 ramp + steady), ramp 1, steady 1.
  EXPECT_DOUBLE_EQ(time_of(6, {100, 1, 1}), 4 * 1 + 2 * 1);
  // Neither: d = 2 j ramp^3.
  EXPECT_DOUBLE_EQ(time_of(16, {100, 100, 1}), 4 * 2);
  EXPECT_EQ(time_of(0, {1, 1, 1}), 0);
}

/// Over any ways and limits: begins, ends, never exceeds, and is the integral of itself.
TEST(PointToPoint, KeepsEveryLimitAndIsAtItsGoalAtTheEnd) {
  std::mt19937 random{4};
  std::uniform_real_distribution<double> place{-3, 3};
  std::uniform_real_distribution<double> power{-1.5, 1.5};
  for (int trial = 0; trial < 500; ++trial) {
    const JointVector from = JointVector::NullaryExpr(7, [&] { return place(random); });
    JointVector to = JointVector::NullaryExpr(7, [&] { return place(random); });
    to[3] = from[3];
    std::array<MotionLimits, 7> limits;
    for (auto& its : limits)
      its = {std::pow(10, power(random)), std::pow(10, power(random)), std::pow(10, power(random))};
    const bool straight = trial % 2 == 0;
    const auto plan = (straight ? PointToPoint::plan_straight : PointToPoint::plan)(from, to, limits).value();
    PointToPoint::Sample sample, before;
    plan.at(0, before);
    EXPECT_EQ(before.position, from);
    constexpr int steps = 400;
    const double h = plan.duration_s() / steps;
    for (int i = 1; i <= steps; ++i) {
      plan.at(i * h, sample);
      for (Eigen::Index k = 0; k < 7; ++k) {
        const auto& its = limits[static_cast<std::size_t>(k)];
        ASSERT_LE(std::abs(sample.velocity[k]), its.velocity * (1 + 1e-9));
        ASSERT_LE(std::abs(sample.acceleration[k]), its.acceleration * (1 + 1e-9));
        ASSERT_LE(std::abs(sample.acceleration[k] - before.acceleration[k]), its.jerk * h * (1 + 1e-6) + 1e-9);
        // Hermite: exact within a piece of constant jerk, and never off by more than a piece's end makes it.
        const double middle =
            (before.velocity[k] + sample.velocity[k]) / 2 + h / 12 * (before.acceleration[k] - sample.acceleration[k]);
        ASSERT_NEAR(sample.position[k] - before.position[k], h * middle, its.jerk * h * h * h);
      }
      before = sample;
      const JointVector gone = sample.position - from, way = to - from;
      ASSERT_TRUE(!straight || (gone - gone.dot(way) / way.squaredNorm() * way).norm() < 1e-9);
    }
    EXPECT_LT((sample.position - to).norm(), 1e-12);
    EXPECT_LT(sample.velocity.norm() + sample.acceleration.norm(), 1e-9);
  }
}

TEST(PointToPoint, GoesStraightInNoMoreTimeWhereAllJointsHaveTheSameLimits) {
  const std::array<MotionLimits, 3> limits{MotionLimits{1, 2, 8}, MotionLimits{1, 2, 8}, MotionLimits{1, 2, 8}};
  const JointVector from = numbers({0, 1, 2}), to = numbers({1.5, 0.2, 2});
  EXPECT_NEAR(PointToPoint::plan_straight(from, to, limits).value().duration_s(),
              PointToPoint::plan(from, to, limits).value().duration_s(), 1e-12);
  EXPECT_EQ(PointToPoint::plan_straight(from, from, limits).value().duration_s(), 0);
}

TEST(PointToPoint, RestsBeforeAndAfter) {
  const std::array<MotionLimits, 2> limits{MotionLimits{1, 1, 1}, MotionLimits{1, 1, 1}};
  const auto plan = PointToPoint::plan(numbers({0, 1}), numbers({2, 1}), limits).value();
  PointToPoint::Sample sample;
  plan.at(-1, sample);
  EXPECT_EQ(sample.position, numbers({0, 1}));
  plan.at(1e9, sample);
  EXPECT_EQ(sample.position, numbers({2, 1}));
  EXPECT_EQ(sample.velocity, numbers({0, 0}));
}

TEST(PointToPoint, RefusesWhatIsNoMotion) {
  const MotionLimits good{1, 1, 1};
  const auto refused = [](const JointVector& from, const JointVector& to, MotionLimits limits) {
    return !PointToPoint::plan(from, to, {&limits, 1}) && !PointToPoint::plan_straight(from, to, {&limits, 1});
  };
  EXPECT_FALSE(refused(numbers({0}), numbers({1}), good));
  EXPECT_TRUE(refused(numbers({0}), numbers({1, 2}), good));
  EXPECT_TRUE(refused(numbers({0, 1}), numbers({1, 2}), good));
  EXPECT_TRUE(refused(numbers({0}), numbers({std::numeric_limits<double>::quiet_NaN()}), good));
  EXPECT_TRUE(refused(numbers({0}), numbers({1}), {0, 1, 1}));
  EXPECT_TRUE(refused(numbers({0}), numbers({1}), {1, -1, 1}));
  EXPECT_TRUE(refused(numbers({0}), numbers({1}), {1, 1, std::numeric_limits<double>::infinity()}));
}

}  // namespace
}  // namespace hirosco::robotics
