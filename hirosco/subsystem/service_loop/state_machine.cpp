// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
// Safety module: states (docs/safety/modules.csv).
#include <algorithm>
#include <array>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"
#include "hirosco/data_transfer/device/frame_protocol.hpp"
#include "hirosco/data_transfer/device/power_frame.hpp"
#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/model/wire_values.hpp"
#include "hirosco/subsystem/cycle/layout_difference.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

/// The state machine of the generic subsystem: commands, phases of transient states, configurations.
namespace hirosco {
namespace {

constexpr Duration transient_limit = 10s;

constexpr const char* port_wanted(LinkKind kind) noexcept {
  switch (kind) {
    case LinkKind::Loaned: return ": is lent, its port is no LoanInput";
    case LinkKind::Queued: return ": is queued, its port is no QueueInput";
    default: return ": is copied, its port is no LinkInput";
  }
}

}  // namespace

std::expected<void, pus::FailureNotice> GenericSubsystem::command_state(State target, const pus::Request& request) {
  // Down to Error-Operational overrides a change between cyclic states that the cycle has not confirmed yet.
  const bool overrides = way_ && target == State::ErrorOperational && is_cyclic(state_) &&
                         is_cyclic(way_->states[way_at_]) && way_->states[way_at_] != State::ErrorOperational;
  if (way_ && !overrides) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  // Nothing is begun on what a cycle that never came to rest may still be using.
  if (release_owed_) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  if (!route(state_, target)) return std::unexpected{wrong_state()};
  if (target == State::SafeOperational && state_ == State::PreOperational) {
    if (configuration_ == nullptr) return std::unexpected{wrong_state()};
    if (!required_links_attached()) return std::unexpected{pus::FailureNotice{pus::FailureCode::LinkAbsent}};
  }
  if (target == State::ErrorOperational && configuration_ == nullptr) return std::unexpected{wrong_state()};
  if (target == State::Operational && !permit_->permits(permit_->epoch.load(std::memory_order_acquire)))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::NotPermittedNow}.with(std::uint8_t{0})};
  if (target == State::Operational)
    if (const auto missing = self_tests_.keeps_from_operational(*configuration_, cycle_.self_test_passed()))
      return std::unexpected{*missing};
  if (overrides && way_request_)
    verification_.completion_failed(*way_request_, pus::FailureNotice{pus::FailureCode::Aborted});
  verification_.started(request);
  go(target, request);
  return {};
}

void GenericSubsystem::go(State target, std::optional<pus::Request> request) {
  way_ = route(state_, target);
  way_at_ = 0;
  way_request_ = way_ ? request : std::nullopt;
  phase_entered_ = false;
  awaiting_cycle_ = answer_owed_ = false;
}

/// The cycle controls already. Who has never been heard is lost there within its limit, the last fall-back included.
void GenericSubsystem::look_for_first_answer() {
  if (cycle_.awaits_first_answer()) return;
  awaiting_cycle_ = answer_owed_ = false;
  if (const auto device = cycle_.never_answered())
    return fail_transition(State::SafeOperational, never_answered_failure(*device));
  arrive(State::SafeOperational);
}

/// "device ARM: never heard (udp 127.0.0.1:5001)".
Failure GenericSubsystem::never_answered_failure(const CycleLoop::NeverAnswered& device) const {
  std::string text = "device " + descriptor_.devices[device.device].name + ": " + std::string{to_text(device.reason)};
  const auto use = std::ranges::find(configuration_->devices, device.device, &descriptor::DeviceUse::device);
  if (use != configuration_->devices.end())
    text += " (" + std::string{to_text(use->endnode.transfer)} + " " + use->endnode.address + ")";
  return {ErrorCode::Unavailable, std::move(text), device.device};
}

void GenericSubsystem::advance(TimePoint now) {
  // A cycle that hangs confirms nothing: the request ends all the same, and the next command is heard.
  if (reconfiguration_request_ && now > reconfiguration_deadline_) give_up_reconfiguration(pus::FailureCode::Timeout);
  if (way_ && answer_owed_) look_for_first_answer();
  if (way_ && awaiting_cycle_ && now > phase_deadline_)
    fail_transition(way_->states[way_at_], {ErrorCode::Timeout, "time limit of the cycle"});
  // Several transient states may be done in one step; each round either arrives somewhere or waits.
  for (int rounds = 0; way_ && !awaiting_cycle_ && rounds < 8; ++rounds)
    if (!run_phase(way_->states[way_at_], now)) return;
}

