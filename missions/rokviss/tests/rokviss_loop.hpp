// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "subsystems/joystick/control_law.hpp"
#include "subsystems/manipulator/control/clutch.hpp"
#include "subsystems/manipulator/control/joint_controller.hpp"
#include "subsystems/manipulator/control/sensor_limits.hpp"

namespace hirosco::simulation {

/// rokviss without the framework: both worlds behind their devices, both control laws, 2 kHz, so that a figure can be
/// judged as physics and law before anything else is there to blame.
/// Delays, as the framework has them:
///   device -> subsystem: the status of cycle k-1 is read in cycle k (the world has moved by one cycle since its sample
///   was commanded);
///   subsystem -> device: the command of cycle k acts during the world's step from k to k+1;
///   link: a sample written in cycle k is read in cycle k + link_cycles; 1 each way unless told otherwise, as a
///   subsystem on another core that runs at the same instant sees its peer's last cycle.
/// Thread: one.
class RokvissLoop {
 public:
  struct Settings {
    bool friction{true};
    double force_scale{0.02};
    bool passivity{false};
    double soft_limit_n_m{12};
    double hard_limit_n_m{15};
    int link_cycles{1};
    int torque_off_cycles{20};  ///< from the trip of the limit to torque off: the most that FC1 allows
    /// FC1: from the trip on the motors may relieve a joint, not load it further, and the hand feels nothing; else all
    /// goes on until torque off.
    bool reacting{true};
    ArmParameters arm{};
    HandleParameters handle{};
  };
  struct Sensors {
    Vec2 motor_position_rad{};
    Vec2 motor_velocity_rad_s{};
    Vec2 position_rad{};
    Vec2 velocity_rad_s{};
    Vec2 torque_n_m{};
  };
  /// What both laws saw and said in the last cycle, all of one instant.
  struct Trace {
    Sensors robot{};
    Vec2 desired_rad{};
    Vec2 joystick_rad{};
    Vec2 joystick_rad_s{};
    Vec2 display_n_m{};
    Contact contact{};  ///< world truth
    Vec2 tip_m{};
  };

  explicit RokvissLoop(const Settings& settings);

  void step();
  template <class Each>
  void run_to(double time_s, const Each& each) {
    while (time_s_ < time_s) {
      step();
      each();
    }
  }
  void run_to(double time_s) {
    run_to(time_s, [] {});
  }

  [[nodiscard]] double time_s() const noexcept { return time_s_; }
  [[nodiscard]] const Trace& trace() const noexcept { return trace_; }
  [[nodiscard]] RobotDevice& robot() noexcept { return robot_; }
  [[nodiscard]] JoystickDevice& joystick() noexcept { return joystick_; }
  /// When and where the torque limit tripped; `torque_off_cycles` later the robot is off, as in Safe-Operational.
  struct Trip {
    double time_s;
    manipulator::TorqueLimit::Finding finding;
    double contact_force_n;
  };
  [[nodiscard]] bool torque_off() const noexcept { return trip_ && cycles_since_trip_ >= settings_.torque_off_cycles; }
  [[nodiscard]] const std::optional<Trip>& trip() const noexcept { return trip_; }

  static constexpr double period_s = 0.0005;

 private:
  /// A real-time link: what is written comes out `cycles` later.
  struct Sample {
    Vec2 value{};
    bool active{false};
  };
  class Link {
   public:
    explicit Link(int cycles) noexcept : cycles_{cycles} {}
    Sample pass(const Sample& written) noexcept;

   private:
    static constexpr std::size_t longest = 256;
    std::array<Sample, longest> samples_{};
    int cycles_;
    std::size_t at_{0};
  };

  void read_robot() noexcept;
  void read_joystick() noexcept;
  [[nodiscard]] Vec2 manipulator_cycle(const Sample& handle) noexcept;
  static void command(DataFlow& flow, DeviceMode mode, std::uint32_t sequence, const Vec2& torque_n_m,
                      std::size_t payload_octets) noexcept;

  Settings settings_;
  LocalFlows flows_;
  RobotDevice robot_;
  JoystickDevice joystick_;
  std::unique_ptr<DataFlow> to_robot_;
  std::unique_ptr<DataFlow> to_joystick_;

  manipulator::JointController controller_{2, period_s};
  manipulator::Clutch clutch_;
  manipulator::TorqueLimit limit_;
  joystick::PositionForce position_force_{period_s};
  joystick::PassivePositionForce passive_position_force_{period_s};
  joystick::DisplayLaw& display_;
  Link to_manipulator_;
  Link to_display_;
  std::optional<Trip> trip_;
  int cycles_since_trip_{0};
  Trace trace_;
  std::uint32_t cycle_{0};
  double time_s_{0};
};

}  // namespace hirosco::simulation
