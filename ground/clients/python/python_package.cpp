// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_package.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include "ground/clients/python/python_services.hpp"
#include "ground/clients/python/python_text.hpp"
#include "ground/clients/python/python_values.hpp"
#include "ground/clients/python/runtime_text.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"

namespace hirosco::ground {
namespace {

using Texts = std::vector<descriptor::EnumerationText>;

/// Public names of runtime.Subsystem and runtime.Craft (runtime_test.py compares).
const std::set<std::string> subsystem_names{
    "configuration", "disable_housekeeping", "enable_housekeeping", "latest", "record", "state"};
const std::set<std::string> craft_names{"close",    "connected", "damaged",  "events", "kept_events", "mode",
                                        "on_event", "on_link",   "received", "source", "wait_event",  "wait_until"};
constexpr std::uint16_t in_every_state = 0x03FF;

/// The class of one subsystem: the table of its descriptor, and its methods.
class SubsystemClass {
 public:
  SubsystemClass(const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem)
      : catalogue_{catalogue}, subsystem_{subsystem}, names_{subsystem_names} {
    for (const auto& function : catalogue_.functions_of(subsystem_))
      if (function.sets == 0) add_function(function);  // parameters have methods of their own
    add_reports();
    for (const auto& parameter : subsystem_.parameters) add_parameter(parameter);
    for (const auto& event : subsystem_.events) add_event(event);
    for (const auto& service : subsystem_.services) add_own_reports(service);
    // Last: no name that the descriptor gives a method is another one for them.
    const ServiceMethods framework = service_methods(catalogue_, subsystem_, names_);
    requests_ = framework.tables;
    methods_ += framework.methods;
  }

  [[nodiscard]] std::string text(const std::string& name) const {
    std::string result = "\n\nclass " + name + "(_r.Subsystem):\n";
    result += docstring(
        "    ",
        {fmt::format("{}: {}", doc(subsystem_.name), doc(subsystem_.description)), "",
         fmt::format("Application process {}. Methods return when the request is completed; with wait=None at once "
                     "(Request.result() waits).",
                     subsystem_.id)});
    Texts configurations;
    for (const auto& one : subsystem_.configurations) configurations.push_back({one.id, one.name});
    result += "    _about = _r.SubsystemAbout(\n";
    result += fmt::format("        name={}, apid={}, configurations={},\n", python_string(subsystem_.name),
                          subsystem_.id, pairs(configurations));
    result += "        functions=(\n" + functions_ + "        ),\n        parameters=(\n" + parameters_ +
              "        ),\n        layouts=(\n" + layouts_ + "        ),\n        events=(\n" + events_ +
              "        ),\n        reports=(\n" + reports_ + "            *_told,\n        ), requests=(" + requests_ +
              "))\n";
    return result + methods_;
  }

 private:
  [[nodiscard]] PythonValue value_of(const descriptor::Field& field) const {
    return {field, std::nullopt, catalogue_.texts_of(subsystem_, {}, field), 0, true};
  }

  void add_method(const std::string& signature, const std::vector<std::string>& says, const std::string& body) {
    methods_ += method(signature, says, body);
  }

  void add_function(const descriptor::Function& function) {
    PythonNames local{{"self", "wait"}};
    std::vector<PythonValue> values;
    std::vector<std::string> says{doc(function.description.empty() ? function.name : function.description)};
    std::string parameters, given;
    bool optional = false;
    for (const auto& argument : function.arguments) {
      PythonValue value{argument.field, argument.fallback, catalogue_.texts_of(subsystem_, function, argument), 0,
                        false};
      const std::string name = local.variable(argument.field.name);
      optional = optional || argument.fallback;
      parameters +=
          fmt::format(", {}: {}", name, optional ? "_t.Optional[" + annotation(value) + "] = None" : annotation(value));
      given += name + ", ";
      if (says.size() == 1) says.emplace_back();
      says.push_back(name + ": " + described(value));
      values.push_back(std::move(value));
    }
    std::string states;
    for (const auto& row : EnumTexts<descriptor::State>::table)
      if (function.permitted_in(row.value)) states += (states.empty() ? "" : ", ") + std::string{row.text};
    if (function.states != 0 && function.states != in_every_state)
      says.insert(says.end(), {"", "Permitted in: " + states});
    const bool call = function.service == pus::FunctionService::service_type;
    const std::string carried = call ? "" : fmt::format(", service={}, subtype={}", function.service, function.subtype);
    functions_ += fmt::format("            _r.Function({}{}, arguments={}{}),\n", python_string(function.name), carried,
                              fields_tuple(values), pus::goes_alone(function) ? ", alone=True" : "");
    add_method(fmt::format("{}(self{}, *, wait: _t.Optional[float] = 70.0) -> _r.Request",
                           names_.variable(function.name), parameters),
               says, fmt::format("self._call({}, ({}), wait)", python_string(function.name), given));
  }

