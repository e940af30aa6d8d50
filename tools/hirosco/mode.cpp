// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "hirosco/utilities/lower_case.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/preview.hpp"

namespace hirosco::tools {
namespace {

void print_modes(const descriptor::Mission& mission, std::FILE* to) {
  for (const auto& mode : mission.modes) {
    fmt::print(to, "  {}", mode.name);
    for (const auto& step : mode.commission)
      fmt::print(to, "{}{} {}", &step == mode.commission.data() ? ": " : ", ", step.subsystem, step.configuration);
    fmt::print(to, "\n");
  }
}

/// A line each, as `hirosco status` has its subsystems.
void print_modes_json(const descriptor::Mission& mission) {
  for (const auto& mode : mission.modes) {
    auto steps = nlohmann::ordered_json::array();
    for (const auto& step : mode.commission)
      steps.push_back(
          {{"subsystem", step.subsystem}, {"configuration", step.configuration}, {"state", to_text(step.state)}});
    fmt::print("{}\n", json_line({{"mode", mode.name}, {"number", mode.id}, {"commission", std::move(steps)}}));
  }
}

void print_preview(const pus::st129::ModePreview& preview, const descriptor::Mission& mission, const std::string& mode,
                   bool json) {
  const pus::PacketDescriber describer{mission};
  if (json) {
    fmt::print("{}\n", json_line({{"mode", mode},
                                  {"possible", preview.against.empty()},
                                  {"against", preview.against},
                                  {"steps", steps_json(preview.steps, describer)}}));
    return;
  }
  for (const std::string& why : preview.against) fmt::print("impossible: {}\n", why);
  if (!preview.against.empty()) return;
  if (preview.steps.empty()) fmt::print("nobody moves: what is permitted changes, nothing else\n");
  fmt::print("{}", steps_text(preview.steps, describer));
}

}  // namespace

int mode(const ModeOptions& options) {
  const auto place = find_ground_link("mode", options.connection);
  if (!place) return place.error();
  const descriptor::Mission& mission = place->mission;
  const auto wanted = std::ranges::find_if(
      mission.modes, [&](const descriptor::Mode& each) { return lower_case(each.name) == lower_case(options.name); });
  if (wanted == mission.modes.end()) {
    const bool asked = options.name.empty();
    if (!asked) fmt::print(stderr, "hirosco mode: no mode '{}'; the mission has\n", options.name);
    if (asked && options.connection.json) print_modes_json(mission);
    else print_modes(mission, asked ? stdout : stderr);
    return asked ? exit_ok : exit_usage;
  }
  if (!options.preview)
    return telecommand({.connection = options.connection,
                        .subsystem = mission.supervisor.name,
                        .function = "SET_MODE",
                        .arguments = {wanted->name},
                        .limit = options.limit});
  auto connection = GroundConnection::open(place->host, place->port);
  if (!connection) {
    fmt::print(stderr, "hirosco mode: {}:{}: {}\n", place->host, place->port, connection.error().text);
    return exit_environment;
  }
  const auto answer = ask(*connection,
                          {.supervisor = mission.supervisor.id,
                           .subtype = pus::st129::mode_question,
                           .data = {std::byte{wanted->id}},
                           .answer = pus::st129::mode_preview},
                          options.limit);
  const auto preview = answer ? pus::st129::read_mode_preview(*answer) : std::nullopt;
  if (!preview) {
    fmt::print(stderr, "hirosco mode: no answer within the limit\n");
    return exit_finding;
  }
  print_preview(*preview, mission, wanted->name, options.connection.json);
  return preview->against.empty() ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
