// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "subsystems/robot_gripper/control/grip.hpp"
#include "subsystems/robot_gripper/testing/plant.hpp"

/// One drive for both sides, and two drives: the laws are the same.
namespace hirosco::robot_gripper {
namespace {

constexpr double cycle_s = 0.001;
Finger driven() { return {.closed = 0, .open = 0.05, .effort = 80, .velocity = 0.1, .moved = 2.3, .friction = 2}; }

struct Gripped : ::testing::TestWithParam<std::size_t> {
  Fingers fingers{std::vector<Finger>(GetParam(), driven()), 0.1};
  testing::Plant plant{fingers};
  Opening opening{0.5, 10, cycle_s};
  Grip grip{fingers, {}};
  double fastest_m_s{0}, hardest_n{0};

  void SetUp() override { opening.rest(plant.width_m()); }
  void run(double seconds) {
    for (double t = 0; t < seconds - cycle_s / 2; t += cycle_s) {
      opening.advance();
      plant.step(grip.torques(opening.now(), plant.measured()), cycle_s);
      fastest_m_s = std::max(fastest_m_s, std::abs(plant.closing_m_s()));
      hardest_n = std::max(hardest_n, plant.pressed_n);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Drives, Gripped, ::testing::Values(1, 2));

TEST_P(Gripped, GoesToAWidthWithinATenthOfAMillimetreThoughFrictionIsTwiceThatOfItsFile) {
  plant.friction_factor = 2;
  for (const double width_m : {0.02, 0.09}) {
    ASSERT_TRUE(opening.go(width_m, 0.1));
    run(opening.duration_s() + 1.5);
    EXPECT_NEAR(plant.width_m(), width_m, 1e-4);
  }
  EXPECT_LT(fastest_m_s, 0.11);
}

TEST_P(Gripped, ClosesUntilItMeetsSomethingAndPressesWithinFivePercent) {
  for (const double friction : {0.0, 1.0, 1.5})
    for (const double force_n : {10.0, 20.0}) {
      plant.open(1);
      plant.friction_factor = friction;
      plant.object_m = 0.06;
      grip.keep();
      grip.grip(force_n, 0.05);
      EXPECT_EQ(grip.law(), Law::Reach);
      run(2.5);
      EXPECT_EQ(grip.law(), Law::Press);
      EXPECT_GT(grip.settled_s(), 0.1) << friction << " " << force_n;
      EXPECT_NEAR(plant.pressed_n, force_n, 0.05 * force_n) << friction;
    }
  EXPECT_LT(fastest_m_s, 0.06);
  EXPECT_LT(hardest_n, 1.2 * 20);
}

TEST_P(Gripped, PressesOtherwiseWithoutLettingGo) {
  plant.object_m = 0.06;
  grip.grip(20, 0.05);
  run(2);
  grip.grip(6, 0.05);
  EXPECT_EQ(grip.law(), Law::Press);
  double least_n = 1e9;
  for (int i = 0; i < 1000; ++i) {
    run(cycle_s);
    least_n = std::min(least_n, plant.pressed_n);
  }
  EXPECT_GT(least_n, 5);
  EXPECT_NEAR(plant.pressed_n, 6, 0.3);
}

TEST_P(Gripped, FollowsWhatIsTakenAwayNoFasterThanItReached) {
  plant.object_m = 0.06;
  grip.grip(20, 0.05);
  run(2);
  fastest_m_s = 0;
  plant.object_m.reset();
  run(0.5);
  EXPECT_EQ(grip.law(), Law::Reach);
  EXPECT_LT(fastest_m_s, 0.12) << "of 0.2 that it may";
  EXPECT_LT(plant.width_m(), 0.05);
}

TEST_P(Gripped, KeepsAWidthWithNoMoreThanItsForce) {
  plant.open(0.5);
  opening.rest(0.05);
  plant.pulled_open_n = 5;
  run(1);
  EXPECT_NEAR(plant.width_m(), 0.05, 1e-4);
  plant.pulled_open_n = 15;
  run(1);
  EXPECT_GT(plant.width_m(), 0.06) << "10 N do not hold it";
}

TEST_P(Gripped, GoesOnPressingAtOnceWhereItWasInterrupted) {
  plant.object_m = 0.06;
  grip.grip(20, 0.05);
  run(2);
  grip.press_on(20, 0.05);
  double least_n = 1e9;
  for (int i = 0; i < 300; ++i) {
    run(cycle_s);
    least_n = std::min(least_n, plant.pressed_n);
  }
  EXPECT_GT(least_n, 17);
}

TEST_P(Gripped, LetsGoBitByBitOfWhatItPressesOn) {
  std::array<double, 2> fastest{};
  for (const bool at_once : {true, false}) {
    plant.open(1);
    plant.object_m = 0.06;
    grip.keep();
    grip.grip(20, 0.05);
    run(2);
    ASSERT_NEAR(plant.pressed_n, 20, 1);
    opening.rest(plant.width_m());
    if (at_once) grip.keep();
    else grip.let_go();
    fastest_m_s = 0;
    run(0.05);
    fastest[at_once ? 0 : 1] = fastest_m_s;
    if (!at_once) {
      EXPECT_GT(plant.pressed_n, 5) << "after half of the time in which it lets go";
    }
  }
  EXPECT_LT(fastest[1], 0.5 * fastest[0]) << "a spring that is let go at once throws it open";
}

TEST(Held, IsLostWhenItClosesOrOpensFurtherForTwoOfThreeSamples) {
  using Change = Held::Change;
  Held held;
  EXPECT_EQ(held.update(0.01, 0.002), Change::None) << "nothing is held";
  held.hold(0.06);
  EXPECT_EQ(held.update(0.05, 0.002), Change::None) << "one disturbed sample";
  EXPECT_EQ(held.update(0.0605, 0.002), Change::None);
  EXPECT_EQ(held.update(0.0605, 0.002), Change::None);
  EXPECT_TRUE(held.held());
  EXPECT_EQ(held.update(0.057, 0.002), Change::None);
  EXPECT_EQ(held.update(0.057, 0.002), Change::LostClosed);
  EXPECT_EQ(held.update(0.057, 0.002), Change::None) << "told once";
  held.hold(0.06);
  EXPECT_EQ(held.update(0.063, 0.002), Change::None);
  EXPECT_EQ(held.update(0.063, 0.002), Change::LostOpened);
  held.hold(0.06);
  EXPECT_EQ(held.update(NAN, 0.002), Change::None);
  EXPECT_EQ(held.update(NAN, 0.002), Change::LostClosed);
}

}  // namespace
}  // namespace hirosco::robot_gripper
