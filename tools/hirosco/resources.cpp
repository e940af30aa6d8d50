// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>

#include "hirosco/pus/packet/packet.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/craft_books.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/listening.hpp"
#include "tools/hirosco/resource_marks.hpp"
#include "tools/hirosco/resource_table.hpp"

namespace hirosco::tools {
namespace {

/// Housekeeping of a mission's members, as it comes by. The mission outlives it.
class Hearing {
 public:
  explicit Hearing(const descriptor::Mission& mission) : supervisor_{mission.supervisor.id}, books_{mission} {
    for (const auto* member : mission.everybody()) decoders_.emplace(member->id, pus::HousekeepingDecoder{*member});
  }
  void hear(Octets packet) {
    const auto report = pus::TelemetryView::parse(packet);
    if (!report || report->service() != 3 || report->subtype() != 25) return;
    const auto decoder = decoders_.find(report->apid());
    if (decoder == decoders_.end()) return;
    if (const auto values = decoder->second.decode(report->source_data()))
      take(report->apid(), *values, report->time());
  }
  void take(std::uint16_t apid, std::span<const pus::HousekeepingValue> values, OnboardTime at) {
    marks_[apid].hear(values, at);
    if (apid == supervisor_) books_.hear(values, at);
  }
  [[nodiscard]] ResourceMarks& of(std::uint16_t apid) { return marks_[apid]; }
  [[nodiscard]] const CraftBooks& books() const noexcept { return books_; }

 private:
  std::uint16_t supervisor_;
  CraftBooks books_;
  std::map<std::uint16_t, pus::HousekeepingDecoder> decoders_;
  std::map<std::uint16_t, ResourceMarks> marks_;
};

/// What the log has; in words why there is nothing.
[[nodiscard]] std::string hear_log(const FoundLog& found, bool all, Hearing& hearing) {
  const auto newest = supervisor::read_log(found.path, {.last = 1});
  if (!newest || newest->records.empty()) return newest ? "the log is empty" : std::string{newest.error().text};
  supervisor::LogQuery query{.service = std::uint8_t{3}, .last = 1};
  if (!all) query.run = newest->records.back().run;
  // Heard as it is searched, and never found: a log may be larger than the memory of who reads it.
  query.text = "nothing is searched";
  query.words = [&](const supervisor::LogRecord& record) {
    hearing.hear(record.packet);
    return std::string{};
  };
  const auto page = supervisor::read_log(found.path, query);
  return page ? std::string{} : std::string{page.error().text};
}

/// What the flight says now, which its log has a moment later, or not at all; in words why nobody is heard.
[[nodiscard]] std::string hear_flight(const FoundLog& found, const std::string& mission, Hearing& hearing) {
  Connection connection;
  connection.mission = mission;
  connection.instance = found.flight->instance;
  const auto place = find_ground_link("resources", connection);
  if (!place) return "its flight is not heard";
  auto link = GroundConnection::open(place->host, place->port);
  if (!link) return fmt::format("{}:{}: {}", place->host, place->port, link.error().text);
  Listened listened;
  const bool open = listen(found.mission, *link, listened, [] { return false; });
  for (const auto& [apid, newest] : listened.values) {
    std::vector<pus::HousekeepingValue> values;
    for (const auto& [name, value] : newest) values.push_back(value);
    hearing.take(apid, values, listened.at[apid]);
  }
  return open ? "" : "the ground link was closed";
}

}  // namespace

int resources(const ResourcesOptions& options) {
  const auto found = find_log("resources", options.mission, options.instance);
  if (!found) return found.error();
  const Flies flies = found->flight ? Flies::Yes : Flies::No;
  Hearing hearing{found->mission};
  if (const std::string why = hear_log(*found, options.all, hearing); !why.empty()) {
    fmt::print(stderr, "hirosco resources: {}: {}\n", found->path.string(), why);
    if (flies == Flies::No) return exit_environment;
  }
  if (flies == Flies::Yes)
    if (const std::string why = hear_flight(*found, options.mission, hearing); !why.empty())
      fmt::print(stderr, "hirosco resources: {}: what is taken now is as the log has it\n", why);
  if (!options.json) fmt::print("{}\n", resource_heading(flies));
  bool all_heard = true;
  for (const auto* member : found->mission.everybody()) {
    const auto print = [&](const std::vector<ResourceRow>& rows) {
      for (const ResourceRow& row : rows)
        fmt::print("{}\n",
                   options.json ? resource_json(member->name, row, flies) : resource_line(member->name, row, flies));
    };
    ResourceMarks& marks = hearing.of(member->id);
    if (flies == Flies::Yes) {
      if (!hearing.books().runs(member->id)) marks.forget_now();
      print(hearing.books().rows(*member));
    }
    if (marks.silent()) {
      all_heard = false;
      fmt::print(stderr, "hirosco resources: {}: none of its reports in the log has RESOURCE_STATS\n", member->name);
      continue;
    }
    print(marks.rows(*member));
  }
  return all_heard ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
