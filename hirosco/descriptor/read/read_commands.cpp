// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <charconv>

#include "hirosco/descriptor/model/supervisor_functions.hpp"
#include "hirosco/descriptor/read/detail/other_members.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"

/// Whom a subsystem may command (adr 0062): what its descriptor says, who that is in a mission, and how its process is told.
namespace hirosco::descriptor {
namespace detail {

namespace {

/// What the attribute names, each once.
void read_things(Attributes& attributes, std::string_view attribute, Thing::Kind kind, Problems& problems,
                 std::vector<Thing>& things) {
  const auto* named = attributes.optional(attribute);
  if (named == nullptr) return;
  Unique names{std::string{attribute}, "E0201"};
  const auto all = words(named->value);
  if (all.empty()) problems.add(*named, "E0109", fmt::format("attribute '{}' is empty", attribute));
  for (const auto name : all) {
    names.add(std::string{name}, place(named->value_at), problems, named->value.size());
    things.push_back({.kind = kind, .name = std::string{name}});
  }
}

}  // namespace

void read_commands(const xml::Element& element, Problems& problems, Unique& commanded, std::vector<Commands>& all) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  Commands commands;
  commands.at = place(element.at);
  commands.subsystem = attributes.name("subsystem");
  if (!commands.subsystem.empty())
    commanded.add(commands.subsystem, commands.at, problems, element.name.size() + 1, "name all functions in one");
  using enum Thing::Kind;
  read_things(attributes, "sets", Set, problems, commands.things);
  read_things(attributes, "reads", Read, problems, commands.things);
  read_things(attributes, "housekeeping", Housekeeping, problems, commands.things);
  read_things(attributes, "events", Event, problems, commands.things);
  const auto* functions = commands.things.empty() ? attributes.required("functions") : attributes.optional("functions");
  if (functions != nullptr) {
    Unique names{"function", "E0201"};
    for (const auto function : words(functions->value)) {
      names.add(std::string{function}, place(functions->value_at), problems, functions->value.size());
      commands.functions.emplace_back(function);
    }
    if (commands.functions.empty()) problems.add(*functions, "E0109", "attribute 'functions' is empty");
  }
  all.push_back(std::move(commands));
}

void read_subscribes(const xml::Element& element, Problems& problems, Unique& heard, std::vector<Subscribes>& all) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  Subscribes subscribes;
  subscribes.at = place(element.at);
  subscribes.subsystem = attributes.name("subsystem");
  if (!subscribes.subsystem.empty())
    heard.add(subscribes.subsystem, subscribes.at, problems, element.name.size() + 1, "name all of it in one");
  read_things(attributes, "housekeeping", Thing::Kind::Housekeeping, problems, subscribes.things);
  read_things(attributes, "events", Thing::Kind::Event, problems, subscribes.things);
  if (attributes.optional("housekeeping") == nullptr && attributes.optional("events") == nullptr)
    problems.add(element, "E0105", "<Subscribes> needs 'housekeeping' or 'events'",
                 "housekeeping=\"4800\" events=\"BURNT_OUT\"");
  all.push_back(std::move(subscribes));
}

/// Another subsystem than the descriptor's word names is commanded, or heard, by this instance.
void OtherMembers::read_redirected(const xml::Element& element, MissionSubsystem& member, Redirected::Kind kind,
                                   Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  const auto* subsystem = attributes.required("subsystem");
  const auto* to = attributes.required("to");
  if (subsystem == nullptr || to == nullptr) return;
  names.add(subsystem->value, place(subsystem->value_at), problems_, subsystem->value.size());
  const bool commands = kind == Redirected::Kind::Commands;
  std::vector<std::string_view> known;
  if (commands)
    for (const Commands& each : member.subsystem.commands) known.push_back(each.subsystem);
  else
    for (const Subscribes& each : member.subsystem.subscribes) known.push_back(each.subsystem);
  if (std::ranges::find(known, subsystem->value) == known.end())
    problems_.add(*subsystem, "E0304",
                  fmt::format("'{}' {} no subsystem {}", member.subsystem.name, commands ? "commands" : "hears",
                              in_quotes(subsystem->value)),
                  known.empty() ? fmt::format("its descriptor says whom: <{}>", element.name)
                                : did_you_mean(subsystem->value, known));
  member.redirected.push_back({kind, subsystem->value, to->value});
  redirections_.emplace_back(to, member.subsystem.name);
}

