// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/robot_arm/robot_arm.hpp"

#include <array>
#include <cstdint>
#include <string_view>

#include "subsystems/robot_arm/lengths.hpp"

namespace hirosco {

using robot_arm::Events;
using robot_arm::ForceSensor;
using robot_arm::Guidance;
using robot_arm::Lead;
using robot_arm::millimetres;
using robot_arm::Trouble;
using robot_arm::UrdfArm;
using robot_arm::Yielding;

std::unique_ptr<Subsystem> make_robot_arm() { return std::make_unique<RobotArm>(); }

Result<Step> RobotArm::software_init() {
  parameters_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  using namespace robotics::urdf;
  bind_force_sensor();
  use_device(UrdfArm::device, drives_.port(), {model_setting, tip_setting, fixed_setting});
  events_.each([this](EventPort& event) { use_event(event); });
  HIROSCO_TRY_LET(const UrdfArm::Source source, known_.read(own_descriptor()));
  HIROSCO_TRY(obstacles_.read(source, known_.model(), known_.tip()));
  HIROSCO_TRY(known_.take_bounds());
  bind_motions();
  bind_settings();
  bind_laws();
  bind_lead();
  return done;
}

Result<> RobotArm::configure(const descriptor::Configuration& configuration) {
  HIROSCO_TRY(robot_arm::check_lengths(known_.joints(), own_descriptor(), parameters_, drives_, abort_path_));
  const double cycle_s = seconds(configuration.sampling);
  known_.limit_motions(parameters_.acceleration.load(), parameters_.jerk.load());
  model_.begin(cycle_s);
  HIROSCO_TRY(control_.begin(cycle_s));
  guidance_.begin(cycle_s);
  HIROSCO_TRY(lead_.begin(configuration, cycle_s));
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
    at_tip_.shape();
  }
  yielding_.engage();
  control_.control();
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
    yielding_.engage();
  } else {
    advance();
  }
  control_.control();
  watch(cycle.active);
  if (cycle.active && !cycle.first) watch_contact();
  if (stopped_) inhibit_actuators();
  moving_ = cycle.active && !limits_.tripped() && !stopped_;
  parameters_.active.store(moving_ ? 1 : 0);
  return ok();
}

Result<> RobotArm::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) drop_calls(limits_.tripped());
  drives_.put_out(robot_arm::Joints::zeros(known_.joints()));
  return ok();
}

void RobotArm::measure(const Cycle& cycle) noexcept {
  drives_.measure(cycle.state);
  parameters_.active.store(0);
  moving_ = false;
  model_.update();
  if (const auto age_ms = force_sensor_.update()) raise(events_.force_sensor_lost, *age_ms);
  lead_.tell();
}

// --- what comes of it, told ----------------------------------------------------------------------------------------------

void RobotArm::advance() noexcept {
  guidance_.keep_power(model_.held(model_.payload()));
  if (const auto end = lead_.advance()) tell(*end);
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
  const auto worked = limits_.update_work(follows);
  if (limits_.lets_go()) model_.forget_brakes();
  if (worked) raise(events_.of(worked->what), worked->value, worked->limit);
  const auto* setpoint = follows && !control_.gives_way() ? &guidance_.setpoints().now().position : nullptr;
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
  end_motion(Trouble::contact);
  yielding_.react({.stood = stood, .stopping = stop_.has_value()});
}

// --- functions -----------------------------------------------------------------------------------------------------------

Outcome RobotArm::move(Begin begin, const FunctionValues& values, const Call& call) noexcept {
  if (const Outcome may = rules_.may_move(now()); may.kind == Outcome::Kind::Refused) return may;
  const Outcome begun = (guidance_.*begin)(values);
  if (begun.kind == Outcome::Kind::Refused) return begun;
  contact_watch_.arm(Yielding::Before::Stands);
  motion_ = call;
  return begun;
}

/// CHECK_ABORT, which moves nothing, keeps nobody in.
Outcome RobotArm::leave(Begin begin, const FunctionValues& values, const Call& call) noexcept {
  if (guidance_.only_judges()) end_motion(pus::FailureCode::Aborted);
  if (!rules_.may_wait_for_rest(now())) return move(begin, values, call);
  motion_ = call;
  return guidance_.once_it_stands(begin, values);
}

Outcome RobotArm::check_abort(const Call& call) noexcept {
  const bool operational = parameters_.current.load().state == static_cast<std::int32_t>(State::Operational);
  if (const Outcome may = rules_.may_check(now(), operational); may.kind == Outcome::Kind::Refused) return may;
  const Outcome begun = guidance_.check_abort();
  if (begun.kind != Outcome::Kind::Refused) motion_ = call;
  return begun;
}

/// Who jogs on says so before the time of what he said last is over: that is done then, and nothing stands still between them.
Outcome RobotArm::jog(Begin begin, const FunctionValues& values, const Call& call) noexcept {
  if (!motion_ || stop_ || !guidance_.jogs(begin)) return move(begin, values, call);
  finish(*motion_);
  motion_ = call;
  return (guidance_.*begin)(values);
}

