// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/supervisor_functions.hpp"
#include "hirosco/descriptor/read/detail/mode_parts.hpp"

/// What a mode lets through.
namespace hirosco::descriptor::detail {
namespace {

/// Built in: in every subsystem, and in the supervisor besides (decision 10).
constexpr std::array<std::string_view, 2> common_functions{"SET_STATE", "CONFIGURE"};
constexpr std::array<std::string_view, 12> supervisor_functions{
    "SET_MODE", "ENTER_MODE", "LINK",      "UNLINK", "SET_DATABASE", "SET_POWER_BUDGET",
    "REPLACE",  "CONFIRM",    "TAKE_BACK", "REREAD", "SAFE_ALL",     "SHUTDOWN"};

void check_functions(const xml::Attribute& at, const Permit& permit, MissionDraft& draft) {
  if (!draft.whole) return;
  std::vector<std::string_view> known{"*"};
  known.insert(known.end(), common_functions.begin(), common_functions.end());
  const auto add = [&](const SubsystemDescriptor& subsystem) {
    if (permit.subsystem == "*" || permit.subsystem == subsystem.name) {
      for (const Function& function : subsystem.functions) known.push_back(function.name);
      for (const CustomService& service : subsystem.services)
        for (const Function& request : service.requests) known.push_back(request.name);
    }
  };
  for (const SubsystemDescriptor* member : draft.mission.everybody()) add(*member);
  if (permit.subsystem == "*" || permit.subsystem == draft.mission.supervisor.name)
    known.insert(known.end(), supervisor_functions.begin(), supervisor_functions.end());
  for (const std::string& function : permit.functions)
    if (std::ranges::find(known, function) == known.end())
      draft.problems.add(at, "E0310",
                         permit.subsystem == "*"
                             ? fmt::format("no subsystem has a function {}", in_quotes(function))
                             : fmt::format("'{}' has no function {}", permit.subsystem, in_quotes(function)),
                         did_you_mean(function, known));
}

/// The framework's own (below 192) are known above the descriptors: here only whether somebody leaves such a one out for good.
[[nodiscard]] bool has_service(const SubsystemDescriptor& subsystem, std::uint8_t service) {
  if (service >= first_custom_service && subsystem.find_service(service) == nullptr) return false;
  return subsystem.offers(service, nullptr) ||
         std::ranges::any_of(subsystem.configurations,
                             [&](const Configuration& each) { return subsystem.offers(service, &each); });
}

/// A number that nobody has opens nothing: it is another one that is meant.
void check_services(const xml::Attribute& at, const Permit& permit, MissionDraft& draft) {
  if (!draft.whole) return;
  std::vector<const SubsystemDescriptor*> meant;
  std::string own;
  for (const SubsystemDescriptor* member : draft.mission.everybody()) {
    if (permit.subsystem != "*" && permit.subsystem != member->name) continue;
    meant.push_back(member);
    for (const CustomService& each : member->services) own += fmt::format(" {} ({})", each.type, each.name);
  }
  for (const std::uint8_t service : permit.services)
    if (std::ranges::none_of(meant, [&](const auto* each) { return has_service(*each, service); }))
      draft.problems.add(
          at, "E0352",
          permit.subsystem == "*" ? fmt::format("no subsystem has a service {}", service)
                                  : fmt::format("'{}' has no service {}", permit.subsystem, service),
          own.empty() ? "services of its own stand in its descriptor: <CustomService>" : "services of its own:" + own);
}

void check_parameters(const xml::Attribute& at, const Permit& permit, MissionDraft& draft) {
  if (!draft.whole) return;
  std::vector<std::string_view> known{"*"}, fixed;
  const auto add = [&](const SubsystemDescriptor& subsystem) {
    if (permit.subsystem != "*" && permit.subsystem != subsystem.name) return;
    for (const Parameter& parameter : subsystem.parameters)
      (parameter.writable() ? known : fixed).push_back(parameter.field.name);
  };
  for (const SubsystemDescriptor* member : draft.mission.everybody()) add(*member);
  const std::string whose = permit.subsystem == "*" ? "no subsystem has" : in_quotes(permit.subsystem) + " has no";
  for (const std::string& parameter : permit.parameters) {
    if (std::ranges::find(known, parameter) != known.end()) continue;
    const bool exists = std::ranges::find(fixed, parameter) != fixed.end();
    draft.problems.add(
        at, "E0320",
        exists ? fmt::format("parameter {} is never writable", in_quotes(parameter))
               : fmt::format("{} parameter {}", whose, in_quotes(parameter)),
        exists ? "its descriptor says in which states it is: writable=\"...\"" : did_you_mean(parameter, known));
  }
}

/// Whether a descriptor lets this subsystem ask something of whom the permit means.
[[nodiscard]] bool asks_somebody(const MissionSubsystem& member, const Permit& permit, const Mission& mission) {
  return std::ranges::any_of(member.subsystem.commands, [&](const Commands& commands) {
    const SubsystemDescriptor* whom = mission.find_member(commands.apid);
    return whom == nullptr || permit.subsystem == "*" || permit.subsystem == whom->name;  // null: that is reported
  });
}

/// Of the supervisor a function by its name, where no ground is named: for subsystems it would open nothing.
void check_asked_of_supervisor(const xml::Attribute& at, const Permit& permit, MissionDraft& draft) {
  if (permit.subsystem != draft.mission.supervisor.name || permit.names(ground_origin)) return;
  for (const std::string& function : permit.functions)
    if (function != "*" && !is_for_subsystems(function))
      draft.problems.add(at, "E0357",
                         fmt::format("{} of the supervisor is the ground's alone to ask for", in_quotes(function)),
                         "ENTER_MODE, SAFE_ALL and SET_MODE are what a subsystem may ask it for");
}

void read_origins(const xml::Attribute& at, Permit& permit, MissionDraft& draft) {
  Unique names{"origin", "E0201"};
  for (const auto word : words(at.value)) {
    names.add(std::string{word}, place(at.value_at), draft.problems, at.value.size());
    permit.from.emplace_back(word);
  }
  if (permit.from.empty()) draft.problems.add(at, "E0109", "attribute 'from' is empty");
}

/// Each is there, and may ask for something of whom the permit means: else that would open nothing for it.
void check_origins(const xml::Attribute& at, const Permit& permit, MissionDraft& draft) {
  if (!draft.whole) return;
  const Mission& mission = draft.mission;
  std::vector<std::string_view> known{ground_origin};
  for (const MissionSubsystem& member : mission.subsystems) known.push_back(member.subsystem.name);
  for (const std::string& name : permit.from) {
    const MissionSubsystem* member = mission.find_subsystem(name);
    if (name == mission.supervisor.name)
      draft.problems.add(at, "E0357", fmt::format("'{}' is bound to no mode", name),
                         "what it asks for its plans and changes of mode say");
    else if (name == ground_origin && member != nullptr)
      draft.problems.add(at, "E0357", "'ground' is the ground here, and a subsystem of the mission",
                         "call the subsystem by another name");
    else if (name != ground_origin && member == nullptr)
      draft.problems.add(at, "E0304", fmt::format("subsystem {} is not in the mission", in_quotes(name)),
                         did_you_mean(name, known));
    else if (member != nullptr && !asks_somebody(*member, permit, mission))
      draft.problems.add(at, "E0357",
                         permit.subsystem == "*" ? fmt::format("'{}' asks nobody for anything", name)
                                                 : fmt::format("'{}' asks '{}' for nothing", name, permit.subsystem),
                         "its descriptor says for what: <Commands>");
  }
  check_asked_of_supervisor(at, permit, draft);
}

}  // namespace

void read_permit(const xml::Element& element, Mode& mode, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  Permit permit;
  permit.at = place(element.at);
  const auto* subsystem = attributes.required("subsystem");
  const auto* functions = attributes.optional("functions");
  const auto* services = attributes.optional("services");
  const auto* parameters = attributes.optional("parameters");
  const auto* from = attributes.optional("from");
  if (functions == nullptr && services == nullptr && parameters == nullptr)
    draft.problems.add(element, "E0105", "<Permit> needs the attribute 'functions', 'services' or 'parameters'");
  if (functions != nullptr) {
    for (const auto function : words(functions->value)) permit.functions.emplace_back(function);
    if (permit.functions.empty()) draft.problems.add(*functions, "E0109", "attribute 'functions' is empty");
  }
  if (services != nullptr) {
    for (const auto word : words(services->value)) {
      const auto service = to_integer(word);
      if (!service) draft.problems.add(*services, "E0111", in_quotes(word) + " is not a whole number");
      else if (*service < 1 || *service > 255)
        draft.problems.add(*services, "E0112", fmt::format("service {} is out of range", *service), "1 to 255");
      else permit.services.push_back(static_cast<std::uint8_t>(*service));
    }
    if (words(services->value).empty()) draft.problems.add(*services, "E0109", "attribute 'services' is empty");
  }
  if (parameters != nullptr) {
    for (const auto parameter : words(parameters->value)) permit.parameters.emplace_back(parameter);
    if (permit.parameters.empty()) draft.problems.add(*parameters, "E0109", "attribute 'parameters' is empty");
  }
  if (from != nullptr) read_origins(*from, permit, draft);
  if (subsystem == nullptr) return;
  permit.subsystem = subsystem->value;
  const bool known = permit.subsystem == "*" || draft.find(*subsystem, permit.subsystem, true) != nullptr;
  if (known && functions != nullptr) check_functions(*functions, permit, draft);
  if (known && services != nullptr) check_services(*services, permit, draft);
  if (known && parameters != nullptr) check_parameters(*parameters, permit, draft);
  if (known && from != nullptr) check_origins(*from, permit, draft);
  mode.permits.push_back(std::move(permit));
}

}  // namespace hirosco::descriptor::detail
