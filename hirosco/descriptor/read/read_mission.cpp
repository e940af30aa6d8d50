// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "hirosco/descriptor/model/status_rows.hpp"
#include "hirosco/descriptor/read/brought_files.hpp"
#include "hirosco/descriptor/read/detail/mission_parts.hpp"
#include "hirosco/descriptor/read/detail/mission_reader.hpp"
#include "hirosco/utilities/lower_case.hpp"

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

void read_log_server(Attributes& attributes, DatabaseUse& database, Problems& problems) {
  const auto* server = attributes.optional("server");
  if (server == nullptr && database.strategy == "postgresql" && HIROSCO_POSTGRESQL)
    problems.add(attributes.element(), "E0105", "a log in a server needs attribute 'server'",
                 "as libpq takes it: server=\"service=hirosco\" or \"host=/run/postgresql dbname=hirosco\"");
  if (server == nullptr) return;
  database.server = server->value;
  if (!HIROSCO_POSTGRESQL) problems.not_built_in(*server, without_postgresql);
  if (server->value.empty()) problems.add(*server, "E0109", "attribute 'server' is empty");
  if (has_password(server->value))
    problems.add(*server, "E0346", "a password has no place in a mission",
                 "libpq finds it in a passfile, a service file or the environment");
}

void read_database(const xml::Element& element, DatabaseUse& database, Problems& problems) {
  Attributes attributes{element, problems};
  no_children(element, problems);
  if (const auto* strategy = attributes.optional("strategy"); strategy != nullptr) {
    database.strategy = strategy->value;
    if (strategy->value == "postgresql" && !HIROSCO_POSTGRESQL)
      problems.not_built_in(*strategy, strategy->value, without_postgresql);
    else if (strategy->value != "sqlite" && strategy->value != "ascii" && strategy->value != "postgresql")
      attributes.unknown_word(*strategy, strategy->value, {"sqlite", "ascii", "postgresql"});
  }
  read_log_server(attributes, database, problems);
  database.rotate_mb = attributes.integer_or<std::uint32_t>("rotate_MB", 1, 1'000'000, 0);
  database.rotate_h = attributes.integer_or<std::uint32_t>("rotate_h", 1, 100'000, 0);
  database.keep_mb = attributes.integer_or<std::uint32_t>("keep_MB", 2, 100'000'000, 0);
  if (const auto* keep = attributes.optional("keep_MB"); keep != nullptr && database.keep_mb != 0)
    if (database.rotate_mb == 0 || database.keep_mb / 2 < database.rotate_mb)
      problems.add(*keep, "E0342", "a bounded log needs pieces, of which the newest two have room",
                   "give 'rotate_MB', at most half of 'keep_MB'");
  // Not refused: a telecommand may take the log into files, where they hold.
  for (const char* const bound : {"rotate_MB", "rotate_h", "keep_MB"})
    if (const auto* said = attributes.optional(bound); said != nullptr && database.strategy == "postgresql")
      problems.warn(place(said->at), "E0353", fmt::format("'{}' bounds files, and this log is in a server", bound),
                    "its owner bounds what a server keeps; in force only where SET_DATABASE goes on in files",
                    said->name.size());
  const auto* path = attributes.optional("path");
  if (path == nullptr) return;
  database.path = path->value;
  if (const auto wrong = refuse_path(path->value, 0); !wrong.empty())
    problems.add(*path, "E0314", fmt::format("database path {} is not allowed", in_quotes(path->value)),
                 std::string{wrong});
}

void read_ground_address(Attributes& attributes, std::string_view name, std::string& into, Problems& problems) {
  const auto* address = attributes.optional(name);
  if (address == nullptr) return;
  into = address->value;
  switch (classify_address(address->value)) {
    case Address::Loopback: return;
    case Address::Malformed:
      return problems.add(*address, "E0217", in_quotes(address->value) + " is no address",
                          "host:port, for example 127.0.0.1:10015");
    case Address::Foreign:
      return problems.add(*address, "E0313", in_quotes(address->value) + " leaves this computer",
                          "only loopback addresses are allowed: 127.0.0.1");
  }
}

void read_ground(const xml::Element& element, MissionDraft& draft) {
  Attributes attributes{element, draft.problems};
  no_children(element, draft.problems);
  if (const auto* subsystem = attributes.required("subsystem"); subsystem != nullptr) {
    draft.mission.ground.subsystem = subsystem->value;
    // A stop of everything spares it, so nothing that moves may be its own (hazard SF1).
    if (const SubsystemDescriptor* carries = draft.find(*subsystem, subsystem->value, false); carries != nullptr)
      if (const auto acts = std::ranges::find_if(carries->devices, &Device::actuator); acts != carries->devices.end())
        draft.problems.add(*subsystem, "E0329",
                           fmt::format("'{}' carries the ground link, which a stop spares, and has the actuator '{}'",
                                       carries->name, acts->name),
                           "give the actuator, or the ground link, to another subsystem");
    if (const auto* carries = draft.mission.find_subsystem(subsystem->value); carries != nullptr && !carries->starts)
      draft.problems.add(
          *subsystem, "E0363",
          fmt::format("'{}' carries the ground link and is not started with the flight", subsystem->value),
          "leave start=\"no\" out: nobody could ask for its start");
  }
  read_ground_address(attributes, "telemetry", draft.mission.ground.telemetry, draft.problems);
  read_ground_address(attributes, "telecommand", draft.mission.ground.telecommand, draft.problems);
  if (draft.mission.ground.telemetry == draft.mission.ground.telecommand)
    draft.problems.add(element, "E0313", "telemetry and telecommand need addresses of their own");
}

}  // namespace

