// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hirosco/subsystem/author/subsystem.hpp"

namespace hirosco::robotics {

/// What subsystems have in common that move something by telecommands: one motion at a time, which is a telecommand until it ends; HOLD
/// ends it and stands; STOP ends it, comes to rest, and leaves it to the brakes until the next entry into Operational.
class MovingSubsystem : public Subsystem {
 protected:
  /// What the author's failure codes for these are.
  struct Codes {
    pus::FailureCode inhibited{};
    pus::FailureCode limit_tripped{};
  };
  explicit MovingSubsystem(Codes codes) noexcept : codes_{codes} {}

  /// In software_init().
  void bind_hold_and_stop();
  /// In configure().
  void forget_motion() noexcept;

  // --- in the cycle and in function handlers --------------------------------------------------------------------------
  /// Comes to rest where it is.
  virtual void stand() noexcept = 0;
  /// Whoever asked for it hears that it is done.
  void finish_motion() noexcept;
  /// Whatever else belongs to a motion ends with it.
  virtual void motion_ended() noexcept {}
  template <FailureEnumeration Code>
  void end_motion(Code why, const char* text = "", std::int64_t number = 0) noexcept {
    if (motion_) abort(*motion_, why, text, number);
    motion_.reset();
    motion_ended();
  }
  /// The actuators were taken away from whatever runs.
  void drop_calls(bool limit_tripped) noexcept;
  /// Whoever waits for STOP hears that it rests; the brakes have it from now on.
  void at_rest_for_stop() noexcept;

  std::optional<Call> motion_, stop_;
  bool moving_{false};  ///< what is put out reaches the actuators
  bool stopped_{false};  ///< by STOP, until the next entry into Operational

 private:
  [[nodiscard]] Outcome hold() noexcept;
  Codes codes_;
};

}  // namespace hirosco::robotics
