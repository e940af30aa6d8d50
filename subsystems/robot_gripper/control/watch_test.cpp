// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "subsystems/robot_gripper/control/watch.hpp"

namespace hirosco::robot_gripper {
namespace {

struct GripperWatch : ::testing::Test {
  Fingers fingers{std::array{Finger{.closed = 0, .open = 0.05, .effort = 80, .velocity = 0.1, .moved = 2}}, 0.1};
  Watch watch;
  Measured good{{0.02}, {0.05}, {-40}};
  std::optional<Finding> twice(const Measured& measured) {
    static_cast<void>(watch.update(measured, fingers, {}));
    return watch.update(measured, fingers, {});
  }
};

TEST_F(GripperWatch, TripsOnTwoOfThreeSamplesOfEachKindOnce) {
  struct Case {
    Measured measured;
    Excess what;
    double limit;
  };
  for (const Case& each :
       {Case{{{0.053}, {0}, {0}}, Excess::Position, 0.0525}, Case{{{-0.003}, {0}, {0}}, Excess::Position, -0.0025},
        Case{{{0.02}, {0.12}, {0}}, Excess::Speed, 0.11}, Case{{{0.02}, {0}, {-77}}, Excess::Force, 76}}) {
    watch.arm();
    EXPECT_FALSE(watch.update(each.measured, fingers, {}));
    EXPECT_FALSE(watch.tripped());
    const auto found = watch.update(each.measured, fingers, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->what, each.what);
    EXPECT_NEAR(found->limit, each.limit, 1e-12);
    EXPECT_FALSE(watch.update(each.measured, fingers, {})) << "told once";
    EXPECT_TRUE(watch.tripped());
  }
}

TEST_F(GripperWatch, TakesWhatIsNoNumberForTooMuch) {
  for (const Measured& measured :
       {Measured{{NAN}, {0}, {0}}, Measured{{0.02}, {NAN}, {0}}, Measured{{0.02}, {0}, {NAN}}}) {
    watch.arm();
    EXPECT_TRUE(twice(measured));
  }
}

TEST_F(GripperWatch, LetsAGoodGripBe) {
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(twice(good));
}

}  // namespace
}  // namespace hirosco::robot_gripper
