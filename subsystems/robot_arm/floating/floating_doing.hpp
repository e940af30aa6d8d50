// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "subsystems/robot_arm/control/compliance.hpp"

namespace hirosco::robot_arm {

/// What a floating arm is about, and by which law it is held for that.
/// Realtime: wait-free. Thread: the cycle, and the service loop while there is none.
class FloatingDoing {
 public:
  /// PHASES of the descriptor.
  enum class Phase : std::uint8_t {
    Holds,
    JointsMove,
    ToolMoves,
    Braked,  ///< told alone
    Stops,
    GoesOut,
    JointsJog,
    ToolJogs,
    Floats,
    Driven,
    Follows,
    ToolFollows,
  };
  [[nodiscard]] bool holds() const noexcept { return phase_ == Phase::Holds; }
  /// Comes to rest, and does not yet.
  [[nodiscard]] bool stops() const noexcept { return phase_ == Phase::Stops; }
  [[nodiscard]] bool jogs_joints() const noexcept { return phase_ == Phase::JointsJog; }
  [[nodiscard]] bool jogs_tool() const noexcept { return phase_ == Phase::ToolJogs; }
  [[nodiscard]] bool floats() const noexcept { return phase_ == Phase::Floats; }
  /// By torques.
  [[nodiscard]] bool driven() const noexcept { return phase_ == Phase::Driven; }
  /// Whoever leads its joints over a link.
  [[nodiscard]] bool follows() const noexcept { return phase_ == Phase::Follows; }
  /// Whoever leads its tool.
  [[nodiscard]] bool follows_tool() const noexcept { return phase_ == Phase::ToolFollows; }
  /// By its joints or whoever leads it, so that nothing is kept of what a law of the tool keeps.
  [[nodiscard]] bool keeps_nothing() const noexcept { return phase_ == Phase::GoesOut || floats() || driven(); }

  /// In force: who comes to rest or goes out does so by velocities, and is held behind that as before.
  [[nodiscard]] LawKind law() const noexcept {
    if (floats()) return LawKind::Float;
    if (driven()) return LawKind::Torque;
    return stops() || phase_ == Phase::GoesOut ? LawKind::Position : held_by_;
  }
  [[nodiscard]] bool soft() const noexcept {
    return law() == LawKind::JointImpedance || law() == LawKind::ToolImpedance;
  }
  /// Where it is may be elsewhere than it is to be, and that is meant.
  [[nodiscard]] bool gives_way() const noexcept { return law() != LawKind::Position; }

 protected:
  Phase phase_{Phase::Holds};
  LawKind held_by_{LawKind::Position};  ///< where it stands
};

}  // namespace hirosco::robot_arm
