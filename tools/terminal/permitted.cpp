// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/permitted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "hirosco/pus/packet/failure_code.hpp"
#include "supervisor/supervision/data_handling/permission_table.hpp"
#include "tools/terminal/verdict.hpp"

namespace hirosco::terminal {
namespace {

constexpr std::uint16_t in_all_states = 0x03FF;

}  // namespace

std::string while_in(std::uint16_t states) {
  if (states == in_all_states) return "in any state";
  std::vector<std::string> names;
  for (const auto& row : EnumTexts<descriptor::State>::table)
    if ((states >> static_cast<unsigned>(row.value) & 1) != 0) names.push_back(state_words(row.text));
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  return "while it is " + text;
}

std::string permitted_where(const descriptor::Mission& mission, const descriptor::SubsystemDescriptor& addressee,
                            std::string_view request) {
  std::vector<std::pair<std::uint16_t, std::vector<std::string>>> alike;  // states, and the modes in which they permit
  for (const auto& mode : mission.modes)
    for (const auto& row : supervisor::permission_table(mission, mode)) {
      if (!row.origin.is_ground() || row.addressee->id != addressee.id || row.request != request || row.permitted == 0)
        continue;
      const auto same =
          std::ranges::find(alike, row.permitted, &std::pair<std::uint16_t, std::vector<std::string>>::first);
      if (same == alike.end()) alike.push_back({row.permitted, {mode.name}});
      else same->second.push_back(mode.name);
    }
  std::string text;
  for (const auto& [states, modes] : alike) {
    text += text.empty() ? "" : "; ";
    text += modes.size() == 1 ? "mode " : "modes ";
    for (std::size_t i = 0; i < modes.size(); ++i) text += (i == 0 ? "" : ", ") + modes[i];
    text += " " + while_in(states);
  }
  return text;
}

std::string permitted_to_others(const descriptor::Mission& mission, const descriptor::SubsystemDescriptor& addressee,
                                std::string_view request) {
  std::vector<std::string_view> names;
  for (const auto& mode : mission.modes)
    for (const auto& row : supervisor::permission_table(mission, mode)) {
      const bool asked = row.addressee->id == addressee.id && row.request == request && row.permitted != 0;
      if (!asked || !row.origin.is_subsystem()) continue;
      const std::string_view name = mission.find_member(row.origin.apid())->name;
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  std::string text;
  for (const std::string_view name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

std::string ended_by(std::uint16_t failure_code) {
  if (failure_code != static_cast<std::uint16_t>(pus::FailureCode::Aborted)) return {};
  return "ended by another request, a stop, a plan or the loss of a device: hirosco why";
}

}  // namespace hirosco::terminal
