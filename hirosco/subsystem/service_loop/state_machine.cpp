// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include "hirosco/subsystem/service_loop/state_machine.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/subsystem/service_loop/cycle_reports.hpp"

namespace hirosco {
namespace {

constexpr Duration transient_limit = 10s;

}  // namespace

std::expected<void, pus::FailureNotice> StateMachine::command(State target, const pus::Request& request) {
  // Down to Error-Operational overrides a change between cyclic states that the cycle has not confirmed yet.
  const bool overrides = at_.way && target == State::ErrorOperational && is_cyclic(at_.state) &&
                         is_cyclic(at_.way->states[way_at_]) && at_.way->states[way_at_] != State::ErrorOperational;
  if (at_.way && !overrides) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  // Nothing is begun on what a cycle that never came to rest may still be using.
  if (at_.release_owed) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  if (!route(at_.state, target)) return std::unexpected{at_.wrong_state()};
  if (target == State::SafeOperational && at_.state == State::PreOperational) {
    if (at_.configuration == nullptr) return std::unexpected{at_.wrong_state()};
    if (!parts_.links.required_attached()) return std::unexpected{pus::FailureNotice{pus::FailureCode::LinkAbsent}};
  }
  if (target == State::ErrorOperational && at_.configuration == nullptr) return std::unexpected{at_.wrong_state()};
  if (target == State::Operational &&
      !parts_.permit.page().permits(parts_.permit.page().epoch.load(std::memory_order_acquire)))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::NotPermittedNow}.with(std::uint8_t{0})};
  if (target == State::Operational)
    if (const auto missing =
            parts_.self_tests.keeps_from_operational(*at_.configuration, parts_.cycle.self_test_passed()))
      return std::unexpected{*missing};
  if (overrides && way_request_)
    parts_.reports.verification().completion_failed(*way_request_, pus::FailureNotice{pus::FailureCode::Aborted});
  parts_.reports.verification().started(request);
  go(target, request);
  return {};
}

void StateMachine::go(State target, std::optional<pus::Request> request) {
  at_.way = route(at_.state, target);
  way_at_ = 0;
  way_request_ = at_.way ? request : std::nullopt;
  phase_entered_ = false;
  awaiting_cycle_ = answer_owed_ = false;
}

/// The cycle controls already. Who has never been heard is lost there within its limit, the last fall-back included.
void StateMachine::look_for_first_answer() {
  if (parts_.cycle.device_inputs().awaits_first_answer()) return;
  awaiting_cycle_ = answer_owed_ = false;
  if (const auto device = parts_.cycle.device_inputs().never_answered())
    return fail_transition(State::SafeOperational, never_answered_failure(*device));
  arrive(State::SafeOperational);
}

/// "device ARM: never heard (udp 127.0.0.1:5001)".
Failure StateMachine::never_answered_failure(const DeviceInputs::NeverAnswered& device) const {
  std::string text =
      "device " + parts_.descriptor.devices[device.device].name + ": " + std::string{to_text(device.reason)};
  const auto use = std::ranges::find(at_.configuration->devices, device.device, &descriptor::DeviceUse::device);
  if (use != at_.configuration->devices.end())
    text += " (" + std::string{to_text(use->endnode.transfer)} + " " + use->endnode.address + ")";
  return {ErrorCode::Unavailable, std::move(text), device.device};
}

void StateMachine::advance(TimePoint now) {
  if (at_.way && answer_owed_) look_for_first_answer();
  if (at_.way && awaiting_cycle_ && now > phase_deadline_)
    fail_transition(at_.way->states[way_at_], {ErrorCode::Timeout, "time limit of the cycle"});
  // Several transient states may be done in one step; each round either arrives somewhere or waits.
  for (int rounds = 0; at_.way && !awaiting_cycle_ && rounds < 8; ++rounds)
    if (!run_phase(at_.way->states[way_at_], now)) return;
}

