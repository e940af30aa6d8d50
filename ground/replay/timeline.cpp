// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/timeline.hpp"

#include <cstdlib>
#include <ranges>
#include <utility>

#include "ground/model/json.hpp"
#include "ground/model/views.hpp"

namespace hirosco::ground {

using nlohmann::json;

json gaps_json(const std::vector<StoredGap>& gaps) {
  json list = json::array();
  for (const auto& gap : gaps) list.push_back({{"from", json_time(gap.from)}, {"to", json_time(gap.to)}});
  return list;
}

json timeline_json(Archive& archive, const Span& span) {
  json modes = json::array(), states = json::array(), links = json::array();
  for (const auto& change : archive.changes(span)) {
    const double t = json_time(change.t);
    if (change.kind == "mode") modes.push_back({{"t", t}, {"mode", change.value}});
    if (change.kind == "state")
      states.push_back(
          {{"t", t}, {"subsystem", change.name}, {"state", change.value.empty() ? json(nullptr) : json(change.value)}});
    if (change.kind == "link")
      links.push_back({{"t", t}, {"id", std::atoi(change.name.c_str())}, {"up", change.value == "up"}});
  }
  // Of too many the newest, like of all else.
  const Archive::Filter filter{.span = span, .text = {}, .limit = most_rows, .newest_first = true};
  json commands = json::array(), events = json::array(), faults = json::array();
  for (const auto& command : archive.commands(filter) | std::views::reverse) commands.push_back(command_json(command));
  for (const auto& event : archive.events(filter) | std::views::reverse) events.push_back(event_json(event));
  for (const auto& fault : archive.faults(span))
    faults.push_back(
        {{"t", json_time(fault.t)}, {"device", fault.device}, {"line", fault.line}, {"answer", fault.answer}});
  return {{"modes", std::move(modes)},
          {"states", std::move(states)},
          {"links", std::move(links)},
          {"commands", std::move(commands)},
          {"events", std::move(events)},
          {"faults", std::move(faults)},
          {"gaps", gaps_json(archive.gaps(span))}};
}

json events_json(Archive& archive, const Archive::Filter& filter) {
  json list = json::array();
  for (const auto& event : archive.events(filter)) list.push_back(event_json(event));
  return {{"events", std::move(list)}};
}

json commands_json(Archive& archive, const Archive::Filter& filter) {
  json list = json::array();
  for (const auto& command : archive.commands(filter)) {
    json one = command_json(command);
    one["reports"] = json::array();
    for (const auto& report : archive.reports(command.number)) one["reports"].push_back(report_json(report));
    list.push_back(std::move(one));
  }
  return {{"commands", std::move(list)}};
}

}  // namespace hirosco::ground
