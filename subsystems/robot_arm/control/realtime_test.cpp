// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hirosco/utilities/allocation_guard.hpp"
#include "robotics/shapes/clearance.hpp"
#include "subsystems/robot_arm/control/abort_way.hpp"
#include "subsystems/robot_arm/control/following.hpp"
#include "subsystems/robot_arm/control/home_search.hpp"
#include "subsystems/robot_arm/control/homing_law.hpp"
#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/control/pose_search.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/control/straight_way.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/control/work_watch.hpp"
#include "subsystems/robot_arm/testing/plant.hpp"

namespace hirosco::robot_arm {
namespace {

constexpr double period_s = 0.001;

/// All that a cycle of the arm calls, in every way to move.
TEST(Control, UsesNoHeapInACycle) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  const robotics::Model model = testing::model_of(testing::six_axes);
  const auto bounds = testing::bounds_of(model);
  const auto tip = model.find_frame("tool").value();
  robotics::Dynamics dynamics{model, robotics::Base::Fixed};
  Laws laws{model, tip, period_s};
  const Impedance impedance{JointVector::Constant(6, 100), 500, 20, 0.7};
  MomentumObserver observer{6, period_s, 50};
  Setpoints setpoints{model, tip, bounds, period_s};
  const auto text = descriptor::file_system()(testing::six_axes).value();
  robotics::Clearance clearance{
      model, robotics::read_collision_shapes(testing::six_axes, text, descriptor::file_system()).value.value().hulls};
  clearance.set_limit(0.02);
  PoseSearch search{model, tip, bounds};
  Following following{bounds, period_s};
  Watch watch;
  WorkWatch work_watch;
  ToolLever lever;
  TorqueDrive drive;
  drive.begin(6);
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  const JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  const JointVector zeros = JointVector::Zero(6);
  const Payload payload{2, {0.1, 0, 0}};
  const PreferredPosture preferred{start, 1};
  using Kind = Setpoints::Kind;
  for (const Kind kind : {Kind::JointPath, Kind::Line, Kind::JointJog, Kind::TipJog, Kind::Retract, Kind::Follow}) {
    if (kind != Kind::Retract) setpoints.begin(start);
    const RealtimeScope scope;
    robotics::Pose pose = setpoints.tool();
    pose.position.z() += 0.1;
    search.begin(setpoints.tip_with(pose), setpoints.now().position);
    while (search.step() == PoseSearch::Found::NotYet) {}
    EXPECT_FALSE(search.singular());
    search.begin(setpoints.tip_with(pose), setpoints.now().position, preferred);
    while (search.step() == PoseSearch::Found::NotYet) {}
    switch (kind) {
      case Kind::Rest: break;
      case Kind::JointPath: EXPECT_TRUE(setpoints.go(goal, 1)); break;
      case Kind::Line: EXPECT_TRUE(setpoints.go_straight(pose, {0.2, 0.5}, preferred)); break;
      case Kind::JointJog: setpoints.jog(goal); break;
      case Kind::TipJog: setpoints.jog(Vector6{Vector6::Constant(0.05)}); break;
      case Kind::Retract: setpoints.retract(setpoints.now().position, zeros, 0.1); break;
      case Kind::Follow: following.begin(setpoints.now().position); break;
    }
    for (int i = 0; i < 300; ++i) {
      if (kind == Kind::Follow && i < 200)
        setpoints.take(i < 100 ? following.go_to(goal, zeros) : following.go_with(goal));
      if (i == 200) setpoints.brake();
      const Setpoint& now = setpoints.advance();
      const Measured measured{now.position, now.velocity, zeros};
      robotics::State state;
      state.q = measured.position;
      state.qd = measured.velocity;
      dynamics.update(state);
      robotics::Coordinates of_payload = robotics::Coordinates::Zero(6);
      Law::add_payload(payload, tip, {0, 0, -9.81}, dynamics, zeros, of_payload);
      observer.update(measured, dynamics, of_payload);
      if (i % 50 == 0) {
        laws.set(static_cast<LawKind>(i / 50 % 5), impedance);
        EXPECT_FALSE(laws.compliance().too_stiff(laws.kind(), impedance, dynamics, {}, 1e3));
      }
      if (i % 70 == 0) laws.take_load(of_payload, {});
      lever.update(dynamics, tip, {0.1, 0, 0});
      drive.want(of_payload);
      laws.drive(drive.step(measured, {.held = of_payload, .moved = zeros}, bounds, 0.8, period_s));
      setpoints.keep_power(of_payload, 100);
      const Laws::Settings settings{
          .position = {}, .lever = &lever, .work = {.force_n = 20, .power_w = 50, .tool_power_w = 10}};
      EXPECT_TRUE(laws.torque(now, measured, dynamics, payload, bounds, settings).allFinite());
      static_cast<void>(work_watch.update({lever.force(zeros).norm(), 0, 0}, settings.work, true));
      EXPECT_GT(clearance.nearest(now.position).distance_m, 0);
      EXPECT_GT(clearance.nearer(now.position, setpoints.braked()).distance_m, 0);
      static_cast<void>(watch.update(measured, &now.position, bounds, {}));
    }
    EXPECT_EQ(scope.count(), AllocationCount{}) << static_cast<int>(kind);
  }
}

/// Of seven joints, of which a tool leaves one free.
TEST(Control, UsesNoHeapInACycleThatGoesToAPosture) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  const robotics::Model model =
      testing::model_of(HIROSCO_SOURCE_DIR "/subsystems/robot_arm/floating/floating_arm.urdf");
  const auto bounds = testing::bounds_of(model);
  const auto tip = model.find_frame("tool").value();
  PoseSearch search{model, tip, bounds};
  Setpoints setpoints{model, tip, bounds, period_s};
  const JointVector ready = vector_of(std::array{0.10, 0.75, -0.30, -1.25, -0.05, 1.85, 0.0});
  JointVector bent = ready;
  bent[2] += 0.3;
  const PreferredPosture preferred{bent, 1};
  ASSERT_TRUE(preferred.draws());
  setpoints.begin(ready);
  const RealtimeScope scope;
  robotics::Pose pose = setpoints.tool();
  pose.position.z() += 0.1;
  search.begin(setpoints.tip_with(pose), setpoints.now().position, preferred);
  while (search.step() == PoseSearch::Found::NotYet) {}
  EXPECT_FALSE(search.singular());
  EXPECT_TRUE(setpoints.go_straight(pose, {0.1, 0.5}, preferred));
  for (int i = 0; i < 300; ++i) setpoints.advance();
  EXPECT_EQ(setpoints.line().found(), Line::Found::Way);
  EXPECT_EQ(scope.count(), AllocationCount{});
}

