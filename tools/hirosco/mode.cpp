// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st129_supervision/supervision.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/ground_connection.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
namespace {

using Clock = std::chrono::steady_clock;

void print_modes(const descriptor::Mission& mission, std::FILE* to) {
  for (const auto& mode : mission.modes) {
    fmt::print(to, "  {}", mode.name);
    for (const auto& step : mode.commission)
      fmt::print(to, "{}{} {}", &step == mode.commission.data() ? ": " : ", ", step.subsystem, step.configuration);
    fmt::print(to, "\n");
  }
}

void print_preview(const pus::st129::ModePreview& preview, const descriptor::Mission& mission, const std::string& mode,
                   bool json) {
  const pus::PacketDescriber describer{mission};
  if (json) {
    fmt::print("{{\"mode\":\"{}\",\"possible\":{},\"against\":[", mode, preview.against.empty());
    for (std::size_t i = 0; i < preview.against.size(); ++i)
      fmt::print("{}\"{}\"", i == 0 ? "" : ",", json_text(preview.against[i]));
    fmt::print("],\"steps\":[");
    for (std::size_t i = 0; i < preview.steps.size(); ++i) {
      const auto& step = preview.steps[i];
      fmt::print("{}{{\"stage\":{},\"subsystem\":\"{}\",\"what\":\"{}\"}}", i == 0 ? "" : ",", step.stage,
                 describer.name_of(step.subject), json_text(step.what));
    }
    fmt::print("]}}\n");
    return;
  }
  for (const std::string& why : preview.against) fmt::print("impossible: {}\n", why);
  if (!preview.against.empty()) return;
  if (preview.steps.empty()) fmt::print("nobody moves: what is permitted changes, nothing else\n");
  unsigned stage = 0;
  for (const auto& step : preview.steps) {
    if (step.stage == stage) fmt::print(", ");
    else fmt::print("{}{:3}  ", stage == 0 ? "" : "\n", step.stage);
    stage = step.stage;
    fmt::print("{} {}", describer.name_of(step.subject), step.what);
  }
  if (stage != 0) fmt::print("\n");
}

/// The answer to TC[129,4]; nothing when none comes in time.
[[nodiscard]] std::optional<pus::st129::ModePreview> ask(GroundConnection& connection, std::uint16_t supervisor,
                                                         std::uint8_t mode, Duration limit) {
  const auto source = static_cast<std::uint16_t>(0x4000 | (::getpid() & 0x3FFF));
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const std::array data{std::byte{mode}};
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = supervisor,
                                              .ack = pus::ack_all,
                                              .service = pus::st129::service_type,
                                              .subtype = pus::st129::mode_question,
                                              .source = source},
                                             data);
  if (!packet || !connection.send(*packet)) return std::nullopt;
  for (const auto begin = Clock::now();;) {
    const auto left = std::chrono::duration_cast<Duration>(limit - (Clock::now() - begin));
    const auto received = connection.receive(std::max(left, Duration{0}));
    if (!received || !*received) return std::nullopt;
    const auto report = pus::TelemetryView::parse(**received);
    if (!report || report->destination() != source || report->service() != pus::st129::service_type) continue;
    if (report->subtype() == pus::st129::mode_preview) return pus::st129::read_mode_preview(report->source_data());
  }
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
    print_modes(mission, asked ? stdout : stderr);
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
  const auto preview = ask(*connection, mission.supervisor.id, wanted->id, options.limit);
  if (!preview) {
    fmt::print(stderr, "hirosco mode: no answer within the limit\n");
    return exit_finding;
  }
  print_preview(*preview, mission, wanted->name, options.connection.json);
  return preview->against.empty() ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
