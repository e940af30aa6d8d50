// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/testing/flown.hpp"

/// An arm whose driver is slow, as the guide has one in Python, and whose torques come two cycles late (docs/adr/0193).
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The numbers that the guide has changed, and nothing else.
[[nodiscard]] std::string slow(int sampling_us) {
  std::string text = descriptor_for(6, std::string{folder} + "robot_arm.urdf");
  replace_all(text, "sampling_us=\"1000\"", "sampling_us=\"" + std::to_string(sampling_us) + "\"");
  replace_all(text, R"(silence="3" silence_reduced="40" watchdog_ms="10" watchdog_reduced_ms="50")",
              R"(silence="10" silence_reduced="40" watchdog_ms="60" watchdog_reduced_ms="250")");
  return text;
}

/// `heavier`: its links, than its file says.
struct SlowlyFlown : Flown {
  double cycle_s;
  std::deque<JointVector> under_way;

  SlowlyFlown(int sampling_us, double heavier)
      : Flown{model_of(std::string{folder} + "robot_arm.urdf", heavier), slow(sampling_us)},
        cycle_s{1e-6 * sampling_us} {
    plant.step_s = 250e-6;
  }
  std::vector<double> play(std::span<const double> torques) override {
    commanded = vector_of(torques);
    if (mode == DeviceMode::Active) under_way.push_back(commanded);
    else under_way.clear();
    if (under_way.size() > static_cast<std::size_t>(robotics::delay_cycles)) {
      plant.step(under_way.front(), cycle_s, &outside);
      under_way.pop_front();
    } else {
      plant.place(plant.measured().position);  // its brakes hold it until the first torque has come
    }
    std::vector<double> numbers;
    for (const auto* each : {&plant.measured().position, &plant.measured().velocity, &plant.measured().torque})
      numbers.insert(numbers.end(), each->begin(), each->end());
    return numbers;
  }
};

TEST(RobotArmThatIsSlow, GoesWhereItIsToldToWithNothingChangedButItsCycleThoughItsLinksAreAFifthHeavierOrLighter) {
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  const JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  for (const int sampling_us : {1000, 2000, 4000})
    for (const double heavier : {0.8, 1.2}) {
      SlowlyFlown flown{sampling_us, heavier};
      const std::string which = std::to_string(sampling_us) + " us, " + std::to_string(heavier);
      flown.plant.place(start);
      flown.operate();
      const int second = 1'000'000 / sampling_us;
      flown.cycle(2 * second);
      EXPECT_LT(flown.off(start), 1e-3) << which;
      for (const JointVector& where : {goal, start}) {
        const auto request = flown.move_j(where);
        flown.finish(request);
        EXPECT_EQ(flown.rig.outcome(request), "1 3 5:0001 7") << which;
        EXPECT_LE(flown.off(where), 1e-3) << which;
      }
      EXPECT_EQ(flown.rig.inhibited(), 0u) << which;
    }
}

TEST(RobotArmThatIsSlow, TellsWhatOfItsBandwidthIsInForce) {
  for (const auto& [sampling_us, in_force] : {std::pair{1000, 40.0}, {2000, 40.0}, {4000, 20.0}}) {
    SlowlyFlown flown{sampling_us, 1};
    flown.rig.bring_to(State::PreOperational, 1);
    flown.cycle(5);
    EXPECT_DOUBLE_EQ(flown.told_number("BANDWIDTH_IN_FORCE"), in_force) << sampling_us;
    flown.write("BANDWIDTH", 60);
    flown.command(State::SafeOperational);
    flown.cycle(3);
    EXPECT_DOUBLE_EQ(flown.told_number("BANDWIDTH"), 60) << sampling_us;
    EXPECT_DOUBLE_EQ(flown.told_number("BANDWIDTH_IN_FORCE"), std::min(60.0, 80'000.0 / sampling_us)) << sampling_us;
  }
}

/// 1 kg at 0.2 m, on the joint that moves the least: of poles of 10 rad/s it would be 59 mrad off for ever.
TEST(RobotArmThatIsSlow, LearnsALoadThatNobodyDeclaredWithTheLongestCycleThatIsTaken) {
  const JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  const JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});
  SlowlyFlown flown{static_cast<int>(1e6 * robotics::longest_cycle_s + 0.5), 1};
  flown.plant.place(start);
  flown.outside[5] = 2;
  flown.operate();
  flown.cycle(static_cast<int>(4 / robotics::longest_cycle_s));
  EXPECT_LT(flown.off(start), 1e-3);
  const auto request = flown.move_j(goal);
  flown.finish(request);
  EXPECT_EQ(flown.rig.outcome(request), "1 3 5:0001 7");
  EXPECT_LE(flown.off(goal), 1e-3);
  EXPECT_EQ(flown.rig.inhibited(), 0u);
}

TEST(RobotArmThatIsSlow, IsNotConfiguredWithACycleThatLeavesNoLaw) {
  for (const int sampling_us : {5000, 8000, 10'000}) {
    SlowlyFlown flown{sampling_us, 1};
    ASSERT_EQ(flown.rig.set_state_now(State::PreOperational), "1 3 7");
    EXPECT_THAT(flown.rig.configure_now(1), StartsWith("1 3 8:")) << sampling_us;
    EXPECT_THAT(flown.rig.explanations, Contains(HasSubstr("sampling_us is too long"))) << sampling_us;
  }
}

}  // namespace
}  // namespace hirosco
