// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: cycle (docs/safety/modules.csv).
#include "hirosco/subsystem/cycle/cycle.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"

namespace hirosco {
namespace {

[[nodiscard]] Octets octets_of_report(const CycleReport& report) noexcept {
  return std::as_bytes(std::span{&report, 1});
}

/// Bin of CycleTimes.
std::size_t bin_of(Duration span) noexcept {
  constexpr std::int64_t ns_per_us = 1000;
  const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(span.count() / ns_per_us, 0));
  return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(us)), CycleTimes{}.execution.size() - 1);
}

}  // namespace

CycleLoop::CycleLoop(const Parts& parts) : parts_{parts}, permit_{&parts.permit}, offered_permit_{&parts.permit} {
  std::size_t largest = 0;
  for (const auto& event : parts_.descriptor.events) largest = std::max(largest, pus::octets_of(event));
  event_buffer_.resize(largest);
  for (const descriptor::Device& device : parts_.descriptor.devices)
    if (device.actuator && !device.output.empty()) outputs_.push_back(std::make_unique<OutputParameter>(device));
  own_writes_octets_ = parts_.descriptor.parameters.size();
  own_writes_ = std::make_unique<std::atomic<std::uint8_t>[]>(own_writes_octets_);
}

void CycleLoop::prepare(CyclePlan plan) {
  plan_ = std::move(plan);
  self_test_.forget();
  for (const auto& output : outputs_) {
    output->clear();
    for (DeviceSlot& slot : plan_.devices)
      if (&slot.device() == &output->device()) slot.show_in(output.get());
  }
  input_was_stale_.assign(plan_.inputs.size(), 0);
  const auto starts = std::ranges::find_if(plan_.inputs, [](const auto& input) { return input.terms().starts; });
  starter_.reset();
  if (starts != plan_.inputs.end()) starter_ = static_cast<std::size_t>(starts - plan_.inputs.begin());
  state_ = State::PreOperational;
  first_ = true;
  inhibited_ = 0;
  awaits_device_ = false;
  awaits_first_answer_.store(!plan_.devices.empty(), std::memory_order_relaxed);
  never_answered_.store(0, std::memory_order_relaxed);
  taken_over_ = nullptr;
  heartbeat_ = permit().heartbeat.load(std::memory_order_acquire);
  silent_cycles_ = 0;
  begin_counting(*plan_.configuration);
  link_statistics_.store({});
  watched_.clear();
  for (std::size_t i = 0; i < own_writes_octets_; ++i) {
    own_writes_[i].store(0, std::memory_order_relaxed);
    const ParameterCell* cell = parts_.dictionary.cell(i);
    if (parts_.descriptor.parameters[i].writable() && cell != nullptr)
      watched_.push_back({cell, 0, static_cast<std::uint16_t>(i)});
  }
  for (IncomingLink& page : parts_.vital.incoming) page.link.store(0, std::memory_order_relaxed);
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
  if (spun_from) budget_.account_spin(parts_.clock.processor() - *spun_from);
  const CyclePace::Start start = pace_.start(planned, started);
  take_permit();
  listen_to_supervisor(start.counts);
  check_permit();
  take_commands(start.planned);
  // Looked at before the samples are read: what comes meanwhile starts another cycle, and none is slept through.
  pace_.look(starter() != nullptr ? starter()->arrival_word() : nullptr);
  read_inputs(started, start.counts);
  pace_.rely(starter() != nullptr && starter()->reliable());
  note_stores();
  run_node(start.planned);
  note_own_writes();
  end_reconfiguration();
  write_outputs(start.planned);
  if (plan_.sampler != nullptr && start.counts) plan_.sampler->tick(*this, *this);
  ++count_;
  hold_to_realtime(forbidden.uses());
  account(start, started);
  const CyclePace::Next next = pace_.next(start.planned, parts_.clock.now());
  if (next.skipped != 0) parts_.vital.missed.fetch_add(next.skipped, std::memory_order_relaxed);
  return next.due;
}

const LinkInputSlot* CycleLoop::starter() const noexcept { return starter_ ? &plan_.inputs[*starter_] : nullptr; }

bool CycleLoop::controlling() const noexcept {
  return state_ == State::SafeOperational || state_ == State::Operational;
}

