// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Who begins is let go (docs/guide/your_device.md, duty 4; docs/adr/0149): nothing goes on by itself after a reboot.
#include <array>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/power_frame.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "simulation/devices/testing/bench.hpp"

namespace hirosco::simulation {
namespace {

const FlowAddress inhibit_at{Transfer::SharedMemory, "robot.enable"};
const FlowAddress switch_at{Transfer::SharedMemory, "robot.power"};
constexpr double told_n_m = 0.01;  // it does not run away, however long
constexpr std::uint32_t watchdog_us = 1000;
constexpr int longer_than_the_watchdog = 3;  // cycles

enum class Inhibit : std::uint8_t { None, Second };

SimulatedDevice::Settings an_actuator(Inhibit inhibit = Inhibit::None) {
  SimulatedDevice::Settings settings;
  settings.actuator = true;
  if (inhibit == Inhibit::Second) settings.enable = inhibit_at;
  return settings;
}

/// The robot's device, its subsystem and, where it has a second inhibit, who names each epoch there.
struct Commanded : Bench<RobotDevice> {
  explicit Commanded(const SimulatedDevice::Settings& settings) : Bench{settings} {
    if (settings.enable) inhibit = flows.open(inhibit_at, FlowSide::Subsystem).value();
    if (settings.power) power = flows.open(switch_at, FlowSide::Subsystem).value();
  }
  void name(std::uint32_t epoch) {
    if (!inhibit) return;
    std::array<std::byte, enable_frame_octets> buffer;
    (void)inhibit->send(write_enable_command(buffer, {1, epoch, ++named}).value());
  }
  void tell(DeviceMode mode, std::uint32_t epoch) {
    name(epoch);
    command(mode, epoch, told_n_m, 0, watchdog_us);
    step();
  }
  void switch_power(bool on) {
    std::array<std::byte, power_frame_octets> buffer;
    (void)power->send(write_power_command(buffer, {.on = on, .sequence = ++switched}).value());
    step();
  }
  [[nodiscard]] bool acts() const {
    EXPECT_EQ(device.motor_torque_n_m()[0] == told_n_m, device.active());
    return device.active();
  }
  std::unique_ptr<DataFlow> inhibit, power;
  std::uint32_t named{0}, switched{0};
};

TEST(WhoBegins, IsLetGoIfItIsToldToBeActiveFirstAndTakenUpByAHigherEpochAlone) {
  for (const Inhibit inhibit : {Inhibit::None, Inhibit::Second}) {
    Commanded robot{an_actuator(inhibit)};
    for (int k = 0; k < 100; ++k) {
      robot.tell(DeviceMode::Active, 7);
      ASSERT_FALSE(robot.acts()) << k;
      const auto status = robot.status();
      ASSERT_TRUE(status) << "it is answered all the same";
      ASSERT_EQ(status->head.flags, device_flag::watchdog_tripped);
      ASSERT_EQ(status->head.epoch, 7U);
    }
    for (const DeviceMode mode : {DeviceMode::Off, DeviceMode::Active, DeviceMode::Stop, DeviceMode::Active}) {
      robot.tell(mode, 7);
      EXPECT_FALSE(robot.acts()) << "as after a trip";
    }
    robot.tell(DeviceMode::Active, 8);
    EXPECT_TRUE(robot.acts());
    EXPECT_EQ(robot.status()->head.flags, 0);
  }
}

TEST(WhoBegins, MovesAfterAFirstCommandThatIsNotActive) {
  for (const Inhibit inhibit : {Inhibit::None, Inhibit::Second})
    for (const DeviceMode first : {DeviceMode::Off, DeviceMode::Stop}) {
      Commanded robot{an_actuator(inhibit)};
      robot.tell(first, 7);
      robot.tell(DeviceMode::Active, 7);
      EXPECT_TRUE(robot.acts());
      EXPECT_EQ(robot.device.flags(), 0);
    }
}

TEST(WhoBegins, MovesNothingWhenItRebootsInAMotionUntilAHigherEpoch) {
  for (const Inhibit inhibit : {Inhibit::None, Inhibit::Second}) {
    Commanded robot{an_actuator(inhibit)};
    robot.tell(DeviceMode::Off, 7);
    robot.tell(DeviceMode::Active, 7);
    ASSERT_TRUE(robot.acts());
    ASSERT_TRUE(robot.device.fault("reboot"));
    EXPECT_FALSE(robot.device.active()) << "at once";
    ASSERT_TRUE(robot.device.fault("heal")) << "which takes nothing of it back";
    for (int k = 0; k < 100; ++k) {
      robot.tell(DeviceMode::Active, 7);
      ASSERT_FALSE(robot.acts()) << k;
    }
    robot.tell(DeviceMode::Active, 8);
    EXPECT_TRUE(robot.acts());
  }
}

TEST(WhoBegins, HasForgottenItsEpochAndItsSequence) {
  Commanded robot{an_actuator()};
  robot.tell(DeviceMode::Off, 7);
  ASSERT_TRUE(robot.device.fault("reboot"));
  robot.tell(DeviceMode::Off, 3);
  EXPECT_EQ(robot.status()->head.epoch, 3U) << "the first that comes";
  EXPECT_FALSE(robot.device.fault("reboot now"));
}

TEST(WhoBegins, AsItsPowerComesBackIsLetGo) {
  auto settings = an_actuator();
  settings.power = switch_at;
  Commanded robot{settings};
  robot.switch_power(true);
  robot.tell(DeviceMode::Off, 7);
  robot.tell(DeviceMode::Active, 7);
  ASSERT_TRUE(robot.acts());
  robot.switch_power(false);
  robot.switch_power(true);
  robot.tell(DeviceMode::Active, 7);
  EXPECT_FALSE(robot.acts());
  EXPECT_TRUE(robot.device.watchdog_tripped());
  robot.switch_power(false);
  robot.switch_power(true);
  robot.tell(DeviceMode::Off, 7);
  robot.tell(DeviceMode::Active, 7);
  EXPECT_TRUE(robot.acts()) << "as its subsystem brings it up";
}

TEST(WhoBegins, OfAnEpochThatItsSecondInhibitHasNotNamedHearsWhatIsNotActiveOnly) {
  for (const DeviceMode first : {DeviceMode::Off, DeviceMode::Active}) {
    Commanded robot{an_actuator(Inhibit::Second)};
    for (int k = 0; k < 5; ++k) {
      robot.command(first, 7, told_n_m, 0, watchdog_us);
      robot.step();
      ASSERT_FALSE(robot.acts());
    }
    robot.tell(DeviceMode::Active, 7);
    EXPECT_EQ(robot.acts(), first == DeviceMode::Off);
    robot.tell(DeviceMode::Active, 8);
    EXPECT_TRUE(robot.acts());
  }
}

TEST(WhoBegins, ASensorIsAlwaysToldActiveAndGoesOn) {
  auto settings = an_actuator();
  settings.actuator = false;
  Commanded sensor{settings};
  for (int k = 0; k < 3; ++k) {
    sensor.tell(DeviceMode::Active, 7);
    EXPECT_EQ(sensor.status()->head.flags, 0);
    ASSERT_TRUE(sensor.device.fault("reboot"));
  }
}

/// What a device may do by what it has heard since it began, said once more and in other words.
struct Allowed {
  std::optional<std::uint32_t> first_active;  ///< epoch of the first command, where that was Active
  bool heard{false};
  bool heard_other{false};  ///< than Active
  std::set<std::uint32_t> trips{};
  std::uint32_t epoch{0};
  DeviceMode mode{DeviceMode::Off};

