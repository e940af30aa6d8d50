// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/control/following.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace hirosco::robot_arm {
namespace {

/// Two joints, of which one goes round without an end.
struct FollowingTest : ::testing::Test {
  double cycle_s{0.001};
  std::vector<JointBounds> bounds{{-1, 2, 10, {2.5, 4, 40}}, {-HUGE_VAL, HUGE_VAL, 10, {1, 4, 40}}};
  std::unique_ptr<Following> following;
  JointVector zeros = JointVector::Zero(2);

  void begin(const JointVector& place) {
    following = std::make_unique<Following>(bounds, cycle_s);
    following->begin(place);
    before_ = following->now();
  }
  /// Of the cycle that was.
  void keeps_limits() {
    const Setpoint& now = following->now();
    for (std::size_t joint = 0; joint < bounds.size(); ++joint) {
      const auto i = static_cast<Eigen::Index>(joint);
      const auto& most = bounds[joint].motion;
      ASSERT_GE(now.position[i], bounds[joint].lowest - 1e-9);
      ASSERT_LE(now.position[i], bounds[joint].highest + 1e-9);
      ASSERT_LE(std::abs(now.velocity[i]), most.velocity * (1 + 1e-9));
      ASSERT_LE(std::abs(now.acceleration[i]), most.acceleration * (1 + 1e-6));
      ASSERT_LE(std::abs(now.acceleration[i] - before_.acceleration[i]), most.jerk * cycle_s * (1 + 1e-6) + 1e-8);
      ASSERT_NEAR(now.velocity[i] - before_.velocity[i], now.acceleration[i] * cycle_s, 1e-9);
      ASSERT_NEAR(now.position[i] - before_.position[i], now.velocity[i] * cycle_s, 1e-9);
    }
    before_ = now;
  }