  void add_reports() {
    std::vector<std::uint16_t> done;
    std::set<std::string> written;
    for (const Report& first : catalogue_.reports()) {
      if (first.apid != subsystem_.id || std::ranges::find(done, first.sid) != done.end()) continue;
      done.push_back(first.sid);
      std::vector<std::string> says{fmt::format("The next housekeeping report {}.", first.sid), ""};
      for (const PythonValue& column : columns_of(first))
        says.push_back(doc(column.field.name) + ": " + described(column));
      add_method(fmt::format("{}(self, timeout: float = 5.0) -> _r.Housekeeping",
                             names_.variable("hk_" + std::to_string(first.sid))),
                 says, fmt::format("self._next({}, timeout)", first.sid));
      // Configurations may give one id several forms; they differ in length.
      for (const Report& report : catalogue_.reports()) {
        if (report.apid != subsystem_.id || report.sid != first.sid) continue;
        const std::string row = fmt::format("            _r.Layout({}, {}, columns={}),\n", report.sid, report.octets,
                                            fields_tuple(columns_of(report)));
        if (written.insert(row).second) layouts_ += row;
      }
    }
  }

  /// The columns of a report with arrays put together again, named without the subsystem.
  [[nodiscard]] std::vector<PythonValue> columns_of(const Report& report) const {
    std::vector<PythonValue> values;
    for (const Place& place : report.places) {
      const Column& column = catalogue_.columns()[place.column];
      std::string name = column.name.substr(subsystem_.name.size() + 1);
      const auto bracket = name.rfind('[');
      const bool element = bracket != std::string::npos && name.back() == ']';
      const std::string index = element ? name.substr(bracket) : "";
      if (element) name.resize(bracket);
      if (element && !values.empty() && values.back().field.name == name &&
          index == fmt::format("[{}]", values.back().field.count)) {
        ++values.back().field.count;
        continue;
      }
      PythonValue value;
      value.field.name = name;
      value.field.type = column.type;
      value.field.text_octets = column.text_octets;
      value.fixed = true;
      value.field.unit = column.unit;
      value.field.minimum = column.minimum;
      value.field.maximum = column.maximum;
      if (column.enumeration != nullptr) value.texts = column.enumeration->texts;
      value.offset = place.offset;
      values.push_back(std::move(value));
    }
    return values;
  }

  void add_parameter(const descriptor::Parameter& parameter) {
    const auto index = static_cast<std::uint16_t>(&parameter - subsystem_.parameters.data());
    add_place({parameter.field.name, index, std::nullopt, {}}, {});
    for (std::uint16_t m = 0; m < parameter.numbers(); ++m) {
      const std::string inside{parameter.identity_of(m).name};
      add_place({parameter.field.name + "." + inside, index, m, {}}, inside + ".");
    }
  }

  /// A parameter or what is in it; `way` of a structure within: before the names of its members.
  void add_place(const descriptor::ParameterRef& place, const std::string& way) {
    const descriptor::Parameter& parameter = subsystem_.parameters[place.parameter];
    const ParameterId id = descriptor::identity_of(subsystem_, place);
    std::vector<PythonValue> values;
    for (descriptor::Field field : descriptor::fields_of(subsystem_, place)) {
      if (id.layout == Type::Struct && !way.empty()) field.name.erase(0, way.size());
      values.push_back(value_of(field));
    }
    const bool dictionary = id.layout == Type::Struct;
    add_get(place.text, id, values, dictionary);
    if (parameter.writable()) add_set(place.text, values, dictionary);
  }

  void add_get(const std::string& name, ParameterId id, const std::vector<PythonValue>& values, bool dictionary) {
    parameters_ += fmt::format("            _r.Parameter({}, {:#x}, fields={}{}),\n", python_string(name), id.wire(),
                               fields_tuple(values), dictionary ? ", structure=True" : "");
    std::vector<std::string> says{"Asks for " + doc(name) + "."};
    if (dictionary) says.front() += " A dictionary:";
    says.emplace_back();
    for (const PythonValue& value : values)
      says.push_back((dictionary ? doc(value.field.name) + ": " : "") + described(value));
    add_method(names_.variable("get_" + name) + "(self, wait: float = 10.0)", says,
               fmt::format("self._get({}, wait)", python_string(name)));
  }

  void add_set(const std::string& name, const std::vector<PythonValue>& values, bool dictionary) {
    std::vector<std::string> says{
        "Sets " + doc(name) + (dictionary ? ", all of it at once. value, a dictionary:" : "."), ""};
    for (const PythonValue& value : values)
      says.push_back((dictionary ? doc(value.field.name) : "value") + ": " + described(value));
    add_method(fmt::format("{}(self, value: {}, *, wait: _t.Optional[float] = 10.0) -> _r.Request",
                           names_.variable("set_" + name),
                           dictionary ? "_t.Mapping[str, _t.Any]" : annotation(values.front())),
               says, fmt::format("self._set({}, value, wait)", python_string(name)));
  }

