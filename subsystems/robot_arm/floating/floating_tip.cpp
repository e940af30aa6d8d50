// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_tip.hpp"

#include <cmath>

#include "subsystems/robot_arm/floating/floating_trouble.hpp"

namespace hirosco::robot_arm {

void FloatingTip::begin() noexcept {
  parts_.craft.carry(parts_.carried.tool(), parts_.carried.payload());
  parts_.guidance.carry(parts_.carried.tool(), parts_.carried.payload());
  parts_.carried.shape();
}

Outcome FloatingTip::take_payload(double mass_kg, const std::array<double, 3>& place_m, const Now& now) noexcept {
  const Payload payload{mass_kg, {place_m[0], place_m[1], place_m[2]}};
  const Outcome taken = take(parts_.carried.tool(), payload, now);
  if (taken.kind != Outcome::Kind::Refused) parts_.carried.take_payload(mass_kg, place_m);
  return taken;
}

Outcome FloatingTip::take_tool(const ToolValues& in_tip, const Now& now) noexcept {
  if (!ToolAndPayload::has_orientation(in_tip)) return refused(FloatingTrouble::no_goal, "no orientation");
  const Outcome taken = take(pose_of(in_tip), parts_.carried.payload(), now);
  if (taken.kind == Outcome::Kind::Refused) return taken;
  parts_.carried.take_tool(in_tip);
  parts_.guidance.take_tool();
  return taken;
}

/// Where another tool, or a heavier one, cannot be held with the base unturned, nobody is to find out by his brakes.
Outcome FloatingTip::take(const robotics::Pose& tool, const Payload& payload, const Now& now) noexcept {
  FloatingCraft& craft = parts_.craft;
  if (!craft.begun()) return refused(pus::FailureCode::NotPermittedNow);
  if (parts_.guidance.floats()) return refused(FloatingTrouble::led, "HOLD first");
  if (parts_.guidance.soft()) return refused(FloatingTrouble::soft, "POSITION_CONTROL first");
  if (now.called || !parts_.guidance.holds()) return refused(pus::FailureCode::Busy);
  craft.carry(tool, payload);
  if (const double left = craft.model().conditioning();
      now.moves && craft.law() == ToolLaw::AttitudeHold && left < least_conditioning) {
    craft.carry(parts_.carried.tool(), parts_.carried.payload());
    return refused(FloatingTrouble::ill_conditioned, "with it, thousandths", std::llround(1e3 * left));
  }
  parts_.guidance.carry(tool, payload);
  return ok();
}

}  // namespace hirosco::robot_arm
