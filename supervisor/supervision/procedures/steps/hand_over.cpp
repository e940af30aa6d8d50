// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/hand_over.hpp"

#include <algorithm>
#include <memory>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/procedures/steps/step_kinds.hpp"
#include "supervisor/supervision/procedures/steps/way_there.hpp"

namespace hirosco::supervisor::steps::task {
namespace {

[[nodiscard]] std::uint16_t receiver_of(const ProcedureStep& step) {
  return static_cast<std::uint16_t>(step.values[descriptor::hand_over_receiver]);
}

/// Each that the configuration needs, is not there, and that its producer has.
void add_links(const Member& receiver, const descriptor::Configuration& configuration, const Means& means,
               WayThere& way) {
  for (const descriptor::MissionLink& link : means.craft.mission.links) {
    if (link.to != receiver.descriptor().name) continue;
    const auto* producer = means.craft.member(means.craft.mission.find_subsystem(link.from)->subsystem.id);
    const auto* made =
        producer != nullptr ? producer->descriptor().find_configuration(producer->configuration()) : nullptr;
    const bool wanted = std::ranges::find(configuration.requires_, link.requires_, &descriptor::Requires::name) !=
                        configuration.requires_.end();
    const bool offered = made != nullptr && std::ranges::find(made->provides, link.provides,
                                                              &descriptor::Provides::name) != made->provides.end();
    if (wanted && offered) way.link(link.id);
  }
}

/// Kept by the answers that are still to come.
struct HandOver : std::enable_shared_from_this<HandOver> {
  HandOver(const ProcedureStep& what, const Means& with, CommandDone ended)
      : step{what}, means{with}, runner{with}, done{std::move(ended)} {}

  void begin() {
    Craft& craft = means.craft;
    craft.tell("plan " + step.occasion.plan + ": the task of " + craft.name_of(step.subject) + " to " +
                   craft.name_of(receiver_of(step)) + " because of " + step.occasion.event,
               step.subject);
    const Member* giver = craft.member(step.subject);
    const bool acts = giver != nullptr && giver->alive() && giver->state() == State::Operational;
    if (!acts) return bring_up();
    // It is fenced: whether it obeys decides nothing.
    runner.start({.stages = {{to_state(step.subject, State::SafeOperational)}},
                  .on_failure = Procedure::OnFailure::GoOn,
                  .finished = [self = shared_from_this()](const ProcedureEnd&) { self->bring_up(); }});
  }

  void bring_up() {
    if (const std::string why = against(step, means); !why.empty()) return end(false, why);
    const Member& receiver = *means.craft.member(receiver_of(step));
    const auto& configuration = *receiver.descriptor().find_configuration(
        static_cast<std::uint8_t>(step.values[descriptor::hand_over_configuration]));
    const bool has_it = receiver.state() == State::Operational && receiver.configuration() == configuration.id;
    if (has_it && !means.craft.guard.fenced(receiver.apid())) return end(true, {});
    WayThere way;
    way.add(receiver.descriptor(), configuration, {receiver.state(), receiver.configuration()}, State::Operational);
    add_links(receiver, configuration, means, way);
    runner.start(
        {.stages = way.stages(),
         .finished = [self = shared_from_this()](const ProcedureEnd& ended) { self->end(ended.success, ended.text()); },
         .begins =
             [self = shared_from_this()](std::size_t) {
               if (const std::string why = against(self->step, self->means); !why.empty()) self->end(false, why);
             },
         .knows_of_no_stop = true});
  }

  void end(bool success, const std::string& why) {
    const auto told = std::exchange(done, nullptr);
    runner.cancel();
    if (!told) return;
    const std::string whose = "the task of " + means.craft.name_of(step.subject);
    // Of one that is dead nobody else tells it.
    means.craft.tell(success ? whose + " is with " + means.craft.name_of(receiver_of(step))
                             : "nobody takes over " + whose + ": " + why,
                     step.subject);
    told(success, why);
  }

  ProcedureStep step;
  Means means;
  ProcedureRunner runner;
  CommandDone done;
};

}  // namespace

std::string against(const ProcedureStep& step, const Means& means) {
  const Craft& craft = means.craft;
  const Member* receiver = craft.member(receiver_of(step));
  if (receiver == nullptr || !receiver->alive()) return craft.name_of(receiver_of(step)) + " is down";
  const std::string& name = receiver->descriptor().name;
  if (receiver->apid() == step.subject) return name + " has it";
  if (craft.shutting_down) return "the craft shuts down";
  if (craft.changing_to != nullptr) return "the mode changes";
  if (receiver->recovery.running() || receiver->closed_at) return name + " is in a recovery";
  if (!receiver->state()) return name + " does not say where it is";
  if (craft.guard.fences(receiver->apid()) != receiver->fences_when_free)
    return name + " was stopped, and nobody has let it go since";
  return {};
}

void hand_over(const ProcedureStep& step, const Means& means, const CommandDone& done) {
  means.craft.guard.fence(step.subject);
  std::make_shared<HandOver>(step, means, done)->begin();
}

}  // namespace hirosco::supervisor::steps::task
