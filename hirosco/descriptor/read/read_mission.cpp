// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/status_rows.hpp"
#include "hirosco/descriptor/model/supervisor_apid.hpp"
#include "hirosco/descriptor/read/brought_files.hpp"
#include "hirosco/descriptor/read/detail/mission_reader.hpp"
#include "hirosco/descriptor/read/detail/subsystem_reader.hpp"
#include "hirosco/utilities/lower_case.hpp"
#include "hirosco/utilities/os/installation.hpp"

namespace hirosco::descriptor {
namespace detail {
namespace {

constexpr const char* without_postgresql = "install libpq-dev and configure anew, or take sqlite or ascii";

/// Where a secret may stand, which has no place in a file that is shown, checked in and printed.
[[nodiscard]] bool has_password(std::string_view connection) {
  const std::string text = lower_case(std::string{connection});
  const auto user = text.find("://");
  const auto host = user == std::string::npos ? user : text.find('@', user);
  const bool in_address =
      host != std::string::npos && text.substr(user + 3, host - user - 3).find(':') != std::string::npos;
  return in_address || text.find("password") != std::string::npos;
}

/// A mission stands in missions/NAME/, what it may name in the tree two folders above.
constexpr int folders_above = 2;

/// A file that comes with HIROSCO, by its name there.
bool is_shipped(std::string_view text) { return text.starts_with(shipped_prefix); }

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
    if (depth < 0) return above == 0 ? "the path must stay inside the folder" : "at most two folders up";
  }
  return "";
}

Mission MissionReader::read(const xml::Element& root) {
  {
    Attributes attributes{root, problems_};
    mission_.name = attributes.name();
    mission_.id = attributes.required_integer<std::uint16_t>("id", 1, 65'535);
  }
  // What is referred to is read before what refers to it, whatever the order in the file.
  std::vector<const xml::Element*> grounds, powers, budgets, devices, links, modes, recoveries, consoles;
  const auto later = [](auto& list) { return [&list](const xml::Element& element) { list.push_back(&element); }; };
  for (const xml::Element& child : root.children)
    if (child.name == "DeviceNetwork") read_device_network(child);
  bool supervised = false;
  each_child(root, problems_,
             {{"Supervisor",
               [&](const xml::Element& element) {
                 read_supervisor(element);
                 supervised = true;
               },
               1},
              {"Power", later(powers), 1},
              {"Resources", later(budgets), 1},
              {"Manifest", [this](const auto& element) { read_manifest(element); }, 1},
              {"Isolation", [this](const auto& element) { read_isolation(element); }, 1},
              {"DeviceNetwork", [](const xml::Element&) {}, max_device_networks},
              {"Subsystem", [this](const auto& element) { read_member(element); }, 255},
              {"SimulatedDevice", later(devices), 255},
              {"Links", later(links), 1},
              {"Modes", later(modes), 1},
              {"Recovery", later(recoveries), 1},
              {"Console", later(consoles), 1}});
  if (!supervised) problems_.add(root, "E0106", "<Mission> needs a <Supervisor>");
  if (modes.empty()) problems_.add(root, "E0106", "<Mission> needs <Modes>");
  for (const xml::Element& child : root.children)
    if (child.name == "Supervisor")
      for (const xml::Element& ground : child.children)
        if (ground.name == "Ground") grounds.push_back(&ground);
  for (const auto* element : grounds) {
    read_ground(*element);
    break;
  }
  resolve_commands();
  for (const auto* element : powers) read_power(*element);
  for (const auto* element : budgets) {
    read_resources(*element);
    if (whole()) check_resources(*element);
  }
  for (const auto* element : devices) read_simulated_device(*element);
  for (const auto* element : links) {
    const Attributes none{*element, problems_};
    each_child(*element, problems_, {{"Link", [this](const auto& child) { read_link(child); }, 255}});
  }
  for (const auto* element : modes) read_modes(*element);
  for (const auto* element : recoveries) read_recovery(*element);
  for (const auto* element : consoles) read_console(*element);
  note_sockets();
  check_reach();
  if (const std::string wrong = give_everybody_a_row(mission_); !wrong.empty())
    problems_.add(root, "E0328",
                  fmt::format("the supervisor cannot tell of {} subsystems and {} links in one report",
                              mission_.subsystems.size(), mission_.links.size()),
                  wrong);
  return std::move(mission_);
}

std::vector<Diagnostic> MissionReader::take_subsystem_problems() {
  std::vector<Diagnostic> all;
  for (auto& problems : subsystem_problems_) std::ranges::move(problems, std::back_inserter(all));
  return all;
}

std::vector<Diagnostic> MissionReader::take_subsystem_warnings() { return std::move(warnings_); }

void MissionReader::read_supervisor(const xml::Element& element) {
  Attributes attributes{element, problems_};
  if (auto subsystem = read_descriptor(attributes)) {
    const xml::Attribute& at = *element.find("descriptor");
    if (subsystem->id != supervisor_apid)
      problems_.add(
          at, "E0303",
          fmt::format("the supervisor has id {}, '{}' has {}", supervisor_apid, subsystem->name, subsystem->id));
    subsystem_names_.add(subsystem->name, place(at.value_at), problems_, at.value.size());
    check_endnodes(*subsystem);
    const bool spins = std::ranges::any_of(subsystem->configurations,
                                           [](const Configuration& each) { return each.spin > Duration{}; });
    if (!subsystem->service_loops.empty() || !subsystem->bumpless.empty() || spins)
      problems_.add(at, "E0332",
                    fmt::format("'{}' is the supervisor: its services run in its own loop, its configuration stays, "
                                "its cycle spins for nobody",
                                subsystem->name),
                    "leave <ServiceLoop>, <Bumpless> and spin_us out of its descriptor");
    mission_.supervisor = std::move(*subsystem);
  }
  mission_.database.path = "log/" + (mission_.name.empty() ? std::string{"mission"} : mission_.name) + ".db";
  each_child(element, problems_,
             {{"Database", [this](const auto& child) { read_database(child); }, 1},
              {"Ground", [](const xml::Element&) {}, 1}});
}

void MissionReader::read_log_server(Attributes& attributes) {
  const auto* server = attributes.optional("server");
  if (server == nullptr && mission_.database.strategy == "postgresql" && HIROSCO_POSTGRESQL)
    problems_.add(attributes.element(), "E0105", "a log in a server needs attribute 'server'",
                  "as libpq takes it: server=\"service=hirosco\" or \"host=/run/postgresql dbname=hirosco\"");
  if (server == nullptr) return;
  mission_.database.server = server->value;
  if (!HIROSCO_POSTGRESQL) problems_.not_built_in(*server, without_postgresql);
  if (server->value.empty()) problems_.add(*server, "E0109", "attribute 'server' is empty");
  if (has_password(server->value))
    problems_.add(*server, "E0346", "a password has no place in a mission",
                  "libpq finds it in a passfile, a service file or the environment");
}

void MissionReader::read_database(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  if (const auto* strategy = attributes.optional("strategy"); strategy != nullptr) {
    mission_.database.strategy = strategy->value;
    if (strategy->value == "postgresql" && !HIROSCO_POSTGRESQL)
      problems_.not_built_in(*strategy, strategy->value, without_postgresql);
    else if (strategy->value != "sqlite" && strategy->value != "ascii" && strategy->value != "postgresql")
      attributes.unknown_word(*strategy, strategy->value, {"sqlite", "ascii", "postgresql"});
  }
  read_log_server(attributes);
  mission_.database.rotate_mb = attributes.integer_or<std::uint32_t>("rotate_MB", 1, 1'000'000, 0);
  mission_.database.rotate_h = attributes.integer_or<std::uint32_t>("rotate_h", 1, 100'000, 0);
  mission_.database.keep_mb = attributes.integer_or<std::uint32_t>("keep_MB", 2, 100'000'000, 0);
  if (const auto* keep = attributes.optional("keep_MB"); keep != nullptr && mission_.database.keep_mb != 0)
    if (mission_.database.rotate_mb == 0 || mission_.database.keep_mb / 2 < mission_.database.rotate_mb)
      problems_.add(*keep, "E0342", "a bounded log needs pieces, of which the newest two have room",
                    "give 'rotate_MB', at most half of 'keep_MB'");
  const auto* path = attributes.optional("path");
  if (path == nullptr) return;
  mission_.database.path = path->value;
  if (const auto wrong = refuse_path(path->value, 0); !wrong.empty())
    problems_.add(*path, "E0314", fmt::format("database path {} is not allowed", in_quotes(path->value)),
                  std::string{wrong});
}

void MissionReader::read_ground(const xml::Element& element) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
  if (const auto* subsystem = attributes.required("subsystem"); subsystem != nullptr) {
    mission_.ground.subsystem = subsystem->value;
    // A stop of everything spares it, so nothing that moves may be its own (hazard SF1).
    if (const SubsystemDescriptor* carries = find(*subsystem, subsystem->value, false); carries != nullptr)
      if (const auto acts = std::ranges::find_if(carries->devices, &Device::actuator); acts != carries->devices.end())
        problems_.add(*subsystem, "E0329",
                      fmt::format("'{}' carries the ground link, which a stop spares, and has the actuator '{}'",
                                  carries->name, acts->name),
                      "give the actuator, or the ground link, to another subsystem");
    if (const auto* carries = mission_.find_subsystem(subsystem->value); carries != nullptr && !carries->starts)
      problems_.add(*subsystem, "E0363",
                    fmt::format("'{}' carries the ground link and is not started with the flight", subsystem->value),
                    "leave start=\"no\" out: nobody could ask for its start");
  }
  read_address(attributes, "telemetry", mission_.ground.telemetry);
  read_address(attributes, "telecommand", mission_.ground.telecommand);
  if (mission_.ground.telemetry == mission_.ground.telecommand)
    problems_.add(element, "E0313", "telemetry and telecommand need addresses of their own");
}

void MissionReader::read_address(Attributes& attributes, std::string_view name, std::string& into) {
  const auto* address = attributes.optional(name);
  if (address == nullptr) return;
  into = address->value;
  switch (classify_address(address->value)) {
    case Address::Loopback: return;
    case Address::Malformed:
      return problems_.add(*address, "E0217", in_quotes(address->value) + " is no address",
                           "host:port, for example 127.0.0.1:10015");
    case Address::Foreign:
      return problems_.add(*address, "E0313", in_quotes(address->value) + " leaves this computer",
                           "only loopback addresses are allowed: 127.0.0.1");
  }
}

std::string MissionReader::executable(Attributes& attributes) { return attributes.name("executable", NameKind::Loose); }

void MissionReader::read_member(const xml::Element& element) {
  Attributes attributes{element, problems_};
  MissionSubsystem member;
  member.at = place(element.at);
  member.executable = executable(attributes);
  member.starts = attributes.yes("start", true);
  auto subsystem = read_descriptor(attributes);
  if (!subsystem) return;  // what is set in it cannot be judged
  member.subsystem = std::move(*subsystem);
  read_identity(attributes, member);
  Unique names{"parameter", "E0201"}, devices{"device", "E0201"};
  Unique commanded{"commanded subsystem", "E0201"}, heard{"subsystem that is heard", "E0201"};
  using enum Redirected::Kind;
  each_child(element, problems_,
             {{"Set", [&](const xml::Element& child) { read_override(child, member, names); }, 255},
              {"Commands", [&](const auto& child) { read_redirected(child, member, Commands, commanded); }, 255},
              {"Subscribes", [&](const auto& child) { read_redirected(child, member, Subscribes, heard); }, 255},
              {"Device", [&](const xml::Element& child) { read_device_change(child, member, devices); }, 255}});
  check_endnodes(member.subsystem);
  mission_.subsystems.push_back(std::move(member));
}

void MissionReader::read_identity(Attributes& attributes, MissionSubsystem& member) {
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

/// Another address or other settings for a device of this instance: what it is and how it is carried stays the
/// descriptor's.
void MissionReader::read_device_change(const xml::Element& element, MissionSubsystem& member, Unique& names) {
  Attributes attributes{element, problems_};
  const auto* name = attributes.required("name");
  const auto* address = attributes.optional("address");
  const auto* enable = attributes.optional("enable");
  if (name == nullptr) return no_children(element, problems_);
  DeviceChange changed{name->value, address != nullptr ? address->value : "", enable != nullptr ? enable->value : ""};
  std::vector<std::string_view> known;
  for (const Device& device : member.subsystem.devices) known.push_back(device.name);
  names.add(name->value, place(name->value_at), problems_, name->value.size());
  const bool exists = std::ranges::find(known, name->value) != known.end();
  if (!exists)
    problems_.add(*name, "E0312", fmt::format("'{}' has no device {}", member.subsystem.name, in_quotes(name->value)),
                  did_you_mean(name->value, known));
  Unique settings{"setting", "E0201"};
  bool sets = false;
  const auto read_one = [&](const xml::Element& child) {
    sets = true;
    if (exists) read_changed_setting(child, member, changed, settings);
  };
  each_child(element, problems_, {{"Setting", read_one, 256}});
  if (address == nullptr && enable == nullptr && !sets)
    return problems_.add(element, "E0105",
                         "<Device> of a mission's <Subsystem> needs 'address', 'enable' or a <Setting>");
  for (const auto& [at, word] : {std::pair{address, "--address"}, std::pair{enable, "--enable"}}) {
    if (at == nullptr || !exists) continue;
    if (const auto applied = apply_change(member.subsystem, word, name->value + "=" + at->value); !applied)
      problems_.add(*at, "E0217", fmt::format("{}: {}", in_quotes(at->value), applied.error().text));
  }
  member.devices.push_back(std::move(changed));
}

void MissionReader::read_changed_setting(const xml::Element& element, MissionSubsystem& member, DeviceChange& changed,
                                         Unique& names) {
  const std::size_t before = changed.settings.size();
  read_setting(element, problems_, names, changed.settings);
  if (changed.settings.size() == before) return;
  const Setting& setting = changed.settings.back();
  if (apply_change(member.subsystem, "--setting", fmt::format("{}:{}={}", changed.device, setting.name, setting.value)))
    return;
  std::vector<std::string_view> known;
  for (const Configuration& configuration : member.subsystem.configurations)
    for (const DeviceUse& use : configuration.devices)
      if (member.subsystem.devices[use.device].name == changed.device)
        for (const Setting& each : use.settings) known.push_back(each.name);
  problems_.add(*element.find("name"), "E0351",
                fmt::format("no configuration of '{}' gives '{}' a setting {}", member.subsystem.name, changed.device,
                            in_quotes(setting.name)),
                did_you_mean(setting.name, known));
}

void MissionReader::read_override(const xml::Element& element, MissionSubsystem& member, Unique& names) {
  Attributes attributes{element, problems_};
  no_children(element, problems_);
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
    problems_.add(*name, "E0204",
                  fmt::format("'{}' has no parameter {}", member.subsystem.name, in_quotes(name->value)),
                  did_you_mean(name->value, known));
    return;
  }
  names.add(name->value, place(name->value_at), problems_, name->value.size());
  for (const Configuration& configuration : member.subsystem.configurations)
    for (const Configuration::Initial& initial : configuration.initial)
      if (overlap(member.subsystem, initial.parameter, *found))
        return problems_.add(*name, "E0319",
                             fmt::format("configuration '{}' sets '{}' itself", configuration.name, name->value),
                             "the value would not last: change it in the descriptor");
  auto values =
      read_values(problems_, *value, name->value, fields_of(member.subsystem, *found), member.subsystem.enumerations);
  if (!values) return;
  begin_with(parameters[found->parameter], found->member, *values);
  member.overrides.push_back({name->value, std::move(*values)});
}

std::optional<SubsystemDescriptor> MissionReader::read_descriptor(Attributes& attributes) {
  const auto* at = attributes.required("descriptor");
  if (at == nullptr || !refuse_path(at->value, folders_above).empty()) {
    incomplete_ = true;
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
  else if (!reading.problems.empty()) subsystem_problems_.push_back(std::move(reading.problems));
  std::ranges::move(reading.warnings, std::back_inserter(warnings_));
  if (!reading.value) incomplete_ = true;
  return std::move(reading.value);
}

void MissionReader::read_simulated_device(const xml::Element& element) {
  Attributes attributes{element, problems_};
  SimulatedDevice device;
  device.at = place(element.at);
  device.name = attributes.name("name", NameKind::Loose);
  device.executable = executable(attributes);
  device.seed = attributes.integer_or<std::uint64_t>("seed", 0, std::numeric_limits<std::int64_t>::max(), 1);
  const auto* subsystem = attributes.required("subsystem");
  const auto* played = attributes.required("device");
  if (subsystem != nullptr) device.subsystem = subsystem->value;
  if (played != nullptr) device.device = played->value;
  const SubsystemDescriptor* owner = subsystem == nullptr ? nullptr : find(*subsystem, subsystem->value, false);
  if (owner != nullptr && played != nullptr) {
    std::vector<std::string_view> known;
    // A simulated device plays a whole one, with all its endnodes.
    for (const Device& candidate : owner->devices)
      if (candidate.part_of.empty()) known.push_back(candidate.name);
      else if (known.empty() || known.back() != candidate.part_of) known.push_back(candidate.part_of);
    if (std::ranges::find(known, played->value) == known.end())
      problems_.add(*played, "E0312", fmt::format("'{}' has no device {}", owner->name, in_quotes(played->value)),
                    did_you_mean(played->value, known));
    else played_.add(device.subsystem + "." + device.device, place(played->value_at), problems_, played->value.size());
  }
  Unique settings{"setting", "E0201"};
  each_child(element, problems_,
             {{"Setting", [&](const xml::Element& child) { read_setting(child, problems_, settings, device.settings); },
               256}});
  if (!device.name.empty()) device_names_.add(device.name, device.at, problems_, element.name.size() + 1);
  mission_.devices.push_back(std::move(device));
}

const SubsystemDescriptor* MissionReader::find(const xml::Attribute& at, std::string_view name, bool supervisor) {
  if (const auto* member = mission_.find_subsystem(name); member != nullptr) return &member->subsystem;
  if (supervisor && !name.empty() && mission_.supervisor.name == name) return &mission_.supervisor;
  if (!whole()) return nullptr;
  std::vector<std::string_view> known;
  for (const MissionSubsystem& member : mission_.subsystems) known.push_back(member.subsystem.name);
  if (supervisor) known.push_back(mission_.supervisor.name);
  problems_.add(at, "E0304", fmt::format("subsystem {} is not in the mission", in_quotes(name)),
                did_you_mean(name, known));
  return nullptr;
}

}  // namespace detail

Reading<Mission> read_mission(const std::filesystem::path& file, const FileSource& source) {
  detail::Problems problems{file};
  std::map<std::filesystem::path, std::shared_ptr<const std::string>> texts;
  // Each file once: who flies one descriptor twice has the same of both.
  const FileSource once = [&](const std::filesystem::path& asked) -> Result<std::string> {
    if (const auto known = texts.find(asked); known != texts.end()) return *known->second;
    auto content = source(asked);
    if (content) texts[asked] = std::make_shared<const std::string>(*content);
    return content;
  };
  const auto root = detail::read_root(file, once, "Mission", problems);
  Reading<Mission> reading;
  if (!root) return {std::nullopt, problems.take(), {}};
  detail::MissionReader reader{problems, once};
  Mission mission = reader.read(*root);
  for (MissionSubsystem& member : mission.subsystems) member.brought = brought_files(member.subsystem, once);
  mission.texts = std::move(texts);
  mission.file = file;
  reading.problems = problems.take();
  std::ranges::move(reader.take_subsystem_problems(), std::back_inserter(reading.problems));
  reading.warnings = problems.take_warnings();
  std::ranges::move(reader.take_subsystem_warnings(), std::back_inserter(reading.warnings));
  if (reading.problems.empty()) reading.value = std::move(mission);
  return reading;
}

}  // namespace hirosco::descriptor
