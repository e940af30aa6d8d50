// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "subsystems/manipulator/manipulator.hpp"

#include <algorithm>
#include <span>
#include <string_view>

#include "hirosco/descriptor/model/framework_events.hpp"

namespace hirosco {

using manipulator::Joints;
using manipulator::Tasks;
using manipulator::TemperatureGuard;
using manipulator::TorqueGuard;
static_assert(manipulator::max_joints + 1 <= max_function_arguments, "MOVE_TO names each joint, and the time");

namespace {

constexpr double home_duration_s = 3.0;

}  // namespace

std::unique_ptr<Subsystem> make_arm() { return std::make_unique<Manipulator>(); }

Result<Step> Manipulator::software_init() {
  parameters_.each([this](std::string_view name, ParameterCell& cell) { publish(name, cell); });
  // One handle leads at a time: that of the set which the configuration requires.
  for (const auto& set : descriptor::required_sets(own_descriptor())) require_link(set, coupling_.port());
  use_device("ROBOT", drives_.port());
  use_event(motion_done_);
  watch_.each_event([this](EventPort& event) { use_event(event); });
  HIROSCO_TRY(joints_.read(own_descriptor(), desired_rad().size()));
  bind_functions();
  declare();
  return done;
}

void Manipulator::bind_functions() {
  on_function("MOVE_TO", [this](const FunctionValues& values, Call call) -> Outcome {
    return move(Joints::of(std::span{values}.first(joints())), values[joints()], call);
  });
  on_function("HOME", [this](Call call) {
    const double shortest_s = manipulator::shortest_duration_s(desired_rad(), home_rad(), manipulator::path_limits);
    return move(home_rad(), std::max(home_duration_s, shortest_s), call);
  });
  on_function("HOLD", [this]() -> Outcome {
    if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
    if (!moving_) return refused(Trouble::actuators_inhibited);
    stop_tasks(pus::FailureCode::Aborted);
    return ok();
  });
  on_function("SET_GAINS", [this](double kp, double kd, Call call) { return set_gains(kp, kd, call); });
  on_function("SET_TORQUE_LIMIT", [this](double limit_n_m) { return set_torque_limit(limit_n_m); });
  on_function("SET_TEMP_LIMITS", [this](double warning_c, double critical_c, double maximum_c) -> Outcome {
    if (!(warning_c < critical_c && critical_c < maximum_c)) return refused(Trouble::limits_not_ordered);
    parameters_.temperature_limits.store(
        {static_cast<float>(warning_c), static_cast<float>(critical_c), static_cast<float>(maximum_c)});
    return ok();
  });
}

/// What is a number for each joint is so everywhere.
Result<> Manipulator::configure(const descriptor::Configuration& configuration) {
  coupled_ = !configuration.requires_.empty();
  HIROSCO_TRY(drives_.check_lengths(joints()));
  if (coupled_) HIROSCO_TRY(coupling_.check_length(joints()));
  servo_.configure(joints(), seconds(configuration.sampling));
  tasks_.forget();
  gains_call_.reset();
  moving_ = false;
  watch_.reset();
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
    stop_tasks(watch_.why_stopped());
    engage();
  }
  setpoint_.rest();
  control(cycle);
  check_torque(cycle);
  return ok();
}

Result<> Manipulator::operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) {
    engage();
    watch_.arm();
  }
  if (cycle.active) {
    advance(cycle);
  } else {
    stop_tasks(watch_.why_stopped());  // inhibited it could never end
    setpoint_.rest();
  }
  tell(tasks_.watch_tool());
  control(cycle);
  check_torque(cycle);
  if (watch_.too_hot()) inhibit_actuators();
  moving_ = cycle.active && !watch_.tripped();
  parameters_.active.store(moving_ ? 1 : 0);
  return ok();
}

Result<> Manipulator::error_operational(const Cycle& cycle) noexcept {
  measure(cycle);
  if (cycle.first) stop_tasks(watch_.why_stopped());
  drives_.put_nothing_out();
  return ok();
}

void Manipulator::measure(const Cycle& cycle) noexcept {
  drives_.tell(cycle.state);
  observe(drives_.sensed());
  parameters_.active.store(0);
  moving_ = false;
  check_temperature(cycle);
}

