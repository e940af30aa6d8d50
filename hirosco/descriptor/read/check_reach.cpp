// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "hirosco/data_transfer/device/flow_access.hpp"
#include "hirosco/descriptor/model/common_link_way.hpp"
#include "hirosco/descriptor/model/member_reach.hpp"
#include "hirosco/descriptor/read/detail/mission_link_reader.hpp"
#include "hirosco/descriptor/read/detail/mission_parts.hpp"

/// How each subsystem's links may travel, and that nobody's sandbox lets it in where the supervisor's side holds an endnode (docs/adr/0150, 0175).
namespace hirosco::descriptor::detail {
namespace {

void note_method(LinkMethod method, MissionSubsystem& member) {
  auto& known = member.link_methods;
  if (std::ranges::find(known, method) == known.end()) known.push_back(method);
}

void note_methods(const MissionLink& link, const SubsystemDescriptor& producer, const SubsystemDescriptor& consumer,
                  MissionSubsystem& member) {
  if (link.method) return note_method(*link.method, member);
  for (const Configuration& one : producer.configurations)
    for (const Provides& provides : one.provides)
      for (const Configuration& other : consumer.configurations)
        for (const Requires& requires_ : other.requires_) {
          if (provides.name != link.provides || requires_.name != link.requires_) continue;
          const auto way = first_common_way(provides.terms, requires_.terms, requires_.starts, carried_here);
          if (way) note_method(way->method, member);
        }
}

/// As far as the files of a mission tell: an instance of the flight is in all addresses or in none.
[[nodiscard]] Sandbox reach_of(const MissionSubsystem& member) {
  Sandbox sandbox;
  let_in_links(member, sandbox);
  for (const FlowAddress& flow : flows_of(member.subsystem)) let_in(flow, "", sandbox);
  return sandbox;
}

}  // namespace

void note_sockets(Mission& mission) {
  for (MissionSubsystem& member : mission.subsystems) {
    const auto& name = member.subsystem.name;
    member.carries_ground = name == mission.ground.subsystem;
    for (const MissionLink& link : mission.links) {
      if (link.from != name && link.to != name) continue;
      const auto *producer = mission.find_subsystem(link.from), *consumer = mission.find_subsystem(link.to);
      if (producer != nullptr && consumer != nullptr)
        note_methods(link, producer->subsystem, consumer->subsystem, member);
    }
  }
}

void check_reach(MissionDraft& draft) {
  std::vector<Sandbox> reaches;
  for (const MissionSubsystem& member : draft.mission.subsystems) reaches.push_back(reach_of(member));
  for (const MissionSubsystem& owner : draft.mission.subsystems) {
    Problems problems{owner.subsystem.file};
    const auto check = [&](const Endnode& held, const std::string& what) {
      const FlowAddress flow{held.transfer, held.address, held.framing, FlowHolder::Supervisor};
      const auto reach = std::ranges::find_if(reaches, [&](const Sandbox& any) { return is_reached(flow, any); });
      if (reach == reaches.end()) return;
      const MissionSubsystem& other = draft.mission.subsystems[static_cast<std::size_t>(reach - reaches.begin())];
      problems.add(held.at, "E0349",
                   fmt::format("{} is reached by {}, and the sandbox of '{}' lets that in", what,
                               to_text(held.transfer), other.subsystem.name),
                   "transfer=\"shared_memory\", where no sandbox lets anybody in, one that no subsystem has (\"unix\" "
                   "beside frames by udp), or a device beyond this computer",
                   8);
    };
    const auto check_all = [&](const Endnode& held, const HeldTerms& terms, const std::string& what) {
      check(held, what);
      for (const Endnode& other : terms.fall_backs) check(other, what);
    };
    for (const Device& device : owner.subsystem.devices)
      if (device.enable)
        check_all(*device.enable, device.enable_terms, fmt::format("the second inhibit of '{}'", device.name));
    for (const PowerSwitch& power : owner.subsystem.power_switches)
      check_all(power.endnode, power.terms, fmt::format("the power switch of '{}'", power.device));
    if (problems.count() != 0) draft.subsystem_problems.push_back(problems.take());
  }
}

}  // namespace hirosco::descriptor::detail
