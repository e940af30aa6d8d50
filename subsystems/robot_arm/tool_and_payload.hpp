// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "subsystems/robot_arm/control/law.hpp"
#include "subsystems/robot_arm/obstacles.hpp"
#include "subsystems/robot_arm/robot_arm_data.hpp"

namespace hirosco::robot_arm {

/// What an arm, on whatever base, has at its tip as it was said: a tool and a payload. Their shapes keep clear with its links (docs/adr/0194).
/// Realtime: bounded, no allocation. Thread: the cycle, and the service loop while there is none.
class ToolAndPayload {
 public:
  struct Parts {
    Obstacles& obstacles;
    Parameter<ToolValues>& tool_place;  ///< TOOL_PLACE
    Parameter<PayloadValues>& payload;  ///< PAYLOAD
    const Parameter<double>& tool_radius_m;  ///< TOOL_RADIUS
  };
  explicit ToolAndPayload(const Parts& parts) noexcept : parts_{parts} {}

  /// Of the tool in the tip's frame.
  [[nodiscard]] robotics::Pose tool() const noexcept { return pose_of(parts_.tool_place.load()); }
  [[nodiscard]] Payload payload() const noexcept;
  /// By what was said last, and TOOL_RADIUS as it was written last.
  void shape() noexcept;

  /// What is said of a tool is a place and an orientation: none at all, all 0, is that of the tip.
  [[nodiscard]] static bool has_orientation(const ToolValues& in_tip) noexcept;
  /// From now on; one that has_orientation().
  void take_tool(const ToolValues& in_tip) noexcept;
  void take_payload(double mass_kg, const std::array<double, 3>& place_m) noexcept;

 private:
  Parts parts_;
};

}  // namespace hirosco::robot_arm
