// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/mujoco/relative_encoders.hpp"

namespace hirosco::simulation {
namespace {

TEST(RelativeEncoders, CountFromWhereTheyWereSwitchedOn) {
  RelativeEncoders encoders{{0.5, 0.5}, std::vector{0.0, -1.0}, 1};
  EXPECT_EQ(encoders.read(0, 0.25), 0);
  EXPECT_EQ(encoders.read(1, 0.25), -1);
  EXPECT_EQ(encoders.read(0, 1.25), 1);
  EXPECT_FALSE(encoders.knows_zero(0)) << "nobody told it to take its zero";
}

TEST(RelativeEncoders, KnowTheirZeroFromTheirMarkOnWhereTheyAreToldToTakeIt) {
  RelativeEncoders encoders{{0.5, 0.5}, std::vector{0.0, 0.0}, 1};
  static_cast<void>(encoders.read(0, 0.25));
  static_cast<void>(encoders.read(1, 0.25));
  encoders.take_zero(0, true);
  EXPECT_EQ(encoders.read(0, 0.375), 0.125);
  EXPECT_FALSE(encoders.knows_zero(0));
  EXPECT_EQ(encoders.read(0, 0.5625), 0.5625);
  EXPECT_TRUE(encoders.knows_zero(0));
  encoders.take_zero(0, false);
  EXPECT_EQ(encoders.read(0, 0.25), 0.25);
  EXPECT_EQ(encoders.read(1, 0.75), 0.5);
  EXPECT_FALSE(encoders.knows_zero(1));
}

TEST(RelativeEncoders, ForgetTheirZeroWithoutPower) {
  RelativeEncoders encoders{{0.5}, std::vector{0.0}, 1};
  static_cast<void>(encoders.read(0, 0.25));
  encoders.take_zero(0, true);
  EXPECT_EQ(encoders.read(0, 0.75), 0.75);
  encoders.forget();
  EXPECT_FALSE(encoders.knows_zero(0));
  EXPECT_EQ(encoders.read(0, 0.75), 0);
}

TEST(RelativeEncoders, BeginAnywhereByTheirSeedAndAlikeByTheSameOne) {
  RelativeEncoders one{{0.5}, std::nullopt, 7}, same{{0.5}, std::nullopt, 7}, other{{0.5}, std::nullopt, 8};
  const double told = one.read(0, 0.25);
  EXPECT_EQ(same.read(0, 0.25), told);
  EXPECT_NE(other.read(0, 0.25), told);
  EXPECT_LE(std::abs(told), 3);
  one.forget();
  EXPECT_NE(one.read(0, 0.25), told);
}

}  // namespace
}  // namespace hirosco::simulation