  void add_event(const descriptor::Event& event) {
    std::vector<PythonValue> values;
    for (const auto& argument : event.arguments) values.push_back(value_of(argument));
    events_ += fmt::format("            _r.EventKind({}, {}, arguments={}),\n", event.id, python_string(event.name),
                           fields_tuple(values));
  }

  /// They stand in the `reports` of the request that they answer.
  void add_own_reports(const descriptor::CustomService& service) {
    for (const auto& report : service.reports) {
      std::vector<PythonValue> values;
      for (const auto& field : report.fields) values.push_back({field.field, std::nullopt, field.texts, 0, false});
      reports_ += fmt::format("            _r.ReportKind({}, {}, {}, fields={}),\n", service.type, report.subtype,
                              python_string(report.name), fields_tuple(values));
    }
  }

  const Catalogue& catalogue_;
  const descriptor::SubsystemDescriptor& subsystem_;
  PythonNames names_;
  std::string functions_, parameters_, layouts_, events_, reports_, requests_, methods_;
};

/// "127.0.0.1:10015": host and port, 0 where it has none.
[[nodiscard]] std::pair<std::string, std::uint16_t> host_and_port(const std::string& address) {
  const auto colon = std::min(address.rfind(':'), address.size());
  std::uint16_t port = 0;
  if (colon < address.size()) std::from_chars(address.data() + colon + 1, address.data() + address.size(), port);
  return {address.substr(0, colon), port};
}

[[nodiscard]] std::string mission_about(const Catalogue& catalogue) {
  const auto& mission = catalogue.mission();
  const auto [host, port] = host_and_port(mission.ground.telemetry);
  Texts modes, links, failures;
  for (const auto& mode : mission.modes) modes.push_back({mode.id, mode.name});
  for (const auto& link : mission.links) links.push_back({link.id, link.from + "." + link.provides + " to " + link.to});
  for (const auto& row : EnumTexts<pus::FailureCode>::table)
    failures.push_back({static_cast<std::int64_t>(row.value), std::string{row.text}});
  return fmt::format(
      "    _about = _r.MissionAbout(\n        name={}, host={}, port={}, supervisor={},\n        modes={},\n"
      "        links={},\n        failures={}, telecommand_port={})\n",
      python_string(mission.name), python_string(host), port, python_string(mission.supervisor.name), pairs(modes),
      pairs(links), pairs(failures), host_and_port(mission.ground.telecommand).second);
}

[[nodiscard]] std::string module_text(const Catalogue& catalogue) {
  const std::string mission = doc(catalogue.mission().name);
  std::string text = docstring(
      "",
      {"The mission " + mission + " for Python 3.9 or later. Generated by `hirosco export python`: export again rather",
       "than change it.", "", "    with Spacecraft() as craft:", "        print(craft.mode)"});
  text +=
      "from __future__ import annotations\n\nimport typing as _t\n\nfrom . import runtime as _r\n"
      "from .runtime import ArgumentError, CommandFailed, HiroscoError, LinkLost, NoAnswer  # noqa: F401\n";
  text += service_tables();
  // The names above are taken, and that of the spacecraft itself.
  PythonNames types{{"ArgumentError", "CommandFailed", "HiroscoError", "LinkLost", "NoAnswer", "Spacecraft"}};
  PythonNames members{craft_names};
  std::string made, all;
  for (const auto* subsystem : catalogue.subsystems()) {
    const std::string type = types.type(subsystem->name);
    const std::string member = members.variable(subsystem->name);
    text += SubsystemClass{catalogue, *subsystem}.text(type);
    made += fmt::format("        self.{} = {}(self)\n", member, type);
    all += fmt::format("self.{}, ", member);
  }
  text += "\n\nclass Spacecraft(_r.Craft):\n" +
          docstring("    ", {"The mission " + mission + " in flight: a link to it, and its subsystems."});
  text += mission_about(catalogue);
  text +=
      "\n    def __init__(self, host: _t.Optional[str] = None, port: _t.Optional[int] = None, "
      "timeout: float = 5.0,\n                 instance: _t.Optional[str] = None, reconnect: bool = False,\n"
      "                 telecommand_port: _t.Optional[int] = None) -> None:\n"
      "        super().__init__(host, port, timeout, instance, reconnect, telecommand_port)\n";
  return text + made + "        self._subsystems = (" + all + ")\n        self._start()\n";
}

}  // namespace

PythonPackage python_package(const Catalogue& catalogue) {
  constexpr std::string_view licence =
      "# SPDX-FileCopyrightText: 2026 The HIROSCO developers\n# SPDX-License-Identifier: Apache-2.0\n";
  PythonPackage package;
  package.name = "hirosco_" + PythonNames{{}}.variable(catalogue.mission().name);
  package.files["__init__.py"] = std::string{licence} + module_text(catalogue);
  for (const PythonFile& file : python_runtime) package.files[std::string{file.name}] = std::string{file.text};
  return package;
}

}  // namespace hirosco::ground
