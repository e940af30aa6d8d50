// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <map>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/ground_connection.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
namespace {

/// Long enough for every structure of the shipped missions to come once.
constexpr Duration listening = 1500ms;

struct Listened {
  std::map<std::uint16_t, std::map<std::string, pus::HousekeepingValue>> values;
  std::map<std::uint16_t, std::size_t> packets;
};

void print_text(const descriptor::Subsystem& subsystem, Listened& listened) {
  fmt::print("{} (APID {}): {} packets in {} s\n", subsystem.name, subsystem.id, listened.packets[subsystem.id],
             seconds(listening));
  for (const auto& [name, value] : listened.values[subsystem.id]) {
    fmt::print("  {:<28}", name);
    for (const std::string& text : value.texts()) fmt::print(" {:>12}", text);
    fmt::print(" {}\n", value.unit);
  }
}

void print_json(const descriptor::Subsystem& subsystem, Listened& listened) {
  fmt::print("{{\"subsystem\":\"{}\",\"apid\":{},\"packets\":{},\"values\":{{", subsystem.name, subsystem.id,
             listened.packets[subsystem.id]);
  bool first = true;
  for (const auto& [name, value] : listened.values[subsystem.id]) {
    fmt::print("{}\"{}\":{}", first ? "" : ",", name, value.json());
    first = false;
  }
  fmt::print("}}}}\n");
}

}  // namespace

int status(const Connection& connection) {
  const auto place = find_ground_link("status", connection);
  if (!place) return place.error();
  const descriptor::Mission& mission = place->mission;
  auto link = GroundConnection::open(place->host, place->port);
  if (!link) {
    fmt::print(stderr, "hirosco status: {}:{}: {}\n", place->host, place->port, link.error().text);
    return exit_environment;
  }
  std::map<std::uint16_t, pus::HousekeepingDecoder> decoders;
  decoders.emplace(mission.supervisor.id, pus::HousekeepingDecoder{mission.supervisor});
  for (const auto& member : mission.subsystems)
    decoders.emplace(member.subsystem.id, pus::HousekeepingDecoder{member.subsystem});
  Listened listened;
  const auto end = std::chrono::steady_clock::now() + listening;
  while (std::chrono::steady_clock::now() < end) {
    const auto left = std::chrono::duration_cast<Duration>(end - std::chrono::steady_clock::now());
    const auto packet = link->receive(std::max(left, Duration{0}));
    if (!packet) return exit_environment;
    if (!*packet) break;
    const auto report = pus::TelemetryView::parse(**packet);
    if (!report) continue;
    ++listened.packets[report->apid()];
    const auto decoder = decoders.find(report->apid());
    if (report->service() != 3 || report->subtype() != 25 || decoder == decoders.end()) continue;
    if (const auto values = decoder->second.decode(report->source_data()))
      for (const auto& value : *values) listened.values[report->apid()][value.name] = value;
  }
  const auto print = connection.json ? print_json : print_text;
  print(mission.supervisor, listened);
  for (const auto& member : mission.subsystems) print(member.subsystem, listened);
  return exit_ok;
}

}  // namespace hirosco::tools
