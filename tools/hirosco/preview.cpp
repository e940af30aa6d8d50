// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/preview.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <nlohmann/json.hpp>

#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::tools {

std::optional<std::vector<std::byte>> ask(GroundConnection& connection, const Question& question, Duration limit) {
  using Clock = std::chrono::steady_clock;
  const auto source = static_cast<std::uint16_t>(0x4000 | (::getpid() & 0x3FFF));
  std::array<std::byte, pus::max_telecommand_octets> buffer;
  const auto packet = pus::write_telecommand(buffer,
                                             {.apid = question.supervisor,
                                              .ack = pus::ack_all,
                                              .service = pus::st129::service_type,
                                              .subtype = question.subtype,
                                              .source = source},
                                             question.data);
  if (!packet || !connection.send(*packet)) return std::nullopt;
  for (const auto begin = Clock::now();;) {
    const auto left = std::chrono::duration_cast<Duration>(limit - (Clock::now() - begin));
    const auto received = connection.receive(std::max(left, Duration{0}));
    if (!received || !*received) return std::nullopt;
    const auto report = pus::TelemetryView::parse(**received);
    if (!report || report->destination() != source) continue;
    const Octets data = report->source_data();
    if (report->service() == pus::st129::service_type && report->subtype() == question.answer)
      return std::vector<std::byte>{data.begin(), data.end()};
    // Of ST[01], an even one: refused.
    if (report->service() == 1 && report->subtype() % 2 == 0) return std::nullopt;
  }
}

nlohmann::ordered_json steps_json(const std::vector<pus::st129::ModePreview::Step>& steps,
                                  const pus::PacketDescriber& describer) {
  auto all = nlohmann::ordered_json::array();
  for (const auto& step : steps)
    all.push_back({{"stage", step.stage}, {"subsystem", describer.name_of(step.subject)}, {"what", step.what}});
  return all;
}

std::string steps_text(const std::vector<pus::st129::ModePreview::Step>& steps, const pus::PacketDescriber& describer) {
  std::string text;
  unsigned stage = 0;
  for (const auto& step : steps) {
    if (step.stage == stage) text += ", ";
    else text += fmt::format("{}{:3}  ", stage == 0 ? "" : "\n", step.stage);
    stage = step.stage;
    text += fmt::format("{} {}", describer.name_of(step.subject), step.what);
  }
  return text.empty() ? text : text + "\n";
}

}  // namespace hirosco::tools