void CycleLoop::take_commands(TimePoint planned) noexcept {
  parts_.writes.apply(parts_.dictionary);
  // Bounded by the ring: at most what was there when the cycle began.
  for (std::size_t left = parts_.rings.commands.size(); left > 0; --left) {
    const auto command = parts_.rings.commands.try_pop();
    if (!command) return;
    switch (command->kind) {
      case CommandKind::Function: run_function(*command); break;
      case CommandKind::EnterState: enter(static_cast<State>(command->index)); break;
      case CommandKind::AttachInput: plan_.inputs[command->index].attach(command->link); break;
      case CommandKind::DetachInput:
        plan_.inputs[command->index].detach(command->link);
        report(ReportKind::InputDetached, command->index, {}, command->link);
        break;
      case CommandKind::AttachOutput: plan_.outputs[command->index].attach(command->link); break;
      case CommandKind::DetachOutput:
        plan_.outputs[command->index].detach(command->link);
        report(ReportKind::OutputDetached, command->index, {}, command->link);
        break;
      case CommandKind::Reconfigure: reconfigure(*command->reconfiguration, planned); break;
      case CommandKind::SelfTest:
        self_test_.begin(command->request, plan_.configuration->self_test_within);
        if (state_ != State::SafeOperational) end_self_test(self_test_.leave(state_));
        break;
    }
  }
}

void CycleLoop::run_function(const CycleCommand& command) noexcept {
  pus::ArgumentReader reader{parts_.descriptor.functions[command.index].arguments, command.arguments};
  const Outcome outcome = functions_[command.index].handler(reader, Call{command.request});
  switch (outcome.kind) {
    case Outcome::Kind::Refused: fail_call(ReportKind::Refused, outcome.code, command.request, outcome.reason); return;
    case Outcome::Kind::Running: report(ReportKind::Started, 0, command.request); return;
    case Outcome::Kind::Done:
      report(ReportKind::Started, 0, command.request);
      report(ReportKind::Finished, 0, command.request);
      return;
  }
}

const char* CycleLoop::why_not(State state) const noexcept {
  if (state != State::Operational) return nullptr;
  // A node that failed is not healed by an entry that was on its way already: the way down follows (hazard SF10).
  if ((inhibited_ & inhibited_by_failure) != 0) return "a node had failed before";
  // The service loop has looked, too; what voids it may have come in between.
  const bool required = plan_.configuration->self_test == descriptor::SelfTest::Required;
  return required && !self_test_.passed() ? "the required self test is not passed" : nullptr;
}

void CycleLoop::enter(State state) noexcept {
  if (const char* const why = why_not(state)) {
    const AuthorsError reason{Error{ErrorCode::NotPermitted, why}};
    return answer({.kind = ReportKind::EntryRefused, .index = static_cast<std::uint16_t>(state)},
                  std::as_bytes(std::span{&reason, 1}));
  }
  end_self_test(self_test_.leave(state));
  const bool lets_go = state_ == State::Operational && state != State::Operational;
  state_ = state;
  first_ = true;
  // Before anybody is told of it, and before the author's node, which may hang: the first thing on the way down is to let go.
  if (lets_go) write_devices();
  if (state == State::Operational) {
    entered_epoch_ = permit().epoch.load(std::memory_order_acquire);
    inhibited_ = 0;
    check_permit();
  }
  report(ReportKind::StateEntered, static_cast<std::uint16_t>(state), {});
  // Before anything moves, as what moved was told to let go, and whether or not the service loop goes on to say so: an arm that acts stands beside no page of another
  // state. After the report, so that who reads the page is not refused for a state that the service loop has not heard of.
  parts_.vital.state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
}

void CycleLoop::run_node(TimePoint planned) noexcept {
  const Cycle cycle{.planned = planned,
                    .period = plan_.configuration->sampling,
                    .count = count_,
                    .state = state_,
                    .first = first_,
                    .active = state_ == State::Operational && inhibited_ == 0};
  first_ = false;
  Result<> result;
  switch (state_) {
    case State::PreOperational: result = parts_.author.pre_operational(cycle); break;
    case State::SafeOperational: result = parts_.author.safe_operational(cycle); break;
    case State::Operational: result = parts_.author.operational(cycle); break;
    case State::ErrorOperational: result = parts_.author.error_operational(cycle); break;
    default: break;
  }
  if ((inhibited_ & inhibited_by_failure) != 0) return;
  if (result || state_ == State::ErrorOperational) return run_self_test(cycle);
  inhibit(inhibited_by_failure);
  end_self_test(self_test_.fail_node());
  const AuthorsError failure{result.error()};
  answer({.kind = ReportKind::NodeFailed, .index = static_cast<std::uint16_t>(state_)},
         std::as_bytes(std::span{&failure, 1}));
}

