// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_package.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "ground/clients/python/runtime_text.hpp"
#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/service/service_kind.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco::ground {
namespace {

using Texts = std::vector<descriptor::EnumerationText>;

constexpr std::array keywords{"False", "None",     "True",  "and",    "as",   "assert", "async",  "await",    "break",
                              "class", "continue", "def",   "del",    "elif", "else",   "except", "finally",  "for",
                              "from",  "global",   "if",    "import", "in",   "is",     "lambda", "nonlocal", "not",
                              "or",    "pass",     "raise", "return", "try",  "while",  "with",   "yield"};
/// Public names of runtime.Subsystem and runtime.Craft (runtime_test.py compares).
const std::set<std::string> subsystem_names{
    "configuration", "disable_housekeeping", "enable_housekeeping", "latest", "record", "state"};
const std::set<std::string> craft_names{"close",    "connected", "damaged",  "events", "kept_events", "mode",
                                        "on_event", "on_link",   "received", "source", "wait_event",  "wait_until"};
/// More names would hide what matters in an editor's help.
constexpr std::size_t most_literals = 16;
constexpr std::uint16_t in_every_state = 0x03FF;

[[nodiscard]] bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
[[nodiscard]] bool is_digit(char c) { return c >= '0' && c <= '9'; }
[[nodiscard]] char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
[[nodiscard]] char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// The code point at the front and its octets; U+FFFD and one octet for what is no UTF-8.
[[nodiscard]] std::pair<std::uint32_t, std::size_t> code_point(std::string_view text) {
  constexpr std::uint32_t replacement = 0xFFFD;
  const auto octet = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = octet(0);
  if (first < 0x80) return {first, 1};
  const std::size_t octets = first >= 0xF0 && first < 0xF5 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < octets) return {replacement, 1};
  std::uint32_t point = first & (0x7FU >> octets);
  for (std::size_t i = 1; i < octets; ++i) {
    if ((octet(i) & 0xC0) != 0x80) return {replacement, 1};
    point = point << 6 | (octet(i) & 0x3FU);
  }
  return {point, octets};
}

/// The inside of a literal.
[[nodiscard]] std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const auto [point, octets] = code_point(text);
    text.remove_prefix(octets);
    if (point == '"' || point == '\\') result += fmt::format("\\{}", static_cast<char>(point));
    else if (point >= ' ' && point < 0x7F) result += static_cast<char>(point);
    else if (point < 0x80) result += fmt::format("\\x{:02x}", point);
    else if (point <= 0xFFFF) result += fmt::format("\\u{:04x}", point);
    else result += fmt::format("\\U{:08x}", point);
  }
  return result;
}

/// A sentence of a description on one line.
[[nodiscard]] std::string doc(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!blank) line += c;
    else if (!line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return escaped(line);
}

[[nodiscard]] std::string docstring(const std::string& indent, const std::vector<std::string>& paragraphs) {
  std::string text = indent + "\"\"\"";
  for (std::size_t i = 0; i < paragraphs.size(); ++i)
    text += (i == 0 ? "" : paragraphs[i].empty() ? "\n" : "\n" + indent) + paragraphs[i];
  return text + (paragraphs.size() > 1 ? "\n" + indent : "") + "\"\"\"\n";
}

template <class List, class Text>
[[nodiscard]] std::string joined(const List& list, std::string_view between, Text text) {
  std::string result;
  for (const auto& one : list) result += (result.empty() ? "" : std::string{between}) + text(one);
  return result;
}

[[nodiscard]] std::string pairs(const Texts& texts) {
  return "(" +
         joined(texts, " ",
                [](const auto& entry) { return fmt::format("({}, {}),", entry.value, python_string(entry.text)); }) +
         ")";
}

/// A value as runtime.Field knows it, from a descriptor or from a column.
struct Value {
  descriptor::Field field;
  std::optional<hirosco::Value> fallback;
  Texts texts;
  std::size_t offset{0};
  bool fixed{false};  ///< words with zeros behind, as parameters have them
};

