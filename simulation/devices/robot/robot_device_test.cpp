// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/simulated_device.hpp"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "simulation/devices/robot/robot_device.hpp"
#include "simulation/devices/testing/bench.hpp"

namespace hirosco::simulation {
namespace {

constexpr Duration cycle = std::chrono::microseconds{500};

using RobotBench = Bench<RobotDevice>;

TEST(RobotDevice, AnswersEachCommandWithItsSensors) {
  RobotBench bench;
  bench.active();
  const auto status = bench.status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->head.sequence, 1U);
  EXPECT_EQ(status->head.epoch, 1U);
  EXPECT_EQ(status->payload.size(), RobotDevice::sensor_octets);
  EXPECT_NEAR(status->value(0), -0.80, 1e-6);
  EXPECT_NEAR(status->value(5), 1.60, 5e-5);
  OctetReader tail{Octets{status->payload}.last(9), std::endian::little};
  EXPECT_EQ(tail.get<float>(), 20.0F);
}

TEST(RobotDevice, SpeaksTheByteOrderOfItsEndnode) {
  LocalFlows flows;
  const FlowAddress at{Transfer::SharedMemory, "robot"};
  SimulatedDevice::Settings settings;
  settings.byte_order = std::endian::big;
  RobotDevice robot{flows, at, settings};
  ASSERT_TRUE(robot.plug());
  const auto flow = std::move(flows.open(at, FlowSide::Subsystem).value());
  std::array<std::byte, RobotDevice::command_octets> payload{};
  OctetWriter writer{payload, std::endian::big};
  writer.put(7.5).put(-2.5);
  std::array<std::byte, max_device_frame_octets> buffer;
  ASSERT_TRUE(flow->send(write_command(buffer, {DeviceMode::Active, 1, 1, 0, payload}).value()));
  robot.step(TimePoint{});
  EXPECT_EQ(robot.motor_torque_n_m(), (Vec2{7.5, -2.5}));
  const auto received = flow->receive(buffer);
  ASSERT_TRUE(received);
  OctetReader reader{read_status(Octets{buffer}.first(received->octets))->payload, std::endian::big};
  EXPECT_NEAR(reader.get<double>(), -0.80, 1e-3);
}

TEST(RobotDevice, MovesByTheCommandedTorqueOneCyclePerExchange) {
  RobotBench bench;
  TwoJointArm alone;
  for (int k = 0; k < 100; ++k) {
    bench.active(5);
    alone.step({5, 0}, cycle);
  }
  EXPECT_EQ(bench.device.arm().state().link_rad, alone.state().link_rad);
  EXPECT_EQ(bench.device.cycles(), 100U);
  EXPECT_EQ(bench.device.own_cycles(), 0U);
}

TEST(RobotDevice, AppliesNothingWhileOffAndDropsInStopWhereNoOtherStopIsDeclared) {
  RobotBench bench;
  bench.command(DeviceMode::Off, 1, 50);
  bench.step();
  EXPECT_EQ(bench.device.motor_torque_n_m(), (Vec2{}));
  for (int k = 0; k < 50; ++k) bench.active(20);
  bench.command(DeviceMode::Stop, 1, 50);
  bench.step();
  EXPECT_EQ(bench.device.motor_torque_n_m(), (Vec2{}));
  EXPECT_EQ(bench.device.output(), DeviceOutput::Off);
}

TEST(RobotDevice, SaysWhenItSaturatesAndWhenItIsHot) {
  RobotBench bench;
  bench.active(61);
  EXPECT_TRUE(bench.status()->head.flags & device_flag::torque_saturated);
  ASSERT_TRUE(bench.device.fault("temperature 2 85.5"));
  bench.active(0);
  const auto status = bench.status();
  EXPECT_EQ(status->head.flags, device_flag::over_temperature);
  OctetReader tail{Octets{status->payload}.last(5), std::endian::little};
  EXPECT_NEAR(tail.get<float>(), 85.5F, 0.01F);
}

TEST(RobotDevice, HooksAndReleasesASpringWhenTheCommandChanges) {
  RobotBench bench;
  const auto hooked = [&](std::uint8_t wanted) {
    bench.beyond_torque[0] = std::byte{wanted};
    bench.active();
    return std::to_integer<int>(bench.status()->payload.back());
  };
  EXPECT_EQ(hooked(1), 0) << "the vertical spring is not within reach at home";
  EXPECT_EQ(hooked(2), 2);
  EXPECT_EQ(hooked(1), 2) << "one spring at a time";
  EXPECT_EQ(hooked(0), 0);
}

TEST(RobotDevice, HooksASpringAtHome) {
  RobotBench bench;
  EXPECT_FALSE(bench.device.fault("hook 1"));
  EXPECT_TRUE(bench.device.fault("hook 2"));
  EXPECT_EQ(bench.device.arm().hooked_spring(), 1U);
  EXPECT_TRUE(bench.device.fault("release"));
  EXPECT_FALSE(bench.device.arm().hooked_spring());
}

TEST(Watchdog, SwitchesTheTorqueOffAfterItsTimeAndLatchesUntilAHigherEpoch) {
  RobotBench bench;
  bench.active(5);
  for (int k = 0; k < 19; ++k) bench.step();
  EXPECT_FALSE(bench.device.watchdog_tripped());
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 5);
  bench.step();  // 10 ms after the command
  EXPECT_TRUE(bench.device.watchdog_tripped());
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 0);
  bench.active(5);
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 0) << "the same epoch does not wake it";
  EXPECT_TRUE(bench.status()->head.flags & device_flag::watchdog_tripped);
  bench.active(5, 2);
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 5);
  EXPECT_EQ(bench.status()->head.flags, 0);
}