/// One phase on the way into `next`; false while there is something to wait for.
bool StateMachine::run_phase(State next, TimePoint now) {
  if (!phase_entered_) {
    phase_entered_ = true;
    phase_deadline_ = now + transient_limit;
  }
  const bool cycle_node = is_cyclic(next) && at_.configuration != nullptr && parts_.orders.wanted();
  if (cycle_node) {
    // Nothing moves yet: who begins is given time to, which the limit of somebody's silence is not made for (docs/adr/0128).
    if (next == State::SafeOperational && at_.state == State::PreOperational &&
        parts_.cycle.device_inputs().awaits_first_answer() &&
        now <= phase_deadline_ - transient_limit + first_answer_limit)
      return false;
    // What ST[20] has found permitted in a loop of its own is queued before this, or judged once more (docs/adr/0200).
    const LockGuard lock{parts_.values.judging()};
    parts_.values.send_into(next);
    awaiting_cycle_ =
        parts_.rings.command({.kind = CommandKind::EnterState, .index = static_cast<std::uint16_t>(next)});
    return false;
  }
  if (is_transient(next) && at_.state != next) arrive_transient(next);
  const Result<Step> outcome = enter_transient(next);
  if (!outcome) {
    const Error& error = outcome.error();
    fail_transition(next, {error.code, error.text, error.value});
    return true;
  }
  if (*outcome == Step::Again) {
    if (now <= phase_deadline_) return false;
    fail_transition(next, {ErrorCode::Timeout, "time limit"});
    return true;
  }
  arrive(next);
  return true;
}

/// A transient state is entered before its phases run: it shows in telemetry while it lasts.
void StateMachine::arrive_transient(State state) {
  at_.state = state;
  parts_.vital.state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
}

Result<Step> StateMachine::enter_transient(State next) {
  switch (next) {
    case State::SoftwareInit: return parts_.introduction.step();
    case State::HardwareInit:
      if (powered(power_on)) return parts_.author.hardware_init();
      if (powered(power_unknown_version))
        return fail(ErrorCode::Mismatch, "a power switch is of another version: build both from one hirosco");
      if (power_takes_too_long()) return fail(ErrorCode::Timeout, "a device is not switched on");
      return again;
    case State::PostOperational: return leave_cycle();
    case State::HardwareDeinit: return parts_.author.hardware_deinit();
    case State::SoftwareDeinit: parts_.values.remember_persistent(); return parts_.introduction.undo(!at_.release_owed);
    case State::Offline:
      if (powered(power_off)) return done;
      if (!power_takes_too_long()) return again;
      parts_.reports.raise_failure(descriptor::framework_event::state_failed, static_cast<std::uint8_t>(State::Offline),
                                   {ErrorCode::Timeout, "a device is still switched on"});
      return done;
    default: return done;
  }
}

/// The supervisor's side switches, as it reads the state on the vital page (adr 0079).
bool StateMachine::powered(Power wanted) const noexcept {
  return parts_.descriptor.power_switches.empty() ||
         parts_.permit.page().powered.load(std::memory_order_acquire) == wanted;
}

bool StateMachine::power_takes_too_long() const noexcept {
  return parts_.platform.clock.now() > phase_deadline_ - transient_limit + power_limit;
}

/// Stops the cycle, gives back what Pre-Operational took, then lets the author finish.
Result<Step> StateMachine::leave_cycle() {
  parts_.orders.rest();
  if (!parts_.orders.rests()) return again;
  parts_.cycle_reports.take();
  if (at_.configuration != nullptr) parts_.configurations.release();
  return parts_.author.post_operational();
}

/// A cycle that did not come to rest in time still uses its configuration: that is given back when it has. In Offline the rest follows, which
/// the way down left behind because it did not, or the author failed in his Software-Deinit or still held blocks.
void StateMachine::release_late() {
  if (at_.release_owed) {
    if (!parts_.orders.rests()) return;
    at_.release_owed = false;
    parts_.cycle_reports.take();
    parts_.configurations.release();
    // It may have entered a state late, and said so there: nobody is in that.
    parts_.vital.state.store(static_cast<std::uint32_t>(at_.state), std::memory_order_release);
  }
  if (at_.state != State::Offline) return;
  const auto undone = parts_.introduction.undo_late();
  if (undone) return;
  const Error& why = undone.error();
  parts_.reports.raise_failure(descriptor::framework_event::state_failed,
                               static_cast<std::uint8_t>(State::SoftwareDeinit), {why.code, why.text, why.value});
}

void StateMachine::be_in(State state) {
  at_.state = state;
  {
    const LockGuard lock{parts_.values.judging()};
    parts_.values.send_into(std::nullopt);
    parts_.vital.state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
  }
  const double entered = static_cast<double>(state);
  parts_.reports.raise(descriptor::framework_event::state_changed, {&entered, 1});
}

