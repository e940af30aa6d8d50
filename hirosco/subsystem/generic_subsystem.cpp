// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/generic_subsystem.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "hirosco/parameter/number.hpp"

namespace hirosco {
namespace {

/// The service loop's pace while a cycle runs or a transition is under way, and otherwise. Messages wake it at once.
constexpr Duration busy_pace = 1ms;
constexpr Duration idle_pace = 10ms;
/// Without a heartbeat of the supervisor for this long a subsystem makes itself safe (reliability 5.1).
constexpr Duration heartbeat_limit = 2s;
constexpr int messages_per_step = 64;
constexpr std::size_t most_unsent_packets = 1024;

[[nodiscard]] Dictionary make_dictionary(const descriptor::Subsystem& subsystem, std::string& problem) {
  std::vector<ParameterSpec> specs;
  for (const auto& parameter : subsystem.parameters) {
    ParameterSpec spec{.name = parameter.field.name,
                       .id = {subsystem.id, parameter.field.type, parameter.id},
                       .fields = {},
                       .is_struct = parameter.field.type == Type::Struct,
                       .init = parameter.init};
    if (spec.is_struct)
      for (const auto& member : parameter.members)
        spec.fields.push_back({member.field.name, member.field.type, member.field.count});
    else spec.fields.push_back({parameter.field.name, parameter.field.type, parameter.field.count});
    specs.push_back(std::move(spec));
  }
  auto dictionary = Dictionary::make(specs);
  if (dictionary) return std::move(*dictionary);
  problem = dictionary.error();
  return {};
}

}  // namespace

GenericSubsystem::GenericSubsystem(Subsystem& author, descriptor::Subsystem descriptor, const World& world,
                                   Channel& channel, VitalPage& vital, const PermitPage& permit)
    : author_{author},
      descriptor_{std::move(descriptor)},
      world_{world},
      channel_{channel},
      vital_{vital},
      permit_{permit},
      dictionary_{make_dictionary(descriptor_, latched_problem_)},
      writes_{32, 2048},
      cycle_{{author, descriptor_, world.clock, dictionary_, writes_, handover_, vital, permit, world.realtime}},
      counters_{vital.counters},
      verification_{*this},
      test_service_{verification_, *this},
      event_service_{descriptor_.events, verification_, *this},
      function_service_{descriptor_.functions, pus::common_functions(), *this, verification_},
      parameter_service_{*this, verification_, *this},
      link_service_{verification_, *this, *this} {
  author_.framework_ = this;
  cycle_.functions().resize(descriptor_.functions.size());
  vital_.realtime.store(world_.realtime ? 1 : 0, std::memory_order_relaxed);
  heartbeat_seen_ = world_.clock.now();
  if (const auto started = author_.offline(); !started) latched_problem_ = started.error().text;
}

GenericSubsystem::~GenericSubsystem() { author_.framework_ = nullptr; }

GenericSubsystem::Demand GenericSubsystem::cycle_demand() const noexcept {
  Demand demand{.wanted = wanted_.load(std::memory_order_acquire)};
  demand.ticket = rest_ticket_.load(std::memory_order_acquire);
  if (!demand.wanted) return demand;
  demand.period = configuration_->sampling;
  demand.priority = configuration_->priority;
  demand.generation = generation_;
  return demand;
}

// --- the service loop --------------------------------------------------------------------------------------------------

TimePoint GenericSubsystem::service_step(TimePoint now) {
  take_cycle_reports();
  receive_messages();
  watch_supervisor(now);
  advance(now);
  author_.service(now);
  flush();
  vital_.service_steps.fetch_add(1, std::memory_order_relaxed);
  const bool busy = way_.has_value() || wanted_.load(std::memory_order_relaxed) || !unsent_.empty();
  return now + (busy ? busy_pace : idle_pace);
}

void GenericSubsystem::receive_messages() {
  MessageBuffer buffer;
  for (int left = messages_per_step; left > 0; --left) {
    auto found = channel_.receive(buffer);
    if (!found) {
      // One damaged message is no loss of the supervisor: the next look goes on behind it.
      if (found.error().code == ErrorCode::Unavailable) supervisor_lost_ = true;
      return;
    }
    if (found->flow == Flow::None) return;
    dispatch(found->message);
  }
}

void GenericSubsystem::dispatch(const Message& message) {
  const auto header = pus::read_primary_header(message.packet);
  if (!header) return;
  if (!header->telecommand) return author_.telemetry(message.packet);
  const auto telecommand = pus::TelecommandView::parse(message.packet);
  if (!telecommand) return verification_.rejected({header->request_id, 0, 0}, telecommand.error());
  const pus::Request request = pus::request_of(*telecommand);
  if (telecommand->apid() != descriptor_.id)
    return verification_.routing_failed(request, pus::FailureNotice{pus::FailureCode::UnknownApid});
  if (message.mode_epoch != 0 && message.mode_epoch != permit_.mode_epoch.load(std::memory_order_acquire))
    return verification_.rejected(request, pus::FailureNotice{pus::FailureCode::WrongMode});
  pus::Service* service = nullptr;
  switch (telecommand->service()) {
    case 3: service = housekeeping_service_.get(); break;
    case 5: service = &event_service_; break;
    case 8: service = &function_service_; break;
    case 17: service = &test_service_; break;
    case 20: service = &parameter_service_; break;
    case 128:
      link_service_.offer_memory(message.memory);
      service = &link_service_;
      break;
    default:
      return verification_.rejected(request,
                                    pus::FailureNotice{pus::FailureCode::UnknownService}.with(telecommand->service()));
  }
  // Housekeeping exists from Pre-Operational on: its structures belong to a configuration.
  if (service == nullptr) return verification_.rejected(request, wrong_state());
  service->handle(*telecommand, request);
}

pus::FailureNotice GenericSubsystem::wrong_state() const {
  return pus::FailureNotice{pus::FailureCode::WrongState}.with(static_cast<std::uint8_t>(state_));
}

void GenericSubsystem::watch_supervisor(TimePoint now) {
  const std::uint64_t heartbeat = permit_.heartbeat.load(std::memory_order_acquire);
  if (heartbeat != last_heartbeat_) {
    last_heartbeat_ = heartbeat;
    heartbeat_seen_ = now;
  }
  if (!supervisor_lost_ && now - heartbeat_seen_ <= heartbeat_limit) return;
  if (way_) return;
  if (state_ == State::Offline) {
    finished_ = supervisor_lost_;
    return;
  }
  if (state_ == State::Operational) return go(State::ErrorOperational, std::nullopt);
  // A silent supervisor may come back: stay in a safe state. One that is gone for good will not.
  if (supervisor_lost_) go(State::Offline, std::nullopt);
}

// --- reports of the cycle ----------------------------------------------------------------------------------------------

void GenericSubsystem::take_cycle_reports() {
  while (const auto record = handover_.reports.front()) {
    CycleReport head;
    std::memcpy(&head, record->data(), sizeof head);
    take_cycle_report(head, record->subspan(sizeof head));
    handover_.reports.pop();
  }
}

void GenericSubsystem::take_cycle_report(const CycleReport& head, Octets payload) {
  switch (head.kind) {
    case ReportKind::Housekeeping: report(3, 25, 0, payload); break;
    case ReportKind::Event: static_cast<void>(event_service_.raise(head.index, payload)); break;
    case ReportKind::Started:
      open_calls_.push_back(head.request);
      verification_.started(head.request);
      break;
    case ReportKind::Refused:
      verification_.start_failed(head.request, pus::FailureNotice{static_cast<pus::FailureCode>(head.index)});
      break;
    case ReportKind::Progressed: verification_.progressed(head.request, head.index); break;
    case ReportKind::Finished:
      if (close_call(head.request)) verification_.completed(head.request);
      break;
    case ReportKind::Aborted:
      if (close_call(head.request))
        verification_.completion_failed(head.request, pus::FailureNotice{static_cast<pus::FailureCode>(head.index)});
      break;
    case ReportKind::StateEntered:
      if (awaiting_cycle_ && way_ && static_cast<State>(head.index) == way_->states[way_at_]) {
        awaiting_cycle_ = false;
        arrive(way_->states[way_at_]);
      }
      break;
    case ReportKind::NodeFailed:
      // While the cycle comes to rest the subsystem is on its way down already: Error-Operational has no cycle there.
      if (wanted_.load(std::memory_order_relaxed)) fail_transition(static_cast<State>(head.index), "node failed");
      else announce("STATE_FAILED", {static_cast<double>(head.index)});
      break;
    case ReportKind::InputDetached:
    case ReportKind::OutputDetached:
      std::erase_if(leaving_links_, [&](const auto& link) { return link.get() == head.link; });
      break;
  }
}

// --- telemetry ---------------------------------------------------------------------------------------------------------

void GenericSubsystem::report(std::uint8_t service, std::uint8_t subtype, std::uint16_t destination,
                              Octets source_data) {
  std::array<std::byte, max_packet_octets> buffer;
  pus::TelemetryHeader header{.apid = descriptor_.id,
                              .service = service,
                              .subtype = subtype,
                              .destination = destination,
                              .time = world_.clock.onboard()};
  counters_.stamp(header);
  const auto packet = pus::write_telemetry(buffer, header, source_data);
  if (packet) send({.packet = *packet});
}

void GenericSubsystem::send(const Message& message) {
  if (unsent_.empty() && channel_.send(message)) return;
  // The supervisor is behind: keep a bounded backlog, oldest out first, in order.
  if (unsent_.size() == most_unsent_packets) {
    unsent_.pop_front();
    ++unsent_dropped_;
  }
  unsent_.emplace_back(message.packet.begin(), message.packet.end());
}

void GenericSubsystem::flush() {
  while (!unsent_.empty() && channel_.send({.packet = unsent_.front()})) unsent_.pop_front();
}

Result<> GenericSubsystem::submit_ground_telecommand(std::uint16_t client, Octets packet) {
  // Its own reports come first: telecommands that overtake them would keep them from ever being sent.
  if (!unsent_.empty()) return fail(ErrorCode::ResourceExhausted, "reports wait for the supervisor");
  return channel_.send({.kind = MessageKind::GroundTelecommand, .link = client, .packet = packet});
}

void GenericSubsystem::raise_in_service(std::uint16_t event, std::span<const double> arguments) {
  const auto found = std::ranges::find(descriptor_.events, event, &descriptor::Event::id);
  if (found == descriptor_.events.end()) return;
  std::array<std::byte, 1024> buffer;
  OctetWriter writer{buffer};
  for (std::size_t i = 0; i < found->arguments.size(); ++i)
    put_number(writer, found->arguments[i].type, i < arguments.size() ? arguments[i] : 0.0);
  static_cast<void>(event_service_.raise(event, writer.written()));
}

void GenericSubsystem::announce(std::string_view event_name, std::initializer_list<double> arguments) {
  raise_in_service(event_id(event_name), std::span{arguments.begin(), arguments.size()});
}

std::uint16_t GenericSubsystem::event_id(std::string_view name) const noexcept {
  const descriptor::Event* event = descriptor_.find_event(name);
  return event != nullptr ? event->id : 0;
}

// --- functions ---------------------------------------------------------------------------------------------------------

std::expected<void, pus::FailureNotice> GenericSubsystem::submit(const pus::FunctionCall& call,
                                                                 const pus::Request& request) {
  if (call.function == pus::set_state_function) return command_state(static_cast<State>(call.arguments[0]), request);
  if (call.function == pus::configure_function)
    return command_configuration(static_cast<std::uint8_t>(call.arguments[0]), request);
  const descriptor::Function& function = descriptor_.functions[call.function];
  if (!function.permitted_in(state_) || !wanted_.load(std::memory_order_relaxed) || way_)
    return std::unexpected{wrong_state()};
  if (!cycle_.functions()[call.function].handler)
    return std::unexpected{pus::FailureNotice{pus::FailureCode::ExecutionError}};
  CycleCommand command{.kind = CommandKind::Function, .index = call.function, .request = request};
  std::ranges::copy(call.arguments, command.arguments.begin());
  if (!push(command)) return std::unexpected{pus::FailureNotice{pus::FailureCode::QueueFull}};
  return {};
}

/// False when the call had its final report already.
bool GenericSubsystem::close_call(const pus::Request& request) {
  const auto found = std::ranges::find_if(
      open_calls_, [&](const pus::Request& open) { return open.id == request.id && open.source == request.source; });
  if (found == open_calls_.end()) return false;
  open_calls_.erase(found);
  return true;
}

bool GenericSubsystem::push(const CycleCommand& command) { return handover_.commands.try_push(command); }

void GenericSubsystem::bind_function(std::string_view name, std::size_t arguments, FunctionHandler handler) {
  const auto& functions = descriptor_.functions;
  const auto found = std::ranges::find(functions, name, &descriptor::Function::name);
  if (found == functions.end()) {
    latched_problem_ = "on_function: the descriptor declares no function '" + std::string{name} + "'";
    return;
  }
  if (found->arguments.size() != arguments) {
    latched_problem_ = "on_function " + std::string{name} + ": the handler takes " + std::to_string(arguments) +
                       " arguments, the descriptor declares " + std::to_string(found->arguments.size());
    return;
  }
  cycle_.functions()[static_cast<std::size_t>(found - functions.begin())].handler = std::move(handler);
}

// --- parameters --------------------------------------------------------------------------------------------------------

void GenericSubsystem::publish(std::string_view name, ParameterCell& parameter) {
  if (const auto published = dictionary_.publish(name, parameter); !published) latched_problem_ = published.error();
}

std::expected<std::size_t, ErrorCode> GenericSubsystem::read(std::uint32_t parameter, MutableOctets big_endian) {
  const auto index = dictionary_.index_of(parameter);
  if (!index) return std::unexpected{ErrorCode::NotFound};
  const std::size_t octets = dictionary_.snapshot_encode(*index, -1, big_endian);
  if (octets == 0) return std::unexpected{ErrorCode::Unavailable};
  return octets;
}

std::size_t GenericSubsystem::size_of(std::uint32_t parameter) {
  const auto index = dictionary_.index_of(parameter);
  if (!index || dictionary_.cell(*index) == nullptr) return 0;
  return dictionary_.wire_octets(*index);
}

std::expected<void, pus::FailureCode> GenericSubsystem::check_write(std::uint32_t parameter, Octets value) {
  const auto index = dictionary_.index_of(parameter);
  if (!index) return std::unexpected{pus::FailureCode::UnknownIdentifier};
  const descriptor::Parameter& declared = descriptor_.parameters[*index];
  if (declared.read_only) return std::unexpected{pus::FailureCode::NotPermittedNow};
  if (!dictionary_.accepts(*index, -1, value)) return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  OctetReader reader{value};
  const auto in_range = [&](const descriptor::Field& field) {
    for (std::uint16_t i = 0; i < field.count; ++i) {
      const double number = get_number(reader, field.type);
      if (!(number == number)) return false;
      if (field.minimum && number < *field.minimum) return false;
      if (field.maximum && number > *field.maximum) return false;
    }
    return true;
  };
  bool good = true;
  if (declared.members.empty()) good = in_range(declared.field);
  else
    for (const auto& member : declared.members) good = good && in_range(member.field);
  if (!good) return std::unexpected{pus::FailureCode::ValueNotAcceptable};
  return {};
}

bool GenericSubsystem::submit_write(std::span<const pus::ParameterAccess::Write> writes, const pus::Request&) {
  std::vector<ParameterWrite> batch;
  for (const auto& write : writes)
    if (const auto index = dictionary_.index_of(write.id)) batch.push_back({*index, -1, write.value});
  if (!writes_.enqueue(dictionary_, batch)) return false;
  // While the cycle rests the service loop is the writer; one that is still coming to rest is applied for when it has.
  const bool parked = parked_ticket_.load(std::memory_order_acquire) == rest_ticket_.load(std::memory_order_relaxed);
  if (!wanted_.load(std::memory_order_relaxed) && parked) writes_.apply(dictionary_);
  return true;
}

// --- links -------------------------------------------------------------------------------------------------------------

void GenericSubsystem::require_link(std::string_view set, LinkInputPort& port) {
  link_ports_[std::string{set}] = &port;
}

void GenericSubsystem::use_device(std::string_view name, DevicePortBase& port) {
  device_ports_[std::string{name}] = &port;
}

const descriptor::Requires* GenericSubsystem::find_required(std::string_view set) {
  if (configuration_ == nullptr || !is_cyclic(state_)) return nullptr;
  const auto found = std::ranges::find(configuration_->requires_, set, &descriptor::Requires::name);
  return found != configuration_->requires_.end() ? &*found : nullptr;
}

const LinkOutputSlot* GenericSubsystem::find_provided(std::string_view set) {
  if (configuration_ == nullptr || !is_cyclic(state_)) return nullptr;
  const auto& outputs = cycle_.plan().outputs;
  const auto found = std::ranges::find_if(outputs, [&](const auto& slot) { return slot.terms().name == set; });
  return found != outputs.end() ? &*found : nullptr;
}

Duration GenericSubsystem::period() { return configuration_ != nullptr ? configuration_->sampling : Duration{}; }

Result<> GenericSubsystem::attach(const pus::st128::AttachRequest& request, const MemoryHandle& memory) {
  if (!memory) return fail(ErrorCode::Malformed, "no memory beside the attach request");
  if (configuration_ == nullptr) return fail(ErrorCode::NotPermitted, "no configuration in force");
  // A later epoch: the partner left without this end and came back, and what this end still holds is the link as it was.
  const auto earlier = link_ends_.find(request.link);
  const bool renewed = earlier != link_ends_.end() && request.epoch > earlier->second.epoch;
  if (earlier != link_ends_.end() && !renewed) return fail(ErrorCode::AlreadyExists, "the link is attached already");
  const bool producer = request.role == pus::st128::Role::Producer;
  const pus::st128::Agreement& agreement = request.agreement;
  const LinkLayout layout{.epoch = request.epoch,
                          .payload_octets = agreement.payload_octets(),
                          .layout_hash = agreement.layout_hash(),
                          .period = agreement.producer_period};
  const std::size_t octets = link_memory_octets(layout.payload_octets);
  auto link = std::make_unique<AttachedLink>();
  HIROSCO_TRY(world_.memory.verify(memory, octets, !producer));
  HIROSCO_TRY_LET(link->mapping, world_.memory.map(memory, producer ? Access::ReadWrite : Access::ReadOnly));
  link->id = request.link;
  link->agreement = agreement;
  link->order = agreement.byte_order == descriptor::ByteOrder::Big ? std::endian::big : std::endian::little;
  link->payload.resize(layout.payload_octets);
  LinkEnd end{.link = nullptr, .role = request.role, .epoch = request.epoch, .slot = 0};
  CyclePlan& plan = cycle_.plan();
  if (producer) {
    const auto slot = std::ranges::find_if(plan.outputs, [&](const auto& s) { return s.terms().name == request.set; });
    if (slot == plan.outputs.end()) return fail(ErrorCode::NotFound, "no such provided set");
    // Another configuration may be in force than the one that negotiated; the cycle writes these fields unchecked.
    if (agreement.fields != slot->fields()) return fail(ErrorCode::Mismatch, "the agreement is not of this set");
    HIROSCO_TRY_LET(link->writer, LinkWriter::make(link->mapping.octets, layout));
    HIROSCO_TRY(world_.memory.seal_writers(memory));
    end.slot = static_cast<std::uint16_t>(slot - plan.outputs.begin());
  } else {
    const auto slot = std::ranges::find_if(plan.inputs, [&](const auto& s) { return s.terms().name == request.set; });
    if (slot == plan.inputs.end()) return fail(ErrorCode::NotFound, "no such required set");
    HIROSCO_TRY_LET(link->reader, LinkReader::make(link->mapping.octets, layout));
    HIROSCO_TRY(slot->plan(*link));
    const auto ratio = agreement.producer_period / std::max(agreement.consumer_period, Duration{1});
    link->producer_cycles_per_sample = static_cast<std::uint32_t>(std::max<std::int64_t>(ratio, 1));
    end.slot = static_cast<std::uint16_t>(slot - plan.inputs.begin());
  }
  if (renewed && !withdraw(request.link))
    return fail(ErrorCode::ResourceExhausted, "the cycle's command queue is full");
  const auto kind = producer ? CommandKind::AttachOutput : CommandKind::AttachInput;
  if (!push({.kind = kind, .index = end.slot, .link = link.get()}))
    return fail(ErrorCode::ResourceExhausted, "the cycle's command queue is full");
  end.link = std::move(link);
  link_ends_.emplace(request.link, std::move(end));
  return ok();
}

bool GenericSubsystem::detach(std::uint8_t link) {
  const auto found = link_ends_.find(link);
  if (found == link_ends_.end()) return false;
  const pus::st128::Role role = found->second.role;
  if (!withdraw(link)) return false;
  link_service_.report_detached(link, role);
  return true;
}

/// Takes an end back from the cycle, which names it when it has let go of it.
bool GenericSubsystem::withdraw(std::uint8_t link) {
  const auto found = link_ends_.find(link);
  LinkEnd& end = found->second;
  const bool producer = end.role == pus::st128::Role::Producer;
  const auto kind = producer ? CommandKind::DetachOutput : CommandKind::DetachInput;
  if (!push({.kind = kind, .index = end.slot, .link = end.link.get()})) return false;
  leaving_links_.push_back(std::move(end.link));
  link_ends_.erase(found);
  return true;
}

bool GenericSubsystem::required_links_attached() const noexcept {
  return std::ranges::all_of(configuration_->requires_, [&](const descriptor::Requires& wanted) {
    if (!wanted.required) return true;
    return std::ranges::any_of(link_ends_, [&](const auto& entry) {
      const LinkEnd& end = entry.second;
      return end.role == pus::st128::Role::Consumer && &configuration_->requires_[end.slot] == &wanted;
    });
  });
}

}  // namespace hirosco
