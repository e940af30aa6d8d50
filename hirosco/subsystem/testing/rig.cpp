// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/testing/rig.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/testing/report_shape.hpp"
#include "hirosco/subsystem/testing/inside.hpp"

namespace hirosco::testing {

namespace st128 = pus::st128;

namespace {

std::optional<std::size_t> value_octets(const descriptor::SubsystemDescriptor& subsystem, std::uint32_t parameter) {
  const auto found = descriptor::find_parameter(subsystem, parameter);
  if (!found) return std::nullopt;
  std::size_t octets = 0;
  for (const descriptor::Field& field : descriptor::fields_of(subsystem, *found)) octets += field.octets();
  return octets;
}

[[nodiscard]] std::vector<std::byte> kept(Octets octets) { return {octets.begin(), octets.end()}; }

[[nodiscard]] Raised raised_by(Octets message) {
  const auto event = pus::read_event_message(message);
  if (!event) throw std::runtime_error{"the subsystem sent an event that is none"};
  return {event->severity, event->reported, event->id, kept(event->auxiliary)};
}

[[nodiscard]] Asked asked_by(const pus::TelecommandView& request, std::uint32_t known_stop) {
  return {request.request_id(),
          request.apid(),
          request.source(),
          request.ack(),
          request.service(),
          request.subtype(),
          kept(request.application_data()),
          known_stop};
}

/// A report is to be of its shape.
[[nodiscard]] Telemetry told_by(Octets packet, const descriptor::SubsystemDescriptor& subsystem) {
  const auto view = pus::TelemetryView::parse(packet);
  if (!view) throw std::runtime_error{"the subsystem sent something that is not telemetry"};
  const Octets data = view->source_data();
  if (const std::string why =
          pus::testing::unlike_its_shape(view->service(), view->subtype(), data,
                                         [&](std::uint32_t parameter) { return value_octets(subsystem, parameter); });
      !why.empty())
    throw std::runtime_error{"the subsystem sent " + why};
  return {view->service(), view->subtype(), view->destination(), kept(data)};
}

/// Which event a report is of; empty: it is of none.
[[nodiscard]] std::optional<std::uint16_t> event_in(const Telemetry& report) {
  if (report.service != 5 || report.subtype > 4) return std::nullopt;
  return OctetReader{report.data}.get<std::uint16_t>();
}

[[nodiscard]] std::string outcome_in(const std::vector<Telemetry>& telemetry, Sent request) {
  std::string text;
  for (const Telemetry& report : telemetry) {
    if (report.service != 1 || report.data.size() < 4) continue;
    OctetReader reader{report.data};
    if (reader.get<std::uint32_t>() != request.id) continue;
    if (!text.empty()) text += ' ';
    text += std::to_string(report.subtype);
    if (report.data.size() > 4) text.append(1, ':').append(hex(Octets{report.data}.subspan(4)));
  }
  return text;
}

[[nodiscard]] std::vector<std::string> reports_in(const std::vector<Telemetry>& telemetry, std::uint8_t service,
                                                  std::uint8_t subtype) {
  std::vector<std::string> found;
  for (const Telemetry& report : telemetry)
    if (report.service == service && report.subtype == subtype) found.push_back(hex(report.data));
  return found;
}

[[nodiscard]] st128::Agreement in_memory(std::vector<st128::OfferedField> fields, Duration producer_period,
                                         Duration consumer_period) {
  return {.method = LinkMethod::SharedMemory,
          .byte_order = descriptor::ByteOrder::Little,
          .kind = LinkKind::Latest,
          .producer_period = producer_period,
          .consumer_period = consumer_period,
          .fields = std::move(fields)};
}

/// What is sent may be outside of its range. Whoever sends a telecommand may not know the ranges; the subsystem does, and refuses.
[[nodiscard]] descriptor::Function unbounded(descriptor::Function request) {
  for (auto& argument : request.arguments) {
    argument.field.minimum = argument.field.maximum = std::nullopt;
    argument.texts.clear();
  }
  return request;
}

[[nodiscard]] std::runtime_error no_carrier(const std::string& what, const Error& error, std::size_t values) {
  return std::runtime_error{what + ": " + error.text + ": no telecommand can carry it; give " + std::to_string(values) +
                            " values of the types that the descriptor says"};
}

/// Application data of TC[8,1] by the function's name.
[[nodiscard]] std::vector<std::byte> call_data(const descriptor::SubsystemDescriptor& subsystem,
                                               std::string_view function,
                                               const std::vector<std::optional<Value>>& arguments) {
  const descriptor::Function* found = subsystem.find_function(function);
  const auto common = pus::common_functions();
  for (const auto& candidate : common)
    if (candidate.name == function) found = &candidate;
  if (found == nullptr) {
    std::string names;
    for (const auto& one : subsystem.functions) names += " " + one.name;
    throw std::runtime_error{"Rig::call: " + subsystem.name + " has no function '" + std::string{function} +
                             "'; its descriptor has:" + names};
  }
  auto data = pus::encode_call(unbounded(*found), arguments);
  if (!data)
    throw no_carrier("Rig::call: " + found->name + " of " + subsystem.name, data.error(), pus::value_count(*found));
  return std::move(*data);
}

/// Application data of TC[20,3] with one parameter, by the name of it or of a part of it.
[[nodiscard]] std::vector<std::byte> set_data(const descriptor::SubsystemDescriptor& subsystem,
                                              std::string_view parameter,
                                              const std::vector<std::optional<Value>>& values) {
  std::string names;
  for (const descriptor::Function& request : pus::requests_of(subsystem)) {
    if (!request.name.starts_with(pus::setting_prefix)) continue;
    const std::string name = request.name.substr(pus::setting_prefix.size());
    names += " " + name;
    if (name != parameter) continue;
    auto data = pus::encode_request(unbounded(request), values);
    if (!data) throw no_carrier("Rig::set: " + name + " of " + subsystem.name, data.error(), pus::value_count(request));
    return std::move(*data);
  }
  throw std::runtime_error{"Rig::set: " + subsystem.name + " has no writable parameter '" + std::string{parameter} +
                           "'; its descriptor has:" + (names.empty() ? " none" : names)};
}

[[nodiscard]] std::string count_of(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

[[nodiscard]] std::string in_words(const AuthorUses& done, const descriptor::SubsystemDescriptor& subsystem) {
  const std::string where =
      done.node != nullptr ? done.node : "the handler of " + subsystem.functions[done.function].name;
  return where + " of " + subsystem.name +
         " does in the cycle what real time forbids: " + count_of(done.uses.heap, "use") + " of the heap, " +
         count_of(done.uses.locks, "lock") + ", " + count_of(done.uses.outputs, "output") +
         "; do it before or in service(), take from pools; a debugger stops at it by `break hirosco_forbidden_use`";
}

}  // namespace

std::string hex(Octets octets) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const std::byte octet : octets) {
    text += digits[std::to_integer<std::size_t>(octet) >> 4];
    text += digits[std::to_integer<std::size_t>(octet) & 15];
  }
  return text;
}

