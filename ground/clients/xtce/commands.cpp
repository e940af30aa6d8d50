// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/clients/xtce/commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "ground/clients/xtce/service_reports.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/pus/standard_services.hpp"

namespace hirosco::ground {
namespace {

using Texts = std::vector<descriptor::EnumerationText>;

/// A telecommand is over within 70 s (`hirosco tc`), or its end is not told any more.
constexpr const char* longest_command = "PT80S";
constexpr const char* longest_acceptance = "PT25S";  ///< a disk may hold a telecommand back for 20 s
const std::set<std::string> header_arguments{"apid", "ack", "service", "subtype", "source"};

[[nodiscard]] Element fixed(std::string_view name, const std::string& hex) {
  return {"FixedValueEntry",
          {{"name", std::string{name}}, {"binaryValue", hex}, {"sizeInBits", std::to_string(4 * hex.size())}}};
}
[[nodiscard]] Element fixed_bits(std::string_view name, const char* hex, unsigned bits) {
  return {"FixedValueEntry", {{"name", std::string{name}}, {"binaryValue", hex}, {"sizeInBits", std::to_string(bits)}}};
}
[[nodiscard]] Element argument_entry(const std::string& name) { return {"ArgumentRefEntry", {{"argumentRef", name}}}; }

[[nodiscard]] Element assignments(const std::vector<std::pair<std::string, unsigned>>& values) {
  Element list{"ArgumentAssignmentList"};
  for (const auto& [name, value] : values)
    list.children.push_back({"ArgumentAssignment", {{"argumentName", name}, {"argumentValue", std::to_string(value)}}});
  return list;
}

/// One stage of service 1 as Yamcs' own algorithm judges it. The order of its first five inputs is that algorithm's.
class Verifiers {
 public:
  Verifiers(const PacketRoot& root, std::string failure) : root_{root}, failure_{std::move(failure)} {}

  [[nodiscard]] Element stage(const char* tag, const char* name, unsigned stage, const char* window,
                              bool ends = false) const {
    Element inputs{"InputSet"};
    const auto add = [&](const char* input, const std::string& parameter) {
      inputs.children.push_back({"InputParameterInstanceRef", {{"parameterRef", parameter}, {"inputName", input}}});
    };
    add("sentApid", "/yamcs/cmd/arg/apid");
    add("sentSeq", "/yamcs/cmdHist/ccsds-seqcount");
    add("rcvdApid", root_.verified_apid);
    add("rcvdSeq", root_.verified_count);
    add("reportSubtype", root_.verified_subtype);
    add("code", failure_);
    Element algorithm{
        "CustomAlgorithm",
        {{"name", fmt::format("stage_{}", stage)}},
        {{.name = "AlgorithmText",
          .attributes = {{"language", "Java"}},
          .text = fmt::format("org.yamcs.pus.Pus1Verifier({{stage: {}, template: \"{{code}}\"}})", stage)},
         std::move(inputs)}};
    Element verifier{tag, {{"name", name}}};
    if (ends)
      verifier.children.push_back(
          {"AncillaryDataSet",
           {},
           {{.name = "AncillaryData", .attributes = {{"name", "yamcs.onTimeout"}}, .text = "FAIL"}}});
    verifier.children.push_back(std::move(algorithm));
    verifier.children.push_back(
        {"CheckWindow", {{"timeToStopChecking", window}, {"timeWindowIsRelativeTo", "commandRelease"}}});
    return verifier;
  }

 private:
  const PacketRoot& root_;
  std::string failure_;
};

/// Arguments and entries of one command while it is put together.
struct Layout {
  XtceNames names{header_arguments};
  std::vector<Element> arguments, entries;

