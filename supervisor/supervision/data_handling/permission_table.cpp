// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/permission_table.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "supervisor/supervision/data_handling/permission.hpp"

namespace hirosco::supervisor {
namespace {

using descriptor::State;

constexpr std::size_t called_name_octets = 16;

[[nodiscard]] std::vector<std::byte> call_of(std::string_view function, std::optional<std::uint8_t> argument = {}) {
  std::vector<std::byte> data(called_name_octets);
  std::ranges::copy(std::as_bytes(std::span{function}).first(std::min(function.size(), called_name_octets)),
                    data.begin());
  data.push_back(argument ? std::byte{1} : std::byte{0});
  if (argument) data.insert(data.end(), {std::byte{1}, std::byte{*argument}});
  return data;
}

[[nodiscard]] std::vector<std::byte> set_of(std::uint16_t apid, const descriptor::Parameter& parameter) {
  std::vector<std::byte> data(1 + sizeof(std::uint32_t) + parameter.octets());
  OctetWriter{data}.put(std::uint8_t{1}).put(ParameterId{apid, parameter.field.type, parameter.id}.wire());
  return data;
}

/// With none in force, and with each.
[[nodiscard]] std::vector<const descriptor::Configuration*> all_configurations(
    const descriptor::SubsystemDescriptor& subsystem) {
  std::vector<const descriptor::Configuration*> all{nullptr};
  for (const auto& each : subsystem.configurations) all.push_back(&each);
  return all;
}

[[nodiscard]] std::vector<std::string> refusing(const descriptor::SubsystemDescriptor& subsystem,
                                                std::uint8_t service) {
  std::vector<std::string> names;
  for (const auto* each : all_configurations(subsystem))
    if (!subsystem.offers(service, each)) names.push_back(each == nullptr ? "-" : each->name);
  return names;
}

[[nodiscard]] bool offered_everywhere(const descriptor::SubsystemDescriptor& subsystem, std::uint8_t service) {
  return refusing(subsystem, service).empty();
}

/// One that offers the service; 0: none, or none needs to be in force.
[[nodiscard]] std::uint8_t offering(const descriptor::SubsystemDescriptor& subsystem, std::uint8_t service) {
  for (const auto* each : all_configurations(subsystem))
    if (subsystem.offers(service, each)) return each == nullptr ? std::uint8_t{0} : each->id;
  return 0;
}

class Table {
 public:
  Table(const descriptor::Mission& mission, const descriptor::Mode& mode)
      : mission_{mission}, mode_{mode}, links_{mission} {}

  void ask_everything(const Origin& origin, const descriptor::SubsystemDescriptor& addressee) {
    asked_.origin = origin;
    asked_.addressee = &addressee;
    for (const pus::ServiceKind* kind : pus::standard_services())
      for (const pus::RequestKind& request : kind->requests)
        if (kind->type != pus::FunctionService::service_type) ask_service(kind->type, request);
    for (const auto& row : EnumTexts<State>::table)
      ask_function(fmt::format("SET_STATE {}", row.text), call_of("SET_STATE", static_cast<std::uint8_t>(row.value)));
    ask_function("CONFIGURE", call_of("CONFIGURE", 0));
    for (const descriptor::Function& function : addressee.functions)
      ask_function(function.name, call_of(function.name));
    ask_declared(origin, addressee);
    for (const descriptor::CustomService& service : addressee.services)
      for (const descriptor::Function& request : service.requests)
        ask(service.type, request.subtype, fmt::format("{} {}", service.name, request.name), {});
  }

  [[nodiscard]] std::vector<PermissionRow> take() && { return std::move(rows_); }

 private:
  /// What one subsystem may ask the services of another about, thing by thing, and what it may hear.
  void ask_declared(const Origin& origin, const descriptor::SubsystemDescriptor& addressee) {
    const auto* sender = origin.is_subsystem() ? mission_.find_subsystem(origin.apid()) : nullptr;
    if (sender == nullptr) return;
    for (const descriptor::Commands& commands : sender->subsystem.commands)
      for (const descriptor::Thing& thing : commands.things)
        if (commands.apid == addressee.id) ask_thing(thing);
    if (addressee.id != supervisor_apid) return;
    for (const descriptor::Subscribes& subscribes : sender->subsystem.subscribes)
      for (const descriptor::Thing& thing : subscribes.things) {
        using What = pus::st129::Subscribed::What;
        const bool event = thing.kind == descriptor::Thing::Kind::Event;
        const auto data = pus::st129::write_subscribed(
            {subscribes.apid, event ? What::Event : What::Structure, static_cast<std::uint16_t>(thing.id)});
        ask(pus::st129::service_type, pus::st129::subscribe,
            fmt::format("hear {} of {}", thing.name, mission_.find_member(subscribes.apid)->name), data);
      }
  }

