// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/python/python_services.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ground/clients/python/python_values.hpp"
#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco::ground {
namespace {

using pus::Form;
using pus::Part;
using pus::Shape;

[[nodiscard]] bool has(Shape shape, Form form) {
  return std::ranges::any_of(shape, [form](const Part& part) { return part.form == form; });
}

/// Whether somebody but the supervisor may ask, and has no other way to.
[[nodiscard]] bool is_asked_by_shape(const pus::ServiceKind& service, const pus::RequestKind& request) {
  return request.words.empty() && service.needs_of(request.subtype) != pus::Needs::SupervisorAsks &&
         !has(request.data, Form::Arguments);
}

[[nodiscard]] std::vector<const pus::RequestKind*> requests_by_shape(const pus::ServiceKind& service) {
  std::vector<const pus::RequestKind*> requests;
  for (const pus::RequestKind& request : service.requests)
    if (is_asked_by_shape(service, request)) requests.push_back(&request);
  return requests;
}

/// Verification, housekeeping and events, which the client knows by what a descriptor says of them.
[[nodiscard]] bool is_read_otherwise(const pus::ServiceKind& service, const pus::ReportKind& report) {
  constexpr std::uint8_t verification = 1, housekeeping = 3, events = 5;
  return service.type == verification ||
         ((service.type == housekeeping || service.type == events) && has(report.data, Form::Rest));
}

[[nodiscard]] PythonValue value_of(const Part& part) {
  PythonValue value{.field = {}, .fallback = std::nullopt, .texts = {}};
  value.field.name = part.name;
  value.field.type = part.type;
  value.field.count = part.count;
  if (part.form == Form::Text) {
    value.field.type = Type::Text;
    value.field.count = 1;
    value.field.text_octets = part.count;
    value.fixed = true;
  }
  for (std::size_t i = 0; i < part.names.size(); ++i)
    if (!part.names[i].empty()) value.texts.push_back({static_cast<std::int64_t>(i), std::string{part.names[i]}});
  return value;
}

/// What the ids are that stand in a shape: of the subsystem that is asked, which alone has names for them. Whom a question
/// to the supervisor is about stands in the question.
[[nodiscard]] std::string_view id_type(const pus::ServiceKind& service, const Part& part) {
  if (service.needs == pus::Needs::SupervisorAnswers || part.form != Form::Number) return {};
  if (part.name == "PARAMETER" && part.type == Type::Uint32) return "PARAMETER";
  return part.name == "EVENT" && part.type == Type::Uint16 ? "EVENT" : "";
}

/// As runtime.Part calls it; empty: it is a field.
[[nodiscard]] std::string_view part_type(const pus::ServiceKind& service, const Part& part) {
  switch (part.form) {
    case Form::Number: return id_type(service, part);
    case Form::Text: return {};
    case Form::Word: return "WORD";
    case Form::Time: return "TIME";
    case Form::List: return "LIST";
    case Form::Value: return "VALUE";
    case Form::Arguments:
    case Form::Rest: return "REST";
  }
  return "REST";
}

[[nodiscard]] std::string parts_tuple(const pus::ServiceKind& service, Shape shape) {
  const auto call = [&](const Part& part) {
    const std::string_view type = part_type(service, part);
    if (type.empty()) return field_call(value_of(part)) + ",";
    const std::string each = part.form == Form::List ? ", " + parts_tuple(service, part.repeated()) : "";
    return fmt::format("_r.Part({}, \"{}\"{}),", python_string(part.name), type, each);
  };
  return "(" + joined(shape, " ", call) + ")";
}

[[nodiscard]] std::string part_annotation(const pus::ServiceKind& service, const Part& part) {
  if (!id_type(service, part).empty()) return "_t.Union[int, str]";
  switch (part.form) {
    case Form::Number:
    case Form::Text: return annotation(value_of(part));
    case Form::Word: return "str";
    case Form::Time: return "float";
    case Form::List:
      return "_t.Sequence[" +
             (part.each_count == 1 ? part_annotation(service, part.repeated().front())
                                   : std::string{"_t.Mapping[str, _t.Any]"}) +
             "]";
    case Form::Value: return "_t.Any";
    case Form::Arguments:
    case Form::Rest: return "bytes";
  }
  return "bytes";
}

/// "a list of dictionaries with STRUCTURE (UINT16), INTERVAL (UINT32)"
[[nodiscard]] std::string part_described(const pus::ServiceKind& service, const Part& part) {
  if (!id_type(service, part).empty()) return "an id or its name";
  switch (part.form) {
    case Form::Number:
    case Form::Text: return described(value_of(part));
    case Form::Word: return "a text of at most 255 octets";
    case Form::Time: return "on board, seconds TAI since 1958";
    case Form::List: {
      const auto named = [&](const Part& one) {
        return std::string{one.name} + " (" + part_described(service, one) + ")";
      };
      if (part.each_count == 1) return "a list: each " + part_described(service, part.repeated().front());
      return "a list of dictionaries with " + joined(part.repeated(), ", ", named);
    }
    case Form::Value: return "as the parameter before it";
    case Form::Arguments:
    case Form::Rest: return "octets";
  }
  return "octets";
}

/// As the log calls it: no name of a descriptor looks like that.
[[nodiscard]] std::string called(const pus::ServiceKind& service, const pus::RequestKind& request) {
  return fmt::format("TC[{},{}] {}", service.type, request.subtype, request.name);
}

[[nodiscard]] bool goes_past(const pus::ServiceKind& service, const pus::RequestKind& request) {
  descriptor::Function asked;
  asked.service = service.type;
  asked.essential = service.needs_of(request.subtype) == pus::Needs::Essential;
  return pus::goes_alone(asked);
}

[[nodiscard]] bool offers(const descriptor::SubsystemDescriptor& subsystem, std::uint8_t type) {
  const auto in = [&](const descriptor::Configuration& each) { return subsystem.offers(type, &each); };
  return subsystem.offers(type, nullptr) || std::ranges::any_of(subsystem.configurations, in);
}

[[nodiscard]] std::string method_of(const pus::ServiceKind& service, const pus::RequestKind& request,
                                    PythonNames& names) {
  PythonNames local{{"self", "wait"}};
  std::string parameters, given;
  std::vector<std::string> says{fmt::format("{}, service of {}.", called(service, request), service.name)};
  for (const Part& part : request.data) {
    const std::string name = local.variable(part.name);
    parameters += fmt::format(", {}: {}", name, part_annotation(service, part));
    given += name + ", ";
    if (says.size() == 1) says.emplace_back();
    says.push_back(name + ": " + part_described(service, part));
  }
  return method(fmt::format("{}(self{}, *, wait: _t.Optional[float] = 70.0) -> _r.Request",
                            names.variable(request.name), parameters),
                says, fmt::format("self._ask({}, ({}), wait)", python_string(called(service, request)), given));
}

}  // namespace

