// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/read/detail/service_reader.hpp"

/// Which services a subsystem offers and in which loops they run (docs/adr/0096).
namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t least_period_us = 1000;
constexpr std::int64_t most_period_us = 1'000'000;
constexpr std::uint8_t housekeeping_service = 3;

}  // namespace

void ServiceListReader::read_service_loop(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  ServiceLoop loop;
  loop.at = place(element.at);
  loop.name = attributes.name();
  loop.period = std::chrono::microseconds{
      attributes.required_integer<std::int64_t>("period_us", least_period_us, most_period_us)};
  loop.priority = attributes.integer_or<int>("priority", 0, greatest_cycle_priority, 0);
  loop.budget = std::chrono::microseconds{attributes.integer_or<std::int64_t>("budget_us", 1, most_period_us, 0)};
  loop.queue = attributes.integer_or<std::uint32_t>("queue", 1, max_service_queue, loop.queue);
  if (loop.period != Duration{} && loop.budget > loop.period)
    problems_.add(
        *attributes.optional("budget_us"), "E0227",
        fmt::format("a step of {} us every {} us does not end before the next", loop.budget / 1us, loop.period / 1us),
        "the budget is at most the period");
  if (!loop.name.empty()) loop_names_.add(loop.name, loop.at, problems_, element.name.size() + 1);
  subsystem_.service_loops.push_back(std::move(loop));
}

void ServiceListReader::read_service(const xml::Element& element, std::vector<ServiceUse>& uses, Unique& names,
                                     bool of_configuration) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  ServiceUse use;
  use.at = place(element.at);
  const std::string name = attributes.name();
  use.offered = attributes.yes("offered", true);
  const xml::Attribute* const loop = of_configuration ? nullptr : attributes.optional("loop");
  if (name.empty()) return;
  if (!names.add(name, use.at, problems_, element.name.size() + 1)) return;
  const auto* const own = subsystem_.find_service(name);
  const auto standard = std::ranges::find(standard_services_by_name, name, &StandardService::name);
  const bool listed = own != nullptr || standard != standard_services_by_name.end();
  if (!listed && is_standard_service_name(name)) {
    const xml::Attribute* const offered = element.find("offered");
    if (loop != nullptr && offered == nullptr) return refuse_loop(*loop, name);
    return problems_.add(
        offered != nullptr ? *offered : *element.find("name"), "E0243",
        fmt::format("{} is offered by every subsystem or by none", name),
        "states, links and the test of it rest on it; ST03, ST05, ST20 and services of its own may be left out");
  }
  if (!listed) {
    std::vector<std::string_view> known;
    for (const StandardService& each : standard_services_by_name) known.push_back(each.name);
    for (const CustomService& each : subsystem_.services) known.push_back(each.name);
    return problems_.add(*element.find("name"), "E0242", fmt::format("the subsystem has no service '{}'", name),
                         did_you_mean(name, known));
  }
  use.type = own != nullptr ? own->type : standard->type;
  if (loop != nullptr) {
    const auto found = std::ranges::find(subsystem_.service_loops, loop->value, &ServiceLoop::name);
    if (own == nullptr && !standard->may_have_loop) refuse_loop(*loop, name);
    else if (found == subsystem_.service_loops.end()) {
      std::vector<std::string_view> known;
      for (const ServiceLoop& each : subsystem_.service_loops) known.push_back(each.name);
      problems_.add(*loop, "E0244", fmt::format("no <ServiceLoop> has the name '{}'", loop->value),
                    did_you_mean(loop->value, known));
    } else use.loop = static_cast<int>(found - subsystem_.service_loops.begin());
  }
  uses.push_back(use);
}

void ServiceListReader::refuse_loop(const xml::Attribute& loop, std::string_view name) {
  problems_.add(loop, "E0243", fmt::format("{} has no loop of its own: {}", name, why_no_loop(name)),
                "ST03, ST20 and services of its own may have one");
}

void ServiceListReader::check(const xml::Element& root) {
  for (std::size_t i = 0; i < subsystem_.service_loops.size(); ++i)
    if (std::ranges::find(subsystem_.service_uses, static_cast<int>(i), &ServiceUse::loop) ==
        subsystem_.service_uses.end())
      problems_.add(subsystem_.service_loops[i].at, "E0244",
                    fmt::format("no service runs in the loop '{}'", subsystem_.service_loops[i].name),
                    "name it in a <Service loop=\"...\">, or leave it out", 12);
  const auto threads = amount_of(subsystem_.resources.most, Resource::Threads);
  const std::size_t needed = 2 + subsystem_.service_loops.size();
  if (!threads || *threads >= needed) return;
  const auto resources = std::ranges::find(root.children, "Resources", &xml::Element::name);
  problems_.add(*resources, "E0248",
                fmt::format("{} threads are less than its {}: service loop, cycle and {} of its services", *threads,
                            needed, subsystem_.service_loops.size()),
                "raise threads, or let services share a loop");
}

/// What a configuration reports by a service that it does not have would be reported by nobody.
void ServiceListReader::check_housekeeping_offered(const xml::Element& element, const Configuration& configuration) {
  if (subsystem_.offers(housekeeping_service, &configuration)) return;
  const auto own = std::ranges::find(element.children, "HKService", &xml::Element::name);
  if (own == element.children.end()) return;
  problems_.add(*own, "E0245", fmt::format("configuration '{}' does not offer ST03", configuration.name),
                "leave the <HKService> out, or offer ST03");
}

}  // namespace hirosco::descriptor::detail
