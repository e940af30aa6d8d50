// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/descriptor/read/detail/configuration_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t least_sampling_us = least_sampling / std::chrono::microseconds{1};
constexpr std::int64_t max_sampling_us = 3'600'000'000;  // an hour

}  // namespace

void ConfigurationReader::read(const xml::Element& element, const Services& common, std::size_t configurations) {
  Attributes attributes{element, problems_};
  Configuration configuration;
  configuration.at = place(element.at);
  configuration.name = attributes.name();
  configuration.id = attributes.required_integer<std::uint8_t>("id", 1, 255);
  configuration.priority = attributes.integer_or<int>("priority", 0, greatest_cycle_priority, 0);
  configuration.sampling = std::chrono::microseconds{
      attributes.required_integer<std::int64_t>("sampling_us", least_sampling_us, max_sampling_us)};
  read_start(attributes, configuration);
  read_budget(attributes, configuration);
  read_spin(attributes, configuration);
  configuration.power_w = attributes.watts("power_W").value_or(0);
  configuration.overruns = read_limit(attributes, "overruns", "overruns_reduced", configuration.overruns);
  configuration.self_test = attributes.one_of("self_test", SelfTest::Optional);
  configuration.self_test_within = common.self_test_within;
  configuration.provides = common.provides;
  configuration.requires_ = common.requires_;

  Unique structure_ids = common.structure_ids, provided = common.provided, required = common.required;
  Services services{configuration.housekeeping,
                    configuration.provides,
                    configuration.requires_,
                    structure_ids,
                    provided,
                    required,
                    configuration.self_test_within,
                    configurations};
  Unique devices{"device", "E0201"};
  auto children = services_.children(services);
  children.push_back({"Device", [&](const auto& child) { device_uses_.read(child, configuration, devices); }, 255});
  Unique set{"parameter", "E0201"};
  children.push_back({"Set", [&](const auto& child) { read_set(child, configuration, set); }, 1024});
  Unique uses{"service", "E0201"};
  children.push_back({"Service",
                      [&](const auto& child) { service_list_.read_service(child, configuration.services, uses, true); },
                      255});
  Unique paces{"name of a loop", "E0201"};
  children.push_back({"ServiceLoop",
                      [&](const auto& child) { service_list_.read_pace_of(child, configuration.paces, paces); },
                      max_service_loops});
  each_child(element, problems_, children);
  check_start(element, configuration);
  service_list_.check_housekeeping_offered(element, configuration);

  if (!configuration.name.empty())
    configuration_names_.add(configuration.name, configuration.at, problems_, element.name.size() + 1);
  if (configuration.id != 0)
    configuration_ids_.add(std::to_string(configuration.id), place(element.find("id")->value_at), problems_,
                           element.find("id")->value.size());
  subsystem_.configurations.push_back(std::move(configuration));
}

void ConfigurationReader::read_budget(Attributes& attributes, Configuration& configuration) {
  configuration.budget =
      std::chrono::microseconds{attributes.integer_or<std::int64_t>("budget_us", 1, max_sampling_us, 0)};
  const Duration period = configuration.shortest();
  if (period == Duration{} || configuration.budget <= period) return;
  problems_.add(
      *attributes.optional("budget_us"), "E0227",
      fmt::format("a cycle of {} us every {} us is an overrun each time", configuration.budget / 1us, period / 1us),
      "the budget is at most the sampling period, or the least distance of cycles that samples start");
}