[[nodiscard]] std::string python_value(const hirosco::Value& value) {
  const auto* words = std::get_if<std::string>(&value);
  return words != nullptr ? python_string(*words) : to_string(std::get<Number>(value));
}

[[nodiscard]] std::string field_call(const Value& value) {
  const auto& field = value.field;
  std::string text = fmt::format("_r.Field({}, \"{}\"", python_string(field.name), to_text(field.type));
  const auto add = [&](const char* name, const std::optional<Number>& number) {
    if (number && number->is_finite()) text += fmt::format(", {}={}", name, to_string(*number));
  };
  if (field.count != 1) text += fmt::format(", count={}", field.count);
  if (!field.unit.empty()) text += ", unit=" + python_string(field.unit);
  add("minimum", field.minimum);
  add("maximum", field.maximum);
  if (value.fallback) text += ", default=" + python_value(*value.fallback);
  if (field.type == Type::Text)
    text += fmt::format(", most={}{}", field.text_octets, value.fixed ? ", fixed=True" : "");
  if (!value.texts.empty()) text += ", texts=" + pairs(value.texts);
  if (field.text) text += ", words=True";
  if (value.offset != 0) text += fmt::format(", offset={}", value.offset);
  return text + ")";
}

[[nodiscard]] std::string fields_tuple(const std::vector<Value>& values) {
  return "(" + joined(values, " ", [](const Value& value) { return field_call(value) + ","; }) + ")";
}

/// A part of a standard service's report as runtime.Field knows it: numbers, times and words.
[[nodiscard]] std::string part_call(const pus::Part& part) {
  if (part.form != pus::Form::Number)
    return fmt::format("_r.Field({}, \"{}\")", python_string(part.name),
                       part.form == pus::Form::Time ? "TIME" : "WORD");
  Value value{.field = {}, .fallback = std::nullopt, .texts = {}};
  value.field.name = part.name;
  value.field.type = part.type;
  value.field.count = part.count;
  for (std::size_t i = 0; i < part.names.size(); ++i)
    value.texts.push_back({static_cast<std::uint32_t>(i), std::string{part.names[i]}});
  return field_call(value);
}

[[nodiscard]] std::string annotation(const Value& value) {
  const bool real = value.field.type == Type::Float || value.field.type == Type::Double;
  const Type type = value.field.type;
  if (type == Type::Text) return "str";
  std::string one = real ? "float" : type == Type::Bool ? "bool" : "int";
  if (!value.texts.empty() && value.texts.size() <= most_literals)
    one = "_t.Union[" + one + ", _t.Literal[" +
          joined(value.texts, ", ", [](const auto& entry) { return python_string(entry.text); }) + "]]";
  else if (!value.texts.empty()) one = "_t.Union[" + one + ", str]";
  return value.field.count == 1 ? one : "_t.Sequence[" + one + "]";
}

