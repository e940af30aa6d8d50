// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "hirosco/subsystem/author/handler.hpp"
#include "subsystems/robot_arm/floating/floating_craft.hpp"
#include "subsystems/robot_arm/floating/floating_guidance.hpp"
#include "subsystems/robot_arm/tool_and_payload.hpp"

namespace hirosco::robot_arm {

/// What an arm on a base that floats has at its tip (ToolAndPayload): the craft, whose base gives way otherwise for it, and its guidance are told.
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class FloatingTip {
 public:
  struct Parts {
    ToolAndPayload& carried;
    FloatingCraft& craft;
    FloatingGuidance& guidance;
  };
  explicit FloatingTip(const Parts& parts) noexcept : parts_{parts} {}

  /// In configure(), behind drives, craft and guidance.
  void begin() noexcept;

  // --- functions ----------------------------------------------------------------------------------------------------------
  /// What it is asked in. Nothing hangs at an arm in orbit: no joint has to hold more for a payload, and none is refused for its weight.
  struct Now {
    bool called{false};  ///< a telecommand that moves or judges is under way
    bool moves{false};  ///< what is put out reaches the joints
  };
  [[nodiscard]] Outcome take_payload(double mass_kg, const std::array<double, 3>& place_m, const Now& now) noexcept;
  [[nodiscard]] Outcome take_tool(const ToolValues& in_tip, const Now& now) noexcept;

 private:
  [[nodiscard]] Outcome take(const robotics::Pose& tool, const Payload& payload, const Now& now) noexcept;

  Parts parts_;
};

}  // namespace hirosco::robot_arm
