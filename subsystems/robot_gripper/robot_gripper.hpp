// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "robotics/dynamics/model.hpp"
#include "robotics/subsystem/moving_subsystem.hpp"
#include "robotics/urdf/named_robot.hpp"
#include "subsystems/robot_gripper/control/grip.hpp"
#include "subsystems/robot_gripper/control/opening.hpp"
#include "subsystems/robot_gripper/control/watch.hpp"
#include "subsystems/robot_gripper/robot_gripper_data.hpp"

namespace hirosco {

/// A gripper of 1 to 4 driven finger joints whose device takes torques: all that it knows of them it reads from the URDF file that the
/// setting MODEL_FILE of its device names, and from its descriptor. What it holds it lets go of when it is told to open, and at nothing else.
class RobotGripper final : public robotics::MovingSubsystem {
 public:
  /// Author's failure codes: why a function was refused or ended without its effect.
  enum class Trouble : std::uint16_t {
    width_not_reached = 0x8001,
    out_of_range = 0x8002,
    limit_tripped = 0x8003,
    obstructed = 0x8004,  ///< something is in the way
    nothing_met = 0x8005,
    actuators_inhibited = 0x8006,
    too_slow = 0x8007,  ///< longer than a telecommand is waited for
    force_not_reached = 0x8008,
    no_goal = 0x8009,  ///< it is there already
    is_held = 0x800A,  ///< something is held: GRIP with another force, or open
    object_lost = 0x800B,
  };

  RobotGripper() noexcept
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
  [[nodiscard]] Result<> find_fingers(std::vector<std::string> wanted);
  [[nodiscard]] std::unexpected<Error> refuse(ErrorCode code, std::string why);
  [[nodiscard]] Result<robot_gripper::Fingers> fingers_now();
  [[nodiscard]] Result<> take_values() noexcept;
  [[nodiscard]] Result<> check_lengths() noexcept;
  [[nodiscard]] Result<> check_sensors() noexcept;
  [[nodiscard]] Result<> check_law(double side) noexcept;

  void measure(const Cycle& cycle) noexcept;
  void recognise() noexcept;
  void engage() noexcept;
  void advance() noexcept;
  void follow_path() noexcept;
  void back_off() noexcept;
  void follow_grip() noexcept;
  void control() noexcept;
  void tell_gap() noexcept;
  void watch() noexcept;
  void watch_held() noexcept;
  void stand() noexcept override;
  [[nodiscard]] Outcome may_move() const noexcept;
  [[nodiscard]] double most_force_n() const noexcept;
  Outcome move_to(double width_m, double speed_m_s, const Call& call) noexcept;
  Outcome grip(double force_n, double speed_m_s, const Call& call) noexcept;

  Parameter<robot_gripper::CurrentValues> current_;
  Parameter<robot_gripper::GapValues> gap_values_;
  Parameter<robot_gripper::Joints> rotor_inertia_;
  Parameter<double> full_width_m_, empty_width_m_, lost_distance_m_, width_tolerance_m_, following_limit_m_;
  Parameter<double> force_tolerance_, felt_force_n_, move_force_n_, force_hard_, speed_limit_;
  Parameter<double> bandwidth_rad_s_, acceleration_, jerk_;
  Parameter<std::uint8_t> active_;
  Event<> motion_done_{"MOTION_DONE"};
  Event<double, double> held_told_{"OBJECT_HELD"};  ///< m, N
  Event<double, double> lost_told_{"OBJECT_LOST"};  ///< m: now, and where it was held
  Event<double> released_{"OBJECT_RELEASED"}, nothing_met_{"NOTHING_MET"};  ///< m
  /// Joint from 1, what was measured, the limit.
  Event<std::uint8_t, double, double> position_exceeded_{"POSITION_LIMIT_EXCEEDED"},
      speed_exceeded_{"SPEED_LIMIT_EXCEEDED"}, force_exceeded_{"FORCE_LIMIT_EXCEEDED"};
  DevicePort<robot_gripper::GripperInput, robot_gripper::GripperOutput> device_;

  std::optional<robotics::Model> model_;
  std::vector<std::size_t> finger_joints_;  ///< of the model, in its order
  bool closed_is_upper_{false};
  robotics::urdf::NotRead not_read_;  ///< of its file or settings, for whoever reads the refusal
  robot_gripper::Fingers fingers_;
  robot_gripper::Joints links_moved_;  ///< by each finger joint, without its rotor
  robot_gripper::Opening opening_;
  robot_gripper::Grip grip_;
  robot_gripper::Held held_;
  robot_gripper::Watch watch_;
  robot_gripper::Measured measured_;
  double width_m_{0}, speed_m_s_{0}, force_n_{0};
  double held_force_n_{0}, grip_speed_m_s_{0.02};
  double cycle_s_{0.001};
  double goal_m_{0};
  double waited_s_{0};  ///< behind the end of a path, or pressing
  double settled_s_{0};  ///< at the goal
  double behind_s_{0};  ///< farther behind than it may be
  bool reported_{false};
  std::size_t tried_{0};
};

[[nodiscard]] std::unique_ptr<Subsystem> make_robot_gripper();

}  // namespace hirosco
