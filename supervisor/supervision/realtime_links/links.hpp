// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "hirosco/data_transfer/memory.hpp"
#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/interfaces.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/realtime_links/link_handling.hpp"

namespace hirosco::supervisor {

/// The real-time links of the mission in a flight: LINK and UNLINK, the handshakes, and a look into the memory of the links
/// that are up. Thread: the supervisor's.
class Links final : public Watch, public Hearer, private LinkOperator {
 public:
  Links(Craft& craft, OwnSubsystem& own, CommandDesk& desk, LinkGraph& graph)
      : craft_{craft}, own_{own}, desk_{desk}, handling_{craft.mission, graph, craft.world.memory, *this} {}

  /// LINK and UNLINK.
  void provide();
  [[nodiscard]] const LinkGraph& graph() const noexcept { return handling_.graph(); }
  /// Memory of a link that is up; nullptr: it is not, or cannot be seen into.
  [[nodiscard]] const Mapping* memory_of(std::uint8_t link) const;
  /// A subsystem is gone without reporting: all its links are down.
  void forget(std::uint16_t apid) { handling_.forget(apid); }
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override { handling_.step(now); }

 private:
  void send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data, const MemoryHandle& memory) override;
  void link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) override;

  Craft& craft_;
  OwnSubsystem& own_;
  CommandDesk& desk_;
  LinkHandling handling_;
  std::map<std::uint8_t, Mapping> seen_;
};

}  // namespace hirosco::supervisor