/// "2 x DOUBLE, rad, -2 to 2.6": what may be given, or what comes.
[[nodiscard]] std::string described(const Value& value) {
  const auto& field = value.field;
  std::string text = (field.count == 1 ? "" : fmt::format("{} x ", field.count)) + std::string{to_text(field.type)};
  if (!field.unit.empty()) text += ", " + doc(field.unit);
  if (field.type == Type::Text) text += fmt::format(", at most {} octets of UTF-8", field.text_octets);
  if (field.minimum && field.maximum)
    text += fmt::format(", {} to {}", to_string(*field.minimum), to_string(*field.maximum));
  else if (field.minimum) text += fmt::format(", from {}", to_string(*field.minimum));
  else if (field.maximum) text += fmt::format(", up to {}", to_string(*field.maximum));
  if (value.fallback) text += fmt::format(", {} if left out", doc(python_value(*value.fallback)));
  if (!value.texts.empty())
    text += ": " + joined(value.texts, ", ",
                          [](const auto& entry) { return fmt::format("{} {}", entry.value, doc(entry.text)); });
  return text;
}

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
    for (const pus::ServiceKind* service : pus::standard_services()) add_standard_reports(*service);
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
              "        ),\n        reports=(\n" + reports_ + "        ))\n";
    return result + methods_;
  }

 private:
  [[nodiscard]] Value value_of(const descriptor::Field& field) const {
    return {field, std::nullopt, catalogue_.texts_of(subsystem_, {}, field), 0, true};
  }

  void add_method(const std::string& signature, const std::vector<std::string>& says, const std::string& body) {
    methods_ += "\n    def " + signature + ":\n" + docstring("        ", says) + "        return " + body + "\n";
  }

  void add_function(const descriptor::Function& function) {
    PythonNames local{{"self", "wait"}};
    std::vector<Value> values;
    std::vector<std::string> says{doc(function.description.empty() ? function.name : function.description)};
    std::string parameters, given;
    bool optional = false;
    for (const auto& argument : function.arguments) {
      Value value{argument.field, argument.fallback, catalogue_.texts_of(subsystem_, function, argument), 0, false};
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
    functions_ += fmt::format("            _r.Function({}{}, arguments={}),\n", python_string(function.name), carried,
                              fields_tuple(values));
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
      for (const Value& column : columns_of(first)) says.push_back(doc(column.field.name) + ": " + described(column));
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
  [[nodiscard]] std::vector<Value> columns_of(const Report& report) const {
    std::vector<Value> values;
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
      Value value;
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
    std::vector<Value> values;
    for (descriptor::Field field : descriptor::fields_of(subsystem_, place)) {
      if (id.layout == Type::Struct && !way.empty()) field.name.erase(0, way.size());
      values.push_back(value_of(field));
    }
    const bool dictionary = id.layout == Type::Struct;
    add_get(place.text, id, values, dictionary);
    if (parameter.writable()) add_set(place.text, values, dictionary);
  }

  void add_get(const std::string& name, ParameterId id, const std::vector<Value>& values, bool dictionary) {
    parameters_ += fmt::format("            _r.Parameter({}, {:#x}, fields={}{}),\n", python_string(name), id.wire(),
                               fields_tuple(values), dictionary ? ", structure=True" : "");
    std::vector<std::string> says{"Asks for " + doc(name) + "."};
    if (dictionary) says.front() += " A dictionary:";
    says.emplace_back();
    for (const Value& value : values)
      says.push_back((dictionary ? doc(value.field.name) + ": " : "") + described(value));
    add_method(names_.variable("get_" + name) + "(self, wait: float = 10.0)", says,
               fmt::format("self._get({}, wait)", python_string(name)));
  }

  void add_set(const std::string& name, const std::vector<Value>& values, bool dictionary) {
    std::vector<std::string> says{
        "Sets " + doc(name) + (dictionary ? ", all of it at once. value, a dictionary:" : "."), ""};
    for (const Value& value : values)
      says.push_back((dictionary ? doc(value.field.name) : "value") + ": " + described(value));
    add_method(fmt::format("{}(self, value: {}, *, wait: _t.Optional[float] = 10.0) -> _r.Request",
                           names_.variable("set_" + name),
                           dictionary ? "_t.Mapping[str, _t.Any]" : annotation(values.front())),
               says, fmt::format("self._set({}, value, wait)", python_string(name)));
  }

  void add_event(const descriptor::Event& event) {
    std::vector<Value> values;
    for (const auto& argument : event.arguments) values.push_back(value_of(argument));
    events_ += fmt::format("            _r.EventKind({}, {}, arguments={}),\n", event.id, python_string(event.name),
                           fields_tuple(values));
  }

  /// They stand in the `reports` of the request that they answer.
  void add_own_reports(const descriptor::CustomService& service) {
    for (const auto& report : service.reports) {
      std::vector<Value> values;
      for (const auto& field : report.fields) values.push_back({field.field, std::nullopt, field.texts, 0, false});
      reports_ += fmt::format("            _r.ReportKind({}, {}, {}, fields={}),\n", service.type, report.subtype,
                              python_string(report.name), fields_tuple(values));
    }
  }

  /// Of a standard service that is asked by name.
  void add_standard_reports(const pus::ServiceKind& service) {
    const auto has_words = [](const pus::RequestKind& request) { return !request.words.empty(); };
    if (std::ranges::none_of(service.requests, has_words)) return;
    for (const pus::ReportKind& report : service.reports)
      reports_ += fmt::format("            _r.ReportKind({}, {}, {}, fields=({})),\n", service.type, report.subtype,
                              python_string(report.name),
                              joined(report.data, " ", [](const pus::Part& part) { return part_call(part) + ","; }));
  }

  const Catalogue& catalogue_;
  const descriptor::SubsystemDescriptor& subsystem_;
  PythonNames names_;
  std::string functions_, parameters_, layouts_, events_, reports_, methods_;
};

[[nodiscard]] std::string mission_about(const Catalogue& catalogue) {
  const auto& mission = catalogue.mission();
  const std::string& telemetry = mission.ground.telemetry;
  const auto colon = std::min(telemetry.rfind(':'), telemetry.size());
  std::uint16_t port = 0;
  if (colon < telemetry.size())
    std::from_chars(telemetry.data() + colon + 1, telemetry.data() + telemetry.size(), port);
  Texts modes, links, failures;
  for (const auto& mode : mission.modes) modes.push_back({mode.id, mode.name});
  for (const auto& link : mission.links) links.push_back({link.id, link.from + "." + link.provides + " to " + link.to});
  for (const auto& row : EnumTexts<pus::FailureCode>::table)
    failures.push_back({static_cast<std::int64_t>(row.value), std::string{row.text}});
  return fmt::format(
      "    _about = _r.MissionAbout(\n        name={}, host={}, port={}, supervisor={},\n        modes={},\n"
      "        links={},\n        failures={})\n",
      python_string(mission.name), python_string(telemetry.substr(0, colon)), port,
      python_string(mission.supervisor.name), pairs(modes), pairs(links), pairs(failures));
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
      "timeout: float = 5.0,\n                 instance: _t.Optional[str] = None, reconnect: bool = False) -> None:\n"
      "        super().__init__(host, port, timeout, instance, reconnect)\n";
  return text + made + "        self._subsystems = (" + all + ")\n        self._start()\n";
}

}  // namespace

std::string python_string(std::string_view text) { return "\"" + escaped(text) + "\""; }

std::string PythonNames::variable(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const bool good = is_letter(c) || is_digit(c);
    if (!good && (result.empty() || result.back() == '_')) continue;
    result += good ? lower(c) : '_';
  }
  while (!result.empty() && result.back() == '_') result.pop_back();
  if (result.empty() || is_digit(result.front())) result.insert(0, "n");
  return unique(std::move(result));
}

std::string PythonNames::type(std::string_view name) {
  std::string result;
  bool first = true;
  for (const char c : name) {
    const bool good = is_letter(c) || is_digit(c);
    if (good) result += first ? upper(c) : lower(c);
    first = !good;
  }
  if (result.empty() || is_digit(result.front())) result.insert(0, "N");
  return unique(std::move(result));
}

std::string PythonNames::unique(std::string name) {
  const auto is_free = [this](const std::string& wanted) {
    return std::ranges::find(keywords, wanted) == keywords.end() && !taken_.contains(wanted);
  };
  std::string wanted = name;
  for (int number = 2; !is_free(wanted); ++number) wanted = fmt::format("{}_{}", name, number);
  taken_.insert(wanted);
  return wanted;
}

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
