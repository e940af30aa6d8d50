// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/replies.hpp"

#include <fmt/format.h>

namespace hirosco::supervisor {

Replies::Replies(Craft& craft, Unanswered& unanswered)
    : craft_{craft},
      unanswered_{unanswered},
      deliveries_{craft, [&craft](const Member& member, std::uint32_t lost) {
                    craft.tell(fmt::format("{} does not read what it asked for: {} reports lost",
                                           member.descriptor().name, lost),
                               member.apid());
                  }} {}

void Replies::hear(std::uint16_t from, const pus::TelemetryView& report) {
  const std::uint16_t to = report.destination();
  if (to == 0 || to == supervisor_apid || to == from) return;
  const Member* asker = craft_.member(to);
  if (asker == nullptr || !asker->alive() || craft_.is_ground_link(*asker)) return;  // that has all reports anyway
  if (from != supervisor_apid && !unanswered_.answers(report)) return;
  deliveries_.give(*asker, report.packet());
}

}  // namespace hirosco::supervisor
