// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/words/describe.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "hirosco/parameter/number.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st129_supervision/supervision.hpp"

namespace hirosco::pus {
namespace {

[[nodiscard]] std::string number_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// "NAME=value unit", an enumeration by its text.
void append_field(std::string& text, const descriptor::Subsystem& subsystem, const descriptor::Field& field,
                  OctetReader& reader) {
  text.append(" ").append(field.name).append("=");
  if (field.text) {
    const std::string words = text_of(reader.get(field.octets()));
    text.append("'").append(words).append("'");
    return;
  }
  for (std::uint16_t i = 0; i < field.count; ++i) {
    const double value = get_number(reader, field.type);
    if (i != 0) text.append(",");
    const auto enumeration =
        std::ranges::find(subsystem.enumerations, field.enumeration, &descriptor::Enumeration::name);
    if (!field.enumeration.empty() && enumeration != subsystem.enumerations.end()) {
      const auto named = std::ranges::find_if(
          enumeration->texts, [&](const auto& entry) { return static_cast<double>(entry.value) == value; });
      if (named != enumeration->texts.end()) {
        text.append(named->text);
        continue;
      }
    }
    text.append(number_text(value));
  }
  if (!field.unit.empty()) text.append(" ").append(field.unit);
}

[[nodiscard]] std::string kind_text(const char* direction, std::uint8_t service, std::uint8_t subtype) {
  std::array<char, 24> text{};
  std::snprintf(text.data(), text.size(), "%s[%u,%u] ", direction, service, subtype);
  return text.data();
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

const descriptor::Subsystem* PacketDescriber::find(std::uint16_t apid) const {
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
  if (subsystem == nullptr || telecommand.service() != 8 || telecommand.subtype() != 1) return text;
  const auto common = common_functions();
  const auto call = decode_call(subsystem->functions, telecommand.application_data(), common);
  if (!call) return text.append(" (").append(to_text(call.error().notice.code())).append(")");
  const bool built_in = call->function >= first_built_in_function;
  const auto& function =
      built_in ? common[call->function - first_built_in_function] : subsystem->functions[call->function];
  text.append(" ").append(function.name);
  std::size_t next = 0;
  for (const auto& argument : function.arguments) {
    text.append(" ").append(argument.field.name).append("=");
    if (function.name == "SET_STATE") text.append(to_text(static_cast<descriptor::State>(call->arguments[next])));
    else text.append(number_text(call->arguments[next]));
    next += argument.field.count;
  }
  return text;
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
  const auto reason = reason_in(data);
  if (!reason) return text;
  text.append(" '").append(text_of(std::as_bytes(std::span{reason->text}))).append("'");
  if (reason->number != 0) text.append(" ").append(std::to_string(reason->number));
  return text;
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
