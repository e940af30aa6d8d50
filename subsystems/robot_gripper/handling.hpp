// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_gripper/control/grip.hpp"
#include "subsystems/robot_gripper/control/motion_progress.hpp"
#include "subsystems/robot_gripper/control/opening.hpp"
#include "subsystems/robot_gripper/drives.hpp"

namespace hirosco::robot_gripper {

/// What the fingers are to do, from cycle to cycle: keep a width, go to one, close on something, press on what they hold. What is held is let
/// go of by move_to() alone. It reports nothing: it says what is to be told.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class Handling {
 public:
  struct Parts {
    const Fingers& fingers;
    Drives& drives;
    Parameters& parameters;  ///< GAP tells what it does
  };
  explicit Handling(const Parts& parts) noexcept : parts_{parts} {}

  /// The fingers and what parameters say now; engage() follows before control().
  void take_values(double cycle_s) noexcept;
  /// Nothing is held, as far as it knows.
  void forget() noexcept { held_ = {}; }

  // --- where actuators begin and end --------------------------------------------------------------------------------------
  /// Moves nothing: it keeps the width, or goes on pressing on what it holds as hard as it did.
  void engage() noexcept;
  /// Keeps this width from now on.
  void keep(double width_m) noexcept;
  /// Comes to rest where it is. Who presses goes on: nothing is let go of that was not told to be.
  void stand() noexcept;
  /// Who was configured anew, or died, has forgotten what he held: brakes that press on something tell him. True: it holds something that it
  /// did not know of.
  [[nodiscard]] bool recognise() noexcept;

  // --- functions: refused, or running -------------------------------------------------------------------------------------
  /// To a width, m, with at most this speed, m/s. Lets go of what it holds, but does not press on it.
  [[nodiscard]] Outcome move_to(double width_m, double speed_m_s) noexcept;
  /// Closes with this speed, m/s, until it meets something, and presses on it with this force, N.
  [[nodiscard]] Outcome grip(double force_n, double speed_m_s) noexcept;

  // --- in each cycle ------------------------------------------------------------------------------------------------------
  /// Whether what is held still is. Who closes on nothing stands; who was forced open goes on pressing, as what forced it may still be there.
  [[nodiscard]] Held::Change watch_held() noexcept;
  /// `awaited`: somebody waits for the motion that was begun last.
  [[nodiscard]] MotionProgress::News advance(bool awaited) noexcept;
  /// The law: what it finds is put out and told.
  void control() noexcept;
  /// GAP.
  void tell() noexcept;

  [[nodiscard]] bool holds() const noexcept { return held_.held(); }
  /// m, of what is held, or was last.
  [[nodiscard]] double held_width_m() const noexcept { return held_.width_m(); }
  /// Nothing is under way, whatever the sensors say.
  [[nodiscard]] bool at_rest() const noexcept { return opening_.at_rest(); }

 private:
  [[nodiscard]] MotionProgress::News follow_path() noexcept;
  [[nodiscard]] MotionProgress::News follow_grip(bool awaited) noexcept;
  void back_off() noexcept;
  [[nodiscard]] double most_force_n() const noexcept;
  [[nodiscard]] const Gap& gap() const noexcept { return parts_.drives.gap(); }

  Parts parts_;
  Opening opening_;
  Grip grip_;
  Held held_;
  MotionProgress progress_;
  double held_force_n_{0}, grip_speed_m_s_{0.02};
  double cycle_s_{0.001};
};

}  // namespace hirosco::robot_gripper
