// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/modules.hpp"

#include "hirosco/subsystem/author/module.hpp"
#include "simulation/devices/module.hpp"

namespace hirosco::simulation {

Modules load_modules(const descriptor::Mission& mission) {
  Modules modules;
  for (const auto& member : mission.subsystems) {
    if (const auto loaded = load_subsystem(member.executable); loaded) modules.subsystems[member.executable] = **loaded;
    else modules.missing[member.executable] = loaded.error();
  }
  for (const auto& device : mission.devices) {
    if (const auto loaded = load_device(device.executable); loaded)
      modules.devices[device.executable] = (*loaded)->make;
    else modules.missing[device.executable] = loaded.error();
  }
  return modules;
}

std::vector<Mistake> try_introduction(Subsystem& author, const descriptor::SubsystemDescriptor& described) {
  const ManualClock clock;
  HeapMemory memory;
  LocalFlows flows;
  ChannelPair channels;
  VitalPage vital{};
  const PermitPage permit{};
  const Platform platform{.clock = clock, .memory = memory, .flows = flows, .explain = {}};
  return GenericSubsystem{author, described, platform, channels.subsystem_end(), vital, permit}.try_introduction();
}

}  // namespace hirosco::simulation
