// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/words/describe.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <optional>
#include <vector>

#include "hirosco/parameter/number.hpp"
#include "hirosco/parameter/text.hpp"
#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/standard_services.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::pus {
namespace {

[[nodiscard]] std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// No double has all its numbers.
[[nodiscard]] bool is_wide(Type type) noexcept { return type == Type::Uint64 || type == Type::Int64; }

/// "value,value", an enumeration and a switch by their words, a text in quotes.
void append_values(std::string& text, const descriptor::SubsystemDescriptor& subsystem, const descriptor::Field& field,
                   OctetReader& reader) {
  if (field.text) {
    const std::string words = text_of(reader.get(field.octets()));
    text.append("'").append(words).append("'");
    return;
  }
  if (field.type == Type::Text) {
    text.append("'").append(printable_words(fixed_words(reader.get(field.octets())))).append("'");
    return;
  }
  for (std::uint32_t i = 0; i < field.count; ++i) {
    const Number value = read_number(reader, field.type);
    if (i != 0) text.append(",");
    if (field.type == Type::Bool) {
      text.append(switch_word(value != Number{0}));
      continue;
    }
    const auto enumeration =
        std::ranges::find(subsystem.enumerations, field.enumeration, &descriptor::Enumeration::name);
    if (!field.enumeration.empty() && enumeration != subsystem.enumerations.end()) {
      const auto named =
          std::ranges::find_if(enumeration->texts, [&](const auto& entry) { return Number{entry.value} == value; });
      if (named != enumeration->texts.end()) {
        text.append(named->text);
        continue;
      }
    }
    text.append(is_wide(field.type) ? to_string(value) : number_text(value.real()));
  }
}

/// "NAME=value unit"
void append_field(std::string& text, const descriptor::SubsystemDescriptor& subsystem, const descriptor::Field& field,
                  OctetReader& reader) {
  text.append(" ").append(field.name).append("=");
  append_values(text, subsystem, field, reader);
  if (!field.unit.empty()) text.append(" ").append(field.unit);
}

[[nodiscard]] std::string kind_text(const char* direction, std::uint8_t service, std::uint8_t subtype) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "%s[%u,%u] ", direction, service, subtype);
  return text.data();
}

enum class Units : std::uint8_t { No, Yes };
/// " NAME=value,value unit NAME=value", as far as the octets go.
[[nodiscard]] std::string values_text(ArgumentList declared, ArgumentReader& reader, Units units) {
  std::string text;
  for (const Argument& argument : declared) {
    std::string values;
    for (std::size_t i = 0; i < value_count(argument); ++i) {
      const Value value =
          argument.field.type == Type::Text ? Value{std::string{reader.text()}} : Value{reader.number()};
      if (!reader.good()) return text.append(" ").append(argument.field.name).append("=?");
      values.append(i == 0 ? "" : ",").append(value_text(argument, value));
    }
    text.append(" ").append(argument.field.name).append("=").append(values);
    if (units == Units::Yes && !argument.field.unit.empty()) text.append(" ").append(argument.field.unit);
  }
  return text;
}
[[nodiscard]] std::string values_text(ArgumentList declared, Octets data) {
  ArgumentReader reader{declared, data};
  return values_text(declared, reader, Units::Yes);
}

/// " SET_STATE STATE=Operational" of the data of TC[8,1].
[[nodiscard]] std::string call_text(const descriptor::SubsystemDescriptor& subsystem, Octets data) {
  const auto common = common_functions();
  const auto call = decode_call(subsystem.functions, data, common);
  std::string text;
  if (!call) return text.append(" (").append(to_text(call.error().notice.code())).append(")");
  const bool built_in = call->function >= first_built_in_function;
  const auto& function =
      built_in ? common[call->function - first_built_in_function] : subsystem.functions[call->function];
  text.append(" ").append(function.name);
  ArgumentReader reader{function.arguments, call->arguments};
  if (function.name != "SET_STATE") return text.append(values_text(function.arguments, reader, Units::No));
  return text.append(" STATE=").append(to_text(static_cast<descriptor::State>(reader.number().as<int>().value_or(0))));
}

