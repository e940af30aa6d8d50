// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/procedures/steps/shut_down_network.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "supervisor/supervision/procedures/procedure_runner.hpp"
#include "supervisor/supervision/procedures/steps/set_state.hpp"

namespace hirosco::supervisor::steps::network {
namespace {

std::string names(const std::vector<std::uint16_t>& members, const Craft& craft) {
  std::string text;
  for (const std::uint16_t apid : members) text += (text.empty() ? "" : ", ") + craft.name_of(apid);
  return text;
}

Procedure to(std::uint16_t apid, State state, std::function<void(const ProcedureEnd&)> finished) {
  return {.stages = {{{.kind = &set_state, .subject = apid, .values = {static_cast<std::int64_t>(state)}}}},
          .on_failure = Procedure::OnFailure::GoOn,
          .finished = std::move(finished)};
}

/// Each member goes its own way: one that does not answer holds up nobody else.
void bring_down(const Member& member, const Means& means) {
  const std::uint16_t apid = member.apid();
  const auto to_offline = [apid, means](const ProcedureEnd&) {
    Member* again = means.craft.member(apid);
    if (!again->alive() || again->state() == State::Offline) return again->recovery.came_down();
    ProcedureRunner{means}.start(to(apid, State::Offline, [apid, means](const ProcedureEnd& end) {
      means.craft.member(apid)->recovery.came_down();
      means.craft.tell(means.craft.name_of(apid) + (end.success ? " is Offline" : " did not reach Offline: " + end.why),
                       apid);
    }));
  };
  const auto state = member.state();
  const bool can_stop =
      state == State::PreOperational || state == State::SafeOperational || state == State::Operational;
  if (!can_stop) return to_offline({});
  ProcedureRunner{means}.start(to(apid, State::ErrorOperational, to_offline));
}

}  // namespace

std::vector<std::uint16_t> members(const ProcedureStep& step, const Means& means) {
  auto found = means.links.taken_down_with(step.subject);
  std::erase_if(found, [&](std::uint16_t apid) {
    const Member* subject = means.craft.member(apid);
    return subject != nullptr && apid != step.subject && means.craft.is_ground_link(*subject);
  });
  return found;
}

void shut_down(const ProcedureStep& step, const Means& means, const CommandDone& done) {
  const auto network = members(step, means);
  const std::string plan = "plan " + step.occasion.plan;
  means.craft.tell(plan + ": network {" + names(network, means.craft) + "} to ErrorOperational and down", step.subject);
  const std::string_view event = step.occasion.event;
  const std::string because = plan + " because of " + means.craft.name_of(step.subject) + (event.empty() ? "" : " ");
  if (means.under_way.cancel(because + std::string{event}) == Cancelled::ForGood) means.craft.fail();
  std::vector<const Member*> led;
  for (const std::uint16_t apid : network) {
    Member* member = means.craft.member(apid);
    if (member == nullptr || !member->alive()) continue;
    means.commanded.lower(apid, State::Offline, step.occasion.event);
    if (member->recovery.goes_down()) led.push_back(member);
  }
  // The plan ends with this step, and who is fenced and on the way down is to be taken there by whoever goes on.
  means.craft.remember();
  for (const Member* member : led) bring_down(*member, means);
  for (const std::uint8_t link : means.links.links_out_of(network)) means.losses.lost(link);
  done(true, {});
}

}  // namespace hirosco::supervisor::steps::network
