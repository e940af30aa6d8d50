// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "subsystems/robot_arm/control/watch.hpp"
#include "subsystems/robot_arm/floating/commanded_floating_arm.hpp"

namespace hirosco {

/// An arm on a base that floats: it moves its joints, or its tool in inertial axes by the pose of the base that somebody else measures.
/// What the robot is it reads from the URDF file that the setting MODEL_FILE of its device names. It puts its parts into the nodes of figure 4, and
/// tells what comes of them.
class FloatingArm final : public CommandedFloatingArm {
 private:
  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle& cycle) noexcept override;
  Result<> safe_operational(const Cycle& cycle) noexcept override;
  Result<> operational(const Cycle& cycle) noexcept override;
  Result<> error_operational(const Cycle& cycle) noexcept override;

  void measure(const Cycle& cycle) noexcept;
  void advance() noexcept;
  void control(bool moves) noexcept;
  void watch(bool free) noexcept;
  void watch_work(bool free) noexcept;
  void tell(const robot_arm::Lead::End& end) noexcept;
  [[nodiscard]] bool tripped() const noexcept { return watch_.tripped() || work_.tripped(); }
  void watch_contact() noexcept;
  [[nodiscard]] bool may_act() noexcept;
  void stop_before(const robot_arm::EndAhead& end) noexcept;
  void watch_clearance(const robot_arm::JointVector& rates, bool moves) noexcept;
  void tell_ill_conditioned(double conditioning) noexcept;

  Event<> motion_done_{"MOTION_DONE"};
  Event<double> conditioning_low_{"CONDITIONING_LOW"};
  Event<> base_held_{"BASE_IS_HELD"};
  /// Joint from 1, what was measured, the limit.
  Event<std::uint8_t, double, double> limit_exceeded_{"LIMIT_EXCEEDED"}, hard_exceeded_{"TORQUE_HARD_EXCEEDED"};
  /// Joint from 1, where it is, the end of its range.
  Event<std::uint8_t, double, double> range_end_near_{"RANGE_END_NEAR"};

  using PairNames = Text<64>;
  Event<double, PairNames> too_near_{"TOO_NEAR"};  ///< m, and who

  robot_arm::Watch watch_;
};

[[nodiscard]] std::unique_ptr<Subsystem> make_floating_arm();

}  // namespace hirosco
