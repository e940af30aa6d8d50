// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "hirosco/pus/words/describe.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"
#include "supervisor/platform/storage/postgresql_database.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"

namespace hirosco::tools {
int log(const LogOptions& options) {
  std::filesystem::path path = options.path;
  std::optional<descriptor::Mission> mission;
  if (path.empty()) {
    auto found = find_log("log", options.mission, options.instance);
    if (!found) return found.error();
    path = std::move(found->path);
    mission = std::move(found->mission);
  } else if (const std::string name = options.mission.empty() ? usual_mission() : options.mission;
             !find_mission(name).empty()) {
    mission = load_mission(name);
  }
  // What the log has in a server; a server that it never was in has no table.
  std::unique_ptr<supervisor::Database> server;
  if (mission && !mission->database.server.empty()) {
    auto opened = supervisor::open_postgresql(
        {.connection = mission->database.server, .log = supervisor::log_name(path)}, supervisor::DatabaseAccess::Read);
    const auto seen = opened ? (*opened)->read({.last = 1}) : fail(opened.error());
    if (seen) server = std::move(*opened);
    else if (seen.error().code != ErrorCode::NotFound)
      fmt::print(stderr, "hirosco log: what stands in the server is left out: {}\n", seen.error().text);
  }
  const std::vector<supervisor::Database*> beside(server ? 1 : 0, server.get());
  const auto describer = mission ? std::optional<pus::PacketDescriber>{*mission} : std::nullopt;
  const auto text_of = [&](const supervisor::LogRecord& record) {
    if (!describer || record.packet.empty()) return supervisor::describe(record);
    std::string text = fmt::format("{} {} {} {}", record.number, supervisor::time_text(record.stored),
                                   to_text(record.kind), describer->describe(record.packet));
    if (!record.note.view().empty()) text += fmt::format(" \"{}\"", record.note.view());
    return text;
  };
  // What is searched is what is shown.
  const auto page = supervisor::read_log(path,
                                         {.apid = options.apid,
                                          .service = options.service,
                                          .housekeeping = options.housekeeping || options.json || options.service,
                                          .text = options.text,
                                          .words = text_of,
                                          .last = options.last},
                                         beside);
  if (!page) {
    fmt::print(stderr, "hirosco log: {}: {}\n", path.string(), page.error().text);
    return exit_environment;
  }
  for (const auto& record : page->records) {
    if (options.json)
      fmt::print("{{\"number\":{},\"stored\":\"{}\",\"kind\":\"{}\",\"source\":{},\"peer\":{},\"text\":\"{}\"}}\n",
                 record.number, supervisor::time_text(record.stored), to_text(record.kind), record.source, record.peer,
                 json_text(text_of(record)));
    else fmt::print("{}\n", text_of(record));
  }
  if (page->damaged != 0) fmt::print(stderr, "hirosco log: {} damaged records left out\n", page->damaged);
  return page->damaged == 0 ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
