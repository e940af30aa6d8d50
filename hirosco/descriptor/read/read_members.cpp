// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/framework_parameters.hpp"
#include "hirosco/descriptor/model/supervisor_apid.hpp"
#include "hirosco/descriptor/read/detail/device_reader.hpp"
#include "hirosco/descriptor/read/detail/member_reader.hpp"
#include "hirosco/descriptor/read/detail/mission_parts.hpp"
#include "hirosco/utilities/os/installation.hpp"

/// Who flies in a mission, and what it changes in their descriptors.
namespace hirosco::descriptor::detail {
namespace {

/// A mission stands in missions/NAME/, what it may name in the tree two folders above.
constexpr int folders_above = 3;
/// Of a device, in all its configurations together.
constexpr std::size_t max_moved_fall_backs = 256;

/// A file that comes with HIROSCO, by its name there.
bool is_shipped(std::string_view text) { return text.starts_with(shipped_prefix); }

void read_changed_setting(const xml::Element& element, MissionSubsystem& member, DeviceChange& changed, Unique& names,
                          Problems& problems) {
  const std::size_t before = changed.settings.size();
  read_setting(element, problems, names, changed.settings);
  if (changed.settings.size() == before) return;
  const Setting& setting = changed.settings.back();
  if (apply_change(member.subsystem, "--setting", fmt::format("{}:{}={}", changed.device, setting.name, setting.value)))
    return;
  std::vector<std::string_view> known;
  for (const Configuration& configuration : member.subsystem.configurations)
    for (const DeviceUse& use : configuration.devices)
      if (member.subsystem.devices[use.device].name == changed.device)
        for (const Setting& each : use.settings) known.push_back(each.name);
  problems.add(*element.find("name"), "E0351",
               fmt::format("no configuration of '{}' gives '{}' a setting {}", member.subsystem.name, changed.device,
                           in_quotes(setting.name)),
               did_you_mean(setting.name, known));
}

/// What the mission changes of the device in `text`, as its process is told; where it stands is what is refused.
void apply_to_device(const xml::Attribute& at, std::string_view word, const std::string& text, MissionSubsystem& member,
                     Problems& problems) {
  if (const auto applied = apply_change(member.subsystem, word, text); !applied)
    problems.add(at, "E0217", fmt::format("{}: {}", in_quotes(at.value), applied.error().text));
}

void read_moved_fall_back(const xml::Element& element, MissionSubsystem& member, DeviceChange& changed, Unique& names,
                          Problems& problems) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  const auto* address = attributes.required("address");
  const auto* to = attributes.required("to");
  if (address == nullptr || to == nullptr) return;
  names.add(address->value, place(address->value_at), problems, address->value.size());
  const std::size_t before = problems.count();
  for (const auto* at : {address, to})
    if (at->value.empty() || at->value.find('=') != std::string::npos)
      problems.add(*at, "E0217", in_quotes(at->value) + " is no address");
  if (problems.count() != before) return;
  apply_to_device(*address, "--fall-back", fmt::format("{}={}={}", changed.device, address->value, to->value), member,
                  problems);
  changed.fall_backs.push_back({address->value, to->value});
}

/// Other addresses or other settings for a device of this instance: what it is and how it is carried stays the
/// descriptor's.
void read_device_change(const xml::Element& element, MissionSubsystem& member, Unique& names, Problems& problems) {
  Attributes attributes{element, problems};
  const auto* name = attributes.required("name");
  const auto* address = attributes.optional("address");
  const auto* enable = attributes.optional("enable");
  const auto* power = attributes.optional("power");
  if (name == nullptr) return no_children(element, problems);
  const auto text_of = [](const xml::Attribute* at) { return at != nullptr ? at->value : std::string{}; };
  DeviceChange changed{name->value, text_of(address), text_of(enable), text_of(power)};
  std::vector<std::string_view> known;
  for (const Device& device : member.subsystem.devices) known.push_back(device.name);
  // A device with several endnodes is itself in no configuration; its power is.
  for (const PowerSwitch& switched : member.subsystem.power_switches)
    if (std::ranges::find(known, switched.device) == known.end()) known.push_back(switched.device);
  names.add(name->value, place(name->value_at), problems, name->value.size());
  const bool exists = std::ranges::find(known, name->value) != known.end();
  if (!exists)
    problems.add(*name, "E0312", fmt::format("'{}' has no device {}", member.subsystem.name, in_quotes(name->value)),
                 did_you_mean(name->value, known));
  // Before its fall-backs, which must not meet it; its process does the same in this order.
  for (const auto& [at, word] : {std::pair{address, "--address"}, {enable, "--enable"}, {power, "--power"}})
    if (at != nullptr && exists) apply_to_device(*at, word, name->value + "=" + at->value, member, problems);
  Unique settings{"setting", "E0201"}, fall_backs{"fall-back", "E0201"};
  const auto read_one_setting = [&](const xml::Element& child) {
    if (exists) read_changed_setting(child, member, changed, settings, problems);
  };
  const auto read_one_fall_back = [&](const xml::Element& child) {
    if (exists) read_moved_fall_back(child, member, changed, fall_backs, problems);
  };
  each_child(element, problems,
             {{"Setting", read_one_setting, 256}, {"FallBack", read_one_fall_back, max_moved_fall_backs}});
  if (address == nullptr && enable == nullptr && power == nullptr && element.children.empty())
    return problems.add(
        element, "E0105",
        "<Device> of a mission's <Subsystem> needs 'address', 'enable', 'power', a <FallBack> or a <Setting>");
  member.devices.push_back(std::move(changed));
}

/// What it has is apart in its descriptor, and perhaps no more by what is changed.
void check_ends(const SubsystemDescriptor& subsystem, MissionDraft& draft) {
  Problems met{subsystem.file};
  check_addresses(subsystem, met);
  for (const Configuration& configuration : subsystem.configurations)
    for (const DeviceUse& use : configuration.devices)
      for (const Endnode& other : use.fall_backs)
        if (other.transfer == use.endnode.transfer && other.address == use.endnode.address)
          met.add(other.at, "E0222", in_quotes(other.address) + " is tried already",
                  "a fall-back has an address of its own");
  if (met.count() != 0) draft.subsystem_problems.push_back(met.take());
}

void read_override(const xml::Element& element, MissionSubsystem& member, Unique& names, Problems& problems) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  const auto* name = attributes.required("parameter");
  const auto* value = attributes.required("value");
  if (name == nullptr || value == nullptr) return;
  auto& parameters = member.subsystem.parameters;
  const auto found = find_place(member.subsystem, name->value);
  const std::vector<std::string> built_in = built_in_parameters(member.subsystem);
  const auto is_built_in = [&](const Parameter& parameter) {
    return std::ranges::find(built_in, parameter.field.name) != built_in.end();
  };
  if (!found || is_built_in(parameters[found->parameter])) {
    std::vector<std::string_view> known;
    for (const Parameter& parameter : parameters)
      if (!is_built_in(parameter)) known.push_back(parameter.field.name);
    problems.add(*name, "E0204", fmt::format("'{}' has no parameter {}", member.subsystem.name, in_quotes(name->value)),
                 did_you_mean(name->value, known));
    return;
  }
  names.add(name->value, place(name->value_at), problems, name->value.size());
  for (const Configuration& configuration : member.subsystem.configurations)
    for (const Configuration::Initial& initial : configuration.initial)
      if (overlap(member.subsystem, initial.parameter, *found))
        return problems.add(*name, "E0319",
                            fmt::format("configuration '{}' sets '{}' itself", configuration.name, name->value),
                            "the value would not last: change it in the descriptor");
  auto values =
      read_values(problems, *value, name->value, fields_of(member.subsystem, *found), member.subsystem.enumerations);
  if (!values) return;
  begin_with(parameters[found->parameter], found->member, *values);
  member.overrides.push_back({name->value, std::move(*values)});
}

}  // namespace

