// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "robotics/shapes/clearance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "robotics/shapes/swept.hpp"
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

TEST_F(ClearanceTest, TellsWhoIsTooNearWhereverHeComesFrom) {
  EXPECT_LT(clearance.too_near(folded).distance_m, 0.02);
  EXPECT_THAT(clearance.too_near(folded).names, HasSubstr("upper_arm"));
  EXPECT_FALSE(clearance.keeps_limits(folded));
  EXPECT_EQ(clearance.too_near(clear).distance_m, HUGE_VAL);
  EXPECT_TRUE(clearance.keeps_limits(clear));
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

/// A tool of half a metre across the arm, and a line to where a payload is.
TEST_F(ClearanceTest, SeesWhatTheTipCarriesAndForgetsIt) {
  using Carried = robotics::Clearance::Carried;
  robotics::Clearance carrying{model,
                               shapes_of(testing::six_axes, descriptor::file_system()(testing::six_axes).value()).hulls,
                               model.find_frame("tool").value()};
  carrying.set_limit(0.02);
  ASSERT_EQ(carrying.pairs(), clearance.pairs());
  const double without = clearance.nearest(clear).distance_m;
  EXPECT_NEAR(carrying.nearest(clear).distance_m, without, 1e-6);
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  dynamics.update({.q = clear, .qd = JointVector::Zero(6)});
  const robotics::Pose tip = dynamics.frame_pose(model.find_frame("tool").value());
  const robotics::Pose upper_arm = dynamics.frame_pose(model.find_frame("upper_arm").value());
  const Vector3 into = robotics::inverse(tip) * (upper_arm * Vector3{0, 0, 0.2});
  for (const auto& [which, name] : {std::pair{Carried::Tool, "the tool"}, {Carried::Payload, "the payload"}}) {
    carrying.carry(which, into, 0);
    EXPECT_LT(carrying.nearest(clear).distance_m, 0.02) << name;
    EXPECT_THAT(carrying.nearest(clear).names, HasSubstr(name));
    carrying.carry(which, Vector3::Zero(), 0.1);
    EXPECT_NEAR(carrying.nearest(clear).distance_m, without, 1e-6) << name;
  }
  // Beside a volume: as far around as it is said to be.
  const Vector3 beside = tip * Vector3{0.1, 0.2, 0};
  carrying.keep_out(std::array{robotics::Capsule{beside, beside, 0.01}});
  carrying.carry(Carried::Tool, {0, 0.3, 0}, 0);
  EXPECT_TRUE(carrying.keeps_limits(clear));
  carrying.carry(Carried::Tool, {0, 0.3, 0}, 0.08);
  EXPECT_FALSE(carrying.keeps_limits(clear));
  EXPECT_THAT(carrying.nearest(clear).names, HasSubstr("the tool and a volume"));
}

TEST_F(ClearanceTest, HasNothingOfWhatTheTipCarriesBehindTheTip) {
  using Carried = robotics::Clearance::Carried;
  robotics::Clearance carrying{model,
                               shapes_of(testing::six_axes, descriptor::file_system()(testing::six_axes).value()).hulls,
                               model.find_frame("tool").value()};
  carrying.set_limit(0.02);
  for (const double radius_m : {0.05, 0.066, 0.1})
    for (const double length_m : {0.02, 0.3}) {
      carrying.carry(Carried::Tool, {0, length_m, 0}, radius_m);
      for (int roll = -6; roll <= 6; ++roll) {
        JointVector rolled = clear;
        rolled[4] = 0.1 * roll;
        EXPECT_TRUE(carrying.keeps_limits(rolled)) << radius_m << " m, " << length_m << " m, " << rolled[4];
      }
    }
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

/// The same, and at the end of the last one a finger that opens by 50 mm towards the first; it is a gripper's.
[[nodiscard]] robotics::Clearance clearance_of_row_with_finger(double gap) {
  std::string text = row(gap, "lower='-1' upper='1'");
  text.insert(text.find("</robot>"),
              "<link name='f'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
              "izz='1'/></inertial><collision><origin xyz='" +
                  std::to_string(gap - 0.29) +
                  " 0 0'/><geometry><box size='0.02 0.1 0.1'/></geometry></collision></link>"
                  "<joint name='slide' type='prismatic'><parent link='c'/><child link='f'/><axis xyz='-1 0 0'/>"
                  "<limit lower='0' upper='0.05' velocity='1' effort='1'/></joint>");
  auto robot = robotics::urdf::read("row.urdf", text).value.value();
  auto shapes = shapes_of("row.urdf", text);
  const std::vector<std::string> standing{"slide"};
  robotics::sweep(shapes.hulls, robot, standing);
  EXPECT_FALSE(robotics::urdf::fix(robot, standing));
  static std::deque<robotics::Model> models;  // which clearances go by
  models.push_back(robotics::Model::make(robotics::urdf::describe(robot)).value());
  robotics::Clearance made{models.back(), shapes.hulls};
  made.set_limit(0.02);
  return made;
}
[[nodiscard]] std::size_t pair_of(const robotics::Clearance& clearance, std::string_view names) {
  for (std::size_t i = 0; i < clearance.pairs(); ++i)
    if (clearance.pair(i).names == names) return i;
  ADD_FAILURE() << names;
  return 0;
}

TEST(ClearanceOfAGripper, IsThatOfItsFingersWhereverTheyMayBe) {
  robotics::Clearance clearance = clearance_of_row_with_finger(0.1);
  std::vector<double> apart(clearance.pairs());
  clearance.distances(JointVector::Zero(2), apart);
  EXPECT_NEAR(apart[pair_of(clearance, "a and c")], 0.1, 1e-5);
  EXPECT_NEAR(apart[pair_of(clearance, "a and f")], 0.05, 1e-5) << "closed it is 0.1 away";
  EXPECT_THAT(clearance.nearest(JointVector::Zero(2)).names, HasSubstr("a and f"));
}

/// Open it is in the first one with all joints at 0: that is where it may not be, and not how the two are built.
TEST(ClearanceOfAGripper, IsNotLearntFromFingersThatAreOpen) {
  robotics::Clearance clearance = clearance_of_row_with_finger(0.03);
  const auto& pair = clearance.pair(pair_of(clearance, "a and f"));
  EXPECT_NEAR(pair.built_m, 0.03, 1e-5);
  EXPECT_NEAR(pair.limit_m, 0.01, 1e-5);
  const JointVector beside = vector_of(std::array{0.0, 1.0}), there = JointVector::Zero(2);
  EXPECT_THAT(clearance.nearer(beside, there).names, HasSubstr("a and f"));
  EXPECT_EQ(clearance.nearer(there, beside).distance_m, HUGE_VAL) << "away from it";
}

TEST(ClearanceByConstruction, IsNotLearntWhereTheJointsBetweenThemCannotBe) {
  EXPECT_EQ(clearance_of_row(-0.05, "lower='0.5' upper='2'").pair(0).limit_m, 0.02);
}

}  // namespace
}  // namespace hirosco::robot_arm