/// One joint after the other finds its mark, each after half a radian.
TEST(Control, UsesNoHeapInACycleThatHomes) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  const robotics::Model model = testing::model_of(testing::six_axes);
  HomingLaw law{model, period_s};
  HomeSearch search{period_s};
  const std::array rotor{0.1, 0.1, 0.1, 0.1, 0.1, 0.1}, most{15.0, 15.0, 12.0, 5.0, 5.0, 5.0};
  const std::array<std::uint8_t, 6> order{5, 4, 3, 2, 1, 0};
  std::array<HomeSearch::Way, 6> ways;
  ways.fill({.speed = 0.2, .distance = 1});
  const JointVector zeros = JointVector::Zero(6);
  Measured measured{zeros, zeros, zeros};
  std::array<std::uint8_t, 6> referenced{};
  const RealtimeScope scope;
  search.begin({measured, referenced});
  search.look(order, ways);
  HomeSearch::News news;
  for (int i = 0; i < 30'000 && news.end == HomeSearch::End::None; ++i) {
    news = search.advance({measured, referenced, law.presses()});
    EXPECT_TRUE(law.torque(search.now(), measured, {.rotor = rotor, .most = most}).allFinite());
    measured.position = search.now().position;
    measured.velocity = search.now().velocity;
    if (const auto joint = search.looking(); joint && measured.position[static_cast<Eigen::Index>(*joint)] > 0.5)
      referenced[*joint] = 1;
  }
  EXPECT_EQ(news.end, HomeSearch::End::Done);
  EXPECT_EQ(scope.count(), AllocationCount{});
}

/// A way out, and a straight way of joints, are judged against the arm itself, and gone.
TEST(Control, UsesNoHeapInACycleThatJudgesAnAbortPath) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  const robotics::Model model = testing::model_of(testing::six_axes);
  const auto bounds = testing::bounds_of(model);
  Setpoints setpoints{model, model.find_frame("tool").value(), bounds, period_s};
  const auto text = descriptor::file_system()(testing::six_axes).value();
  robotics::Clearance clearance{
      model, robotics::read_collision_shapes(testing::six_axes, text, descriptor::file_system()).value.value().hulls};
  clearance.set_limit(0.02);
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector beside = start, last = start;
  beside[0] += 0.3;
  last[0] += 0.6;
  const std::array path{beside, last};
  AbortWay way;
  StraightWay straight;
  setpoints.begin(start);
  const RealtimeScope scope;
  way.begin(path, setpoints.now().position, AbortWay::Judged::FromHere, 5000);
  while (way.found() == AbortWay::Found::NotYet)
    way.heed(way.by_itself() ? clearance.too_near(way.then()) : clearance.nearer(way.before(), way.then()));
  EXPECT_EQ(way.found(), AbortWay::Found::Way);
  straight.begin(setpoints.now().position, last, period_s);
  while (straight.step()) EXPECT_EQ(clearance.nearer(straight.from(), straight.posture()).distance_m, HUGE_VAL);
  setpoints.pass(setpoints.now().position);
  double all_s = setpoints.duration_s(way.here(), way.posture(way.joined()), 1);
  for (std::size_t i = way.joined(); i < way.size(); ++i) {
    EXPECT_TRUE(setpoints.go(way.posture(i), 1));
    for (int cycle = 0; cycle < 3000 && !setpoints.at_rest(); ++cycle) setpoints.advance();
    if (i > way.joined()) all_s += setpoints.duration_s(way.posture(i - 1), way.posture(i), 1);
  }
  EXPECT_LT(apart(setpoints.now().position, last), 1e-6);
  EXPECT_GT(all_s, 0.3);
  EXPECT_EQ(scope.count(), AllocationCount{});
}

}  // namespace
}  // namespace hirosco::robot_arm
