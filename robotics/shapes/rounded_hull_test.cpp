// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/rounded_hull.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

namespace hirosco::robotics {
namespace {

using Corners = std::vector<Vector3>;

[[nodiscard]] RoundedHull ball(double radius_m) { return RoundedHull{Corners{Vector3::Zero()}, radius_m}; }
[[nodiscard]] RoundedHull box(double half_m) {
  Corners corners;
  for (const double x : {-half_m, half_m})
    for (const double y : {-half_m, half_m})
      for (const double z : {-half_m, half_m}) corners.emplace_back(x, y, z);
  return RoundedHull{corners, 0};
}
[[nodiscard]] Pose at(double x, double y, double z) { return {Matrix3::Identity(), {x, y, z}}; }
[[nodiscard]] double apart(const RoundedHull& one, const Pose& here, const RoundedHull& other, const Pose& there) {
  return distance_m({one, here}, {other, there});
}

TEST(RoundedHulls, AreAsFarApartAsClosedFormsHaveIt) {
  EXPECT_NEAR(apart(ball(0.2), {}, ball(0.3), at(1, 2, 2)), 2.5, 1e-7) << "two balls";
  EXPECT_NEAR(apart(box(0.5), {}, ball(0.1), at(1.5, 0, 0)), 0.9, 1e-7) << "a face and a ball";
  EXPECT_NEAR(apart(box(0.5), {}, ball(0), at(1.5, 1.5, 0.2)), std::numbers::sqrt2, 1e-7) << "an edge and a point";
  EXPECT_NEAR(apart(box(0.5), {}, ball(0), at(1.5, 1.5, 1.5)), std::numbers::sqrt3, 1e-7) << "a corner and a point";
  const RoundedHull along_x{Corners{{0, 0, 0}, {1, 0, 0}}, 0.1};
  EXPECT_NEAR(apart(along_x, {}, RoundedHull{Corners{{0.5, 0.5, -1}, {0.5, 0.5, 1}}, 0.2}, {}), 0.2, 1e-7)
      << "capsules that cross";
  EXPECT_NEAR(apart(along_x, {}, RoundedHull{Corners{{0, 1, 0}, {1, 1, 0}}, 0.1}, {}), 0.8, 1e-7) << "parallel";
  EXPECT_NEAR(apart(along_x, {}, RoundedHull{Corners{{3, 0, 0}, {5, 0, 0}}, 0.1}, {}), 1.8, 1e-7) << "in a line";
  const Pose turned{Eigen::AngleAxisd{std::numbers::pi / 4, Vector3::UnitZ()}.toRotationMatrix(), {2, 0, 0}};
  EXPECT_NEAR(apart(box(0.5), {}, box(0.5), turned), 1.5 - std::numbers::sqrt2 / 2, 1e-7) << "a face and an edge";
}

TEST(RoundedHulls, ThatAreInEachOtherAreSoByBothRadiiAtLeast) {
  EXPECT_EQ(apart(box(0.5), {}, box(0.2), at(0.1, 0, 0)), 0);
  EXPECT_EQ(apart(ball(0.5), {}, ball(0.2), {}), -0.7);
  EXPECT_NEAR(apart(ball(0.5), {}, ball(0.2), at(0.4, 0, 0)), -0.3, 1e-7);
}

/// Distances by coal 3.0.3 (coal.distance of ConvexBase::convexHull) of the corners written here.
TEST(RoundedHulls, AreAsFarApartAsCoalFinds) {
  struct Row {
    Corners one, other;
    double distance_m;
  };
  const std::vector<Row> rows{
      {{{-0.21, 0.24, 0.07},
        {-0.32, -0.05, -0.02},
        {-0.27, 0.19, -0.31},
        {-0.09, 0.01, -0.06},
        {0.07, 0.19, 0.37},
        {-0.17, 0.12, 0.16}},
       {{-0.82, -0.14, 1.07}, {-0.82, 0.11, 1}, {-0.59, 0.23, 0.91}, {-1.03, 0.42, 0.59}},
       0.843856732},
      {{{0.1, -0.16, 0.19},
        {0.18, -0.23, 0.26},
        {0.13, 0.15, 0.26},
        {-0.06, 0.21, 0.3},
        {-0.32, 0.28, -0.08},
        {-0.02, -0.28, 0.16}},
       {{-0.64, 0.86, -0.71}, {-0.42, 0.48, -0.44}, {-0.71, 0.31, -0.33}, {-0.27, 0.62, -0.19}},
       0.299405921},
      {{{0.1, 0.09, 0.38},
        {0.23, 0.23, -0.36},
        {-0.1, -0.33, -0.25},
        {-0.23, 0.29, -0.3},
        {-0.16, -0.01, 0.28},
        {0.37, 0.17, -0.23}},
       {{0.08, -0.31, 0.03},
        {0.19, -0.58, 0.46},
        {0.18, -0.34, 0.4},
        {0.09, -0.71, 0.38},
        {-0.26, -0.49, 0.42},
        {0.26, -0.56, 0}},
       0.178066504},
      {{{-0.1, 0.33, -0.09},
        {-0.12, -0.12, -0.02},
        {-0.33, 0.04, 0.34},
        {0.05, 0.2, 0.36},
        {0.27, 0.2, 0.25},
        {0.26, -0.2, -0.01}},
       {{-0.39, -0.68, 0.75}, {-0.41, -0.39, 0.76}, {-0.58, -0.53, 0.6}, {-0.1, -0.81, 0.43}, {-0.26, -0.56, 0.82}},
       0.606382717},
      {{{-0.28, -0.18, -0.13}, {-0.22, 0.03, 0.35}, {-0.3, -0.07, 0.13}, {0.31, 0.4, -0.29}, {0.03, 0.3, -0.36}},
       {{-0.31, 0.07, -0.09}, {-0.03, 0.36, -0.7}, {-0.72, 0.26, -0.03}, {-0.59, 0.46, -0.38}},
       0.125153430},
      {{{0.21, 0, 0.23},
        {0.01, -0.27, -0.05},
        {0.3, 0.05, 0.37},
        {-0.4, -0.13, 0.22},
        {0.15, 0.05, 0.13},
        {0.3, 0.15, 0.04}},
       {{-0.63, 0.72, 0.46}, {-0.54, 0.68, 0.83}, {-0.69, 0.21, 0.63}, {-0.39, 0.7, 0.72}, {-0.76, 0.47, 0.78}},
       0.606465168},
  };
  for (const auto& row : rows) {
    const RoundedHull one{row.one, 0}, other{row.other, 0};
    EXPECT_NEAR(apart(one, {}, other, {}), row.distance_m, 1e-6);
    EXPECT_NEAR(apart(other, {}, one, {}), row.distance_m, 1e-6);
  }
}

struct Random {
  std::mt19937 engine{7};
  double operator()(double low, double high) { return std::uniform_real_distribution<double>{low, high}(engine); }
  Vector3 point() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
  RoundedHull hull(std::size_t corners, double radius_m) {
    RoundedHull made;
    for (std::size_t i = 0; i < corners; ++i) static_cast<void>(made.add(0.3 * point()));
    made.round(radius_m);
    return made;
  }
  Pose pose(double far_m) {
    return {Eigen::AngleAxisd{(*this)(-3, 3), point().normalized()}.toRotationMatrix(), far_m * point()};
  }
};

/// The axis proves that they are no nearer: along it there is so much between them.
TEST(RoundedHulls, TellAnAxisAlongWhichTheyAreThatFarApart) {
  Random random;
  int apart_at_all = 0;
  for (int i = 0; i < 2000; ++i) {
    const RoundedHull one = random.hull(1 + static_cast<std::size_t>(i) % RoundedHull::most_corners, 0.01),
                      other = random.hull(1 + static_cast<std::size_t>(i / 7) % RoundedHull::most_corners, 0.02);
    const Pose here = random.pose(1), there = random.pose(1);
    Vector3 axis = random.point().normalized();
    const double far = distance_m({one, here}, {other, there}, HUGE_VAL, axis);
    if (far <= 0) continue;
    ++apart_at_all;
    ASSERT_NEAR(axis.norm(), 1, 1e-9);
    double lowest = HUGE_VAL, highest = -HUGE_VAL;
    for (std::size_t k = 0; k < one.corners(); ++k) lowest = std::min(lowest, axis.dot(here * one.corner(k)));
    for (std::size_t k = 0; k < other.corners(); ++k) highest = std::max(highest, axis.dot(there * other.corner(k)));
    ASSERT_NEAR(lowest - highest - 0.03, far, 1e-9);
    // And from there it is found at once.
    ASSERT_NEAR(distance_m({one, here}, {other, there}, HUGE_VAL, axis), far, 2e-7);
  }
  EXPECT_GT(apart_at_all, 1000);
}

/// Nor are they farther apart: points of both are found by a plain descent.
TEST(RoundedHulls, AreNoFartherApartThanSomePointsOfThem) {
  Random random;
  for (int i = 0; i < 40; ++i) {
    const RoundedHull one = random.hull(20, 0), other = random.hull(30, 0);
    const Pose here = random.pose(1), there = random.pose(1);
    Vector3 between = here * one.corner(0) - there * other.corner(0);
    for (int step = 1; step < 5000; ++step) {
      const Vector3 next = here * one.farthest(here.rotation.transpose() * -between) -
                           there * other.farthest(there.rotation.transpose() * between);
      const Vector3 way = next - between;
      if (way.squaredNorm() < 1e-18) break;
      between += std::clamp(-between.dot(way) / way.squaredNorm(), 0.0, 1.0) * way;
    }
    const double far = apart(one, here, other, there);
    ASSERT_LE(far, between.norm() + 1e-9);
    ASSERT_NEAR(far, between.norm(), 5e-3);
  }
}

TEST(RoundedHulls, AreSearchedNoLongerThanIsAskedFor) {
  Vector3 axis{1, 0, 0};
  const Pose there = at(-3, 0, 0);
  const double far = distance_m({box(0.5), {}}, {box(0.5), there}, 0.5, axis);
  EXPECT_GE(far, 0.5);
  EXPECT_LE(far, 2);
}

TEST(RoundedHulls, HaveABallAroundThem) {
  Random random;
  const std::array hulls{random.hull(10, 0.1), random.hull(20, 0.05)};
  const Ball found = ball_around(hulls);
  for (const RoundedHull& hull : hulls)
    for (std::size_t k = 0; k < hull.corners(); ++k)
      EXPECT_LE((hull.corner(k) - found.centre).norm() + hull.radius_m(), found.radius_m + 1e-12);
}

TEST(RoundedHulls, HaveNoMoreCornersThanThereIsRoomFor) {
  RoundedHull hull = Random{}.hull(RoundedHull::most_corners, 0);
  EXPECT_EQ(hull.corners(), RoundedHull::most_corners);
  EXPECT_FALSE(hull.add({9, 9, 9}));
}

}  // namespace
}  // namespace hirosco::robotics
