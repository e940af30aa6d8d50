// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/icd/icd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "hirosco/pus/packet/failure_code.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "hirosco/utilities/utf8.hpp"
#include "hirosco/utilities/version.hpp"

namespace hirosco::ground {
namespace {

using Texts = std::vector<descriptor::EnumerationText>;

/// A cell of a table: no character of it ends the cell or marks it up.
[[nodiscard]] std::string cell(std::string_view text) {
  std::string result, line{text};
  std::ranges::replace_if(line, [](char c) { return c == '\n' || c == '\t' || c == '\r'; }, ' ');
  for (const char c : printable_words(line)) {
    if (c == '|' || c == '\\' || c == '`' || c == '*' || c == '<' || c == '[') result += '\\';
    result += c;
  }
  return result.empty() ? " " : result;
}

/// A code span, whatever is in it.
[[nodiscard]] std::string code(std::string_view text) {
  std::string result = printable_words(text);
  std::ranges::replace(result, '`', '\'');
  std::ranges::replace(result, '|', '/');
  return "`" + result + "`";
}

[[nodiscard]] std::string type_text(const descriptor::Field& field) {
  if (field.text) return fmt::format("{} octets of ASCII, zeros behind", field.count);
  if (field.type == Type::Text) return fmt::format("TEXT, {} octets", field.text_octets);
  return (field.count == 1 ? "" : fmt::format("{} x ", field.count)) + std::string{to_text(field.type)};
}

[[nodiscard]] std::string range_text(const descriptor::Field& field) {
  if (field.minimum && field.maximum)
    return fmt::format("{} to {}", to_string(*field.minimum), to_string(*field.maximum));
  if (field.minimum) return "from " + to_string(*field.minimum);
  if (field.maximum) return "up to " + to_string(*field.maximum);
  return {};
}

[[nodiscard]] std::string names_text(const Texts& texts) {
  std::string result;
  for (const auto& entry : texts) result += fmt::format("{}{} {}", result.empty() ? "" : ", ", entry.value, entry.text);
  return result;
}

[[nodiscard]] std::string joined(const std::string& range, const std::string& names) {
  return range + (range.empty() || names.empty() ? "" : "; ") + names;
}

/// A table of values with the place of each in its packet.
class Table {
 public:
  Table(std::string& out, const char* place) : out_{out} {
    out_ += fmt::format("| {} | name | type | unit | range, names |\n|---|---|---|---|---|\n", place);
  }
  void row(const std::string& place, const std::string& name, const std::string& type, const std::string& unit,
           const std::string& more) {
    out_ += fmt::format("| {} | {} | {} | {} | {} |\n", place, code(name), cell(type), cell(unit), cell(more));
  }

 private:
  std::string& out_;
};

class SubsystemPart {
 public:
  SubsystemPart(std::string& out, const Catalogue& catalogue, const descriptor::SubsystemDescriptor& subsystem)
      : out_{out}, catalogue_{catalogue}, subsystem_{subsystem} {}

  void write() {
    out_ += fmt::format("\n## {}, APID {}\n\n{}\n", cell(subsystem_.name), subsystem_.id, cell(subsystem_.description));
    configurations();
    housekeeping();
    events();
    requests();
    parameters();
    own_reports();
    failures();
  }

 private:
  void configurations() {
    if (subsystem_.configurations.empty()) return;
    out_ += "\n### Configurations\n\n| id | name | cycle |\n|---|---|---|\n";
    for (const auto& one : subsystem_.configurations)
      out_ += fmt::format("| {} | {} | {} us |\n", one.id, code(one.name), one.sampling.count() / 1000);
  }

  void housekeeping() {
    structures("every configuration", subsystem_.housekeeping, nullptr);
    for (const auto& configuration : subsystem_.configurations)
      structures(configuration.name, configuration.housekeeping, &configuration);
  }

  void structures(const std::string& where, const std::vector<descriptor::HousekeepingStructure>& all,
                  const descriptor::Configuration* configuration) {
    for (const auto& structure : all) {
      std::string text;
      Table table{text, "octet"};
      std::size_t octet = 20 + sizeof structure.id;
      const auto add = [&](const descriptor::ParameterRef& reference, const std::string& sample) {
        const auto& parameter = subsystem_.parameters[reference.parameter];
        const bool whole = !reference.member && !parameter.members.empty();
        for (const auto& field : descriptor::fields_of(subsystem_, reference)) {
          const std::string name = whole || reference.member ? parameter.field.name + "." + field.name : field.name;
          table.row(std::to_string(octet), name + sample, type_text(field), field.unit, more(field));
          octet += field.octets();
        }
      };
      for (const auto& reference : structure.sampled_once) add(reference, "");
      for (const auto& set : structure.sampled_repeatedly)
        for (std::uint16_t i = 0; i < set.repetitions; ++i)
          for (const auto& reference : set.parameters) add(reference, fmt::format(" sample {}", i + 1));
      // The same in many configurations is said once.
      if (!said_.insert(std::to_string(structure.id) + text).second) continue;
      const Duration cycle = configuration != nullptr            ? configuration->sampling
                             : subsystem_.configurations.empty() ? Duration{0}
                                                                 : subsystem_.configurations.front().sampling;
      out_ += fmt::format("\n### TM[3,25] structure {}\n\n{}: every {:g} s, {} octets in all{}.\n\n{}", structure.id,
                          code(where), seconds(cycle * static_cast<int>(structure.interval_cycles)), octet + 2,
                          structure.enabled ? "" : ", when it was asked for", text);
    }
  }