/// After every way down of up to four steps, with or without a trip of the watchdog between any two of them.
TEST(Watchdog, LeavesADeviceThatAHigherEpochTakesUpAfterEverySequenceOfModesAndTrips) {
  constexpr int length = 4, choices = 6;  // three modes, each with and without a trip after it
  for (int sequence = 0; sequence < 6 * 6 * 6 * 6; ++sequence) {
    RobotBench bench;
    bench.active(5);
    int rest = sequence;
    for (int step = 0; step < length; ++step, rest /= choices) {
      bench.command(static_cast<DeviceMode>(rest % 3), 1, 5);
      bench.step();
      if (rest % choices >= 3)
        for (int k = 0; k < 21; ++k) bench.step();
    }
    bench.active(5, 2);
    ASSERT_EQ(bench.device.motor_torque_n_m()[0], 5) << sequence;
    ASSERT_EQ(bench.status()->head.flags, 0) << sequence;
  }
}

TEST(Watchdog, TakesTheTimeThatTheCommandAsksFor) {
  RobotBench bench;
  bench.command(DeviceMode::Active, 1, 5, 0, 50'000);
  bench.step();
  for (int k = 0; k < 99; ++k) bench.step();
  EXPECT_FALSE(bench.device.watchdog_tripped());
  bench.step();
  EXPECT_TRUE(bench.device.watchdog_tripped());
}

TEST(Watchdog, IsNotArmedWhileOff) {
  RobotBench bench;
  bench.command(DeviceMode::Off, 1);
  for (int k = 0; k < 1000; ++k) bench.step();
  EXPECT_FALSE(bench.device.watchdog_tripped());
}

TEST(Watchdog, TripsEvenWhenThePendingCommandComesBeforeTheClockWasLookedAt) {
  RobotBench bench;
  bench.active(5);
  for (int k = 0; k < 19; ++k) bench.step();
  EXPECT_FALSE(bench.device.watchdog_tripped());
  bench.active(5);
  EXPECT_TRUE(bench.device.watchdog_tripped());
}

TEST(Watchdog, CountsOnlyTheTimeInWhichTheDeviceItselfRan) {
  RobotBench bench;
  bench.active(5);
  bench.device.step(bench.now += std::chrono::seconds{3});
  EXPECT_FALSE(bench.device.watchdog_tripped());
  for (int k = 0; k < 20; ++k) bench.step();
  EXPECT_TRUE(bench.device.watchdog_tripped());
}

TEST(Watchdog, DoesNotCountForAWhileWhatAStarvingMachineGivesTheDeviceBeforeItsSubsystem) {
  constexpr Duration late = std::chrono::microseconds{1700};
  RobotBench bench;
  bench.active(5);
  for (int k = 0; k < 100; ++k) {
    bench.device.step(bench.now += late);
    ASSERT_FALSE(bench.device.watchdog_tripped()) << k;
  }
  for (int k = 0; k < 20; ++k) bench.device.step(bench.now += late);
  EXPECT_TRUE(bench.device.watchdog_tripped());
}

TEST(Watchdog, ForgivesNoStepInWhichTheWorldWouldFollowACommandThatNobodyHadTimeToFollowUp) {
  constexpr Duration late = std::chrono::microseconds{1700};
  RobotBench bench;
  bench.active(5);
  const Vec2 motor_rad = bench.device.arm().state().motor_rad;
  const auto lived = bench.device.cycles();
  for (int k = 0; k < 40; ++k) {
    bench.device.step(bench.now += late);
    ASSERT_EQ(bench.device.arm().state().motor_rad, motor_rad) << k;
  }
  EXPECT_EQ(bench.device.cycles(), lived);
  bench.active(5);
  EXPECT_GT(bench.device.cycles(), lived) << "whoever follows it up finds the world where it was";
  EXPECT_LE(bench.device.cycles(), lived + 2);
  EXPECT_NE(bench.device.arm().state().motor_rad, motor_rad);
}

TEST(Fence, RefusesAnOldEpochAndItDoesNotFeedTheWatchdog) {
  RobotBench bench;
  bench.active(5, 7);
  for (int k = 0; k < 20; ++k) bench.active(50, 6);
  EXPECT_TRUE(bench.device.watchdog_tripped());
  EXPECT_TRUE(bench.status()->head.flags & device_flag::old_epoch_refused);
  bench.active(5, 8);
  EXPECT_EQ(bench.status()->head.flags, 0);
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 5);
}

