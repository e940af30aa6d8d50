// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/floating/floating_arm.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "robotics/motion/sampled_rates.hpp"
#include "subsystems/robot_arm/floating/floating_trouble.hpp"

namespace hirosco {

using robot_arm::FloatingGuidance;
using robot_arm::Joints;
using robot_arm::JointVector;
using robot_arm::ToolLaw;
using robot_arm::UrdfArm;
using Trouble = robot_arm::FloatingTrouble;

namespace {

constexpr std::string_view hold_configuration = "ATTITUDE_HOLD", pose_set = "POSE";
/// On a way out a joint has its velocity in a second, half as hard as what stops it (StopRamp), and that acceleration in a tenth of it.
constexpr double velocity_within_s = 1, ramp_share = 0.1;

}  // namespace

std::unique_ptr<Subsystem> make_floating_arm() { return std::make_unique<FloatingArm>(); }

Result<Step> FloatingArm::software_init() {
  parameters_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  bind_force_sensor();
  use_device(UrdfArm::device, drives_.port(), {robotics::urdf::model_setting, robotics::urdf::tip_setting});
  require_link(pose_set, craft_.pose_port());
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
  HIROSCO_TRY(posture_.check(own_descriptor()));
  const double cycle_s = seconds(configuration.sampling);
  HIROSCO_TRY(robotics::check_cycle(cycle_s));
  known_.limit_motions_by_velocity(velocity_within_s, ramp_share);
  const bool tracks = std::ranges::find(configuration.requires_, pose_set, &descriptor::Requires::name) !=
                      configuration.requires_.end();
  craft_.begin(!tracks                                    ? ToolLaw::FixedBase
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
  HIROSCO_TRY(lead_.begin(configuration, cycle_s));
  if (tracks && lead_.leads())
    return fail(ErrorCode::Mismatch, "JOINT_POSITIONS lead, POSE is kept to: one in a configuration");
  tool_lead_.begin(configuration, cycle_s);
  if (tool_lead_.leads() && lead_.leads())
    return fail(ErrorCode::Mismatch, "TOOL_POSE and JOINT_POSITIONS lead: one in a configuration");
  if (tool_lead_.leads() && craft_.law() == ToolLaw::AttitudeHold)
    return fail(ErrorCode::Mismatch, "TOOL_POSE leads, and ATTITUDE_HOLD turns no tool");
  work_.begin(cycle_s);
  work_.arm();
  laws_.begin(known_.model().joint_count(), cycle_s);
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
  watch(false);
  return ok();
}

Result<> FloatingArm::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    watch_.arm();
    work_.arm();
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
  watch(cycle.active && !braked_);
  if (cycle.active && !braked_ && !may_act()) braked_ = true;
  if (braked_) inhibit_actuators();
  moving_ = cycle.active && !tripped() && !braked_;
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
  // Nothing weighs there; what the tip's axes are the tool's tell, as it is turned in them.
  const robotics::Matrix3 tip = craft_.tool().rotation * carried_.tool().rotation.transpose();
  if (const auto age_ms = force_sensor_.update({.tip = tip})) raise(force_sensor_lost_, *age_ms);
  work_.measure();
  lead_.tell(guidance_.setpoints());
  tool_lead_.tell(guidance_.tool_goal(), guidance_.follows_tool());
}

void FloatingArm::control(bool moves) noexcept {
  JointVector rates = guidance_.wanted_rates();
  if (!guidance_.gives_way()) rates *= work_.pace().share(rates);
  const auto end = guidance_.may_end_range() ? ahead_.end(rates) : std::nullopt;
  if (end) {
    rates.setZero();
    if (moves) stop_before(*end);
  }
  watch_clearance(rates, moves);
  const robot_arm::FloatingLaws::Now now{.kind = guidance_.law(),
                                         .rates = rates,
                                         .goal = guidance_.goal(),
                                         .driven = guidance_.torques(),
                                         .axes = craft_.law(),
                                         .followed_per_s = craft_.followed_per_s(),
                                         .float_damping_per_s = parameters_.float_damping.load(),
                                         .lever = work_.lever(),
                                         .work = work_.limits()};
  drives_.put_out(robot_arm::joints_of(laws_.torque(craft_.model(), drives_.measured(), known_.bounds(), now)));
  const robot_arm::Impedance& impedance = laws_.impedance();
  parameters_.law.store(
      {static_cast<std::uint8_t>(now.kind), impedance.tool_n_m, impedance.tool_n_m_rad, impedance.damping_ratio});
  parameters_.joint_stiffness.store(robot_arm::joints_of(impedance.joint_n_m_rad));
  parameters_.desired_velocity.store(robot_arm::joints_of(rates));
  guidance_.tell(braked_);
}

// --- what comes of it, told ----------------------------------------------------------------------------------------------

void FloatingArm::advance() noexcept {
  if (guidance_.follows())
    if (const auto end = lead_.advance(guidance_.setpoints())) tell(*end);
  if (guidance_.follows_tool()) {
    if (const auto end = tool_lead_.advance(guidance_.tool_goal())) tell(*end);
    guidance_.lead_tool(tool_lead_.turning(), tool_lead_.moving(), tool_lead_.over());
  }
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

/// From this cycle on it slows down, and stands: each end of following that whoever leads has brought about is told once.
void FloatingArm::tell(const robot_arm::Lead::End& end) noexcept {
  using Why = robot_arm::Lead::Why;
  if (end.why == Why::Lost) raise(lead_lost_, static_cast<std::uint32_t>(end.value));
  else if (end.why == Why::LetGo) raise(lead_let_go_);
  else if (tool_lead_.leads()) raise(tool_lead_unfit_, end.value, end.limit, static_cast<std::uint8_t>(end.why));
  else raise(lead_unfit_, end.joint, end.value, end.limit, static_cast<std::uint8_t>(end.why));
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
  const bool led = guidance_.gives_way();  // whoever pushes, or the springs that pull it there
  const auto ahead = ahead_.near(rates, guidance_.holds() && !led ? Doing::Holds : Doing::Goes);
  if (!ahead) return;
  raise(too_near_, ahead->distance_m, PairNames{std::string_view{ahead->names}});
  const bool held = guidance_.holds() && !led;
  end_motion(Trouble::too_near, robot_arm::millimetres(ahead->distance_m), ahead->names);
  if (held) {
    braked_ = true;
  } else if (led) {
    guidance_.hold_by(robot_arm::LawKind::Position);
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
  const auto felt = force_sensor_.meet(false);
  if (!met && !felt) return;
  using Reaction = robot_arm::JointContact::Reaction;
  const Reaction by = contact_.reaction();
  if (met)
    raise(contact_met_, static_cast<std::uint8_t>(met->joint + 1), met->torque, met->limit,
          static_cast<std::uint8_t>(by));
  if (felt) raise(wrist_contact_, felt->force_n, felt->moment_n_m, static_cast<std::uint8_t>(by));
  if (!contact_.is_another(felt.has_value())) return;
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
void FloatingArm::watch(bool free) noexcept {
  watch_work(free);
  const auto shares = parameters_.limits.load();
  const auto found = watch_.update(
      drives_.measured(), nullptr, known_.bounds(),
      {.speed_share = shares.speed, .torque_share = shares.torque, .torque_hard_share = shares.torque_hard});
  if (tripped()) inhibit_actuators();
  if (!found) return;
  end_motion(Trouble::limit_tripped, static_cast<std::int64_t>(found->joint + 1));
  raise(found->what == robot_arm::Excess::TorqueHard ? hard_exceeded_ : limit_exceeded_,
        static_cast<std::uint8_t>(found->joint + 1), found->value, found->limit);
}

void FloatingArm::watch_work(bool free) noexcept {
  const auto found = work_.watch(free);
  if (!found) return;
  using robot_arm::Work;
  end_motion(Trouble::limit_tripped);
  raise(found->what == Work::ToolForce ? force_exceeded_
        : found->what == Work::Power   ? power_exceeded_
                                       : tool_power_exceeded_,
        found->value, found->limit);
}

}  // namespace hirosco
