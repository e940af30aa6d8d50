// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/missed_cycles.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ground/model/model.hpp"

namespace hirosco::ground {
namespace {

/// As the newest report before an instant has it, counted since the start.
[[nodiscard]] std::optional<std::uint32_t> missed_by(const Catalogue& catalogue, Archive& archive,
                                                     std::string_view subsystem, OnboardTime t) {
  const auto column = catalogue.supervisor_column("SUBSYSTEMS.MISSED");
  if (!column) return std::nullopt;
  for (const Report& report : catalogue.reports()) {
    if (report.apid != catalogue.mission().supervisor.id ||
        std::ranges::find(report.places, *column, &Place::column) == report.places.end())
      continue;
    const auto stored = archive.last_of(report.apid, report.sid, t);
    if (!stored) continue;
    const auto packet = pus::TelemetryView::parse(stored->octets);
    if (!packet) continue;
    Model past{catalogue};
    past.take(*packet);
    for (std::size_t i = 0; i < past.subsystems().size() && i < catalogue.subsystems().size(); ++i)
      if (catalogue.subsystems()[i]->name == subsystem && past.subsystems()[i].known)
        return past.subsystems()[i].missed;
  }
  return std::nullopt;
}

}  // namespace

std::uint32_t missed_around(const Catalogue& catalogue, Archive& archive, std::string_view subsystem, OnboardTime t) {
  const auto after = missed_by(catalogue, archive, subsystem, t + 500ms);
  const auto before = missed_by(catalogue, archive, subsystem, t - 1s);
  // One that was started anew counts from 0.
  return after && before && *after > *before ? *after - *before : 0;
}

std::string missed_words(std::string_view subsystem, std::uint32_t missed) {
  return fmt::format("{} missed {} cycles around it", subsystem, missed);
}

std::string advice_for_missed(std::string_view device, std::uint32_t missed, const std::optional<std::string>& up) {
  return fmt::format(
      "Less other work, or real-time rights (hirosco doctor), as {} cycles were missed; the device {} may be well.{}",
      missed, device, up ? " Then bring " + *up + " up." : "");
}

}  // namespace hirosco::ground
