// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plans_before.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "supervisor/supervision/procedures/steps/step_kinds.hpp"

namespace hirosco::supervisor {

using descriptor::Severity;

namespace {

[[nodiscard]] bool leads_to_where_it_is(const ProcedureStep& step, const Member& subject) {
  return step.kind == &steps::set_state && subject.state() == steps::state_step::wanted(step);
}

/// What a plan asks of its subject on the way to where that is now, and would fail there.
[[nodiscard]] bool is_done_on_the_way(const ProcedureStep& step, const Member& subject) {
  if (step.kind == &steps::set_state) return true;
  if (step.kind != &steps::command || !subject.state()) return false;
  const descriptor::Function* function = subject.descriptor().find_function(step.words.front());
  return function != nullptr && !function->permitted_in(*subject.state());
}

/// Of a plan that begins anew. What cannot be told to have been done is done once more.
[[nodiscard]] Stage left_to_do(const PlanStart& start, const Member& subject, const Craft& craft) {
  const auto is_there = [&](const ProcedureStep& step) { return leads_to_where_it_is(step, subject); };
  const auto behind_the_way = std::ranges::find_if(start.planned.rbegin(), start.planned.rend(), is_there).base();
  Stage left;
  for (auto each = start.planned.begin(); each != start.planned.end(); ++each)
    if (does_something(*each, craft) && (each >= behind_the_way || !is_done_on_the_way(*each, subject)))
      left.push_back(*each);
  return left;
}

}  // namespace

bool PlansBefore::begins_anew(std::uint16_t apid) const {
  const auto of_it = [apid](const PlanUnderWay& each) { return each.subject == apid; };
  return !is_spent(apid) && std::ranges::any_of(before_, of_it) &&
         std::ranges::none_of(before_, [&](const PlanUnderWay& each) { return of_it(each) && each.anew; });
}

bool PlansBefore::begin_anew(Member& subject, const Answer& answer) {
  const std::uint16_t apid = subject.apid();
  const bool may = begins_anew(apid) && !craft_.shutting_down;
  const auto of_it = [apid](const PlanUnderWay& each) { return each.subject == apid; };
  if (may) {
    for (PlanUnderWay& each : before_) each.anew = each.anew || of_it(each);
    craft_.remember();  // should this supervisor die by it at once, no third one does
  }
  std::vector<PlanUnderWay> those;
  std::ranges::copy_if(before_, std::back_inserter(those), of_it);
  std::erase_if(before_, of_it);
  if (!may) return false;
  bool goes_on = false;
  for (const PlanUnderWay& each : those) {
    PlanStart start = answer(each);
    const auto is_there = [&](const ProcedureStep& step) { return leads_to_where_it_is(step, subject); };
    // Who has come elsewhere than its plan leads has not followed that.
    if (start.steps.empty() && (start.planned.empty() || !std::ranges::all_of(start.planned, is_there))) continue;
    goes_on = start.anew = true;
    // It stands fenced where it has come to.
    start.steps = left_to_do(start, subject, craft_);
    const bool has_to_do = !start.steps.empty();
    if (!has_to_do || runs_.against(start).empty())
      craft_.tell(
          fmt::format("{}: plan {} because of {} {}: the supervisor died in the midst of it", craft_.name_of(apid),
                      start.occasion.plan, each.event, has_to_do ? "begins anew" : "has nothing left to do"),
          apid);
    if (has_to_do) runs_.begin(start);
  }
  return goes_on;
}

void PlansBefore::counts_as_failed(std::uint16_t apid) {
  const auto of_it = [apid](const PlanUnderWay& each) { return each.subject == apid; };
  std::erase_if(before_, of_it);
  before_.push_back({apid, apid, Severity::High, false, std::string{event_of_failure}});
  craft_.remember();  // should this supervisor die by it at once, the next one knows that it had begun
  std::erase_if(before_, of_it);
}

void PlansBefore::note(OctetWriter& writer) const {
  std::vector<PlanUnderWay> all = runs_.under_way();
  all.insert(all.end(), before_.begin(), before_.end());
  // Until it is down, whoever goes on finds it on its way.
  for (const std::uint16_t apid : spent_)
    if (const Member* member = std::as_const(craft_).member(apid);
        !answered_ || (member != nullptr && member->recovery.running()))
      all.push_back({apid, apid, Severity::High, true, std::string{event_of_failure}});
  writer.put(static_cast<std::uint16_t>(all.size()));
  for (const PlanUnderWay& each : all) each.note(writer);
}

void PlansBefore::recall(OctetReader& reader) {
  for (auto left = reader.get<std::uint16_t>(); left > 0 && reader.good(); --left) {
    PlanUnderWay each;
    each.recall(reader);
    if (!reader.good()) return;
    if (each.anew && each.event == event_of_failure) spent_.insert(each.subject);
    else before_.push_back(std::move(each));
  }
}

}  // namespace hirosco::supervisor
