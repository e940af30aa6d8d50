// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/supervisor_events.hpp"
#include "hirosco/descriptor/read/detail/mode_parts.hpp"
#include "hirosco/descriptor/read/detail/plan_reader.hpp"

/// The recovery plans of a mission: when, and what.
namespace hirosco::descriptor::detail {
namespace {

constexpr std::size_t most_steps = 16;

/// A step that can answer none of the plan's events would be a promise that is never kept.
void check_answers(const xml::Element& element, const Plan& plan, MissionDraft& draft) {
  if (!draft.whole) return;
  for (const PlanStep& step : plan.steps) {
    const std::string_view only = find_plan_step(step.kind)->answers;
    if (only.empty()) continue;
    const auto* event = draft.mission.supervisor.find_event(only);
    const bool named = plan.event.empty() || plan.event == only;
    const bool severe = plan.severities.empty() || event == nullptr ||
                        std::ranges::find(plan.severities, event->severity) != plan.severities.end();
    if (!named || !severe)
      draft.problems.add(element, "E0326",
                         fmt::format("plan '{}' never does '{}': that answers {} only", plan.name, step.kind, only),
                         fmt::format("it belongs to the plan for {}", only));
  }
}

/// The steps of a plan that another one runs stand in that one's place, so that all that looks at a plan sees them.
void expand_runs(const xml::Element& element, Mission& mission, Problems& problems) {
  const auto is_run = [](const PlanStep& step) { return step.kind == step_that_runs_a_plan; };
  for (std::size_t depth = 0; depth < most_steps; ++depth) {
    bool any = false;
    for (Plan& plan : mission.plans) {
      const auto run = std::ranges::find_if(plan.steps, is_run);
      if (run == plan.steps.end()) continue;
      any = true;
      const std::string name = run->words.empty() ? std::string{} : run->words.front();
      const auto other = std::ranges::find(mission.plans, name, &Plan::name);
      if (other == mission.plans.end()) {
        std::vector<std::string_view> known;
        for (const Plan& each : mission.plans) known.push_back(each.name);
        problems.add(plan.at, "E0373", fmt::format("plan '{}' runs {}, which is no plan", plan.name, in_quotes(name)),
                     did_you_mean(name, known));
        plan.steps.erase(run);
        continue;
      }
      const std::vector<PlanStep> steps = other->steps;
      const auto at = plan.steps.erase(run);
      plan.steps.insert(at, steps.begin(), steps.end());
      if (plan.steps.size() <= most_steps) continue;
      problems.add(plan.at, "E0373",
                   fmt::format("plan '{}' has more than {} steps with those that it runs", plan.name, most_steps),
                   "does it run itself?");
      std::erase_if(plan.steps, is_run);
      plan.steps.resize(std::min(plan.steps.size(), most_steps));
    }
    if (!any) return;
  }
  problems.add(element, "E0373", "plans run each other in a circle");
}

}  // namespace

void PlanReader::read_recovery(const xml::Element& element) {
  const Attributes none{element, problems_};
  each_child(element, problems_, {{"Plan", [this](const auto& child) { read_plan(child); }, 255}});
  expand_runs(element, mission_, problems_);
  // What the supervisor tells of plans has their names wherever it is read.
  auto& enumerations = mission_.supervisor.enumerations;
  const auto names = std::ranges::find(enumerations, plans_enumeration, &Enumeration::name);
  if (names == enumerations.end()) return;
  for (std::size_t i = 0; i < mission_.plans.size(); ++i)
    names->texts.push_back({static_cast<std::int64_t>(i + 1), mission_.plans[i].name});
}

void PlanReader::read_plan(const xml::Element& element) {
  Attributes attributes{element, problems_};
  Plan plan;
  plan.at = place(element.at);
  plan.name = attributes.name("name", NameKind::Loose);
  plan.priority = attributes.integer_or<std::uint8_t>("priority", 1, 255, default_plan_priority);
  bool condition = false, action = false;
  each_child(element, problems_,
             {{"When",
               [&](const auto& child) {
                 read_when(child, plan);
                 condition = true;
               },
               1},
              {"Do",
               [&](const auto& child) {
                 read_do(child, plan);
                 action = true;
               },
               most_steps}});
  step_names_.resolve_names(plan);
  check_answers(element, plan, draft_);
  if (!condition) problems_.add(element, "E0106", "<Plan> needs a <When>");
  if (!action) problems_.add(element, "E0106", "<Plan> needs a <Do>");
  if (plan.name == "default")
    problems_.add(*element.find("name"), "E0371", "what no plan answers has the name 'default'", "another name");
  if (!plan.name.empty()) plan_names_.add(plan.name, plan.at, problems_, element.name.size() + 1);
  mission_.plans.push_back(std::move(plan));
}

void PlanReader::read_when(const xml::Element& element, Plan& plan) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  plan.severities = attributes.list_of<Severity>("severity", {});
  const auto* subsystem = attributes.optional("subsystem");
  const auto* event = attributes.optional("event");
  const auto* mode = attributes.optional("mode");
  const SubsystemDescriptor* found = subsystem == nullptr ? nullptr : draft_.find(*subsystem, subsystem->value, true);
  if (subsystem != nullptr) plan.subsystem = subsystem->value;
  if (mode != nullptr) {
    plan.mode = mode->value;
    std::vector<std::string_view> known;
    for (const Mode& candidate : mission_.modes) known.push_back(candidate.name);
    if (mission_.find_mode(plan.mode) == nullptr)
      problems_.add(*mode, "E0305", fmt::format("mode {} is not defined", in_quotes(plan.mode)),
                    did_you_mean(plan.mode, known));
  }
  if (event == nullptr) return;
  plan.event = event->value;
  if (!draft_.whole || (subsystem != nullptr && found == nullptr)) return;
  std::vector<std::string_view> known;
  bool fires = plan.severities.empty();
  const auto add = [&](const SubsystemDescriptor& candidate) {
    for (const Event& e : candidate.events) {
      const bool told_of_it = &candidate == &mission_.supervisor && found != nullptr &&
                              may_be_told_of(e.name, found->name, mission_.ground.subsystem);
      if (found != nullptr && found != &candidate && !told_of_it) continue;
      known.push_back(e.name);
      fires =
          fires || (e.name == plan.event && std::ranges::find(plan.severities, e.severity) != plan.severities.end());
    }
  };
  for (const SubsystemDescriptor* member : mission_.everybody()) add(*member);
  if (std::ranges::find(known, plan.event) == known.end())
    problems_.add(*event, "E0311",
                  found == nullptr ? fmt::format("no subsystem has an event {}", in_quotes(plan.event))
                                   : fmt::format("'{}' has no event {}", found->name, in_quotes(plan.event)),
                  did_you_mean(plan.event, known));
  else if (!fires)
    problems_.add(*element.find("severity"), "E0325",
                  fmt::format("the plan never begins: event {} has another severity", in_quotes(plan.event)),
                  "leave severity out, or name the event's");
  else if (plan.event == event_of_local_stop)
    problems_.add(*event, "E0325",
                  fmt::format("the plan never begins: {} tells of a stop that is carried out", plan.event),
                  "everything stops by it; leave the plan out");
  else if (is_unplanned(plan.event))
    problems_.add(*event, "E0325", fmt::format("the plan never begins: {} tells of other plans", plan.event),
                  "name the event that the other plan answers");
}

