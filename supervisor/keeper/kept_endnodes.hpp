// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/data_transfer/device/data_flow.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "supervisor/keeper/kept.hpp"

namespace hirosco::supervisor {

/// Of a second inhibit or a power switch, which the supervisor's side holds.
[[nodiscard]] inline FlowAddress held_address(const descriptor::Endnode& endnode) {
  return {.transfer = endnode.transfer, .address = endnode.address, .holder = FlowHolder::Supervisor};
}

/// One way to the second inhibit of one device of the mission.
struct KeptEndnode {
  std::uint16_t apid{0};
  std::string device;
  FlowAddress address;
  std::size_t way{0};  ///< 0: the preferred one, then the fall-backs in their order
};

/// All of them, in one order for keeper and supervisor, fall-backs behind what is preferred; those beyond `most_inhibits` are not kept: they end with
/// the supervisor.
[[nodiscard]] inline std::vector<KeptEndnode> kept_endnodes(const descriptor::Mission& mission) {
  std::vector<KeptEndnode> found;
  for (const auto& subsystem : mission.subsystems)
    for (const auto& device : subsystem.subsystem.devices)
      if (device.enable) found.push_back({subsystem.subsystem.id, device.name, held_address(*device.enable)});
  for (const auto& subsystem : mission.subsystems)
    for (const auto& device : subsystem.subsystem.devices)
      for (std::size_t way = 0; device.enable && way < device.enable_terms.fall_backs.size(); ++way)
        found.push_back(
            {subsystem.subsystem.id, device.name, held_address(device.enable_terms.fall_backs[way]), way + 1});
  if (found.size() > most_inhibits) found.resize(most_inhibits);
  return found;
}

/// Where the guard notes what it tells this device.
class InhibitNotes {
 public:
  InhibitNotes() = default;
  InhibitNotes(const descriptor::Mission& mission, KeeperPage& page)
      : endnodes_{kept_endnodes(mission)}, page_{&page} {}
  /// Null: nobody would go on telling it.
  [[nodiscard]] KeptInhibit* of(std::uint16_t apid, std::string_view device, std::size_t way = 0) const noexcept {
    const auto meant = [&](const KeptEndnode& each) {
      return each.apid == apid && each.device == device && each.way == way;
    };
    for (std::size_t i = 0; page_ != nullptr && i < endnodes_.size(); ++i)
      if (meant(endnodes_[i])) return &page_->inhibits[i];
    return nullptr;
  }

 private:
  std::vector<KeptEndnode> endnodes_;
  KeeperPage* page_{nullptr};
};

}  // namespace hirosco::supervisor