/// A parameter by its id on the wire, a member by its structure's name and its own.
struct Known {
  std::string name;
  std::vector<descriptor::Field> fields;
};
[[nodiscard]] std::optional<Known> parameter_of(const descriptor::SubsystemDescriptor& subsystem, std::uint32_t wire) {
  const auto found = descriptor::find_parameter(subsystem, wire);
  return found ? std::optional{Known{found->text, descriptor::fields_of(subsystem, *found)}} : std::nullopt;
}

/// Seconds since the epoch, to the millisecond.
[[nodiscard]] std::string time_text(Octets code) {
  if (code.size() < cuc_octets) return "?";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3f s",
                std::chrono::duration<double>(from_cuc(code).time_since_epoch()).count());
  return text.data();
}

/// The data of a standard service by their shape (service/service_kind.hpp).
class ShapeWords {
 public:
  ShapeWords(const descriptor::Mission& mission, const descriptor::SubsystemDescriptor& subsystem, OctetReader& reader)
      : mission_{mission}, subsystem_{subsystem}, about_{&subsystem}, reader_{reader} {}
  /// " STRUCTURES=4711,4712"
  [[nodiscard]] std::string parts(Shape shape) {
    std::string text;
    for (const Part& part : shape) {
      if (!reader_.good()) break;
      const std::string words = value(part);
      if (!words.empty()) text.append(" ").append(part.name).append("=").append(words);
    }
    return text;
  }

 private:
  [[nodiscard]] std::string value(const Part& part) {
    switch (part.form) {
      case Form::Number: return number_of(part);
      case Form::Text: return "'" + text_of(reader_.get(part.count)) + "'";
      case Form::Word: return "'" + text_of(reader_.get(reader_.get<std::uint8_t>())) + "'";
      case Form::Time: return time_text(reader_.get(cuc_octets));
      case Form::List: return list_of(part);
      case Form::Value: return value_of_last();
      case Form::Arguments:
      case Form::Rest: return {};
    }
    return {};
  }
  [[nodiscard]] std::string number_of(const Part& part) {
    std::string text;
    for (std::uint16_t i = 0; i < part.count; ++i) {
      const double number = get_number(reader_, part.type);
      if (i != 0) text.append(",");
      if (part.name == "PARAMETER") {
        last_ = parameter_of(subsystem_, static_cast<std::uint32_t>(number));
        text.append(last_ ? last_->name : number_text(number));
      } else if (part.name == "SUBSYSTEM") {
        about_ = mission_.find_member(static_cast<std::uint16_t>(number));
        text.append(about_ != nullptr ? about_->name : number_text(number));
      } else if (part.name == "EVENT") {
        const auto* event = event_of(static_cast<std::uint16_t>(number));
        text.append(event != nullptr ? event->name : number_text(number));
      } else {
        const bool named = number >= 0 && number < static_cast<double>(part.names.size());
        text.append(named ? part.names[static_cast<std::size_t>(number)] : number_text(number));
      }
    }
    return text;
  }
  /// Of whom is named before it; else of whom the packet is for, or from.
  [[nodiscard]] const descriptor::Event* event_of(std::uint16_t id) const {
    if (about_ == nullptr) return nullptr;
    const auto found = std::ranges::find(about_->events, id, &descriptor::Event::id);
    return found != about_->events.end() ? &*found : nullptr;
  }
  [[nodiscard]] std::string list_of(const Part& part) {
    const auto count = reader_.get<std::uint8_t>();
    std::string text;
    for (std::uint8_t i = 0; i < count && reader_.good(); ++i) {
      text.append(i == 0 ? "" : ",");
      const bool single = part.repeated().size() == 1;
      if (single) text.append(value(part.repeated().front()));
      else {
        const std::string inner = parts(part.repeated());
        text.append("(").append(inner.empty() ? inner : inner.substr(1)).append(")");
      }
    }
    return text.empty() ? "none" : text;
  }
  [[nodiscard]] std::string value_of_last() {
    // The width of an unknown parameter is unknown: nothing behind it can be read.
    if (!last_) {
      static_cast<void>(reader_.get(reader_.remaining() + 1));
      return "?";
    }
    std::string text;
    for (const auto& field : last_->fields) {
      if (!text.empty()) text.append(",");
      append_values(text, subsystem_, field, reader_);
    }
    return text;
  }

