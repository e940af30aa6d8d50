// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "hirosco/pus/words/describe.hpp"
#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/event_handling/restarts.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/realtime_links/link_graph.hpp"

namespace hirosco::supervisor {

class Commissioning;

/// Events are heard here and nowhere else, and answered by the recovery plans of the mission (paper 4.3 and 5): whether
/// ST[05] reports one to ground is no matter of recovery (adr 0020). Thread: the supervisor's.
class Reactions {
 public:
  struct Parts {
    Craft& craft;
    OwnSubsystem& own;
    CommandDesk& desk;
    const LinkGraph& links;
    Commissioning& commissioning;
    Restarts& restarts;
  };
  explicit Reactions(const Parts& parts) : parts_{parts}, craft_{parts.craft}, describer_{craft_.mission} {}

  /// False: it cannot be read.
  [[nodiscard]] bool take_event(std::uint16_t from, Octets message);
  /// What the mission's plans ask for when this event concerns `origin`.
  void react(Member& origin, std::string_view event, descriptor::Severity severity);

 private:
  void react_to_own(std::string_view event, descriptor::Severity severity);
  void shut_down_network(Member& origin, std::string_view plan);
  void bring_down(Member& subject);
  void recover_to(std::uint16_t apid, descriptor::State state, CommandDone done);
  void recovered(std::uint16_t apid, descriptor::Severity severity);

  Parts parts_;
  Craft& craft_;
  pus::PacketDescriber describer_;
};

}  // namespace hirosco::supervisor
