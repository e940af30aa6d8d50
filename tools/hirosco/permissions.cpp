// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <span>

#include "hirosco/descriptor/read/read.hpp"
#include "supervisor/supervision/data_handling/permission_table.hpp"
#include "tools/hirosco/commands.hpp"

/// `hirosco permissions`: who may ask what of whom, mode by mode, as the supervisor judges it.
namespace hirosco::tools {
namespace {

using supervisor::Origin;
using supervisor::PermissionRow;

constexpr std::uint16_t all_states = 0x03FF;

[[nodiscard]] std::string name_of(const Origin& origin, const descriptor::Mission& mission) {
  if (origin.is_ground()) return "ground";
  return mission.find_member(origin.apid())->name;
}

[[nodiscard]] std::string states_of(std::uint16_t states) {
  if (states == all_states) return "in any state";
  std::string text;
  for (const auto& row : EnumTexts<descriptor::State>::table)
    if ((states >> static_cast<unsigned>(row.value) & 1) != 0)
      text += fmt::format("{}{}", text.empty() ? "" : " ", row.text);
  return "in " + text;
}

/// A digit for each state that permits it, Offline first, a dot for one that does not.
[[nodiscard]] std::string bits_of(std::uint16_t states) {
  std::string text;
  for (unsigned n = 0; n < 10; ++n) text += (states >> n & 1) != 0 ? static_cast<char>('0' + n) : '.';
  return text;
}

void print_csv(const std::vector<PermissionRow>& rows, const descriptor::Mission& mission,
               const descriptor::Mode& mode) {
  for (const PermissionRow& row : rows)
    fmt::print("{},{},{},{},{},\"{}\",{},{},{},{}\n", mode.name, name_of(row.origin, mission), row.addressee->name,
               row.service, row.subtype, row.request, bits_of(row.permitted), bits_of(row.essential),
               bits_of(row.in_change), fmt::join(row.not_in, " "));
}

void print_requests(const std::string& head, const std::vector<const PermissionRow*>& rows) {
  fmt::print("    {}:", head);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    fmt::print("{} {}", i == 0 ? "" : ",", rows[i]->request);
    // "-": while no configuration is in force.
    if (!rows[i]->not_in.empty()) fmt::print(" (not in {})", fmt::join(rows[i]->not_in, ", "));
  }
  fmt::print("\n");
}

/// What is alike in one line, and what is refused in every state in the last one: nothing is left out.
void print_addressee(std::span<const PermissionRow> rows, bool also_refused) {
  std::map<std::pair<std::uint16_t, bool>, std::vector<const PermissionRow*>, std::greater<>> alike;
  for (const PermissionRow& row : rows)
    alike[{row.permitted, row.permitted != 0 && row.essential == row.permitted}].push_back(&row);
  for (const auto& [what, requests] : alike) {
    const auto& [states, essential] = what;
    if (states != 0) print_requests(states_of(states) + (essential ? ", past what waits" : ""), requests);
    else if (also_refused) print_requests("refused", requests);
  }
}

/// Of who is bound to neither mode nor state.
void print_exceptions(std::span<const PermissionRow> rows) {
  std::vector<const PermissionRow*> exceptions;
  for (const PermissionRow& row : rows)
    if (row.permitted != all_states) exceptions.push_back(&row);
  if (exceptions.empty()) fmt::print("    anything in any state\n");
  else print_requests("anything in any state, except", exceptions);
}

void print_words(std::span<const PermissionRow> rows, const descriptor::Mission& mission,
                 const descriptor::Mode& mode) {
  fmt::print("mode {} ({})\n", mode.name, mode.id);
  while (!rows.empty()) {
    const PermissionRow& first = rows.front();
    const auto other = std::ranges::find_if(rows, [&](const PermissionRow& row) {
      return row.addressee != first.addressee || name_of(row.origin, mission) != name_of(first.origin, mission);
    });
    const auto same = rows.first(static_cast<std::size_t>(other - rows.begin()));
    rows = rows.subspan(same.size());
    const bool any = std::ranges::any_of(same, [](const PermissionRow& row) { return row.permitted != 0; });
    if (!any && first.origin.is_subsystem()) continue;  // its descriptor does not name this one
    fmt::print("  {} to {}\n", name_of(first.origin, mission), first.addressee->name);
    if (first.origin.is_supervisor()) print_exceptions(same);
    else print_addressee(same, !first.origin.is_subsystem());
  }
}

}  // namespace

int permissions(const PermissionsOptions& options) {
  const auto mission = load_mission(options.mission);
  if (!mission) return exit_finding;
  if (!options.mode.empty() && mission->find_mode(options.mode) == nullptr) {
    fmt::print(stderr, "{} has no mode '{}'; it has", mission->name, options.mode);
    for (const auto& mode : mission->modes) fmt::print(stderr, " {}", mode.name);
    fmt::print(stderr, "\n");
    return exit_usage;
  }
  if (options.csv) fmt::print("mode,sender,addressee,service,subtype,request,permitted,essential,in_change,not_in\n");
  for (const auto& mode : mission->modes) {
    if (!options.mode.empty() && mode.name != options.mode) continue;
    const auto rows = supervisor::permission_table(*mission, mode);
    if (options.csv) print_csv(rows, *mission, mode);
    else print_words(rows, *mission, mode);
  }
  return exit_ok;
}

}  // namespace hirosco::tools
