// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/at_tip.hpp"

namespace hirosco::robot_arm {

void AtTip::begin() noexcept {
  place_tool();
  parts_.carried.shape();
}

Outcome AtTip::take_payload(double mass_kg, const std::array<double, 3>& place_m, bool called) noexcept {
  if (!parts_.model.updated()) return refused(pus::FailureCode::NotPermittedNow);
  if (parts_.control.floats()) return refused(Trouble::led, "HOLD first");
  if (called || !parts_.guidance.at_rest()) return refused(pus::FailureCode::Busy);
  if (parts_.control.gives_way()) return refused(Trouble::soft, "POSITION_CONTROL first");
  const JointVector held = parts_.model.held({mass_kg, {place_m[0], place_m[1], place_m[2]}});
  if (const Outcome may = parts_.limits.may_hold(held); may.kind == Outcome::Kind::Refused) return may;
  parts_.control.take_load(held - parts_.model.held(parts_.model.payload()));
  parts_.carried.take_payload(mass_kg, place_m);
  parts_.model.forget_external();
  return ok();
}

/// Springs are the same along and about all axes: for them it is no matter how the tool is turned.
void AtTip::place_tool() noexcept {
  const robotics::Pose place = parts_.carried.tool();
  parts_.guidance.setpoints().set_tool(place);
  parts_.control.laws().set_tool(place.position);
}

Outcome AtTip::take_tool(const ToolValues& in_tip, bool called) noexcept {
  if (!parts_.guidance.begun()) return refused(pus::FailureCode::NotPermittedNow);
  if (called || !parts_.guidance.at_rest()) return refused(pus::FailureCode::Busy);
  if (!ToolAndPayload::has_orientation(in_tip)) return refused(Trouble::no_goal, "no orientation");
  parts_.carried.take_tool(in_tip);
  place_tool();
  return ok();
}

}  // namespace hirosco::robot_arm