descriptor::SubsystemDescriptor read_descriptor(const std::string& text) {
  const descriptor::FileSource source = [&](const std::filesystem::path&) { return Result<std::string>{text}; };
  auto reading = descriptor::read_subsystem("probe.xml", source);
  std::string problems;
  for (const auto& problem : reading.problems) problems += descriptor::render(problem, source, false);
  if (!reading.value) throw std::runtime_error{problems};
  return std::move(*reading.value);
}

descriptor::SubsystemDescriptor read_descriptor(const std::string& text, const std::vector<std::string>& commanded) {
  descriptor::SubsystemDescriptor commanding = read_descriptor(text);
  for (const std::string& other : commanded) {
    const descriptor::SubsystemDescriptor described = read_descriptor(other);
    const auto named = std::ranges::find(commanding.commands, described.name, &descriptor::Commands::subsystem);
    const auto heard = std::ranges::find(commanding.subscribes, described.name, &descriptor::Subscribes::subsystem);
    const bool commands = named != commanding.commands.end(), hears = heard != commanding.subscribes.end();
    if (!commands && !hears) throw std::runtime_error{"it neither commands nor hears " + described.name};
    const auto have = [&](std::vector<descriptor::Thing>& things) {
      if (const auto missing = descriptor::resolve(things, described); missing.thing != nullptr)
        throw std::runtime_error{missing.thing->name + " of " + described.name + ": " + std::string{missing.why}};
    };
    if (commands) {
      if (const auto missing = descriptor::resolve(*named, described); !missing.empty())
        throw std::runtime_error{described.name + " has no function " + std::string{missing}};
      have(named->things);
    }
    if (!hears) continue;
    heard->apid = described.id;
    have(heard->things);
  }
  return commanding;
}

