// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "hirosco/subsystem/author/subsystem.hpp"
#include "subsystems/robot_arm/abort_path.hpp"
#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_guidance.hpp"
#include "subsystems/robot_arm/floating/floating_parameters.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco {

/// An arm on a base that floats: it moves its joints, or its tool in inertial axes by the pose of the base that somebody else measures.
/// What the robot is it reads from the URDF file that the setting MODEL_FILE of its device names. It puts its parts into the nodes of figure 4, and
/// tells what comes of them.
class FloatingArm final : public Subsystem {
 public:
  FloatingArm() = default;

 private:
  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle& cycle) noexcept override;
  Result<> safe_operational(const Cycle& cycle) noexcept override;
  Result<> operational(const Cycle& cycle) noexcept override;
  Result<> error_operational(const Cycle& cycle) noexcept override;

  using Out = robot_arm::FloatingWayOut::By;

  void bind_functions();
  void bind_ways_out();
  [[nodiscard]] Result<> check_lengths() noexcept;

  void measure(const Cycle& cycle) noexcept;
  void advance() noexcept;
  void finish_call() noexcept;
  void control(bool moves) noexcept;
  void watch() noexcept;
  [[nodiscard]] bool may_act() noexcept;
  void stop_before(const robot_arm::EndAhead& end) noexcept;
  void watch_clearance(const robot_arm::JointVector& rates, bool moves) noexcept;
  void tell_ill_conditioned(double conditioning) noexcept;
  template <FailureEnumeration Code>
  void end_motion(Code why, std::int64_t number = 0, const char* text = "") noexcept;
  void hold() noexcept;
  [[nodiscard]] Outcome may_move() const noexcept;
  [[nodiscard]] Outcome may_leave() const noexcept;
  Outcome leave(Out by, double number, const Call& call) noexcept;
  Outcome check_abort(const Call& call) noexcept;
  [[nodiscard]] bool offers(const char* function) const { return own_descriptor().find_function(function) != nullptr; }
  [[nodiscard]] Outcome started(const Outcome& outcome, const Call& call) noexcept;

  robot_arm::FloatingParameters parameters_;
  Event<> motion_done_{"MOTION_DONE"};
  Event<double> conditioning_low_{"CONDITIONING_LOW"};
  Event<> base_held_{"BASE_IS_HELD"};
  /// Joint from 1, what was measured, the limit.
  Event<std::uint8_t, double, double> limit_exceeded_{"LIMIT_EXCEEDED"}, hard_exceeded_{"TORQUE_HARD_EXCEEDED"};
  /// Joint from 1, where it is, the end of its range.
  Event<std::uint8_t, double, double> range_end_near_{"RANGE_END_NEAR"};

  using PairNames = Text<64>;
  Event<double, PairNames> too_near_{"TOO_NEAR"};  ///< m, and who
  Event<double> retracted_{"RETRACTED"};  ///< how far, rad or m

  // Each refers to some of those before it.
  robot_arm::UrdfArm known_;
  robot_arm::Drives drives_{parameters_.current};
  robot_arm::FloatingCraft craft_{{known_, drives_, parameters_}};
  robot_arm::Obstacles obstacles_{{parameters_.clearance_limit_m, parameters_.clearance_m, parameters_.keep_out}};
  robot_arm::AbortPath abort_path_{{known_, obstacles_}};
  robot_arm::FloatingGuidance guidance_{{known_, drives_, craft_, obstacles_, parameters_, abort_path_}};
  robot_arm::Watch watch_;
  std::optional<Call> motion_;
  bool moving_{false};  ///< what is put out reaches the joints
  bool braked_{false};  ///< by BRAKE or a finding, until the next entry into Operational
};

[[nodiscard]] std::unique_ptr<Subsystem> make_floating_arm();

}  // namespace hirosco
