// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/guidance.hpp"
#include "subsystems/robot_arm/homing.hpp"
#include "subsystems/robot_arm/lead.hpp"
#include "subsystems/robot_arm/torque_control.hpp"

namespace hirosco::robot_arm {

/// Whether what a telecommand asks for may begin now: refused, or running.
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class MotionRules {
 public:
  struct Parts {
    const Guidance& guidance;
    const TorqueControl& control;
    const Lead& lead;
    const Homing& homing;
  };
  struct Now {
    bool moving{false};  ///< what is put out reaches the actuators
    bool called{false};  ///< a motion or STOP is under way
  };
  explicit MotionRules(const Parts& parts) noexcept : parts_{parts} {}

  [[nodiscard]] Outcome may_move(const Now& now) const noexcept;
  [[nodiscard]] Outcome may_change_law(const Now& now) const noexcept;
  /// To a law of springs, or of dampers alone.
  [[nodiscard]] Outcome may_soften(const Now& now) const noexcept;
  /// Nothing moves for CHECK_ABORT: in Safe-Operational it needs no actuators. In Operational without them nothing goes on that was begun.
  [[nodiscard]] Outcome may_check(const Now& now, bool operational) const noexcept;
  /// Whoever wants the arm out of where it is need not wait until it stands, where it comes to rest by itself. A stop is none of that: it ends in brakes. Who is inhibited, or
  /// floats, is refused as for any motion.
  [[nodiscard]] bool may_wait_for_rest(const Now& now) const noexcept;

  /// HOME, and nothing else in a configuration that homes.
  [[nodiscard]] Outcome may_home(const Now& now) const noexcept;

 private:
  [[nodiscard]] Outcome is_free(const Now& now) const noexcept;

  Parts parts_;
};

}  // namespace hirosco::robot_arm
