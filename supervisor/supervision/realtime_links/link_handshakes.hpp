// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hirosco/data_transfer/link/link.hpp"
#include "hirosco/data_transfer/memory/memory.hpp"
#include "hirosco/descriptor/model/mission.hpp"
#include "hirosco/pus/packet/packet.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "supervisor/supervision/realtime_links/handshake_under_way.hpp"
#include "supervisor/supervision/realtime_links/link_graph.hpp"
#include "supervisor/supervision/realtime_links/link_memory.hpp"
#include "supervisor/supervision/realtime_links/link_operator.hpp"
#include "supervisor/supervision/realtime_links/link_releases.hpp"

/// Leads the handshake of service 128 between two subsystems and keeps the graph (paper 4.3, decisions 19 and 20).
namespace hirosco::supervisor {

class LinkHandshakes {
 public:
  /// Called once with the outcome of an establish.
  using Done = std::function<void(bool success)>;

  LinkHandshakes(const descriptor::Mission& mission, LinkGraph& graph, MemoryProvider& memory,
                 LinkMechanisms mechanisms, LinkOperator& supervisor)
      : mission_{mission},
        operator_{supervisor},
        graph_{graph},
        memory_{mission, memory, mechanisms},
        releases_{mission, graph, supervisor} {}

  [[nodiscard]] const LinkGraph& graph() const noexcept { return graph_; }
  /// Of the newest handshake; those of a supervisor that goes on are newer.
  [[nodiscard]] std::uint32_t epoch() const noexcept { return epoch_; }
  void go_on_from(std::uint32_t epoch) noexcept { epoch_ = epoch; }
  /// Links of which a handshake or a release is under way.
  [[nodiscard]] std::vector<std::uint8_t> under_way() const;
  /// The supervisor before died in the middle of one: both ends are told to let go, and one that knows nothing of it has.
  void break_off(std::uint8_t link);
  /// Begins the handshake. False: unknown link, already up, being released, or a handshake of it is under way.
  [[nodiscard]] bool establish(std::uint8_t link, TimePoint now, Done done);
  /// Takes a link down at whichever end holds it, and ends when none does. False: nobody holds it, it is being taken down
  /// already, or a handshake of it is under way.
  [[nodiscard]] bool release(std::uint8_t link, LinkReleases::Done done);
  /// A release of it is under way.
  [[nodiscard]] bool releases(std::uint8_t link) const { return releases_.under_way(link); }
  /// How a link does. Empty: it is not up, nothing was produced yet, or it cannot be seen.
  [[nodiscard]] std::optional<LinkGlance> glance(std::uint8_t link) const noexcept;
  /// Whether a link that is up can be looked at from here: what passes a network nobody sees but its consumer.
  [[nodiscard]] bool can_look(std::uint8_t link) const noexcept { return views_.contains(link); }
  /// Reports of service 128.
  void handle(std::uint16_t from, const pus::TelemetryView& report);
  /// What was sent for a handshake or a release, TC[128,subtype], did not reach its addressee or failed there: it ends with the
  /// next step().
  void failed(std::uint16_t apid, std::uint8_t subtype, std::uint8_t link, const std::string& why);
  /// A subsystem is gone without reporting: all its links are down.
  void forget(std::uint16_t apid);
  /// Time limits of handshakes and releases, and releases whose ends have gone without a word.
  void step(TimePoint now);

 private:
  using Handshake = HandshakeUnderWay;
  using Stage = HandshakeUnderWay::Stage;
  void offered(Handshake& handshake, const pus::st128::Offer& offer);
  void agreed(Handshake& handshake, const pus::st128::Agreement& agreement);
  [[nodiscard]] Result<> share(Handshake& handshake, const pus::st128::Agreement& agreement);
  void attach(const Handshake& handshake, pus::st128::Role role);
  void attached(Handshake& handshake, const pus::st128::Attached& report);
  /// Of a link that is not memory: the producer learns where its consumer stands.
  void reach(Handshake& handshake);
  void up(Handshake& handshake);
  void detached(std::uint8_t link, std::uint16_t from);
  /// Ends a handshake; `without`: the partner that needs no word of it because it refused, left or died.
  void give_up(std::uint8_t link, const std::string& why, std::uint16_t without = 0);
  void down(std::uint8_t link, const std::string& why);
  [[nodiscard]] bool is_end_of(std::uint8_t link, std::uint16_t apid) const;

  const descriptor::Mission& mission_;
  LinkOperator& operator_;
  LinkGraph& graph_;
  LinkMemory memory_;
  LinkReleases releases_;
  std::map<std::uint8_t, Handshake> handshakes_;
  std::map<std::uint8_t, std::unique_ptr<LinkView>> views_;  ///< of links that are up
  std::set<std::uint8_t> broken_off_;
  std::uint32_t epoch_{0};
};

}  // namespace hirosco::supervisor
