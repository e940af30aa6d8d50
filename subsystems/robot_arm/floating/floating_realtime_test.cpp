// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/utilities/allocation_guard.hpp"
#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/floating/floating_laws.hpp"
#include "subsystems/robot_arm/floating/range_ends.hpp"
#include "subsystems/robot_arm/floating/tool_law.hpp"
#include "subsystems/robot_arm/floating/tool_way.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

/// All that is reckoned in a cycle of an arm whose base gives way, in every law, with a tool and a payload.
TEST(FloatingControl, UsesNoHeapInACycle) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  constexpr double period_s = 0.001;
  const robotics::Model model =
      testing::model_of(HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf");
  const auto bounds = testing::bounds_of(model);
  const auto tip = model.find_frame("tool").value();
  FloatingModel floating{model, tip};
  ToolWay way{model, tip};
  MomentumObserver observer{7, period_s, 50};
  FloatingLaws laws;
  laws.begin(7, period_s);
  laws.set({.joint_n_m_rad = 10 * JointVector::Ones(7), .tool_n_m = 100, .tool_n_m_rad = 10});
  ToolLever lever;
  TorqueDrive drive;
  drive.begin(7);
  const JointVector zeros = JointVector::Zero(7);
  Measured measured{vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0}), zeros, zeros};
  const robotics::Matrix3 upright = robotics::Matrix3::Identity();
  const RealtimeScope scope;
  for (const ToolLaw law : {ToolLaw::FixedBase, ToolLaw::InertialTrack, ToolLaw::AttitudeHold}) {
    floating.carry({upright, {0, 0, 0.1}}, {20, {0, 0, 0.1}});
    EXPECT_TRUE(floating.update({}, measured.position));
    const ToolGoal goal{floating.tool(), {0.01, 0, 0}};
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(floating.update({}, measured.position));
      JointVector rates = tool_rates(law, floating, bounds, goal, upright, upright);
      slow_down(rates, bounds);
      const double per_s = followed_with(floating.heavier(), period_s);
      static_cast<void>(end_ahead(measured.position, rates, bounds, per_s));
      measured.velocity = rates;
      measured.torque = joint_torque(floating, rates, zeros, bounds, per_s);
      observer.update(measured, floating.inertia(), floating.bias(measured.velocity), zeros);
      if (i == 10) observer.reset(), laws.jump();
      lever.update(ToolLever::Rows{floating.tool_of_free().bottomRows<3>()});
      FloatingLaws::Now now;
      now.kind = static_cast<LawKind>(i % 5);
      now.rates = rates;
      now.goal = {{measured.position, rates, zeros}, goal};
      now.driven = drive.step(measured, {zeros, floating.inertia().diagonal()}, bounds, 0.8, period_s);
      now.axes = law;
      now.lever = &lever;
      now.work = {.force_n = 10, .power_w = 10, .tool_power_w = 1};
      EXPECT_TRUE(laws.torque(floating, measured, bounds, now).allFinite());
      EXPECT_GT(laws.swings_rad_s(LawKind::ToolImpedance, law, laws.impedance(), floating), 0);
      measured.position += period_s * rates;
    }
    way.carry({upright, {0, 0, 0.1}}, {20, {0, 0, 0.1}});
    way.begin({.law = law,
               .position = measured.position,
               .tool = floating.tool(),
               .offset_m = {0.01, 0, 0},
               .duration_s = 2});
    while (way.step(bounds)) {}
  }
  EXPECT_EQ(scope.count(), AllocationCount{});
}

}  // namespace
}  // namespace hirosco::robot_arm
