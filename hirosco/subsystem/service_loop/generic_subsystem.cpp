// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/parameter/number.hpp"
#include "hirosco/pus/st01_verification/instructions.hpp"
#include "hirosco/pus/st05_event/event_message.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco {
namespace {

/// The service loop's pace while a transition is under way or a cycle runs whose reports wake nobody, and otherwise. Messages wake
/// it at once.
constexpr Duration busy_pace = 1ms;
constexpr Duration idle_pace = 10ms;
constexpr int messages_per_step = 64;

[[nodiscard]] Dictionary make_dictionary(const descriptor::SubsystemDescriptor& subsystem, std::string& problem) {
  std::vector<ParameterSpec> specs;
  for (const auto& parameter : subsystem.parameters) {
    ParameterSpec spec{.name = parameter.field.name,
                       .id = {subsystem.id, parameter.field.type, parameter.id},
                       .fields = {},
                       .is_struct = parameter.field.type == Type::Struct,
                       .init = parameter.init};
    if (spec.is_struct)
      for (const auto& member : parameter.members)
        spec.fields.push_back({member.field.name, member.field.type, member.field.elements(), member.id});
    else spec.fields.push_back({parameter.field.name, parameter.field.type, parameter.field.elements()});
    for (const auto& part : parameter.parts) spec.parts.push_back({part.name, part.first, part.count, part.id});
    specs.push_back(std::move(spec));
  }
  auto dictionary = Dictionary::make(specs);
  if (dictionary) return std::move(*dictionary);
  problem = dictionary.error();
  return {};
}

/// Whoever made the descriptor: the framework's events are there.
[[nodiscard]] descriptor::SubsystemDescriptor with_framework_events(descriptor::SubsystemDescriptor subsystem) {
  descriptor::add_framework_events(subsystem);
  return subsystem;
}

}  // namespace

GenericSubsystem::GenericSubsystem(Subsystem& author, descriptor::SubsystemDescriptor descriptor,
                                   const Platform& platform, Channel& channel, VitalPage& vital,
                                   const PermitPage& permit)
    : author_{author},
      descriptor_{with_framework_events(std::move(descriptor))},
      platform_{platform},
      channel_{channel},
      vital_{vital},
      permit_{&permit},
      dictionary_{make_dictionary(descriptor_, dictionary_problem_)},
      writes_{32, 2048},
      resources_{descriptor_.resources},
      loop_meter_{descriptor_.service_loops},
      loops_{make_loops()},
      cycle_{{author, descriptor_, platform.clock, dictionary_, writes_, rings_, vital, permit, platform.realtime,
              platform.precise, resources_, loop_meter_}},
      counters_{vital.counters},
      verification_{*this},
      event_service_{descriptor_.events, verification_, *this},
      function_service_{descriptor_.functions, pus::common_functions(), *this, verification_},
      parameter_service_{*this, verification_, *this},
      housekeeping_service_{descriptor_, home_of(3).verification(), home_of(3).telemetry()},
      link_service_{verification_, *this, *this},
      descriptor_service_{verification_, *this},
      self_tests_{verification_, *this, platform.clock},
      services_{&housekeeping_service_, &event_service_, &function_service_,
                &parameter_service_,    &link_service_,  &descriptor_service_},
      requester_{descriptor_, channel_, platform.clock.now()},
      subscriber_{descriptor_, channel_},
      foreign_{descriptor_, foreign_home()} {
  for (const pus::ServiceKind* kind : pus::standard_services()) {
    if (kind->make == nullptr) continue;
    made_services_.push_back(kind->make(*this));
    services_.push_back(made_services_.back().get());
  }
  // One for each command that can be on its way to the cycle: none grows it then.
  open_calls_.reserve(std::decay_t<decltype(rings_.commands)>::capacity());
  tell_descriptor();
  if (OwnLoop* const loop = loop_of(housekeeping_service_.type())) loop->host(housekeeping_service_);
  loops_looked_at_ = platform_.clock.now();
  author_.framework_ = this;
  cycle_.functions().resize(descriptor_.functions.size());
  vital_.realtime.store(platform_.realtime ? 1 : 0, std::memory_order_relaxed);
  watched_supervisor_at_ = platform_.clock.now();
  if (const auto started = author_.offline(); !started) mistake(started.error().text);
}

GenericSubsystem::~GenericSubsystem() { author_.framework_ = nullptr; }

GenericSubsystem::Demand GenericSubsystem::cycle_demand() const noexcept {
  Demand demand{.wanted = wanted_.load(std::memory_order_acquire)};
  demand.ticket = rest_ticket_.load(std::memory_order_acquire);
  if (!demand.wanted) return demand;
  // The cycle's own: it changes at a boundary between two cycles (adr 0096).
  const descriptor::Configuration& in_force = cycle_.in_force();
  demand.period = in_force.sampling;
  demand.priority = in_force.priority;
  demand.generation = generation_;
  return demand;
}

