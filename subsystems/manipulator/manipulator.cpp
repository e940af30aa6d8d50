// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/manipulator.hpp"

#include <algorithm>

namespace hirosco {

using manipulator::Joints;
using manipulator::RobotInput;
using manipulator::TemperatureVerdict;
using manipulator::TorqueVerdict;

std::unique_ptr<Subsystem> make_arm() { return std::make_unique<Manipulator>(); }

Result<> Manipulator::configure(const descriptor::Configuration& configuration) {
  coupled_ = !configuration.requires_.empty();
  HIROSCO_TRY(check_lengths());
  controller_.emplace(joints(), seconds(configuration.sampling));
  for (auto* call : {&move_, &programme_call_, &tool_call_, &gains_call_}) call->reset();
  programme_ = nullptr;
  tool_.forget();
  moving_ = false;
  torque_guard_.arm();
  temperature_guard_.reset();
  return ok();
}

Result<> Manipulator::pre_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  return ok();
}

/// The control law runs on the present position: what would be commanded is visible, nothing moves.
Result<> Manipulator::safe_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    stop_motion(why_stopped());
    engage();
  }
  rest();
  control(cycle);
  check_torque(cycle);
  return ok();
}

Result<> Manipulator::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    engage();
    torque_guard_.arm();
  }
  if (!cycle.active) {
    stop_motion(why_stopped());  // inhibited it could never end
    rest();
  } else if (coupled_) {
    follow();
  } else if (programme_ != nullptr) {
    advance_programme(cycle);
  } else {
    advance_motion(cycle);
  }
  if (cycle.active) govern(cycle);
  watch_tool();
  control(cycle);
  check_torque(cycle);
  if (temperature_guard_.too_hot()) inhibit_actuators();
  moving_ = cycle.active && !torque_guard_.tripped();
  active_.store(moving_ ? 1 : 0);
  return ok();
}

Result<> Manipulator::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) stop_motion(why_stopped());
  robot_.output() = {};
  return ok();
}

void Manipulator::measure(const Cycle& cycle) noexcept {
  const RobotInput& in = robot_.input();
  current_.store({static_cast<std::int32_t>(cycle.state), in.position_rad, in.velocity_rad_per_s, in.torque_n_m,
                  in.temperature_deg_c, robot_.flags()});
  observe(in);
  active_.store(0);
  moving_ = false;
  check_temperature(cycle);
}

// --- the setpoint ------------------------------------------------------------------------------------------------------

/// Takes the present position as the reference: entering Operational moves nothing.
void Manipulator::engage() noexcept {
  rest();
  trajectory_.start(asked_, asked_, 0.0);
  following_ = false;
  engage_clutch();
}

void Manipulator::rest() noexcept {
  asked_ = robot_.input().motor_position_rad;
  controller_->reset(asked_);
  set_desired(asked_);
  governor_.reset(desired_position_.load());
  gains_.reset(wanted_gains());
}

/// Stays where the setpoint is.
void Manipulator::hold() noexcept {
  asked_ = desired_position_.load();
  trajectory_.start(asked_, asked_, 0.0);
}

/// From here the handle moves the setpoint: neither the handle's angle now nor a link that was away makes it jump.
void Manipulator::engage_clutch() noexcept {
  clutch_.engage(desired_position_.load(), handle_.value().position_rad);
  clutch_values_.store({clutch_.joint_rad(), clutch_.handle_rad()});
}

void Manipulator::follow() noexcept {
  const bool enabled = handle_.valid() && handle_.value().enable != 0;
  if (enabled && !following_) engage_clutch();
  following_ = enabled;
  if (!enabled) return;  // hold the last setpoint
  asked_ = clutch_.desired(handle_.value().position_rad, position_scale_.load());
}

void Manipulator::advance_motion(const Cycle& cycle) noexcept {
  asked_ = trajectory_.advance(seconds(cycle.period));
  trajectory_values_.store({trajectory_.target_rad(), trajectory_.duration_s(), trajectory_.progress()});
  if (!move_) return;
  if (!half_reported_ && trajectory_.progress() >= 0.5) {
    half_reported_ = true;
    progress(*move_, 1);
  }
  if (trajectory_.done()) arrive(move_, trajectory_.target_rad(), cycle);
}

