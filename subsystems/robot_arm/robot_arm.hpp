// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "subsystems/robot_arm/commanded_arm.hpp"

namespace hirosco {

/// An arm of 1 to 16 joints whose device takes torques: all that it knows of the robot it reads from the URDF file that the setting
/// MODEL_FILE of its device names, and from its descriptor. It puts its parts into the nodes of figure 4, and tells what comes of them.
class RobotArm final : public CommandedArm {
 private:
  Result<Step> software_init() override;
  Result<> configure(const descriptor::Configuration& configuration) override;
  Result<> pre_operational(const Cycle& cycle) noexcept override;
  Result<> safe_operational(const Cycle& cycle) noexcept override;
  Result<> operational(const Cycle& cycle) noexcept override;
  Result<> error_operational(const Cycle& cycle) noexcept override;
  Result<Step> self_test(const Cycle& cycle) noexcept override { return self_check_.step(cycle); }

  void measure(const Cycle& cycle) noexcept;
  void engage() noexcept;
  void control() noexcept;
  void advance() noexcept;
  void advance_homing() noexcept;
  [[nodiscard]] bool keep_from_acting() noexcept;
  void tell(const robot_arm::Guidance::News& news) noexcept;
  void tell(const robot_arm::Lead::End& end) noexcept;
  void watch(bool follows) noexcept;
  void watch_clearance() noexcept;
  void watch_contact() noexcept;
};

[[nodiscard]] std::unique_ptr<Subsystem> make_robot_arm();

}  // namespace hirosco
