// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "subsystems/robot_arm/control/clearance.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

TEST(Capsules, AreAsFarFromEachOtherAsTheirLinesLessTheirRadii) {
  const Capsule along_x{{0, 0, 0}, {1, 0, 0}, 0.1};
  EXPECT_NEAR(distance_m(along_x, {{0.5, 0.5, -1}, {0.5, 0.5, 1}, 0.2}), 0.2, 1e-12) << "crossing";
  EXPECT_NEAR(distance_m(along_x, {{0, 1, 0}, {1, 1, 0}, 0.1}), 0.8, 1e-12) << "parallel";
  EXPECT_NEAR(distance_m(along_x, {{3, 0, 0}, {5, 0, 0}, 0.1}), 1.8, 1e-12) << "one behind the other";
  EXPECT_NEAR(distance_m(along_x, {{2, 1, 0}, {2, 1, 0}, 0}), std::numbers::sqrt2 - 0.1, 1e-12) << "a point";
  EXPECT_NEAR(distance_m({{1, 1, 1}, {1, 1, 1}, 0.5}, {{1, 1, 3}, {1, 1, 3}, 0.5}), 1, 1e-12) << "two balls";
}

/// Against a search of both lines.
TEST(Capsules, AreAsFarAsASearchFinds) {
  std::mt19937 random{1};
  std::uniform_real_distribution<double> any{-1, 1};
  const auto point = [&] { return Vector3{any(random), any(random), any(random)}; };
  constexpr int steps = 200;
  for (int i = 0; i < 50; ++i) {
    const Capsule one{point(), point(), 0.05}, other{point(), point(), 0.1};
    double least = HUGE_VAL;
    for (int s = 0; s <= steps; ++s)
      for (int t = 0; t <= steps; ++t)
        least = std::min(
            least,
            (one.from + (one.to - one.from) * s / steps - other.from - (other.to - other.from) * t / steps).norm());
    EXPECT_NEAR(distance_m(one, other), least - 0.15, 0.01);
    EXPECT_LE(distance_m(one, other), least - 0.15 + 1e-12);
  }
}

TEST(Hulls, EncloseCylindersBoxesAndSpheresWhereTheyAreAndNameMeshes) {
  const auto found = hulls_of(R"(<robot name="r">
    <link name="a"><collision><origin xyz="1 2 3" rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.1" length="2"/></geometry></collision></link>
    <link name="b"><collision><geometry><box size="0.3 1 0.4"/></geometry></collision><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
    <link name="c"><collision><geometry><mesh filename="c.stl"/></geometry></collision><visual><geometry><sphere radius="9"/></geometry></visual></link>
  </robot>)");
  ASSERT_EQ(found.hulls.size(), 3u);
  EXPECT_LT((found.hulls[0].capsule.to - Vector3{2, 2, 3}).norm(), 1e-12);
  EXPECT_LT((found.hulls[0].capsule.from - Vector3{0, 2, 3}).norm(), 1e-12);
  EXPECT_NEAR(found.hulls[1].capsule.radius_m, 0.25, 1e-12);
  EXPECT_NEAR(found.hulls[1].capsule.to.y(), 0.5, 1e-12);
  EXPECT_EQ(found.hulls[2].capsule.radius_m, 0.2);
  EXPECT_EQ(found.unknown, std::vector<std::string>{"c"});
}

struct ClearanceTest : ::testing::Test {
  robotics::Model model = testing::model_of(testing::six_joints);
  Clearance clearance{model, hulls_of(descriptor::file_system()(testing::six_joints).value()), 0.02};
};

TEST_F(ClearanceTest, NamesTheTwoLinksThatAFoldedArmBringsTogether) {
  EXPECT_GT(clearance.pairs(), 3u);
  EXPECT_GT(clearance.nearest(vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1})).distance_m, 0.05);
  // Folded back onto the upper arm, the wrist meets it.
  const auto folded = clearance.nearest(vector_of(std::array{0.0, 0.0, 2.6, 2.2, 0.0, 0.0}));
  EXPECT_LT(folded.distance_m, 0.02) << folded.names;
  EXPECT_NE(std::string{folded.names}.find("upper_arm"), std::string::npos) << folded.names;
}

TEST_F(ClearanceTest, NamesTheLinkThatComesNearAVolumeToKeepOutOf) {
  const JointVector upright = JointVector::Zero(6);
  const std::array volumes{Capsule{{0.5, -1, 0.7}, {0.5, 1, 0.7}, 0.2}};
  clearance.keep_out(volumes);
  EXPECT_GT(clearance.nearest(upright).distance_m, 0.05);
  const auto near = clearance.nearest(vector_of(std::array{0.0, 0.8, 0.3, 0.0, 0.0, 0.0}));
  EXPECT_LT(near.distance_m, 0);
  EXPECT_NE(std::string{near.names}.find("volume"), std::string::npos) << near.names;
  clearance.keep_out({});
  EXPECT_GT(clearance.nearest(vector_of(std::array{0.0, 0.8, 0.3, 0.0, 0.0, 0.0})).distance_m, 0);
}

}  // namespace
}  // namespace hirosco::robot_arm
