// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/testing/guard_rig.hpp"

/// Who holds two actuators, of which one alone can be asked whether it moves: it answers for the other one itself.
namespace hirosco::supervisor {
namespace {

using namespace testing;

struct OneOfTwoAsked : GuardTest {
  OneOfTwoAsked() {
    descriptor::Device gripper;
    gripper.name = "GRIPPER";
    gripper.actuator = true;
    mission.subsystems[0].subsystem.devices.push_back(gripper);
  }
  void SetUp() override {
    GuardTest::SetUp();
    cycling(arm);
    ASSERT_TRUE(guard.release(arm, guard.fences(arm)));
    run(50ms, {arm, hand, camera}, DeviceOutput::Active);
    stop = guard.stop_all();
  }
  /// How this device of ARM answered.
  [[nodiscard]] const StopAnswer& of(std::string_view name) {
    answers = guard.stop_outcome(stop).value_or(std::vector<StopAnswer>{});
    const auto found = std::ranges::find(answers, name, &StopAnswer::name);
    EXPECT_NE(found, answers.end()) << name << " is not named";
    static const StopAnswer none;
    return found != answers.end() ? *found : none;
  }
  std::vector<StopAnswer> answers;
  std::uint64_t stop{0};
};

TEST_F(OneOfTwoAsked, ItsNeighboursWordIsNotItsOwn) {
  run(100ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_FALSE(guard.stop_outcome(stop)) << "ARM acts by its own word";
  EXPECT_FALSE(guard.release(arm, guard.fences(arm)));
  lives[arm].vital->inhibited = inhibited_by_stop;
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_TRUE(of("MOTOR").asked_device);
  EXPECT_LE(of("MOTOR").stopped.value(), 10ms);
  EXPECT_FALSE(of("GRIPPER").asked_device);
  EXPECT_GE(of("GRIPPER").stopped.value(), 100ms);
  EXPECT_FALSE(lives[arm].process->killed);
}

TEST_F(OneOfTwoAsked, WhoGoesOnWithItIsEndedThoughItsNeighbourRests) {
  run(440ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_FALSE(lives[arm].process->killed);
  run(20ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_TRUE(lives[arm].process->killed);
  run(500ms, {arm, hand, camera}, DeviceOutput::Holding);
  EXPECT_TRUE(of("MOTOR").stopped);
  EXPECT_EQ(of("GRIPPER").stopped, std::nullopt);
  EXPECT_TRUE(of("GRIPPER").killed);
}

TEST_F(OneOfTwoAsked, ItsMembersWordDoesNotStandForTheNeighbour) {
  lives[arm].vital->inhibited = inhibited_by_stop;
  run(100ms, {arm, hand, camera}, DeviceOutput::Stopping);
  EXPECT_FALSE(guard.stop_outcome(stop));
  run(20ms, {arm, hand, camera}, DeviceOutput::Off);
  EXPECT_GE(of("MOTOR").stopped.value(), 100ms);
  EXPECT_LE(of("GRIPPER").stopped.value(), 10ms);
}

}  // namespace
}  // namespace hirosco::supervisor