void StateMachine::arrive(State state) {
  be_in(state);
  phase_entered_ = false;
  if (++way_at_ < at_.way->size) return;
  if (way_request_) parts_.reports.verification().completed(*way_request_);
  at_.way.reset();
  way_request_.reset();
}

void StateMachine::fail_transition(State failed, const Failure& why) {
  // Ground hears the first mistake and how many there are; the author each, on a line of its own.
  const bool by_mistakes = failed == State::SoftwareInit && !parts_.introduction.mistakes().empty();
  const auto explain = [&](const std::string& words) {
    if (parts_.platform.explain)
      parts_.platform.explain(parts_.descriptor.name + ": " + std::string{to_text(failed)} + " failed: " + words);
  };
  if (!by_mistakes) explain(why.text);
  else
    for (const Mistake& mistake : parts_.introduction.mistakes()) explain(parts_.introduction.words_of(mistake));
  parts_.reports.raise_failure(descriptor::framework_event::state_failed, static_cast<std::uint8_t>(failed), why);
  if (way_request_)
    parts_.reports.verification().completion_failed(
        *way_request_, pus::FailureNotice{pus::FailureCode::ExecutionError}.because({why.code, why.number, why.text}));
  way_request_.reset();
  at_.way.reset();
  const auto target = failure_target(failed);
  if (failed == State::PostOperational && at_.configuration != nullptr) {
    parts_.configurations.end();
    at_.release_owed = true;
  }
  if (!target) {
    // A deinit that fails cannot stop the way down: what is left is given back in Offline or by the end of the process.
    if (failed == State::HardwareDeinit || failed == State::SoftwareDeinit || failed == State::PostOperational)
      go_down_from(failed);
    return;
  }
  if (is_cyclic(failed)) return go(State::ErrorOperational, std::nullopt);
  go_down_from(failed);
}

/// The way to Offline that begins behind a failed state.
void StateMachine::go_down_from(State failed) {
  constexpr std::array down{State::PostOperational, State::HardwareDeinit, State::SoftwareDeinit, State::Offline};
  const State first = failed == State::SoftwareInit      ? State::SoftwareDeinit
                      : failed == State::HardwareInit    ? State::HardwareDeinit
                      : failed == State::PostOperational ? State::HardwareDeinit
                      : failed == State::HardwareDeinit  ? State::SoftwareDeinit
                                                         : State::Offline;
  Route way;
  for (auto state = std::ranges::find(down, first); state != down.end(); ++state) way.states[way.size++] = *state;
  parts_.introduction.forget_mistakes();
  at_.way = way;
  way_at_ = 0;
  phase_entered_ = false;
  awaiting_cycle_ = answer_owed_ = false;
}

void StateMachine::cycle_entered(State state) {
  if (awaits(state)) {
    // Where a device has not answered yet nobody can say that it was a success (docs/adr/0147).
    answer_owed_ = at_.state == State::PreOperational && at_.way->states[way_at_] == State::SafeOperational;
    if (answer_owed_) return look_for_first_answer();
    awaiting_cycle_ = false;
    arrive(at_.way->states[way_at_]);
  } else if (!at_.way && parts_.orders.wanted() && state != at_.state) {
    // One whose time was over, and who comes after all: the cycle is where it says, and what follows begins there.
    be_in(state);
  }
}

void StateMachine::cycle_refused(State state, const Failure& why) { fail_transition(state, why); }

void StateMachine::node_failed(State state, const Failure& why) {
  // While the cycle comes to rest the subsystem is on its way down already: Error-Operational has no cycle there.
  if (parts_.orders.wanted()) fail_transition(state, why);
  else parts_.reports.raise_failure(descriptor::framework_event::state_failed, static_cast<std::uint8_t>(state), why);
}

void StateMachine::react_to_silence() {
  if (!parts_.permit.unheard()) return;
  if (at_.way) return;
  if (at_.state == State::Offline) {
    finished_ = parts_.permit.gone();
    return;
  }
  if (at_.state == State::Operational) return go(State::ErrorOperational, std::nullopt);
  // A silent supervisor may come back: stay in a safe state. One that is gone for good will not.
  if (parts_.permit.gone()) go(State::Offline, std::nullopt);
}

}  // namespace hirosco