void OtherMembers::resolve_all() {
  if (!draft_.whole) return;
  for (const auto& [to, commanding] : redirections_)
    if (const auto* found = draft_.find(*to, to->value, true); found != nullptr && found->name == commanding)
      problems_.add(*to, "E0304", fmt::format("'{}' cannot command or hear itself", commanding));
  for (MissionSubsystem& member : mission_.subsystems) {
    for (Commands& commands : member.subsystem.commands) resolve_one(member, commands);
    for (Subscribes& subscribes : member.subsystem.subscribes) resolve_one(member, subscribes);
  }
  check_foreign_circles(draft_);
}

const SubsystemDescriptor* OtherMembers::find_other(const MissionSubsystem& member, const std::string& named,
                                                    Redirected::Kind kind) {
  const auto redirected = std::ranges::find_if(
      member.redirected, [&](const Redirected& each) { return each.kind == kind && each.subsystem == named; });
  const bool as_written = redirected == member.redirected.end();
  const std::string& name = as_written ? named : redirected->to;
  const SubsystemDescriptor* found = mission_.find_member(name);
  if (found != nullptr && found != &member.subsystem) return found;
  const bool commands = kind == Redirected::Kind::Commands;
  if (as_written)
    problems_.add(member.at, "E0304",
                  fmt::format("'{}' {} {}, which is {}", member.subsystem.name, commands ? "commands" : "hears",
                              in_quotes(name), found == nullptr ? "not in the mission" : "itself"),
                  fmt::format("say who it is here: <{} subsystem=\"{}\" to=\"...\"/>",
                              commands ? "Commands" : "Subscribes", named),
                  10);
  return nullptr;
}

void OtherMembers::resolve_one(const MissionSubsystem& member, Commands& commands) {
  const SubsystemDescriptor* found = find_other(member, commands.subsystem, Redirected::Kind::Commands);
  if (found == nullptr) return;
  Problems problems{member.subsystem.file};
  if (const std::string_view missing = resolve(commands, *found); !missing.empty()) {
    std::vector<std::string_view> known;
    for (const Function& function : found->functions) known.push_back(function.name);
    for (const CustomService& service : found->services)
      for (const Function& request : service.requests) known.push_back(request.name);
    problems.add(commands.at, "E0310", fmt::format("'{}' has no function {}", found->name, in_quotes(missing)),
                 did_you_mean(missing, known), 9);
  } else if (found == &mission_.supervisor) {
    check_asked_of_supervisor(member, commands, problems);
  }
  resolve_things(commands.things, *found, commands.at, problems);
  draft_.subsystem_problems.push_back(problems.take());
}

void OtherMembers::resolve_one(const MissionSubsystem& member, Subscribes& subscribes) {
  const SubsystemDescriptor* found = find_other(member, subscribes.subsystem, Redirected::Kind::Subscribes);
  if (found == nullptr) return;
  subscribes.apid = found->id;
  subscribes.file = found->file;
  Problems problems{member.subsystem.file};
  resolve_things(subscribes.things, *found, subscribes.at, problems);
  if (problems.count() == 0) resolve_foreign_of(member, subscribes, *found, problems);
  draft_.subsystem_problems.push_back(problems.take());
}

/// What is the ground's alone to ask, no descriptor declares: no permit would open it (docs/adr/0216).
void OtherMembers::check_asked_of_supervisor(const MissionSubsystem& member, const Commands& commands,
                                             Problems& problems) {
  for (const std::string& function : commands.functions)
    if (!is_for_subsystems(function))
      problems.add(commands.at, "E0357",
                   fmt::format("'{}' may not ask the supervisor for {}: that is the ground's alone",
                               member.subsystem.name, in_quotes(function)),
                   "ENTER_MODE, SAFE_ALL and SET_MODE are what a subsystem may ask it for", 9);
}

void OtherMembers::check_rows() const {
  if (!draft_.whole) return;
  const auto is_as_long = [](const Field& a, const Field& b) { return a.elements() == b.elements(); };
  const auto check = [&](const MissionSubsystem& member, const std::vector<Thing>& things, const Location& at) {
    std::vector<Thing> as_flown = things;
    if (resolve(as_flown, mission_.supervisor).thing != nullptr) return;  // reported
    for (std::size_t i = 0; i < things.size(); ++i) {
      if (std::ranges::equal(things[i].fields, as_flown[i].fields, is_as_long)) continue;
      Problems problems{member.subsystem.file};
      problems.add(at, "E0310",
                   fmt::format("{} of '{}' cannot be had: in this mission it has more rows than its descriptor says",
                               in_quotes(things[i].name), mission_.supervisor.name),
                   "take another structure, or parameter, of the supervisor", 9);
      draft_.subsystem_problems.push_back(problems.take());
    }
  };
  for (const MissionSubsystem& member : mission_.subsystems) {
    for (const Commands& commands : member.subsystem.commands)
      if (commands.apid == mission_.supervisor.id) check(member, commands.things, commands.at);
    for (const Subscribes& subscribes : member.subsystem.subscribes)
      if (subscribes.apid == mission_.supervisor.id) check(member, subscribes.things, subscribes.at);
  }
}

