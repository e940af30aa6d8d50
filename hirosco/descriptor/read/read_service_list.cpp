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
  static_cast<void>(attributes.required("period_us"));
  read_pace(attributes, loop);
  loop.queue = attributes.integer_or<std::uint32_t>("queue", 1, max_service_queue, loop.queue);
  if (!loop.name.empty()) loop_names_.add(loop.name, loop.at, problems_, element.name.size() + 1);
  subsystem_.service_loops.push_back(std::move(loop));
}

/// What is left out stays as it is in `loop`.
void ServiceListReader::read_pace(Attributes& attributes, ServiceLoop& loop) {
  const auto microseconds_or = [&](std::string_view name, std::int64_t least, Duration other) -> Duration {
    return std::chrono::microseconds{attributes.integer_or<std::int64_t>(name, least, most_period_us, other / 1us)};
  };
  loop.period = microseconds_or("period_us", least_period_us, loop.period);
  loop.priority = attributes.integer_or<int>("priority", 0, greatest_cycle_priority, loop.priority);
  loop.budget = microseconds_or("budget_us", 1, loop.budget);
  if (loop.period == Duration{} || loop.budget <= loop.period) return;
  const xml::Attribute* const budget = attributes.optional("budget_us");
  const xml::Attribute* const at = budget != nullptr ? budget : attributes.optional("period_us");
  if (at == nullptr) return;  // neither is said here
  problems_.add(
      *at, "E0227",
      fmt::format("a step of {} us every {} us does not end before the next", loop.budget / 1us, loop.period / 1us),
      budget != nullptr ? "the budget is at most the period"
                        : "that is the budget of its subsystem: say a budget_us here, too, or a longer period_us");
}

/// What a configuration says of a loop of its subsystem; its queue is made when the process starts.
void ServiceListReader::read_pace_of(const xml::Element& element, std::vector<ServiceLoop>& paces, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const std::string name = attributes.name();
  const auto own = std::ranges::find(subsystem_.service_loops, name, &ServiceLoop::name);
  ServiceLoop loop = own != subsystem_.service_loops.end() ? *own : ServiceLoop{};
  loop.at = place(element.at);
  read_pace(attributes, loop);
  if (name.empty()) return;
  if (!names.add(name, loop.at, problems_, element.name.size() + 1)) return;
  if (own == subsystem_.service_loops.end()) return refuse_pace(*element.find("name"));
  if (attributes.optional("period_us") == nullptr && attributes.optional("priority") == nullptr &&
      attributes.optional("budget_us") == nullptr)
    return problems_.add(element, "E0244", fmt::format("nothing of the loop '{}' is otherwise here", name),
                         "say period_us, priority or budget_us, or leave it out");
  paces.push_back(std::move(loop));
}

/// There is no such loop: perhaps it is meant by one of its services.
void ServiceListReader::refuse_pace(const xml::Attribute& name) {
  const std::string& said = name.value;
  const auto* const own = subsystem_.find_service(said);
  const auto standard = std::ranges::find(standard_services_by_name, said, &StandardService::name);
  const bool listed = own != nullptr || standard != standard_services_by_name.end();
  const bool may_have_one = own != nullptr || (listed && standard->may_have_loop);
  if (!may_have_one && is_standard_service_name(said)) return refuse_loop(name, said);
  std::vector<std::string_view> known;
  for (const ServiceLoop& each : subsystem_.service_loops) known.push_back(each.name);
  std::string hint = did_you_mean(said, known);
  if (may_have_one) {
    const int loop = subsystem_.loop_of(own != nullptr ? own->type : standard->type);
    if (loop < 0)
      hint =
          fmt::format("service {} has no loop of its own: <Service loop=\"...\"> of the subsystem gives it one", said);
    else
      hint = fmt::format("service {} runs in '{}': name that", said,
                         subsystem_.service_loops[static_cast<std::size_t>(loop)].name);
  }
  problems_.add(name, "E0244", fmt::format("no <ServiceLoop> has the name '{}'", said), std::move(hint));
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