// --- the service loop --------------------------------------------------------------------------------------------------

/// Commissioning uses the heap, and so does each change of state: what is between them must not (adr 0103).
bool GenericSubsystem::commissioned() const noexcept {
  return (state_ == State::SafeOperational || state_ == State::Operational) && !way_;
}

TimePoint GenericSubsystem::service_step(TimePoint now) {
  if (!commissioned()) return step_services(now);
  AllocationCount used;
  TimePoint next;
  {
    const RealtimeScope watched;
    next = step_services(now);
    used = watched.count();
  }
  if (!commissioned() || !heap_watch_.account(used, now)) return next;
  const AllocationCount& sum = heap_watch_.sum();
  cycle_.note_service_heap(sum.allocations + sum.frees);
  raise_in_service(descriptor::framework_event::service_uses_heap,
                   std::array{static_cast<double>(sum.allocations), static_cast<double>(sum.frees)});
  return next;
}

TimePoint GenericSubsystem::step_services(TimePoint now) {
  known_stop_ = newest_stop();
  take_cycle_reports();
  take_loop_reports();
  receive_messages();
  confirm_permit_page();
  watch_supervisor(now);
  release_late();
  advance(now);
  requester_.step(now);
  // As for what is asked: its own reports come first.
  if (backlog_.empty()) subscriber_.step(now);
  foreign_.step(now, state_ == State::SafeOperational || state_ == State::Operational);
  author_.service(now);
  for (pus::Service* service : services_)
    if (loop_of(service->type()) == nullptr) service->step(now);
  if (cycle_rests() && writes_.waiting() != 0) writes_.apply(dictionary_);
  backlog_.flush(channel_);
  tell_losses(now);
  look_at_resources(now);
  if (loops_move(now)) vital_.service_steps.fetch_add(1, std::memory_order_relaxed);
  const bool looks = wanted_.load(std::memory_order_relaxed) && !platform_.wakes;
  const bool busy = way_.has_value() || looks || !backlog_.empty();
  return now + (busy ? busy_pace : std::clamp(author_.service_wake().pace, busy_pace, idle_pace));
}

void GenericSubsystem::receive_messages() {
  MessageBuffer buffer;
  // A telecommand whose answers might crowd out those to another stays in the channel: the supervisor finds that full and
  // says so, while an answer that is dropped is a telecommand of which nobody ever hears again (adr 0029).
  for (int left = messages_per_step; left > 0 && reads(); --left) {
    auto found = channel_.receive(buffer);
    if (!found) {
      // One damaged message is no loss of the supervisor: the next look goes on behind it.
      if (found.error().code == ErrorCode::Unavailable) supervisor_lost_ = true;
      return;
    }
    if (found->flow == Flow::None) return;
    if (found->message.kind == MessageKind::Packet) dispatch(found->message);
    else if (found->message.kind == MessageKind::PermitPage) take_permit_page(found->message.memory);
  }
}

/// The supervisor died, and another one goes on in its place: it cannot write the page of the one before (hazard SF13). What is no
/// permit page is not taken, nor is one before the cycle looks at the last: then it comes again.
void GenericSubsystem::take_permit_page(const MemoryHandle& memory) {
  if (!cycle_.looks_at_offered_permit() || !platform_.memory.verify(memory, sizeof(PermitPage), true)) return;
  auto mapped = platform_.memory.map(memory, Access::ReadOnly);
  if (!mapped) return;
  const auto* page = reinterpret_cast<const PermitPage*>(mapped->octets.data());
  if (page->magic != page_magic || page->version != page_version) return;
  permit_before_ = std::exchange(permit_memory_, std::move(*mapped));
  permit_ = page;
  last_heartbeat_ = page->heartbeat.load(std::memory_order_acquire);
  cycle_.offer_permit(*page);
  for (const auto& loop : loops_) loop->take_permit(*page);
  permit_owed_ = true;
  confirm_permit_page();
}

void GenericSubsystem::confirm_permit_page() {
  if (!permit_owed_) return;
  if (cycle_rests()) cycle_.take_permit();
  if (!cycle_.looks_at_offered_permit()) return;
  permit_owed_ = !channel_.send({.kind = MessageKind::PermitPage});
}

