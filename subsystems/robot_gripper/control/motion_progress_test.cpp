// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "subsystems/robot_gripper/control/motion_progress.hpp"

namespace hirosco::robot_gripper {
namespace {

using End = MotionProgress::End;
constexpr double of_cycle_s = 0.001;

/// From 100 mm to 30 mm, in a second.
struct GripperPath : ::testing::Test {
  Opening opening{0.5, 10, of_cycle_s};
  MotionProgress progress;
  int steps{0}, cycles{0};
  void SetUp() override {
    opening.rest(0.1);
    ASSERT_TRUE(opening.go(0.03, 0.1));
    progress.begin_path(0.03, of_cycle_s);
  }
  /// `width_m()`: what is measured.
  End end_where(const auto& width_m) {
    for (; cycles < 10'000; ++cycles) {
      opening.advance();
      const MotionProgress::News news = progress.follow(opening, width_m(), {});
      steps += news.step ? 1 : 0;
      if (news.end != End::None) return news.end;
    }
    return End::None;
  }
};

TEST_F(GripperPath, IsReachedWhenItsGoalIsMeasuredAndHalfWayIsToldOnce) {
  EXPECT_EQ(end_where([this] { return opening.now().width_m; }), End::Reached);
  EXPECT_EQ(steps, 1);
}

TEST_F(GripperPath, IsObstructedWhereItStaysBehind) {
  EXPECT_EQ(end_where([] { return 0.1; }), End::Obstructed);
  EXPECT_EQ(steps, 0);
}

TEST_F(GripperPath, WhoIsAheadIsNotObstructedAndAMillimetreOffIsNotThere) {
  EXPECT_EQ(end_where([] { return 0.029; }), End::NotReached);
  EXPECT_EQ(steps, 1);
  EXPECT_GT(cycles, 3000) << "it is waited for";
}

/// Presses with 20 N, measured at rest.
struct GripperPressing : ::testing::Test {
  Fingers fingers{std::array{Finger{.closed = 0, .open = 0.05, .effort = 80, .velocity = 0.1, .moved = 2}}, 0.1};
  Grip grip{fingers, {.cycle_s = of_cycle_s}};
  MotionProgress progress;
  GripperPressing() { grip.press_on(20, 0.05); }
  void press(int cycles) {
    for (int i = 0; i < cycles; ++i) static_cast<void>(grip.torques({}, {{0.03}, {0}, {-40}}));
  }
};

TEST_F(GripperPressing, HoldsSomethingWhenItHasPressedAtRestForATenthOfASecond) {
  press(98);
  EXPECT_EQ(MotionProgress::met(grip, 0.06, 0.001), End::None);
  press(4);
  EXPECT_EQ(MotionProgress::met(grip, 0.06, 0.001), End::Held);
  EXPECT_EQ(MotionProgress::met(grip, 0.0005, 0.001), End::NothingMet);
  grip.keep();
  EXPECT_EQ(MotionProgress::met(grip, 0.06, 0.001), End::None) << "it does not press";
}

TEST_F(GripperPressing, IsGivenUpAfterAWhileThatBeginsWhenSomethingIsMet) {
  progress.begin_grip(of_cycle_s);
  grip.keep();
  for (int i = 0; i < 5000; ++i) {
    const MotionProgress::News news = progress.follow(grip, End::None);
    ASSERT_FALSE(news.step);
    ASSERT_EQ(news.end, End::None);
  }
  grip.press_on(20, 0.05);
  EXPECT_TRUE(progress.follow(grip, End::None).step);
  for (int i = 0; i < 2900; ++i) {
    const MotionProgress::News news = progress.follow(grip, End::None);
    ASSERT_FALSE(news.step) << "told once";
    ASSERT_EQ(news.end, End::None);
  }
  for (int i = 0; i < 100; ++i) static_cast<void>(progress.follow(grip, End::None));
  EXPECT_EQ(progress.follow(grip, End::None).end, End::ForceNotReached);
}

TEST_F(GripperPressing, EndsWithWhatIsMet) {
  progress.begin_grip(of_cycle_s);
  const MotionProgress::News news = progress.follow(grip, End::Held);
  EXPECT_TRUE(news.step) << "that something was met is told before";
  EXPECT_EQ(news.end, End::Held);
}

}  // namespace
}  // namespace hirosco::robot_gripper