/// Who drives it on says so before the time of what he said last is over, as who jogs. Behind a contact its law is that of torques for a cycle yet: whoever
/// waits for its rest then is not driven on.
Outcome RobotArm::drive(const FunctionValues& values, const Call& call) noexcept {
  const bool goes_on = motion_ && !stop_ && torque_mode_.drives() && !guidance_.waits();
  if (const Outcome may = goes_on ? running : rules_.may_move(now()); may.kind == Outcome::Kind::Refused) return may;
  const Outcome driven = torque_mode_.drive(values);
  if (driven.kind == Outcome::Kind::Refused) return driven;
  if (goes_on) finish(*motion_);
  else force_sensor_.arm(true);
  motion_ = call;
  return driven;
}

/// Whose descriptor has no abort path has no function of it.
void RobotArm::bind_motions() {
  const auto bind = [this](const char* name, auto how, Begin begin) {
    on_function(name, [this, how, begin](const FunctionValues& values, Call call) {
      return (this->*how)(begin, values, call);
    });
  };
  bind("MOVE_J", &RobotArm::move, &Guidance::move_j);
  bind("MOVE_P", &RobotArm::move, &Guidance::move_p);
  bind("MOVE_L", &RobotArm::move, &Guidance::move_l);
  bind("JOG_J", &RobotArm::jog, &Guidance::jog_j);
  bind("JOG_L", &RobotArm::jog, &Guidance::jog_l);
  bind("RETREAT", &RobotArm::leave, &Guidance::retreat);
  bind_hold_and_stop();
  if (!robot_arm::AbortPath::declared(own_descriptor())) return;
  abort_path_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  bind("MOVE_ABORT", &RobotArm::leave, &Guidance::move_abort);
  on_function("CHECK_ABORT", [this](Call call) { return check_abort(call); });
}

void RobotArm::bind_settings() {
  on_function("SET_TORQUE_LIMIT", [this](double share) { return limits_.set_torque_limit(share); });
  on_function("SET_FORCE_LIMIT", [this](double force_n) { return limits_.set_force_limit(force_n); });
  on_function("SET_POWER_LIMIT",
              [this](double power_w, double tool_w) { return limits_.set_power_limits(power_w, tool_w); });
  on_function("KEEP_OUT", [this](const robot_arm::KeepOut& numbers) { return obstacles_.keep_out(numbers); });
  on_function("SET_CONTACT", [this](std::uint8_t reaction, double limit) -> Outcome {
    parameters_.contact.store({reaction, limit});
    contact_watch_.arm(Yielding::Before::Counts);
    return ok();
  });
  on_function("SET_PAYLOAD", [this](double mass_kg, std::array<double, 3> place_m) -> Outcome {
    return at_tip_.take_payload(mass_kg, place_m, motion_ || stop_);
  });
  on_function("SET_TOOL", [this](std::array<double, 3> place_m, std::array<double, 4> wxyz) -> Outcome {
    return at_tip_.take_tool({place_m, wxyz}, motion_ || stop_);
  });
}

/// What the descriptor does not offer, this arm does not have.
void RobotArm::bind_laws() {
  const auto offered = [&](const char* name) { return own_descriptor().find_function(name) != nullptr; };
  if (offered("IMPEDANCE_J"))
    on_function("IMPEDANCE_J", [this](const FunctionValues& values, Call) -> Outcome {
      if (const Outcome may = rules_.may_soften(now()); may.kind == Outcome::Kind::Refused) return may;
      return yielding_.soften_joints(values);
    });
  if (offered("IMPEDANCE_L"))
    on_function("IMPEDANCE_L", [this](double stiffness_n_m, double turning_n_m, double damping) -> Outcome {
      if (const Outcome may = rules_.may_soften(now()); may.kind == Outcome::Kind::Refused) return may;
      return yielding_.soften_tool(stiffness_n_m, turning_n_m, damping);
    });
  if (offered("TORQUE_J"))
    on_function("TORQUE_J", [this](const FunctionValues& values, Call call) { return drive(values, call); });
  if (offered("POSITION_CONTROL"))
    on_function("POSITION_CONTROL", [this]() -> Outcome {
      if (const Outcome may = rules_.may_change_law(now()); may.kind == Outcome::Kind::Refused) return may;
      yielding_.harden();
      return ok();
    });
}

/// An arm whose device tells no force at its tip has what its joints feel, and nothing besides.
void RobotArm::bind_force_sensor() {
  if (!ForceSensor::declared(own_descriptor())) return;
  drives_.take_force();
  force_sensor_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  events_.each_of_force_sensor([this](EventPort& event) { use_event(event); });
}

/// An arm of whose configurations none has a set that leads follows nobody, and knows nothing of it.
void RobotArm::bind_lead() {
  const bool by_positions = Lead::declared(own_descriptor(), Lead::positions_set);
  const bool by_speeds = Lead::declared(own_descriptor(), Lead::speeds_set);
  if (!by_positions && !by_speeds) return;
  if (by_positions) require_link(Lead::positions_set, lead_.positions());
  if (by_speeds) require_link(Lead::speeds_set, lead_.speeds());
  lead_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  events_.each_of_lead([this](EventPort& event) { use_event(event); });
  on_function("FOLLOW", [this]() -> Outcome {
    if (const Outcome may = rules_.may_move(now()); may.kind == Outcome::Kind::Refused) return may;
    const Outcome begun = lead_.follow();
    if (begun.kind != Outcome::Kind::Refused) contact_watch_.arm(Yielding::Before::Stands);
    return begun;
  });
}

}  // namespace hirosco
