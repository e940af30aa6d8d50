// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/subsystem_handling/version_texts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hirosco/descriptor/model/in_flight.hpp"
#include "hirosco/descriptor/read/brought_files.hpp"
#include "supervisor/keeper/kept.hpp"
#include "supervisor/supervision/data_handling/persistent_values/stored_values.hpp"
#include "supervisor/supervision/realtime_links/unprovided_fields.hpp"

namespace hirosco::supervisor {

using descriptor::MissionSubsystem;
using descriptor::TakenBy;

namespace {

/// What the keeper holds for the next supervisor, but for paths and lengths.
constexpr std::size_t most_octets_of_texts = texts_octets / 2 - (std::size_t{64} << 10);

/// Where a text that is not in force stands among those of the mission: behind a file as if that were a folder, where no file can be.
[[nodiscard]] std::filesystem::path place_of(const std::filesystem::path& file, std::string_view version) {
  return file / ("@" + std::string{version});
}

/// Of what comes with a version, in one line of the story.
constexpr std::size_t most_named = 20;

/// The parts that the program of this version has to have.
[[nodiscard]] std::string additions(const descriptor::SubsystemDescriptor& flown,
                                    const descriptor::SubsystemDescriptor& fresh) {
  std::string words;
  std::size_t count = 0;
  for (const auto& each : descriptor::obstacles(flown, fresh, TakenBy::SameProcess))
    if (each.addition && ++count <= most_named) words.append(words.empty() ? "" : ", ").append(each.what);
  return count <= most_named ? words : words + fmt::format(" and {} more", count - most_named);
}

}  // namespace

MissionSubsystem& VersionTexts::flown(const Member& subject) {
  return *std::ranges::find(craft_.mission.subsystems, subject.apid(),
                            [](const MissionSubsystem& each) { return each.subsystem.id; });
}

VersionTexts::Found VersionTexts::look(Member& subject, std::uint16_t asked_by) {
  if (parts_.readings == nullptr) return Found::InForce;
  if (late_) return Found::NotYet;
  if (reading_ != subject.apid()) {
    // One file at a time, judged with all others as they are: none of them changes in this moment.
    const bool changes = std::ranges::any_of(craft_.members, [&](const Member& each) {
      return each.descriptor_changes || (each.exchanged && each.brings_text);
    });
    if (reading_ || changes || !parts_.readings->begin(craft_.mission, subject.descriptor().file)) return Found::NotYet;
    reading_ = subject.apid();
  }
  auto reading = parts_.readings->outcome();
  if (!reading) return Found::NotYet;
  reading_.reset();
  return judge(subject, std::move(*reading), asked_by);
}

VersionTexts::Found VersionTexts::judge(Member& subject, DescriptorReading reading, std::uint16_t asked_by) {
  const MissionSubsystem& now = flown(subject);
  const auto& file = now.subsystem.file;
  const auto refuse = [&](const DescriptorProblems& problems) {
    problems_ = problems.size();
    tell_problems(craft_, parts_.own, subject.apid(), asked_by, problems);
    craft_.tell(
        fmt::format("{} stays the version that it is: {} says neither what is in force nor that and more; where "
                    "it says what is in force, nothing but the program changes",
                    now.subsystem.name, file.string()),
        subject.apid());
    return Found::Refused;
  };
  if (reading.text && now.subsystem.text && *reading.text == *now.subsystem.text) return Found::InForce;
  if (!reading.mission.value) return refuse(reading.mission.problems);
  DescriptorProblems problems;
  for (const MissionSubsystem& other : craft_.mission.subsystems)
    if (other.subsystem.file == file && other.subsystem.id != subject.apid())
      add_problem(problems, file, {},
                  fmt::format("it differs from what flies, and {} flies by it, too", other.subsystem.name),
                  "a version takes a text for itself alone: a file of its own for each, or the text as it is in force");
  const auto* found = reading.mission.value->find_subsystem(subject.apid());
  if (found == nullptr || found->subsystem.name != now.subsystem.name) {
    add_problem(problems, file, {}, "name or id of " + now.subsystem.name + " cannot change in flight",
                "everybody knows it by them");
    return refuse(problems);
  }
  add_obstacles(problems, file, descriptor::obstacles(now.subsystem, found->subsystem, TakenBy::AnotherProcess));
  MissionSubsystem tried = *found;
  carry_values(now, tried, problems);
  if (octets_beside(*reading.text, reading.mission.value->texts) > most_octets_of_texts)
    add_problem(problems, file, {}, "there is no room to keep the text before",
                fmt::format("all texts of a flight take {} octets at most", most_octets_of_texts));
  if (!problems.empty()) return refuse(problems);
  fresh_.insert_or_assign(subject.apid(),
                          Fresh{*found, std::move(reading.text), std::move(reading.mission.value->texts)});
  subject.brings_text = true;
  return Found::Another;
}

/// Of all texts once this one is in force and the one before is kept; of files that are brought along, as they are now.
std::size_t VersionTexts::octets_beside(const std::string& text, const MissionTexts& read) const {
  std::size_t octets = text.size();
  for (const auto& [path, each] : craft_.mission.texts)
    if (descriptor::bringing_format_of(path) == nullptr || !read.contains(path)) octets += each->size();
  for (const auto& [path, each] : read)
    if (descriptor::bringing_format_of(path) != nullptr) octets += each->size();
  return octets;
}

void VersionTexts::let_go(Member& subject) {
  if (reading_ == subject.apid()) late_ = true;
  fresh_.erase(subject.apid());
  subject.brings_text = false;
}

void VersionTexts::watch() {
  if (!late_ || !parts_.readings->outcome()) return;
  late_ = false;
  reading_.reset();
}

void VersionTexts::take(const Member& subject, const std::string& leaving) {
  auto found = fresh_.extract(subject.apid());
  if (found.empty()) return;
  MissionSubsystem& now = flown(subject);
  Fresh& fresh = found.mapped();
  const std::string added = additions(now.subsystem, fresh.declared.subsystem);
  keep(now, leaving);
  put(now, std::move(fresh.declared), "as it is now");
  take_texts(craft_, now.subsystem.file, std::move(fresh.text), std::move(fresh.texts));
  if (!added.empty())
    craft_.tell(
        fmt::format("of {} {}: hirosco tc, status and log read it in the file; it has names in a ground station "
                    "that is started now (hirosco ground --archive FILE), and in a client that is exported anew",
                    now.subsystem.name, added),
        subject.apid());
}

void VersionTexts::go_back(const Member& subject, const std::string& leaving, const std::string& version) {
  const auto found = kept_.find({subject.apid(), version});
  if (found == kept_.end()) return;
  MissionSubsystem& now = flown(subject);
  MissionSubsystem declared = found->second;
  auto text = declared.subsystem.text;
  // Read again since, it may say the same.
  if (text && now.subsystem.text && *text == *now.subsystem.text) return;
  // What failed on trial under the name of a version that was confirmed is not what that flew by.
  if (!has(subject.apid(), leaving)) keep(now, leaving);
  put(now, std::move(declared), "as it was");
  if (text) craft_.mission.texts[now.subsystem.file] = std::move(text);
  // It stands among the texts once, as that in force: room for it twice nobody has judged. A next supervisor that finds no text to go back to
  // starts the version before by that in force.
  craft_.mission.texts.erase(place_of(now.subsystem.file, version));
  kept_.erase(found);
  craft_.tell(fmt::format("{} flies by the text before: who reads {} needs that text in it again", now.subsystem.name,
                          now.subsystem.file.string()),
              subject.apid());
  for (const std::string& each : unprovided_fields(craft_.mission, now.subsystem))
    craft_.tell(each + ", which it provides no more: LINK is refused until who reads it is another version, too",
                subject.apid());
}

/// As it was declared: what was set by then may be another when it is gone back to.
void VersionTexts::keep(const MissionSubsystem& flown, const std::string& version) {
  MissionSubsystem declared = flown;
  parts_.stored.undo(declared.subsystem);
  if (flown.subsystem.text) craft_.mission.texts[place_of(flown.subsystem.file, version)] = flown.subsystem.text;
  kept_.insert_or_assign({flown.subsystem.id, version}, std::move(declared));
}

void VersionTexts::put(MissionSubsystem& flown, MissionSubsystem declared, std::string_view how) {
  const auto text = declared.subsystem.text;
  // Before what goes on is looked at: of what was stored it forgets what does not fit any more.
  parts_.stored.redeclared(declared.subsystem);
  std::erase_if(flown.overrides,
                [&](const descriptor::Override& each) { return !apply_override(declared.subsystem, to_string(each)); });
  put_in_force(craft_, parts_.own, flown, std::move(declared), text ? *text : std::string{}, how);
}

void VersionTexts::keep_only(const Member& subject, const std::string* version) {
  std::erase_if(kept_, [&](const auto& each) {
    return each.first.first == subject.apid() && (version == nullptr || each.first.second != *version);
  });
  const auto& file = subject.descriptor().file;
  const std::string all = place_of(file, "").native();
  std::erase_if(craft_.mission.texts, [&](const auto& each) {
    return each.first.native().starts_with(all) && (version == nullptr || each.first != place_of(file, *version));
  });
}

bool VersionTexts::recall(const Member& subject, const std::string& version) {
  const auto& file = subject.descriptor().file;
  const auto text = craft_.mission.texts.find(place_of(file, version));
  if (text == craft_.mission.texts.end()) return false;
  const auto reading = descriptor::read_again(craft_.mission, file, *text->second,
                                              [&](const std::filesystem::path& asked) -> Result<std::string> {
                                                const auto known = craft_.mission.texts.find(asked);
                                                if (known == craft_.mission.texts.end())
                                                  return fail(ErrorCode::NotFound, "is no file of this flight");
                                                return *known->second;
                                              });
  const auto* found = reading.value ? reading.value->find_subsystem(subject.apid()) : nullptr;
  if (found == nullptr) {
    craft_.tell(subject.descriptor().name + "'s text before cannot be read: it stays by the one in force",
                subject.apid());
    return false;
  }
  kept_.insert_or_assign({subject.apid(), version}, *found);
  return true;
}

}  // namespace hirosco::supervisor
