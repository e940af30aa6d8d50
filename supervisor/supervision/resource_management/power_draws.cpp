// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/resource_management/power_draws.hpp"

#include <fmt/format.h>

#include <utility>

#include "supervisor/supervision/event_handling/reactions.hpp"

namespace hirosco::supervisor {

PowerDraws::PowerDraws(Craft& craft, OwnSubsystem& own, Reactions& reactions, const PowerLedger& ledger)
    : craft_{craft}, own_{own}, reactions_{reactions}, ledger_{ledger} {
  for (const descriptor::PowerDraw& draw : craft.mission.power_draws)
    watched_.push_back({&draw, MeasuredBudget{draw.measured}});
}

void PowerDraws::hear(std::uint16_t from, const pus::TelemetryView& report) {
  for (Watched& each : watched_) static_cast<void>(each.drawn.hear(from, report, craft_.now));
}

void PowerDraws::watch(TimePoint now) {
  for (Watched& each : watched_) judge(each, now);
}

void PowerDraws::judge(Watched& watched, TimePoint now) {
  const descriptor::PowerDraw& declared = *watched.declared;
  const Member* who = std::as_const(craft_).member(declared.measured.apid);
  if (who == nullptr || !who->alive()) watched.drawn.gone();
  watched.drawn.watch(now);
  const auto drawn_w = watched.drawn.watts();
  // What is not known is measured anew from its beginning, and what was told stays told.
  if (!drawn_w) return watched.since.reset();
  const double may_w = claimed_w(declared) + declared.beyond_w;
  if (*drawn_w <= may_w) {
    watched.since.reset();
    if (std::exchange(watched.told, false))
      craft_.tell(fmt::format("power: {} again no more than claimed, {} W: {}", names(declared), *drawn_w,
                              declared.measured.name),
                  declared.of.front());
    return;
  }
  if (!watched.since) watched.since = now;
  if (now - *watched.since < declared.longer_than || craft_.shutting_down || std::exchange(watched.told, true)) return;
  tell_excess(watched, *drawn_w, may_w);
}

void PowerDraws::tell_excess(const Watched& watched, double drawn_w, double may_w) {
  const descriptor::PowerDraw& declared = *watched.declared;
  craft_.tell(fmt::format("power: {} W are drawn by {}, {} W may be: {}", drawn_w, names(declared), may_w,
                          declared.measured.name),
              declared.of.front());
  for (const std::uint16_t apid : declared.of) {
    own_.announce("POWER_EXCEEDED", {static_cast<double>(apid), drawn_w, may_w});
    if (Member* subject = craft_.member(apid); subject != nullptr && subject->alive())
      reactions_.react(*subject, "POWER_EXCEEDED", descriptor::Severity::Low);
  }
}

double PowerDraws::claimed_w(const descriptor::PowerDraw& draw) const noexcept {
  double sum_w = 0;
  for (const std::uint16_t apid : draw.of) sum_w += ledger_.held_mw(apid) * 1e-3;
  return sum_w;
}

std::string PowerDraws::names(const descriptor::PowerDraw& draw) const {
  std::string text;
  for (const std::uint16_t apid : draw.of) text.append(text.empty() ? "" : ", ").append(craft_.name_of(apid));
  return text;
}

}  // namespace hirosco::supervisor