  void ask_thing(const descriptor::Thing& thing) {
    using Kind = descriptor::Thing::Kind;
    if (thing.kind == Kind::Set) return;  // among all parameters
    const bool parameter = thing.kind == Kind::Read;
    std::vector<std::byte> data(1 + (parameter ? sizeof(std::uint32_t) : sizeof(std::uint16_t)));
    OctetWriter writer{data};
    writer.put(std::uint8_t{1});
    if (parameter) writer.put(thing.id);
    else writer.put(static_cast<std::uint16_t>(thing.id));
    using Housekeeping = pus::HousekeepingService;
    using Events = pus::EventService;
    if (parameter)
      return ask(pus::ParameterService::service_type, pus::ParameterService::report_values, "read " + thing.name, data);
    if (thing.kind == Kind::Event) {
      ask(Events::service_type, Events::enable_reports, "enable " + thing.name, data);
      return ask(Events::service_type, Events::disable_reports, "disable " + thing.name, data);
    }
    ask(Housekeeping::service_type, Housekeeping::enable_periodic, "enable " + thing.name, data);
    ask(Housekeeping::service_type, Housekeeping::disable_periodic, "disable " + thing.name, data);
    ask(Housekeeping::service_type, Housekeeping::one_shot, "one shot of " + thing.name, data);
    data.resize(data.size() + sizeof(std::uint32_t));
    ask(Housekeeping::service_type, Housekeeping::modify_interval, "interval of " + thing.name, data);
  }

  void ask_service(std::uint8_t type, const pus::RequestKind& request) {
    const bool sets =
        type == pus::ParameterService::service_type && request.subtype == pus::ParameterService::set_values;
    if (!sets) return ask(type, request.subtype, fmt::format("TC[{},{}] {}", type, request.subtype, request.name), {});
    for (const descriptor::Parameter& parameter : asked_.addressee->parameters)
      ask(type, request.subtype, fmt::format("set {}", parameter.field.name), set_of(asked_.addressee->id, parameter));
  }

  void ask_function(std::string request, const std::vector<std::byte>& data) {
    ask(pus::FunctionService::service_type, 1, std::move(request), data);
  }

  void ask(std::uint8_t service, std::uint8_t subtype, std::string request, Octets data) {
    std::array<std::byte, 2048> buffer;
    const auto octets = pus::write_telecommand(
        buffer, {.apid = asked_.addressee->id, .service = service, .subtype = subtype, .source = asked_.origin.apid()},
        data);
    if (!octets) return;
    const auto telecommand = pus::TelecommandView::parse(*octets);
    if (!telecommand) return;
    PermissionRow row = asked_;
    row.service = service;
    row.subtype = subtype;
    row.request = std::move(request);
    const bool everywhere = offered_everywhere(*asked_.addressee, service);
    for (const auto& state : EnumTexts<State>::table) {
      const auto bit = static_cast<std::uint16_t>(1U << static_cast<unsigned>(state.value));
      Situation situation{.mission = mission_, .mode = mode_, .links = links_, .state = state.value};
      if (!everywhere) situation.configuration = offering(*asked_.addressee, service);
      const auto decision = decide(*telecommand, asked_.origin, situation);
      situation.changing = true;
      if (decision) row.permitted |= bit;
      if (decision && decision->essential) row.essential |= bit;
      if (decide(*telecommand, asked_.origin, situation)) row.in_change |= bit;
    }
    if (!everywhere) row.not_in = refusing(*asked_.addressee, service);
    rows_.push_back(std::move(row));
  }

  const descriptor::Mission& mission_;
  const descriptor::Mode& mode_;
  const LinkGraph links_;
  PermissionRow asked_;  ///< of every row: who asks whom
  std::vector<PermissionRow> rows_;
};

}  // namespace

std::vector<PermissionRow> permission_table(const descriptor::Mission& mission, const descriptor::Mode& mode) {
  std::vector<Origin> origins{Origin::ground(), Origin::supervisor()};
  for (const auto& member : mission.subsystems) {
    if (!member.subsystem.commands.empty() || !member.subsystem.subscribes.empty())
      origins.push_back(Origin::subsystem(member.subsystem.id));
  }
  Table table{mission, mode};
  for (const Origin& origin : origins)
    for (const descriptor::SubsystemDescriptor* addressee : mission.everybody())
      table.ask_everything(origin, *addressee);
  return std::move(table).take();
}

}  // namespace hirosco::supervisor
