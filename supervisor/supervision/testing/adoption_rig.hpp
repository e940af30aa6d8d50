// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "supervisor/supervision/procedures/steps/hand_over.hpp"
#include "supervisor/supervision/testing/parts_rig.hpp"

namespace hirosco::supervisor::testing {

/// A supervisor dies, as often as the test wants; the members live on, but for those that have gone with it.
struct AdoptionTest : PartsTest {
  struct Next {
    Next(AdoptionTest& test, std::uint32_t first_epoch)
        : guard{{.clock = test.clock, .flows = test.flows, .first_epoch = first_epoch, .on_finding = {}}},
          parts{{.mission = test.next_mission,
                 .platform = {test.clock, test.memory, test.flows},
                 .launcher = test,
                 .guard = guard,
                 .log = test.log,
                 .open_database = [](DatabaseStrategy) { return nullptr; },
                 .observer = test,
                 .journal = &test.journal,
                 .values = &test.values,
                 .log_readings = &test.log_readings}} {}
    Guard guard;
    SupervisorParts parts;
  };
  std::vector<std::byte> journal_memory = std::vector<std::byte>(std::size_t{1} << 18);
  Journal journal{journal_memory};
  descriptor::Mission next_mission = mission;
  Memory notes{&journal,
               {&parts.adoption, &parts.modes, &parts.links, &parts.telecommands, &parts.safe_all, &parts.own,
                &parts.commanded, &parts.restarts, &parts.power, &parts.replacement, &parts.subscriptions,
                &parts.stored, &parts.ground_loss, &parts.losses, &parts.reactions, this}};
  std::set<std::uint16_t> gone;
  std::vector<std::unique_ptr<Next>> nexts;

  std::map<std::uint16_t, NotAdopted> ended_instead;  ///< one of them lives on

  std::expected<AdoptedSubsystem, NotAdopted> adopt(const descriptor::MissionSubsystem& described) override {
    const std::uint16_t apid = described.subsystem.id;
    if (ended_instead.contains(apid)) return std::unexpected{ended_instead[apid]};
    if (gone.contains(apid) || !played.contains(apid)) return std::unexpected{NotAdopted{}};
    PlayedMember& member = played[apid];
    AdoptedSubsystem adopted;
    adopted.epoch = member.permit->epoch;
    adopted.permitted = member.permit->permits(adopted.epoch);
    adopted.stopped = member.permit->stop != 0;
    adopted.permit = memory.create("permit", sizeof(PermitPage)).value();
    adopted.launched.permit = memory.map(adopted.permit, Access::ReadWrite).value();
    member.permit = new (adopted.launched.permit.octets.data()) PermitPage{};
    adopted.launched.vital = {nullptr, {reinterpret_cast<std::byte*>(member.vital), sizeof(VitalPage)}};
    adopted.launched.process = member.process;
    adopted.launched.port = std::make_unique<LocalMemberPort>(std::make_unique<PlayedMember::End>(member.channel),
                                                              adopted.launched.vital, adopted.launched.permit);
    return adopted;
  }
  /// The newest supervisor dies, and another one goes on.
  SupervisorParts& go_on() {
    nexts.push_back(std::make_unique<Next>(*this, 5000 + 1000 * static_cast<std::uint32_t>(nexts.size())));
    SupervisorParts& next = nexts.back()->parts;
    next.craft.now = clock.now();
    next.own.start(next.craft.mode_epoch);
    next.adoption.begin(false);
    next.own.enter_mode(next.craft.mode_epoch);
    return next;
  }
  /// It is as far as it will get by itself: it ends what was begun, and hears what members say.
  void begins_to_hear(SupervisorParts& next) {
    for (const auto& [apid, member] : played) next.adoption.confirmed(apid);
    wait(Adoption::longest_start + 1ms);
    next.craft.now = clock.now();
    next.adoption.watch(clock.now());
    ASSERT_FALSE(next.adoption.waits());
  }
  /// TM[1,subtype] of a member, heard by this supervisor.
  void says(SupervisorParts& next, std::uint16_t apid, const Received& asked, std::uint8_t subtype) {
    std::array<std::byte, pus::max_telemetry_octets> buffer;
    std::array<std::byte, 4> data;
    OctetWriter{data}.put(asked.request);
    const auto packet = pus::write_telemetry(buffer,
                                             {.apid = apid,
                                              .sequence_count = played[apid].reports++,
                                              .service = 1,
                                              .subtype = subtype,
                                              .destination = asked.source},
                                             data);
    ASSERT_TRUE(played[apid].channel.subsystem_end().send({.kind = MessageKind::Packet, .packet = *packet}));
    next.reception.read(*next.craft.member(apid));
  }
  /// TM[1,x] that this supervisor has said itself to anybody but itself since it was asked last: each x with its code, 0 for none.
  std::vector<std::pair<int, int>> told_by(SupervisorParts& next) {
    static_cast<void>(next.own.step(clock.now()));
    std::vector<std::pair<int, int>> found;
    MessageBuffer buffer;
    for (;;) {
      const auto message = next.own.channel().receive(buffer);
      if (!message || message->flow == Flow::None) return found;
      const auto report = pus::TelemetryView::parse(message->message.packet);
      if (!report || report->service() != 1 || report->destination() == supervisor_apid) continue;
      OctetReader reader{report->source_data()};
      static_cast<void>(reader.get<std::uint32_t>());
      found.emplace_back(report->subtype(), report->subtype() % 2 == 0 ? reader.get<std::uint16_t>() : 0);
    }
  }
  /// A stop of everything, to its end; what had acted is safe then.
  void stop_everything() {
    parts.safe_all.asked();
    for (auto& [apid, member] : played) set(apid, State::SafeOperational);
    for (const TimePoint end = clock.now() + 1s; clock.now() < end; wait(Guard::period)) {
      guard.beat();
      for (auto& [apid, member] : played) {
        ++member.vital->service_steps;
        member.vital->seen_epoch = member.permit->epoch.load();
      }
      static_cast<void>(guard.step(clock.now()));
    }
    parts.safe_all.follow();
    ASSERT_FALSE(parts.safe_all.under_way());
  }
  /// Why ARM's task is not handed over to this one; empty: it would be.
  static std::string against(SupervisorParts& next, std::uint16_t receiver) {
    ProcedureStep step;
    step.subject = arm;
    step.values = {receiver, 1};
    return steps::task::against(step, {next.craft, next.own_telecommands, next.graph, next.restarts, next.under_way,
                                       next.commanded, next.losses, next.waiting});
  }
};

}  // namespace hirosco::supervisor::testing