/// In Safe-Operational only: there write_outputs() passes nothing on to an actuator, whatever the test does.
void CycleLoop::run_self_test(Cycle cycle) noexcept {
  if (!self_test_.running()) return;
  cycle.first = self_test_.first(cycle.planned);
  end_self_test(self_test_.take(parts_.author.self_test(cycle), cycle.planned));
}

void CycleLoop::end_self_test(const std::optional<SelfTestRun::End>& end) noexcept {
  if (!end) return;
  const AuthorsError reason{end->why};
  answer({.kind = ReportKind::SelfTestEnded, .index = static_cast<std::uint16_t>(end->code), .request = end->request},
         std::as_bytes(std::span{&reason, 1}));
}

void CycleLoop::note_stores() noexcept {
  for (Watched& watched : watched_) watched.stores = watched.cell->stores();
}

void CycleLoop::note_own_writes() noexcept {
  for (const Watched& watched : watched_) {
    const std::uint8_t own = watched.cell->stores() != watched.stores ? 1 : 0;
    own_writes_[watched.parameter].store(own, std::memory_order_relaxed);
  }
}

void CycleLoop::count_links() noexcept {
  LinkStatistics sum;
  for (std::size_t i = 0; i < plan_.inputs.size(); ++i) {
    LinkInputSlot& input = plan_.inputs[i];
    if (i < parts_.vital.incoming.size()) {
      input.tell(parts_.vital.incoming[i]);
      input.tell(parts_.vital.latencies[i]);
    }
    sum.received += static_cast<std::uint32_t>(input.port()->received());
    sum.lost += static_cast<std::uint32_t>(input.port()->lost());
  }
  link_statistics_.store(sum);
}

