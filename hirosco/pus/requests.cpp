// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/requests.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "hirosco/descriptor/model/wire_values.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st17_test/test_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco::pus {

using descriptor::Function;

namespace {

/// What fits one telecommand beside how many there are.
constexpr std::size_t most_setting_octets = max_telecommand_octets - telecommand_overhead_octets - 1;

[[nodiscard]] Function::Argument argument_of(const descriptor::SubsystemDescriptor& subsystem,
                                             const descriptor::Field& field) {
  Function::Argument argument;
  argument.field = field;
  if (field.type == Type::Bool)
    argument.texts = {{0, std::string{switch_word(false)}}, {1, std::string{switch_word(true)}}};
  const auto words = std::ranges::find(subsystem.enumerations, field.enumeration, &descriptor::Enumeration::name);
  if (!field.enumeration.empty() && words != subsystem.enumerations.end()) argument.texts = words->texts;
  return argument;
}

void add_settings(const descriptor::SubsystemDescriptor& subsystem, std::vector<Function>& requests) {
  const auto add = [&](const descriptor::ParameterRef& place) {
    const descriptor::Parameter& parameter = subsystem.parameters[place.parameter];
    if (parameter.octets(place.member) + sizeof(std::uint32_t) > most_setting_octets) return;
    Function setting;
    setting.name = std::string{setting_prefix} + place.text;
    setting.service = ParameterService::service_type;
    setting.subtype = ParameterService::set_values;
    setting.states = parameter.writable_states;
    setting.description = "Sets " + place.text + (place.member ? "" : ", all of it");
    setting.sets = descriptor::identity_of(subsystem, place).wire();
    for (const descriptor::Field& field : descriptor::fields_of(subsystem, place))
      setting.arguments.push_back(argument_of(subsystem, field));
    requests.push_back(std::move(setting));
  };
  for (std::size_t i = 0; i < subsystem.parameters.size(); ++i) {
    const descriptor::Parameter& parameter = subsystem.parameters[i];
    if (!parameter.writable()) continue;
    const auto index = static_cast<std::uint16_t>(i);
    add({parameter.field.name, index, std::nullopt, {}});
    for (std::uint16_t m = 0; m < parameter.numbers(); ++m)
      add({parameter.field.name + "." + std::string{parameter.identity_of(m).name}, index, m, {}});
  }
}

[[nodiscard]] Result<> write_setting(OctetWriter& writer, const Function& setting, GivenValues values) noexcept {
  writer.put(std::uint8_t{1}).put(setting.sets);
  std::size_t next = 0;
  for (const Function::Argument& argument : setting.arguments)
    for (std::size_t i = 0; i < value_count(argument); ++i) {
      const auto value = values.at(next++);
      if (!value) return fail(ErrorCode::InvalidArgument, "a value missing");
      HIROSCO_TRY(write_value(writer, argument, *value, Words::Padded));
    }
  if (next < values.size()) return fail(ErrorCode::InvalidArgument, "too many values");
  return ok();
}

[[nodiscard]] std::optional<std::vector<Value>> decode_setting(const Function& setting, Octets data) {
  if (!is_for(setting, setting.service, setting.subtype, data)) return std::nullopt;
  data = data.subspan(1 + sizeof setting.sets);
  std::vector<Value> all;
  for (const Function::Argument& argument : setting.arguments) {
    if (data.size() < argument.field.octets()) return std::nullopt;
    const auto values = descriptor::values_within(argument.field, data.first(argument.field.octets()));
    if (!values) return std::nullopt;
    all.insert(all.end(), values->begin(), values->end());
    data = data.subspan(argument.field.octets());
  }
  return data.empty() ? std::optional{std::move(all)} : std::nullopt;
}

}  // namespace

std::vector<Function> requests_of(const descriptor::SubsystemDescriptor& subsystem) {
  std::vector<Function> requests = common_functions();
  for (const ServiceKind* service : standard_services())
    for (const RequestKind& kind : service->requests) {
      if (kind.words.empty()) continue;
      Function request;
      request.name = kind.name;
      request.service = service->type;
      request.subtype = kind.subtype;
      request.states = kind.states;
      request.essential = service->needs_of(kind.subtype) == Needs::Essential;
      request.description = kind.words;
      requests.push_back(std::move(request));
    }
  requests.insert(requests.end(), subsystem.functions.begin(), subsystem.functions.end());
  for (const auto& service : subsystem.services)
    requests.insert(requests.end(), service.requests.begin(), service.requests.end());
  add_settings(subsystem, requests);
  return requests;
}

bool is_for(const Function& request, std::uint8_t service, std::uint8_t subtype, Octets data) {
  if (request.service != service || request.subtype != subtype) return false;
  if (request.sets == 0) return true;
  OctetReader reader{data};
  return reader.get<std::uint8_t>() == 1 && reader.get<std::uint32_t>() == request.sets && reader.good();
}

bool goes_alone(const Function& request) noexcept {
  return request.essential && request.service != TestService::service_type;
}

Result<Octets> write_request(MutableOctets room, const Function& request, GivenValues values) noexcept {
  OctetWriter writer{room};
  const auto write = [&]() noexcept -> Result<> {
    if (request.service == FunctionService::service_type) return write_call(writer, request, values);
    if (request.sets != 0) return write_setting(writer, request, values);
    return write_values(writer, request.arguments, values, Ids::None);
  };
  HIROSCO_TRY(write());
  return all_written(writer);
}

Result<std::vector<std::byte>> encode_request(const Function& request, GivenValues values) {
  std::array<std::byte, max_telecommand_octets> room;
  HIROSCO_TRY_LET(const Octets data, write_request(room, request, values));
  return std::vector<std::byte>(data.begin(), data.end());
}

std::optional<std::vector<Value>> decode_request(const Function& request, Octets data) {
  if (request.service == FunctionService::service_type) {
    const auto call = decode_call({&request, 1}, data);
    if (!call) return std::nullopt;
    return ArgumentReader{request.arguments, call->arguments}.rest();
  }
  if (request.sets != 0) return decode_setting(request, data);
  if (!first_not_permitted(request.arguments, data)) return std::nullopt;
  return ArgumentReader{request.arguments, data}.rest();
}

}  // namespace hirosco::pus