  /// `given`: its value where none is given; empty = one has to be.
  std::string add(std::string_view name, const std::string& type, const std::string& given = {}) {
    const std::string free = names.unique(name);
    Element argument{"Argument", {{"name", free}, {"argumentTypeRef", type}}};
    if (!given.empty()) argument.attributes.emplace_back("initialValue", given);
    arguments.push_back(std::move(argument));
    entries.push_back(argument_entry(free));
    return free;
  }
};

[[nodiscard]] std::string name_of(const Value& value, const Texts& texts) {
  for (const auto& entry : texts)
    if (value == Value{Number{entry.value}}) return entry.text;
  const auto* words = std::get_if<std::string>(&value);
  return words != nullptr ? *words : to_string(std::get<Number>(value));
}

class Commands {
 public:
  Commands(SpaceSystem& system, TypeSet& types, const PacketRoot& root, const Catalogue& catalogue,
           const descriptor::SubsystemDescriptor& subsystem, const std::string& telecommand, const std::string& failure)
      : system_{system}, types_{types}, catalogue_{catalogue}, subsystem_{subsystem}, verifiers_{root, failure} {
    Element base{"MetaCommand", {{"abstract", "true"}}};
    base.children.push_back(
        {"BaseMetaCommand", {{"metaCommandRef", telecommand}}, {assignments({{"apid", subsystem.id}})}});
    const std::string name = system_.free_command_name("telecommand");
    base.children.push_back(
        {"CommandContainer", {{"name", name}}, {{"EntryList"}, {"BaseContainer", {{"containerRef", telecommand}}}}});
    base.children.push_back(
        {"VerifierSet", {}, {verifiers_.stage("AcceptedVerifier", "Accepted", 1, longest_acceptance)}});
    base_ = system_.add_command(name, std::move(base));
  }

  void add_functions() {
    for (const auto& function : catalogue_.functions_of(subsystem_)) {
      Layout layout;
      const bool call = function.service == pus::FunctionService::service_type;
      if (call) {
        std::string hex;
        for (const char c : function.name) hex += fmt::format("{:02X}", static_cast<unsigned char>(c));
        hex.resize(2 * pus::function_name_octets, '0');
        layout.entries.push_back(fixed("function", hex));
        layout.entries.push_back(fixed("number_of_arguments", fmt::format("{:02X}", function.arguments.size())));
      }
      unsigned number = 0;
      for (const auto& argument : function.arguments) {
        if (call) layout.entries.push_back(fixed("argument_id", fmt::format("{:02X}", ++number)));
        add_argument(layout, function, argument);
      }
      add(function.name, says_of(function), function.service, function.subtype, std::move(layout), call);
    }
  }

  /// What the framework's services are asked by numbers, not by name.
  void add_service_requests() {
    const bool supervisor = &subsystem_ == &catalogue_.mission().supervisor;
    for (const pus::ServiceKind* service : pus::standard_services()) {
      const bool answers = service->needs != pus::Needs::SupervisorAnswers || supervisor;
      if (!answers || !subsystem_.offers(service->type, nullptr)) continue;
      for (const pus::RequestKind& request : service->requests) {
        const bool by_name = !request.words.empty();
        if (by_name || service->needs_of(request.subtype) == pus::Needs::SupervisorAsks) continue;
        Layout layout;
        if (!add_parts(layout, *service, request.data, false)) continue;
        add(std::string{request.name},
            fmt::format("TC[{},{}], service of {}", service->type, request.subtype, service->name), service->type,
            request.subtype, std::move(layout), false);
      }
    }
  }

  void add_writes() {
    if (!subsystem_.offers(pus::ParameterService::service_type, nullptr)) return;
    for (const auto& parameter : subsystem_.parameters) {
      if (!parameter.writable()) continue;
      if (parameter.members.empty()) add_write(parameter.field.name, parameter.field, parameter.id);
      for (const auto& member : parameter.members)
        add_write(parameter.field.name + "_" + member.field.name, member.field, member.id);
    }
  }

  [[nodiscard]] CommandPaths paths() && { return std::move(paths_); }

 private:
  [[nodiscard]] std::string says_of(const descriptor::Function& function) const {
    std::string states;
    for (const auto& row : EnumTexts<descriptor::State>::table)
      if (function.permitted_in(row.value)) states += (states.empty() ? "" : ", ") + std::string{row.text};
    return function.description + (function.description.empty() ? "" : ". ") + "Permitted in: " + states;
  }