void PlanReader::read_do(const xml::Element& element, Plan& plan) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* action = attributes.required("action");
  const StepWord* word = action != nullptr ? find_plan_step(action->value) : nullptr;
  PlanStep step;
  // Before its attributes: they may be of whom it moves.
  if (const auto* whom = attributes.optional("subsystem"); whom != nullptr && word != nullptr) {
    if (!word->names_subject)
      problems_.add(*whom, "E0317", fmt::format("the action '{}' takes no subsystem", word->name),
                    "it is for the subsystem whose event it is");
    else if (draft_.find(*whom, whom->value, false) != nullptr) step.subsystem = whom->value;
  }
  if (word != nullptr) {
    step.kind = action->value;
    for (const StepAttribute& described : word->attributes)
      step.values.push_back(read_value(attributes, described, plan.steps.size(), step));
  }
  std::vector<std::string_view> known;
  for (const StepWord& other : plan_steps) {
    known.push_back(other.name);
    for (const StepAttribute& foreign : other.attributes) {
      const auto* at = attributes.optional(foreign.name);
      if (at == nullptr || word == nullptr) continue;
      if (std::ranges::find(word->attributes, foreign.name, &StepAttribute::name) == word->attributes.end())
        problems_.add(*at, "E0317", fmt::format("the action '{}' takes no {}", word->name, foreign.name));
    }
  }
  if (word != nullptr) plan.steps.push_back(std::move(step));
  else if (action != nullptr) attributes.unknown_word(*action, action->value, known);
}

/// What names something of somebody is looked up when the whole plan is read: it may say in <When> who that is.
std::int64_t PlanReader::read_value(Attributes& attributes, const StepAttribute& described, std::size_t place,
                                    PlanStep& step) {
  using enum StepAttribute::Kind;
  const auto fallback = described.otherwise.value_or(described.least);
  if (!described.otherwise && attributes.required(described.name) == nullptr) return fallback;
  switch (described.kind) {
    case SteadyState: {
      const State state = read_steady_state(attributes, described.name, State::SafeOperational, problems_);
      if (state == State::Operational)
        problems_.add(*attributes.optional(described.name), "E0370", "a plan lets nobody go who is stopped",
                      "Operational is commanded by the ground, a change of mode, or restart to=\"commanded\"");
      return static_cast<std::int64_t>(state);
    }
    case SeenState:
      return static_cast<std::int64_t>(read_steady_state(attributes, described.name, State::Offline, problems_));
    case Word: {
      const auto* at = attributes.optional(described.name);
      if (at == nullptr) return fallback;
      const auto word = std::ranges::find(described.words, at->value, &StepAttribute::Word::text);
      if (word != described.words.end()) return word->value;
      std::vector<std::string_view> known;
      for (const auto& each : described.words) known.push_back(each.text);
      attributes.unknown_word(*at, at->value, known);
      return fallback;
    }
    case Number: return attributes.integer_or(described.name, described.least, described.most, fallback);
    default: break;
  }
  const auto* at = attributes.optional(described.name);
  if (at == nullptr) return fallback;
  step.words.resize(step.values.size() + 1);
  step.words.back() = at->value;
  step_names_.add({place, step.values.size(), at, described.kind});
  return fallback;
}

}  // namespace hirosco::descriptor::detail
