// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// The second inhibit and the declared stop of a device, judged in the world's own truth.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/robot/robot_device.hpp"

namespace hirosco::simulation {
namespace {

constexpr Duration tick = std::chrono::microseconds{500};
constexpr Duration stop_time = std::chrono::milliseconds{200};
const FlowAddress frames_at{Transfer::SharedMemory, "robot"};
const FlowAddress enable_at{Transfer::SharedMemory, "robot.enable"};

SimulatedDevice::Settings actuator(SimulatedDevice::Stop stop) {
  SimulatedDevice::Settings settings;
  settings.stop = stop;
  settings.stop_within = stop == SimulatedDevice::Stop::Controlled ? stop_time : Duration{0};
  settings.enable = enable_at;
  return settings;
}

/// Robot device, its subsystem and the supervisor's side, all by hand.
struct Guarded {
  explicit Guarded(const SimulatedDevice::Settings& settings) : device{flows, frames_at, settings} {
    EXPECT_TRUE(device.plug());
    frames = flows.open(frames_at, FlowSide::Subsystem).value();
    enable = flows.open(enable_at, FlowSide::Subsystem).value();
  }
  void command(DeviceMode mode, std::uint32_t epoch, const Vec2& torque = {}) {
    std::array<std::byte, RobotDevice::command_octets> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(torque[0]).put(torque[1]);
    std::array<std::byte, max_device_frame_octets> buffer;
    (void)frames->send(write_command(buffer, {mode, epoch, ++sequence, 0, payload}).value());
  }
  void give(std::uint8_t enabled, std::uint32_t epoch) {
    std::array<std::byte, enable_frame_octets> buffer;
    (void)enable->send(write_enable_command(buffer, {enabled, epoch, ++enables}).value());
  }
  void step() { device.step(now += tick); }
  std::optional<EnableStatus> status() {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = enable->receive(buffer);
    if (!received || received->flow != Flow::New) return std::nullopt;
    const auto read = read_enable_status(Octets{buffer}.first(received->octets));
    return read ? std::optional{*read} : std::nullopt;
  }
  [[nodiscard]] double fastest() const {
    const ArmState& state = device.arm().state();
    return std::max({std::abs(state.motor_rad_s[0]), std::abs(state.motor_rad_s[1]), std::abs(state.link_rad_s[0]),
                     std::abs(state.link_rad_s[1])});
  }