  void events() {
    if (subsystem_.events.empty()) return;
    out_ +=
        "\n### Events, TM[5,1] to TM[5,4]\n\nEvent id at octet 20, arguments from octet 22 on.\n\n"
        "| id | event | severity | arguments |\n|---|---|---|---|\n";
    for (const auto& event : subsystem_.events) {
      std::string arguments;
      for (const auto& argument : event.arguments)
        arguments += fmt::format("{}{} {}{}", arguments.empty() ? "" : ", ", argument.name, type_text(argument),
                                 argument.unit.empty() ? "" : " " + argument.unit);
      out_ += fmt::format("| {} | {} | {}{} | {} |\n", event.id, code(event.name), to_text(event.severity),
                          event.safety ? ", never off" : "", cell(arguments));
    }
  }

  void requests() {
    out_ += "\n### Requests by name\n";
    for (const auto& function : catalogue_.functions_of(subsystem_)) {
      const bool call = function.service == pus::FunctionService::service_type;
      std::string states;
      for (const auto& row : EnumTexts<descriptor::State>::table)
        if (function.permitted_in(row.value)) states += (states.empty() ? "" : ", ") + std::string{row.text};
      out_ += fmt::format("\n#### {}, TC[{},{}]\n\n{}{}Permitted in: {}.{}\n", cell(function.name), function.service,
                          function.subtype, cell(function.description), function.description.empty() ? "" : ". ",
                          states, function.essential ? " Essential: forwarded before it is logged." : "");
      if (function.arguments.empty()) continue;
      out_ += call ? fmt::format(
                         "\nThe name in octets 11 to 26, the number of arguments ({}) in octet 27, in front of each "
                         "its id.\n\n",
                         function.arguments.size())
                   : std::string{"\nFrom octet 11 on, in this order.\n\n"};
      Table table{out_, call ? "id" : "order"};
      unsigned number = 0;
      for (const auto& argument : function.arguments) {
        const std::string given = argument.fallback ? "; left out: " + value_text(*argument.fallback) : "";
        std::string type = type_text(argument.field);
        if (argument.field.type == Type::Text)
          type = fmt::format("TEXT, length u16, at most {} octets", argument.field.text_octets);
        table.row(std::to_string(++number), argument.field.name, type, argument.field.unit,
                  joined(range_text(argument.field), names_text(catalogue_.texts_of(subsystem_, function, argument))) +
                      given);
      }
    }
  }

  void parameters() {
    if (subsystem_.parameters.empty()) return;
    out_ += "\n### Parameters, service 20\n\n";
    Table table{out_, "id on the wire"};
    const auto add = [&](const std::string& name, const descriptor::Field& field, std::uint8_t id, bool writable) {
      const ParameterId wire{subsystem_.id, field.type, id};
      table.row(fmt::format("{:#x}", wire.wire()), name, type_text(field), field.unit,
                more(field) + (writable ? "; may be set" : ""));
    };
    for (const auto& parameter : subsystem_.parameters) {
      const std::string& name = parameter.field.name;
      add(name, parameter.field, parameter.id, parameter.writable() && parameter.members.empty());
      for (const auto& member : parameter.members)
        add(name + "." + member.field.name, member.field, member.id, parameter.writable());
      for (const auto& part : parameter.parts) {
        descriptor::Field whole;
        whole.type = Type::Struct;
        add(name + "." + part.name, whole, part.id, false);
      }
    }
  }

  void own_reports() {
    for (const auto& service : subsystem_.services)
      for (const auto& report : service.reports) {
        out_ += fmt::format("\n### {}, TM[{},{}]\n\n", cell(report.name), service.type, report.subtype);
        Table table{out_, "order"};
        unsigned number = 0;
        for (const auto& field : report.fields)
          table.row(std::to_string(++number), field.field.name, type_text(field.field), field.field.unit,
                    names_text(field.texts));
      }
  }

  void failures() {
    if (subsystem_.failures.empty()) return;
    out_ += "\n### Failure codes of its own\n\n| code | name |\n|---|---|\n";
    for (const auto& failure : subsystem_.failures)
      out_ += fmt::format("| {:#06x} | {} |\n", failure.code, code(failure.name));
  }

