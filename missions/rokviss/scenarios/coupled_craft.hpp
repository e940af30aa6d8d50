// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "simulation/devices/joystick/joystick_device.hpp"
#include "simulation/devices/robot/robot_device.hpp"
#include "simulation/spacecraft/observed_flight.hpp"

namespace hirosco::simulation {

/// Errors put into the model on purpose, as factors where nothing else is said: a report that cannot see them shows nothing.
struct Plant {
  double stiffness{1};  ///< of the flexible joints
  double rail{1};  ///< stiffness of the contour
  double mass{1};  ///< of both links, with their inertias
  double force_scale{1};  ///< of what the hand feels
  double hand_clock{1};  ///< how fast time passes for the hand and its handle
  double sub_step{1};  ///< of the robot's world: largest step of its integrator
  double delay_ms{0};  ///< no factor: by which what the joystick tells comes later
};

struct CraftOptions {
  std::filesystem::path mission;  ///< the mission file
  std::uint64_t seed{1};
  Plant plant{};
  /// Initial values of parameters, by "SUBSYSTEM.PARAMETER", over those of the descriptors.
  std::map<std::string, double> initial{};
  std::string start_mode{};  ///< empty = the mission's
  bool friction{true};
  double bump_m{0.010};  ///< height of the contour's bump, in the world
  bool hand_of_mission{false};  ///< else the hand rests until told
  /// Of the manipulator's report 4713, so that a peak between two is no more than 0.01 % higher; 0 = as in the mission.
  std::uint32_t cycles_per_report{10};
};

/// rokviss in its start mode on the whole spacecraft, with what the scenarios want to see at cycle rate.
class CoupledCraft {
 public:
  static constexpr double period_s = 0.0005;

  /// Throws std::runtime_error with the supervisor's story when the mission cannot be commissioned.
  explicit CoupledCraft(const CraftOptions& options);

  [[nodiscard]] Flight& flight() noexcept { return flight_; }
  [[nodiscard]] Spacecraft& craft() noexcept { return flight_.craft(); }
  /// A line of the operator's hand (JoystickDevice::hand); throws std::runtime_error for one that it does not take.
  void hand(const std::string& line);
  void run(double seconds);
  /// A function from ground; throws std::runtime_error unless it is completed.
  void command(std::string_view subsystem, std::string_view function, const std::vector<Value>& arguments);
  /// Since commissioning.
  [[nodiscard]] double time_s() { return seconds(craft().now() - start_); }
  /// Called once per control cycle, when both subsystems have done theirs.
  void each_cycle(std::function<void()> watch);

  [[nodiscard]] const RobotDevice& robot() const noexcept { return *robot_; }
  [[nodiscard]] const JoystickDevice& joystick() const noexcept { return *joystick_; }
  [[nodiscard]] const TwoJointArm& arm() const noexcept { return robot_->arm(); }
  /// Largest absolute torque or value of the hand's display.
  [[nodiscard]] Vec2 felt_n_m() const noexcept { return joystick_->motor_torque_n_m(); }

  /// From the manipulator's report 4713, of one cycle.
  struct Report {
    Vec2 position_rad{}, torque_n_m{}, desired_rad{};
  };
  [[nodiscard]] const Report& report() const noexcept { return report_; }
  std::function<void()> on_report;
  /// What a subsystem says of its incoming links, by APID: LINK_STATS of reports 4714 and 4723, once a second.
  struct Incoming {
    std::uint32_t received{0};
    std::uint32_t lost{0};
  };
  [[nodiscard]] const std::map<std::uint16_t, Incoming>& incoming() const noexcept { return incoming_; }

 private:
  static Plan plan_of(const CraftOptions& options);
  void take(const pus::TelemetryView& packet);
  void delay_joystick(double delay_ms);

  Flight flight_;
  RobotDevice* robot_{nullptr};
  JoystickDevice* joystick_{nullptr};
  Report report_{};
  std::map<std::uint16_t, Incoming> incoming_;
  TimePoint start_{};
};

}  // namespace hirosco::simulation