void CycleLoop::account(const CyclePace::Start& start, TimePoint started) noexcept {
  const TimePoint finished = parts_.clock.now();
  const Duration execution = finished - started;
  // Of a cycle that a sample started: since the instant that this is of.
  const auto waited = start.arrived && starter() != nullptr ? starter()->newest_latency() : std::nullopt;
  const Duration latency = waited.value_or(started - start.planned);
  latency_max_ns_ = std::max(latency_max_ns_, clamped_ns(latency));
  execution_max_ns_ = std::max(execution_max_ns_, clamped_ns(execution));
  constexpr double weight = 1e-3;
  execution_mean_ns_ += weight * (static_cast<double>(execution.count()) - execution_mean_ns_);

  ++times_.execution[bin_of(execution)];
  ++times_.latency[bin_of(latency)];
  times_parameter_.store(times_);
  count_links();
  hold_to_budget();
  // They change slowly and are many words: not in each cycle.
  constexpr std::uint64_t cycles_between = 16;
  if (count_ % cycles_between == 1) {
    resource_statistics_.store(parts_.resources.statistics());
    heap_uses_.store(
        {realtime_.sum().heap, service_heap_.load(std::memory_order_relaxed), RealtimeScope::hook_present()});
  }
  if (count_ % cycles_between == 2 && parts_.loops.any()) loop_statistics_.store(parts_.loops.statistics());

  if (overruns_.account(execution, started - start.planned)) {
    const double row = overruns_.in_a_row();
    raise(descriptor::framework_event::cycle_overruns, {&row, 1});
  }

  statistics_.store({static_cast<std::uint32_t>(overruns_.count()), static_cast<float>(execution_max_ns_) * 1e-3F,
                     static_cast<float>(execution_mean_ns_ * 1e-3)});
  VitalPage& vital = parts_.vital;
  if (inhibited_ != 0 && vital.inhibited.load(std::memory_order_relaxed) == 0)
    vital.inhibited_at_cycle.store(vital.cycles.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  vital.inhibited.store(inhibited_, std::memory_order_relaxed);
  vital.overruns.store(overruns_.count(), std::memory_order_relaxed);
  vital.latency_max_ns.store(latency_max_ns_, std::memory_order_relaxed);
  vital.execution_max_ns.store(execution_max_ns_, std::memory_order_relaxed);
  vital.execution_mean_ns.store(static_cast<std::uint32_t>(execution_mean_ns_), std::memory_order_relaxed);
  vital.lost_reports.store(static_cast<std::uint32_t>(parts_.rings.dropped()), std::memory_order_relaxed);
  vital.cycles.fetch_add(1, std::memory_order_release);
}

void CycleLoop::hold_to_budget() noexcept {
  if (budget_.account(parts_.clock.processor())) {
    const std::array<double, 2> told{static_cast<double>(budget_.in_a_row()), double{budget_.told().longest_us}};
    raise(descriptor::framework_event::cycle_over_budget, told);
  }
  budget_parameter_.store(budget_.told());
  if (pace_.wait().spin != Duration{}) spin_parameter_.store(budget_.told_spin());
}

void CycleLoop::hold_to_realtime(const RealtimeUses& of_cycle) noexcept {
  if (!realtime_.account(of_cycle)) return;
  const RealtimeUses& sum = realtime_.sum();
  const std::array<double, 3> told{static_cast<double>(sum.heap), static_cast<double>(sum.locks),
                                   static_cast<double>(sum.outputs)};
  raise(descriptor::framework_event::cycle_not_realtime, told);
}

void CycleLoop::raise(std::uint16_t event, std::span<const double> arguments) noexcept {
  const auto& events = parts_.descriptor.events;
  const auto found = std::ranges::find(events, event, &descriptor::Event::id);
  if (found == events.end()) return;
  raise_found(*found, pus::fill_arguments(*found, arguments, event_buffer_));
}

void CycleLoop::raise_encoded(std::uint16_t event, Octets auxiliary) noexcept {
  const auto& events = parts_.descriptor.events;
  const auto found = std::ranges::find(events, event, &descriptor::Event::id);
  if (found != events.end() && pus::octets_of(*found) == auxiliary.size()) raise_found(*found, auxiliary);
}

void CycleLoop::raise_found(const descriptor::Event& event, Octets auxiliary) noexcept {
  CycleReport head{.kind = ReportKind::Event, .index = event.id};
  // A lost device or a stale link is told whatever the author raises besides.
  if (event.id >= descriptor::framework_event::first) return answer(head, auxiliary);
  RecordRing& ring = parts_.rings.events;
  if (event.severity < descriptor::Severity::Medium && ring.used() > ring.capacity() / 2) {
    parts_.rings.lost_remarks.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  head.number = ++report_number_;
  static_cast<void>(ring.try_write(octets_of_report(head), auxiliary));
}

void CycleLoop::report(ReportKind kind, std::uint16_t index, const pus::Request& request, AttachedLink* link) noexcept {
  answer({.kind = kind, .index = index, .request = request, .link = link});
}

void CycleLoop::fail_call(ReportKind kind, pus::FailureCode code, const pus::Request& request,
                          const Error& why) noexcept {
  const AuthorsError error{why};
  answer({.kind = kind, .index = static_cast<std::uint16_t>(code), .request = request},
         std::as_bytes(std::span{&error, 1}));
}

void CycleLoop::answer(CycleReport head, Octets payload) noexcept {
  RecordRing& answers = parts_.rings.answers;
  // Progress is all that an author can have without end: it never takes the last half.
  if (head.kind == ReportKind::Progressed && answers.used() > answers.capacity() / 2) {
    parts_.rings.lost_progress.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  head.number = ++report_number_;
  static_cast<void>(answers.try_write(octets_of_report(head), payload));
}

std::size_t CycleLoop::sample(std::uint16_t parameter, int member, MutableOctets big_endian) noexcept {
  return parts_.dictionary.encode(parameter, member, big_endian);
}

MutableOctets CycleLoop::reserve(std::size_t octets) noexcept {
  reserved_ = parts_.rings.housekeeping.try_reserve(sizeof(CycleReport) + octets);
  return reserved_.empty() ? MutableOctets{} : reserved_.subspan(sizeof(CycleReport));
}

void CycleLoop::commit(std::uint16_t structure, std::size_t octets) noexcept {
  // reserve() left room for the head in front of what it handed out.
  const CycleReport head{.kind = ReportKind::Housekeeping, .index = structure};
  std::ranges::copy(octets_of_report(head), reserved_.begin());
  parts_.rings.housekeeping.commit(sizeof head + octets);
}

}  // namespace hirosco
