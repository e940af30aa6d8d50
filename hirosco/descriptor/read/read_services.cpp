// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <utility>

#include "hirosco/descriptor/model/framework_events.hpp"
#include "hirosco/descriptor/read/detail/service_reader.hpp"

namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t max_self_test_ms = 600'000;  // ten minutes
constexpr std::size_t max_structures = 256;
// What ST[03] has room for in flight (hirosco/pus/st03_housekeeping; a test there holds them together).
constexpr std::size_t most_flown_structures = 32;
constexpr std::size_t most_listed_values = 255;  // a count in TM[3,10] is one octet
constexpr std::size_t max_sets = 32;

/// Of the definition of a structure in TM[3,10]: id, enabled,
/// interval, two counts, and of each set its repetitions and a count.
[[nodiscard]] std::size_t definition_octets_of(const HousekeepingStructure& structure) noexcept {
  std::size_t octets = 2 + 1 + 4 + 1 + 4 * structure.sampled_once.size() + 1;
  for (const auto& set : structure.sampled_repeatedly) octets += 2 + 1 + 4 * set.parameters.size();
  return octets;
}

}  // namespace

std::vector<Child> ServiceReader::children(Services& services) {
  const auto service = [this, &services](auto read) {
    return [this, &services, read](const xml::Element& element) {
      Attributes attributes{element, problems_};
      if (first_service(element, services)) read(element);
    };
  };
  return {{"EventService", service([this, &services](const xml::Element& element) {
             each_child(element, problems_,
                        {{"Event", [this, &services](const auto& child) { events_.read(child, services); }}});
           })},
          {"FunctionService", service([this, &services](const xml::Element& element) {
             each_child(element, problems_,
                        {{"Function", [this, &services](const auto& child) { functions_.read(child, services); }}});
           })},
          {"TestService",
           [this, &services](const xml::Element& element) {
             if (first_service(element, services)) read_test_service(element, services);
           }},
          {"HKService", [this, &services](const xml::Element& element) { housekeeping_.read(element, services); },
           max_structures},
          {"RealTimeLinkService", service([this, &services](const xml::Element& element) {
             each_child(
                 element, problems_,
                 {{"Provides", [this, &services](const auto& child) { link_sets_.read_provides(child, services); },
                   max_sets},
                  {"Requires", [this, &services](const auto& child) { link_sets_.read_requires(child, services); },
                   max_sets}});
           })}};
}

bool ServiceReader::first_service(const xml::Element& element, Services& services) {
  const auto [before, first] = services.seen.emplace(element.name, place(element.at));
  if (!first)
    problems_.add(element, "E0212",
                  fmt::format("a second <{}>: a subsystem has one instance of each service", element.name),
                  fmt::format("the first one is in line {}", before->second.line));
  return first;
}

void ServiceReader::read_test_service(const xml::Element& element, Services& services) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const std::int64_t inherited_ms = services.self_test_within / std::chrono::milliseconds{1};
  services.self_test_within = std::chrono::milliseconds{
      attributes.integer_or<std::int64_t>("self_test_within_ms", 1, max_self_test_ms, inherited_ms)};
}

void EventReader::read(const xml::Element& element, const Services& services) {
  Attributes attributes{element, problems_};
  Event event;
  event.at = place(element.at);
  event.name = attributes.name();
  const bool of_framework = element.find("id") == nullptr;
  event.id = attributes.integer_or<std::uint16_t>("id", 1, framework_event::first - 1, 0);
  if (attributes.required("severity") != nullptr) event.severity = attributes.one_of("severity", Severity::Info);
  event.safety = attributes.yes("safety", false);
  Unique names{"argument name", "E0201"};
  each_child(
      element, problems_,
      {{"Argument", [&](const xml::Element& child) { fields_.read_plain(child, event.arguments, names, Says::Told); },
        max_arguments}});
  std::size_t octets = 0;
  for (const Field& argument : event.arguments) octets += argument.octets();
  if (octets > max_event_octets)
    problems_.add(element, "E0215", fmt::format("event '{}' takes {} octets in one report", event.name, octets),
                  fmt::format("at most {}", max_event_octets));
  expect_for_all(element, problems_, services, event.name);
  if (!event.name.empty()) event_names_.add(event.name, event.at, problems_, element.name.size() + 1);
  // Without an id it can only be one of the framework's; those are known when the whole descriptor is.
  if (of_framework) {
    framework_severities_.push_back({&element, std::move(event)});
    return;
  }
  if (event.id != 0)
    event_ids_.add(std::to_string(event.id), place(element.find("id")->value_at), problems_,
                   element.find("id")->value.size());
  subsystem_.events.push_back(std::move(event));
}

