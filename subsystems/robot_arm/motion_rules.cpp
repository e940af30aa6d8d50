// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/motion_rules.hpp"

namespace hirosco::robot_arm {

Outcome MotionRules::is_free(const Now& now) const noexcept {
  if (now.called || !parts_.guidance.at_rest()) return refused(pus::FailureCode::Busy);
  return running;
}

Outcome MotionRules::may_change_law(const Now& now) const noexcept {
  if (parts_.homing.in_force()) return refused(Trouble::other_configuration, "this configuration homes alone");
  return now.moving ? is_free(now) : refused(Trouble::actuators_inhibited);
}

Outcome MotionRules::may_soften(const Now& now) const noexcept {
  return parts_.control.begun() ? may_change_law(now) : refused(pus::FailureCode::NotPermittedNow);
}

Outcome MotionRules::may_move(const Now& now) const noexcept {
  if (now.moving && parts_.control.floats()) return refused(Trouble::led, "HOLD first");
  return may_change_law(now);
}

Outcome MotionRules::may_check(const Now& now, bool operational) const noexcept {
  if (!parts_.guidance.begun()) return refused(pus::FailureCode::NotPermittedNow);
  return operational || parts_.homing.in_force() ? may_change_law(now) : is_free(now);
}

Outcome MotionRules::may_home(const Now& now) const noexcept {
  if (!parts_.homing.in_force()) return refused(Trouble::other_configuration, "CONFIGURE one that homes first");
  if (!now.moving) return refused(Trouble::actuators_inhibited);
  if (now.called || !parts_.homing.at_rest()) return refused(pus::FailureCode::Busy);
  return running;
}

bool MotionRules::may_wait_for_rest(const Now& now) const noexcept {
  if (!now.moving || now.called || parts_.control.floats()) return false;
  return parts_.guidance.comes_to_rest() || parts_.lead.slows_down();
}

}  // namespace hirosco::robot_arm
