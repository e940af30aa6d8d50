// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/data_handling/persistent_values/found_values.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace hirosco::supervisor {

void FoundValues::taken(std::uint16_t apid, std::size_t values, OnboardTime since) {
  // The event has seconds in 32 bits.
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since.time_since_epoch()).count();
  news_.push_back(
      {"VALUES_TAKEN", {static_cast<double>(apid), static_cast<double>(values), static_cast<double>(seconds)}});
}

void FoundValues::refused(std::uint16_t apid, std::size_t copy, CopyFault fault) {
  craft_.tell(fmt::format("copy {} of {}'s stored values is not used: {}", copy, craft_.name_of(apid), to_text(fault)),
              apid);
  news_.push_back(
      {"VALUES_REFUSED", {static_cast<double>(apid), static_cast<double>(copy), static_cast<double>(fault)}});
}

void FoundValues::tell(TimePoint now) {
  if (news_.empty()) return;
  const Member* link = craft_.ground_link();
  const bool heard = link == nullptr || (link->alive() && link->state() == descriptor::State::Operational);
  if (!heard && now - begun_ < patience) return;
  for (const auto& [event, arguments] : std::exchange(news_, {}))
    own_.announce(event, {arguments[0], arguments[1], arguments[2]});
}

}  // namespace hirosco::supervisor
