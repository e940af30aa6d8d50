// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "hirosco/data_transfer/memory/memory.hpp"
#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/realtime_links/link_handshakes.hpp"
#include "supervisor/supervision/realtime_links/link_renewals.hpp"
#include "supervisor/supervision/succession/journal.hpp"
#include "supervisor/supervision/watch_and_hear.hpp"

namespace hirosco::supervisor {

/// The real-time links of the mission in a flight: LINK and UNLINK, the handshakes, those that are negotiated anew, and a look at the links
/// that are up. Thread: the supervisor's.
class LinkCommands final : public Watch, public Hearer, public Remembered, private LinkOperator {
 public:
  LinkCommands(Craft& craft, OwnSubsystem& own, CommandDesk& desk, LinkGraph& graph)
      : craft_{craft},
        own_{own},
        desk_{desk},
        graph_{graph},
        handshakes_{craft.mission, graph, craft.platform.memory, craft.platform.links, *this} {}

  /// LINK and UNLINK.
  void provide();
  [[nodiscard]] const LinkGraph& graph() const noexcept { return handshakes_.graph(); }
  /// How a link does. Empty: it is not up, nothing was produced yet, or it cannot be seen.
  [[nodiscard]] std::optional<LinkGlance> glance(std::uint8_t link) const noexcept { return handshakes_.glance(link); }
  /// Whether a link that is up can be looked at from here.
  [[nodiscard]] bool can_look(std::uint8_t link) const noexcept { return handshakes_.can_look(link); }
  /// A subsystem is gone without reporting: all its links are down.
  void forget(std::uint16_t apid);
  void hear(std::uint16_t from, const pus::TelemetryView& report) override;
  void watch(TimePoint now) override;
  /// Handshakes and releases that the supervisor before had begun end.
  void end_what_was_begun();
  /// Which links are up, who holds them, and which are in between.
  void note(OctetWriter& writer) const override;
  void recall(OctetReader& reader) override;

 private:
  void send_link_command(std::uint16_t apid, std::uint8_t subtype, Octets data, const MemoryHandle& memory) override;
  void link_changed(const descriptor::MissionLink& link, bool up, const std::string& text) override;
  /// Whether this end of a link that was up has left it, whatever it says.
  [[nodiscard]] bool has_left(std::uint16_t apid, std::uint8_t link) const;

  void renew();
  /// The handshake of a link that an end has left; whoever commands LINK meanwhile is told of its end.
  void renew(std::uint8_t link);
  void renewed(std::uint8_t link, bool success);
  void take_back(std::uint8_t link);
  [[nodiscard]] LinkRenewals::End end_of(const std::string& name) const;

  Craft& craft_;
  OwnSubsystem& own_;
  CommandDesk& desk_;
  LinkGraph& graph_;
  LinkHandshakes handshakes_;
  LinkRenewals renewals_;
  std::map<std::uint8_t, std::vector<Call>> renewing_;  ///< handshakes of ours, and who waits for them
  std::set<std::uint8_t> renewed_;  ///< up again without anybody's command: LINK has nothing to do
  /// In force at an end when its link came up, by link and APID.
  std::map<std::pair<std::uint8_t, std::uint16_t>, std::uint8_t> configurations_;
  std::vector<std::uint8_t> broken_;  ///< in between when the supervisor before died
};

}  // namespace hirosco::supervisor
