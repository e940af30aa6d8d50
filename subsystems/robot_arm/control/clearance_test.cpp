// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/clearance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

using ::testing::HasSubstr;

[[nodiscard]] robotics::CollisionShapes shapes_of(const std::filesystem::path& file, std::string_view text) {
  auto reading = robotics::read_collision_shapes(file, text, descriptor::file_system());
  for (const auto& problem : reading.problems) ADD_FAILURE() << problem.message;
  return reading.value.value_or(robotics::CollisionShapes{});
}
[[nodiscard]] robotics::Clearance clearance_of(const robotics::Model& model, const std::filesystem::path& file,
                                               std::string_view text) {
  robotics::Clearance made{model, shapes_of(file, text).hulls};
  made.set_limit(0.02);
  return made;
}

struct ClearanceTest : ::testing::Test {
  robotics::Model model = testing::model_of(testing::six_axes);
  robotics::Clearance clearance =
      clearance_of(model, testing::six_axes, descriptor::file_system()(testing::six_axes).value());
  JointVector clear = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  /// Folded back onto the upper arm, the wrist meets it.
  JointVector folded = vector_of(std::array{0.0, 0.0, 2.6, 2.2, 0.0, 0.0});
};

TEST_F(ClearanceTest, NamesTheTwoLinksThatAFoldedArmBringsTogether) {
  EXPECT_GT(clearance.pairs(), 3u);
  EXPECT_GT(clearance.nearest(clear).distance_m, 0.05);
  const auto found = clearance.nearest(folded);
  EXPECT_LT(found.distance_m, 0.02) << found.names;
  EXPECT_THAT(found.names, HasSubstr("upper_arm"));
}

TEST_F(ClearanceTest, RefusesWhoComesNearerAndLetsGoWhoIsTooNear) {
  EXPECT_LT(clearance.nearer(clear, folded).distance_m, 0.02);
  EXPECT_THAT(clearance.nearer(clear, folded).names, HasSubstr("upper_arm"));
  EXPECT_EQ(clearance.nearer(folded, clear).distance_m, HUGE_VAL) << "away from it";
  EXPECT_EQ(clearance.nearer(folded, folded).distance_m, HUGE_VAL) << "where it is";
}

TEST_F(ClearanceTest, NamesTheLinkThatComesNearAVolumeToKeepOutOf) {
  const JointVector upright = JointVector::Zero(6), inside = vector_of(std::array{0.0, 0.8, 0.3, 0.0, 0.0, 0.0});
  const std::array volumes{robotics::Capsule{{0.5, -1, 0.7}, {0.5, 1, 0.7}, 0.2}};
  clearance.keep_out(volumes);
  EXPECT_GT(clearance.nearest(upright).distance_m, 0.05);
  EXPECT_LT(clearance.nearest(inside).distance_m, 0);
  EXPECT_THAT(clearance.nearest(inside).names, HasSubstr("volume"));
  EXPECT_THAT(clearance.nearer(upright, inside).names, HasSubstr("volume"));
  clearance.keep_out({});
  EXPECT_GT(clearance.nearest(inside).distance_m, 0);
  EXPECT_EQ(clearance.nearer(upright, inside).distance_m, HUGE_VAL);
}

/// Three links in a row, of which the first and the last are `gap` apart with all joints at 0; the middle one is in nobody's way.
[[nodiscard]] std::string row(double gap, const char* range) {
  const auto link = [](const std::string& name, const std::string& x) {
    return "<link name='" + name +
           "'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
           "izz='1'/></inertial><collision><origin xyz='" +
           x +
           " 0 0'/><geometry><box size='0.2 0.1 0.1'/></geometry>"
           "</collision></link>";
  };
  const auto joint = [&](const std::string& name, const char* x, const std::string& parent, const std::string& child) {
    return "<joint name='" + name + "' type='revolute'><origin xyz='" + x + " 0 0'/><parent link='" + parent +
           "'/><child link='" + child + "'/><axis xyz='0 0 1'/><limit " + range + " velocity='1' effort='1'/></joint>";
  };
  return "<robot name='row'>" + link("a", "0") + link("b", "5") + link("c", std::to_string(gap - 0.2)) +
         joint("j", "0.1", "a", "b") + joint("k", "0.3", "b", "c") + "</robot>";
}
[[nodiscard]] robotics::Clearance clearance_of_row(double gap, const char* range) {
  const std::string text = row(gap, range);
  const auto reading = robotics::urdf::read("row.urdf", text);
  return clearance_of(robotics::Model::make(robotics::urdf::describe(reading.value.value())).value(), "row.urdf", text);
}

TEST(ClearanceByConstruction, IsTheLimitOfThoseWhoAreBuiltNearEachOther) {
  constexpr const char* any = "lower='-1' upper='1'";
  EXPECT_NEAR(clearance_of_row(0.03, any).pair(0).limit_m, 0.01, 1e-6) << "30 mm apart";
  EXPECT_EQ(clearance_of_row(0.1, any).pair(0).limit_m, 0.02) << "100 mm apart";
  EXPECT_EQ(clearance_of_row(-0.05, any).pair(0).limit_m, 0) << "in each other";
}

TEST(ClearanceByConstruction, IsNotLearntWhereTheJointsBetweenThemCannotBe) {
  EXPECT_EQ(clearance_of_row(-0.05, "lower='0.5' upper='2'").pair(0).limit_m, 0.02);
}

}  // namespace
}  // namespace hirosco::robot_arm
