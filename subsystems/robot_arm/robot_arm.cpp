// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/robot_arm.hpp"

#include <cstdint>
#include <string_view>

#include "subsystems/robot_arm/lengths.hpp"

namespace hirosco {

using robot_arm::Events;
using robot_arm::Guidance;
using robot_arm::Homing;
using robot_arm::Lead;
using robot_arm::millimetres;
using robot_arm::Trouble;
using robot_arm::Yielding;

std::unique_ptr<Subsystem> make_robot_arm() { return std::make_unique<RobotArm>(); }

Result<Step> RobotArm::software_init() {
  HIROSCO_TRY(bind());
  return done;
}

Result<> RobotArm::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(robot_arm::check_lengths(known_.joints(), own_descriptor(), parameters_, drives_, abort_path_));
  HIROSCO_TRY(posture_.check(own_descriptor()));
  const double cycle_s = seconds(configuration.sampling);
  known_.limit_motions(parameters_.acceleration.load(), parameters_.jerk.load());
  model_.begin(cycle_s);
  HIROSCO_TRY(control_.begin(cycle_s));
  guidance_.begin(cycle_s);
  HIROSCO_TRY(lead_.begin(configuration, cycle_s));
  HIROSCO_TRY(homing_.begin(cycle_s));
  static_cast<void>(obstacles_.keep_out(parameters_.keep_out.load()));
  at_tip_.begin();
  torque_mode_.begin(cycle_s);
  limits_.begin(cycle_s);
  limits_.arm();
  forget_motion();
  return ok();
}

Result<> RobotArm::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first && motion_) drop_calls(limits_.tripped());  // what was judged in Safe-Operational
  return ok();
}

/// The law runs on the present position: what would be put out is visible, nothing moves.
Result<> RobotArm::safe_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    drop_calls(limits_.tripped());
    obstacles_.take_limit();  // it may have been written since CONFIGURE
    carried_.shape();
  }
  engage();
  control();
  watch(false);
  guidance_.keep_power(model_.held(model_.payload()));  // how long a path would take depends on it
  if (motion_) tell(guidance_.look(false));  // CHECK_ABORT moves nothing
  return ok();
}

Result<> RobotArm::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    limits_.arm();
    force_sensor_.arm(false);
    stopped_ = false;
  }
  if (cycle.first || !cycle.active) {
    if (!cycle.active) drop_calls(limits_.tripped());  // inhibited it could never end
    engage();
  } else if (homing_.in_force()) {
    advance_homing();
  } else {
    advance();
  }
  control();
  watch(cycle.active);
  if (cycle.active && !cycle.first && !homing_.in_force()) watch_contact();
  const bool kept = (cycle.first || cycle.active) && keep_from_acting();
  if (stopped_) inhibit_actuators();
  moving_ = cycle.active && !limits_.tripped() && !stopped_ && !kept;
  // Nobody is led by places that are from no zero.
  parameters_.active.store(moving_ && !homing_.in_force() ? 1 : 0);
  return ok();
}

Result<> RobotArm::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) drop_calls(limits_.tripped());
  drives_.put_out(robot_arm::Joints::zeros(known_.joints()));
  return ok();
}

void RobotArm::measure(const Cycle& cycle) noexcept {
  drives_.measure(cycle);
  if (homing_.update()) model_.forget_external();
  parameters_.active.store(0);
  moving_ = false;
  model_.update();
  if (const auto age_ms = force_sensor_.update(model_.hanging())) raise(events_.force_sensor_lost, *age_ms);
  lead_.tell(guidance_.setpoints());
}

/// Takes the present position as the reference.
void RobotArm::engage() noexcept {
  if (homing_.in_force()) homing_.engage();
  else yielding_.engage();
}

void RobotArm::control() noexcept {
  if (homing_.in_force()) homing_.control();
  else control_.control();
}

// --- what comes of it, told ----------------------------------------------------------------------------------------------

void RobotArm::advance() noexcept {
  guidance_.keep_power(model_.held(model_.payload()));
  if (const auto end = lead_.advance(guidance_.setpoints())) tell(*end);
  const bool drove = torque_mode_.drives();
  torque_mode_.advance();
  if (drove && !torque_mode_.drives()) force_sensor_.arm(true);
  guidance_.advance(control_.led());
  watch_clearance();
  if (const auto gone = guidance_.end_retract()) raise(events_.retracted, *gone);
  guidance_.tell();
  if (guidance_.at_rest()) at_rest_for_stop();
  if (motion_ && !torque_mode_.drives()) tell(guidance_.look(control_.gives_way()));
}

