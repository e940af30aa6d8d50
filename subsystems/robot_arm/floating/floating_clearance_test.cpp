// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "robotics/shapes/clearance.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// What the servicer's file says of what collides, and what comes of it in the postures that its runs begin and end in.
namespace hirosco::robot_arm {
namespace {

using ::testing::HasSubstr;

constexpr double kept_apart_m = 0.02;

struct ServicerClearance : ::testing::Test {
  const std::string file = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf";
  const std::string text = descriptor::file_system()(file).value();
  robotics::Model model = testing::model_of(file);
  robotics::CollisionShapes shapes = robotics::read_collision_shapes(file, text, descriptor::file_system())
                                         .value.value_or(robotics::CollisionShapes{});
  robotics::Clearance clearance{model, shapes.hulls};

  JointVector stow = vector_of(std::array{0.0, -1.2, 0.0, 2.4, 0.0, -1.2, 0.0});
  JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});

  void SetUp() override { clearance.set_limit(kept_apart_m); }
};

/// Of eight solids with seven joints between them each two that are not joined.
TEST_F(ServicerClearance, LooksAtTheBaseAndEachLinkWithTheWholeLimit) {
  EXPECT_TRUE(shapes.unseen.empty());
  EXPECT_EQ(shapes.hulls.size(), 8u);
  ASSERT_EQ(clearance.pairs(), 8u * 7 / 2 - 7);
  for (std::size_t i = 0; i < clearance.pairs(); ++i)
    EXPECT_EQ(clearance.pair(i).limit_m, kept_apart_m) << clearance.pair(i).names;
}

/// SV2 goes straight from one to the other. SV3's most folded run ends along -z with the base unturned; of all its runs it comes nearest, to 38 mm.
TEST_F(ServicerClearance, KeepsItsLimitInTheRunsOfTheDesign) {
  for (int i = 0; i <= 100; ++i) {
    const JointVector there = stow + i / 100.0 * (ready - stow);
    EXPECT_GT(clearance.nearest(there).distance_m, 2 * kept_apart_m) << i << " % of the way from stow to ready";
  }
  const JointVector most_folded = vector_of(std::array{0.116, 0.715, -0.288, -1.157, 0.131, 2.428, 0.0});
  EXPECT_GT(clearance.nearest(most_folded).distance_m, kept_apart_m + 0.015);
  const JointVector stretched = vector_of(std::array{0.3, 0.35, 0.2, 1.1, -0.3, 0.5, 0.1});
  EXPECT_GT(clearance.nearest(stretched).distance_m, 2 * kept_apart_m);
}

TEST_F(ServicerClearance, NamesTheBaseAndWhoIsFoldedTooFar) {
  const JointVector in_base = vector_of(std::array{0.1, -1.0, 0.0, -2.0, 0.0, 0.0, 0.0});
  EXPECT_LT(clearance.nearer(ready, in_base).distance_m, kept_apart_m);
  EXPECT_THAT(clearance.nearer(ready, in_base).names, HasSubstr("base and link"));
  for (const auto& [joint, pair] : {std::pair{1, "link1 and link3"}, {3, "link3 and link5"}, {5, "link5 and link7"}})
    for (const double side : {1.0, -1.0}) {
      JointVector folded = JointVector::Zero(7);
      folded[joint] = side * 2.45;
      if (joint != 1) {
        EXPECT_GT(clearance.nearest(folded).distance_m, kept_apart_m) << pair;
      }
      folded[joint] = side * 2.55;
      std::vector<double> apart(clearance.pairs());
      clearance.distances(folded, apart);
      for (std::size_t i = 0; i < clearance.pairs(); ++i)
        if (clearance.pair(i).names == pair) {
          EXPECT_LT(apart[i], kept_apart_m) << pair << " at " << folded[joint];
        }
    }
}

/// A ball 50 mm around a place on the way of a slide: what is between them is known.
TEST(ClearanceOfWhoIsMeasuredWithNoise, LetsHimShakeAboutAPlaceAndComeNoNearer) {
  constexpr std::string_view mass =
      "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>";
  const std::string text = std::string{"<robot name='slide'><link name='base'/><link name='cart'>"} +
                           std::string{mass} +
                           "<collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision></link>"
                           "<joint name='x' type='prismatic'><parent link='base'/><child link='cart'/><axis xyz='1 0 "
                           "0'/><limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>";
  const auto reading = robotics::urdf::read("slide.urdf", text);
  const auto model = robotics::Model::make(robotics::urdf::describe(reading.value.value())).value();
  const auto shapes = robotics::read_collision_shapes("slide.urdf", text, descriptor::file_system());
  robotics::Clearance clearance{model, shapes.value.value().hulls};
  clearance.set_limit(kept_apart_m);
  clearance.keep_out(std::array{robotics::Capsule{{0.6, 0, 0}, {0.6, 0, 0}, 0.05}});
  const auto apart = [](double metres) { return JointVector::Constant(1, 0.5 - metres); };
  constexpr double noise_m = 0.002;
  EXPECT_EQ(clearance.nearer(apart(0.019), apart(0.0175), noise_m).distance_m, HUGE_VAL) << "so much it shakes";
  EXPECT_NEAR(clearance.nearer(apart(0.019), apart(0.0175)).distance_m, 0.0175, 1e-6) << "who is measured without";
  EXPECT_NEAR(clearance.nearer(apart(0.019), apart(0.0165), noise_m).distance_m, 0.0165, 1e-6);
  EXPECT_NEAR(clearance.nearer(apart(0.1), apart(0.0199), noise_m).distance_m, 0.0199, 1e-6) << "from afar";
  EXPECT_EQ(clearance.nearer(apart(0.005), apart(0.006), noise_m).distance_m, HUGE_VAL) << "away from it";
  EXPECT_NEAR(clearance.nearer(apart(0.015), apart(0.004), 0.1).distance_m, 0.004, 1e-6)
      << "half of the limit, however much noise there is";
}

}  // namespace
}  // namespace hirosco::robot_arm
