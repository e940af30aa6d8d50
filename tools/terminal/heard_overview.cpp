// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/heard_overview.hpp"

#include <algorithm>
#include <cmath>

namespace hirosco::terminal {
namespace {

/// Element `i` of a parameter as a whole number; empty: not told.
[[nodiscard]] std::optional<std::uint64_t> told(const HeardValues& values, const std::string& name, std::size_t i) {
  const auto found = values.find(name);
  if (found == values.end() || i >= found->second.values.size()) return std::nullopt;
  const double number = found->second.values[i];
  constexpr double beyond = 18'446'744'073'709'551'616.0;
  if (!(number >= 0) || number >= beyond) return std::nullopt;
  return static_cast<std::uint64_t>(number);
}

void take_row(const descriptor::Mission& mission, const HeardValues& values, std::size_t i, std::uint64_t apid,
              supervisor::Overview& overview) {
  const auto* described = mission.find_subsystem(static_cast<std::uint16_t>(apid));
  if (described == nullptr) return;
  const auto member =
      std::ranges::find(overview.members, described->subsystem.name, &supervisor::Overview::Member::name);
  if (member == overview.members.end()) return;
  const auto column = [&](const char* name) { return told(values, std::string{"SUBSYSTEMS."} + name, i).value_or(0); };
  const std::uint64_t state = told(values, "SUBSYSTEMS.STATE", i).value_or(255);
  member->runs = state <= static_cast<std::uint64_t>(descriptor::State::SoftwareDeinit);
  if (!member->runs) return;
  member->state = to_text(static_cast<descriptor::State>(state));
  member->counted = true;
  member->realtime = true;
  member->inhibited = static_cast<std::uint32_t>(column("INHIBITED"));
  member->cycles = column("CYCLES");
  member->overruns = column("OVERRUNS");
  member->missed = column("MISSED");
  member->latency_max_ns = static_cast<std::uint32_t>(column("LATENCY_MAX"));
  member->execution_mean_ns = static_cast<std::uint32_t>(column("EXECUTION_MEAN"));
  const auto* configuration =
      described->subsystem.find_configuration(static_cast<std::uint8_t>(column("CONFIGURATION")));
  if (configuration == nullptr) return;
  member->cycling = true;
  member->period_ns = static_cast<std::uint64_t>(configuration->sampling.count());
}

}  // namespace

std::optional<supervisor::Overview> heard_overview(const descriptor::Mission& mission, const HeardValues& supervisor) {
  const auto number = told(supervisor, "MODE", 0);
  if (!number || !supervisor.contains("SUBSYSTEMS.APID") || !supervisor.contains("LINK_STATUS.LINK"))
    return std::nullopt;
  const auto mode = std::ranges::find(mission.modes, static_cast<std::uint8_t>(*number), &descriptor::Mode::id);
  if (mode == mission.modes.end()) return std::nullopt;
  supervisor::Overview overview = supervisor::blank_overview(mission, *mode);
  for (std::size_t i = 0; const auto apid = told(supervisor, "SUBSYSTEMS.APID", i); ++i)
    if (*apid != 0) take_row(mission, supervisor, i, *apid, overview);
  for (std::size_t i = 0; const auto id = told(supervisor, "LINK_STATUS.LINK", i); ++i) {
    const auto link =
        std::ranges::find(overview.links, static_cast<std::uint8_t>(*id), &supervisor::Overview::Link::id);
    if (link != overview.links.end()) link->up = told(supervisor, "LINK_STATUS.IS_UP", i).value_or(0) != 0;
  }
  return overview;
}

}  // namespace hirosco::terminal