std::string method(const std::string& signature, const std::vector<std::string>& says, const std::string& body) {
  return "\n    def " + signature + ":\n" + docstring("        ", says) + "        return " + body + "\n";
}

std::string service_tables() {
  std::string text = "\n# What the framework's services take and tell.\n";
  std::string told;
  for (const pus::ServiceKind* service : pus::standard_services()) {
    if (const auto requests = requests_by_shape(*service); !requests.empty()) {
      text += fmt::format("_st{} = (\n", service->type);
      for (const pus::RequestKind* request : requests)
        text += fmt::format("    _r.ServiceRequest({}, {}, {}, parts={}{}),\n",
                            python_string(called(*service, *request)), service->type, request->subtype,
                            parts_tuple(*service, request->data), goes_past(*service, *request) ? ", alone=True" : "");
      text += ")\n";
    }
    if (service->needs == pus::Needs::SupervisorAsks) continue;
    for (const pus::ReportKind& report : service->reports)
      if (!is_read_otherwise(*service, report))
        told += fmt::format("    _r.ReportKind({}, {}, {}, fields={}),\n", service->type, report.subtype,
                            python_string(report.name), parts_tuple(*service, report.data));
  }
  return text + "_told = (\n" + told + ")\n";
}

ServiceMethods service_methods(const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem,
                               PythonNames& names) {
  ServiceMethods made;
  for (const pus::ServiceKind* service : pus::standard_services()) {
    const bool here = service->needs != pus::Needs::SupervisorAnswers || &subsystem == &catalogue.mission().supervisor;
    const auto requests = requests_by_shape(*service);
    if (!here || requests.empty() || !offers(subsystem, service->type)) continue;
    made.tables += fmt::format("*_st{}, ", service->type);
    for (const pus::RequestKind* request : requests) made.methods += method_of(*service, *request, names);
  }
  return made;
}

}  // namespace hirosco::ground
