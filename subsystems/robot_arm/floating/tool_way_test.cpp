// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/tool_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "robotics/shapes/clearance.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// What is reckoned of a way of the tool before it is gone, beside the servicer that goes it: joints that follow the velocities of each cycle, on a base
/// without momentum.
namespace hirosco::robot_arm {
namespace {

const std::string walked_file = HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf";

const robotics::Model& walked_model() {
  static const robotics::Model model = testing::model_of(walked_file);
  return model;
}
[[nodiscard]] robotics::FrameId walked_tip() { return walked_model().find_frame("tool").value(); }
[[nodiscard]] Bounds walked_bounds() {
  static const std::vector<JointBounds> all = testing::bounds_of(walked_model());
  return all;
}
const JointVector walked_from = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});

/// From there, on a base that stands where its axes are.
[[nodiscard]] ToolWay::Plan plan_from(ToolLaw law, const JointVector& position, const Vector3& offset_m,
                                      double duration_s) {
  FloatingModel model{walked_model(), walked_tip()};
  EXPECT_TRUE(model.update({}, position));
  return {.law = law, .position = position, .tool = model.tool(), .offset_m = offset_m, .duration_s = duration_s};
}

/// The same, gone: where the joints are at the end of its time, with a cycle of 5 ms.
[[nodiscard]] JointVector gone(const ToolWay::Plan& plan) {
  constexpr double cycle_s = 0.005;
  FloatingModel model{walked_model(), walked_tip()};
  BaseEstimate base;
  JointVector position = plan.position;
  for (double t = 0; t < plan.duration_s + 2; t += cycle_s) {
    const robotics::Matrix3 turned = base.orientation().toRotationMatrix();
    EXPECT_TRUE(model.update({turned, base.position_m()}, position));
    const Course at = course(t, plan.duration_s);
    ToolGoal goal{plan.tool, at.per_s * plan.offset_m};
    goal.pose.position += at.share * plan.offset_m;
    JointVector rates = tool_rates(plan.law, model, walked_bounds(), goal, turned, plan.base_kept);
    slow_down(rates, walked_bounds());
    if (plan.law != ToolLaw::FixedBase) base.go_on(model.base() * rates, cycle_s);
    position += cycle_s * rates;
  }
  return position;
}

TEST(ToolWay, EndsWhereTheLawTakesTheJointsInEachLawAndDirection) {
  double most = 0, laws_apart = HUGE_VAL;
  for (const Vector3& axis : {Vector3{Vector3::UnitX()}, Vector3{Vector3::UnitY()}, Vector3{Vector3::UnitZ()}})
    for (const double side : {0.2, -0.2}) {
      const Vector3 offset_m = side * axis;
      std::array<JointVector, 3> ends;
      for (const ToolLaw law : {ToolLaw::FixedBase, ToolLaw::InertialTrack, ToolLaw::AttitudeHold}) {
        const ToolWay::Plan plan = plan_from(law, walked_from, offset_m, 20);
        ToolWay way{walked_model(), walked_tip()};
        way.begin(plan);
        int steps = 0;
        while (way.step(walked_bounds())) ++steps;
        EXPECT_EQ(steps, ToolWay::steps);
        most = std::max(most, (way.posture() - gone(plan)).cwiseAbs().maxCoeff());
        ends[static_cast<std::size_t>(law)] = way.posture();
      }
      laws_apart = std::min(laws_apart, (ends[0] - ends[1]).cwiseAbs().maxCoeff());
    }
  std::cout << "  a joint is off by " << 1e3 * most << " mrad at most, by another law's base by " << 1e3 * laws_apart
            << " mrad at least\n";
  EXPECT_LT(most, 0.01);
  EXPECT_GT(laws_apart, most) << "how the base gives way is in it";
}

/// Where a flight of it is stopped before the last tube is folded onto the one before: the limit of 20 mm is at 2.51 rad.
TEST(ToolWay, LeadsIntoThePairThatAMotionWouldBeStoppedFor) {
  const std::string text = descriptor::file_system()(walked_file).value();
  const auto shapes = robotics::read_collision_shapes(walked_file, text, descriptor::file_system());
  robotics::Clearance clearance{walked_model(), shapes.value.value().hulls};
  clearance.set_limit(0.02);
  const JointVector folded = vector_of(std::array{0.107, 0.76, -0.327, -1.758, -0.059, 2.35, -0.005});
  ToolWay way{walked_model(), walked_tip()};
  for (const auto& [side, pair] : {std::pair{-0.35, "link5 and link7"}, {0.1, ""}}) {
    way.begin(plan_from(ToolLaw::FixedBase, folded, {side, 0, side}, 25));
    robotics::Clearance::Nearest found;
    while (found.distance_m == HUGE_VAL && way.step(walked_bounds())) found = clearance.nearer(folded, way.posture());
    EXPECT_STREQ(found.names, pair) << side;
    if (side > 0) continue;
    EXPECT_LT(found.distance_m, 0.02);
    EXPECT_GT(way.posture()[5], 2.48);
    EXPECT_LT(way.posture()[5], 2.56) << "in the step in which it is reached";
  }
}

/// Beyond that nobody knows where it would be: a cycle ends the motion there, and says why.
TEST(ToolWay, EndsBeforeAJointsEndAndWhereTheBaseWouldNotStayUnturned) {
  ToolWay way{walked_model(), walked_tip()};
  EXPECT_FALSE(way.step(walked_bounds())) << "nothing was begun";
  const JointVector near_end = vector_of(std::array{2.8, 1.5708, 1.5708, -1.2, 0.0, 1.2, 0.0});
  way.begin(plan_from(ToolLaw::FixedBase, near_end, {0, -0.3, 0}, 25));
  int steps = 0;
  while (way.step(walked_bounds())) {
    ++steps;
    EXPECT_LE(way.posture()[0], 2.9 - 0.01);
  }
  EXPECT_LT(steps, ToolWay::steps);
  EXPECT_FALSE(way.step(walked_bounds())) << "and stays so";
  const JointVector stretched_out = vector_of(std::array{0.3, 0.35, 0.2, 1.1, -0.3, 0.5, 0.1});
  way.begin(plan_from(ToolLaw::AttitudeHold, stretched_out, {0.02, 0, 0}, 2));
  EXPECT_FALSE(way.step(walked_bounds()));
  EXPECT_EQ(way.posture(), stretched_out);
}

/// Ten times what TOOL_SPEED permits: joints go as fast as they may and no faster, and what is no number moves nobody.
TEST(ToolWay, GoesNoFasterThanItsJointsMay) {
  ToolWay way{walked_model(), walked_tip()};
  way.begin(plan_from(ToolLaw::InertialTrack, walked_from, {0.3, 0, 0}, 1));
  JointVector before = walked_from;
  while (way.step(walked_bounds())) {
    EXPECT_LE((way.posture() - before).cwiseAbs().maxCoeff(), 0.2 / ToolWay::steps * (1 + 1e-9));
    before = way.posture();
  }
  way.begin(plan_from(ToolLaw::InertialTrack, walked_from, {NAN, 0, 0}, 1));
  while (way.step(walked_bounds())) EXPECT_EQ(way.posture(), walked_from);
}

}  // namespace
}  // namespace hirosco::robot_arm