Rig::Rig(Subsystem& author, const std::string& descriptor_text, bool realtime, bool wakes)
    : Rig{author, read_descriptor(descriptor_text), realtime, wakes} {}

struct Rig::Parts {
  ChannelPair channels{4096};
  VitalPage vital{};
  PermitPage permit{};
  GenericSubsystem subsystem;

  Parts(Rig& rig, Subsystem& author, descriptor::SubsystemDescriptor described, bool realtime, bool wakes)
      : subsystem{
            author,
            std::move(described),
            {.clock = rig.clock,
             .memory = rig.memory,
             .flows = rig.flows,
             .realtime = realtime,
             .wakes = wakes,
             .explain = [&rig](std::string_view text) { rig.explanations.emplace_back(text); },
             .read_again =
                 [this](std::string_view text) { return descriptor::read_again(subsystem.descriptor(), text, {}); }},
            channels.subsystem_end(),
            vital,
            permit} {}
};

Rig::Rig(Subsystem& author, descriptor::SubsystemDescriptor described, bool realtime, bool wakes)
    : parts_{std::make_unique<Parts>(*this, author, std::move(described), realtime, wakes)},
      channels{parts_->channels},
      vital{parts_->vital},
      permit{parts_->permit},
      subsystem{parts_->subsystem} {
  permit.release();
}
Rig::~Rig() = default;

TimePoint Rig::own_loop(std::size_t loop, TimePoint planned) { return subsystem.own_loop_step(loop, planned); }
void Rig::fence() { permit.fence(); }
const descriptor::SubsystemDescriptor& Rig::descriptor() const { return subsystem.descriptor(); }
State Rig::state() const { return subsystem.state(); }
std::uint32_t Rig::inhibited() const { return vital.inhibited.load(); }

void Rig::service() {
  if (!supervisor_silent) permit.heartbeat.fetch_add(1);
  static_cast<void>(subsystem.service_step(clock.now()));
  MessageBuffer buffer;
  for (;;) {
    const auto found = channels.supervisor_end().receive(buffer);
    if (!found || found->flow == Flow::None) return;
    const Octets packet = found->message.packet;
    if (found->message.kind == MessageKind::Event) raised.push_back(raised_by(packet));
    else if (const auto request = pus::TelecommandView::parse(packet))
      asked.push_back(asked_by(*request, found->message.epoch));
    else telemetry.push_back(told_by(packet, subsystem.descriptor()));
  }
}

void Rig::cycle(int count) {
  for (int i = 0; i < count; ++i) {
    const auto demand = subsystem.cycle_demand();
    if (!demand.wanted) return subsystem.cycle_parked(demand.ticket);
    if (!supervisor_silent) permit.heartbeat.fetch_add(1);
    clock.advance(demand.period);
    static_cast<void>(subsystem.cycle_step(clock.now()));
    const AuthorUses done = std::exchange(subsystem.cycle().author_uses(), {});
    if (cycles_watched && done.uses != RealtimeUses{})
      throw std::runtime_error{"Rig::cycle: " + in_words(done, subsystem.descriptor())};
  }
}

void Rig::settle(int rounds) {
  for (int i = 0; i < rounds; ++i) {
    service();
    cycle();
  }
  service();
}

Sent Rig::send(std::uint8_t service, std::uint8_t subtype, Octets data, const MemoryHandle& beside,
               std::uint32_t mode_epoch) {
  std::vector<std::byte> buffer(max_packet_octets);
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = subsystem.descriptor().id,
                                              .sequence_count = ++count_,
                                              .ack = pus::ack_all,
                                              .service = service,
                                              .subtype = subtype,
                                              .source = source},
                                             data);
  const auto sent = channels.supervisor_end().send({.epoch = mode_epoch, .packet = packet.value(), .memory = beside});
  if (!sent) throw std::runtime_error{sent.error().text};
  return {pus::TelecommandView::parse(packet.value()).value().request_id()};
}