/// Of a precise cycle (adr 0104). It is no favour: the processor is everybody's, and the spin is reckoned as its work is.
void ConfigurationReader::read_spin(Attributes& attributes, Configuration& configuration) {
  const auto* spin = attributes.optional("spin_us");
  if (spin == nullptr) return;
  configuration.spin = std::chrono::microseconds{
      attributes.integer_or<std::int64_t>("spin_us", 1, greatest_spin / std::chrono::microseconds{1}, 0)};
  const auto refuse = [&](std::string message, std::string hint) {
    problems_.add(*spin, "E0253", std::move(message), std::move(hint));
  };
  if (!configuration.started_by.empty())
    return refuse("a cycle that samples start is due at no instant", "spin_us is of a cycle that the clock starts");
  if (configuration.priority == 0)
    return refuse("a precise cycle has no priority", "priority: without one it would take turns with everybody");
  if (configuration.budget == Duration{})
    return refuse("a precise cycle declares no budget", "budget_us: whether there is room to spin is reckoned with it");
  if (configuration.sampling == Duration{} || configuration.load() <= configuration.sampling) return;
  refuse(fmt::format("{} us of spin and {} us of budget are more than a period of {} us", configuration.spin / 1us,
                     configuration.budget / 1us, configuration.sampling / 1us),
         "lower spin_us or budget_us, or raise sampling_us");
}

/// Of a cycle that samples start: by which set, and how soon one may follow another.
void ConfigurationReader::read_start(Attributes& attributes, Configuration& configuration) {
  const auto* set = attributes.optional("started_by");
  const auto* least = attributes.optional("least_us");
  if (set == nullptr && least == nullptr) return;
  if (set == nullptr || least == nullptr)
    return problems_.add(set == nullptr ? *least : *set, "E0250",
                         fmt::format("'{}' without '{}'", set == nullptr ? "least_us" : "started_by",
                                     set == nullptr ? "started_by" : "least_us"),
                         "both of a cycle that samples start: the set, and the shortest distance of two cycles");
  configuration.least = std::chrono::microseconds{
      attributes.required_integer<std::int64_t>("least_us", least_sampling_us, max_sampling_us)};
  configuration.started_by = attributes.name("started_by");
  if (configuration.sampling == Duration{} || configuration.least <= configuration.sampling) return;
  problems_.add(*least, "E0250",
                fmt::format("a cycle is to wait {} us at least and {} us at most", configuration.least / 1us,
                            configuration.sampling / 1us),
                "least_us is at most sampling_us, the longest wait");
}

void ConfigurationReader::check_start(const xml::Element& element, Configuration& configuration) {
  if (configuration.started_by.empty()) return;
  const auto set = std::ranges::find(configuration.requires_, configuration.started_by, &Requires::name);
  if (set == configuration.requires_.end()) {
    std::vector<std::string_view> known;
    for (const Requires& each : configuration.requires_) known.push_back(each.name);
    return problems_.add(*element.find("started_by"), "E0251",
                         fmt::format("set {} is not required here", in_quotes(configuration.started_by)),
                         did_you_mean(configuration.started_by, known));
  }
  set->starts = true;
  const auto wakes = [&](LinkMethod method) {
    const LinkMechanism* mechanism = find_link_mechanism(standard_link_mechanisms(), method, set->kind());
    return mechanism != nullptr && mechanism->wakes();
  };
  if (std::ranges::any_of(set->terms.methods, wakes)) return;
  problems_.add(*element.find("started_by"), "E0252",
                fmt::format("set {} comes by no method that wakes", in_quotes(configuration.started_by)),
                "methods=\"shared_memory\", or sampling_us alone: the clock");
}

void ConfigurationReader::read_set(const xml::Element& element, Configuration& configuration, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* name = attributes.required("parameter");
  const auto* value = attributes.required("value");
  auto reference = name == nullptr ? std::nullopt : references_.resolve(*name, "<Set>");
  if (!reference || value == nullptr) return;
  names.add(name->value, place(name->value_at), problems_, name->value.size());
  if (subsystem_.parameters[reference->parameter].persistent)
    return problems_.add(*name, "E0238", fmt::format("'{}' is persistent and set by a configuration", reference->text),
                         "one of the two: what telecommands set counts until they set it again");
  const auto fields = fields_of(subsystem_, *reference);
  auto values = read_values(problems_, *value, reference->text, fields, subsystem_.enumerations);
  if (values) configuration.initial.push_back({std::move(*reference), std::move(*values)});
}

}  // namespace hirosco::descriptor::detail