void Manipulator::advance_programme(const Cycle& cycle) noexcept {
  asked_ = programme_->advance(seconds(cycle.period));
  if (const auto wanted = programme_->tool(); wanted && !tool_call_) {
    tool_call_ = programme_call_;
    tool_.want(*wanted);
  }
  if (programme_->leg() != reported_leg_ && !programme_->done()) {
    reported_leg_ = programme_->leg();
    progress(*programme_call_, static_cast<std::uint16_t>(reported_leg_));
  }
  if (!programme_->done()) return;
  arrive(programme_call_, programme_->goal_rad(), cycle);
  if (!programme_call_) programme_ = nullptr;
}

/// The end of a path is not yet the goal: a motion is done when it is measured there.
void Manipulator::arrive(std::optional<Call>& call, const Joints& goal_rad, const Cycle& cycle) noexcept {
  using Verdict = manipulator::Arrival::Verdict;
  const Verdict verdict =
      arrival_.judge(robot_.input().position_rad, goal_rad, goal_tolerance_.load(), seconds(cycle.period));
  if (verdict == Verdict::UnderWay) return;
  if (verdict == Verdict::There) {
    raise(motion_done_);
    finish(*call);
  } else {
    abort(*call, Trouble::goal_not_reached);
  }
  call.reset();
  hold();
}

/// Waits for the device to hold what was asked for.
void Manipulator::watch_tool() noexcept {
  using Verdict = manipulator::ToolWatch::Verdict;
  const Verdict verdict = tool_.update(robot_.input().tool);
  if (verdict == Verdict::Done) {
    if (programme_ != nullptr) programme_->tool_done();
    else finish(*tool_call_);
    tool_call_.reset();
  } else if (verdict == Verdict::Failed) {
    abort(*tool_call_, pus::FailureCode::DeviceError);
    tool_call_.reset();
    if (programme_ == nullptr) return;
    programme_call_.reset();
    programme_ = nullptr;
    hold();
  }
}

void Manipulator::stop_motion(pus::FailureCode why) noexcept {
  hold();
  if (programme_call_) tool_call_.reset();  // it is the same call
  programme_ = nullptr;
  tool_.forget();
  for (auto* call : {&move_, &programme_call_, &tool_call_}) {
    if (!*call) continue;
    abort(**call, why);
    call->reset();
  }
}

Joints Manipulator::within_range(Joints position_rad) const noexcept {
  for (std::size_t i = 0; i < position_rad.size(); ++i)
    position_rad[i] = std::clamp(position_rad[i], lowest_rad_[i], highest_rad_[i]);
  return position_rad;
}

void Manipulator::set_desired(const Joints& position_rad) noexcept {
  desired_position_.store(within_range(position_rad));
}

/// What is asked for reaches the control law within the bounds of the governor only.
void Manipulator::govern(const Cycle& cycle) noexcept {
  asked_ = within_range(asked_);
  const auto bounds = manipulator::bounds_for(torque_hard_.load(), gains_.now().kp_n_m_per_rad);
  set_desired(governor_.advance(asked_, robot_.input().motor_position_rad, bounds, seconds(cycle.period)));
}

// --- the law and its guards --------------------------------------------------------------------------------------------

manipulator::Gains Manipulator::wanted_gains() const noexcept {
  const double effort_n_m = torque_hard_.load();
  return {kp_.load(), kd_.load(), effort_n_m, effort_n_m / 3};
}

manipulator::Measured Manipulator::measured() const noexcept {
  const RobotInput& in = robot_.input();
  return {in.motor_position_rad, in.motor_velocity_rad_per_s, in.position_rad, in.velocity_rad_per_s, in.torque_n_m};
}

/// From the law to what is put out.
void Manipulator::drive(const Joints& desired_rad, const manipulator::Measured& measured) noexcept {
  robot_.output().torque_n_m = law_(*controller_, desired_rad, measured, gains_.now());
}

