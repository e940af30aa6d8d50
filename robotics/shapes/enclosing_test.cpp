// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/enclosing.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace hirosco::robotics {
namespace {

using Points = std::vector<Vector3>;

void add_box(Mesh& mesh, const Vector3& low, const Vector3& high) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  for (int i = 0; i < 8; ++i)
    mesh.points.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z());
  constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  for (const auto& side : sides) {
    mesh.triangles.push_back({first + side[0], first + side[1], first + side[2]});
    mesh.triangles.push_back({first + side[0], first + side[2], first + side[3]});
  }
}

[[nodiscard]] double outside(const std::vector<RoundedHull>& hulls, const Vector3& point) {
  double least = HUGE_VAL;
  const Pose here;
  const RoundedHull alone{std::span{&point, 1}, 0};
  for (const RoundedHull& hull : hulls) least = std::min(least, distance_m({hull, here}, {alone, here}));
  return least;
}

/// Points all over the triangles, not their corners only.
void expect_enclosed(const Mesh& mesh, const std::vector<RoundedHull>& hulls) {
  std::mt19937 random{2};
  std::uniform_real_distribution<double> share{0, 1};
  for (const Mesh::Triangle& triangle : mesh.triangles)
    for (int i = 0; i < 20; ++i) {
      double u = share(random), v = share(random);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vector3& a = mesh.points[triangle[0]];
      const Vector3 point = a + u * (mesh.points[triangle[1]] - a) + v * (mesh.points[triangle[2]] - a);
      ASSERT_LE(outside(hulls, point), 0);
    }
}

TEST(HullVolume, IsThatOfClosedForms) {
  Points corners{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  EXPECT_NEAR(hull_volume_m3(corners), 1, 1e-12) << "a tetrahedron";
  corners.emplace_back(0.1, 0.1, 0.1);
  EXPECT_NEAR(hull_volume_m3(corners), 1, 1e-12) << "and a point in it";
  Mesh box;
  add_box(box, {-1, -2, -3}, {1, 2, 3});
  EXPECT_NEAR(hull_volume_m3(box.points), 48, 1e-9);
  EXPECT_EQ(hull_volume_m3(Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), 0) << "flat";
  EXPECT_EQ(hull_volume_m3(Points(5, Vector3::Ones())), 0);
}

TEST(Hull, OfFewPointsHasThemAsCorners) {
  const RoundedHull hull = hull_around({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_EQ(hull.corners(), 4u);
  EXPECT_LT(hull.radius_m(), 1e-6);
}

TEST(Hull, OfManyPointsHasSomeOfThemAndARadiusThatCoversTheOthers) {
  std::mt19937 random{5};
  std::normal_distribution<double> any;
  Points ball;
  for (int i = 0; i < 3000; ++i) ball.push_back(0.1 * Vector3{any(random), any(random), any(random)}.normalized());
  const RoundedHull hull = hull_around(ball);
  EXPECT_EQ(hull.corners(), RoundedHull::most_corners);
  // The ball of 0.1 m with 64 corners: a few millimetres.
  EXPECT_LT(hull.radius_m(), 0.008);
  for (const Vector3& point : ball) ASSERT_LE(outside({hull}, point), 0);
}

TEST(Enclosing, ABoxIsOneHull) {
  Mesh box;
  add_box(box, {0, 0, 0}, {0.1, 0.2, 0.3});
  const auto hulls = enclosing(box);
  ASSERT_EQ(hulls.size(), 1u);
  EXPECT_EQ(hulls[0].corners(), 8u);
  expect_enclosed(box, hulls);
  EXPECT_NEAR(outside(hulls, {0.2, 0.1, 0.1}), 0.1, 1e-6);
}

/// An angle of two beams: what lies between them is free once it is cut.
TEST(Enclosing, AnAngleIsCutWhereItsHullIsEmpty) {
  Mesh angle;
  add_box(angle, {0, 0, 0}, {1, 0.1, 0.1});
  add_box(angle, {0, 0, 0}, {0.1, 1, 0.1});
  const Vector3 between{0.4, 0.4, 0.05};
  EXPECT_LE(outside(enclosing(angle, {.most_hulls = 1}), between), 0);
  const auto hulls = enclosing(angle);
  EXPECT_GT(hulls.size(), 1u);
  EXPECT_LE(hulls.size(), Fineness{}.most_hulls);
  expect_enclosed(angle, hulls);
  EXPECT_GT(outside(hulls, between), 0.15);
}

TEST(Enclosing, WhatIsFlatOrOnePointIsEnclosedToo) {
  Mesh flat;
  flat.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}};
  expect_enclosed(flat, enclosing(flat));
  flat.points.assign(3, Vector3::Ones());
  EXPECT_LE(outside(enclosing(flat), Vector3::Ones()), 0);
}

}  // namespace
}  // namespace hirosco::robotics
