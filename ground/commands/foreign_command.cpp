// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/commands/foreign_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ground/model/json.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

struct Senders {
  std::uint16_t first;
  std::uint16_t last;
  const char* name;
};
constexpr std::array senders{Senders{0x1000, 0x1000, "an exported database"},
                             Senders{0x2000, 0x3FFF, "another ground station"}, Senders{0x4000, 0x7FFF, "hirosco tc"},
                             Senders{0x8000, 0xBFFF, "a Python client"}};

/// The name in the first 16 octets of TC[8,1], up to its padding.
[[nodiscard]] std::string function_name(Octets data) {
  const Octets field = data.first(std::min(data.size(), pus::function_name_octets));
  std::string name{reinterpret_cast<const char*>(field.data()), field.size()};
  name.resize(std::min(name.find('\0'), name.size()));
  return name.empty() ? "?" : name;
}

[[nodiscard]] json argument_json(const hirosco::Value& value, const std::vector<descriptor::EnumerationText>& texts) {
  const auto named =
      std::ranges::find_if(texts, [&](const auto& entry) { return value == hirosco::Value{Number{entry.value}}; });
  return named != texts.end() ? json(named->text) : json_value(value);
}

[[nodiscard]] json arguments_json(const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem,
                                  const descriptor::Function& function, Octets data) {
  json arguments = json::object();
  const auto values_of = pus::decode_request(function, data);
  if (!values_of) return arguments;
  std::size_t next = 0;
  for (const auto& argument : function.arguments) {
    const auto texts = catalogue.texts_of(subsystem, function, argument);
    json values = json::array();
    for (std::size_t i = 0; i < pus::value_count(argument); ++i)
      values.push_back(argument_json((*values_of)[next++], texts));
    arguments[argument.field.name] = values.size() == 1 ? values.front() : values;
  }
  return arguments;
}

}  // namespace

std::string sender_of(std::uint16_t source) {
  for (const Senders& range : senders)
    if (source >= range.first && source <= range.last) return fmt::format("{} ({})", range.name, source);
  return fmt::format("another ground ({})", source);
}

StoredCommand command_of(const Catalogue& catalogue, const pus::TelecommandView& telecommand) {
  StoredCommand command;
  command.sender = sender_of(telecommand.source());
  command.apid = telecommand.apid();
  command.subsystem = catalogue.name_of(command.apid);
  command.function = fmt::format("TC[{},{}]", telecommand.service(), telecommand.subtype());
  command.arguments = "{}";
  command.stage = "sent";
  const bool call = telecommand.service() == pus::FunctionService::service_type &&
                    telecommand.subtype() == pus::FunctionService::perform_function;
  if (call) command.function = function_name(telecommand.application_data());
  const auto* subsystem = catalogue.find(command.apid);
  if (subsystem == nullptr) return command;
  const auto requests = catalogue.functions_of(*subsystem);
  const auto known = std::ranges::find_if(requests, [&](const descriptor::Function& request) {
    if (call) return request.service == telecommand.service() && request.name == command.function;
    return pus::is_for(request, telecommand.service(), telecommand.subtype(), telecommand.application_data());
  });
  if (known == requests.end()) return command;
  command.function = known->name;
  command.arguments = to_string(arguments_json(catalogue, *subsystem, *known, telecommand.application_data()));
  return command;
}

}  // namespace hirosco::ground
