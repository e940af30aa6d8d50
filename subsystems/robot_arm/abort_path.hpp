// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/parameter/parameter.hpp"
#include "subsystems/robot_arm/control/abort_way.hpp"
#include "subsystems/robot_arm/no_way_out.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"
#include "subsystems/robot_arm/urdf_arm.hpp"

namespace hirosco::robot_arm {

/// The abort path of an arm, on whatever base, as it is stored (docs/adr/0199), and what keeps the arm from going out by it. What is written meanwhile is the next one's.
/// To judge it takes no longer than ABORT_JUDGING_LIMIT (docs/adr/0209): a posture in a cycle, and no more of them than cycles that long.
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
    publish("ABORT_JUDGED", judged_);
    publish("ABORT_JUDGING_LIMIT", limit_s_);
  }
  /// In configure(): of another number of joints than the robot has.
  [[nodiscard]] bool has_length(std::size_t joints) const noexcept;

  /// In configure().
  void begin_cycles(double cycle_s) noexcept { cycle_s_ = cycle_s; }

  /// Takes it as it is stored, or says why it is not judged: there is none, a posture is beyond the range of a joint, or to look at all of it takes too long.
  [[nodiscard]] std::optional<NoWayOut> begin(const JointVector& here, AbortWay::Judged what) noexcept;
  /// Judges on by a posture, while it has found nothing yet.
  AbortWay::Found judge() noexcept;
  /// Of what was found to be Nothing, or TooLong.
  [[nodiscard]] NoWayOut why() const noexcept;
  /// What was judged.
  [[nodiscard]] const AbortWay& way() const noexcept { return way_; }
  /// ABORT_POSTURE: from 1, of the way to which it is told; 0: none.
  void tell(std::size_t posture) noexcept { told_.store(static_cast<std::uint8_t>(posture)); }

 private:
  [[nodiscard]] std::optional<NoWayOut> fit(JointVector& posture, std::size_t number) const noexcept;
  [[nodiscard]] std::size_t most_looks() const noexcept;

  Parts parts_;
  Parameter<AbortPathValues> stored_;
  Parameter<std::uint8_t> told_;
  Parameter<double> judged_;  ///< 0 to 1
  Parameter<double> limit_s_;
  double cycle_s_{0.001};
  AbortWay way_;
};

}  // namespace hirosco::robot_arm
