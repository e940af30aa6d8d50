// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <tuple>

#include "subsystems/robot_arm/control/watch.hpp"

namespace hirosco::robot_arm {
namespace {

const std::array<JointBounds, 2> bounds{JointBounds{-1, 1, 100, {2, 4, 40}}, JointBounds{-2, 2, 10, {3, 4, 40}}};

Measured rest() {
  const JointVector zeros = JointVector::Zero(2);
  return {zeros, zeros, zeros};
}

/// How it is measured, what it is called, and a value that is just permitted and one that is not, of the second joint.
struct Case {
  Excess what;
  double within, beyond;
};

Measured with(Excess what, double value) {
  Measured measured = rest();
  (what == Excess::Position || what == Excess::Following ? measured.position
   : what == Excess::Speed                               ? measured.velocity
                                                         : measured.torque)[1] = value;
  return measured;
}

struct WatchTest : ::testing::TestWithParam<Case> {};

TEST_P(WatchTest, TellsTheSecondOfThreeSamplesBeyondALimitOnceAndByName) {
  const auto [what, within, beyond] = GetParam();
  const JointVector zeros = JointVector::Zero(2);
  const JointVector* setpoint = what == Excess::Following ? &zeros : nullptr;
  for (const double value : {beyond, -beyond, std::numeric_limits<double>::quiet_NaN()}) {
    // Then the position itself is told, or the hard limit.
    if ((what == Excess::Following || what == Excess::Torque) && std::isnan(value)) continue;
    Watch watch;
    for (const double permitted : {within, -within})
      for (int i = 0; i < 5; ++i) EXPECT_FALSE(watch.update(with(what, permitted), setpoint, bounds, {}));
    EXPECT_FALSE(watch.update(with(what, value), setpoint, bounds, {}));
    EXPECT_FALSE(watch.update(rest(), setpoint, bounds, {})) << "one disturbed sample";
    const auto found = watch.update(with(what, value), setpoint, bounds, {});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->what, what);
    EXPECT_EQ(found->joint, 1u);
    EXPECT_FALSE(watch.update(with(what, value), setpoint, bounds, {})) << "told already";
    EXPECT_TRUE(watch.tripped());
    watch.arm();
    EXPECT_FALSE(watch.tripped());
  }
}

INSTANTIATE_TEST_SUITE_P(Each, WatchTest,
                         ::testing::Values(Case{Excess::Position, 2.019, 2.021}, Case{Excess::Speed, 3.29, 3.31},
                                           Case{Excess::Torque, 7.99, 8.01}, Case{Excess::Following, 0.099, 0.101}));

TEST(Watch, TellsAShortSliderByItsOwnRange) {
  const std::array<JointBounds, 2> sliders{JointBounds{0, 0.1, 100, {2, 4, 40}}, JointBounds{0, 1, 100, {2, 4, 40}}};
  for (const auto& [joint, position, permitted] :
       {std::tuple{0, 0.1019, true}, {0, 0.1021, false}, {0, -0.0021, false}, {1, 1.019, true}, {1, 1.021, false}}) {
    Watch watch;
    Measured measured = rest();
    measured.position[joint] = position;
    for (int i = 0; i < 2; ++i) static_cast<void>(watch.update(measured, nullptr, sliders, {}));
    EXPECT_EQ(watch.tripped().has_value(), !permitted) << joint << " at " << position;
  }
}

TEST(Watch, TakesATorqueThatIsNoNumberForBeyondTheHardLimit) {
  Watch watch;
  const Measured none = with(Excess::Torque, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(watch.update(none, nullptr, bounds, {}));
  EXPECT_EQ(watch.update(none, nullptr, bounds, {})->what, Excess::TorqueHard);
}

TEST(Watch, TellsTheHardTorqueBesidesTheSoftOne) {
  Watch watch;
  const Measured hard = with(Excess::TorqueHard, 9.6);
  EXPECT_FALSE(watch.update(hard, nullptr, bounds, {}));
  EXPECT_EQ(watch.update(hard, nullptr, bounds, {})->what, Excess::TorqueHard);
  EXPECT_EQ(watch.update(hard, nullptr, bounds, {})->what, Excess::Torque);
  EXPECT_FALSE(watch.update(hard, nullptr, bounds, {}));
}

}  // namespace
}  // namespace hirosco::robot_arm
