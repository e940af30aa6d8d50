// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <charconv>

#include "hirosco/descriptor/read/detail/mission_reader.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// Whom a subsystem may command (adr 0062): what its descriptor says, who that is in a mission, and how its process is told.
namespace hirosco::descriptor {
namespace detail {

void SubsystemReader::read_commands(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  Commands commands;
  commands.at = place(element.at);
  commands.subsystem = attributes.name("subsystem");
  if (!commands.subsystem.empty())
    commanded_.add(commands.subsystem, commands.at, problems_, element.name.size() + 1, "name all functions in one");
  const auto* functions = attributes.required("functions");
  if (functions == nullptr) return;
  Unique names{"function", "E0201"};
  for (const auto function : words(functions->value)) {
    names.add(std::string{function}, place(functions->value_at), problems_, functions->value.size());
    commands.functions.emplace_back(function);
  }
  if (commands.functions.empty()) problems_.add(*functions, "E0109", "attribute 'functions' is empty");
  subsystem_.commands.push_back(std::move(commands));
}

/// Another subsystem than the descriptor's word names is commanded by this instance.
void MissionReader::read_redirected(const xml::Element& element, MissionSubsystem& member, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* subsystem = attributes.required("subsystem");
  const auto* to = attributes.required("to");
  if (subsystem == nullptr || to == nullptr) return;
  names.add(subsystem->value, place(subsystem->value_at), problems_, subsystem->value.size());
  std::vector<std::string_view> known;
  for (const Commands& commands : member.subsystem.commands) known.push_back(commands.subsystem);
  if (std::ranges::find(known, subsystem->value) == known.end())
    problems_.add(*subsystem, "E0304",
                  fmt::format("'{}' commands no subsystem {}", member.subsystem.name, in_quotes(subsystem->value)),
                  known.empty() ? "its descriptor says whom: <Commands>" : did_you_mean(subsystem->value, known));
  member.redirected.push_back({subsystem->value, to->value});
  redirections_.emplace_back(to, member.subsystem.name);
}

void MissionReader::resolve_commands() {
  if (!whole()) return;
  for (const auto& [to, commanding] : redirections_)
    if (const Subsystem* found = find(*to, to->value, false); found != nullptr && found->name == commanding)
      problems_.add(*to, "E0304", fmt::format("'{}' cannot command itself", commanding));
  for (MissionSubsystem& member : mission_.subsystems)
    for (Commands& commands : member.subsystem.commands) resolve_one(member, commands);
}

void MissionReader::resolve_one(const MissionSubsystem& member, Commands& commands) {
  const auto redirected = std::ranges::find(member.redirected, commands.subsystem, &Redirected::subsystem);
  const bool as_written = redirected == member.redirected.end();
  const std::string& name = as_written ? commands.subsystem : redirected->to;
  const MissionSubsystem* found = mission_.find_subsystem(name);
  if (found == nullptr || found == &member) {
    if (as_written)
      problems_.add(member.at, "E0304",
                    fmt::format("'{}' commands {}, which is {}", member.subsystem.name, in_quotes(name),
                                found == nullptr ? "not in the mission" : "itself"),
                    fmt::format("say who it is here: <Commands subsystem=\"{}\" to=\"...\"/>", commands.subsystem), 10);
    return;
  }
  const std::string_view missing = resolve(commands, found->subsystem);
  if (missing.empty()) return;
  std::vector<std::string_view> known;
  for (const Function& function : found->subsystem.functions) known.push_back(function.name);
  for (const CustomService& service : found->subsystem.services)
    for (const Function& request : service.requests) known.push_back(request.name);
  Problems problems{member.subsystem.file};
  problems.add(commands.at, "E0310", fmt::format("'{}' has no function {}", name, in_quotes(missing)),
               did_you_mean(missing, known), 9);
  subsystem_problems_.push_back(problems.take());
}

}  // namespace detail

std::string to_string(const Commands& commands) {
  return fmt::format("{}={}:{}", commands.subsystem, commands.apid, commands.file.string());
}

Result<> apply_commands(Subsystem& subsystem, std::string_view text, const FileSource& source) {
  const auto equals = text.find('=');
  const auto colon = text.find(':', equals == text.npos ? text.size() : equals);
  if (colon == text.npos) return fail(ErrorCode::InvalidArgument, "NAME=ID:FILE is wanted");
  const auto commands = std::ranges::find(subsystem.commands, text.substr(0, equals), &Commands::subsystem);
  if (commands == subsystem.commands.end()) return fail(ErrorCode::NotFound, "it commands no such subsystem");
  std::uint16_t id = 0;
  const auto read = std::from_chars(text.data() + equals + 1, text.data() + colon, id);
  if (read.ec != std::errc{} || read.ptr != text.data() + colon)
    return fail(ErrorCode::InvalidArgument, "NAME=ID:FILE is wanted");
  auto reading = read_subsystem(text.substr(colon + 1), source);
  if (!reading.value) return fail(ErrorCode::NotFound, "the descriptor of who is commanded cannot be read");
  reading.value->id = id;
  if (!resolve(*commands, *reading.value).empty())
    return fail(ErrorCode::NotFound, "who is commanded has no such function");
  return ok();
}

}  // namespace hirosco::descriptor
