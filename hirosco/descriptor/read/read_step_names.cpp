// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "hirosco/descriptor/read/detail/step_names.hpp"

namespace hirosco::descriptor::detail {

/// Of the plan that was just read, all names that its steps say.
void StepNames::resolve_names(Plan& plan) {
  for (const NamedInStep& named : std::exchange(named_in_steps_, {}))
    if (draft_.whole && named.step < plan.steps.size()) resolve_name(plan, plan.steps[named.step], named);
}

void StepNames::resolve_name(const Plan& plan, PlanStep& step, const NamedInStep& named) {
  using enum StepAttribute::Kind;
  const xml::Attribute& at = *named.at;
  std::int64_t& value = step.values[named.attribute];
  switch (named.kind) {
    case Subsystem: {
      if (const auto* found = draft_.find(at, at.value, false)) value = found->id;
      else return;
      // For the events of all there would be as many tasks, and one receiver.
      if (step.kind == "hand_over" && mission_.find_subsystem(plan.subsystem) == nullptr)
        problems_.add(at, "E0372", "the plan does not say whose task that is", "subsystem=\"...\" in <When>");
      return;
    }
    case Link: {
      const auto id = to_integer(at.value);
      if (id && (*id < 1 || *id > 255))
        problems_.add(at, "E0112", fmt::format("link {} is out of range", *id), "1 to 255");
      else if (!id || mission_.find_link(static_cast<std::uint8_t>(*id)) == nullptr)
        problems_.add(at, "E0309", fmt::format("link {} is not defined", in_quotes(at.value)));
      value = id.value_or(0);
      return;
    }
    case Plan: return;  // when all are read
    default: break;
  }
  // Whose function or configuration it is.
  const bool of_receiver = step.kind == "hand_over";
  const bool of_anybody = step.kind == "notify_network";
  std::string whose = !step.subsystem.empty() ? step.subsystem : plan.subsystem;
  if (of_receiver) whose = step.words.empty() ? std::string{} : step.words.front();
  const MissionSubsystem* member = mission_.find_subsystem(whose);
  if (member == nullptr && !of_anybody) {
    if (!of_receiver)
      problems_.add(at, "E0372", fmt::format("the plan does not say whose {} that is", at.name),
                    "subsystem=\"...\" here or in <When>");
    return;
  }
  if (named.kind == Configuration) {
    const auto* found = member->subsystem.find_configuration(at.value);
    std::vector<std::string_view> known;
    for (const auto& each : member->subsystem.configurations) known.push_back(each.name);
    if (found == nullptr)
      problems_.add(at, "E0316", fmt::format("'{}' has no configuration {}", whose, in_quotes(at.value)),
                    did_you_mean(at.value, known));
    else value = found->id;
    return;
  }
  if (named.kind == Function && of_anybody) return check_notice(at);
  if (named.kind == Function) {
    const auto& functions = member->subsystem.functions;
    const auto found = std::ranges::find(functions, at.value, &descriptor::Function::name);
    std::vector<std::string_view> known;
    for (const auto& each : functions) known.push_back(each.name);
    if (found == functions.end())
      problems_.add(at, "E0310", fmt::format("'{}' has no function {}", whose, in_quotes(at.value)),
                    did_you_mean(at.value, known));
    value = found - functions.begin();
    if (found != functions.end() && step.words.size() < 2) check_arguments(at, *found, step);
  }
  if (named.kind == Arguments && !step.words.empty())
    if (const auto* function = member->subsystem.find_function(step.words.front()))
      check_arguments(at, *function, step);
}

/// All of them are numbers, as many as declared, each in its range.
void StepNames::check_arguments(const xml::Attribute& at, const Function& function, PlanStep& step) {
  const auto given = step.words.size() > 1 ? words(step.words[1]) : std::vector<std::string_view>{};
  std::size_t wanted = 0;
  for (const auto& argument : function.arguments) wanted += argument.field.values();
  const auto refuse = [&](std::string_view why) {
    problems_.add(at, "E0372", fmt::format("{} is not called like this: {}", function.name, why),
                  "arguments=\"0.5 1\", in the order of its descriptor");
  };
  if (given.size() != wanted) return refuse(fmt::format("it takes {} numbers, these are {}", wanted, given.size()));
  step.arguments.clear();
  for (const auto& argument : function.arguments) {
    const Field& field = argument.field;
    if (field.type == Type::Text) return refuse("a plan gives no words");
    for (std::uint32_t i = 0; i < field.values(); ++i) {
      const std::string_view text = given[step.arguments.size()];
      double number = 0;
      const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
      const bool whole = field.type == Type::Float || field.type == Type::Double || std::trunc(number) == number;
      if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || !std::isfinite(number) || !whole)
        return refuse(fmt::format("{} is no value of {}", in_quotes(text), field.name));
      const bool below = field.minimum && number < field.minimum->real();
      const bool above = field.maximum && number > field.maximum->real();
      const auto is_it = [&](const EnumerationText& named) { return static_cast<double>(named.value) == number; };
      const bool unnamed = !argument.texts.empty() && std::ranges::none_of(argument.texts, is_it);
      if (below || above || unnamed) return refuse(fmt::format("{} is outside the range of {}", text, field.name));
      step.arguments.push_back(number);
    }
  }
  step.values[1] = static_cast<std::int64_t>(step.arguments.size());
}

/// A notice is a function without arguments, or with the APID of who has failed as its only one.
void StepNames::check_notice(const xml::Attribute& at) {
  std::vector<std::string_view> known;
  for (const MissionSubsystem& member : mission_.subsystems) {
    for (const descriptor::Function& function : member.subsystem.functions) {
      if (!is_notice(function)) continue;
      if (function.name == at.value) return;
      known.push_back(function.name);
    }
  }
  problems_.add(
      at, "E0310", fmt::format("nobody has a function {} for a notice", in_quotes(at.value)),
      known.empty() ? "no argument, or one UINT16, which is told whose event it is" : did_you_mean(at.value, known));
}

}  // namespace hirosco::descriptor::detail
