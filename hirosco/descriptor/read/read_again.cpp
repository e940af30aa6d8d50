// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "hirosco/descriptor/read/brought_files.hpp"
#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::descriptor {
namespace {

/// What was resolved when the flight began is what is meant.
void resolve_as(std::vector<Thing>& things, const std::vector<Thing>& known) {
  for (Thing& thing : things)
    for (const Thing& before : known)
      if (before.kind == thing.kind && before.name == thing.name) thing = before;
}

}  // namespace

Reading<SubsystemDescriptor> read_again(const SubsystemDescriptor& flown, std::string_view text,
                                        const std::vector<std::pair<std::string, std::string>>& changes) {
  Reading<SubsystemDescriptor> reading = read_subsystem(
      flown.file, [&](const std::filesystem::path&) -> Result<std::string> { return std::string{text}; });
  if (!reading.value) return reading;
  for (Commands& commands : reading.value->commands) {
    const auto known = std::ranges::find(flown.commands, commands.subsystem, &Commands::subsystem);
    if (known == flown.commands.end()) continue;
    commands.apid = known->apid;
    commands.file = known->file;
    commands.requests = known->requests;
    resolve_as(commands.things, known->things);
  }
  for (Subscribes& subscribes : reading.value->subscribes) {
    const auto known = std::ranges::find(flown.subscribes, subscribes.subsystem, &Subscribes::subsystem);
    if (known == flown.subscribes.end()) continue;
    subscribes.apid = known->apid;
    subscribes.file = known->file;
    resolve_as(subscribes.things, known->things);
    // What is heard cannot change in flight: where it stands does not either.
    if (subscribes.foreign.size() == known->foreign.size())
      for (std::size_t i = 0; i < known->foreign.size(); ++i) {
        subscribes.foreign[i].structure = known->foreign[i].structure;
        subscribes.foreign[i].offset = known->foreign[i].offset;
      }
  }
  for (const auto& [word, change] : changes) {
    if (needs_other(word)) continue;
    const auto applied = apply_change(*reading.value, word, change);
    if (applied) continue;
    reading.problems.push_back({.file = flown.file,
                                .at = {},
                                .code = "E0204",
                                .message = fmt::format("{} {}: {}", word, change, applied.error().text),
                                .hint = "the mission, or a stored value, changes what is not there any more"});
    reading.value.reset();
    return reading;
  }
  return reading;
}

Reading<Mission> read_again(const Mission& flown, const std::filesystem::path& file, std::string text,
                            const FileSource& disk) {
  return read_mission(flown.file, [&](const std::filesystem::path& asked) -> Result<std::string> {
    if (asked == file) return text;
    if (bringing_format_of(asked) != nullptr) return disk(asked);
    const auto known = flown.texts.find(asked);
    if (known == flown.texts.end()) return fail(ErrorCode::NotFound, "is no file of this flight");
    return *known->second;
  });
}

}  // namespace hirosco::descriptor
