// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/set_values.hpp"

#include <string_view>

#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "supervisor/supervision/telecommand/called_function.hpp"

namespace hirosco::supervisor {

bool sets_values(const pus::TelecommandView& telecommand) {
  return telecommand.service() == pus::ParameterService::service_type &&
         telecommand.subtype() == pus::ParameterService::set_values;
}

std::uint32_t owner_of(const descriptor::SubsystemDescriptor& subsystem, std::uint32_t id) {
  const auto place = descriptor::find_parameter(subsystem, id);
  return place ? descriptor::identity_of(subsystem, {{}, place->parameter, std::nullopt, {}}).wire() : id;
}

AwaitedChanges::Ids set_by(const pus::TelecommandView& telecommand, const descriptor::SubsystemDescriptor& subsystem,
                           const ValueSet& values) {
  AwaitedChanges::Ids ids;
  if (sets_values(telecommand)) {
    each_value(subsystem, telecommand.application_data(), [&](std::uint32_t id, Octets) {
      if (const auto owner = owner_of(subsystem, id); values.has(owner)) ids.insert(owner);
    });
    return ids;
  }
  const auto call = called_function(telecommand);
  const descriptor::Function* request =
      call ? subsystem.find_function(call->name) : subsystem.find_request(telecommand.service(), telecommand.subtype());
  if (request == nullptr) return ids;
  for (const auto& argument : request->arguments) {
    const auto* parameter =
        argument.of.empty() ? nullptr
                            : subsystem.find_parameter(std::string_view{argument.of}.substr(0, argument.of.find('.')));
    if (parameter == nullptr || !parameter->persistent) continue;
    ids.insert(ParameterId{subsystem.id, parameter->field.type, parameter->id}.wire());
  }
  return ids;
}

}  // namespace hirosco::supervisor
