// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/ground_link_care.hpp"

#include <algorithm>
#include <chrono>

#include "hirosco/descriptor/model/plan_steps.hpp"
#include "supervisor/supervision/procedures/steps/way_there.hpp"

namespace hirosco::supervisor {

using descriptor::State;

namespace {

/// What a plan says of a restart where it says no more than that.
constexpr Restarts::Rule usual_restart = [] {
  const auto attributes = descriptor::find_plan_step("restart")->attributes;
  return Restarts::Rule{.limit = static_cast<std::size_t>(*attributes[0].otherwise),
                        .within = std::chrono::seconds{*attributes[1].otherwise},
                        .pause = std::chrono::milliseconds{*attributes[2].otherwise}};
}();

}  // namespace

void GroundLinkCare::watch(TimePoint now) {
  const Member* link = craft_.ground_link();
  if (link == nullptr) return;
  if (!link->alive()) start_again(*link, now);
  // In Offline, and after that until a configuration is in force, it hears nobody who could bring it up again.
  const bool deaf = link->state() == State::Offline || link->configuration() == 0;
  const bool others_at_it = craft_.shutting_down || under_way_.running() || runner_.running();
  if (!link->alive() || !deaf || others_at_it) return lost_at_.reset();
  if (!lost_at_) lost_at_ = now;
  if (now - *lost_at_ < patience_) return;
  lost_at_.reset();
  restore(*link);
}

/// By the rule of 0043, as if its plan had said so: the limit does not hold for it.
void GroundLinkCare::start_again(const Member& link, TimePoint now) {
  // A plan that still runs for it may come to a restart of its own; who has not been there yet is commissioned; and of whom the
  // supervisor before left it is told first that it died.
  const bool others_at_it = craft_.shutting_down || restarts_.is_planned(link.apid()) || link.recovery.running() ||
                            (!link.was_started && under_way_.running()) || succession_.waits();
  if (others_at_it) return;
  craft_.tell(link.descriptor().name + " carries the ground link and is started again, which no plan asks for",
              link.apid());
  static_cast<void>(restarts_.plan(link.apid(), usual_restart, now, Restarts::AtLimit::GoesOn));
}

const descriptor::CommissionStep* GroundLinkCare::wanted(const Member& link) const {
  for (const descriptor::Mode* mode : {craft_.mode, craft_.mission.find_mode(craft_.mission.start_mode)}) {
    if (mode == nullptr) continue;
    const auto found =
        std::ranges::find(mode->commission, link.descriptor().name, &descriptor::CommissionStep::subsystem);
    if (found != mode->commission.end()) return &*found;
  }
  return nullptr;
}

const descriptor::Configuration& GroundLinkCare::able(const descriptor::SubsystemDescriptor& link,
                                                      const std::string& configuration) const {
  const auto& wished = *link.find_configuration(configuration);
  const auto can = [&](const descriptor::Configuration& one) { return !links_.absent_for(link.id, one); };
  if (can(wished)) return wished;
  const auto other = std::ranges::find_if(link.configurations, can);
  return other != link.configurations.end() ? *other : wished;
}

void GroundLinkCare::restore(const Member& link) {
  const descriptor::CommissionStep* step = wanted(link);
  if (step == nullptr) return;
  const descriptor::SubsystemDescriptor& subsystem = link.descriptor();
  const auto& configuration = able(subsystem, step->configuration);
  WayThere way;
  way.add(subsystem, configuration, {link.state(), link.configuration()}, step->state);
  craft_.restoring_ground_link = true;
  runner_.start({.stages = way.stages(), .finished = [this](const ProcedureEnd& end) {
                   craft_.restoring_ground_link = false;
                   patience_ = end.success ? pause : std::min(2 * patience_, Restarts::longest_pause);
                   craft_.tell(end.success ? "the ground link is back"
                                           : "the ground link did not come back: " + end.text());
                 }});
}

}  // namespace hirosco::supervisor
