// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>

#include "hirosco/descriptor/read/detail/other_members.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// Parameters that have the value of another subsystem's (docs/adr/0103): what a descriptor says, and what a mission makes of it.
namespace hirosco::descriptor::detail {

namespace {

constexpr std::int64_t most_age_ms = 3'600'000;

}  // namespace

void ParameterReader::read_from(Attributes& attributes, Parameter& parameter) {
  const auto* from = attributes.optional("from");
  if (from == nullptr) {
    if (const auto* age = attributes.optional("age_ms"); age != nullptr)
      problems_.add(place(age->at), "E0255", fmt::format("'{}' has an age and is from nobody", parameter.field.name),
                    "age_ms stands beside from", age->name.size());
    return;
  }
  parameter.from = from->value;
  parameter.age = std::chrono::milliseconds{attributes.required_integer<std::int64_t>("age_ms", 1, most_age_ms)};
  const auto dot = from->value.find('.');
  if (dot == 0 || dot == std::string::npos || dot + 1 == from->value.size())
    return problems_.add(*from, "E0110", in_quotes(from->value) + " names no parameter of another subsystem",
                         "SUBSYSTEM.PARAMETER, as <Subscribes> calls the subsystem");
  if (parameter.writable() || parameter.protection || parameter.persistent)
    problems_.add(*from, "E0255",
                  fmt::format("'{}' is from another subsystem and {}", parameter.field.name,
                              parameter.protection   ? "a protection"
                              : parameter.writable() ? "writable"
                                                     : "persistent"),
                  "it has the value of the other: set that");
  foreign_.emplace_back(subsystem_.parameters.size(), from);
}

/// Once all is read: whose it is must be heard, and nobody else sets it.
void ParameterReader::check_foreign() {
  for (const auto& [index, from] : foreign_) {
    const std::string subsystem = from->value.substr(0, from->value.find('.'));
    const auto heard = std::ranges::find(subsystem_.subscribes, subsystem, &Subscribes::subsystem);
    const bool structures =
        heard != subsystem_.subscribes.end() &&
        std::ranges::find(heard->things, Thing::Kind::Housekeeping, &Thing::kind) != heard->things.end();
    if (!structures) {
      problems_.add(*from, "E0254", fmt::format("housekeeping of {} is not heard", in_quotes(subsystem)),
                    fmt::format("say by which of its structures it comes: <Subscribes subsystem=\"{}\" "
                                "housekeeping=\"4800\"/>",
                                subsystem));
      continue;
    }
    heard->foreign.push_back(
        {.parameter = static_cast<std::uint16_t>(index), .name = from->value.substr(subsystem.size() + 1)});
  }
  for (const Configuration& configuration : subsystem_.configurations)
    for (const Configuration::Initial& initial : configuration.initial) {
      const Parameter& parameter = subsystem_.parameters[initial.parameter.parameter];
      if (!parameter.from.empty())
        problems_.add(initial.parameter.at, "E0255",
                      fmt::format("'{}' is from another subsystem and set by a configuration", parameter.field.name),
                      "it has the value of the other: set that", initial.parameter.text.size());
    }
}

void resolve_foreign_of(const MissionSubsystem& member, Subscribes& heard, const SubsystemDescriptor& other,
                        Problems& problems) {
  const NoForeign missing = resolve_foreign(member.subsystem, heard, other);
  if (missing.foreign == nullptr) return;
  const Parameter& parameter = member.subsystem.parameters[missing.foreign->parameter];
  std::vector<std::string_view> known;
  for (const Parameter& each : other.parameters) known.push_back(each.field.name);
  problems.add(parameter.field.at, "E0374",
               fmt::format("{} of '{}', whose value '{}' has, cannot be had: {}", in_quotes(missing.foreign->name),
                           other.name, parameter.field.name, missing.why),
               did_you_mean(missing.foreign->name, known), 8);
}

namespace {

/// Where the value of a parameter comes from: a step towards its source. Null: it is somebody's own, or not known.
struct Source {
  const MissionSubsystem* member{nullptr};
  std::uint16_t parameter{0};
};
[[nodiscard]] Source source_of(const Mission& mission, const Source& of) {
  for (const Subscribes& heard : of.member->subsystem.subscribes)
    for (const Foreign& foreign : heard.foreign) {
      if (foreign.parameter != of.parameter) continue;
      const MissionSubsystem* other = mission.find_subsystem(heard.apid);
      const auto place = other == nullptr ? std::nullopt : find_place(other->subsystem, foreign.name);
      return place ? Source{other, place->parameter} : Source{};
    }
  return {};
}

}  // namespace

/// Each way ends at somebody who makes the value, after at most as many steps as there are parameters.
void check_foreign_circles(MissionDraft& draft) {
  std::size_t most = 0;
  for (const MissionSubsystem& member : draft.mission.subsystems) most += member.subsystem.parameters.size();
  for (const MissionSubsystem& member : draft.mission.subsystems)
    for (const Subscribes& heard : member.subsystem.subscribes)
      for (const Foreign& foreign : heard.foreign) {
        const Source begin{&member, foreign.parameter};
        Source at = begin;
        bool back = false;
        for (std::size_t step = 0; step < most && at.member != nullptr && !back; ++step) {
          at = source_of(draft.mission, at);
          back = at.member == begin.member && at.parameter == begin.parameter;
        }
        if (!back) continue;
        const Field& field = member.subsystem.parameters[foreign.parameter].field;
        Problems problems{member.subsystem.file};
        problems.add(field.at, "E0375",
                     fmt::format("the value of '{}' comes, by way of others, from itself", field.name),
                     "somebody has to make it", 8);
        draft.subsystem_problems.push_back(problems.take());
      }
}

}  // namespace hirosco::descriptor::detail