Sent Rig::call(std::string_view function, std::initializer_list<double> arguments) {
  return call_with(function, {arguments.begin(), arguments.end()});
}

Sent Rig::call_with(std::string_view function, const std::vector<std::optional<Value>>& arguments) {
  return send(8, 1, call_data(subsystem.descriptor(), function, arguments));
}

Sent Rig::set_with(std::string_view parameter, const std::vector<std::optional<Value>>& values) {
  return send(20, 3, set_data(subsystem.descriptor(), parameter, values));
}

void Rig::answer(std::uint16_t from, std::uint8_t service, std::uint8_t subtype, Octets data,
                 std::optional<std::uint16_t> destination) {
  std::vector<std::byte> buffer(max_packet_octets);
  const auto packet = pus::write_telemetry(buffer,
                                           {.apid = from,
                                            .service = service,
                                            .subtype = subtype,
                                            .destination = destination.value_or(subsystem.descriptor().id)},
                                           data);
  if (const auto sent = channels.supervisor_end().send({.packet = packet.value()}); !sent)
    throw std::runtime_error{sent.error().text};
}

std::string Rig::set_state_now(State target) {
  const Sent request = set_state(target);
  settle();
  // Devices that no test plays are waited for.
  if (target == State::SafeOperational && outcome(request) == "1 3") {
    clock.advance(first_answer_limit);
    settle();
  }
  return outcome(request);
}

std::string Rig::configure_now(std::uint8_t id) {
  const Sent request = configure(id);
  settle();
  return outcome(request);
}

void Rig::bring_to(State target, std::uint8_t id) {
  const auto step = [&](State state) {
    if (const auto text = set_state_now(state); text != "1 3 7")
      throw std::runtime_error{std::string{to_text(state)} + ": " + text};
  };
  if (target == State::Offline) return;
  step(State::PreOperational);
  if (id != 0 && configure_now(id) != "1 3 7") throw std::runtime_error{"CONFIGURE failed"};
  if (target == State::PreOperational) return;
  if (target == State::PostOperational || target == State::ErrorOperational) return step(target);
  step(State::SafeOperational);
  if (target == State::Operational) step(State::Operational);
}

std::string Rig::outcome(Sent request) const { return outcome_in(telemetry, request); }

std::vector<std::string> Rig::reports(std::uint8_t service, std::uint8_t subtype) const {
  return reports_in(telemetry, service, subtype);
}

int Rig::events(std::uint16_t id) const {
  return static_cast<int>(std::ranges::count(telemetry, std::optional{id}, event_in));
}

Rig::Partner Rig::attach(std::uint8_t link, st128::Role role, std::string set, std::vector<st128::OfferedField> fields,
                         std::string* outcome_text, Duration producer_period) {
  const st128::AttachRequest request{
      .link = link,
      .role = role,
      .epoch = link_epoch,
      .set = std::move(set),
      .agreement = in_memory(std::move(fields), producer_period, subsystem.cycle_demand().period)};
  const LinkLayout layout = request.agreement.layout(request.epoch);
  Partner partner;
  partner.memory = memory.create("link", link_memory_octets(layout.payload_octets)).value();
  const bool we_produce = role == st128::Role::Consumer;
  if (we_produce) {
    partner.mapping = memory.map(partner.memory, Access::ReadWrite).value();
    partner.writer = LatestWriter::make(partner.mapping.octets, layout).value();
    static_cast<void>(memory.seal_writers(partner.memory));
  }
  std::vector<std::byte> buffer(max_packet_octets);
  const std::size_t octets = st128::write_attach_request(buffer, request).value();
  const Sent sent = send(128, st128::attach, Octets{buffer}.first(octets), partner.memory);
  service();
  cycle();
  if (outcome_text != nullptr) *outcome_text = outcome(sent);
  if (!we_produce) {
    partner.mapping = memory.map(partner.memory, Access::ReadOnly).value();
    if (auto reader = LatestReader::make(partner.mapping.octets, layout)) partner.reader = std::move(*reader);
  }
  return partner;
}

Sent Rig::detach(std::uint8_t link) {
  const std::byte data{link};
  return send(128, st128::detach, std::span{&data, 1});
}

}  // namespace hirosco::testing
