// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/range_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <vector>

#include "subsystems/robot_arm/floating/tool_law.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

/// What keeps laws of the tool off the ends of ranges, by itself and in plain reckoning of the servicer: joints that follow their velocities, and
/// a base without momentum.
namespace hirosco::robot_arm {
namespace {

constexpr double sides[] = {1, -1};

const robotics::Model& floating_servicer() {
  static const robotics::Model model =
      testing::model_of(HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf");
  return model;
}
[[nodiscard]] Bounds ranges() {
  static const std::vector<JointBounds> all = testing::bounds_of(floating_servicer());
  return all;
}
[[nodiscard]] JointVector begun() {
  JointVector q(7);
  q << 0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0;
  return q;
}
[[nodiscard]] double end_of(Eigen::Index joint, double side) {
  const JointBounds& its = ranges()[static_cast<std::size_t>(joint)];
  return side > 0 ? its.highest : its.lowest;
}
/// Of all joints, from the nearest end.
[[nodiscard]] double least_left(const JointVector& q) {
  double least = HUGE_VAL;
  for (Eigen::Index i = 0; i < q.size(); ++i) least = std::min({least, end_of(i, 1) - q[i], q[i] - end_of(i, -1)});
  return least;
}

/// The servicer as its joints make it move.
class Floating {
 public:
  Floating(ToolLaw law, JointVector q) : law_{law}, q_{std::move(q)} { update(); }

  /// Along the course of MOVE_TOOL and a second more. The joint that ended it, as who carries it out is told.
  std::optional<EndAhead> move(const Vector3& offset_m, double duration_s) {
    const robotics::Pose from = model_.tool();
    const robotics::Matrix3 kept = base_.rotation;
    std::optional<EndAhead> stopped;
    for (double t = 0; t < duration_s + 1; t += cycle_s) {
      const Course at = course(t, duration_s);
      ToolGoal goal{from, at.per_s * offset_m};
      goal.pose.position += at.share * offset_m;
      JointVector rates = tool_rates(law_, model_, ranges(), goal, base_.rotation, kept);
      slow_down(rates, ranges());
      if (!stopped) stopped = end_ahead(q_, rates, ranges());
      if (stopped) rates.setZero();
      step(rates);
      least_left_ = std::min(least_left_, least_left(q_));
    }
    off_m_ = (model_.tool().position - from.position - offset_m).norm();
    return stopped;
  }
  [[nodiscard]] const FloatingModel& model() const { return model_; }
  [[nodiscard]] double least_left_ever() const { return least_left_; }
  [[nodiscard]] double off_goal_m() const { return off_m_; }

 private:
  static constexpr double cycle_s = 0.01;

  void update() { ASSERT_TRUE(model_.update(base_, q_)); }
  /// Joints follow velocities as the law of torques lets them.
  void step(const JointVector& rates) {
    qd_ += (1 - std::exp(-followed_per_s * cycle_s)) * (rates - qd_);
    q_ += cycle_s * qd_;
    if (law_ != ToolLaw::FixedBase) {
      const Vector6 twist = model_.base() * qd_;
      const Vector3 turn = cycle_s * twist.head<3>();
      base_.position += cycle_s * (base_.rotation * Vector3{twist.tail<3>()});
      base_.rotation = base_.rotation *
                       Eigen::AngleAxisd{turn.norm(), turn.norm() > 0 ? Vector3{turn.normalized()} : Vector3::UnitX()}
                           .toRotationMatrix();
    }
    update();
  }

  ToolLaw law_;
  FloatingModel model_{floating_servicer(), floating_servicer().find_frame("tool").value()};
  robotics::Pose base_{};
  JointVector q_, qd_{JointVector::Zero(7)};
  double least_left_{HUGE_VAL}, off_m_{0};
};

TEST(RangeEnds, WeighNothingBeforeTheLastTwentiethOfARangeAndNobodyWhoGoesAway) {
  for (Eigen::Index joint = 0; joint < 7; ++joint)
    for (const double side : sides) {
      const JointBounds& its = ranges()[static_cast<std::size_t>(joint)];
      const auto weight = [&](double before, double way) {
        return weight_near_end(its, end_of(joint, side) - side * before, side * way);
      };
      const double avoided = avoided_share * (its.highest - its.lowest);
      EXPECT_EQ(weight(kept_from_end + avoided + 1e-9, 0.1), 1);
      EXPECT_NEAR(weight(kept_from_end + avoided / 2, 0.1), 0.5, 1e-9);
      for (const double before : {kept_from_end, kept_from_end / 2, 0.0, -0.1}) {
        EXPECT_LT(weight(before, 0.1), 1e-12) << before;
        EXPECT_EQ(weight(before, -0.1), 1) << before;
      }
    }
  EXPECT_EQ(weight_near_end(JointBounds{}, 100, 1), 1) << "one without an end";
}

TEST(RangeEnds, ATurnOfEachJointIsStoppedBeforeEachEndAndNamed) {
  for (Eigen::Index joint = 0; joint < 7; ++joint)
    for (const double side : sides)
      for (const double rate : {1e-3, 0.05, 0.2}) {
        JointVector rates = JointVector::Zero(7), q = begun();
        rates[joint] = side * rate;
        const double stops_at = kept_from_end + rate * stopped_in_s;
        q[joint] = end_of(joint, side) - side * (stops_at + 1e-9);
        EXPECT_FALSE(end_ahead(q, rates, ranges()));
        q[joint] = end_of(joint, side) - side * (stops_at - 1e-9);
        const auto found = end_ahead(q, rates, ranges());
        ASSERT_TRUE(found);
        EXPECT_EQ(found->joint, static_cast<std::size_t>(joint));
        EXPECT_EQ(found->position, q[joint]);
        EXPECT_EQ(found->end, end_of(joint, side));
        EXPECT_FALSE(end_ahead(q, -rates, ranges())) << "away from it";
        EXPECT_FALSE(end_ahead(q, JointVector::Zero(7), ranges()));
      }
}

TEST(RangeEnds, LeaveTheLawsOfTheToolAsTheyAreFarFromThem) {
  const Floating servicer{ToolLaw::FixedBase, begun()};
  const robotics::Matrix3 upright = robotics::Matrix3::Identity();
  ToolGoal goal{servicer.model().tool(), {0.01, -0.02, 0.005}};
  for (const ToolLaw law : {ToolLaw::FixedBase, ToolLaw::InertialTrack, ToolLaw::AttitudeHold})
    EXPECT_EQ(tool_rates(law, servicer.model(), ranges(), goal, upright, upright),
              tool_rates(law, servicer.model(), {}, goal, upright, upright));
}

/// Three moves that are permitted one by one: without what is tried here joint 6 passes its end in the third, with no error of the tool at all.
TEST(RangeEnds, AreNotPassedByMovesOneBehindTheOther) {
  Floating servicer{ToolLaw::FixedBase, begun()};
  const Vector3 offset_m{-0.35, 0, -0.35};
  for (int moved = 1; moved <= 2; ++moved) {
    EXPECT_FALSE(servicer.move(offset_m, 25)) << moved;
    EXPECT_LT(servicer.off_goal_m(), 1e-3) << moved;
  }
  // And however often it is asked again.
  for (int moved = 3; moved <= 5; ++moved) {
    const auto stopped = servicer.move(offset_m, 25);
    ASSERT_TRUE(stopped) << moved;
    EXPECT_EQ(stopped->joint + 1, 6U);
    EXPECT_EQ(stopped->end, 2.9);
  }
  EXPECT_GT(servicer.least_left_ever(), 0);
  EXPECT_FALSE(servicer.move(-offset_m, 25)) << "the way back";
  EXPECT_LT(servicer.off_goal_m(), 1e-3);
}

TEST(RangeEnds, ArePassedByNoJointUnderNoLaw) {
  int stops = 0;
  double least = HUGE_VAL;
  for (const ToolLaw law : {ToolLaw::FixedBase, ToolLaw::InertialTrack, ToolLaw::AttitudeHold})
    for (Eigen::Index joint = 0; joint < 7; ++joint)
      for (const double side : sides) {
        JointVector q = begun();
        q[joint] = end_of(joint, side) - side * 0.2;
        Floating servicer{law, q};
        // Where this joint's own turn moves the tool; the last one turns it in its place.
        const auto& twists =
            law == ToolLaw::FixedBase ? servicer.model().tool_of_fixed() : servicer.model().tool_of_free();
        const Vector3 moves = twists.block<3, 1>(3, joint);
        const Vector3 offset_m = moves.norm() > 1e-3 ? Vector3{side * 0.4 * moves.normalized()} : Vector3{0.2, 0.2, 0};
        const auto stopped = servicer.move(offset_m, 20);
        least = std::min(least, servicer.least_left_ever());
        EXPECT_GT(servicer.least_left_ever(), 0) << "joint " << joint + 1 << ", side " << side;
        if (!stopped) continue;
        ++stops;
        EXPECT_LT(std::abs(stopped->end - stopped->position), avoided_share * 5.8 + kept_from_end);
      }
  std::cout << "  " << stops << " of 42 stopped, the nearest " << least << " rad before an end\n";
  EXPECT_GT(stops, 0);
}

/// With a payload joints are followed slower: whoever is told of his end only as early as without one is beyond it before he stands.
TEST(RangeEnds, LeaveRoomToStandHoweverSlowlyAJointFollows) {
  constexpr double cycle_s = 0.001, fastest_rad_s = 0.2;
  for (const double side : sides)
    for (const double per_s : {followed_per_s, 10.0, 5.0, 2.0, 1.0}) {
      JointVector q = JointVector::Zero(7), rates = q;
      q[0] = end_of(0, side) - side;
      double wanted = side * fastest_rad_s, speed = wanted;
      for (int i = 0; i < 20'000; ++i) {
        rates[0] = wanted;
        if (end_ahead(q, rates, ranges(), per_s)) wanted = 0;
        speed += per_s * cycle_s * (wanted - speed);
        q[0] += cycle_s * speed;
      }
      EXPECT_EQ(wanted, 0) << per_s;
      EXPECT_GT(side * (end_of(0, side) - q[0]), kept_from_end) << per_s;
    }
}

}  // namespace
}  // namespace hirosco::robot_arm