  const descriptor::Mission& mission_;
  const descriptor::SubsystemDescriptor& subsystem_;
  const descriptor::SubsystemDescriptor* about_;
  OctetReader& reader_;
  std::optional<Known> last_;
};

[[nodiscard]] std::string shape_text(Shape shape, const descriptor::Mission& mission,
                                     const descriptor::SubsystemDescriptor& subsystem, OctetReader& reader) {
  return ShapeWords{mission, subsystem, reader}.parts(shape);
}

/// " PAGE NUMBER=3 VALUE=1.5,2" of a report that no rule above knows.
[[nodiscard]] std::string report_text(const descriptor::Mission& mission,
                                      const descriptor::SubsystemDescriptor& subsystem, std::uint8_t service,
                                      std::uint8_t subtype, OctetReader& reader) {
  std::string text;
  if (const auto* own = subsystem.find_service(service)) {
    const auto report = std::ranges::find(own->reports, subtype, &descriptor::CustomService::Report::subtype);
    if (report == own->reports.end()) return text;
    return text.append(" ").append(report->name).append(values_text(report->fields, reader.rest()));
  }
  const ServiceKind* kind = standard_service(service);
  const ReportKind* report = kind != nullptr ? kind->report(subtype) : nullptr;
  if (report == nullptr) return text;
  return text.append(" ").append(report->name).append(shape_text(report->data, mission, subsystem, reader));
}

/// Stages of ST[01] by subtype.
constexpr std::array<std::string_view, 11> stages{
    "",          "accepted",        "not accepted", "started",           "start failed",
    "progress",  "progress failed", "completed",    "completion failed", "",
    "not routed"};

}  // namespace

std::string text_of(Octets octets) {
  std::string text;
  for (const std::byte octet : octets) {
    const auto c = std::to_integer<unsigned char>(octet);
    if (c == 0) break;
    text += c < ' ' || c >= 0x7F ? '?' : static_cast<char>(c);
  }
  return text;
}

const descriptor::SubsystemDescriptor* PacketDescriber::find(std::uint16_t apid) const {
  if (apid == mission_->supervisor.id) return &mission_->supervisor;
  const auto* member = mission_->find_subsystem(apid);
  return member != nullptr ? &member->subsystem : nullptr;
}

std::string PacketDescriber::name_of(std::uint16_t apid) const {
  const auto* subsystem = find(apid);
  if (subsystem != nullptr) return subsystem->name;
  std::string text = "APID ";
  return text.append(std::to_string(apid));
}

std::string PacketDescriber::describe(Octets packet) const {
  const auto header = read_primary_header(packet);
  if (!header) return "fragment";
  if (header->telecommand) {
    const auto telecommand = TelecommandView::parse(packet);
    if (telecommand) return describe_telecommand(*telecommand);
    std::string text = "TC damaged: ";
    return text.append(to_text(telecommand.error().code()));
  }
  const auto telemetry = TelemetryView::parse(packet);
  return telemetry ? describe_telemetry(*telemetry) : "TM damaged";
}

std::string PacketDescriber::describe_telecommand(const TelecommandView& telecommand) const {
  std::string text = kind_text("TC", telecommand.service(), telecommand.subtype());
  text.append(name_of(telecommand.apid()));
  text.append(" #").append(std::to_string(telecommand.sequence_count()));
  const auto* subsystem = find(telecommand.apid());
  if (subsystem == nullptr) return text;
  if (telecommand.service() == FunctionService::service_type &&
      telecommand.subtype() == FunctionService::perform_function)
    return text.append(call_text(*subsystem, telecommand.application_data()));
  OctetReader reader{telecommand.application_data()};
  if (const auto* request = subsystem->find_request(telecommand.service(), telecommand.subtype())) {
    return text.append(" ").append(request->name).append(values_text(request->arguments, reader.rest()));
  }
  const ServiceKind* kind = standard_service(telecommand.service());
  const RequestKind* request = kind != nullptr ? kind->request(telecommand.subtype()) : nullptr;
  if (request == nullptr) return text;
  return text.append(" ").append(request->name).append(shape_text(request->data, *mission_, *subsystem, reader));
}