  void hear(DeviceMode told, std::uint32_t of) {
    if (!heard && told == DeviceMode::Active) first_active = of;
    heard = true;
    heard_other = heard_other || told != DeviceMode::Active;
    epoch = of;
    mode = told;
  }
  void wait() {
    if (mode != DeviceMode::Off) trips.insert(epoch);
  }
  /// After the newest command.
  [[nodiscard]] bool moves() const {
    return mode == DeviceMode::Active && !trips.contains(epoch) && first_active != epoch;
  }
  /// What is claimed of whatever moves.
  [[nodiscard]] bool permitted() const {
    return (heard_other || (first_active && epoch > *first_active)) && !trips.contains(epoch);
  }
};

/// Every sequence of five, of commands of each mode under the same or a higher epoch, reboots, and waits that trip the watchdog.
class EverySequence : public ::testing::TestWithParam<Inhibit> {};

TEST_P(EverySequence, MovesExactlyWhatHeardSomethingElseFirstOrAHigherEpochAndNeverAfterATripInTheSameOne) {
  constexpr int length = 5, choices = 8, commands = 6;
  constexpr int all = choices * choices * choices * choices * choices;
  Commanded robot{an_actuator(GetParam())};
  int moved = 0;
  for (int sequence = 0; sequence < all; ++sequence) {
    ASSERT_TRUE(robot.device.fault("reboot"));
    Allowed allowed;
    std::uint32_t epoch = 1 + static_cast<std::uint32_t>(sequence);  // its second inhibit never goes back
    std::string what;
    for (int step = 0, rest = sequence; step < length; ++step, rest /= choices) {
      const int choice = rest % choices;
      what += "oasOASrw"[choice];  // capitals: under a higher epoch
      if (choice < commands) {
        if (choice >= 3) ++epoch;
        const auto mode = static_cast<DeviceMode>(choice % 3);
        allowed.hear(mode, epoch);
        robot.tell(mode, epoch);
        ASSERT_EQ(robot.acts(), allowed.moves()) << what;
        ASSERT_TRUE(!robot.acts() || allowed.permitted()) << what;
        moved += robot.acts() ? 1 : 0;
      } else if (choice == commands) {
        ASSERT_TRUE(robot.device.fault("reboot"));
        allowed = {};
        ASSERT_FALSE(robot.device.active()) << what;
      } else {
        for (int k = 0; k < longer_than_the_watchdog; ++k) robot.step();
        allowed.wait();
        ASSERT_FALSE(robot.acts()) << what;
      }
    }
  }
  EXPECT_GT(moved, all / 10);
}

INSTANTIATE_TEST_SUITE_P(WhoBegins, EverySequence, ::testing::Values(Inhibit::None, Inhibit::Second),
                         [](const auto& about) {
                           return about.param == Inhibit::None ? "Alone" : "WithASecondInhibit";
                         });

}  // namespace
}  // namespace hirosco::simulation