TEST(Commands, ThatAreDamagedAreCountedAndIgnored) {
  RobotBench bench;
  bench.active(5);
  std::array<std::byte, max_device_frame_octets> buffer;
  const std::array<std::byte, 15> too_short{};
  (void)bench.flow->send(write_command(buffer, {DeviceMode::Active, 1, 9, 0, too_short}).value());
  bench.step();
  (void)bench.flow->send(Octets{buffer}.first(7));
  bench.step();
  EXPECT_EQ(bench.device.damaged_commands(), 2U);
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 5) << "the last good one holds until the watchdog";
}

TEST(OwnClock, TakesOverWhenACommandIsOverdueByACycleAndTheWorldGoesOn) {
  RobotBench bench;
  bench.active(5);
  const auto first = bench.device.cycles();
  EXPECT_EQ(bench.device.next_wake(), bench.now + 2 * cycle);
  bench.step();
  EXPECT_EQ(bench.device.cycles(), first) << "not overdue yet";
  bench.step();
  EXPECT_EQ(bench.device.cycles(), first + 2);
  EXPECT_EQ(bench.device.next_wake(), bench.now + cycle);
  for (int k = 0; k < 100; ++k) bench.step();
  EXPECT_EQ(bench.device.cycles(), first + 102);
  EXPECT_TRUE(bench.status()) << "the device speaks on";
}

TEST(OwnClock, CatchesUpBoundedlyAfterTheProcessWasHeldUp) {
  RobotBench bench;
  bench.active();
  bench.device.step(bench.now += std::chrono::hours{1});
  EXPECT_LE(bench.device.cycles(), 41U);
  EXPECT_GT(bench.device.next_wake(), bench.now);
}

