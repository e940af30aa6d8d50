// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <array>
#include <utility>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/descriptor/read/detail/mission_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

/// Built in: in every subsystem, and in the supervisor besides (decision 10).
constexpr std::array<std::string_view, 2> common_functions{"SET_STATE", "CONFIGURE"};
constexpr std::array<std::string_view, 12> supervisor_functions{
    "SET_MODE", "ENTER_MODE", "LINK",      "UNLINK", "SET_DATABASE", "SET_POWER_BUDGET",
    "REPLACE",  "CONFIRM",    "TAKE_BACK", "REREAD", "SAFE_ALL",     "SHUTDOWN"};

template <class Set>
std::vector<std::string_view> names_of(const std::vector<const Set*>& sets) {
  std::vector<std::string_view> names;
  for (const Set* set : sets) names.push_back(set->name);
  return names;
}

}  // namespace

void MissionReader::read_link(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  MissionLink link;
  link.at = place(element.at);
  link.id = attributes.required_integer<std::uint8_t>("id", 1, 255);
  const std::size_t before = problems_.count();
  const SubsystemDescriptor* producer = read_end(attributes, "from", link.from, link.provides);
  const SubsystemDescriptor* consumer = read_end(attributes, "to", link.to, link.requires_);
  read_way(attributes, link);
  if (producer != nullptr && consumer != nullptr) check_link(element, *producer, *consumer, link);
  read_loss(attributes, consumer, link);
  if (link.id != 0)
    link_ids_.add(std::to_string(link.id), place(element.find("id")->value_at), problems_,
                  element.find("id")->value.size());
  if (problems_.count() != before) ++doubtful_links_;
  mission_.links.push_back(std::move(link));
}

const SubsystemDescriptor* MissionReader::read_end(Attributes& attributes, std::string_view name,
                                                   std::string& subsystem, std::string& set) {
  const auto* at = attributes.required(name);
  if (at == nullptr) return nullptr;
  const std::size_t dot = at->value.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == at->value.size()) {
    problems_.add(*at, "E0110", in_quotes(at->value) + " does not name a set", "SUBSYSTEM.SET is needed");
    return nullptr;
  }
  subsystem = at->value.substr(0, dot);
  set = at->value.substr(dot + 1);
  return find(*at, subsystem, false);
}

void MissionReader::check_link(const xml::Element& element, const SubsystemDescriptor& producer,
                               const SubsystemDescriptor& consumer, const MissionLink& link) {
  std::vector<const Provides*> provides, provided;
  std::vector<const Requires*> requires_, required;
  for (const Configuration& configuration : producer.configurations)
    for (const Provides& set : configuration.provides)
      (set.name == link.provides ? provides : provided).push_back(&set);
  for (const Configuration& configuration : consumer.configurations)
    for (const Requires& set : configuration.requires_)
      (set.name == link.requires_ ? requires_ : required).push_back(&set);
  if (provides.empty())
    problems_.add(*element.find("from"), "E0307",
                  fmt::format("no configuration of '{}' provides {}", link.from, in_quotes(link.provides)),
                  did_you_mean(link.provides, names_of(provided)));
  if (requires_.empty())
    problems_.add(*element.find("to"), "E0307",
                  fmt::format("no configuration of '{}' requires {}", link.to, in_quotes(link.requires_)),
                  did_you_mean(link.requires_, names_of(required)));
  if (link.from == link.to) problems_.add(*element.find("to"), "E0308", "a link joins two subsystems");
  // A configuration may change a set; one pair that fits is enough, the handshake decides at run time.
  std::string why;
  for (const Requires* wanted : requires_)
    for (const Provides* offered : provides) {
      std::string reason = !wanted->from.empty() && wanted->from != link.from
                               ? fmt::format("'{}' is required from '{}'", wanted->name, wanted->from)
                               : mismatch(producer, *offered, *wanted, link.method);
      if (reason.empty()) return;
      if (why.empty()) why = std::move(reason);
    }
  if (!why.empty()) problems_.add(element, "E0308", fmt::format("link {} does not fit: {}", link.id, why));
}

