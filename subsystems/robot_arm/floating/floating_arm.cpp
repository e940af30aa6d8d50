// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_arm.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/floating/float_law.hpp"
#include "subsystems/robot_arm/floating/floating_trouble.hpp"

namespace hirosco {

using robot_arm::FloatingGuidance;
using robot_arm::Joints;
using robot_arm::JointVector;
using robot_arm::ToolLaw;
using robot_arm::UrdfArm;
using Trouble = robot_arm::FloatingTrouble;

namespace {

constexpr std::string_view hold_configuration = "ATTITUDE_HOLD";
/// On a way out a joint has its velocity in a second, half as hard as what stops it (StopRamp), and that acceleration in a tenth of it.
constexpr double velocity_within_s = 1, ramp_share = 0.1;

}  // namespace

std::unique_ptr<Subsystem> make_floating_arm() { return std::make_unique<FloatingArm>(); }

Result<Step> FloatingArm::software_init() {
  parameters_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  use_device(UrdfArm::device, drives_.port(), {robotics::urdf::model_setting, robotics::urdf::tip_setting});
  require_link("POSE", craft_.pose_port());
  for (EventPort* event :
       std::initializer_list<EventPort*>{&motion_done_, &conditioning_low_, &base_held_, &limit_exceeded_,
                                         &hard_exceeded_, &range_end_near_, &too_near_})
    use_event(*event);
  HIROSCO_TRY_LET(const UrdfArm::Source source, known_.read(own_descriptor()));
  HIROSCO_TRY(obstacles_.read(source, known_.model(), known_.tip()));
  HIROSCO_TRY(known_.take_bounds());
  bind_functions();
  return done;
}

/// Who requires the pose of the base tracks by it, and by the name of the configuration leaves the base unturned.
Result<> FloatingArm::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(check_lengths());
  const double cycle_s = seconds(configuration.sampling);
  HIROSCO_TRY(robotics::check_cycle(cycle_s));
  known_.limit_motions_by_velocity(velocity_within_s, ramp_share);
  craft_.begin(configuration.requires_.empty()            ? ToolLaw::FixedBase
               : configuration.name == hold_configuration ? ToolLaw::AttitudeHold
                                                          : ToolLaw::InertialTrack,
               cycle_s);
  watch_.arm();
  motion_.reset();
  drives_.forget(static_cast<std::size_t>(known_.model().joint_count()));
  moving_ = braked_ = false;
  guidance_.begin(cycle_s);
  ahead_.begin(cycle_s);
  tip_.begin();
  contact_.begin(cycle_s);
  law_change_.begin(known_.model().joint_count(), cycle_s);
  fastest_rad_s_ = robotics::fastest_rad_s(cycle_s);
  static_cast<void>(obstacles_.keep_out(parameters_.keep_out.load()));
  return ok();
}

Result<> FloatingArm::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first && motion_) end_motion(pus::FailureCode::Aborted);  // what was judged in Safe-Operational
  return ok();
}

/// The law runs on the present place: what would be put out is visible, nothing moves.
Result<> FloatingArm::safe_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    end_motion(pus::FailureCode::Aborted);
    obstacles_.take_limit();  // it may have been written since CONFIGURE
    carried_.shape();
  }
  guidance_.engage();
  if (motion_) advance();  // CHECK_ABORT moves nothing
  control(false);
  watch();
  return ok();
}

Result<> FloatingArm::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    watch_.arm();
    braked_ = false;
  }
  if (cycle.first || !cycle.active) {
    if (!cycle.active) end_motion(pus::FailureCode::Aborted);  // inhibited it could never end
    guidance_.engage();
    contact_.arm(robot_arm::JointContact::Before::Counts);
  } else {
    advance();
    watch_contact();
  }
  control(cycle.active && !braked_);
  watch();
  if (cycle.active && !braked_ && !may_act()) braked_ = true;
  if (braked_) inhibit_actuators();
  moving_ = cycle.active && !watch_.tripped() && !braked_;
  parameters_.active.store(moving_ ? 1 : 0);
  return ok();
}

Result<> FloatingArm::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) end_motion(pus::FailureCode::Aborted);
  drives_.put_out(Joints::zeros(known_.joints()));
  return ok();
}

void FloatingArm::measure(const Cycle& cycle) noexcept {
  drives_.measure(cycle);
  parameters_.active.store(0);
  const bool driven = moving_ && cycle.state == State::Operational;
  moving_ = false;
  craft_.update();
  contact_.update(driven);
}

void FloatingArm::control(bool moves) noexcept {
  JointVector rates = guidance_.wanted_rates();
  const auto end = guidance_.may_end_range() ? ahead_.end(rates) : std::nullopt;
  if (end) {
    rates.setZero();
    if (moves) stop_before(*end);
  }
  watch_clearance(rates, moves);
  drives_.put_out(robot_arm::joints_of(torque_of(rates)));
  parameters_.desired_velocity.store(robot_arm::joints_of(rates));
  guidance_.tell(braked_);
}

/// Whoever leads it is not held back by more than the law of velocities, which a payload makes slower, would.
JointVector FloatingArm::torque_of(const JointVector& rates) noexcept {
  const double per_s = craft_.followed_per_s();
  const robot_arm::Measured& measured = drives_.measured();
  const robot_arm::Bounds bounds = known_.bounds();
  const bool floats = guidance_.floats();
  JointVector torque;
  if (floats) {
    float_aims_.remember(measured.position);
    torque = robot_arm::float_torque(craft_.model(), measured, float_aims_, bounds,
                                     std::min(parameters_.float_damping.load(), per_s), fastest_rad_s_);
  } else {
    float_aims_.let_go();  // who floats next begins where it is then
    torque = robot_arm::joint_torque(craft_.model(), rates, measured.velocity, bounds, per_s);
  }
  return law_change_.without_a_step(torque, floats, bounds);
}