/// Over ten seconds of a subsystem's cycles, as the craft steps a device: by its own wakes and at each exchange.
std::uint64_t cycles_in_ten_seconds(Duration period, Duration jitter) {
  RobotBench bench;
  bench.step();
  const TimePoint start = bench.now;
  const auto before = bench.device.cycles();
  bool late = false;
  for (TimePoint planned = start + period; planned <= start + std::chrono::seconds{10}; planned += period) {
    const TimePoint exchange = planned + (std::exchange(late, !late) ? jitter : Duration{0});
    while (bench.device.next_wake() <= exchange) bench.device.step(bench.now = bench.device.next_wake());
    bench.command(DeviceMode::Active, 1);
    bench.device.step(bench.now = exchange);
  }
  return bench.device.cycles() - before;
}

TEST(OwnClock, MakesTimeThroughPeriodCyclesWhateverTheRatioOfPeriods) {
  constexpr double expected = 20'000;
  for (const int sixteenths : {4, 8, 16, 24, 32, 40, 64, 128, 320})
    for (const Duration jitter : {Duration{0}, cycle / 8, cycle / 3})
      EXPECT_NEAR(static_cast<double>(cycles_in_ten_seconds(cycle * sixteenths / 16, jitter)), expected, 1)
          << sixteenths / 16.0 << " device cycles a period, jitter " << jitter.count() << " ns";
}

TEST(OwnClock, MovesTheWorldByOneCycleForEachExchangeOfAnEquallyFastSubsystemThatJitters) {
  RobotBench bench;
  bench.active();
  for (int k = 0; k < 1000; ++k) {
    const auto before = bench.device.cycles();
    bench.command(DeviceMode::Active, 1);
    bench.device.step(bench.now += k % 2 == 0 ? cycle * 13 / 10 : cycle * 7 / 10);
    ASSERT_EQ(bench.device.cycles(), before + 1) << k;
  }
}

TEST(OwnClock, AnswersAnExchangeAlsoWhereItHasAlreadyMovedTheWorld) {
  RobotBench bench;
  bench.active();
  bench.device.step(bench.now += 4 * cycle);
  (void)bench.raw();
  const auto before = bench.device.cycles();
  bench.command(DeviceMode::Active, 1);
  bench.device.step(bench.now);
  EXPECT_EQ(bench.device.cycles(), before);
  const auto status = bench.status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->head.sequence, 2U);
}

TEST(Faults, UnplugHangsUpAndPlugComesBack) {
  RobotBench bench;
  bench.active(5);
  (void)bench.status();
  ASSERT_TRUE(bench.device.fault("unplug"));
  EXPECT_FALSE(bench.device.plugged());
  std::array<std::byte, max_device_frame_octets> buffer;
  EXPECT_EQ(bench.flow->receive(buffer).error().code, ErrorCode::Unavailable);
  for (int k = 0; k < 30; ++k) bench.step();
  EXPECT_TRUE(bench.device.watchdog_tripped());
  ASSERT_TRUE(bench.device.fault("plug"));
  bench.flow.reset();
  bench.flow = bench.flows.open(bench.address, FlowSide::Subsystem).value();
  bench.active(5, 2);
  EXPECT_TRUE(bench.status());
}

TEST(Faults, FreezeRepeatsTheLastFrameWhileTheWorldGoesOn) {
  RobotBench bench;
  bench.active(20);
  const auto before = bench.raw();
  ASSERT_TRUE(bench.device.fault("freeze 5"));
  for (int k = 0; k < 9; ++k) {
    bench.active(20);
    EXPECT_EQ(bench.raw(), before) << k;
  }
  bench.active(20);
  EXPECT_NE(bench.raw(), before);
  EXPECT_EQ(bench.device.cycles(), 11U);
}

