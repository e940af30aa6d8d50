// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/craft.hpp"

#include <algorithm>

namespace hirosco::supervisor {

Craft::Craft(const descriptor::Mission& described, const Platform& outside, ProcessLauncher& processes, Guard& watcher,
             PacketLog& packets, Observer& who)
    : mission{described},
      platform{outside},
      launcher{processes},
      guard{watcher},
      log{packets},
      observer{who},
      mode{mission.find_mode(mission.initial_mode)} {
  members.reserve(mission.subsystems.size());
  for (const auto& subsystem : mission.subsystems) members.emplace_back(subsystem);
}

Member* Craft::member(std::uint16_t apid) {
  const auto found = std::ranges::find(members, apid, &Member::apid);
  return found != members.end() ? &*found : nullptr;
}

const Member* Craft::member(std::uint16_t apid) const {
  const auto found = std::ranges::find(members, apid, &Member::apid);
  return found != members.end() ? &*found : nullptr;
}

bool Craft::is_ground_link(const Member& subject) const {
  return subject.descriptor().name == mission.ground.subsystem;
}

Member* Craft::ground_link() {
  const auto found = std::ranges::find_if(members, [&](const Member& subject) { return is_ground_link(subject); });
  return found != members.end() ? &*found : nullptr;
}

std::string Craft::name_of(std::uint16_t apid) const {
  const auto* found = mission.find_member(apid);
  return found != nullptr ? found->name : "APID " + std::to_string(apid);
}

void Craft::tell(std::string_view line, std::uint16_t subject) {
  static_cast<void>(log.append(
      {.kind = LogKind::Action, .source = mission.supervisor.id, .peer = subject, .packet = {}, .note = line}));
  observer.told(platform.clock.onboard(), line);
}

}  // namespace hirosco::supervisor