  void add_argument(Layout& layout, const descriptor::Function& function,
                    const descriptor::Function::Argument& argument) {
    constexpr unsigned length_bits = 16;
    const auto& field = argument.field;
    const Texts texts = catalogue_.texts_of(subsystem_, function, argument);
    std::string given;
    if (argument.fallback) {
      given = name_of(*argument.fallback, texts);
      if (field.values() != 1) {
        std::string list;
        for (std::uint32_t i = 0; i < field.values(); ++i) list += (i == 0 ? "" : ", ") + given;
        given = "[" + list + "]";
      }
    }
    const std::string type = field.type == Type::Text ? types_.words_behind_length(length_bits, field.text_octets)
                                                      : types_.value(kind_of(field, texts));
    layout.add(field.name, type, given);
  }

  void add_write(const std::string& name, const descriptor::Field& field, std::uint8_t id) {
    Layout layout;
    layout.entries.push_back(fixed("number_of_parameters", "01"));
    layout.entries.push_back(
        fixed("parameter", fmt::format("{:08X}", ParameterId{subsystem_.id, field.type, id}.wire())));
    layout.add("VALUE", types_.value(kind_of(field, catalogue_.texts_of(subsystem_, {}, field))));
    add("WRITE_" + name, "Sets the parameter by service 20", pus::ParameterService::service_type,
        pus::ParameterService::set_values, std::move(layout), false);
  }

  /// False: its form is not one that a database can say.
  [[nodiscard]] bool add_parts(Layout& layout, const pus::ServiceKind& service, pus::Shape shape, bool in_list) {
    constexpr unsigned length_bits = 8;
    constexpr std::uint32_t most_words = 255;
    using pus::Form;
    for (const pus::Part& part : shape) switch (part.form) {
        case Form::Number: layout.add(part.name, types_.value(named(service, part))); break;
        case Form::Time: layout.add(part.name, types_.time()); break;
        case Form::Text: layout.add(part.name, types_.value({.type = Type::Text, .text_octets = part.count})); break;
        case Form::Word: layout.add(part.name, types_.words_behind_length(length_bits, most_words)); break;
        case Form::List:
          if (!add_list(layout, service, part, in_list)) return false;
          break;
        case Form::Value:
        case Form::Arguments:
        case Form::Rest: return false;
      }
    return true;
  }

  /// Of single numbers: how many, and they. Of others one, or none where lists stand in a list.
  [[nodiscard]] bool add_list(Layout& layout, const pus::ServiceKind& service, const pus::Part& part, bool in_list) {
    const auto each = part.repeated();
    const bool of_numbers = each.size() == 1 && each.front().form == pus::Form::Number && each.front().count == 1;
    if (of_numbers && !in_list) {
      const std::string count = layout.add(fmt::format("NUMBER_OF_{}", part.name), types_.bits(8));
      layout.add(part.name, types_.list_by(count, types_.value(named(service, each.front()))));
      return true;
    }
    const bool nested = std::ranges::any_of(each, [](const pus::Part& one) { return one.form == pus::Form::List; });
    layout.entries.push_back(fixed(fmt::format("number_of_{}", part.name), nested || in_list ? "00" : "01"));
    return nested || in_list || add_parts(layout, service, each, true);
  }

  /// Its values by the names that they have in this subsystem. Whom a question to the supervisor is about stands in the question: what its
  /// numbers are called nobody knows before.
  [[nodiscard]] ValueKind named(const pus::ServiceKind& service, const pus::Part& part) const {
    ValueKind kind = kind_of(part);
    if (part.name == "SUBSYSTEM" && part.type == Type::Uint16)
      for (const auto* each : catalogue_.mission().everybody()) kind.texts.push_back({each->id, each->name});
    if (service.needs == pus::Needs::SupervisorAnswers) return kind;
    if (part.name == "PARAMETER" && part.type == Type::Uint32) kind.texts = parameter_ids();
    if (part.name == "EVENT" && part.type == Type::Uint16)
      for (const auto& event : subsystem_.events) kind.texts.push_back({event.id, event.name});
    return kind;
  }

