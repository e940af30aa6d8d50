// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "subsystems/manipulator/script.hpp"

namespace hirosco::manipulator {
namespace {

constexpr double period_s = 0.0005;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(JointController, HoldsALoadWithTheTwistOfItsStiffness) {
  // At rest u = tau_j: motor torque equals joint torque when kp (qd - theta) does.
  JointController controller{period_s};
  controller.reset({0.1, 0});
  Measured measured;
  measured.torque_n_m = {6, 0};
  measured.motor_position_rad = {0.1 - 6.0 / 300, 0};
  const Joints torque = controller.motor_torque({0.1, 0}, measured, {});
  EXPECT_NEAR(torque[0], 6, 1e-9);
  EXPECT_NEAR(torque[1], 0, 1e-12);
}

TEST(JointController, FiltersTheSetpointsRateAndStartsWithoutAKick) {
  JointController controller{period_s};
  controller.reset({1, 1});
  const Measured measured{.motor_position_rad = {1, 1},
                          .motor_velocity_rad_s = {},
                          .position_rad = {},
                          .velocity_rad_s = {},
                          .torque_n_m = {},
                          .temperature_c = {}};
  EXPECT_EQ(controller.motor_torque({1, 1}, measured, {}), (Joints{0, 0}));
  (void)controller.motor_torque({1 + 0.001 * period_s, 1}, measured, {});
  EXPECT_NEAR(controller.desired_velocity_rad_s()[0], 0.2 * 0.001, 1e-12);
  (void)controller.motor_torque({1 + 0.002 * period_s, 1}, measured, {});
  EXPECT_NEAR(controller.desired_velocity_rad_s()[0], 0.36 * 0.001, 1e-12);
}

TEST(JointController, StaysWithinTheMotorAndMakesNothingOfADamagedSample) {
  JointController controller{period_s};
  Measured measured;
  EXPECT_EQ(controller.motor_torque({10, -10}, measured, {}), (Joints{60, -60}));
  measured.torque_n_m = {nan, 0};
  EXPECT_EQ(controller.motor_torque({10, -10}, measured, {})[0], 0);
}

TEST(Trajectory, GoesFromRestToRestThroughTheMiddleAtItsPeakSpeed) {
  Trajectory motion;
  motion.start({0, 1}, {0.4, 0.2}, 2);
  EXPECT_FALSE(motion.done());
  (void)motion.advance(0.999);
  const double before = motion.position_rad()[1];
  (void)motion.advance(0.001);
  EXPECT_NEAR(motion.position_rad()[0], 0.2, 1e-12);
  EXPECT_NEAR(motion.progress(), 0.5, 1e-12);
  EXPECT_NEAR((before - motion.position_rad()[1]) / 0.001, Trajectory::peak_speed({0, 1}, {0.4, 0.2}, 2), 1e-5);
  EXPECT_EQ(motion.advance(5), (Joints{0.4, 0.2}));
  EXPECT_TRUE(motion.done());
}

TEST(Trajectory, ArrivesAtOnceWithoutTimeAndStaysWhereItIsStopped) {
  Trajectory motion;
  motion.start({0, 0}, {1, 1}, 0);
  EXPECT_TRUE(motion.done());
  EXPECT_EQ(motion.position_rad(), (Joints{1, 1}));
  motion.start({0, 0}, {1, 1}, 1);
  const Joints at = motion.advance(0.4);
  motion.stop();
  EXPECT_EQ(motion.advance(1), at);
}

TEST(Clutch, CouplesWithoutAJumpAndScalesAfterwards) {
  Clutch clutch;
  clutch.engage({-0.8, 1.6}, {0.05, -0.03});
  EXPECT_EQ(clutch.desired({0.05, -0.03}, 0.5), (Joints{-0.8, 1.6}));
  EXPECT_NEAR(clutch.desired({0.15, -0.03}, 0.5)[0], -0.75, 1e-12);
}

TEST(TorqueLimit, TripsOnTwoOfThreeSamplesOfOneJoint) {
  TorqueLimit limit;
  const auto feed = [&limit](double one, double two) { return limit.update({one, two}, 12, 15).verdict; };
  EXPECT_EQ(feed(13, 0), TorqueVerdict::Fine);
  EXPECT_EQ(feed(0, -13), TorqueVerdict::Fine) << "another joint does not make the second";
  EXPECT_EQ(feed(13, 0), TorqueVerdict::Soft);
  limit.reset();
  EXPECT_EQ(feed(13, 0), TorqueVerdict::Fine);
  EXPECT_EQ(feed(0, 0), TorqueVerdict::Fine);
  EXPECT_EQ(feed(0, 0), TorqueVerdict::Fine);
  EXPECT_EQ(feed(13, 0), TorqueVerdict::Fine) << "the first one is four samples old";
}

TEST(TorqueLimit, NamesTheJointAndTheWorseLimitAndTrustsNoNan) {
  TorqueLimit limit;
  (void)limit.update({13, -16}, 12, 15);
  const auto finding = limit.update({13, -16}, 12, 15);
  EXPECT_EQ(finding.verdict, TorqueVerdict::Hard);
  EXPECT_EQ(finding.joint, 1);
  EXPECT_EQ(finding.value_n_m, -16);
  limit.reset();
  (void)limit.update({nan, 0}, 12, 15);
  EXPECT_EQ(limit.update({nan, 0}, 12, 15).verdict, TorqueVerdict::Hard);
  limit.reset();
  (void)limit.update({12, -12}, 12, 15);
  EXPECT_EQ(limit.update({12, -12}, 12, 15).verdict, TorqueVerdict::Fine) << "at the limit is within it";
}

TEST(Relieving, LetsTheMotorUnloadButNotLoadAJointAtItsLimit) {
  EXPECT_EQ(relieving({20, -20}, {13, -13}, 12), (Joints{12, -12}));
  EXPECT_EQ(relieving({-20, 20}, {13, -13}, 12), (Joints{-20, 20}));
  EXPECT_EQ(relieving({20, -20}, {11, -11}, 12), (Joints{20, -20}));
}

TEST(Temperature, IsJudgedByTheHotterJoint) {
  const TemperatureLimits limits;
  EXPECT_EQ(judge({54.9F, 20}, limits), TemperatureVerdict::Fine);
  EXPECT_EQ(judge({20, 55}, limits), TemperatureVerdict::Warning);
  EXPECT_EQ(judge({70, 55}, limits), TemperatureVerdict::Critical);
  EXPECT_EQ(judge({80, 20}, limits), TemperatureVerdict::Maximum);
  EXPECT_EQ(judge({20, std::numeric_limits<float>::quiet_NaN()}, limits), TemperatureVerdict::Maximum);
}

TEST(TipForce, IsTheForceWhoseMomentsAreTheJointTorques) {
  const Joints q{-0.8, 1.6};
  const Geometry geometry;
  const Joints at = tip(geometry, q);
  // Moments of a force f at the tip about both joints: (x fy - y fx).
  const Joints f{40, -7};
  const double x2 = at[0] - 0.25 * std::cos(q[0]);
  const double y2 = at[1] - 0.25 * std::sin(q[0]);
  const Joints torque{at[0] * f[1] - at[1] * f[0], x2 * f[1] - y2 * f[0]};
  const Joints found = tip_force(geometry, q, torque);
  EXPECT_NEAR(found[0], 40, 1e-9);
  EXPECT_NEAR(found[1], -7, 1e-9);
}

TEST(TipForce, IsNotToldWhereTheArmIsStretched) { EXPECT_EQ(tip_force({}, {0.3, 0.0}, {1, 1}), (Joints{0, 0})); }

TEST(JointsFor, UndoTheTipAndReachAsFarAsTheyCan) {
  for (const Joints& q : {Joints{-0.8, 1.6}, Joints{0.3, 0.4}, Joints{-1.5, 2.5}}) {
    const Joints back = joints_for({}, tip({}, q));
    EXPECT_NEAR(back[0], q[0], 1e-12);
    EXPECT_NEAR(back[1], q[1], 1e-12);
  }
  const Joints stretched = joints_for({}, {3, 4});
  EXPECT_NEAR(stretched[0], std::atan2(4, 3), 1e-12);
  EXPECT_EQ(stretched[1], 0);
}

TEST(PressedFinger, LiesInTheContourByItsDepthAlongTheTrueNormal) {
  const Surroundings around;
  EXPECT_NEAR(pressed_finger(around, 0, 0.006)[0], 0.350 - 0.010 + 0.006, 1e-12);
  EXPECT_NEAR(pressed_finger(around, 0.05, 0)[0], 0.350 - 0.010 - 0.010, 1e-12) << "on top of the bump";
  // On its flank: the centre is a finger's radius from the surface point, at a right angle to the surface.
  constexpr double y = 0.03, step = 1e-6;
  const Joints surface = pressed_finger(around, y, around.finger_radius_m);
  const Joints ahead = pressed_finger(around, y + step, around.finger_radius_m);
  const Joints centre = pressed_finger(around, y, 0);
  EXPECT_NEAR(std::hypot(centre[0] - surface[0], centre[1] - surface[1]), 0.010, 1e-12);
  const double along = (centre[0] - surface[0]) * (ahead[0] - surface[0]) + (centre[1] - surface[1]) * step;
  EXPECT_NEAR(along / (0.010 * step), 0, 1e-4);
}

TEST(Script, NeverJumpsAndMovesAlongTheContourAtItsSpeed) {
  Script script;
  const Joints home = tip({}, {-0.8, 1.6});
  script.start(Script::Id::Contour, home, home, {});
  Joints last = home;
  double fastest_along_m_s = 0;
  while (!script.done()) {
    const bool along = script.leg() == 2;
    const Joints at = script.advance(period_s);
    EXPECT_LT(std::hypot(at[0] - last[0], at[1] - last[1]) / period_s, 0.15);
    if (along) fastest_along_m_s = std::max(fastest_along_m_s, (at[1] - last[1]) / period_s);
    last = at;
  }
  EXPECT_NEAR(std::hypot(last[0] - home[0], last[1] - home[1]), 0, 1e-12) << "it ends at home";
  EXPECT_NEAR(fastest_along_m_s, 0.020, 0.020 * 0.25) << "along the rail; the finger's centre gains on the flanks";
}

TEST(Script, WaitsForItsDeeds) {
  Script script;
  const Joints slack_end = springs[0].slack_end_m;
  script.start(Script::Id::Spring, slack_end, slack_end, {});
  for (int k = 0; k < 100'000; ++k) (void)script.advance(period_s);
  EXPECT_EQ(script.leg(), 0U);
  EXPECT_EQ(script.deed(), Script::Deed::Hook);
  EXPECT_NEAR(distance_to_spring(1, script.advance(period_s)), 0, 1e-12);
  script.deed_done();
  for (int k = 0; k < 100'000; ++k) (void)script.advance(period_s);
  EXPECT_EQ(script.deed(), Script::Deed::Release);
  script.deed_done();
  for (int k = 0; k < 100'000; ++k) (void)script.advance(period_s);
  EXPECT_TRUE(script.done());
}

}  // namespace
}  // namespace hirosco::manipulator