// --- what comes of it, told ----------------------------------------------------------------------------------------------

void FloatingArm::advance() noexcept {
  const FloatingGuidance::News news = guidance_.advance();
  if (const auto gone = guidance_.end_retreat()) raise(retracted_, *gone);
  switch (news) {
    case FloatingGuidance::News::None: return;
    case FloatingGuidance::News::Reached:
      if (motion_) raise(motion_done_);  // who backs off by himself has done nothing that was asked
      finish_call();
      return;
    case FloatingGuidance::News::NotReached: end_motion(Trouble::goal_not_reached); return;
    case FloatingGuidance::News::IllConditioned:
      tell_ill_conditioned(parameters_.conditioning.load());
      braked_ = true;
      return;
    case FloatingGuidance::News::NoWay:
      end_motion(guidance_.why().trouble, guidance_.why().number, guidance_.why().text);
      return;
    case FloatingGuidance::News::Judged: finish_call(); return;
  }
}

/// What else than its own sensors keeps it from moving.
bool FloatingArm::may_act() noexcept {
  if (!craft_.tracks()) return true;
  if (craft_.base_is_held()) {
    raise(base_held_);
    end_motion(Trouble::base_is_held);
    return false;
  }
  // Whoever goes out keeps neither tool nor base; who is to keep them would begin to turn about as soon as it is let go.
  if (guidance_.keeps_nothing()) return true;
  const double conditioning = parameters_.conditioning.load();
  if (craft_.law() != ToolLaw::AttitudeHold || conditioning >= robot_arm::least_conditioning) return true;
  tell_ill_conditioned(conditioning);
  return false;
}

/// A motion ends, and it stands there: another one may lead away. Who only holds its tool, and runs there for that, cannot go on holding it.
void FloatingArm::stop_before(const robot_arm::EndAhead& end) noexcept {
  if (guidance_.holds()) braked_ = true;
  const auto number = static_cast<std::uint8_t>(end.joint + 1);
  raise(range_end_near_, number, end.position, end.end);
  end_motion(Trouble::out_of_range, number);
  guidance_.stand();
}

/// A motion comes to rest before links meet, or one of them the base or what it is to keep out of. Who only holds its tool and would run there cannot go on.
void FloatingArm::watch_clearance(const JointVector& rates, bool moves) noexcept {
  const JointVector& here = drives_.measured().position;
  obstacles_.tell(here);
  if (!moves) return obstacles_.stand_at(here);
  obstacles_.pass(here);
  if (guidance_.stops()) return;
  using Doing = robot_arm::FloatingAhead::Doing;
  const auto ahead = ahead_.near(rates, guidance_.holds() ? Doing::Holds : Doing::Goes);
  if (!ahead) return;
  raise(too_near_, ahead->distance_m, PairNames{std::string_view{ahead->names}});
  const bool held = guidance_.holds(), led = guidance_.floats();
  end_motion(Trouble::too_near, robot_arm::millimetres(ahead->distance_m), ahead->names);
  if (held) {
    braked_ = true;
  } else if (led) {
    guidance_.halt();
    contact_.stand_apart();  // whoever leads it pushes on meanwhile
  } else {
    guidance_.stop(rates);
  }
}

/// Whoever asked for a motion is told that it ended. Who stood goes nowhere for it: it is not he who went there; nor does who backs off and meets somebody else.
void FloatingArm::watch_contact() noexcept {
  if (guidance_.floats()) return;
  const auto met = contact_.meet();
  if (!met) return;
  using Reaction = robot_arm::JointContact::Reaction;
  const Reaction by = contact_.reaction();
  raise(contact_met_, static_cast<std::uint8_t>(met->joint + 1), met->torque, met->limit,
        static_cast<std::uint8_t>(by));
  const bool stood = guidance_.holds() && !motion_;
  const bool backs_off = guidance_.retracts();
  if (stood && by != Reaction::Float) return;
  if (const auto missed = drives_.sample_time().missed_lately(); missed == 0) end_motion(Trouble::contact);
  else end_motion(Trouble::contact, missed, robot_arm::cycles_missed_before);
  if (by == Reaction::Float) guidance_.let_go();
  else if (by == Reaction::Retract && !backs_off) guidance_.retract(parameters_.retract_distance.load());
  else guidance_.halt();
}

void FloatingArm::tell_ill_conditioned(double conditioning) noexcept {
  raise(conditioning_low_, conditioning);
  end_motion(Trouble::ill_conditioned, std::llround(1e3 * conditioning));
}

/// Each limit is told once until the next entry into Operational; it stays in force when the actuators are inhibited.
void FloatingArm::watch() noexcept {
  const auto shares = parameters_.limits.load();
  const auto found = watch_.update(
      drives_.measured(), nullptr, known_.bounds(),
      {.speed_share = shares.speed, .torque_share = shares.torque, .torque_hard_share = shares.torque_hard});
  if (watch_.tripped()) inhibit_actuators();
  if (!found) return;
  end_motion(Trouble::limit_tripped, static_cast<std::int64_t>(found->joint + 1));
  raise(found->what == robot_arm::Excess::TorqueHard ? hard_exceeded_ : limit_exceeded_,
        static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

}  // namespace hirosco
