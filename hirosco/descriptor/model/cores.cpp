// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/cores.hpp"

#include <algorithm>

namespace hirosco::descriptor {
namespace {

[[nodiscard]] double& share_of(std::vector<CoreShare>& shares, std::optional<std::uint16_t> core) {
  const auto at = std::ranges::lower_bound(shares, core, {}, &CoreShare::core);
  return at != shares.end() && at->core == core ? at->share : shares.insert(at, {core, 0})->share;
}

}  // namespace

std::optional<std::uint16_t> core_of(const Mission& mission, const MissionSubsystem& member) noexcept {
  return member.cores.cycle ? member.cores.cycle : mission.shared_core;
}

std::string core_words(std::optional<std::uint16_t> core) {
  return core ? "core " + std::to_string(*core) : "the core of all who name none";
}

std::vector<std::uint16_t> lone_cores(const Mission& mission) {
  std::vector<std::uint16_t> cores;
  for (const MissionSubsystem& member : mission.subsystems)
    if (member.cores.alone && member.cores.cycle) cores.push_back(*member.cores.cycle);
  std::ranges::sort(cores);
  return cores;
}

bool names_cores(const Mission& mission) noexcept {
  return std::ranges::any_of(mission.subsystems,
                             [](const MissionSubsystem& member) { return member.cores.cycle.has_value(); }) ||
         std::ranges::any_of(mission.devices, [](const SimulatedDevice& device) { return device.core.has_value(); });
}

std::vector<CoreShare> core_shares(const Mission& mission, const Mode& mode) {
  std::vector<CoreShare> shares;
  for (const MissionSubsystem& member : mission.subsystems) {
    const SubsystemDescriptor& subsystem = member.subsystem;
    const auto step = std::ranges::find(mode.commission, subsystem.name, &CommissionStep::subsystem);
    const double share = cycle_share(
        subsystem, step == mode.commission.end() ? nullptr : subsystem.find_configuration(step->configuration));
    share_of(shares, core_of(mission, member)) += share;
  }
  return shares;
}

std::vector<CoreShare> core_shares(const Mission& mission) {
  std::vector<CoreShare> greatest;
  for (const Mode& mode : mission.modes)
    for (const auto& [core, share] : core_shares(mission, mode)) {
      double& most = share_of(greatest, core);
      most = std::max(most, share);
    }
  return greatest;
}

double cycle_share(const Mission& mission, const Mode& mode) {
  double most = 0;
  for (const CoreShare& each : core_shares(mission, mode)) most = std::max(most, each.share);
  return most;
}

double cycle_share(const Mission& mission) {
  double share = 0;
  for (const Mode& mode : mission.modes) share = std::max(share, cycle_share(mission, mode));
  return share;
}

}  // namespace hirosco::descriptor
