// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/tool_and_payload.hpp"

#include <cmath>
#include <numeric>

namespace hirosco::robot_arm {

Payload ToolAndPayload::payload() const noexcept {
  const PayloadValues values = parts_.payload.load();
  return {values.mass_kg, {values.place_m[0], values.place_m[1], values.place_m[2]}};
}

void ToolAndPayload::shape() noexcept {
  const Payload its = payload();
  parts_.obstacles.carry(tool().position, its.mass_kg > 0 ? its.place_m : Vector3{Vector3::Zero()},
                         parts_.tool_radius_m.load());
}

bool ToolAndPayload::has_orientation(const ToolValues& in_tip) noexcept {
  const double norm = std::sqrt(std::inner_product(in_tip.orientation_wxyz.begin(), in_tip.orientation_wxyz.end(),
                                                   in_tip.orientation_wxyz.begin(), 0.0));
  return norm == 0 || (norm > 0.5 && norm < 1.5);
}

void ToolAndPayload::take_tool(const ToolValues& in_tip) noexcept {
  parts_.tool_place.store(values_of(pose_of(in_tip)));
  shape();
}

void ToolAndPayload::take_payload(double mass_kg, const std::array<double, 3>& place_m) noexcept {
  parts_.payload.store({mass_kg, place_m});
  shape();
}

}  // namespace hirosco::robot_arm