void MissionReader::read(const xml::Element& root) {
  {
    Attributes attributes{root, problems_};
    mission_.name = attributes.name();
    // It was demanded once, and nothing went by it.
    if (const auto* id = attributes.optional("id"); id != nullptr)
      problems_.add(place(id->at), "E0103", "a mission has no number, its name is what it is called by", "leave it out",
                    id->name.size());
  }
  // What is referred to is read before what refers to it, whatever the order in the file.
  std::vector<const xml::Element*> grounds, powers, budgets, isolations, devices, links, modes, recoveries, consoles;
  const auto later = [](auto& list) { return [&list](const xml::Element& element) { list.push_back(&element); }; };
  for (const xml::Element& child : root.children)
    if (child.name == "DeviceNetwork") device_addresses_.read_device_network(child);
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
              {"Manifest", [this](const auto& element) { read_manifest(element, draft_, source_); }, 1},
              {"Isolation", later(isolations), 1},
              {"DeviceNetwork", [](const xml::Element&) {}, max_device_networks},
              {"Subsystem", [this](const auto& element) { members_.read_member(element); }, 255},
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
    read_ground(*element, draft_);
    break;
  }
  other_members_.resolve_all();
  for (const auto* element : powers) read_power(*element, draft_);
  for (const auto* element : budgets) {
    read_resources(*element, mission_, problems_);
    if (draft_.whole) check_resources(*element, mission_, problems_);
  }
  for (const auto* element : isolations) read_isolation(*element, draft_);
  read_simulated_devices(devices, draft_);
  check_cores(root, draft_);
  for (const auto* element : links) links_.read_links(*element);
  for (const auto* element : modes) modes_.read_modes(*element);
  for (const auto* element : recoveries) plans_.read_recovery(*element);
  for (const auto* element : consoles) read_console(*element, draft_);
  note_sockets(mission_);
  check_reach(draft_);
  if (const std::string wrong = give_everybody_a_row(mission_); !wrong.empty())
    problems_.add(root, "E0328",
                  fmt::format("the supervisor cannot tell of {} subsystems and {} links in one report",
                              mission_.subsystems.size(), mission_.links.size()),
                  wrong);
  other_members_.check_rows();
}

void MissionReader::read_supervisor(const xml::Element& element) {
  Attributes attributes{element, problems_};
  members_.read_supervisor(attributes);
  mission_.database.path = "log/" + (mission_.name.empty() ? std::string{"mission"} : mission_.name) + ".db";
  each_child(element, problems_,
             {{"Database", [this](const auto& child) { read_database(child, mission_.database, problems_); }, 1},
              {"Ground", [](const xml::Element&) {}, 1}});
}

const SubsystemDescriptor* MissionDraft::find(const xml::Attribute& at, std::string_view name, bool supervisor) {
  if (const auto* member = mission.find_subsystem(name); member != nullptr) return &member->subsystem;
  if (supervisor && !name.empty() && mission.supervisor.name == name) return &mission.supervisor;
  if (!whole) return nullptr;
  std::vector<std::string_view> known;
  for (const MissionSubsystem& member : mission.subsystems) known.push_back(member.subsystem.name);
  if (supervisor) known.push_back(mission.supervisor.name);
  problems.add(at, "E0304", fmt::format("subsystem {} is not in the mission", in_quotes(name)),
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
  detail::MissionDraft draft{problems};
  detail::MissionReader{draft, once}.read(*root);
  Mission& mission = draft.mission;
  for (MissionSubsystem& member : mission.subsystems) member.brought = brought_files(member.subsystem, once);
  mission.texts = std::move(texts);
  mission.file = file;
  reading.problems = problems.take();
  for (auto& of_file : draft.subsystem_problems) std::ranges::move(of_file, std::back_inserter(reading.problems));
  reading.warnings = problems.take_warnings();
  std::ranges::move(draft.subsystem_warnings, std::back_inserter(reading.warnings));
  if (reading.problems.empty()) reading.value = std::move(mission);
  return reading;
}

}  // namespace hirosco::descriptor
