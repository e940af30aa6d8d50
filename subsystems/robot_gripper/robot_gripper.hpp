// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "robotics/subsystem/moving_subsystem.hpp"
#include "subsystems/robot_gripper/control/watch.hpp"
#include "subsystems/robot_gripper/drives.hpp"
#include "subsystems/robot_gripper/handling.hpp"
#include "subsystems/robot_gripper/parameters.hpp"
#include "subsystems/robot_gripper/self_check.hpp"
#include "subsystems/robot_gripper/trouble.hpp"
#include "subsystems/robot_gripper/urdf_fingers.hpp"

namespace hirosco {

/// A gripper of 1 to 4 driven finger joints whose device takes torques: all that it knows of them it reads from the URDF file that the
/// setting MODEL_FILE of its device names, and from its descriptor. What it holds it lets go of when it is told to open, and at nothing else.
/// It puts its parts into the nodes of figure 4, and tells what comes of them.
class RobotGripper final : public robotics::MovingSubsystem {
 public:
  RobotGripper() noexcept
      : MovingSubsystem{{.inhibited = static_cast<pus::FailureCode>(robot_gripper::Trouble::actuators_inhibited),
                         .limit_tripped = static_cast<pus::FailureCode>(robot_gripper::Trouble::limit_tripped)}} {}

 private:
  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle& cycle) noexcept override;
  Result<> safe_operational(const Cycle& cycle) noexcept override;
  Result<> operational(const Cycle& cycle) noexcept override;
  Result<> error_operational(const Cycle& cycle) noexcept override;
  Result<Step> self_test(const Cycle& cycle) noexcept override { return self_check_.step(cycle); }
  void stand() noexcept override { handling_.stand(); }

  void bind_functions();
  [[nodiscard]] Result<> take_values() noexcept;

  void measure(const Cycle& cycle) noexcept;
  void recognise() noexcept;
  void advance() noexcept;
  void tell(const robot_gripper::MotionProgress::News& news) noexcept;
  void complete_motion() noexcept;
  void watch() noexcept;
  void watch_held() noexcept;
  [[nodiscard]] Outcome may_move() const noexcept;
  Outcome move_to(double width_m, double speed_m_s, const Call& call) noexcept;
  Outcome grip(double force_n, double speed_m_s, const Call& call) noexcept;

  robot_gripper::Parameters parameters_;
  Event<> motion_done_{"MOTION_DONE"};
  Event<double, double> held_told_{"OBJECT_HELD"};  ///< m, N
  Event<double, double> lost_told_{"OBJECT_LOST"};  ///< m: now, and where it was held
  Event<double> released_{"OBJECT_RELEASED"}, nothing_met_{"NOTHING_MET"};  ///< m
  /// Joint from 1, what was measured, the limit.
  Event<std::uint8_t, double, double> position_exceeded_{"POSITION_LIMIT_EXCEEDED"},
      speed_exceeded_{"SPEED_LIMIT_EXCEEDED"}, force_exceeded_{"FORCE_LIMIT_EXCEEDED"};

  // Each refers to some of those before it.
  robot_gripper::UrdfFingers known_;
  robot_gripper::Drives drives_{known_.fingers(), parameters_};
  robot_gripper::Handling handling_{{known_.fingers(), drives_, parameters_}};
  robot_gripper::SelfCheck self_check_{{known_.fingers(), drives_, handling_, parameters_}};
  robot_gripper::Watch watch_;
  double cycle_s_{0.001};
};

[[nodiscard]] std::unique_ptr<Subsystem> make_robot_gripper();

}  // namespace hirosco