  LocalFlows flows;
  RobotDevice device;
  std::unique_ptr<DataFlow> frames, enable;
  TimePoint now{};
  std::uint32_t sequence{0}, enables{0};
};

TEST(Enable, OneHundredThousandWellFormedFramesOfEveryEpochAndModeMoveNothingWithoutIt) {
  Guarded bench{actuator(SimulatedDevice::Stop::Drop)};
  const ArmState before = bench.device.arm().state();
  for (std::uint32_t k = 0; k < 100'000; ++k) {
    if (k % 10 == 0) bench.give(0, 1 + k / 20'000);
    const std::uint32_t epoch = k % 7 == 0 ? 1 + k / 20'000 : k * 2'654'435'761U;
    bench.command(static_cast<DeviceMode>(k % 3), epoch, {60, -60});
    bench.step();
    ASSERT_EQ(bench.device.motor_torque_n_m(), (Vec2{})) << k;
  }
  EXPECT_EQ(bench.device.arm().state().motor_rad, before.motor_rad);
  bench.give(1, 6);
  bench.command(DeviceMode::Active, 6, {5, 0});
  bench.step();
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 5) << "and none of them shuts out whom the supervisor's side names";
}

TEST(Enable, OfAnotherEpochThanTheSubsystemsFramesMovesNothing) {
  Guarded bench{actuator(SimulatedDevice::Stop::Drop)};
  for (std::uint32_t k = 0; k < 100; ++k) {
    bench.give(1, 3);
    bench.command(DeviceMode::Active, k % 2 == 0 ? 2 : 4, {5, 0});
    bench.step();
    ASSERT_EQ(bench.device.motor_torque_n_m(), (Vec2{}));
  }
}

TEST(Enable, CountsAsWithdrawnWhenItIsTooOldOrOnlyRepeatedAndThenWantsAHigherEpoch) {
  for (const bool repeated : {false, true}) {
    Guarded bench{actuator(SimulatedDevice::Stop::Drop)};
    bench.give(1, 1);
    int moving = 0;
    for (int k = 0; k < 200; ++k) {
      if (repeated) {
        --bench.enables;
        bench.give(1, 1);
      }
      bench.command(DeviceMode::Active, 1, {5, 0});
      bench.step();
      if (bench.device.motor_torque_n_m()[0] == 5) ++moving;
    }
    EXPECT_GE(moving, 99) << "50 ms";
    EXPECT_LE(moving, 101);
    const auto go = [&](std::uint32_t epoch) {
      bench.give(1, epoch);
      bench.command(DeviceMode::Active, epoch, {5, 0});
      bench.step();
      return bench.device.motor_torque_n_m()[0];
    };
    EXPECT_EQ(go(1), 0) << "no motion goes on by itself";
    EXPECT_EQ(go(2), 5);
  }
}

TEST(Enable, IsAnsweredWhateverTheSubsystemDoes) {
  Guarded bench{actuator(SimulatedDevice::Stop::Drop)};
  bench.give(0, 4);
  for (int k = 0; k < 2; ++k) bench.step();
  auto status = bench.status();
  ASSERT_TRUE(status) << "before its first frame";
  EXPECT_EQ(status->output, DeviceOutput::Off);
  EXPECT_EQ(status->sequence, 1U);
  bench.give(1, 4);
  bench.command(DeviceMode::Active, 4, {5, 0});
  bench.step();
  status = bench.status();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->output, DeviceOutput::Active);
  EXPECT_EQ(status->epoch, 4U);
  for (int k = 0; k < 60; ++k) bench.step();
  bench.give(1, 4);
  bench.step();
  status = bench.status();
  ASSERT_TRUE(status) << "while it is silent";
  EXPECT_EQ(status->output, DeviceOutput::Off);
  EXPECT_EQ(status->flags & device_flag::watchdog_tripped, device_flag::watchdog_tripped);
  bench.give(1, 3);
  bench.step();
  EXPECT_TRUE(bench.status()) << "also one of an old epoch, which changes nothing";
}

TEST(Enable, IsHeardAgainAfterTheDeviceWasUnpluggedAndPlugged) {
  Guarded bench{actuator(SimulatedDevice::Stop::Drop)};
  for (std::uint32_t epoch = 1; epoch <= 10; ++epoch) {
    bench.give(1, epoch);
    bench.command(DeviceMode::Active, epoch, {5, 0});
    bench.step();
    ASSERT_EQ(bench.device.motor_torque_n_m()[0], 5) << epoch;
    ASSERT_TRUE(bench.status()) << epoch;
    ASSERT_TRUE(bench.device.fault("unplug"));
    bench.give(1, epoch);
    for (int k = 0; k < 3; ++k) bench.step();
    ASSERT_EQ(bench.device.motor_torque_n_m()[0], 0) << epoch;
    ASSERT_FALSE(bench.status()) << epoch;
    ASSERT_TRUE(bench.device.fault("plug"));
    bench.frames.reset();
    bench.frames = bench.flows.open(frames_at, FlowSide::Subsystem).value();
  }
}

TEST(Enable, ADeviceWithoutItsEndnodeBehavesAsBefore) {
  auto settings = actuator(SimulatedDevice::Stop::Drop);
  settings.enable.reset();
  Guarded bench{settings};
  bench.command(DeviceMode::Active, 1, {5, 0});
  bench.step();
  EXPECT_EQ(bench.device.motor_torque_n_m()[0], 5);
}

// --- the declared stop -------------------------------------------------------------------------------------------------

enum class Situation : std::uint8_t { FullSpeed, Pressing, Spring };
enum class Way : std::uint8_t { Withdrawn, EnableSilent, SubsystemSilent, Stop, Off };

const char* name_of(Situation situation) {
  return situation == Situation::FullSpeed ? "full speed" : situation == Situation::Pressing ? "pressing" : "spring";
}

/// The control law of the note, from the world's truth.
Vec2 towards(const TwoJointArm& arm, const Vec2& desired, const Vec2& rate) {
  Vec2 torque{};
  for (std::size_t i = 0; i < 2; ++i) {
    const double u = 300 * (desired[i] - arm.state().motor_rad[i]) + 24 * (rate[i] - arm.state().motor_rad_s[i]);
    torque[i] = std::clamp(4 * u - 3 * arm.joint_torque_n_m()[i], -60.0, 60.0);
  }
  return torque;
}

constexpr double full_speed_rad_s = 1.0;

/// Brings the arm into the situation; ends while it is still commanded.
void bring(Guarded& bench, Situation situation) {
  const Vec2 home = bench.device.arm().parameters().home_rad;
  const auto drive = [&](const Vec2& to, double seconds_taken, const Vec2& rate = {}) {
    const int cycles = static_cast<int>(seconds_taken * 2000);
    for (int k = 0; k < cycles; ++k) {
      const Vec2 from = home;
      const double share = std::min(1.0, k / (0.5 * cycles));
      const Vec2 wish = rate == Vec2{} ? from + share * (to - from) : from + (k * 0.0005) * rate;
      if (k % 10 == 0) bench.give(1, 1);
      bench.command(DeviceMode::Active, 1, towards(bench.device.arm(), wish, rate));
      bench.step();
    }
  };
  switch (situation) {
    case Situation::FullSpeed: drive({}, 0.4, {full_speed_rad_s, full_speed_rad_s}); return;  // away from the rail
    case Situation::Pressing: drive(home + solve(bench.device.arm().jacobian(), {0.01678, 0}), 4); return;
    case Situation::Spring:
      ASSERT_TRUE(bench.device.fault("hook 2"));
      drive(home + solve(bench.device.arm().jacobian(), {0.008, -0.030}), 4);
      return;
  }
}

struct Ended {
  double rest_after_s{-1};  ///< since when nothing is faster than the limit
  double peak_force_n{0}, peak_torque_n_m{0}, force_after_n{0};
  DeviceOutput output{};
};

constexpr double at_rest_rad_s = 2e-3;

Ended stop_by(Guarded& bench, Way way) {
  Ended ended;
  for (int k = 0; k < 1000; ++k) {
    const bool silent = way == Way::SubsystemSilent;
    if (k % 10 == 0 && way != Way::EnableSilent) bench.give(way == Way::Withdrawn ? 0 : 1, 1);
    const DeviceMode mode = way == Way::Stop  ? DeviceMode::Stop
                            : way == Way::Off ? DeviceMode::Off
                                              : DeviceMode::Active;
    const TwoJointArm& arm = bench.device.arm();
    if (!silent) bench.command(mode, 1, towards(arm, arm.state().motor_rad, arm.state().motor_rad_s));
    bench.step();
    if (bench.device.active()) {  // until it has noticed
      k = -1;
      continue;
    }
    ended.peak_force_n = std::max(ended.peak_force_n, arm.contact().normal_force_n);
    for (const double torque : arm.joint_torque_n_m())
      ended.peak_torque_n_m = std::max(ended.peak_torque_n_m, std::abs(torque));
    if (bench.fastest() > at_rest_rad_s) ended.rest_after_s = -1;
    else if (ended.rest_after_s < 0) ended.rest_after_s = (k + 1) * 0.0005;
  }
  ended.force_after_n = bench.device.arm().contact().normal_force_n;
  ended.output = bench.device.output();
  return ended;
}

TEST(DeclaredStop, ComesToRestWithinItsTimeAtFullSpeedPressingAndWithASpringHookedWhateverTookTheCommandAway) {
  for (const Situation situation : {Situation::FullSpeed, Situation::Pressing, Situation::Spring})
    for (const Way way : {Way::Withdrawn, Way::EnableSilent, Way::SubsystemSilent, Way::Stop, Way::Off}) {
      Guarded bench{actuator(SimulatedDevice::Stop::Controlled)};
      bring(bench, situation);
      const double speed = bench.fastest(), force_n = bench.device.arm().contact().normal_force_n;
      const Ended ended = stop_by(bench, way);
      const std::string what = fmt::format("{}, way {}", name_of(situation), static_cast<int>(way));
      std::cout << fmt::format(
          "  {}: from {:.2f} rad/s and {:.1f} N at rest after {:.1f} ms, at most {:.1f} N and "
          "{:.1f} N m, {:.2f} N left\n",
          what, speed, force_n, 1e3 * ended.rest_after_s, ended.peak_force_n, ended.peak_torque_n_m,
          ended.force_after_n);
      EXPECT_GT(speed, situation == Situation::FullSpeed ? 0.9 * full_speed_rad_s : 0) << what;
      EXPECT_NEAR(force_n, situation == Situation::Pressing ? 40 : 0, 2) << what;
      EXPECT_GE(ended.rest_after_s, 0) << what;
      EXPECT_LE(ended.rest_after_s, seconds(stop_time)) << what;
      EXPECT_LE(ended.peak_force_n, force_n + 0.5) << what << ": a stop presses no harder";
      EXPECT_LE(ended.peak_torque_n_m, 15) << what << ": the hard limit of the joints";
      EXPECT_LE(ended.force_after_n, 2) << what;
      EXPECT_EQ(ended.output, DeviceOutput::Holding);
    }
}

TEST(DeclaredStop, HoldsAtOnceWhereItIs) {
  Guarded bench{actuator(SimulatedDevice::Stop::Hold)};
  bring(bench, Situation::Spring);
  const Vec2 where = bench.device.arm().state().link_rad;
  const Ended ended = stop_by(bench, Way::Withdrawn);
  EXPECT_EQ(ended.output, DeviceOutput::Holding);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(bench.device.arm().state().link_rad[i], where[i], 0.005);
}

TEST(DeclaredStop, EndsWhenAHigherEpochTakesTheDeviceUp) {
  Guarded bench{actuator(SimulatedDevice::Stop::Controlled)};
  bring(bench, Situation::Spring);
  static_cast<void>(stop_by(bench, Way::Withdrawn));
  bench.give(1, 2);
  bench.command(DeviceMode::Active, 2, {1, 2});
  bench.step();
  EXPECT_EQ(bench.device.output(), DeviceOutput::Active);
  EXPECT_EQ(bench.device.motor_torque_n_m(), (Vec2{1, 2}));
  EXPECT_EQ(bench.device.brake_n_m(), (Vec2{}));
}

}  // namespace
}  // namespace hirosco::simulation