void RobotArm::advance_homing() noexcept {
  const Homing::News news = homing_.advance();
  if (homing_.at_rest()) at_rest_for_stop();
  if (!motion_) return;
  if (news.found != 0) progress(*motion_, static_cast<std::uint16_t>(news.found));
  if (news.done) finish_motion();
  if (news.failed) end_motion(news.failed->trouble, news.failed->text, news.failed->number);
}

/// An arm whose posture is not known by its model, or one that is homed and weighs something: told once for each entry into Operational, and each loss.
bool RobotArm::keep_from_acting() noexcept {
  const auto why = homing_.forbids();
  if (!why) return false;
  inhibit_actuators();
  if (why->joint) {
    raise(events_.not_referenced, static_cast<std::uint8_t>(*why->joint + 1));
    end_motion(Trouble::not_referenced, "it does not know its zero, joint", static_cast<std::int64_t>(*why->joint + 1));
  } else {
    raise(events_.homing_under_gravity, why->gravity_m_s2);
  }
  return true;
}

void RobotArm::tell(const Guidance::News& news) noexcept {
  if (news.begun) contact_watch_.arm(Yielding::Before::Stands);
  if (news.half_way) progress(*motion_, 1);
  switch (news.end) {
    case Guidance::End::None: return;
    case Guidance::End::Reached: raise(events_.motion_done); [[fallthrough]];
    case Guidance::End::Judged: finish_motion(); return;
    case Guidance::End::NotReached: end_motion(Trouble::goal_not_reached); return;
    case Guidance::End::LineLost:
    case Guidance::End::NoWay: end_motion(news.why.trouble, news.why.text, news.why.number); return;
  }
}

/// From this cycle on it slows down, and stands: each end of following that whoever leads has brought about is told once.
void RobotArm::tell(const Lead::End& end) noexcept {
  if (end.why == Lead::Why::Lost) raise(events_.lead_lost, static_cast<std::uint32_t>(end.value));
  else if (end.why == Lead::Why::LetGo) raise(events_.lead_let_go);
  else raise(events_.lead_unfit, end.joint, end.value, end.limit, static_cast<std::uint8_t>(end.why));
}

/// Each limit is told once until the next entry into Operational; it stays in force when the actuators are inhibited.
void RobotArm::watch(bool follows) noexcept {
  // Force and power of the tool are those of a posture.
  const auto worked = limits_.update_work(follows && !homing_.in_force());
  if (limits_.lets_go()) model_.forget_brakes();
  if (worked) raise(events_.of(worked->what), worked->value, worked->limit);
  const auto& wanted = homing_.in_force() ? homing_.wanted() : guidance_.setpoints().now().position;
  const auto* setpoint = follows && !control_.gives_way() ? &wanted : nullptr;
  const auto found = limits_.update(setpoint);
  if (limits_.tripped()) inhibit_actuators();
  if (found) raise(events_.of(found->what), static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

/// Comes to rest before links meet, or one of them what it is to keep out of; who is led stands there.
void RobotArm::watch_clearance() noexcept {
  const auto end = [this](const robot_arm::Obstacles::Nearest& ahead) {
    raise(events_.too_near, ahead.distance_m, Events::PairNames{std::string_view{ahead.names}});
    end_motion(Trouble::too_near, ahead.names, millimetres(ahead.distance_m));
  };
  if (const auto ahead = obstacles_.watch(guidance_.setpoints())) end(*ahead), guidance_.setpoints().brake();
  if (!control_.gives_way()) return;
  if (const auto ahead = obstacles_.watch_led(drives_.measured())) end(*ahead), yielding_.stand_apart();
}

/// Whoever asked for a motion is told that it ended.
void RobotArm::watch_contact() noexcept {
  const robot_arm::ContactWatch::Met met = contact_watch_.meet();
  if (const auto& its = met.by_joints)
    raise(events_.contact, static_cast<std::uint8_t>(its->joint + 1), its->torque, its->limit, its->reaction);
  if (const auto& its = met.at_wrist)
    raise(events_.wrist_contact, its->force_n, its->moment_n_m, static_cast<std::uint8_t>(yielding_.reaction()));
  if (!met.counts) return;
  const bool stood = guidance_.at_rest() && !motion_;
  if (const auto missed = drives_.sample_time().missed_lately(); missed == 0) end_motion(Trouble::contact);
  else end_motion(Trouble::contact, robot_arm::cycles_missed_before, missed);
  yielding_.react({.stood = stood, .stopping = stop_.has_value()});
}

}  // namespace hirosco