std::string PacketDescriber::describe_telemetry(const TelemetryView& telemetry) const {
  std::string text = kind_text("TM", telemetry.service(), telemetry.subtype());
  text.append(name_of(telemetry.apid()));
  OctetReader reader{telemetry.source_data()};
  if (telemetry.service() == 1 && telemetry.subtype() < stages.size()) {
    const auto id = reader.get<std::uint32_t>();
    text.append(" ").append(stages[telemetry.subtype()]);
    text.append(" ").append(name_of(static_cast<std::uint16_t>(id >> 16 & 0x7FF)));
    text.append(" #").append(std::to_string(id & 0x3FFF));
    if (telemetry.subtype() == 5 || telemetry.subtype() == 6)
      text.append(" step ").append(std::to_string(reader.get<std::uint16_t>()));
    if (telemetry.subtype() % 2 == 0) {
      const auto code = reader.get<std::uint16_t>();
      text.append(": ").append(describe_failure(telemetry.apid(), code, reader.rest()));
    }
  } else if (telemetry.service() == 5 && telemetry.subtype() >= 1 && telemetry.subtype() <= 4) {
    text.append(" ").append(to_text(static_cast<descriptor::Severity>(telemetry.subtype())));
    text.append(" ").append(describe_event(telemetry.apid(), telemetry.source_data()));
  } else if (telemetry.service() == 3 && telemetry.subtype() == 25) {
    text.append(" housekeeping ").append(std::to_string(reader.get<std::uint16_t>()));
  } else if (telemetry.service() == st129::service_type && telemetry.subtype() == st129::telecommand_copy) {
    const auto telecommand = TelecommandView::parse(telemetry.source_data());
    text.append(" copy of ").append(telecommand ? describe_telecommand(*telecommand) : "a damaged telecommand");
  } else if (const auto* subsystem = find(telemetry.apid())) {
    text.append(report_text(*mission_, *subsystem, telemetry.service(), telemetry.subtype(), reader));
  }
  return text;
}

std::string PacketDescriber::describe_failure(std::uint16_t apid, std::uint16_t code, Octets data) const {
  std::string text{to_text(static_cast<FailureCode>(code))};
  if (code >= first_own_failure_code) {
    const auto* subsystem = find(apid);
    text = "code " + std::to_string(code);
    if (subsystem != nullptr)
      for (const auto& failure : subsystem->failures)
        if (failure.code == code) text = failure.name;
  }
  if (const std::string parameter = refused_parameter(static_cast<FailureCode>(code), data); !parameter.empty())
    text.append(" ").append(parameter);
  const auto reason = reason_in(data);
  if (!reason) return text;
  text.append(" '").append(text_of(std::as_bytes(std::span{reason->text}))).append("'");
  if (reason->number != 0) text.append(" ").append(std::to_string(reason->number));
  return text;
}

/// "DES_POSITION" of a refusal that names one by its id; a function's argument has a smaller number than any parameter.
std::string PacketDescriber::refused_parameter(FailureCode code, Octets data) const {
  using enum FailureCode;
  const bool names = code == UnknownIdentifier || code == ValueNotAcceptable || code == NotPermittedNow;
  if (!names || data.size() != sizeof(std::uint8_t) + sizeof(std::uint32_t)) return {};
  const auto id = OctetReader{data.subspan(1)}.get<std::uint32_t>();
  const auto* subsystem = find(static_cast<std::uint16_t>(id >> 16));
  const auto known = subsystem != nullptr ? parameter_of(*subsystem, id) : std::nullopt;
  return known ? known->name : std::string{};
}

std::string PacketDescriber::describe_event(std::uint16_t apid, Octets source_data) const {
  OctetReader reader{source_data};
  const auto id = reader.get<std::uint16_t>();
  const auto* subsystem = find(apid);
  if (subsystem == nullptr) return std::to_string(id);
  const auto event = std::ranges::find(subsystem->events, id, &descriptor::Event::id);
  if (event == subsystem->events.end()) return std::to_string(id);
  std::string text = event->name;
  for (const auto& argument : event->arguments) append_field(text, *subsystem, argument, reader);
  return text;
}

}  // namespace hirosco::pus