void GenericSubsystem::dispatch(const Message& message) {
  const auto header = pus::read_primary_header(message.packet);
  if (!header) return;
  if (!header->telecommand) {
    if (const auto report = pus::TelemetryView::parse(message.packet)) {
      if (subscriber_.hear(*report)) return;
      if (requester_.waits() && report->destination() == descriptor_.id) requester_.hear(*report);
    }
    return author_.telemetry(message.packet);
  }
  if (pus::to_be_discarded(message.packet)) return;
  const auto telecommand = pus::TelecommandView::parse(message.packet);
  if (!telecommand) return verification_.rejected({header->request_id, 0, 0}, telecommand.error());
  const pus::Request request = pus::request_of(*telecommand);
  if (telecommand->apid() != descriptor_.id)
    return verification_.routing_failed(request, pus::FailureNotice{pus::FailureCode::UnknownApid});
  if (message.epoch != 0 && message.epoch != permit_->mode_epoch.load(std::memory_order_acquire))
    return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::WrongMode});
  const auto found = std::ranges::find(services_, telecommand->service(), &pus::Service::type);
  if (found == services_.end() || !descriptor_.offers(telecommand->service(), configuration_))
    return verification_.rejected(request,
                                  pus::FailureNotice{pus::FailureCode::UnknownService}.with(telecommand->service()));
  pus::Service& service = **found;
  if (!service.in_force()) return verification_.rejected(request, wrong_state());
  if (OwnLoop* const loop = loop_of(service.type())) {
    if (loop->offer(message.packet, message.epoch)) return;
    return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::QueueFull});
  }
  service.accompany(message.memory);
  service.handle(*telecommand, request);
}

pus::FailureNotice GenericSubsystem::wrong_state() const {
  return pus::FailureNotice{pus::FailureCode::WrongState}.with(static_cast<std::uint8_t>(state_));
}

void GenericSubsystem::watch_supervisor(TimePoint now) {
  const std::uint64_t heartbeat = permit_->heartbeat.load(std::memory_order_acquire);
  // While the whole computer stood nobody was silent: of what passes between two looks only so much counts.
  supervisor_silent_for_ += std::min(now - std::exchange(watched_supervisor_at_, now), most_silence_a_look);
  if (std::exchange(last_heartbeat_, heartbeat) != heartbeat) supervisor_silent_for_ = Duration{0};
  if (!supervisor_lost_ && supervisor_silent_for_ <= supervisor_silence_limit) return;
  if (way_) return;
  if (state_ == State::Offline) {
    finished_ = supervisor_lost_;
    return;
  }
  if (state_ == State::Operational) return go(State::ErrorOperational, std::nullopt);
  // A silent supervisor may come back: stay in a safe state. One that is gone for good will not.
  if (supervisor_lost_) go(State::Offline, std::nullopt);
}

// --- functions ---------------------------------------------------------------------------------------------------------

std::expected<void, pus::FailureNotice> GenericSubsystem::submit(const pus::FunctionCall& call,
                                                                 const pus::Request& request) {
  const auto first = std::to_integer<std::uint8_t>(call.arguments.front());
  if (call.function == pus::set_state_function) return command_state(static_cast<State>(first), request);
  if (call.function == pus::configure_function) return command_configuration(first, request);
  const descriptor::Function& function = descriptor_.functions[call.function];
  if (!function.permitted_in(state_) || !wanted_.load(std::memory_order_relaxed) || way_)
    return std::unexpected{wrong_state()};
  if (!cycle_.functions()[call.function].handler)
    return std::unexpected{pus::FailureNotice{pus::FailureCode::ExecutionError}};
  CycleCommand command{.kind = CommandKind::Function, .index = call.function, .request = request};
  command.arguments = call.arguments;
  if (!push(command)) return std::unexpected{pus::FailureNotice{pus::FailureCode::QueueFull}};
  return {};
}

std::expected<void, pus::FailureNotice> GenericSubsystem::begin_self_test(const pus::Request& request) {
  if (state_ != State::SafeOperational || way_) return std::unexpected{wrong_state()};
  if (self_tests_.running()) return std::unexpected{pus::FailureNotice{pus::FailureCode::Busy}};
  if (!push({.kind = CommandKind::SelfTest, .request = request}))
    return std::unexpected{pus::FailureNotice{pus::FailureCode::QueueFull}};
  self_tests_.begun(request);
  return {};
}

/// A code that nobody can look up says nothing: it becomes an execution error that names it.
pus::FailureNotice GenericSubsystem::notice_of(std::uint16_t code, const Failure& why) const {
  const bool own = code >= pus::first_own_failure_code;
  if (own &&
      std::ranges::find(descriptor_.failures, code, &descriptor::FailureName::code) == descriptor_.failures.end())
    return pus::FailureNotice{pus::FailureCode::ExecutionError}.because(
        {ErrorCode::NotFound, code, "failure code without a name in the descriptor"});
  pus::FailureNotice notice{static_cast<pus::FailureCode>(code)};
  if (!why.text.empty() || why.number != 0) notice.because({why.code, why.number, why.text});
  return notice;
}

