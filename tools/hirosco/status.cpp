// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>

#include "hirosco/utilities/lower_case.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/ground_connection.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/listening.hpp"
#include "tools/hirosco/our_process.hpp"
#include "tools/terminal/columns.hpp"
#include "tools/terminal/heard_overview.hpp"
#include "tools/terminal/terminal.hpp"
#include "tools/terminal/verdict.hpp"

namespace hirosco::tools {
namespace {

void print_newest_text(const descriptor::SubsystemDescriptor& subsystem, Listened& listened) {
  fmt::print("{} (APID {}): {} packets in {} s\n", subsystem.name, subsystem.id, listened.packets[subsystem.id],
             seconds(listening));
  for (const auto& [name, value] : listened.values[subsystem.id]) {
    fmt::print("  {:<28}", name);
    for (const std::string& text : value.texts()) fmt::print(" {:>12}", text);
    fmt::print(" {}\n", value.unit);
  }
}

void print_newest_json(const descriptor::SubsystemDescriptor& subsystem, Listened& listened) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto& [name, value] : listened.values[subsystem.id])
    values[name] = nlohmann::ordered_json::parse(value.json());
  fmt::print("{}\n", json_line({{"subsystem", subsystem.name},
                                {"apid", subsystem.id},
                                {"packets", listened.packets[subsystem.id]},
                                {"values", std::move(values)}}));
}

/// Whole, as the cause stands at its end: a terminal that is narrower breaks it. In letters that the terminal has.
void print_line(std::string_view text, std::string_view look) {
  const bool shown = ::isatty(STDOUT_FILENO) != 0;
  std::string line = terminal::cut(text, std::string::npos);
  if (shown && !terminal::takes_unicode(std::getenv("LC_ALL"), std::getenv("LC_CTYPE"), std::getenv("LANG")))
    line = terminal::ascii(line);
  const bool coloured = shown && !look.empty() && std::getenv("NO_COLOR") == nullptr;
  fmt::print("{}{}{}\n", coloured ? look : "", line, coloured ? "\x1b[0m" : "");
}

[[nodiscard]] std::string_view look_of(descriptor::Severity severity) {
  if (severity == descriptor::Severity::High) return "\x1b[1;31m";
  return severity == descriptor::Severity::Medium ? "\x1b[33m" : "";
}

void print_verdict(const terminal::Judgement& judged) {
  const bool unwell = judged.verdict != terminal::Verdict::Well;
  print_line(judged.line, unwell ? look_of(descriptor::Severity::High) : "");
  for (const auto& finding : judged.findings)
    print_line(fmt::format("  {:<6} {}", to_text(finding.severity), finding.text), look_of(finding.severity));
}

/// What a craft that stopped is brought up again by.
void print_way_up(const descriptor::Mission& mission, const supervisor::Overview& overview) {
  const auto way_up = terminal::way_up(overview, mission);
  print_line(fmt::format("What stopped it: hirosco why{}", way_up.empty()       ? ""
                                                           : way_up.size() == 1 ? ". Up again: " + way_up.front()
                                                                                : ". Up again:"),
             "");
  if (way_up.size() > 1)
    for (const std::string& command : way_up) fmt::print("  {}\n", command);
}

/// Of a flight on this computer.
[[nodiscard]] bool misses_its_keeper(int keeper) { return keeper > 0 && !our_process(keeper); }

/// Who does not answer, and has no keeper, stays as it is.
void print_end_without_keeper(int keeper) {
  if (misses_its_keeper(keeper))
    fmt::print(stderr,
               "hirosco status: the keeper of this flight is gone; who does not answer is ended by: hirosco safe\n");
}

/// Null: there is none of this name, and those that there are were printed.
[[nodiscard]] const descriptor::SubsystemDescriptor* find_named(const descriptor::Mission& mission,
                                                                const std::string& name) {
  std::vector<std::string> names;
  for (const auto* each : mission.everybody()) {
    if (lower_case(each->name) == lower_case(name)) return each;
    names.push_back(each->name);
  }
  fmt::print(stderr, "hirosco status: no subsystem '{}'{}; mission {} has {}\n", name, did_you_mean(name, names),
             mission.name, fmt::join(names, ", "));
  return nullptr;
}

}  // namespace

int status(const StatusOptions& options) {
  const Connection& connection = options.connection;
  const auto place = find_ground_link("status", connection);
  if (!place) return place.error();
  const descriptor::Mission& mission = place->mission;
  const descriptor::SubsystemDescriptor* only = nullptr;
  if (!options.of.empty() && (only = find_named(mission, options.of)) == nullptr) return exit_usage;
  auto link = GroundConnection::open(place->host, place->port);
  if (!link) {
    fmt::print(stderr, "hirosco status: {}:{}: {}\n", place->host, place->port, link.error().text);
    print_end_without_keeper(place->keeper);
    return exit_environment;
  }
  Listened listened;
  const bool everything = options.all || connection.json || only != nullptr;
  const auto known = [&] { return terminal::heard_overview(mission, listened.values[mission.supervisor.id]); };
  if (!listen(mission, *link, listened, [&] { return !everything && known().has_value(); })) {
    fmt::print(stderr, "hirosco status: the ground link was closed\n");
    print_end_without_keeper(place->keeper);
    return exit_environment;
  }
  if (everything) {
    const auto print = connection.json ? print_newest_json : print_newest_text;
    for (const auto* member : mission.everybody())
      if (only == nullptr || only == member) print(*member, listened);
  }
  const auto overview = known();
  terminal::Judgement judged =
      overview ? terminal::judge(*overview)
               : terminal::Judgement{terminal::Verdict::NotWell,
                                     fmt::format("NOT WELL: {} answers, and its supervisor has told nothing for {} s",
                                                 mission.name, seconds(listening))};
  const bool astray = judged.verdict != terminal::Verdict::Well;
  if (misses_its_keeper(place->keeper)) terminal::miss_keeper(judged);
  const bool well = judged.verdict == terminal::Verdict::Well;
  if (connection.json) {
    const auto way_up = overview && astray ? terminal::way_up(*overview, mission) : std::vector<std::string>{};
    fmt::print("{}\n", json_line(terminal::verdict_json(mission.name, judged, way_up)));
  } else if (overview && only != nullptr) print_line(judged.line, "");
  else print_verdict(judged);
  if (!connection.json && overview && only == nullptr && astray) print_way_up(mission, *overview);
  return well ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
