// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/event_handling/plan_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

namespace hirosco::supervisor {
namespace {

/// While one that holds its subject runs, nobody commands that up.
[[nodiscard]] bool holds(const PlanStart& plan) {
  return std::ranges::any_of(plan.steps,
                             [](const ProcedureStep& each) { return each.kind->holds == StepKind::Holds::Subject; });
}

[[nodiscard]] PlanRank rank_of(const PlanStart& plan, std::size_t from) {
  return {safety_of(std::span{plan.steps}.subspan(std::min(from, plan.steps.size()))), plan.priority, plan.severity};
}

}  // namespace

void PlanUnderWay::note(OctetWriter& writer) const {
  writer.put(subject).put(origin).put(static_cast<std::uint8_t>(severity));
  writer.put(static_cast<std::uint8_t>(anew ? 1 : 0)).put(static_cast<std::uint16_t>(event.size()));
  writer.put(std::as_bytes(std::span{event}));
}

void PlanUnderWay::recall(OctetReader& reader) {
  subject = reader.get<std::uint16_t>();
  origin = reader.get<std::uint16_t>();
  severity = static_cast<descriptor::Severity>(reader.get<std::uint8_t>());
  anew = reader.get<std::uint8_t>() != 0;
  const Octets name = reader.get(reader.get<std::uint16_t>());
  event.assign(reinterpret_cast<const char*>(name.data()), name.size());
}

/// By what it has still to do: a stop that is done protects nothing from giving way.
PlanRank PlanRuns::Run::rank() const { return rank_of(plan, at); }

void PlanRuns::begin(const PlanStart& plan) {
  runs_.remove_if([](const Run& run) { return !run.runner.running(); });
  if (!makes_way(plan)) return;
  Run& run = runs_.emplace_back(means_, plan);
  if (holds(plan)) recovery_of(plan.subject).plan_begins(plan.severity);
  Procedure procedure;
  for (const ProcedureStep& each : plan.steps) procedure.stages.push_back({each});
  procedure.begins = [this, &run](std::size_t step) { step_begins(run, step); };
  procedure.finished = [this, &run](const ProcedureEnd& end) { ended(run, end); };
  run.runner.start(std::move(procedure));
}

std::list<PlanRuns::Run>::const_iterator PlanRuns::in_its_way(const PlanStart& plan) const {
  const PlanRank begins = rank_of(plan, 0);
  return std::ranges::find_if(runs_, [&](const Run& run) {
    return run.plan.subject == plan.subject && run.runner.running() && !pre_empts(begins, run.rank());
  });
}

std::string PlanRuns::against(const PlanStart& plan) const {
  if (plan.of_loss) return {};
  if (std::as_const(means_.craft).member(plan.subject)->recovery.going_down())
    return "it is on its way down with its network";
  const auto run = in_its_way(plan);
  return run != runs_.end() ? "plan " + run->plan.occasion.plan + " runs" : std::string{};
}

std::vector<PlanUnderWay> PlanRuns::under_way() const {
  std::vector<PlanUnderWay> found;
  for (const Run& run : runs_)
    if (run.runner.running() && holds(run.plan) && !is_overtaken(run))
      found.push_back({run.plan.subject, run.plan.origin, run.plan.severity, run.plan.anew, run.plan.occasion.event});
  return found;
}

bool PlanRuns::makes_way(const PlanStart& plan) {
  // The way down is the safest there is: nothing pre-empts it, and nothing is to be told of who is on it.
  if (recovery_of(plan.subject).going_down() && !plan.of_loss) return false;
  const PlanRank begins = rank_of(plan, 0);
  const auto is_same = [&](const Run& run) {
    return run.plan.number == plan.number && run.plan.occasion.event == plan.occasion.event;
  };
  if (!plan.of_loss) {
    const auto first = in_its_way(plan);
    if (first != runs_.end()) {
      // Each is told of once: an event may come again in every cycle.
      if (!first->refused.insert(plan.number).second) return false;
      const Occasion &refused = plan.occasion, &runs = first->plan.occasion;
      means_.craft.tell(first->plan.number == plan.number
                            ? fmt::format("{}: plan {} because of {} runs already, {} does not begin it anew",
                                          means_.craft.name_of(plan.subject), runs.plan, runs.event, refused.event)
                            : fmt::format("{}: plan {} because of {} is refused, plan {} runs",
                                          means_.craft.name_of(plan.subject), refused.plan, refused.event, runs.plan),
                        plan.subject);
      own_.announce("PLAN_REFUSED", {static_cast<double>(plan.subject), static_cast<double>(plan.number),
                                     static_cast<double>(first->plan.number)});
      return false;
    }
  }
  for (Run& run : runs_) {
    if (run.plan.subject != plan.subject || !run.runner.running()) continue;
    if (is_same(run)) {
      cancel(run);
      means_.craft.tell(fmt::format("{}: plan {} begins anew: {} came again while it ran",
                                    means_.craft.name_of(plan.subject), plan.occasion.plan, plan.occasion.event),
                        plan.subject);
    } else if (pre_empts(begins, run.rank())) give_up(run, plan.number, plan.occasion.plan);
  }
  return true;
}

void PlanRuns::cancel(Run& run) {
  run.runner.cancel();
  if (holds(run.plan)) recovery_of(run.plan.subject).plan_ended(run.plan.severity);
}

void PlanRuns::give_up(Run& run, std::uint16_t by, const std::string& name) {
  const std::string waiting = run.runner.waiting_for();
  cancel(run);
  const std::uint16_t apid = run.plan.subject;
  means_.craft.tell(fmt::format("{}: plan {} gives way to plan {}{}{}", means_.craft.name_of(apid),
                                run.plan.occasion.plan, name, waiting.empty() ? "" : " at ", waiting),
                    apid);
  own_.announce("PLAN_PREEMPTED",
                {static_cast<double>(apid), static_cast<double>(run.plan.number), static_cast<double>(by)});
}

void PlanRuns::give_up_those_down(const Run& by) {
  for (Run& run : runs_)
    if (&run != &by && run.plan.subject != by.plan.subject && run.runner.running() &&
        recovery_of(run.plan.subject).going_down())
      give_up(run, by.plan.number, by.plan.occasion.plan);
}

bool PlanRuns::is_overtaken(const Run& run) const {
  const bool by_itself = safety_of(std::span{run.plan.steps}.first(run.at)) == Safety::Network;
  return means_.craft.member(run.plan.subject)->recovery.going_down() && !by_itself && !run.plan.of_loss;
}

void PlanRuns::step_begins(Run& run, std::size_t step) {
  run.at = step;
  // Whom it stops is fenced by now: should this supervisor die before the end of its step, the next one is to know what for.
  if (step == 0 && holds(run.plan)) means_.craft.remember();
  give_up_those_down(run);
  if (is_overtaken(run)) give_up(run, loss_of_a_link, "for the loss of a link");
}

void PlanRuns::ended(Run& run, const ProcedureEnd& end) {
  const PlanStart plan = run.plan;
  give_up_those_down(run);
  MemberRecovery& recovery = recovery_of(plan.subject);
  if (holds(plan)) recovery.plan_ended(plan.severity);
  for (const Run& other : runs_)
    if (&other != &run && other.plan.subject == plan.subject && other.runner.running() && holds(other.plan) &&
        !recovery.running())
      recovery.plan_begins(other.plan.severity);
  if (!end.success && means_.craft.member(plan.subject)->alive()) failed_(plan, end);
}

}  // namespace hirosco::supervisor
