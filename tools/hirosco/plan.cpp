// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "supervisor/supervision/event_handling/planned_reactions.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/preview.hpp"

/// `hirosco plan SUBSYSTEM:EVENT`: what recovery would do about an event, asked of the flight (TC[129,6]) or of the descriptors.
namespace hirosco::tools {
namespace {

/// Whose event it would be.
struct Asked {
  const descriptor::SubsystemDescriptor* subsystem{nullptr};
  const descriptor::Event* event{nullptr};
};

[[nodiscard]] bool same(const std::string& a, const std::string& b) { return lower_case(a) == lower_case(b); }

/// Those of the subsystem itself and, of one that the supervisor looks after, what that tells of it.
[[nodiscard]] std::vector<const descriptor::Event*> events_of(const descriptor::Mission& mission,
                                                              const descriptor::SubsystemDescriptor& subsystem) {
  std::vector<const descriptor::Event*> events;
  const bool own = &subsystem == &mission.supervisor;
  for (const descriptor::Event& event : subsystem.events)
    if (!own || (!descriptor::is_about_subsystem(event.name) && !descriptor::is_unplanned(event.name)))
      events.push_back(&event);
  if (own) return events;
  for (const descriptor::Event& event : mission.supervisor.events)
    if (descriptor::may_be_told_of(event.name, subsystem.name, mission.ground.subsystem) &&
        subsystem.find_event(event.name) == nullptr)
      events.push_back(&event);
  return events;
}

/// Prints what there is where it is not found.
[[nodiscard]] Asked find(const descriptor::Mission& mission, const std::string& words) {
  const auto colon = words.find(':');
  const std::string whose = words.substr(0, colon), name = colon == std::string::npos ? "" : words.substr(colon + 1);
  const auto all = mission.everybody();
  const auto subsystem = std::ranges::find_if(all, [&](const auto* each) { return same(each->name, whose); });
  if (subsystem == all.end()) {
    std::vector<std::string> names;
    for (const auto* each : all) names.push_back(each->name);
    fmt::print(stderr, "hirosco plan: no subsystem '{}'; the mission has {}\n", whose, fmt::join(names, ", "));
    return {};
  }
  const auto events = events_of(mission, **subsystem);
  const auto event = std::ranges::find_if(events, [&](const auto* each) { return same(each->name, name); });
  if (event == events.end()) {
    std::vector<std::string> names;
    for (const auto* each : events) names.push_back(each->name);
    fmt::print(stderr, "hirosco plan: {} has no event '{}'; SUBSYSTEM:EVENT, of it {}\n", (*subsystem)->name, name,
               fmt::join(names, ", "));
    return {};
  }
  return {*subsystem, *event};
}

void print_from_descriptors(const descriptor::Mission& mission, const Asked& asked, bool json) {
  auto all = nlohmann::ordered_json::array();
  for (const supervisor::PlannedReaction& each : supervisor::planned_reactions(mission)) {
    if (each.subsystem != asked.subsystem->name || each.event != asked.event->name) continue;
    if (json)
      all.push_back({{"plan", each.plan},
                     {"severity", to_text(each.severity)},
                     {"priority", each.priority},
                     {"modes", each.modes},
                     {"steps", each.steps}});
    else
      fmt::print("plan {} (priority {}) in {}: {}\n", each.plan, each.priority, fmt::join(each.modes, ", "),
                 each.steps.empty() ? "nothing is done" : each.steps);
  }
  if (json) fmt::print("{}\n", json_line(all));
}

void print(const pus::st129::PlanPreview& preview, const descriptor::Mission& mission, const Asked& asked, bool json) {
  const pus::PacketDescriber describer{mission};
  const auto severity = to_text(static_cast<descriptor::Severity>(preview.severity));
  if (json) {
    fmt::print("{}\n", json_line({{"subsystem", asked.subsystem->name},
                                  {"event", asked.event->name},
                                  {"severity", severity},
                                  {"plan", preview.name},
                                  {"number", preview.plan},
                                  {"against", preview.against},
                                  {"steps", steps_json(preview.steps, describer)}}));
    return;
  }
  fmt::print("{} {} {}: plan {}\n", asked.subsystem->name, severity, asked.event->name, preview.name);
  for (const std::string& why : preview.against) fmt::print("against it: {}\n", why);
  fmt::print("{}", preview.steps.empty() ? "nothing is done\n" : steps_text(preview.steps, describer));
}

}  // namespace

int plan(const PlanOptions& options) {
  if (options.from_descriptors) {
    const auto found = find_flight("plan", options.connection.mission, options.connection.instance);
    if (!found) return found.error();
    const Asked asked = find(found->mission, options.event);
    if (asked.event == nullptr) return exit_usage;
    print_from_descriptors(found->mission, asked, options.connection.json);
    return exit_ok;
  }
  const auto place = find_ground_link("plan", options.connection);
  if (!place) return place.error();
  const Asked asked = find(place->mission, options.event);
  if (asked.event == nullptr) return exit_usage;
  auto connection = GroundConnection::open(place->host, place->port);
  if (!connection) {
    fmt::print(stderr, "hirosco plan: {}:{}: {}; --descriptors asks nobody\n", place->host, place->port,
               connection.error().text);
    return exit_environment;
  }
  std::vector<std::byte> data(4);
  OctetWriter{data}.put(asked.subsystem->id).put(asked.event->id);
  const auto answer = ask(*connection,
                          {.supervisor = place->mission.supervisor.id,
                           .subtype = pus::st129::plan_question,
                           .data = std::move(data),
                           .answer = pus::st129::plan_preview},
                          options.limit);
  const auto preview = answer ? pus::st129::read_plan_preview(*answer) : std::nullopt;
  if (!preview) {
    fmt::print(stderr, "hirosco plan: no answer within the limit, or the question is refused\n");
    return exit_finding;
  }
  print(*preview, place->mission, asked, options.connection.json);
  return preview->against.empty() ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
