// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/overview.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "supervisor/platform/launch/standard_error.hpp"
#include "supervisor/supervisor.hpp"

namespace hirosco::supervisor {

std::string json_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : shown(text)) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter;
  }
  return quoted + "\"";
}

Overview blank_overview(const descriptor::Mission& mission, const descriptor::Mode& mode) {
  Overview overview{.mission = mission.name,
                    .mode = mode.name,
                    .initial_mode = mission.initial_mode,
                    .usual_mode = mission.start_mode,
                    .members = {},
                    .links = {}};
  for (const auto& described : mission.subsystems) {
    Overview::Member member{.name = described.subsystem.name};
    const auto step = std::ranges::find(mode.commission, member.name, &descriptor::CommissionStep::subsystem);
    if (step != mode.commission.end()) member.wanted = to_text(step->state);
    overview.members.push_back(std::move(member));
  }
  for (const auto& link : mission.links)
    overview.links.push_back({.id = link.id,
                              .from = link.from,
                              .to = link.to,
                              .wanted = std::ranges::find(mode.establish, link.id) != mode.establish.end()});
  return overview;
}

Overview overview_of(const descriptor::Mission& mission, const Supervisor& supervisor) {
  Overview overview = blank_overview(mission, supervisor.mode());
  overview.waits_for = supervisor.waiting_for();
  for (const Member& member : supervisor.members()) {
    const auto told = std::ranges::find(overview.members, member.descriptor().name, &Overview::Member::name);
    if (told == overview.members.end()) continue;
    const auto state = member.state();
    told->runs = member.alive() && state;
    if (told->runs) told->state = to_text(*state);
    const auto counts = member.statistics();
    if (!counts) continue;
    told->counted = true;
    told->cycling = counts->cycling;
    told->realtime = counts->realtime;
    told->inhibited = counts->inhibited;
    told->period_ns = counts->period_ns;
    told->cycles = counts->cycles;
    told->overruns = counts->overruns;
    told->missed = counts->missed;
    told->latency_max_ns = counts->latency_max_ns;
    told->execution_mean_ns = counts->execution_mean_ns;
    told->inhibited_at_cycle = counts->inhibited_at_cycle;
    told->stopped_at_cycle = member.stopped_at_cycle();
  }
  for (Overview::Link& link : overview.links) link.up = supervisor.links().is_up(link.id);
  return overview;
}

std::string json_of(const Overview& overview, double up_s,
                    const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text = fmt::format(
      R"({{"up_s":{:.3f},"mission":{},"mode":{},"initial_mode":{},"usual_mode":{},"waits_for":{},"members":[)", up_s,
      json_string(overview.mission), json_string(overview.mode), json_string(overview.initial_mode),
      json_string(overview.usual_mode), json_string(overview.waits_for));
  bool first = true;
  for (const Overview::Member& member : overview.members) {
    text += fmt::format(R"({}{{"name":{},"runs":{},"state":{},"wanted":{})", first ? "" : ",", json_string(member.name),
                        member.runs, json_string(member.state), json_string(member.wanted));
    if (member.counted)
      text += fmt::format(
          R"(,"cycling":{},"realtime":{},"inhibited":{},"period_ns":{},"cycles":{},"overruns":{},"missed":{},"latency_max_ns":{},"execution_mean_ns":{})",
          member.cycling, member.realtime, member.inhibited, member.period_ns, member.cycles, member.overruns,
          member.missed, member.latency_max_ns, member.execution_mean_ns);
    text += "}";
    first = false;
  }
  text += R"(],"links":[)";
  first = true;
  for (const Overview::Link& link : overview.links) {
    text += fmt::format(R"({}{{"id":{},"from":{},"to":{},"up":{},"wanted":{}}})", first ? "" : ",", link.id,
                        json_string(link.from), json_string(link.to), link.up, link.wanted);
    first = false;
  }
  text += R"(],"values":[)";
  first = true;
  for (const auto& [label, words] : values) {
    text += fmt::format("{}[{},{}]", first ? "" : ",", json_string(label), json_string(words));
    first = false;
  }
  return text + "]}";
}

}  // namespace hirosco::supervisor