  [[nodiscard]] Texts parameter_ids() const {
    Texts ids;
    const auto add = [&](const std::string& name, Type type, std::uint8_t id) {
      ids.push_back({ParameterId{subsystem_.id, type, id}.wire(), name});
    };
    for (const auto& parameter : subsystem_.parameters) {
      add(parameter.field.name, parameter.field.type, parameter.id);
      for (const auto& member : parameter.members)
        add(parameter.field.name + "." + member.field.name, member.field.type, member.id);
      for (const auto& part : parameter.parts) add(parameter.field.name + "." + part.name, Type::Struct, part.id);
    }
    return ids;
  }

  void add(const std::string& wanted, const std::string& says, unsigned service, unsigned subtype, Layout layout,
           bool may_progress) {
    const std::string name = system_.free_command_name(wanted);
    Element command{"MetaCommand"};
    command.children.push_back({.name = "LongDescription", .text = says});
    command.children.push_back(
        {"BaseMetaCommand", {{"metaCommandRef", base_}}, {assignments({{"service", service}, {"subtype", subtype}})}});
    if (!layout.arguments.empty()) command.children.push_back({"ArgumentList", {}, std::move(layout.arguments)});
    command.children.push_back(
        {"CommandContainer",
         {{"name", name}},
         {{"EntryList", {}, std::move(layout.entries)}, {"BaseContainer", {{"containerRef", base_}}}}});
    Element set{"VerifierSet"};
    set.children.push_back(verifiers_.stage("ExecutionVerifier", "Started", 3, longest_command));
    // Of those that report none it is called off when the command completes.
    if (may_progress) set.children.push_back(verifiers_.stage("ExecutionVerifier", "Progress", 5, longest_command));
    set.children.push_back(verifiers_.stage("CompleteVerifier", "Complete", 7, longest_command, true));
    command.children.push_back(std::move(set));
    paths_.emplace(wanted, system_.add_command(name, std::move(command)));
  }

  SpaceSystem& system_;
  TypeSet& types_;
  const Catalogue& catalogue_;
  const descriptor::SubsystemDescriptor& subsystem_;
  Verifiers verifiers_;
  std::string base_;
  CommandPaths paths_;
};

}  // namespace

std::string add_telecommand(SpaceSystem& system, TypeSet& types) {
  Element command{"MetaCommand", {{"abstract", "true"}}};
  Layout layout;
  layout.names = {};
  auto& entries = layout.entries;
  entries.push_back(fixed_bits("version", "00", 3));
  entries.push_back(fixed_bits("type", "01", 1));
  entries.push_back(fixed_bits("secondary_header", "01", 1));
  (void)layout.add("apid", types.bits(11));
  entries.push_back(fixed_bits("sequence_flags", "03", 2));
  // Count, length and, behind it all, the CRC are filled in by whoever sends.
  entries.push_back(fixed_bits("sequence_count", "0000", 14));
  entries.push_back(fixed_bits("packet_length", "0000", 16));
  entries.push_back(fixed_bits("pus_version", "02", 4));
  (void)layout.add("ack", types.bits(4), std::to_string(pus::ack_all));
  (void)layout.add("service", types.bits(8));
  (void)layout.add("subtype", types.bits(8));
  (void)layout.add("source", types.bits(16), std::to_string(exported_source));
  command.children.push_back({"ArgumentList", {}, std::move(layout.arguments)});
  const std::string name = system.free_command_name("telecommand");
  command.children.push_back({"CommandContainer", {{"name", name}}, {{"EntryList", {}, std::move(entries)}}});
  return system.add_command(name, std::move(command));
}

CommandPaths add_commands(SpaceSystem& system, TypeSet& types, const PacketRoot& root, const Catalogue& catalogue,
                          const descriptor::SubsystemDescriptor& subsystem, const std::string& telecommand,
                          const std::string& failure) {
  Commands commands{system, types, root, catalogue, subsystem, telecommand, failure};
  commands.add_functions();
  commands.add_service_requests();
  commands.add_writes();
  return std::move(commands).paths();
}

}  // namespace hirosco::ground
