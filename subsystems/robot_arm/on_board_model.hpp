// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "subsystems/robot_arm/control/law.hpp"
#include "subsystems/robot_arm/control/momentum_observer.hpp"
#include "subsystems/robot_arm/control/tool_lever.hpp"
#include "subsystems/robot_arm/drives.hpp"
#include "subsystems/robot_arm/force_sensor.hpp"
#include "subsystems/robot_arm/parameters.hpp"
#include "subsystems/robot_arm/tool_work.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// The on-board model in the posture that is measured: its dynamics, what hangs at the tool, where that is, and what acts on the joints from outside.
/// Realtime: bounded, but begin(). Thread: the cycle, and the service loop while there is none.
class OnBoardModel {
 public:
  /// Of the filter of what acts from outside.
  static constexpr double observer_gain_per_s = 50;

  struct Parts {
    const UrdfArm& known;
    const Drives& drives;
    Parameters& parameters;  ///< TOOL and EXTERNAL_TORQUE tell what it finds
    ToolWork& work;  ///< what acts on the tool, and how fast that is
  };
  explicit OnBoardModel(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure().  Realtime: allocates. Thread: the service loop.
  void begin(double cycle_s);
  /// Takes what is measured, and tells what follows.
  void update() noexcept;
  /// There was an update() since begin().
  [[nodiscard]] bool updated() const noexcept { return updated_; }
  /// Something else hangs at the tool: what acts from outside is felt anew.
  void forget_external() noexcept;
  /// What is felt by now brakes held: of the force at the tool it is none, and what the filter still has of it fades. Contacts count it as ever.
  void forget_brakes() noexcept { brakes_ = external(); }

  /// Of update(), gravity included.
  [[nodiscard]] robotics::Dynamics& dynamics() noexcept { return *dynamics_; }
  /// N m or N of each joint, in the direction in which it would accelerate it.
  [[nodiscard]] const JointVector& external() const noexcept { return observer_->external(); }
  [[nodiscard]] const ToolLever& lever() const noexcept { return lever_; }
  [[nodiscard]] Payload payload() const noexcept;
  /// At the tip, for a sensor there.
  [[nodiscard]] ForceSensor::Hanging hanging() const noexcept;
  /// What each joint would hold in the posture of update() if this hung at the tool.
  [[nodiscard]] JointVector held(const Payload& payload) noexcept;

 private:
  void tell_work() noexcept;

  Parts parts_;
  std::optional<robotics::Dynamics> dynamics_;
  std::optional<MomentumObserver> observer_;
  ToolLever lever_;
  JointVector brakes_;  ///< what the observer still has of them: it fades as that forgets
  robotics::State state_;
  bool updated_{false};
};

}  // namespace hirosco::robot_arm
