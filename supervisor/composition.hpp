// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/data_handling/log_watch.hpp"
#include "supervisor/supervision/data_handling/own_telecommands.hpp"
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"
#include "supervisor/supervision/data_handling/reception.hpp"
#include "supervisor/supervision/data_handling/replies.hpp"
#include "supervisor/supervision/data_handling/retrieval.hpp"
#include "supervisor/supervision/data_handling/subscriptions.hpp"
#include "supervisor/supervision/data_handling/telecommands.hpp"
#include "supervisor/supervision/data_handling/telemetry.hpp"
#include "supervisor/supervision/event_handling/ground_loss.hpp"
#include "supervisor/supervision/event_handling/reactions.hpp"
#include "supervisor/supervision/event_handling/safe_all.hpp"
#include "supervisor/supervision/modes/commissioning.hpp"
#include "supervisor/supervision/modes/modes.hpp"
#include "supervisor/supervision/modes/shutdown.hpp"
#include "supervisor/supervision/modes/under_way.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/realtime_links/link_commands.hpp"
#include "supervisor/supervision/resource_management/power_draws.hpp"
#include "supervisor/supervision/resource_management/power_handling.hpp"
#include "supervisor/supervision/resource_management/resource_handling.hpp"
#include "supervisor/supervision/status/housekeeping.hpp"
#include "supervisor/supervision/subsystem_handling/adoption.hpp"
#include "supervisor/supervision/subsystem_handling/descriptors.hpp"
#include "supervisor/supervision/subsystem_handling/ground_link_care.hpp"
#include "supervisor/supervision/subsystem_handling/link_losses.hpp"
#include "supervisor/supervision/subsystem_handling/processes.hpp"
#include "supervisor/supervision/subsystem_handling/replacement.hpp"
#include "supervisor/supervision/subsystem_handling/restoration.hpp"
#include "supervisor/supervision/subsystem_handling/version_texts.hpp"
#include "supervisor/supervisor.hpp"

namespace hirosco::supervisor {

/// The boxes of the paper's figure 6 and what joins them. Here alone they are made and named; whoever watches or hears stands in
/// a list, in the order in which it is asked. They know each other from before they begin to live: nothing is called until
/// all are made.
struct SupervisorParts final : OwnSubsystem::Author {
  explicit SupervisorParts(const Supervisor::Parts& outside)
      : craft{outside.mission, outside.platform, outside.launcher, outside.guard, outside.log, outside.observer},
        stored{craft, own, own_telecommands, outside.values},
        log_watch{craft, own, telecommands, outside.open_database},
        own_telecommands{craft, telecommands, outside.first_sequence_count},
        retrieval{{craft, own, telemetry, outside.log_readings}},
        version_texts{{craft, own, stored, outside.readings}},
        descriptors{{craft, own, own_telecommands, under_way, stored, outside.readings}},
        memory{outside.journal,
               {&adoption, &modes, &links, &telecommands, &safe_all, &own, &commanded, &restarts, &power, &replacement,
                &subscriptions, &stored, &ground_loss, &losses, &reactions, &outside.observer}} {
    if (outside.journal != nullptr) craft.remembers = [this] { memory.note(); };
    // No cycle, no queue and no state of the supervisor's own holds these up.
    telecommands.at_once("SAFE_ALL", [this](const pus::Request& request) { safe_all.carry_out(request); });
    telecommands.at_once("SHUTDOWN", [this](const pus::Request& request) { shutdown.command(request); });
    supervision.answers(pus::st129::permission_question,
                        [this](const pus::Request& asked, Octets data) { judgement.answer(asked, data); });
    supervision.answers(pus::st129::mode_question,
                        [this](const pus::Request& asked, Octets data) { modes.preview(asked, data); });
    supervision.answers(pus::st129::plan_question,
                        [this](const pus::Request& asked, Octets data) { reactions.preview(asked, data); });
    supervision.answers(pus::st129::subscribe,
                        [this](const pus::Request& asked, Octets data) { subscriptions.begin(asked, data); });
    supervision.answers(pus::st129::unsubscribe,
                        [this](const pus::Request& asked, Octets data) { subscriptions.end(asked, data); });
    supervision.answers(pus::st129::retrieve,
                        [this](const pus::Request& asked, Octets data) { retrieval.begin(asked, data); });
    telecommands.starts_with([this](std::uint16_t apid) { return processes.start(apid); });
  }

