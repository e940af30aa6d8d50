// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "subsystems/robot_arm/testing/flown.hpp"

/// An arm on a computer with other work, whose cycles of 4 ms are missed now and then, as the whole subsystem (docs/adr/0229). What its observer makes of that:
/// `control/missed_cycles_test.cpp`.
namespace hirosco {
namespace {

using robot_arm::JointVector;
using robot_arm::vector_of;
using robot_arm::testing::descriptor_for;
using robot_arm::testing::Flown;
using robot_arm::testing::folder;
using robot_arm::testing::model_of;
using robot_arm::testing::replace_all;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr std::uint16_t contact_told = 1025;

[[nodiscard]] std::string descriptor_of_4_ms() {
  std::string text = descriptor_for(6, std::string{folder} + "robot_arm.urdf");
  replace_all(text, "sampling_us=\"1000\"", "sampling_us=\"4000\"");
  replace_all(text, R"(silence="3" silence_reduced="40" watchdog_ms="10" watchdog_reduced_ms="50")",
              R"(silence="10" silence_reduced="40" watchdog_ms="60" watchdog_reduced_ms="250")");
  return text;
}

/// Its device answers each command with what it measures when that comes, and does what it was told last until then.
struct Pausing : Flown {
  JointVector held = JointVector::Zero(6);
  TimePoint was{};
  bool driven{false};  ///< by what it was told before

  Pausing() : Flown{model_of(std::string{folder} + "robot_arm.urdf"), descriptor_of_4_ms()} { plant.step_s = 250e-6; }
  std::vector<double> play(std::span<const double> torques) override {
    const Duration passed = rig.clock.now() - was;
    was = rig.clock.now();
    if (mode == DeviceMode::Active && driven) plant.step(held, seconds(passed), &outside);
    else plant.place(plant.measured().position);
    driven = mode == DeviceMode::Active;
    held = vector_of(torques);
    std::vector<double> numbers;
    for (const auto* each : {&plant.measured().position, &plant.measured().velocity, &plant.measured().torque})
      numbers.insert(numbers.end(), each->begin(), each->end());
    return numbers;
  }
};

struct RobotArmThatMissesCycles : ::testing::Test {
  static constexpr Duration period = 4ms;
  Pausing flown;
  JointVector start = vector_of(std::array{0.2, 0.5, 1.2, -0.6, 0.7, 0.1});
  JointVector goal = vector_of(std::array{-0.8, -0.2, 0.6, 0.5, -0.5, 1.0});

  void SetUp() override {
    flown.plant.place(start);
    flown.operate();
    flown.cycle(250);
  }
  void miss(int cycles) { flown.rig.clock.advance(cycles * period); }
};

/// One cycle in `rarely` is followed by a pause of up to so many. Each of these ended with CONTACT_MET while the observer counted cycles.
TEST_F(RobotArmThatMissesCycles, MeetsNobodyWhereNobodyIs) {
  struct Flight {
    unsigned rarely, longest, seed;
    double speed;
  };
  for (const Flight& its : {Flight{25, 5, 7, 0.5}, {25, 7, 4, 0.5}, {40, 7, 2, 0.5}, {50, 9, 2, 0.5}, {40, 9, 2, 1}}) {
    Pausing arm;
    arm.plant.place(start);
    arm.operate();
    arm.cycle(250);
    std::minstd_rand random{its.seed};
    int missed = 0;
    const auto motion = arm.move_j(goal, its.speed);
    for (int i = 0; i < 1000 && arm.rig.outcome(motion).find_first_of("78") == std::string::npos; ++i) {
      if (random() % its.rarely == 0) {
        const int pause = 1 + static_cast<int>(random() % its.longest);
        missed += pause;
        arm.rig.clock.advance(pause * period);
      }
      arm.cycle();
    }
    EXPECT_GT(missed, 20) << its.rarely;
    EXPECT_THAT(arm.rig.outcome(motion), EndsWith(" 7")) << its.rarely;
    EXPECT_EQ(arm.rig.events(contact_told), 0) << its.rarely;
    EXPECT_LE(arm.off(goal), 1e-3) << its.rarely;
    EXPECT_EQ(arm.rig.inhibited(), 0u) << its.rarely;
  }
}

TEST_F(RobotArmThatMissesCycles, TellsBesideAContactHowManyThatWere) {
  const auto motion = flown.move_j(goal, 0.2);
  flown.cycle(100);
  miss(3);
  flown.cycle(20);
  miss(2);
  flown.cycle(20);
  flown.outside[0] = 100;
  for (int i = 0; i < 100 && flown.rig.events(contact_told) == 0; ++i) flown.cycle();
  flown.cycle();
  const std::string words = robot_arm::cycles_missed_before;
  EXPECT_THAT(flown.rig.outcome(motion), HasSubstr(" 8:8004"));
  EXPECT_THAT(flown.rig.outcome(motion),
              EndsWith("0000000000000005" + hirosco::testing::hex(std::as_bytes(std::span{words}))));
  EXPECT_LE(words.size(), 64U);
}

TEST_F(RobotArmThatMissesCycles, TellsNothingOfThoseThatAreLongAgo) {
  miss(5);
  flown.cycle(300);
  const auto motion = flown.move_j(goal, 0.2);
  flown.cycle(100);
  flown.outside[0] = 100;
  for (int i = 0; i < 100 && flown.rig.events(contact_told) == 0; ++i) flown.cycle();
  flown.cycle();
  EXPECT_EQ(flown.rig.outcome(motion), "1 3 8:8004");
}

/// Who is met in a pause is told when it is over, within what it takes without one.
TEST_F(RobotArmThatMissesCycles, MeetsWhoeverComesInAPauseAsSoonAsItIsOver) {
  const auto motion = flown.move_j(goal, 0.2);
  flown.cycle(100);
  flown.outside[0] = 100;
  miss(5);
  int cycles = 0;
  for (; cycles < 100 && flown.rig.events(contact_told) == 0; ++cycles) flown.cycle();
  EXPECT_LE(cycles, 10);
  EXPECT_THAT(flown.rig.outcome(motion), HasSubstr(" 8:8004"));
}

}  // namespace
}  // namespace hirosco
