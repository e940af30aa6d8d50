// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "hirosco/descriptor/read/detail/mission_parts.hpp"

/// Which sockets a subsystem needs beside those of its devices, and that nobody's sandbox lets it in where the supervisor's side holds
/// an endnode (docs/adr/0150).
namespace hirosco::descriptor::detail {
namespace {

/// The first method that both have, in the producer's order, is UDP.
[[nodiscard]] bool agree_on_udp(const Provides& provides, const Requires& requires_) {
  for (const LinkMethod method : provides.terms.methods)
    if (std::ranges::find(requires_.terms.methods, method) != requires_.terms.methods.end())
      return method == LinkMethod::Udp;
  return false;
}

[[nodiscard]] bool may_be_udp(const MissionLink& link, const SubsystemDescriptor& producer,
                              const SubsystemDescriptor& consumer) {
  if (link.method) return *link.method == LinkMethod::Udp;
  for (const Configuration& one : producer.configurations)
    for (const Provides& provides : one.provides)
      for (const Configuration& other : consumer.configurations)
        for (const Requires& requires_ : other.requires_)
          if (provides.name == link.provides && requires_.name == link.requires_ && agree_on_udp(provides, requires_))
            return true;
  return false;
}

[[nodiscard]] std::string_view line_of(std::string_view address) { return address.substr(0, address.rfind('@')); }
[[nodiscard]] bool is_named(std::string_view address) { return !address.starts_with('/'); }

/// What a sandbox lets its subsystem in for beside this endnode of its own (subsystem_sandbox.cpp).
[[nodiscard]] bool reaches(const Endnode& own, const Endnode& held) {
  const auto there = read_device_address(held.address);
  switch (held.transfer) {
    case Transfer::Unix:
    case Transfer::MessageQueue: return own.transfer == held.transfer;
    case Transfer::Serial:
      return own.transfer == held.transfer &&
             (line_of(own.address) == line_of(held.address) || (is_named(own.address) && is_named(held.address)));
    case Transfer::Udp: {
      if (!there || !there->loopback()) return false;
      const auto here = read_device_address(own.address);
      return own.transfer == held.transfer || (own.transfer == Transfer::Tcp && here && !here->loopback());
    }
    case Transfer::Tcp: {
      const auto here = read_device_address(own.address);
      return own.transfer == held.transfer && there && there->loopback() && here && here->port == there->port;
    }
    case Transfer::SharedMemory:
      return false;  // what the supervisor's side holds lies where nobody is let in
    // Of a means that nothing is known of here: who has a device by it may reach another by it.
    default: return own.transfer == held.transfer;
  }
}

[[nodiscard]] bool reaches(const MissionSubsystem& member, const Endnode& held) {
  const auto there = read_device_address(held.address);
  const bool here = there && there->loopback();
  if (held.transfer == Transfer::Udp && here && (member.carries_ground || member.links_by_udp)) return true;
  if (held.transfer == Transfer::Tcp && here && member.carries_ground) return true;
  return std::ranges::any_of(member.subsystem.configurations, [&](const Configuration& configuration) {
    return std::ranges::any_of(configuration.devices, [&](const DeviceUse& use) {
      const auto one = [&](const Endnode& own) { return reaches(own, held); };
      return one(use.endnode) || std::ranges::any_of(use.fall_backs, one);
    });
  });
}

}  // namespace

void note_sockets(Mission& mission) {
  for (MissionSubsystem& member : mission.subsystems) {
    const auto& name = member.subsystem.name;
    member.carries_ground = name == mission.ground.subsystem;
    for (const MissionLink& link : mission.links) {
      if (link.from != name && link.to != name) continue;
      const auto *producer = mission.find_subsystem(link.from), *consumer = mission.find_subsystem(link.to);
      if (producer != nullptr && consumer != nullptr && may_be_udp(link, producer->subsystem, consumer->subsystem))
        member.links_by_udp = true;
    }
  }
}

void check_reach(MissionDraft& draft) {
  for (const MissionSubsystem& owner : draft.mission.subsystems) {
    Problems problems{owner.subsystem.file};
    const auto check = [&](const Endnode& held, const std::string& what) {
      const auto other =
          std::ranges::find_if(draft.mission.subsystems, [&](const auto& any) { return reaches(any, held); });
      if (other == draft.mission.subsystems.end()) return;
      problems.add(held.at, "E0349",
                   fmt::format("{} is reached by {}, and the sandbox of '{}' lets that in", what,
                               to_text(held.transfer), other->subsystem.name),
                   "transfer=\"shared_memory\", where no sandbox lets anybody in, one that no subsystem has (\"unix\" "
                   "beside frames by udp), or a device beyond this computer",
                   8);
    };
    for (const Device& device : owner.subsystem.devices)
      if (device.enable) check(*device.enable, fmt::format("the second inhibit of '{}'", device.name));
    for (const PowerSwitch& power : owner.subsystem.power_switches)
      check(power.endnode, fmt::format("the power switch of '{}'", power.device));
    if (problems.count() != 0) draft.subsystem_problems.push_back(problems.take());
  }
}

}  // namespace hirosco::descriptor::detail
