// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "hirosco/descriptor/read/detail/mission_parts.hpp"

/// Electrical power of a mission: what there is at most, and who measures what there is now (docs/adr/0124) and what is drawn (docs/adr/0237).
namespace hirosco::descriptor::detail {
namespace {

constexpr std::int64_t most_measurement_age_ms = 3'600'000;
constexpr std::size_t most_draws = 96;

[[nodiscard]] std::vector<std::string_view> names_of(const Mission& mission) {
  std::vector<std::string_view> known;
  for (const MissionSubsystem& each : mission.subsystems) known.push_back(each.subsystem.name);
  return known;
}

/// SUBSYSTEM.PARAMETER, which tells power in W by a report that comes often enough. `measures`: what it is to measure, in words.
[[nodiscard]] std::optional<MeasuredPower> read_measured(const xml::Attribute& measured, Duration age,
                                                         const Mission& mission, std::string_view measures,
                                                         Problems& problems) {
  const auto refuse_as = [&](std::string_view code, const std::string& message, const std::string& hint) {
    problems.add(measured, code, message, hint);
    return std::nullopt;
  };
  const auto dot = measured.value.find('.');
  if (dot == 0 || dot == std::string::npos || dot + 1 == measured.value.size())
    return refuse_as("E0110", in_quotes(measured.value) + " names no parameter of a subsystem",
                     "SUBSYSTEM.PARAMETER, as the mission calls the subsystem");
  const std::string name = measured.value.substr(0, dot), parameter = measured.value.substr(dot + 1);
  const MissionSubsystem* member = mission.find_subsystem(name);
  if (member == nullptr)
    return refuse_as("E0304", fmt::format("subsystem {} is not in the mission", in_quotes(name)),
                     did_you_mean(name, names_of(mission)));
  const auto refuse = [&](const std::string& why, const std::string& hint) {
    return refuse_as("E0376", fmt::format("{} measures no {}: {}", in_quotes(measured.value), measures, why), hint);
  };
  const auto found = find_place(member->subsystem, parameter);
  if (!found) {
    std::vector<std::string_view> known;
    for (const Parameter& each : member->subsystem.parameters) known.push_back(each.field.name);
    return refuse("it has no such parameter", did_you_mean(parameter, known));
  }
  const auto fields = fields_of(member->subsystem, *found);
  if (fields.size() != 1 || fields[0].type != Type::Double || fields[0].elements() != 1 || fields[0].unit != "W")
    return refuse("it is no single DOUBLE in W", "type=\"DOUBLE\" unit=\"W\"");
  const auto at = find_reported(member->subsystem, *found, age);
  if (!at) return refuse(at.error(), "add it to a structure of the subsystem, or raise age_ms");
  return MeasuredPower{.name = measured.value, .age = age, .apid = member->subsystem.id, .at = *at};
}

/// What members draw, and by whom it is measured (docs/adr/0237).
void read_draw(const xml::Element& element, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  const auto* of = attributes.required("of");
  const auto* measured = attributes.required("measured");
  using std::chrono::milliseconds;
  const milliseconds age{attributes.required_integer<std::int64_t>("age_ms", 1, most_measurement_age_ms)};
  PowerDraw draw;
  draw.longer_than =
      milliseconds{attributes.required_integer<std::int64_t>("longer_than_ms", 1, most_measurement_age_ms)};
  draw.beyond_w = attributes.watts("beyond_W").value_or(0);
  if (of == nullptr || measured == nullptr || age.count() <= 0 || !draft.whole) return;
  for (const std::string_view name : words(of->value)) {
    const MissionSubsystem* member = draft.mission.find_subsystem(name);
    if (member == nullptr) {
      draft.problems.add(*of, "E0304", fmt::format("subsystem {} is not in the mission", in_quotes(name)),
                         did_you_mean(name, names_of(draft.mission)));
      return;
    }
    if (std::ranges::find(draw.of, member->subsystem.id) == draw.of.end()) draw.of.push_back(member->subsystem.id);
    else draft.problems.add(*of, "E0113", in_quotes(name) + " stands twice");
  }
  if (draw.of.empty()) return draft.problems.add(*of, "E0109", "attribute 'of' is empty", "who draws it");
  auto found = read_measured(*measured, age, draft.mission, "draw", draft.problems);
  if (!found) return;
  draw.measured = std::move(*found);
  draft.mission.power_draws.push_back(std::move(draw));
}

}  // namespace

void read_power(const xml::Element& element, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  each_child(element, draft.problems, {{"Draw", [&](const auto& draw) { read_draw(draw, draft); }, most_draws}});
  if (attributes.required("budget_W") != nullptr) draft.mission.power_budget_w = attributes.watts("budget_W");
  const auto* measured = attributes.optional("measured");
  if (measured == nullptr) {
    for (const char* name : {"age_ms", "least_W"})
      if (const auto* at = attributes.optional(name))
        draft.problems.add(place(at->at), "E0376", fmt::format("{} is for a budget that is measured", name),
                           "measured=\"SUBSYSTEM.PARAMETER\" stands beside it", at->name.size());
    return;
  }
  const std::chrono::milliseconds age{attributes.required_integer<std::int64_t>("age_ms", 1, most_measurement_age_ms)};
  draft.mission.power_least_w = attributes.watts("least_W").value_or(0);
  if (draft.mission.power_budget_w && draft.mission.power_least_w > *draft.mission.power_budget_w)
    draft.problems.add(*element.find("least_W"), "E0376",
                       fmt::format("{} W are more than the budget of {} W", draft.mission.power_least_w,
                                   *draft.mission.power_budget_w),
                       "budget_W is the most that there ever is");
  if (age.count() > 0 && draft.whole)
    draft.mission.power_measured = read_measured(*measured, age, draft.mission, "budget", draft.problems);
}

}  // namespace hirosco::descriptor::detail
