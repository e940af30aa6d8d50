// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/member_reach.hpp"

#include <algorithm>

#include "hirosco/data_transfer/link/link.hpp"

namespace hirosco::descriptor {

std::vector<FlowAddress> flows_of(const SubsystemDescriptor& subsystem) {
  std::vector<FlowAddress> flows;
  const auto add = [&](const Endnode& endnode) {
    flows.push_back({endnode.transfer, endnode.address, endnode.framing});
  };
  for (const Configuration& configuration : subsystem.configurations)
    for (const DeviceUse& use : configuration.devices) {
      add(use.endnode);
      std::ranges::for_each(use.fall_backs, add);
    }
  return flows;
}

void let_in_links(const MissionSubsystem& member, Sandbox& sandbox) {
  for (const LinkMechanism* mechanism : standard_link_mechanisms())
    if (std::ranges::find(member.link_methods, mechanism->method()) != member.link_methods.end())
      mechanism->let_in(sandbox);
  if (!member.carries_ground) return;
  sandbox.sockets.datagrams = true;
  sandbox.sockets.streams = true;
}

}  // namespace hirosco::descriptor