TEST(Faults, SilenceAndStallSayNothingButListen) {
  RobotBench bench;
  bench.active();
  (void)bench.raw();
  ASSERT_TRUE(bench.device.fault("stall 2"));
  for (int k = 0; k < 3; ++k) {
    bench.active();
    EXPECT_TRUE(bench.raw().empty()) << k;
  }
  bench.active();
  EXPECT_FALSE(bench.raw().empty());
  ASSERT_TRUE(bench.device.fault("silent"));
  for (int k = 0; k < 100; ++k) bench.active();
  EXPECT_TRUE(bench.raw().empty());
  EXPECT_FALSE(bench.device.watchdog_tripped());
  ASSERT_TRUE(bench.device.fault("heal"));
  bench.active();
  EXPECT_FALSE(bench.raw().empty());
}

TEST(Faults, HealTakesBackWhatWasDoneToTheDeviceItself) {
  RobotBench bench;
  const double made = bench.device.arm().parameters().thermal.acceleration;
  for (const char* line : {"temperature 1 85", "temperature 2 85", "thermal_accel 7", "friction off", "noise 3"})
    ASSERT_TRUE(bench.device.fault(line)) << line;
  ASSERT_TRUE(bench.device.fault("heal"));
  EXPECT_EQ(bench.device.arm().temperature_c(), (Vec2{20, 20}));
  EXPECT_EQ(bench.device.arm().parameters().thermal.acceleration, made);
  EXPECT_GT(bench.device.arm().parameters().joint.friction_coulomb_n_m, 0);
}

TEST(Truth, TellsHowMuchTimeHasPassedInTheWorld) {
  RobotBench bench;
  for (int k = 0; k < 40; ++k) bench.active();
  const double passed_s = static_cast<double>(bench.device.cycles()) * 500e-6;
  EXPECT_GE(bench.device.cycles(), 40U);
  EXPECT_NE(bench.device.truth().find(fmt::format("world_s={:.4f}", passed_s)), std::string::npos)
      << bench.device.truth();
}

TEST(Truth, TellsWhenCommandsReachedTheMotorsLast) {
  RobotBench bench;
  for (int k = 0; k < 40; ++k) bench.active();
  const auto obeyed = fmt::format("obeyed_s={:.4f}", static_cast<double>(bench.device.cycles()) * 500e-6);
  EXPECT_NE(bench.device.truth().find(obeyed), std::string::npos) << bench.device.truth();
  for (int k = 0; k < 10; ++k) {
    bench.command(DeviceMode::Off, 1);
    bench.step();
  }
  EXPECT_NE(bench.device.truth().find(obeyed), std::string::npos) << bench.device.truth();
}

TEST(Faults, CorruptDamagesExactlyThatManyFrames) {
  RobotBench bench;
  ASSERT_TRUE(bench.device.fault("corrupt 20"));
  int damaged = 0;
  for (int k = 0; k < 50; ++k) {
    bench.active();
    if (!bench.status()) ++damaged;
  }
  EXPECT_EQ(damaged, 20);
}

TEST(Faults, DelayHoldsFramesBack) {
  RobotBench bench;
  ASSERT_TRUE(bench.device.fault("delay 3"));
  for (std::uint32_t k = 1; k <= 20; ++k) {
    bench.active();
    const auto status = bench.status();
    if (k <= 6) EXPECT_FALSE(status) << k;
    else EXPECT_EQ(status->head.sequence, k - 6);
  }
}

TEST(Faults, AreRecordedWithTheirTimeAndWrongOnesDoNothing) {
  RobotBench bench;
  for (int k = 0; k < 4; ++k) bench.step();
  for (const char* wrong : {"", "explode", "corrupt", "corrupt x", "corrupt -1", "freeze 1 2", "freeze nan", "plug now",
                            "temperature 3 20", "temperature 1 1e9", "hook 0", "a b c d e f g h i j"})
    EXPECT_FALSE(bench.device.fault(wrong)) << wrong;
  EXPECT_TRUE(bench.device.injections().empty());
  ASSERT_TRUE(bench.device.fault("corrupt 1"));
  ASSERT_EQ(bench.device.injections().size(), 1U);
  EXPECT_EQ(bench.device.injections()[0].line, "corrupt 1");
  EXPECT_EQ(bench.device.injections()[0].at, TimePoint{} + 4 * cycle);
}

}  // namespace
}  // namespace hirosco::simulation
