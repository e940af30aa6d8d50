// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/utilities/result.hpp"
#include "subsystems/robot_arm/control/preferred_posture.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"
#include "subsystems/robot_arm/trouble.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// The posture that an arm prefers (docs/adr/0219), as it is written: to it go joints that a pose or a line of the tool leaves free. Whose descriptor does not have it prefers
/// where it stands.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Posture {
 public:
  explicit Posture(const UrdfArm& known) noexcept : known_{known} {}

  /// Whether the descriptor has it.
  [[nodiscard]] static bool declared(const descriptor::SubsystemDescriptor& subsystem);
  /// Calls `publish(name, cell)` for each parameter of it.
  template <class Publish>
  void each(const Publish& publish) {
    publish("POSTURE", joints_);
    publish("POSTURE_GAIN", gain_per_s_);
  }
  /// In configure().  Mismatch: of another number of joints than the robot has. OutOfRange: one that counts, and is beyond the range of this joint, from 1.
  [[nodiscard]] Result<> check(const descriptor::SubsystemDescriptor& subsystem) const noexcept;

  /// As it is written now.
  [[nodiscard]] PreferredPosture preferred() const noexcept { return {vector_of(joints_.load()), gain_per_s_.load()}; }
  /// Why nobody goes by that: the first joint that could not stand there.
  [[nodiscard]] std::optional<Reason> unfit(const PreferredPosture& preferred) const noexcept;

 private:
  const UrdfArm& known_;
  Parameter<Joints> joints_;
  Parameter<double> gain_per_s_;
};

}  // namespace hirosco::robot_arm
