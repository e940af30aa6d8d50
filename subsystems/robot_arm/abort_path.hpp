// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/control/abort_way.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// The abort path as it is stored (docs/adr/0199), and what keeps the arm from going out by it. What is written meanwhile is the next one's.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class AbortPath {
 public:
  struct Parts {
    const UrdfArm& known;
    Obstacles& obstacles;
  };
  explicit AbortPath(const Parts& parts) noexcept : parts_{parts} {}

  /// Whether the descriptor has one.
  [[nodiscard]] static bool declared(const descriptor::SubsystemDescriptor& subsystem);
  /// Calls `publish(name, cell)` for each parameter of it.
  template <class Publish>
  void each(const Publish& publish) {
    publish("ABORT_PATH", stored_);
    publish("ABORT_POSTURE", told_);
  }
  /// In configure(): of another number of joints than the robot has.
  [[nodiscard]] bool has_length(std::size_t joints) const noexcept;

  /// Takes it as it is stored. Refused: there is none, or a posture is beyond the range of a joint.
  [[nodiscard]] Outcome begin(const JointVector& here, AbortWay::Judged what) noexcept;
  /// Judges on by a posture, while it has found nothing yet.
  AbortWay::Found judge() noexcept;
  /// What was judged.
  [[nodiscard]] const AbortWay& way() const noexcept { return way_; }
  /// ABORT_POSTURE: from 1, of the way to which it is told; 0: none.
  void tell(std::size_t posture) noexcept { told_.store(static_cast<std::uint8_t>(posture)); }

 private:
  [[nodiscard]] Outcome fit(JointVector& posture, std::size_t number) const noexcept;

  Parts parts_;
  Parameter<AbortPathValues> stored_;
  Parameter<std::uint8_t> told_;
  AbortWay way_;
};

}  // namespace hirosco::robot_arm
