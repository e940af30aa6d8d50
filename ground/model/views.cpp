// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/model/views.hpp"

#include <array>
#include <string>

#include "ground/model/json.hpp"

namespace hirosco::ground {

using nlohmann::json;

json event_json(const StoredEvent& event) {
  json values = json::parse(event.values, nullptr, false);
  return {{"t", json_time(event.t)},      {"apid", event.apid},
          {"subsystem", event.subsystem}, {"id", event.id},
          {"name", event.name},           {"severity", to_text(static_cast<descriptor::Severity>(event.severity))},
          {"text", event.text},           {"values", values.is_object() ? std::move(values) : json::object()}};
}

json command_json(const StoredCommand& command) {
  json arguments = json::parse(command.arguments, nullptr, false);
  return {{"id", command.number},
          {"t", json_time(command.t)},
          {"sender", command.sender},
          {"apid", command.apid},
          {"subsystem", command.subsystem},
          {"function", command.function},
          {"arguments", arguments.is_object() ? std::move(arguments) : json::object()},
          {"stage", command.stage},
          {"code", command.code ? json(*command.code) : json(nullptr)},
          {"reason", command.reason.empty() ? json(nullptr) : json(command.reason)}};
}

json report_json(const StoredReport& report) {
  return {{"t", json_time(report.t)},
          {"stage", report.stage},
          {"code", report.code ? json(*report.code) : json(nullptr)},
          {"reason", report.reason.empty() ? json(nullptr) : json(report.reason)}};
}

json mark_json(const StoredMark& mark) {
  return {{"t", json_time(mark.t)},
          {"kind", mark.kind},
          {"name", mark.name},
          {"action", mark.action},
          {"who", mark.who},
          {"note", mark.kind == "stack" ? "" : mark.note},  // its text would be most of an answer
          {"until", mark.until != OnboardTime{} ? json(json_time(mark.until)) : json(nullptr)}};
}

json status_json(const Catalogue& catalogue, const Model& model, OnboardTime now) {
  constexpr std::array<const char*, 7> reasons{"stop", "link", "device", "author", "failure", "supervisor", "awaited"};
  json subsystems = json::array();
  for (std::size_t i = 0; i < catalogue.subsystems().size(); ++i) {
    const auto& descriptor = *catalogue.subsystems()[i];
    const auto& view = model.subsystems()[i];
    const auto* configuration = descriptor.find_configuration(view.configuration);
    const auto told = [&](std::uint32_t count) { return view.known ? json(count) : json(nullptr); };
    json inhibited = json::array();
    for (std::size_t bit = 0; bit < reasons.size(); ++bit)
      if ((view.inhibited >> bit & 1) != 0) inhibited.push_back(reasons[bit]);
    subsystems.push_back({{"id", descriptor.id},
                          {"name", descriptor.name},
                          {"state", view.state ? json(to_text(*view.state)) : json(nullptr)},
                          {"configuration", configuration != nullptr ? json(configuration->name) : json(nullptr)},
                          {"cycles", told(view.cycles)},
                          {"overruns", told(view.overruns)},
                          {"missed", told(view.missed)},
                          {"latency_max_ns", told(view.latency_max_ns)},
                          {"execution_mean_ns", told(view.execution_mean_ns)},
                          {"memory_kb", view.memory_kb != 0 ? json(view.memory_kb) : json(nullptr)},
                          {"inhibited", std::move(inhibited)},
                          {"waits_for", model.waits_for(i)},
                          {"age_s", view.known ? json(seconds(now - view.t)) : json(nullptr)}});
  }
  json links = json::array();
  for (std::size_t i = 0; i < model.links().size(); ++i) {
    const auto& view = model.links()[i];
    const auto number = [](const std::optional<double>& value) { return value ? json_number(*value) : json(nullptr); };
    const auto while_up = [&](const std::optional<double>& value) { return view.up ? number(value) : json(nullptr); };
    json latencies;
    if (view.up && view.latencies)
      latencies = {{"period_ns", view.latencies->period_ns}, {"counts", view.latencies->counts}};
    links.push_back({{"id", catalogue.mission().links[i].id},
                     {"up", view.known ? json(view.up) : json(nullptr)},
                     {"age_cycles", number(view.age_cycles)},
                     {"rate_hz", number(view.rate_hz)},
                     {"samples", view.known && view.samples ? json(*view.samples) : json(nullptr)},
                     {"lost", while_up(view.lost)},
                     {"latency_mean_ns", while_up(view.latency_mean_ns)},
                     {"latency_max_ns", while_up(view.latency_max_ns)},
                     {"jitter_ns", while_up(view.jitter_ns)},
                     {"age_at_use_us", while_up(view.age_at_use_us)},
                     {"latencies", std::move(latencies)}});
  }
  return {{"t", json_time(now)},
          {"mode", model.mode().empty() ? json(nullptr) : json(model.mode())},
          {"subsystems", std::move(subsystems)},
          {"links", std::move(links)}};
}

json value_json(const Column& column, const Value& value) {
  if (column.type == Type::Text) return value.words;
  return column.type == Type::Bool ? json(value.number != 0.0) : json_number(value.number);
}

json values_json(const Catalogue& catalogue, const Model& model, std::uint64_t since) {
  json set = json::object();
  for (std::size_t i = 0; i < model.values().size(); ++i) {
    const Value& value = model.values()[i];
    if (value.revision <= since) continue;
    set[catalogue.columns()[i].name] = {value_json(catalogue.columns()[i], value), json_time(value.t)};
  }
  return set;
}

}  // namespace hirosco::ground