void Manipulator::control(const Cycle& cycle) noexcept {
  const manipulator::Gains wanted = wanted_gains();
  const manipulator::Gains& gains = gains_.advance(wanted, seconds(cycle.period));
  gain_values_.store({gains.kp_n_m_per_rad, gains.kd_n_m_s_per_rad});
  if (gains_call_ && gains_.reached(wanted)) {
    finish(*gains_call_);
    gains_call_.reset();
  }
  robot_.output().tool = tool_.busy() ? tool_.wanted() : robot_.input().tool;
  drive(desired_position_.load(), measured());
  desired_velocity_.store(controller_->desired_velocity_rad_s());
}

/// Each limit is told once until the next entry into Operational; a higher one whatever a lower one did, and when the
/// actuators are inhibited too: what goes on loading the arm then is worse, not better.
void Manipulator::check_torque(const Cycle& cycle) noexcept {
  using Watch = manipulator::TorqueGuard::Watch;
  const double soft = torque_limit_.load();
  const double hard = torque_hard_.load();
  const auto finding =
      torque_guard_.update(robot_.input().torque_n_m, soft, hard, cycle.active ? Watch::Both : Watch::HardOnly);
  if (!finding) return;
  inhibit_actuators();
  const bool is_hard = finding->verdict == TorqueVerdict::Hard;
  raise(is_hard ? torque_hard_exceeded_ : torque_limit_exceeded_, static_cast<std::uint8_t>(finding->joint + 1),
        finding->value_n_m, is_hard ? hard : soft);
}

/// What a function that runs is told when the actuators were taken away from it.
pus::FailureCode Manipulator::why_stopped() const noexcept {
  if (torque_guard_.tripped()) return static_cast<pus::FailureCode>(Trouble::torque_tripped);
  if (temperature_guard_.too_hot()) return static_cast<pus::FailureCode>(Trouble::too_hot);
  return pus::FailureCode::Aborted;
}

void Manipulator::check_temperature(const Cycle& cycle) noexcept {
  using Moment = manipulator::TemperatureGuard::Moment;
  const auto limits = temperature_limits_.load();
  const bool entry = cycle.state == State::Operational && cycle.first;
  const auto finding = temperature_guard_.update(robot_.input().temperature_deg_c, {limits[0], limits[1], limits[2]},
                                                 entry ? Moment::EntryIntoOperational : Moment::Other);
  if (!finding) return;
  const auto& event = finding->verdict == TemperatureVerdict::Warning    ? temperature_warning_
                      : finding->verdict == TemperatureVerdict::Critical ? temperature_critical_
                                                                         : temperature_maximum_;
  raise(event, static_cast<std::uint8_t>(finding->joint + 1), static_cast<float>(finding->value_c));
}

// --- functions ---------------------------------------------------------------------------------------------------------

Outcome Manipulator::move(const Joints& target_rad, double duration_s, const Call& call) noexcept {
  if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (move_ || programme_ != nullptr) return refused(pus::FailureCode::Busy);
  const Joints from = desired_position_.load();
  if (duration_s < manipulator::shortest_duration_s(from, target_rad, manipulator::path_limits))
    return refused(Trouble::too_fast);
  trajectory_.start(from, target_rad, duration_s);
  arrival_.start();
  move_ = call;
  half_reported_ = false;
  return running;
}

Outcome Manipulator::run(manipulator::Programme& programme, const Call& call) noexcept {
  programme_ = &programme;
  programme_call_ = call;
  arrival_.start();
  reported_leg_ = 0;
  return running;
}

Outcome Manipulator::use_tool(std::uint8_t wanted, const Call& call) noexcept {
  tool_call_ = call;
  tool_.want(wanted);
  return running;
}

/// The law takes new gains over at a bounded rate: done when they are in force.
Outcome Manipulator::set_gains(double kp, double kd, const Call& call) noexcept {
  if (gains_call_) return refused(pus::FailureCode::Busy);
  kp_.store(kp);
  kd_.store(kd);
  if (!moving_) return ok();  // at rest the law has them at once
  gains_call_ = call;
  return running;
}

/// A limit that the arm's present load exceeds already would only stop it.
Outcome Manipulator::set_torque_limit(double limit_n_m) noexcept {
  if (!(manipulator::largest(robot_.input().torque_n_m) < limit_n_m)) return refused(Trouble::load_above_limit);
  torque_limit_.store(limit_n_m);
  return ok();
}

}  // namespace hirosco
