// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robotics/dynamics/dynamics.hpp"
#include "robotics/shapes/clearance.hpp"
#include "robotics/subsystem/moving_subsystem.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_arm/control/laws.hpp"
#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/control/setpoints.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"

namespace hirosco {

/// An arm of 1 to 16 joints whose device takes torques: all that it knows of the robot it reads from the URDF file that the setting
/// MODEL_FILE of its device names, and from its descriptor.
class RobotArm final : public robotics::MovingSubsystem {
 public:
  /// Author's failure codes: why a function was refused or ended without its effect.
  enum class Trouble : std::uint16_t {
    goal_not_reached = 0x8001,
    out_of_range = 0x8002,  ///< a joint would leave its range
    limit_tripped = 0x8003,
    contact = 0x8004,
    load_above_limit = 0x8005,
    actuators_inhibited = 0x8006,
    too_slow = 0x8007,  ///< longer than a telecommand is waited for
    line_lost = 0x8008,  ///< the joints cannot follow the line
    no_goal = 0x8009,  ///< it is no place, or where it stands already
    too_near = 0x800A,  ///< to itself, or to a volume that it keeps out of
    too_stiff = 0x800B,  ///< a spring that would swing faster than the law may
    led = 0x800C,  ///< it gives way to whoever leads it: HOLD first
  };
  /// Of a contact.
  enum class Reaction : std::uint8_t {
    None,
    Stop,  ///< stands where it was met
    Float,  ///< gives way from then on
    Retract,  ///< backs off by the way it came, then stands
  };

  RobotArm() noexcept
      : MovingSubsystem{{.inhibited = static_cast<pus::FailureCode>(Trouble::actuators_inhibited),
                         .limit_tripped = static_cast<pus::FailureCode>(Trouble::limit_tripped)}} {}

 private:
  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle& cycle) noexcept override;
  Result<> safe_operational(const Cycle& cycle) noexcept override;
  Result<> operational(const Cycle& cycle) noexcept override;
  Result<> error_operational(const Cycle& cycle) noexcept override;
  Result<Step> self_test(const Cycle& cycle) noexcept override;

  void publish_all();
  void bind_functions();
  [[nodiscard]] Result<> read_model();
  [[nodiscard]] Result<> read_shapes(const std::filesystem::path& file, std::string_view text);
  [[nodiscard]] Result<> take_bounds();
  [[nodiscard]] Result<> check_lengths() noexcept;

  void measure(const Cycle& cycle) noexcept;
  void engage() noexcept;
  void advance() noexcept;
  void control() noexcept;
  void watch(bool follows) noexcept;
  void watch_contact() noexcept;
  void react() noexcept;
  void watch_yielding() noexcept;
  void take_law(robot_arm::LawKind kind) noexcept;
  void stand() noexcept override;
  void motion_ended() noexcept override { jog_left_s_ = 0; }
  void end_retract() noexcept;
  [[nodiscard]] robot_arm::JointVector ahead_of_setpoint() const noexcept;
  void watch_clearance() noexcept;
  void lose_line() noexcept;
  void arrive() noexcept;
  [[nodiscard]] bool in_range(const robot_arm::JointVector& goal) const noexcept;
  [[nodiscard]] Outcome may_move() const noexcept;
  [[nodiscard]] bool floats() const noexcept { return laws_->kind() == robot_arm::LawKind::Float; }
  [[nodiscard]] Outcome start(const Result<>& planned, const Call& call) noexcept;
  [[nodiscard]] robot_arm::Payload payload() const noexcept;
  [[nodiscard]] robot_arm::Laws::Settings law_settings() noexcept;
  [[nodiscard]] Result<> check_sensors() noexcept;
  [[nodiscard]] Result<> check_law(std::size_t joint, double side) noexcept;

  Outcome move_j(const FunctionValues& values, const Call& call) noexcept;
  Outcome move_l(const FunctionValues& values, const Call& call) noexcept;
  Outcome jog_j(const FunctionValues& values, const Call& call) noexcept;
  Outcome jog_l(const FunctionValues& values, const Call& call) noexcept;
  void bind_laws();
  Outcome soften(robot_arm::LawKind kind, const robot_arm::Impedance& impedance) noexcept;
  Outcome harden() noexcept;
  Outcome set_torque_limit(double share) noexcept;
  Outcome keep_out(const robot_arm::KeepOut& numbers) noexcept;

  Parameter<robot_arm::CurrentValues> current_;
  Parameter<robot_arm::Joints> rotor_inertia_, desired_position_, desired_velocity_, external_torque_, joint_stiffness_;
  Parameter<robot_arm::ToolValues> tool_values_;
  Parameter<robot_arm::MotionValues> motion_values_;
  Parameter<robot_arm::PayloadValues> payload_values_;
  Parameter<robot_arm::ContactValues> contact_values_;
  Parameter<robot_arm::LawValues> law_values_;
  Parameter<std::array<double, 3>> gravity_m_s2_, tool_place_m_;
  Parameter<double> bandwidth_rad_s_, acceleration_, jerk_, goal_tolerance_;
  Parameter<double> torque_limit_, torque_hard_, speed_limit_, following_limit_;
  Parameter<double> clearance_limit_m_, clearance_m_;
  Parameter<double> float_damping_, retract_distance_;
  Parameter<robot_arm::KeepOut> keep_out_;
  Parameter<std::uint8_t> active_;
  Event<> motion_done_{"MOTION_DONE"};
  /// Joint from 1, what was measured, the limit.
  Event<std::uint8_t, double, double> position_exceeded_{"POSITION_LIMIT_EXCEEDED"},
      speed_exceeded_{"SPEED_LIMIT_EXCEEDED"}, torque_exceeded_{"TORQUE_LIMIT_EXCEEDED"},
      torque_hard_exceeded_{"TORQUE_HARD_EXCEEDED"}, following_exceeded_{"FOLLOWING_LIMIT_EXCEEDED"};
  /// Besides, how it reacts.
  Event<std::uint8_t, double, double, std::uint8_t> contact_{"CONTACT"};
  Event<double> retracted_{"RETRACTED"};  ///< how far, rad or m
  Event<double> too_near_{"TOO_NEAR"};  ///< m
  DevicePort<robot_arm::ArmInput, robot_arm::ArmOutput> device_;

  std::optional<robotics::Model> model_;
  robotics::FrameId tip_;
  robotics::urdf::NotRead not_read_;  ///< of its file or settings, for whoever reads the refusal
  std::vector<robot_arm::JointBounds> bounds_;
  std::optional<robotics::Dynamics> dynamics_;
  std::optional<robot_arm::Laws> laws_;
  std::optional<robot_arm::MomentumObserver> observer_;
  std::optional<robot_arm::Setpoints> setpoints_;
  std::optional<robotics::Clearance> clearance_;
  robot_arm::Watch watch_;
  robotics::State model_state_;
  robot_arm::Measured measured_;
  robot_arm::Joints rotor_;
  robot_arm::JointVector goal_;
  std::optional<robot_arm::Vector3> line_to_;  ///< where the tool is to be at the end of its line
  double cycle_s_{0.001};
  std::size_t tried_{0};  ///< in a self test: each joint to each side
  std::uint32_t contact_cycles_{0};
  double waited_s_{0};  ///< behind the end of a path
  double settled_s_{0};  ///< at the goal
  double jog_left_s_{0};
  bool retracting_{false};
  bool half_reported_{false};
  bool arrives_{false};  ///< its motion has a goal
};

[[nodiscard]] std::unique_ptr<Subsystem> make_robot_arm();

}  // namespace hirosco