/// An author may change the severity of a framework's event, nothing else of it.
void EventReader::imply_framework_events() {
  const std::size_t own = subsystem_.events.size();
  add_framework_events(subsystem_);
  const auto implied = std::span{subsystem_.events}.subspan(own);
  for (const Event& event : std::span{subsystem_.events}.first(own))
    if (std::ranges::find(implied, event.name, &Event::name) != implied.end())
      problems_.add(event.at, "E0213", fmt::format("event '{}' is built in: every subsystem has it", event.name),
                    "leave it out, or give it a severity only: no id, no arguments", 6);
  for (const auto& [element, wanted] : framework_severities_) {
    const auto found = std::ranges::find(implied, wanted.name, &Event::name);
    if (found == implied.end())
      problems_.add(*element, "E0105", "<Event> needs the attribute 'id'",
                    "only an event that every subsystem has is known without it");
    else if (!wanted.arguments.empty())
      problems_.add(*element, "E0213", fmt::format("event '{}' is built in with its arguments", wanted.name));
    else if (const auto* mark = element->find("safety"); mark != nullptr && !wanted.safety && found->safety)
      problems_.add(place(mark->value_at), "E0241", fmt::format("event '{}' is one that safety rests on", wanted.name),
                    "leave safety out: nobody switches its report off", mark->value.size());
    else {
      found->severity = wanted.severity;
      found->safety = found->safety || wanted.safety;
    }
  }
}

/// Functions and events are the subsystem's, whatever is configured: nothing may look as if it held in one configuration only.
void expect_for_all(const xml::Element& element, Problems& problems, const Services& services, std::string_view name) {
  if (services.configurations < 2) return;
  problems.add(
      element, "E0230",
      fmt::format("'{}' stands in one of {} configurations and would hold in all", name, services.configurations),
      "declare it under <Subsystem>; a function that makes no sense now is its author's to refuse");
}

void HousekeepingReader::read(const xml::Element& element, Services& services) {
  Attributes attributes{element, problems_};
  HousekeepingStructure structure;
  structure.at = place(element.at);
  structure.id = attributes.required_integer<std::uint16_t>("id", 1, 65'535);
  structure.interval_cycles = attributes.required_integer<std::uint32_t>("interval", 1, 4'294'967'295);
  structure.enabled = attributes.yes("enabled", true);
  const std::string user = fmt::format("HKService {}", structure.id);
  each_child(element, problems_,
             {{"SampledOnce",
               [&](const xml::Element& child) {
                 const Attributes none{child, problems_};
                 references_.read_sampled(child, structure.sampled_once, user);
               },
               1},
              {"SampledNREPTimes", [&](const xml::Element& child) {
                 Attributes inner{child, problems_};
                 HousekeepingStructure::SampledSet set;
                 set.repetitions = inner.required_integer<std::uint16_t>("nrep", 1, 65'535);
                 if (set.repetitions != 0 && structure.interval_cycles % set.repetitions != 0)
                   problems_.add(*child.find("nrep"), "E0214",
                                 fmt::format("nrep {} does not divide the interval {}", set.repetitions,
                                             structure.interval_cycles));
                 references_.read_sampled(child, set.parameters, user);
                 structure.sampled_repeatedly.push_back(std::move(set));
               }}});
  std::size_t octets = 0;
  for (const auto& reference : structure.sampled_once) octets += references_.octets_of(reference);
  for (const auto& set : structure.sampled_repeatedly)
    for (const auto& reference : set.parameters) octets += set.repetitions * references_.octets_of(reference);
  if (octets > max_housekeeping_octets)
    problems_.add(element, "E0215", fmt::format("{} takes {} octets in one report", user, octets),
                  fmt::format("at most {}", max_housekeeping_octets));
  expect_room(element, structure, services);
  if (element.children.empty())
    problems_.add(element, "E0106", "<HKService> needs <SampledOnce> or <SampledNREPTimes>");
  if (structure.id != 0)
    services.structure_ids.add(std::to_string(structure.id), place(element.find("id")->value_at), problems_,
                               element.find("id")->value.size());
  services.housekeeping.push_back(std::move(structure));
}

/// What CONFIGURE would fail on. A configuration's structures come on top of the subsystem's.
void HousekeepingReader::expect_room(const xml::Element& element, const HousekeepingStructure& structure,
                                     const Services& services) {
  const bool of_configuration = &services.housekeeping != &subsystem_.housekeeping;
  const std::size_t before = services.housekeeping.size() + (of_configuration ? subsystem_.housekeeping.size() : 0);
  if (before == most_flown_structures)  // once, not for each that follows
    problems_.add(element, "E0257", fmt::format("more than {} housekeeping structures", most_flown_structures),
                  of_configuration ? "those of the subsystem and of a configuration together; values of one interval "
                                     "find room in one structure"
                                   : "values of one interval find room in one structure");
  const auto too_many = [](const auto& list) { return list.size() > most_listed_values; };
  if (too_many(structure.sampled_once) || too_many(structure.sampled_repeatedly) ||
      std::ranges::any_of(structure.sampled_repeatedly, too_many, &HousekeepingStructure::SampledSet::parameters))
    problems_.add(element, "E0257",
                  fmt::format("HKService {} has a list of more than {}", structure.id, most_listed_values),
                  fmt::format("at most {} <ParamRef> sampled once, {} <SampledNREPTimes>, and {} <ParamRef> in each: "
                              "an array or a structure is one",
                              most_listed_values, most_listed_values, most_listed_values));
  constexpr std::size_t most_octets = max_housekeeping_octets + 2;  // no structure id stands before it
  if (const std::size_t octets = definition_octets_of(structure); octets > most_octets)
    problems_.add(element, "E0257", fmt::format("the definition of HKService {} takes {} octets", structure.id, octets),
                  fmt::format("at most {} fit into TM[3,10]: 9, 3 for each <SampledNREPTimes>, 4 for each <ParamRef>",
                              most_octets));
}

}  // namespace hirosco::descriptor::detail
