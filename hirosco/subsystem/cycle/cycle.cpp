// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/cycle.hpp"

#include <utility>

namespace hirosco {

CycleLoop::CycleLoop(const Parts& parts)
    : parts_{parts},
      reports_{parts_.descriptor.events, parts_.rings},
      permit_{parts_.permit, {control_, reports_, parts_.vital}},
      self_test_{reports_},
      device_inputs_{{parts_.descriptor, plan_, control_, self_test_, reports_}},
      inputs_{{plan_, control_, device_inputs_, reports_, parts_.vital}},
      gate_{{parts_.descriptor, plan_, control_, permit_, device_inputs_}},
      bumpless_change_{
          {parts_.author, parts_.descriptor, parts_.dictionary, plan_, control_, permit_, self_test_, reports_}},
      own_writes_{parts_.descriptor, parts_.dictionary},
      meter_{{parts_.clock, parts_.rings, parts_.vital, parts_.realtime, parts_.resources, parts_.loops, reports_}} {}

void CycleLoop::prepare(CyclePlan plan) {
  plan_ = std::move(plan);
  self_test_.forget();
  gate_.begin();
  control_.begin();
  first_ = true;
  inputs_.begin();
  permit_.begin();
  begin_counting(*plan_.configuration);
  meter_.begin_links();
  own_writes_.begin();
}

/// What of a configuration the cycle counts begins anew; its state, links and devices stay.
void CycleLoop::begin_counting(const descriptor::Configuration& configuration) noexcept {
  in_force_.store(&configuration, std::memory_order_release);
  count_ = 0;
  permit_.follow(configuration.sampling);
  pace_.begin(configuration, parts_.precise);
  meter_.begin(configuration, pace_.wait().spin);
}

void CycleLoop::release() {
  self_test_.forget();
  for (LinkInputSlot& input : plan_.inputs) input.release();
  for (LinkOutputSlot& output : plan_.outputs) output.release();
  plan_ = {};
}

TimePoint CycleLoop::step(TimePoint planned, std::optional<Duration> spun_from) noexcept {
  const RealtimeScope forbidden;
  const TimePoint started = parts_.clock.now();
  // Asked after its instant, so that the question makes no cycle late.
  if (spun_from) meter_.account_spin(parts_.clock.processor() - *spun_from);
  const CyclePace::Start start = pace_.start(planned, started);
  permit_.take_offered();
  permit_.listen(start.counts);
  permit_.check();
  take_commands(start.planned);
  // Looked at before the samples are read: what comes meanwhile starts another cycle, and none is slept through.
  const LinkInputSlot* const starter = inputs_.starter();
  pace_.look(starter != nullptr ? starter->arrival_word() : nullptr);
  inputs_.read(started, start.counts);
  pace_.rely(starter != nullptr && starter->reliable());
  own_writes_.note_stores();
  run_node(start.planned);
  own_writes_.note_own_writes();
  bumpless_change_.end();
  gate_.write_outputs(start.planned);
  if (plan_.sampler != nullptr && start.counts) plan_.sampler->tick(*this, reports_);
  ++count_;
  meter_.hold_to_realtime(forbidden.uses());
  account(start, started);
  const CyclePace::Next next = pace_.next(start.planned, parts_.clock.now());
  if (next.skipped != 0) parts_.vital.missed.fetch_add(next.skipped, std::memory_order_relaxed);
  return next.due;
}

void CycleLoop::take_commands(TimePoint planned) noexcept {
  // Bounded by the ring: at most what was there when the cycle began. Counted first: what was queued before one of them is set before it.
  std::size_t left = parts_.rings.commands.size();
  parts_.writes.apply(parts_.dictionary);
  for (; left > 0; --left) {
    const auto command = parts_.rings.commands.try_pop();
    if (!command) return;
    switch (command->kind) {
      case CommandKind::Function: run_function(*command); break;
      case CommandKind::EnterState: enter(static_cast<State>(command->index)); break;
      case CommandKind::AttachInput: attach_input(*command); break;
      case CommandKind::DetachInput: detach_input(*command); break;
      case CommandKind::AttachOutput: plan_.outputs[command->index].attach(command->link); break;
      case CommandKind::DetachOutput: detach_output(*command); break;
      case CommandKind::Reconfigure: reconfigure(*command->reconfiguration, planned); break;
      case CommandKind::SelfTest: begin_self_test(*command); break;
    }
  }
}

void CycleLoop::attach_input(const CycleCommand& command) noexcept {
  plan_.inputs[command.index].attach(command.link);
  // What the two agreed on may be of the configuration before.
  plan_.inputs[command.index].follow(plan_.configuration->sampling);
}

void CycleLoop::detach_input(const CycleCommand& command) noexcept {
  plan_.inputs[command.index].detach(command.link);
  reports_.report(ReportKind::InputDetached, command.index, {}, command.link);
}

void CycleLoop::detach_output(const CycleCommand& command) noexcept {
  plan_.outputs[command.index].detach(command.link);
  reports_.report(ReportKind::OutputDetached, command.index, {}, command.link);
}

void CycleLoop::begin_self_test(const CycleCommand& command) noexcept {
  self_test_.begin(command.request, plan_.configuration->self_test_within);
  self_test_.leave(control_.state());  // it may have gone meanwhile
}

void CycleLoop::run_function(const CycleCommand& command) noexcept {
  pus::ArgumentReader reader{parts_.descriptor.functions[command.index].arguments, command.arguments};
  const AuthorCall watched{author_uses_, nullptr, command.index};
  const Outcome outcome = functions_[command.index](reader, Call{command.request});
  switch (outcome.kind) {
    case Outcome::Kind::Refused:
      reports_.fail_call(ReportKind::Refused, outcome.code, command.request, outcome.reason);
      return;
    case Outcome::Kind::Running: reports_.report(ReportKind::Started, 0, command.request); return;
    case Outcome::Kind::Done:
      reports_.report(ReportKind::Started, 0, command.request);
      reports_.report(ReportKind::Finished, 0, command.request);
      return;
  }
}

void CycleLoop::reconfigure(Reconfiguration& wanted, TimePoint planned) noexcept {
  const AuthorCall watched{author_uses_, "bumpless()"};
  if (!bumpless_change_.begin(wanted, planned)) return;
  begin_counting(*wanted.to);
  parts_.vital.period_ns.store(static_cast<std::uint64_t>(wanted.to->sampling.count()), std::memory_order_relaxed);
  parts_.vital.configuration.store(wanted.to->id, std::memory_order_release);
}

const char* CycleLoop::why_not(State state) const noexcept {
  if (state != State::Operational) return nullptr;
  // A node that failed is not healed by an entry that was on its way already: the way down follows (hazard SF10).
  if (control_.failed()) return "a node had failed before";
  // The service loop has looked, too; what voids it may have come in between.
  const bool required = plan_.configuration->self_test == descriptor::SelfTest::Required;
  return required && !self_test_.passed() ? "the required self test is not passed" : nullptr;
}

void CycleLoop::enter(State state) noexcept {
  if (const char* const why = why_not(state))
    return reports_.explain({.kind = ReportKind::EntryRefused, .index = static_cast<std::uint16_t>(state)},
                            {ErrorCode::NotPermitted, why});
  self_test_.leave(state);
  const bool lets_go = control_.state() == State::Operational && state != State::Operational;
  control_.enter(state);
  first_ = true;
  // Before anybody is told of it, and before the author's node, which may hang: the first thing on the way down is to let go.
  if (lets_go) gate_.write_devices();
  if (state == State::Operational) {
    permit_.enter_operational();
    control_.clear();
    permit_.check();
  }
  reports_.report(ReportKind::StateEntered, static_cast<std::uint16_t>(state), {});
  // Before anything moves, as what moved was told to let go, and whether or not the service loop goes on to say so: an arm that acts stands beside no page of another
  // state. After the report, so that who reads the page is not refused for a state that the service loop has not heard of.
  parts_.vital.state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
}

void CycleLoop::run_node(TimePoint planned) noexcept {
  const Cycle cycle{.planned = planned,
                    .period = plan_.configuration->sampling,
                    .count = count_,
                    .state = control_.state(),
                    .first = first_,
                    .active = control_.active()};
  first_ = false;
  Result<> result;
  {
    const AuthorCall watched{author_uses_, control_.state()};
    switch (control_.state()) {
      case State::PreOperational: result = parts_.author.pre_operational(cycle); break;
      case State::SafeOperational: result = parts_.author.safe_operational(cycle); break;
      case State::Operational: result = parts_.author.operational(cycle); break;
      case State::ErrorOperational: result = parts_.author.error_operational(cycle); break;
      default: break;
    }
  }
  if (control_.failed()) return;
  if (result || control_.state() == State::ErrorOperational) return run_self_test(cycle);
  control_.inhibit(inhibited_by_failure);
  self_test_.fail_node();
  reports_.explain({.kind = ReportKind::NodeFailed, .index = static_cast<std::uint16_t>(control_.state())},
                   result.error());
}

/// In Safe-Operational only: there write_outputs() passes nothing on to an actuator, whatever the test does.
void CycleLoop::run_self_test(Cycle cycle) noexcept {
  if (!self_test_.running()) return;
  cycle.first = self_test_.first(cycle.planned);
  const AuthorCall watched{author_uses_, "self_test()"};
  self_test_.take(parts_.author.self_test(cycle), cycle.planned);
}

void CycleLoop::account(const CyclePace::Start& start, TimePoint started) noexcept {
  const TimePoint finished = parts_.clock.now();
  const LinkInputSlot* const starter = inputs_.starter();
  const Duration late = started - start.planned;
  // Of a cycle that a sample started: since the instant that this is of.
  const bool by_sample = start.arrived && starter != nullptr;
  const auto waited = by_sample ? starter->newest_latency() : std::nullopt;
  meter_.account({.execution = finished - started,
                  .latency = waited.value_or(late),
                  .late = late,
                  .count = count_,
                  .inhibited = control_.inhibited()},
                 plan_.inputs);
}

std::size_t CycleLoop::sample(std::uint16_t parameter, int member, MutableOctets big_endian) noexcept {
  return parts_.dictionary.encode(parameter, member, big_endian);
}

}  // namespace hirosco