void MissionReader::read_modes(const xml::Element& element) {
  Attributes attributes{element, problems_};
  each_child(element, problems_, {{"Mode", [this](const auto& child) { read_mode(child); }, 255}});
  if (mission_.modes.empty()) problems_.add(element, "E0106", "<Modes> needs at least one <Mode>");
  const auto mode = [&](const xml::Attribute* at) {
    if (at == nullptr) return std::string{};
    std::vector<std::string_view> known;
    for (const Mode& candidate : mission_.modes) known.push_back(candidate.name);
    if (mission_.find_mode(at->value) == nullptr)
      problems_.add(*at, "E0305", fmt::format("mode {} is not defined", in_quotes(at->value)),
                    did_you_mean(at->value, known));
    return at->value;
  };
  mission_.initial_mode = mode(attributes.required("initial"));
  const auto* start = attributes.optional("start");
  mission_.start_mode = mode(start);
  check_from(element);
  if (const Mode* first = mission_.find_mode(mission_.start_mode); first != nullptr && start != nullptr)
    check_start(*start, *first);
}

void MissionReader::read_mode(const xml::Element& element) {
  Attributes attributes{element, problems_};
  Mode mode;
  mode.at = place(element.at);
  mode.name = attributes.name("name", NameKind::Loose);
  // Counted from 1 in the order of the file, so that 0 means no mode.
  mode.id = attributes.integer_or<std::uint8_t>("id", 1, 255, static_cast<std::uint8_t>(mission_.modes.size() + 1));
  if (const auto* from = attributes.optional("from"))
    for (const auto word : words(from->value)) mode.from.emplace_back(word);
  const std::size_t before = problems_.count();
  Unique commissioned{"subsystem", "E0201"}, established{"link", "E0202"};
  each_child(element, problems_,
             {{"Commission", [&](const auto& child) { read_commission(child, mode, commissioned); }, 255},
              {"Establish", [&](const auto& child) { read_establish(child, mode, established); }, 255},
              {"Needs", [&](const auto& child) { read_interlock(child, Interlock::Kind::Needs, mode); }, 16},
              {"Excludes", [&](const auto& child) { read_interlock(child, Interlock::Kind::Excludes, mode); }, 16},
              {"Permit", [&](const auto& child) { read_permit(child, mode); }, 255}});
  const std::size_t length = element.name.size() + 1;
  if (!mode.name.empty()) mode_names_.add(mode.name, mode.at, problems_, length);
  mode_ids_.add(std::to_string(mode.id), mode.at, problems_, length, "a mode without id has its number in the file");
  check_power(element, mode);
  if (whole() && problems_.count() == before && doubtful_links_ == 0) {
    check_cycles(element, mode);
    check_required(mode);
    check_established(element, mode);
  }
  mission_.modes.push_back(std::move(mode));
}

State MissionReader::read_steady_state(Attributes& attributes, std::string_view name, State fallback) {
  const State state = attributes.one_of(name, fallback);
  const auto* at = attributes.optional(name);
  if (at != nullptr && !is_steady(state))
    problems_.add(*at, "E0306", fmt::format("{} is passed through, not commanded", to_text(state)),
                  "Offline, PreOperational, SafeOperational, Operational, ErrorOperational or PostOperational");
  return state;
}

void MissionReader::read_commission(const xml::Element& element, Mode& mode, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  CommissionStep step;
  step.at = place(element.at);
  const auto* subsystem = attributes.required("subsystem");
  const auto* configuration = attributes.required("configuration");
  step.state = read_steady_state(attributes, "state", State::Operational);
  if (step.state == State::ErrorOperational || step.state == State::PostOperational || step.state == State::Offline)
    problems_.add(*element.find("state"), "E0306",
                  fmt::format("commissioning does not lead to {}", to_text(step.state)),
                  "PreOperational, SafeOperational or Operational");
  if (subsystem == nullptr || configuration == nullptr) return;
  step.subsystem = subsystem->value;
  step.configuration = configuration->value;
  names.add(step.subsystem, place(subsystem->value_at), problems_, subsystem->value.size(),
            "one configuration for each subsystem of a mode");
  const SubsystemDescriptor* found = find(*subsystem, step.subsystem, false);
  if (found != nullptr && found->find_configuration(step.configuration) == nullptr) {
    std::vector<std::string_view> known;
    for (const Configuration& candidate : found->configurations) known.push_back(candidate.name);
    problems_.add(*configuration, "E0316",
                  fmt::format("'{}' has no configuration {}", found->name, in_quotes(step.configuration)),
                  did_you_mean(step.configuration, known));
  }
  mode.commission.push_back(std::move(step));
}

void MissionReader::read_establish(const xml::Element& element, Mode& mode, Unique& ids) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* at = attributes.required("link");
  const auto id = attributes.integer("link", 1, 255);
  if (at == nullptr || !id) return;
  if (mission_.find_link(static_cast<std::uint8_t>(*id)) == nullptr)
    problems_.add(*at, "E0309", fmt::format("link {} is not defined in <Links>", *id));
  ids.add(std::to_string(*id), place(at->value_at), problems_, at->value.size());
  mode.establish.push_back(static_cast<std::uint8_t>(*id));
}