  void provide(OwnSubsystem&) override {
    housekeeping.provide();
    modes.provide();
    links.provide();
    log_watch.provide();
    power.provide();
    replacement.provide();
    descriptors.provide();
    safe_all.provide();
    shutdown.provide();
  }
  void show() noexcept override { housekeeping.show(); }

  Craft craft;
  OwnSubsystem own{craft.mission.supervisor, craft.platform, *this};
  LinkGraph graph{craft.mission};
  Unanswered unanswered;
  Restarts restarts;
  CommandedMembers commanded{craft, own};
  StoredValues stored;
  Traffic traffic;
  GroundRoute ground_route;
  // data handling
  SupervisionService supervision{own};
  Judgement judgement{craft, own, graph, power};
  Telecommands telecommands{
      {craft, own, judgement, power, unanswered, traffic, ground_route, commanded, stored, supervision}};
  LogWatch log_watch;
  OwnTelecommands own_telecommands;
  Replies replies{craft, unanswered};
  Subscriptions subscriptions{craft, own};
  Telemetry telemetry{craft,
                      own,
                      traffic,
                      ground_route,
                      {&traffic, &commanded, &stored, &replies, &subscriptions, &reception, &power, &draws,
                       &own_telecommands, &links, &safe_all}};
  Retrieval retrieval;
  Reception reception{{craft, own, telecommands, telemetry, reactions, ground_loss, unanswered, traffic, subscriptions,
                       stored, adoption}};
  // real-time links, resource management
  LinkCommands links{craft, own, own_telecommands, graph};
  PowerHandling power{craft, own, reactions};
  PowerDraws draws{craft, own, reactions, power.ledger()};
  ResourceHandling resources{craft, own};
  // modes and procedures
  Waiting waiting;
  Means means{craft, own_telecommands, graph, restarts, under_way, commanded, losses, waiting};
  Commissioning commissioning{means};
  Modes modes{{means, own, power.ledger(), commissioning}};
  UnderWay under_way{commissioning, modes};
  Shutdown shutdown{{means, own, under_way, telecommands, reception}};
  // event handling
  Reactions reactions{means, own};
  GroundLoss ground_loss{craft, own, reactions};
  SafeAll safe_all{craft, own, own_telecommands, {&under_way, &restoration, &losses}};
  // subsystem handling, status
  GroundLinkCare ground_link{means, under_way, adoption};
  Restoration restoration{means, own, under_way};
  LinkLosses losses{means, own};
  Processes processes{{craft, own, reception, reactions, safe_all, links, telecommands, own_telecommands, ground_link,
                       ground_loss, restarts, restoration, resources, replacement, stored}};
  VersionTexts version_texts;
  Replacement replacement{{craft, own, processes, reactions, under_way, version_texts}};
  Descriptors descriptors;
  Housekeeping housekeeping{{craft, own, links, power.ledger(), traffic}};
  // what outlives this supervisor
  Adoption adoption{{craft, own, processes, own_telecommands, telecommands, links, modes, commissioning, reactions,
                     safe_all, shutdown, losses, memory}};
  Memory memory;
  std::array<Watch*, 21> watches{
      &adoption,     &stored,           &processes,    &replacement, &descriptors,   &ground_link, &ground_loss,
      &restoration,  &losses,           &housekeeping, &power,       &draws,         &links,       &log_watch,
      &telecommands, &own_telecommands, &replies,      &resources,   &subscriptions, &waiting,     &retrieval};
};

}  // namespace hirosco::supervisor