std::string_view refuse_path(std::string_view text, int above) {
  if (is_shipped(text)) return refuse_path(text.substr(shipped_prefix.size()), 0);
  const std::filesystem::path path{text};
  if (text.empty() || text.size() > 1024) return "a path of 1 to 1024 octets is needed";
  if (path.is_absolute() || text.find('\\') != std::string_view::npos) return "the path must be relative";
  int depth = above;
  for (const auto& part : path) {
    if (part == "..") --depth;
    else if (part != "." && !part.empty()) ++depth;
    if (depth < 0) return above == 0 ? "the path must stay inside the folder" : "at most three folders up";
  }
  return "";
}

void MemberReader::read_supervisor(Attributes& attributes) {
  if (auto subsystem = read_descriptor(attributes)) {
    const xml::Attribute& at = *attributes.element().find("descriptor");
    if (subsystem->id != supervisor_apid)
      problems_.add(
          at, "E0303",
          fmt::format("the supervisor has id {}, '{}' has {}", supervisor_apid, subsystem->name, subsystem->id));
    subsystem_names_.add(subsystem->name, place(at.value_at), problems_, at.value.size());
    addresses_.check_endnodes(*subsystem);
    draft_.mission.supervisor = std::move(*subsystem);
  }
}

void MemberReader::read_member(const xml::Element& element) {
  Attributes attributes{element, problems_};
  MissionSubsystem member;
  member.at = place(element.at);
  member.executable = attributes.name("executable", NameKind::Loose);
  member.starts = attributes.yes("start", true);
  read_cores(attributes, member, problems_);
  auto subsystem = read_descriptor(attributes);
  if (!subsystem) return;  // what is set in it cannot be judged
  member.subsystem = std::move(*subsystem);
  read_identity(attributes, member);
  Unique names{"parameter", "E0201"}, devices{"device", "E0201"};
  Unique commanded{"commanded subsystem", "E0201"}, heard{"subsystem that is heard", "E0201"};
  using enum Redirected::Kind;
  each_child(
      element, problems_,
      {{"Set", [&](const auto& child) { read_override(child, member, names, problems_); }, 255},
       {"Commands", [&](const auto& child) { others_.read_redirected(child, member, Commands, commanded); }, 255},
       {"Subscribes", [&](const auto& child) { others_.read_redirected(child, member, Subscribes, heard); }, 255},
       {"Device", [&](const auto& child) { read_device_change(child, member, devices, problems_); }, 255}});
  if (!member.devices.empty()) check_ends(member.subsystem, draft_);
  addresses_.check_endnodes(member.subsystem);
  draft_.mission.subsystems.push_back(std::move(member));
}

