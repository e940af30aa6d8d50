// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/control/sensor_limits.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace hirosco::manipulator {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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

TEST(TorqueLimit, WatchesEveryJointOfAnyNumber) {
  for (std::size_t joints = 1; joints <= max_joints; ++joints)
    for (std::size_t loaded = 0; loaded < joints; ++loaded) {
      TorqueLimit limit;
      Joints torque = Joints::zeros(joints);
      torque[loaded] = -13;
      (void)limit.update(torque, 12, 15);
      const auto finding = limit.update(torque, 12, 15);
      EXPECT_EQ(finding.verdict, TorqueVerdict::Soft);
      EXPECT_EQ(finding.joint, loaded);
    }
}

TEST(TorqueGuard, TellsEachLimitOnceAndAHigherOneWhateverALowerOneDid) {
  using Watch = TorqueGuard::Watch;
  TorqueGuard guard;
  const auto told = [&guard](double torque, Watch watch = Watch::Both) {
    (void)guard.update({torque}, 12, 15, Watch::HardOnly);
    const auto finding = guard.update({torque}, 12, 15, watch);
    return finding ? finding->verdict : TorqueVerdict::Fine;
  };
  EXPECT_EQ(told(13, Watch::HardOnly), TorqueVerdict::Fine);
  EXPECT_FALSE(guard.tripped());
  EXPECT_EQ(told(13), TorqueVerdict::Soft);
  EXPECT_EQ(told(13), TorqueVerdict::Fine) << "once";
  EXPECT_TRUE(guard.tripped());
  (void)guard.update({16}, 12, 15, Watch::Both);
  const auto hard = guard.update({16}, 12, 15, Watch::HardOnly);
  ASSERT_TRUE(hard);
  EXPECT_EQ(hard->verdict, TorqueVerdict::Hard);
  guard.arm();
  EXPECT_FALSE(guard.tripped());
  EXPECT_EQ(told(13), TorqueVerdict::Soft);
}

TEST(Temperature, IsJudgedByTheHottestJoint) {
  const TemperatureLimits limits;
  EXPECT_EQ(judge({54.9F, 20}, limits), TemperatureVerdict::Fine);
  EXPECT_EQ(judge({20, 55}, limits), TemperatureVerdict::Warning);
  EXPECT_EQ(judge({70, 55}, limits), TemperatureVerdict::Critical);
  EXPECT_EQ(judge({20, 30, 40, 50, 60, 71, 20}, limits), TemperatureVerdict::Critical);
  EXPECT_EQ(judge({80, 20}, limits), TemperatureVerdict::Maximum);
  EXPECT_EQ(judge({20, std::numeric_limits<float>::quiet_NaN()}, limits), TemperatureVerdict::Maximum);
}

TEST(TemperatureGuard, TellsEachLevelOnceOnTheWayUpAndAgainOnAnEntryThatIsTooEarly) {
  using Moment = TemperatureGuard::Moment;
  TemperatureGuard guard;
  const TemperatureLimits limits;
  const auto told = [&](float celsius, Moment moment = Moment::Other) {
    const auto finding = guard.update({20, celsius, 30}, limits, moment);
    if (finding) {
      EXPECT_EQ(finding->joint, 1);
    }
    return finding ? finding->verdict : TemperatureVerdict::Fine;
  };
  EXPECT_EQ(told(60), TemperatureVerdict::Warning);
  EXPECT_EQ(told(61), TemperatureVerdict::Fine);
  EXPECT_EQ(told(61, Moment::EntryIntoOperational), TemperatureVerdict::Fine) << "warm is not too hot";
  EXPECT_EQ(told(75), TemperatureVerdict::Critical);
  EXPECT_TRUE(guard.too_hot());
  EXPECT_EQ(told(75), TemperatureVerdict::Fine);
  EXPECT_EQ(told(75, Moment::EntryIntoOperational), TemperatureVerdict::Critical);
  EXPECT_EQ(told(40), TemperatureVerdict::Fine);
  EXPECT_FALSE(guard.too_hot());
  EXPECT_EQ(told(90), TemperatureVerdict::Maximum);
}

}  // namespace
}  // namespace hirosco::manipulator