void OtherMembers::resolve_things(std::vector<Thing>& things, const SubsystemDescriptor& other, const Location& at,
                                  Problems& problems) {
  const NoThing missing = resolve(things, other);
  if (missing.thing == nullptr) return;
  std::vector<std::string_view> known;
  switch (missing.thing->kind) {
    case Thing::Kind::Event:
      for (const Event& each : other.events) known.push_back(each.name);
      break;
    case Thing::Kind::Housekeeping: break;
    default:
      for (const Parameter& each : other.parameters) known.push_back(each.field.name);
  }
  problems.add(at, "E0310",
               fmt::format("{} of '{}' cannot be had: {}", in_quotes(missing.thing->name), other.name, missing.why),
               known.empty() ? "a structure is named by its id" : did_you_mean(missing.thing->name, known), 9);
}

}  // namespace detail

namespace {

/// "NAME=ID:FILE", taken apart.
struct Other {
  std::string_view name;
  std::uint16_t id{0};
  std::string_view file;
};
[[nodiscard]] Result<Other> take_apart(std::string_view text) {
  const auto equals = text.find('=');
  const auto colon = text.find(':', equals == text.npos ? text.size() : equals);
  Other other;
  if (colon != text.npos) {
    const auto read = std::from_chars(text.data() + equals + 1, text.data() + colon, other.id);
    other.name = text.substr(0, equals);
    other.file = text.substr(colon + 1);
    if (read.ec == std::errc{} && read.ptr == text.data() + colon) return other;
  }
  return fail(ErrorCode::InvalidArgument, "NAME=ID:FILE is wanted");
}
[[nodiscard]] Result<SubsystemDescriptor> read_other(const Other& other, const FileSource& source) {
  auto reading = read_subsystem(other.file, source);
  if (!reading.value) return fail(ErrorCode::NotFound, "the descriptor of the other cannot be read");
  reading.value->id = other.id;
  return std::move(*reading.value);
}

[[nodiscard]] std::string as_word(const std::string& name, std::uint16_t apid, const std::filesystem::path& file) {
  return fmt::format("{}={}:{}", name, apid, file.string());
}

}  // namespace

std::string to_string(const Commands& commands) { return as_word(commands.subsystem, commands.apid, commands.file); }
std::string to_string(const Subscribes& subscribes) {
  return as_word(subscribes.subsystem, subscribes.apid, subscribes.file);
}

Result<> apply_commands(SubsystemDescriptor& subsystem, std::string_view text, const FileSource& source) {
  HIROSCO_TRY_LET(const Other other, take_apart(text));
  const auto named = std::ranges::find(subsystem.commands, other.name, &Commands::subsystem);
  if (named == subsystem.commands.end()) return fail(ErrorCode::NotFound, "it commands no such subsystem");
  HIROSCO_TRY_LET(const SubsystemDescriptor described, read_other(other, source));
  if (!resolve(*named, described).empty()) return fail(ErrorCode::NotFound, "who is commanded has no such function");
  if (resolve(named->things, described).thing != nullptr)
    return fail(ErrorCode::NotFound, "who is commanded has no such parameter, structure or event");
  return ok();
}

Result<> apply_subscribes(SubsystemDescriptor& subsystem, std::string_view text, const FileSource& source) {
  HIROSCO_TRY_LET(const Other other, take_apart(text));
  const auto named = std::ranges::find(subsystem.subscribes, other.name, &Subscribes::subsystem);
  if (named == subsystem.subscribes.end()) return fail(ErrorCode::NotFound, "it hears no such subsystem");
  HIROSCO_TRY_LET(const SubsystemDescriptor described, read_other(other, source));
  named->apid = described.id;
  named->file = described.file;
  if (resolve(named->things, described).thing != nullptr)
    return fail(ErrorCode::NotFound, "who is heard has no such structure or event");
  if (resolve_foreign(subsystem, *named, described).foreign != nullptr)
    return fail(ErrorCode::Mismatch, "who is heard has no such parameter");
  return ok();
}

Result<> apply_other(SubsystemDescriptor& subsystem, std::string_view word, std::string_view text,
                     const FileSource& source) {
  return word == "--commands" ? apply_commands(subsystem, text, source) : apply_subscribes(subsystem, text, source);
}

}  // namespace hirosco::descriptor