 private:
  Setpoint before_;
};

TEST_F(FollowingTest, KeepsRangesVelocitiesAccelerationsAndJerksHoweverItIsLed) {
  std::mt19937 random{7};
  const auto any = [&](double least, double most) {
    return std::uniform_real_distribution<double>{least, most}(random);
  };
  for (int flight = 0; flight < 60; ++flight) {
    cycle_s = std::array{0.0005, 0.001, 0.002, 0.01}[static_cast<std::size_t>(flight % 4)];
    for (JointBounds& its : bounds) its.motion = {any(0.2, 10), any(0.1, 20), std::pow(10, any(0, 3))};
    begin(vector_of(std::array{any(-1, 2), any(-5, 5)}));
    JointVector place = following->now().position, velocity = zeros;
    for (int cycle = 0; cycle < 3000; ++cycle) {
      if (any(0, 1) < 0.01) {
        place = vector_of(std::array{any(-1.5, 2.5), any(-9, 9)});
        velocity = vector_of(std::array{any(-11, 11), any(-11, 11)});
      }
      if (cycle > 2500) following->slow_down();
      else if (flight % 3 == 0) following->go_with(velocity);
      else following->go_to(place, flight % 3 == 1 ? zeros : velocity);
      ASSERT_NO_FATAL_FAILURE(keeps_limits()) << flight << " " << cycle;
    }
  }
}

TEST_F(FollowingTest, StandsInTheEndWhereWhoeverLeadsItStands) {
  begin(zeros);
  const JointVector there = vector_of(std::array{0.5, -0.3});
  double farthest = 0;
  for (int cycle = 0; cycle < 4000; ++cycle) {
    following->go_to(there, zeros);
    ASSERT_NO_FATAL_FAILURE(keeps_limits());
    farthest = std::max(farthest, following->now().position[0]);
  }
  EXPECT_LT((following->now().position - there).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(farthest, 0.5 + 1e-9) << "and goes no farther on the way";
}

/// Who keeps the arm's own limits is behind by half of the mean and no more, and so is one who tells it a hundred times a second.
TEST_F(FollowingTest, IsBehindByATenthOfASecondWithAJerkOfTenTimesTheAcceleration) {
  begin(zeros);
  ASSERT_EQ(following->cycles(), 200u);
  for (int cycle = 0; cycle < 1500; ++cycle) {
    const double told_s = 0.001 * (cycle / 10 * 10);
    following->go_to(vector_of(std::array{0.8 * told_s, 0.0}), vector_of(std::array{0.8, 0.0}));
    ASSERT_NO_FATAL_FAILURE(keeps_limits());
  }
  EXPECT_NEAR(following->now().velocity[0], 0.8, 1e-3);
  EXPECT_NEAR(0.8 * 1.5 - following->now().position[0], 0.8 * 0.1, 0.01);
}

TEST_F(FollowingTest, RestsWithinTheTimesThatItsLimitsTakeAndStaysThere) {
  begin(zeros);
  for (int cycle = 0; cycle < 700; ++cycle) {
    following->go_with(vector_of(std::array{2.5, 1.0}));
    ASSERT_NO_FATAL_FAILURE(keeps_limits());
  }
  EXPECT_FALSE(following->at_rest());
  int cycles = 0;
  while (!following->at_rest() && cycles < 5000) {
    following->slow_down();
    ASSERT_NO_FATAL_FAILURE(keeps_limits());
    ++cycles;
  }
  EXPECT_LE(cycles, 2.5 / 4 / cycle_s + 200 + 2);
  const JointVector there = following->now().position;
  following->slow_down();
  EXPECT_EQ(following->now().position, there);
  EXPECT_TRUE(following->now().velocity.isZero(0));
}

/// However it is led: from rest on, and while one joint takes over from another.
TEST_F(FollowingTest, NeverNeedsMorePowerThanItMay) {
  std::mt19937 random{11};
  const auto any = [&](double least, double most) {
    return std::uniform_real_distribution<double>{least, most}(random);
  };
  double most_share = 0;
  for (int flight = 0; flight < 60; ++flight) {
    cycle_s = std::array{0.0005, 0.001, 0.002, 0.01}[static_cast<std::size_t>(flight % 4)];
    for (JointBounds& its : bounds) its.motion = {any(0.2, 10), any(0.1, 20), std::pow(10, any(0, 3))};
    begin(vector_of(std::array{any(-1, 2), any(-5, 5)}));
    const JointVector held = vector_of(std::array{any(-8, 8), any(-8, 8)});
    const double limit_w = any(1, 20);
    PowerPace power;
    power.set(held, bounds, limit_w);
    following->keep_power(power);
    JointVector place = following->now().position, velocity = zeros;
    for (int cycle = 0; cycle < 3000; ++cycle) {
      if (any(0, 1) < 0.01) {
        place = vector_of(std::array{any(-1.5, 2.5), any(-9, 9)});
        velocity = vector_of(std::array{any(-11, 11), any(-11, 11)});
      }
      if (flight % 3 == 0) following->go_with(velocity);
      else following->go_to(place, flight % 3 == 1 ? zeros : velocity);
      ASSERT_NO_FATAL_FAILURE(keeps_limits()) << flight << " " << cycle;
      double needed_w = 0;
      for (Eigen::Index i = 0; i < 2; ++i)
        needed_w += (std::abs(held[i]) + 0.3 * 10) * std::abs(following->now().velocity[i]);
      most_share = std::max(most_share, needed_w / limit_w);
      ASSERT_LE(needed_w, 0.8 * limit_w * (1 + 1e-9) + 1e-9) << flight << " " << cycle;
    }
  }
  EXPECT_GT(most_share, 0.79) << "and all of it is there to be had";
}

TEST_F(FollowingTest, GoesAsEverWhereItsPowerSuffices) {
  const JointVector there = vector_of(std::array{0.5, -0.3});
  std::array<JointVector, 2> places;
  for (const std::size_t limited : {0U, 1U}) {
    begin(zeros);
    PowerPace power;
    power.set(vector_of(std::array{4.0, -4.0}), bounds, 100);
    if (limited == 1) following->keep_power(power);
    for (int cycle = 0; cycle < 300; ++cycle) following->go_to(there, zeros);
    places[limited] = following->now().position;
  }
  EXPECT_EQ(places[0], places[1]);
}

/// There is room for so many cycles; who has less jerk than that takes accelerates less.
TEST_F(FollowingTest, AcceleratesLessWhereTheJerkHasNoTimeForMore) {
  for (JointBounds& its : bounds) its.motion = {2, 20, 1};
  begin(zeros);
  EXPECT_EQ(following->cycles(), Following::most_cycles);
  double most = 0;
  for (int cycle = 0; cycle < 3000; ++cycle) {
    following->go_with(vector_of(std::array{2.0, 2.0}));
    ASSERT_NO_FATAL_FAILURE(keeps_limits());
    most = std::max(most, following->now().acceleration[0]);
  }
  EXPECT_NEAR(most, 1 * 512 * 0.001 / 2, 1e-3);
}

}  // namespace
}  // namespace hirosco::robot_arm