  [[nodiscard]] std::string more(const descriptor::Field& field) const {
    return joined(range_text(field), names_text(catalogue_.texts_of(subsystem_, {}, field)));
  }
  [[nodiscard]] static std::string value_text(const Value& value) {
    const auto* words = std::get_if<std::string>(&value);
    return words != nullptr ? *words : to_string(std::get<Number>(value));
  }

  std::string& out_;
  const Catalogue& catalogue_;
  const descriptor::SubsystemDescriptor& subsystem_;
  std::set<std::string> said_;
};

/// "COUNT u8, then so many times (PARAMETER UINT32)".
[[nodiscard]] std::string shape_text(pus::Shape shape) {
  std::string result;
  for (const pus::Part& part : shape) {
    result += result.empty() ? "" : ", ";
    const std::string name{part.name};
    switch (part.form) {
      case pus::Form::Number:
        result +=
            fmt::format("{} {}{}", name, part.count == 1 ? "" : fmt::format("{} x ", part.count), to_text(part.type));
        break;
      case pus::Form::Text: result += fmt::format("{} {} octets of ASCII", name, part.count); break;
      case pus::Form::Word: result += name + " length u8 and words"; break;
      case pus::Form::Time: result += name + " on-board time"; break;
      case pus::Form::List:
        result += fmt::format("number of {} u8, each: ({})", name, shape_text(part.repeated()));
        break;
      case pus::Form::Value: result += name + " as the parameter's type"; break;
      case pus::Form::Arguments: result += "number of arguments u8, each: (id u8, value)"; break;
      case pus::Form::Rest: result += name + ", all that is left"; break;
    }
  }
  return result.empty() ? "none" : result;
}

void write_services(std::string& out) {
  out +=
      "\n## Services of the framework\n\nData of a request from octet 11 on, of a report from octet 20 on.\n\n"
      "| packet | name | data |\n|---|---|---|\n";
  for (const pus::ServiceKind* service : pus::standard_services()) {
    for (const auto& request : service->requests)
      out += fmt::format("| TC[{},{}] | {} | {} |\n", service->type, request.subtype, request.name,
                         shape_text(request.data));
    for (const auto& report : service->reports)
      out +=
          fmt::format("| TM[{},{}] | {} | {} |\n", service->type, report.subtype, report.name, shape_text(report.data));
  }
}

constexpr std::string_view packets = R"(
## Packets

CCSDS space packets with the secondary header of PUS-C (ECSS-E-ST-70-41C). Numbers have the most significant octet first. The last two
octets are a CRC-16 of all before them: polynomial 0x1021, preset 0xFFFF.

| octet | telemetry | telecommand |
|---|---|---|
| 0, 1 | version 0 (3 bits), type 0, secondary header 1, APID (11 bits) | the same with type 1 |
| 2, 3 | sequence flags 3 (2 bits), sequence count (14 bits) | the same |
| 4, 5 | octets from 6 on, less one | the same |
| 6 | PUS version 2 (4 bits), time status (4 bits) | PUS version 2 (4 bits), reports wanted: 8 completion, 4 progress, 2 start, 1 acceptance |
| 7, 8 | service, subtype | service, subtype |
| 9, 10 | message counter | source id; reports carry it as destination |
| 11, 12 | destination: source id of whoever asked | data |
| 13 to 19 | on-board time: seconds (4), fractions (3) of TAI since 1958-01-01 | |
| 20 on | data | |
)";

}  // namespace

std::string interface_document(const Catalogue& catalogue) {
  const auto& mission = catalogue.mission();
  std::string out = fmt::format(
      "<!-- SPDX-FileCopyrightText: 2026 The HIROSCO developers -->\n<!-- SPDX-License-Identifier: Apache-2.0 -->\n"
      "# Interface document of {}\n\nFrom the mission's descriptors, by `hirosco export icd` of hirosco {}: export it "
      "again rather than "
      "change it.\n\nTelemetry and telecommands are exchanged by TCP at {}; {} takes telecommands alone. A packet has "
      "at most {} octets.\n",
      cell(mission.name), version, code(mission.ground.telemetry), code(mission.ground.telecommand),
      pus::max_telemetry_octets);
  out += packets;
  out += "\n## Modes\n\n| id | mode |\n|---|---|\n";
  for (const auto& mode : mission.modes) out += fmt::format("| {} | {} |\n", mode.id, code(mode.name));
  for (const auto* subsystem : catalogue.subsystems()) SubsystemPart{out, catalogue, *subsystem}.write();
  write_services(out);
  out +=
      "\n## Failure codes\n\nBehind the request's own first four octets (and the step, of TM[1,6]) in TM[1,2], 4, 6, 8 "
      "and 10.\n\n"
      "| code | name |\n|---|---|\n";
  for (const auto& row : EnumTexts<pus::FailureCode>::table)
    out += fmt::format("| {:#06x} | {} |\n", static_cast<unsigned>(row.value), row.text);
  return out;
}

}  // namespace hirosco::ground
