// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/named_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "hirosco/pus/requests.hpp"
#include "hirosco/pus/words/given_words.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "supervisor/platform/storage/database.hpp"
#include "tools/hirosco/commands.hpp"

namespace hirosco::tools {
namespace {

/// What the mission knows by name: a state, mode or configuration.
[[nodiscard]] std::optional<Number> number_named(const std::string& text, const std::string& function,
                                                 const descriptor::Mission& mission,
                                                 const descriptor::SubsystemDescriptor& subsystem) {
  const std::string wanted = lower_case(text);
  if (function == "SET_STATE")
    for (const auto& row : EnumTexts<descriptor::State>::table)
      if (lower_case(std::string{row.text}) == wanted) return static_cast<std::uint8_t>(row.value);
  if (function == "CONFIGURE")
    for (const auto& configuration : subsystem.configurations)
      if (lower_case(configuration.name) == wanted) return configuration.id;
  if (function == "SET_MODE" || function == "ENTER_MODE")
    for (const auto& mode : mission.modes)
      if (lower_case(mode.name) == wanted) return mode.id;
  if (function == "SET_DATABASE")
    for (const int number : {0, 1, 2})
      if (to_text(static_cast<supervisor::DatabaseStrategy>(number)) == wanted) return Number{number};
  return std::nullopt;
}

[[nodiscard]] std::expected<const descriptor::SubsystemDescriptor*, std::string> find_subsystem(
    const descriptor::Mission& mission, const std::string& name) {
  const std::string wanted = lower_case(name);
  if (wanted == lower_case(mission.supervisor.name)) return &mission.supervisor;
  for (const auto& member : mission.subsystems)
    if (lower_case(member.subsystem.name) == wanted) return &member.subsystem;
  std::vector<std::string> names{mission.supervisor.name};
  for (const auto& member : mission.subsystems) names.push_back(member.subsystem.name);
  const std::string begin =
      name.empty() ? std::string{"of which subsystem? the mission"}
                   : fmt::format("no subsystem '{}'{}; mission {}", name, did_you_mean(name, names), mission.name);
  return std::unexpected(fmt::format("{} has {}", begin, fmt::join(names, ", ")));
}

[[nodiscard]] std::string usage_of(const descriptor::Function& function) {
  return fmt::format("\n  {}", pus::usage_text(function));
}

}  // namespace

std::expected<NamedRequest, std::string> named_request(const descriptor::Mission& mission, const std::string& subsystem,
                                                       const std::string& function,
                                                       std::span<const std::string> arguments) {
  const auto found = find_subsystem(mission, subsystem);
  if (!found) return std::unexpected(found.error());
  const std::vector<descriptor::Function> functions = pus::requests_of(**found);
  const auto request =
      std::ranges::find_if(functions, [&](const auto& f) { return lower_case(f.name) == lower_case(function); });
  if (request == functions.end()) {
    std::vector<std::string> names;
    for (const auto& known : functions) names.push_back(known.name);
    std::string none = function.empty() ? fmt::format("which function? {} has", (*found)->name)
                                        : fmt::format("{} has no function '{}'{}; it has", (*found)->name, function,
                                                      did_you_mean(function, names));
    for (const auto& known : functions) none += usage_of(known);
    return std::unexpected(std::move(none));
  }
  const auto values = pus::values_given(*request, arguments, [&](const std::string& word) {
    return number_named(word, request->name, mission, **found);
  });
  if (!values)
    return std::unexpected(
        fmt::format("{}; usage:{}", pus::misfit_text(*request, arguments, values.error()), usage_of(*request)));
  auto data = pus::encode_request(*request, *values);
  if (!data) return std::unexpected(fmt::format("{}; usage:{}", data.error().text, usage_of(*request)));
  return NamedRequest{*found, *request, std::move(*data)};
}

}  // namespace hirosco::tools