/// False when the call had its final report already.
bool GenericSubsystem::close_call(const pus::Request& request) {
  const auto found = std::ranges::find_if(
      open_calls_, [&](const pus::Request& open) { return open.id == request.id && open.source == request.source; });
  if (found == open_calls_.end()) return false;
  open_calls_.erase(found);
  return true;
}

bool GenericSubsystem::push(const CycleCommand& command) { return rings_.commands.try_push(command); }

// --- parameters --------------------------------------------------------------------------------------------------------

std::expected<std::size_t, ErrorCode> GenericSubsystem::read(std::uint32_t parameter, MutableOctets big_endian) {
  const auto place = dictionary_.place_of(parameter);
  if (!place) return std::unexpected{ErrorCode::NotFound};
  const std::size_t octets = dictionary_.snapshot_encode(place->index, place->member, big_endian);
  if (octets == 0) return std::unexpected{ErrorCode::Unavailable};
  return octets;
}

std::size_t GenericSubsystem::size_of(std::uint32_t parameter) {
  const auto place = dictionary_.place_of(parameter);
  if (!place || dictionary_.cell(place->index) == nullptr) return 0;
  return dictionary_.wire_octets(place->index, place->member);
}

namespace {

/// Each number of these octets, which are of its length, within the range that it has.  Realtime: bounded.
[[nodiscard]] bool in_range(const descriptor::Parameter& declared, int member, Octets value) {
  OctetReader reader{value};
  const auto fits = [&](const descriptor::Field& field) {
    if (field.type == Type::Text) return static_cast<void>(reader.get(field.octets())), true;
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const Number number = read_number(reader, field.type);
      if (!(number == number)) return false;
      if (field.minimum && number < *field.minimum) return false;
      if (field.maximum && number > *field.maximum) return false;
    }
    return true;
  };
  if (declared.members.empty()) return fits(declared.field);
  const std::span<const descriptor::Parameter::Member> all{declared.members};
  const auto asked = member < 0 ? all : declared.members_at(static_cast<std::uint16_t>(member));
  return std::ranges::all_of(asked, [&](const auto& each) { return fits(each.field); });
}

}  // namespace

std::expected<void, pus::FailureCode> GenericSubsystem::check_write(std::uint32_t parameter, Octets value) {
  const auto place = dictionary_.place_of(parameter);
  if (!place) return std::unexpected{pus::FailureCode::UnknownIdentifier};
  const descriptor::Parameter& declared = descriptor_.parameters[place->index];
  if (!declared.writable_in(state_)) return std::unexpected{pus::FailureCode::NotPermittedNow};
  // A value that the next cycle overwrites was not set, whatever a report said.
  if (wanted_.load(std::memory_order_relaxed) && cycle_.writes_itself(place->index))
    return std::unexpected{pus::FailureCode::NotPermittedNow};
  if (!dictionary_.accepts(place->index, place->member, value))
    return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  if (!in_range(declared, place->member, value)) return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  return {};
}

std::expected<void, pus::FailureCode> GenericSubsystem::submit_write(
    std::span<const pus::ParameterAccess::Write> writes, const pus::Request&) {
  std::array<ParameterWrite, pus::max_instructions> batch;
  std::size_t count = 0;
  for (const auto& write : writes)
    if (const auto place = dictionary_.place_of(write.id); place && count < batch.size())
      batch[count++] = {place->index, place->member, write.value};
  if (const auto queued = writes_.enqueue(dictionary_, std::span{batch}.first(count)); !queued)
    return std::unexpected{queued.error().code == ErrorCode::OutOfRange ? pus::FailureCode::CapacityExceeded
                                                                        : pus::FailureCode::Busy};
  // While the cycle rests the service loop is the writer; one that is still coming to rest is applied for when it has.
  if (cycle_rests()) writes_.apply(dictionary_);
  return {};
}

/// What is heard of others comes into a parameter as what a telecommand sets, without asking whether one may.
ForeignParameters::Home GenericSubsystem::foreign_home() {
  const auto accepts = [this](std::uint16_t parameter, Octets value) {
    return dictionary_.accepts(parameter, -1, value) && in_range(descriptor_.parameters[parameter], -1, value);
  };
  const auto set = [this](std::uint16_t parameter, Octets value) {
    const ParameterWrite write{parameter, -1, value};
    if (!writes_.enqueue(dictionary_, {&write, 1})) return false;
    if (cycle_rests()) writes_.apply(dictionary_);
    return true;
  };
  return {.set = set, .accepts = accepts, .tell = [this](std::uint16_t parameter) {
            raise_in_service(descriptor::framework_event::foreign_unknown, std::array{static_cast<double>(parameter)});
          }};
}

}  // namespace hirosco