/// Entering Operational moves nothing, whoever leads then.
void Manipulator::engage() noexcept {
  setpoint_.engage();
  coupling_.engage(setpoint_.desired_rad());
}

void Manipulator::advance(const Cycle& cycle) noexcept {
  if (!coupled_) tell(tasks_.advance(seconds(cycle.period)));
  else if (const auto asked = coupling_.follow(setpoint_.desired_rad())) setpoint_.ask(*asked);
  setpoint_.govern(seconds(cycle.period));
}

void Manipulator::control(const Cycle& cycle) noexcept {
  const bool in_force = servo_.advance_gains(seconds(cycle.period));
  if (gains_call_ && in_force) {
    finish(*gains_call_);
    gains_call_.reset();
  }
  drives_.hold(tasks_.tool());
  servo_.drive(setpoint_.desired_rad());
}

// --- what comes of it, told --------------------------------------------------------------------------------------------

void Manipulator::tell(const Tasks::News& news) noexcept {
  if (news.step) progress(news.call, *news.step);
  switch (news.end) {
    case Tasks::News::End::None: return;
    case Tasks::News::End::There: raise(motion_done_); [[fallthrough]];
    case Tasks::News::End::ToolHolds: finish(news.call); return;
    case Tasks::News::End::Missed: abort(news.call, Trouble::goal_not_reached); return;
    case Tasks::News::End::ToolFailed: abort(news.call, pus::FailureCode::DeviceError); return;
  }
}

void Manipulator::stop_tasks(pus::FailureCode why) noexcept {
  tasks_.stop([&](const Call& call) { abort(call, why); });
}

/// When the actuators are inhibited, too: what goes on loading the arm then is worse, not better.
void Manipulator::check_torque(const Cycle& cycle) noexcept {
  const auto found = watch_.loads(cycle.active ? TorqueGuard::Watch::Both : TorqueGuard::Watch::HardOnly);
  if (!found) return;
  inhibit_actuators();
  raise(found->event, found->joint, found->value_n_m, found->limit_n_m);
}

void Manipulator::check_temperature(const Cycle& cycle) noexcept {
  using Moment = TemperatureGuard::Moment;
  const bool entry = cycle.state == State::Operational && cycle.first;
  const auto found = watch_.temperatures(entry ? Moment::EntryIntoOperational : Moment::Other);
  if (found) raise(found->event, found->joint, found->value_c);
}

// --- functions ---------------------------------------------------------------------------------------------------------

Outcome Manipulator::move(const Joints& target_rad, double duration_s, const Call& call) noexcept {
  if (coupled_) return refused(pus::FailureCode::SetpointOwnedByLink);
  if (!moving_) return refused(Trouble::actuators_inhibited);
  if (tasks_.moves()) return refused(pus::FailureCode::Busy);
  if (duration_s < manipulator::shortest_duration_s(desired_rad(), target_rad, manipulator::path_limits))
    return refused(Trouble::too_fast);
  tasks_.move(target_rad, duration_s, call);
  return running;
}

Outcome Manipulator::run(manipulator::Programme& programme, const Call& call) noexcept {
  tasks_.run(programme, call);
  return running;
}

Outcome Manipulator::use_tool(std::uint8_t wanted, const Call& call) noexcept {
  tasks_.use_tool(wanted, call);
  return running;
}

/// The law takes new gains over at a bounded rate: done when they are in force.
Outcome Manipulator::set_gains(double kp, double kd, const Call& call) noexcept {
  if (gains_call_) return refused(pus::FailureCode::Busy);
  parameters_.kp.store(kp);
  parameters_.kd.store(kd);
  if (!moving_) return ok();  // at rest the law has them at once
  gains_call_ = call;
  return running;
}

/// A limit that the arm's present load exceeds already would only stop it.
Outcome Manipulator::set_torque_limit(double limit_n_m) noexcept {
  if (!(manipulator::largest(drives_.sensed().torque_n_m) < limit_n_m)) return refused(Trouble::load_above_limit);
  parameters_.torque_limit.store(limit_n_m);
  return ok();
}

}  // namespace hirosco
