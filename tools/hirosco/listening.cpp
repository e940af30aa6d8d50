// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/listening.hpp"

#include <algorithm>
#include <chrono>

#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"

namespace hirosco::tools {

bool listen(const descriptor::Mission& mission, GroundConnection& link, Listened& listened,
            const std::function<bool()>& enough) {
  std::map<std::uint16_t, pus::HousekeepingDecoder> decoders;
  for (const auto* member : mission.everybody()) decoders.emplace(member->id, pus::HousekeepingDecoder{*member});
  const auto end = std::chrono::steady_clock::now() + listening;
  while (std::chrono::steady_clock::now() < end && !enough()) {
    const auto left = std::chrono::duration_cast<Duration>(end - std::chrono::steady_clock::now());
    const auto packet = link.receive(std::max(left, Duration{0}));
    if (!packet) return false;
    if (!*packet) break;
    const auto report = pus::TelemetryView::parse(**packet);
    if (!report) continue;
    ++listened.packets[report->apid()];
    const auto decoder = decoders.find(report->apid());
    if (report->service() != 3 || report->subtype() != 25 || decoder == decoders.end()) continue;
    if (const auto values = decoder->second.decode(report->source_data())) {
      listened.at[report->apid()] = report->time();
      for (const auto& value : *values) listened.values[report->apid()][value.name] = value;
    }
  }
  return true;
}

}  // namespace hirosco::tools
