// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/fresh_descriptor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "hirosco/descriptor/read/brought_files.hpp"
#include "hirosco/pus/st129_supervision/supervision_messages.hpp"
#include "hirosco/utilities/crc32.hpp"

namespace hirosco::supervisor {
namespace {

using descriptor::Diagnostic;

/// Each has a report of its own.
constexpr std::size_t most_problems_told = 64;

[[nodiscard]] std::string line_of(const Diagnostic& problem) {
  std::string line = fmt::format("{}:{}:{}: error: {}: {}", problem.file.string(), problem.at.line, problem.at.column,
                                 problem.code, problem.message);
  return problem.hint.empty() ? line : line + " (" + problem.hint + ")";
}

/// A value that begins its next Software-Init and that no telecommand could set any more.
[[nodiscard]] const descriptor::Parameter* outside(const descriptor::SubsystemDescriptor& fresh,
                                                   const descriptor::Override& kept) {
  const auto place = descriptor::find_place(fresh, kept.parameter);
  if (!place) return nullptr;
  bool good = true;
  auto value = kept.values.begin();
  for (const descriptor::Field& field : descriptor::fields_of(fresh, *place))
    for (std::uint32_t i = 0; i < field.values() && value != kept.values.end(); ++i, ++value) {
      const Number* const number = std::get_if<Number>(&*value);
      good = good && (number == nullptr ||
                      !((field.minimum && *number < *field.minimum) || (field.maximum && *number > *field.maximum)));
    }
  return good ? nullptr : &fresh.parameters[place->parameter];
}

}  // namespace

void add_problem(DescriptorProblems& problems, const std::filesystem::path& file, descriptor::Location at,
                 std::string message, std::string_view hint) {
  const bool known =
      std::ranges::any_of(problems, [&](const Diagnostic& each) { return each.at == at && each.message == message; });
  if (!known)
    problems.push_back({.file = file,
                        .at = at,
                        .code = descriptor::not_in_flight,
                        .message = std::move(message),
                        .hint = std::string{hint}});
}

void add_obstacles(DescriptorProblems& problems, const std::filesystem::path& file,
                   const std::vector<descriptor::Obstacle>& obstacles) {
  for (const auto& each : obstacles)
    add_problem(problems, file, each.at, each.what + (each.addition ? ": not by REREAD" : " cannot change in flight"),
                each.why);
}

void carry_values(const descriptor::MissionSubsystem& flown, descriptor::MissionSubsystem& fresh,
                  DescriptorProblems& problems) {
  const auto& file = flown.subsystem.file;
  fresh.overrides = flown.overrides;
  for (const descriptor::Override& kept : fresh.overrides) {
    if (const auto* parameter = outside(fresh.subsystem, kept))
      add_problem(problems, file, parameter->field.at,
                  fmt::format("the stored value of {} is outside its new range", kept.parameter), "set it before");
    if (const auto applied = apply_override(fresh.subsystem, to_string(kept)); !applied)
      add_problem(problems, file, {}, fmt::format("the value of {}: {}", kept.parameter, applied.error().text),
                  "it is stored, or the mission's");
  }
}

void tell_problems(Craft& craft, OwnSubsystem& own, std::uint16_t apid, std::uint16_t asked_by,
                   const DescriptorProblems& problems) {
  const std::string name = craft.name_of(apid);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const Diagnostic& problem = problems[i];
    craft.tell(name + " keeps its descriptor: " + line_of(problem), apid);
    if (i == most_problems_told) break;
    const auto data = pus::st129::write_descriptor_problem({.apid = apid,
                                                            .count = static_cast<std::uint16_t>(problems.size()),
                                                            .file = problem.file.string(),
                                                            .line = static_cast<std::uint32_t>(problem.at.line),
                                                            .column = static_cast<std::uint32_t>(problem.at.column),
                                                            .code = problem.code,
                                                            .what = problem.message,
                                                            .hint = problem.hint});
    own.telemetry().report(pus::st129::service_type, pus::st129::descriptor_problem, asked_by, data);
  }
  own.announce("DESCRIPTOR_REFUSED", {static_cast<double>(apid), static_cast<double>(problems.size())});
}

void put_in_force(Craft& craft, OwnSubsystem& own, descriptor::MissionSubsystem& flown,
                  descriptor::MissionSubsystem&& fresh, const std::string& text, std::string_view how) {
  const std::uint16_t apid = flown.subsystem.id;
  const std::uint32_t hash = crc32(std::as_bytes(std::span{text}));
  descriptor::take_over(flown.subsystem, std::move(fresh.subsystem));
  flown.brought = std::move(fresh.brought);
  craft.tell(
      fmt::format("{} flies by {} {}, CRC-32 {:08x}", flown.subsystem.name, flown.subsystem.file.string(), how, hash),
      apid);
  own.announce("DESCRIPTOR_TAKEN", {static_cast<double>(apid), static_cast<double>(hash)});
}

void take_texts(Craft& craft, const std::filesystem::path& file, std::shared_ptr<const std::string> text,
                MissionTexts&& read) {
  for (auto& [path, other] : read)
    if (descriptor::bringing_format_of(path) != nullptr) craft.mission.texts[path] = std::move(other);
  craft.mission.texts[file] = std::move(text);
}

}  // namespace hirosco::supervisor
