// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "supervisor/supervision/command_desk.hpp"
#include "supervisor/supervision/craft.hpp"
#include "supervisor/supervision/event_handling/plan_choice.hpp"
#include "supervisor/supervision/event_handling/plan_runs.hpp"
#include "supervisor/supervision/event_handling/plans_before.hpp"
#include "supervisor/supervision/own_subsystem.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/succession/journal.hpp"

namespace hirosco::supervisor {

/// Events are heard here and nowhere else, and answered by the recovery plans of the mission (paper 4.3 and 5): whether
/// ST[05] reports one to ground is no matter of recovery (adr 0020). Which plan: `plan_choice.hpp`; what its steps do:
/// `procedures/steps/`, which of two is followed: `plan_runs.hpp`; which were under way when the supervisor before this
/// one died: `plans_before.hpp`; what a member is in the middle of by that: `members/member_recovery.hpp`. Who loses a
/// device has stopped its actuators before: `hirosco/subsystem/cycle/device_inputs.cpp`. Thread: the supervisor's.
class Reactions final : public Remembered {
 public:
  Reactions(const Means& means, OwnSubsystem& own)
      : craft_{means.craft},
        own_{own},
        desk_{means.desk, own},
        means_{means.craft,     desk_,           means.links,  means.restarts,
               means.under_way, means.commanded, means.losses, means.waiting},
        runs_{means_, own, [this](const PlanStart& plan, const ProcedureEnd& end) { escalate(plan, end); }},
        describer_{craft_.mission} {}
  Reactions(const Reactions&) = delete;
  Reactions& operator=(const Reactions&) = delete;

  /// False: it cannot be read.
  [[nodiscard]] bool take_event(std::uint16_t from, Octets message);
  /// What the mission's plans ask for when this event concerns `origin`. A plan that fails escalates once: RECOVERY_FAILED, high.
  void react(Member& origin, std::string_view event, descriptor::Severity severity);
  /// Whose actuators they would stop now because of this event, before anything else.
  [[nodiscard]] std::vector<std::uint16_t> fenced_by(const Member& origin, std::string_view event,
                                                     descriptor::Severity severity) const;
  /// TC[129,6]: what it would do about an event now, and what is against it. Nothing is moved, kept or sent but the answer.
  void preview(const pus::Request& asked, Octets data);

  /// See PlansBefore.
  [[nodiscard]] bool begins_anew(std::uint16_t apid) const { return plans_before_.begins_anew(apid); }
  /// As if its event were told now: by the plan that answers that now.
  bool begin_anew(Member& subject);
  [[nodiscard]] bool is_spent(std::uint16_t apid) const { return plans_before_.is_spent(apid); }
  /// The plan that was under way for it counts as failed: RECOVERY_FAILED, high; where that is spent the network goes down.
  void fail_plan_of(Member& subject);
  void forget_what_was_under_way() noexcept { plans_before_.forget(); }
  /// What is under way, or was under the supervisor before.
  void note(OctetWriter& writer) const override { plans_before_.note(writer); }
  void recall(OctetReader& reader) override { plans_before_.recall(reader); }

 private:
  /// For each whom the plan moves, with what there is to do for it: the one whose event it is first.
  [[nodiscard]] std::vector<PlanStart> answer_to(const Member& origin, std::string_view event,
                                                 descriptor::Severity severity) const;
  /// Which plan; the severity is then that of our descriptor, where it is us who tell.
  [[nodiscard]] Reaction reaction_to(const Member& origin, std::string_view event,
                                     descriptor::Severity& severity) const;
  void react_to_own(std::string_view event, descriptor::Severity severity);
  [[nodiscard]] Reaction reaction_to_own(std::string_view event, descriptor::Severity severity) const;
  [[nodiscard]] std::vector<PlanStart> answer_to_own(const Reaction& reaction, std::string_view event,
                                                     descriptor::Severity severity) const;
  /// Whom a plan for our own events moves; and the first of them.
  [[nodiscard]] bool is_of_all(const Member& member) const { return member.alive() && !craft_.is_ground_link(member); }
  [[nodiscard]] const Member* first_of_all() const;
  /// Null: nobody tells of it.
  [[nodiscard]] const descriptor::Event* find_event(std::uint16_t apid, std::uint16_t id) const;
  void look_ahead(const std::vector<PlanStart>& starts, pus::st129::PlanPreview& preview) const;
  /// `whose`: the event's; null: the supervisor's, and the plan is for all that act.
  [[nodiscard]] PlanStart start_for(const Member& subject, const Member* whose, const Reaction& reaction,
                                    descriptor::Severity severity, std::string_view event) const;
  /// Empty: nobody answers that any more.
  [[nodiscard]] PlanStart answer_again(const Member& subject, const PlanUnderWay& before) const;
  void escalate(const PlanStart& plan, const ProcedureEnd& end);
  void take_down_network_of(const Member& subject);

  class Desk final : public CommandDesk {
   public:
    Desk(CommandDesk& desk, OwnSubsystem& own) : desk_{desk}, own_{own} {}
    void command(std::uint16_t apid, std::string_view function, std::optional<double> argument, CommandDone done,
                 std::optional<std::uint64_t> free_at) override;
    void send(std::uint16_t apid, std::uint8_t service, std::uint8_t subtype, Octets data, const MemoryHandle& memory,
              CommandDone done, Duration takes) override;

   private:
    CommandDesk& desk_;
    OwnSubsystem& own_;
  };

  Craft& craft_;
  OwnSubsystem& own_;
  Desk desk_;
  Means means_;
  PlanRuns runs_;
  PlansBefore plans_before_{craft_, runs_};
  pus::PacketDescriber describer_;
};

}  // namespace hirosco::supervisor
