// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/robot/world/two_joint_arm.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace hirosco::simulation {
namespace {

constexpr Duration period = std::chrono::microseconds{500};

ArmParameters without_losses() {
  ArmParameters arm = ArmParameters{}.without_friction();
  arm.joint.damping_n_m_s_per_rad = 0;
  arm.contour.damping_s_per_m = 0;
  return arm;
}

ContourParameters flat_rail() {
  ContourParameters contour;
  contour.bump_height_m = 0;
  return contour;
}

TEST(TwoJointArm, StandsAtItsHomeAsTheDrawingSays) {
  const TwoJointArm arm;
  EXPECT_NEAR(arm.tip_m()[0], 0.32745, 5e-6);
  EXPECT_NEAR(arm.tip_m()[1], -0.02152, 5e-6);
  EXPECT_NEAR(-arm.contact().penetration_m, 0.01255, 5e-6);
  const Mat2 jacobian = arm.jacobian();
  EXPECT_NEAR(jacobian[0][0], 0.0215, 5e-5);
  EXPECT_NEAR(jacobian[0][1], -0.1578, 5e-5);
  EXPECT_NEAR(jacobian[1][0], 0.3275, 5e-5);
  EXPECT_NEAR(jacobian[1][1], 0.1533, 5e-5);
}

TEST(TwoJointArm, VibratesFreelyInTheTwoModesOfTheClosedForm) {
  // Twist e = theta - q of a free arm: e'' = -K (1/B + M^-1) e, with M of the home pose written out here once more.
  const double coupling = 1.6 * 0.25 * 0.10 * std::cos(1.6);
  const double m22 = 0.008 + 1.6 * 0.10 * 0.10;
  const double m12 = m22 + coupling;
  const double m11 = 0.020 + 3.0 * 0.17 * 0.17 + 1.6 * 0.25 * 0.25 + m22 + 2 * coupling;
  const double det = m11 * m22 - m12 * m12;
  const double a = 1 / 1.28 + m22 / det, b = -m12 / det, d = 1 / 1.28 + m11 / det;
  for (const double sign : {-1.0, 1.0}) {
    const double eigenvalue = (a + d) / 2 + sign * std::hypot((a - d) / 2, b);
    const double omega = std::sqrt(4000 * eigenvalue);
    TwoJointArm arm{without_losses()};
    ArmState state = arm.state();
    const Vec2 mode{b, eigenvalue - a};
    for (std::size_t i = 0; i < 2; ++i) state.motor_rad[i] += 1e-6 * mode[i] / std::hypot(mode[0], mode[1]);
    arm.set_state(state);
    // The torque of the stronger joint is a cosine: its n-th zero is at (n - 1/2) pi / omega.
    const std::size_t joint = std::abs(mode[0]) > std::abs(mode[1]) ? 0 : 1;
    double before = arm.joint_torque_n_m()[joint];
    double zero_s = 0;
    int zeros = 0;
    for (int k = 1; zeros < 100; ++k) {
      arm.step({}, std::chrono::microseconds{100});
      const double now = arm.joint_torque_n_m()[joint];
      if (now * before < 0) {
        ++zeros;
        zero_s = 1e-4 * (k - now / (now - before));
      }
      before = now;
      ASSERT_LT(k, 1'000'000);
    }
    EXPECT_NEAR(zero_s, 99.5 * std::numbers::pi / omega, 1e-4 * zero_s) << "mode at " << omega << " rad/s";
  }
}

TEST(TwoJointArm, KeepsItsEnergyWhenNothingDissipatesIncludingBouncesOffTheRail) {
  TwoJointArm arm{without_losses()};
  ArmState state = arm.state();
  state.motor_rad_s = state.link_rad_s = {0.1, -0.6};
  arm.set_state(state);
  const double start = arm.energy_j();
  bool touched = false;
  double worst = 0;
  for (int k = 0; k < 20'000; ++k) {
    arm.step({}, period);
    touched = touched || arm.contact().normal_force_n > 0;
    worst = std::max(worst, std::abs(arm.energy_j() - start) / start);
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(worst, 1e-4);
}

TEST(TwoJointArm, LosesEnergyOnlyWithFrictionAndNeverGains) {
  TwoJointArm arm;
  ArmState state = arm.state();
  state.motor_rad_s = state.link_rad_s = {0.1, -0.6};
  arm.set_state(state);
  double before = arm.energy_j();
  for (int k = 0; k < 4'000; ++k) {
    arm.step({}, period);
    ASSERT_LE(arm.energy_j(), before * (1 + 1e-9) + 1e-15) << k;
    before = arm.energy_j();
  }
}

TEST(TwoJointArm, LimitsTheMotorTorque) {
  TwoJointArm strong, limited;
  strong.step({1000, -1000}, period);
  limited.step({60, -60}, period);
  EXPECT_EQ(strong.state().motor_rad_s, limited.state().motor_rad_s);
}

TEST(TwoJointArm, GivesTheSameBitsFromTheSameInputs) {
  TwoJointArm one, two;
  for (int k = 0; k < 2'000; ++k) {
    const Vec2 torque{std::sin(k * 0.01), -3.0};
    one.step(torque, period);
    two.step(torque, period);
  }
  EXPECT_EQ(one.state().link_rad, two.state().link_rad);
  EXPECT_EQ(one.state().motor_rad_s, two.state().motor_rad_s);
  EXPECT_GT(one.contact().penetration_m, -0.0125) << "the arm has moved";
}

TEST(TwoJointArm, WarmsUpAsTheClosedFormSays) {
  // T = 20 + 63.48 (1 - exp(-t / 240)) under 11.5 N m; twenty times faster here.
  ArmParameters parameters;
  parameters.thermal.acceleration = 20;
  TwoJointArm arm{parameters};
  auto run_to = [&, now = 0.0](double time_s) mutable {
    for (; now < time_s; now += 0.01) arm.step({11.5, 0}, std::chrono::milliseconds{10});
    return arm.temperature_c()[0];
  };
  EXPECT_NEAR(run_to(192.4 / 20), 55, 0.1);
  EXPECT_NEAR(run_to(371.9 / 20), 70, 0.1);
  EXPECT_NEAR(arm.temperature_c()[1], 20, 1e-9);
}

TEST(TwoJointArm, HooksASpringOnlyWithinReach) {
  TwoJointArm arm;
  EXPECT_FALSE(arm.hook_spring(0)) << "the vertical spring is 21 mm away from home";
  EXPECT_FALSE(arm.hook_spring(2));
  EXPECT_TRUE(arm.hook_spring(1));
  EXPECT_EQ(arm.hooked_spring(), 1U);
  EXPECT_EQ(arm.spring_force_n(), (Vec2{})) << "slack at home";
}

TEST(TwoJointArm, IsPulledByAStretchedSpringAlongIt) {
  TwoJointArm arm;
  ASSERT_TRUE(arm.hook_spring(1));
  ArmState state = arm.state();
  state.link_rad = {-0.70, 1.50};
  arm.set_state(state);
  const Vec2 along = arm.tip_m() - Vec2{0.280, -0.0215};
  const double length = std::hypot(along[0], along[1]);
  ASSERT_GT(length, 0.05);
  const Vec2 force = arm.spring_force_n();
  EXPECT_NEAR(std::hypot(force[0], force[1]), 400 * (length - 0.05), 1e-9);
  EXPECT_NEAR(force[0] * along[1] - force[1] * along[0], 0, 1e-12);
  EXPECT_LT(dot(force, along), 0);
  arm.release_spring();
  EXPECT_EQ(arm.spring_force_n(), (Vec2{}));
}

/// Pressed by constant motor torques for a second, with a pull along the rail of a tenth of what friction holds; the way
/// along the rail in the second half of it.
double creep_m(double press_n, Duration largest_sub_step) {
  ArmParameters parameters;
  parameters.largest_sub_step = largest_sub_step;
  TwoJointArm arm{parameters};
  const Vec2 torque = transposed_times(arm.jacobian(), {press_n, 0.015 * press_n});
  constexpr Duration half_ms = std::chrono::microseconds{500};
  for (int k = 0; k < 1000; ++k) arm.step(torque, half_ms);
  const double before = arm.tip_m()[1];
  for (int k = 0; k < 1000; ++k) arm.step(torque, half_ms);
  return arm.tip_m()[1] - before;
}

TEST(TwoJointArm, AFingerThatSticksDoesNotCreepForTheStepSizesSakeHoweverHardItPresses) {
  for (const double press_n : {40.0, 150.0, 250.0, 370.0}) {
    const double as_flown = creep_m(press_n, ArmParameters{}.largest_sub_step);
    const double converged = creep_m(press_n, std::chrono::microseconds{2});
    EXPECT_NEAR(as_flown, converged, 2e-6) << press_n << " N, m in half a second";
  }
}

TEST(Contact, PushesWithStiffnessTimesDepthAndMoreWhenClosing) {
  const Contact rest = contact_at(flat_rail(), {0.341, -0.02}, {});
  EXPECT_NEAR(rest.penetration_m, 0.001, 1e-15);
  EXPECT_NEAR(rest.normal_force_n, 50, 1e-9);
  EXPECT_NEAR(rest.force_n[0], -50, 1e-9);
  EXPECT_NEAR(contact_at(flat_rail(), {0.341, -0.02}, {0.1, 0}).normal_force_n, 50 * 1.2, 1e-9);
}

TEST(Contact, NeverPulls) {
  EXPECT_EQ(contact_at(flat_rail(), {0.341, -0.02}, {-1, 0}).normal_force_n, 0);
  const Contact gap = contact_at(flat_rail(), {0.339, -0.02}, {1, 0});
  EXPECT_EQ(gap.force_n, (Vec2{}));
  EXPECT_NEAR(gap.penetration_m, -0.001, 1e-15);
}

TEST(Contact, RubsAgainstTheMotion) {
  const Contact contact = contact_at(flat_rail(), {0.341, -0.02}, {0, 0.02});
  EXPECT_NEAR(contact.force_n[1], -0.15 * 50, 1e-6);
}

TEST(Contact, ActsAlongTheTrueNormalOfTheBump) {
  ContourParameters contour;
  contour.friction = 0;
  for (double y = 0.012; y < 0.09; y += 0.006) {
    // A finger placed 0.4 mm deep along the normal of the surface at y, computed here from the cosine itself.
    const double wave = std::numbers::pi / 0.04;
    const double x = 0.350 - 0.005 * (1 + std::cos(wave * (y - 0.05)));
    const double slope = 0.005 * wave * std::sin(wave * (y - 0.05));
    const double scale = 1 / std::hypot(1.0, slope);
    const double away = 0.010 - 0.0004;
    const Contact contact = contact_at(contour, {x - away * scale, y + away * slope * scale}, {});
    EXPECT_NEAR(contact.penetration_m, 0.0004, 1e-9) << y;
    EXPECT_NEAR(contact.force_n[0], -20 * scale, 1e-4) << y;
    EXPECT_NEAR(contact.force_n[1], 20 * slope * scale, 1e-4) << y;
  }
}

}  // namespace
}  // namespace hirosco::simulation