void MissionReader::read_permit(const xml::Element& element, Mode& mode) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  Permit permit;
  permit.at = place(element.at);
  const auto* subsystem = attributes.required("subsystem");
  const auto* functions = attributes.optional("functions");
  const auto* services = attributes.optional("services");
  const auto* parameters = attributes.optional("parameters");
  if (functions == nullptr && services == nullptr && parameters == nullptr)
    problems_.add(element, "E0105", "<Permit> needs the attribute 'functions', 'services' or 'parameters'");
  if (functions != nullptr) {
    for (const auto function : words(functions->value)) permit.functions.emplace_back(function);
    if (permit.functions.empty()) problems_.add(*functions, "E0109", "attribute 'functions' is empty");
  }
  if (services != nullptr) {
    for (const auto word : words(services->value)) {
      const auto service = to_integer(word);
      if (!service) problems_.add(*services, "E0111", in_quotes(word) + " is not a whole number");
      else if (*service < 1 || *service > 255)
        problems_.add(*services, "E0112", fmt::format("service {} is out of range", *service), "1 to 255");
      else permit.services.push_back(static_cast<std::uint8_t>(*service));
    }
    if (words(services->value).empty()) problems_.add(*services, "E0109", "attribute 'services' is empty");
  }
  if (parameters != nullptr) {
    for (const auto parameter : words(parameters->value)) permit.parameters.emplace_back(parameter);
    if (permit.parameters.empty()) problems_.add(*parameters, "E0109", "attribute 'parameters' is empty");
  }
  if (subsystem == nullptr) return;
  permit.subsystem = subsystem->value;
  const bool known = permit.subsystem == "*" || find(*subsystem, permit.subsystem, true) != nullptr;
  if (known && functions != nullptr) check_functions(*functions, permit);
  if (known && parameters != nullptr) check_parameters(*parameters, permit);
  mode.permits.push_back(std::move(permit));
}

void MissionReader::check_functions(const xml::Attribute& at, const Permit& permit) {
  if (!whole()) return;
  std::vector<std::string_view> known{"*"};
  known.insert(known.end(), common_functions.begin(), common_functions.end());
  const auto add = [&](const SubsystemDescriptor& subsystem) {
    if (permit.subsystem == "*" || permit.subsystem == subsystem.name) {
      for (const Function& function : subsystem.functions) known.push_back(function.name);
      for (const CustomService& service : subsystem.services)
        for (const Function& request : service.requests) known.push_back(request.name);
    }
  };
  for (const SubsystemDescriptor* member : mission_.everybody()) add(*member);
  if (permit.subsystem == "*" || permit.subsystem == mission_.supervisor.name)
    known.insert(known.end(), supervisor_functions.begin(), supervisor_functions.end());
  for (const std::string& function : permit.functions)
    if (std::ranges::find(known, function) == known.end())
      problems_.add(at, "E0310",
                    permit.subsystem == "*"
                        ? fmt::format("no subsystem has a function {}", in_quotes(function))
                        : fmt::format("'{}' has no function {}", permit.subsystem, in_quotes(function)),
                    did_you_mean(function, known));
}

void MissionReader::check_parameters(const xml::Attribute& at, const Permit& permit) {
  if (!whole()) return;
  std::vector<std::string_view> known{"*"}, fixed;
  const auto add = [&](const SubsystemDescriptor& subsystem) {
    if (permit.subsystem != "*" && permit.subsystem != subsystem.name) return;
    for (const Parameter& parameter : subsystem.parameters)
      (parameter.writable() ? known : fixed).push_back(parameter.field.name);
  };
  for (const SubsystemDescriptor* member : mission_.everybody()) add(*member);
  const std::string whose = permit.subsystem == "*" ? "no subsystem has" : in_quotes(permit.subsystem) + " has no";
  for (const std::string& parameter : permit.parameters) {
    if (std::ranges::find(known, parameter) != known.end()) continue;
    const bool exists = std::ranges::find(fixed, parameter) != fixed.end();
    problems_.add(
        at, "E0320",
        exists ? fmt::format("parameter {} is never writable", in_quotes(parameter))
               : fmt::format("{} parameter {}", whose, in_quotes(parameter)),
        exists ? "its descriptor says in which states it is: writable=\"...\"" : did_you_mean(parameter, known));
  }
}

}  // namespace hirosco::descriptor::detail