void MemberReader::read_identity(Attributes& attributes, MissionSubsystem& member) {
  SubsystemDescriptor& subsystem = member.subsystem;
  const xml::Attribute& descriptor = *attributes.element().find("descriptor");
  const auto* named = attributes.optional("name");
  const auto* numbered = attributes.optional("id");
  if (named != nullptr) subsystem.name = attributes.name();
  if (numbered != nullptr) subsystem.id = attributes.required_integer<std::uint16_t>("id", 1, 2039);
  const xml::Attribute& name_at = named != nullptr ? *named : descriptor;
  const xml::Attribute& id_at = numbered != nullptr ? *numbered : descriptor;
  subsystem_names_.add(subsystem.name, place(name_at.value_at), problems_, name_at.value.size());
  if (subsystem.id == supervisor_apid)
    problems_.add(id_at, "E0303", fmt::format("id {} of '{}' is the supervisor's", supervisor_apid, subsystem.name));
  else subsystem_ids_.add(std::to_string(subsystem.id), place(id_at.value_at), problems_, id_at.value.size());
}

std::optional<SubsystemDescriptor> MemberReader::read_descriptor(Attributes& attributes) {
  const auto* at = attributes.required("descriptor");
  if (at == nullptr || !refuse_path(at->value, folders_above).empty()) {
    draft_.whole = false;
    if (at != nullptr)
      problems_.add(*at, "E0314", fmt::format("descriptor path {} is not allowed", in_quotes(at->value)),
                    std::string{refuse_path(at->value, folders_above)});
    return std::nullopt;
  }
  const bool shipped = is_shipped(at->value);
  const std::filesystem::path file =
      (shipped ? std::filesystem::path{at->value} : problems_.file().parent_path() / at->value).lexically_normal();
  Reading<SubsystemDescriptor> reading = read_subsystem(file, source_);
  const bool unreadable = std::ranges::any_of(reading.problems, [](const Diagnostic& d) { return d.code == "E0001"; });
  if (unreadable)
    problems_.add(*at, "E0315", fmt::format("descriptor {} {}", in_quotes(at->value), reading.problems.front().message),
                  shipped ? "nothing of this name comes with HIROSCO" : "the path is relative to the mission file");
  else if (!reading.problems.empty()) draft_.subsystem_problems.push_back(std::move(reading.problems));
  std::ranges::move(reading.warnings, std::back_inserter(draft_.subsystem_warnings));
  if (!reading.value) draft_.whole = false;
  return std::move(reading.value);
}

}  // namespace hirosco::descriptor::detail