/// One phase on the way into `next`; false while there is something to wait for.
bool GenericSubsystem::run_phase(State next, TimePoint now) {
  if (!phase_entered_) {
    phase_entered_ = true;
    phase_deadline_ = now + transient_limit;
  }
  const bool cycle_node = is_cyclic(next) && configuration_ != nullptr && wanted_.load(std::memory_order_relaxed);
  if (cycle_node) {
    // Nothing moves yet: who begins is given time to, which the limit of somebody's silence is not made for (docs/adr/0128).
    if (next == State::SafeOperational && state_ == State::PreOperational && cycle_.awaits_first_answer() &&
        now <= phase_deadline_ - transient_limit + first_answer_limit)
      return false;
    awaiting_cycle_ = push({.kind = CommandKind::EnterState, .index = static_cast<std::uint16_t>(next)});
    return false;
  }
  if (is_transient(next) && state_ != next) arrive_transient(next);
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
void GenericSubsystem::arrive_transient(State state) {
  state_ = state;
  vital_.state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
}

Result<Step> GenericSubsystem::enter_transient(State next) {
  switch (next) {
    case State::SoftwareInit: return initialise_software();
    case State::HardwareInit:
      if (powered(power_on)) return author_.hardware_init();
      if (powered(power_unknown_version))
        return fail(ErrorCode::Mismatch, "a power switch is of another version: build both from one hirosco");
      if (power_takes_too_long()) return fail(ErrorCode::Timeout, "a device is not switched on");
      return again;
    case State::PostOperational: return leave_cycle();
    case State::HardwareDeinit: return author_.hardware_deinit();
    case State::SoftwareDeinit: {
      remember_persistent();
      HIROSCO_TRY_LET(const Step step, author_.software_deinit());
      if (step == Step::Done && !release_owed_) forget_introduction();
      return step;
    }
    case State::Offline:
      if (powered(power_off)) return done;
      if (!power_takes_too_long()) return again;
      raise_failure(descriptor::framework_event::state_failed, static_cast<std::uint8_t>(State::Offline),
                    {ErrorCode::Timeout, "a device is still switched on"});
      return done;
    default: return done;
  }
}

/// The supervisor's side switches, as it reads the state on the vital page (adr 0079).
bool GenericSubsystem::powered(Power wanted) const noexcept {
  return descriptor_.power_switches.empty() || permit_->powered.load(std::memory_order_acquire) == wanted;
}

bool GenericSubsystem::power_takes_too_long() const noexcept {
  return platform_.clock.now() > phase_deadline_ - transient_limit + power_limit;
}

Result<Step> GenericSubsystem::initialise_software() {
  const LoopsAtRest at_rest{loops_};
  const auto step = author_.software_init();
  if (step && *step == Step::Again) return again;
  if (!step) mistake(step.error().text);
  publish(descriptor::framework_parameter::cycle_stats, cycle_.statistics());
  publish(descriptor::framework_parameter::cycle_times, cycle_.times());
  publish(descriptor::framework_parameter::cycle_budget, cycle_.budget());
  publish(descriptor::framework_parameter::cycle_spin, cycle_.spin());
  publish(descriptor::framework_parameter::link_stats, cycle_.link_statistics());
  publish(descriptor::framework_parameter::loop_stats, cycle_.loop_statistics());
  publish(descriptor::framework_parameter::resource_stats, cycle_.resource_statistics());
  publish(descriptor::framework_parameter::heap_uses, cycle_.heap_uses());
  publish(descriptor::framework_parameter::descriptor, descriptor_in_force_);
  for (const auto& output : cycle_.outputs()) publish(output->name(), *output);
  if (step) check_introduction();
  if (!problems_.empty()) {
    problems_text_ = short_words_of(problems_.front());
    const Error said =
        step ? Error{ErrorCode::Mismatch, "", static_cast<std::int64_t>(problems_.size())} : step.error();
    return fail(said.code, problems_text_.c_str(), said.value);
  }
  HIROSCO_TRY(dictionary_.initialise());
  foreign_.begin(dictionary_);
  initialised_ = true;
  return done;
}

/// A process that goes through Offline loses no more than one that ends (docs/adr/0087). What could not be set is not taken along.
void GenericSubsystem::remember_persistent() {
  if (!std::exchange(initialised_, false)) return;
  std::array<std::byte, descriptor::max_persistent_octets> room;
  for (std::size_t index = 0; index < descriptor_.parameters.size(); ++index) {
    const descriptor::Parameter& parameter = descriptor_.parameters[index];
    if (!parameter.persistent) continue;
    const std::size_t octets = dictionary_.snapshot_encode(index, -1, room);
    if (auto values = descriptor::values_within(parameter, Octets{room}.first(octets)))
      dictionary_.begin_with(index, std::move(*values));
  }
}

/// Stops the cycle, gives back what Pre-Operational took, then lets the author finish.
Result<Step> GenericSubsystem::leave_cycle() {
  if (wanted_.load(std::memory_order_relaxed)) {
    rest_ticket_.fetch_add(1, std::memory_order_release);
    wanted_.store(false, std::memory_order_release);
  }
  if (!cycle_rests()) return again;
  take_cycle_reports();
  if (configuration_ != nullptr) release_configuration();
  return author_.post_operational();
}

/// What the service loop holds of a configuration: links are told as gone, calls get their final report.
void GenericSubsystem::end_configuration() {
  for (const auto& [link, end] : link_ends_) {
    // An announced end is not a stale link: consumers make themselves safe without an alarm.
    if (end.role == pus::st128::Role::Producer) set_status(*end.link, LinkStatus::Stopping);
    link_service_.report_detached(link, end.role);
  }
  for (auto& [link, end] : link_ends_) leaving_links_.push_back(std::move(end.link));
  link_ends_.clear();
  for (const pus::Request& open : open_calls_)
    verification_.completion_failed(open, pus::FailureNotice{pus::FailureCode::Aborted});
  open_calls_.clear();
  self_tests_.abandon();
  give_up_reconfiguration(pus::FailureCode::Aborted);
}

/// Gives back all of a configuration. The cycle rests: nothing of it is in use.
void GenericSubsystem::release_configuration() {
  end_configuration();
  leaving_links_.clear();
  CycleCommand forgotten;
  while (rings_.commands.try_pop(forgotten)) {
    // A function that never reached the cycle still ends: nothing accepted is lost.
    if (forgotten.kind == CommandKind::Function)
      verification_.start_failed(forgotten.request, pus::FailureNotice{pus::FailureCode::Aborted});
  }
  writes_.apply(dictionary_);
  reconfiguration_.reset();
  cycle_.release();
  {
    const LoopsAtRest at_rest{loops_};
    for (pus::Service* service : services_) service->release();
  }
  configuration_ = nullptr;
  vital_.configuration.store(0, std::memory_order_relaxed);
  vital_.inhibited.store(0, std::memory_order_relaxed);
}

bool GenericSubsystem::cycle_rests() const noexcept {
  return !wanted_.load(std::memory_order_relaxed) &&
         parked_ticket_.load(std::memory_order_acquire) == rest_ticket_.load(std::memory_order_relaxed);
}

/// A cycle that did not come to rest in time still uses its configuration: that is given back when it has.
void GenericSubsystem::release_late() {
  if (!release_owed_ || !cycle_rests()) return;
  release_owed_ = false;
  take_cycle_reports();
  release_configuration();
  if (state_ == State::Offline) forget_introduction();
}

void GenericSubsystem::be_in(State state) {
  state_ = state;
  vital_.state.store(static_cast<std::uint32_t>(state), std::memory_order_release);
  const double entered = static_cast<double>(state);
  raise_in_service(descriptor::framework_event::state_changed, {&entered, 1});
}

void GenericSubsystem::arrive(State state) {
  be_in(state);
  phase_entered_ = false;
  if (++way_at_ < way_->size) return;
  if (way_request_) verification_.completed(*way_request_);
  way_.reset();
  way_request_.reset();
}

void GenericSubsystem::fail_transition(State at, const Failure& why) {
  // Ground hears the first mistake and how many there are; the author each, on a line of its own.
  const bool by_mistakes = at == State::SoftwareInit && !problems_.empty();
  const auto explain = [&](const std::string& words) {
    if (platform_.explain) platform_.explain(descriptor_.name + ": " + std::string{to_text(at)} + " failed: " + words);
  };
  if (!by_mistakes) explain(why.text);
  else
    for (const Mistake& mistake : problems_) explain(words_of(mistake));
  raise_failure(descriptor::framework_event::state_failed, static_cast<std::uint8_t>(at), why);
  if (way_request_)
    verification_.completion_failed(
        *way_request_, pus::FailureNotice{pus::FailureCode::ExecutionError}.because({why.code, why.number, why.text}));
  way_request_.reset();
  way_.reset();
  const auto target = failure_target(at);
  if (at == State::PostOperational && configuration_ != nullptr) {
    end_configuration();
    release_owed_ = true;
  }
  if (!target) {
    // A deinit that fails cannot stop the way down: what is left is given back by the end of the process.
    if (at == State::HardwareDeinit || at == State::SoftwareDeinit || at == State::PostOperational) go_down_from(at);
    return;
  }
  if (is_cyclic(at)) return go(State::ErrorOperational, std::nullopt);
  go_down_from(at);
}

/// The way to Offline that begins behind a failed state.
void GenericSubsystem::go_down_from(State failed) {
  constexpr std::array down{State::PostOperational, State::HardwareDeinit, State::SoftwareDeinit, State::Offline};
  const State first = failed == State::SoftwareInit      ? State::SoftwareDeinit
                      : failed == State::HardwareInit    ? State::HardwareDeinit
                      : failed == State::PostOperational ? State::HardwareDeinit
                      : failed == State::HardwareDeinit  ? State::SoftwareDeinit
                                                         : State::Offline;
  Route way;
  for (auto state = std::ranges::find(down, first); state != down.end(); ++state) way.states[way.size++] = *state;
  problems_.clear();
  way_ = way;
  way_at_ = 0;
  phase_entered_ = false;
  awaiting_cycle_ = answer_owed_ = false;
}

// --- configurations ----------------------------------------------------------------------------------------------------

std::expected<void, pus::FailureNotice> GenericSubsystem::command_configuration(std::uint8_t id,
                                                                                const pus::Request& request) {
  if (way_) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  const descriptor::Configuration* wanted = descriptor_.find_configuration(id);
  const bool acts = state_ == State::SafeOperational || state_ == State::Operational;
  if (acts && wanted != nullptr && configuration_ != nullptr &&
      descriptor_.bumpless_between(configuration_->id, id) != nullptr)
    return command_bumpless(*wanted, request);
  if (state_ != State::PreOperational) return std::unexpected{wrong_state()};
  const auto refuse = [&](pus::FailureCode code) {
    return std::unexpected{pus::FailureNotice{code}.with(std::uint8_t{0}).with(std::uint32_t{id})};
  };
  if (wanted == nullptr) return refuse(pus::FailureCode::UnknownIdentifier);
  // Another configuration goes by way of Post-Operational: devices and links are given back there.
  if (configuration_ != nullptr && configuration_ != wanted) return refuse(pus::FailureCode::WrongStatus);
  verification_.started(request);
  if (configuration_ == wanted) {
    verification_.completed(request);
    return {};
  }
  if (const auto problem = apply_configuration(*wanted)) {
    if (platform_.explain)
      platform_.explain(descriptor_.name + ": CONFIGURE " + wanted->name + " failed: " + problem->text);
    release_configuration();
    raise_failure(descriptor::framework_event::configuration_failed, id, *problem);
    verification_.completion_failed(request, pus::FailureNotice{pus::FailureCode::ExecutionError}.because(
                                                 {problem->code, problem->number, problem->text}));
    return {};
  }
  verification_.completed(request);
  return {};
}

/// The preferred endnode and its fall-backs. One that cannot be opened is passed over and told; if none can, the error is the
/// first one's.
Result<std::vector<DeviceSlot::Way>> GenericSubsystem::open_ways(const descriptor::DeviceUse& use,
                                                                 const DevicePortBase& port) {
  std::vector<DeviceSlot::Way> ways;
  std::optional<Error> first;
  const auto open = [&](const descriptor::Endnode& endnode, std::size_t at) {
    Result<Quota::Held> held = Quota::Held{};
    const FlowMeans* means = find_flow_means(endnode.transfer);
    if (means != nullptr && means->form == AddressForm::HostPort) held = resources_.ports().take();
    auto flow = held ? platform_.flows.open({endnode.transfer, endnode.address, endnode.framing}, FlowSide::Subsystem)
                     : Result<std::unique_ptr<DataFlow>>{std::unexpected{held.error()}};
    if (flow && endnode.framing == Framing::Raw) {
      if (port.protocol() != nullptr) flow = make_raw_flow(std::move(*flow), *port.protocol());
      else flow = fail(ErrorCode::Mismatch, "its port speaks no protocol of its own");
    }
    if (flow) return ways.push_back({std::move(*flow), static_cast<std::uint8_t>(at), std::move(*held)});
    if (!first) first = flow.error();
    const std::array arguments{static_cast<double>(descriptor::DeviceLoss::NotOpened), static_cast<double>(at),
                               static_cast<double>(ways.empty() ? at + 1 : ways.front().endnode), 0.0};
    if (!use.fall_backs.empty()) raise_in_service(descriptor::framework_event::fell_back(use.device), arguments);
  };
  open(use.endnode, 0);
  for (std::size_t i = 0; i < use.fall_backs.size(); ++i) open(use.fall_backs[i], i + 1);
  if (ways.empty()) return std::unexpected{*first};
  return ways;
}

std::optional<Failure> GenericSubsystem::apply_configuration(const descriptor::Configuration& configuration) {
  const auto mismatch = [](std::string text) { return Failure{ErrorCode::Mismatch, std::move(text)}; };
  const auto of = [](const std::string& whose, const Error& error) {
    return Failure{error.code, whose + error.text, error.value};
  };
  configuration_ = &configuration;
  for (const auto& initial : configuration.initial) {
    const int member = initial.parameter.member ? static_cast<int>(*initial.parameter.member) : -1;
    if (!dictionary_.set(initial.parameter.parameter, member, initial.values))
      return mismatch("initial value of " + initial.parameter.text);
  }
  CyclePlan plan;
  plan.configuration = &configuration;
  const auto sets = descriptor::required_sets(descriptor_);
  for (const auto& wanted : configuration.requires_) {
    const auto port = link_ports_.find(wanted.name);
    if (port == link_ports_.end()) return mismatch("no port for the required set " + wanted.name);
    if (const auto difference = layout_difference(port->second->layout(), wanted.fields); !difference.empty())
      return mismatch("required set " + wanted.name + ": " + difference);
    if (port->second->kind() != wanted.kind())
      return mismatch("required set " + wanted.name + port_wanted(wanted.kind()));
    plan.inputs.emplace_back(wanted, port->second, platform_.realtime);
    const auto set = std::ranges::find(sets, wanted.name) - sets.begin();
    plan.input_stale_events.push_back(descriptor::framework_event::set_stale(static_cast<std::size_t>(set)));
  }
  for (const auto& provided : configuration.provides) {
    // Software-Init has refused a lent set without its place, or with one of another layout.
    LoanOutputPort* const port = provided.terms.lent() ? lent_ports_.find(provided.name)->second : nullptr;
    plan.outputs.emplace_back(descriptor_, provided, dictionary_, port);
  }
  for (const auto& use : configuration.devices) {
    const descriptor::Device& device = descriptor_.devices[use.device];
    const auto port = device_ports_.find(device.name);
    if (port == device_ports_.end()) return mismatch("no port for the device " + device.name);
    if (const auto difference = DeviceSlot::difference(device, *port->second); !difference.empty())
      return mismatch("device " + device.name + ": " + difference);
    auto ways = open_ways(use, *port->second);
    if (!ways) return of("device " + device.name + ": ", ways.error());
    plan.devices.emplace_back(device, use, *port->second, std::move(*ways), configuration.sampling, platform_.realtime);
    plan.device_lost_events.push_back(descriptor::framework_event::device_lost(use.device));
    plan.fell_back_events.push_back(descriptor::framework_event::fell_back(use.device));
  }
  {
    const LoopsAtRest at_rest{loops_};
    for (pus::Service* service : services_)
      if (descriptor_.offers(service->type(), &configuration))
        if (const auto configured = service->configure(configuration); !configured) return of("", configured.error());
  }
  plan.sampler = housekeeping_service_.sampler();
  if (const auto configured = author_.configure(configuration); !configured) return of("", configured.error());
  self_tests_.applied(configuration.id);
  cycle_.prepare(std::move(plan));
  vital_.configuration.store(configuration.id, std::memory_order_relaxed);
  vital_.period_ns.store(static_cast<std::uint64_t>(configuration.sampling.count()), std::memory_order_relaxed);
  ++generation_;
  vital_.cycling.store(1, std::memory_order_release);
  wanted_.store(true, std::memory_order_release);
  return std::nullopt;
}

}  // namespace hirosco
