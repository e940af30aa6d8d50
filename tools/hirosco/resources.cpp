// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>

#include "hirosco/pus/packet/packet.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"
#include "tools/hirosco/resource_marks.hpp"

namespace hirosco::tools {
namespace {

/// Housekeeping of a mission's members, as it comes by.
class Hearing {
 public:
  explicit Hearing(const descriptor::Mission& mission) {
    for (const auto* member : mission.everybody()) decoders_.emplace(member->id, pus::HousekeepingDecoder{*member});
  }
  void hear(Octets packet) {
    const auto report = pus::TelemetryView::parse(packet);
    if (!report || report->service() != 3 || report->subtype() != 25) return;
    const auto decoder = decoders_.find(report->apid());
    if (decoder == decoders_.end()) return;
    if (const auto values = decoder->second.decode(report->source_data())) marks_[report->apid()].hear(*values);
  }
  [[nodiscard]] const ResourceMarks& of(std::uint16_t apid) { return marks_[apid]; }

 private:
  std::map<std::uint16_t, pus::HousekeepingDecoder> decoders_;
  std::map<std::uint16_t, ResourceMarks> marks_;
};

void print_json(const std::string& subsystem, const ResourceRow& row) {
  nlohmann::ordered_json object{{"subsystem", subsystem},
                                {"resource", row.attribute},
                                {"declared", nullptr},
                                {"high", row.high},
                                {"percent", nullptr}};
  if (row.declared) object["declared"] = *row.declared;
  if (const auto percent = row.percent()) object["percent"] = *percent;
  fmt::print("{}\n", json_line(object));
}

void print_text(const std::string& subsystem, const ResourceRow& row) {
  const auto percent = row.percent();
  fmt::print("{:<20} {:<22} {:>10} {:>10} {:>7}\n", subsystem, row.attribute,
             row.declared ? std::to_string(*row.declared) : "-", row.high,
             percent ? fmt::format("{} %", *percent) : "-");
}

}  // namespace

int resources(const ResourcesOptions& options) {
  const auto found = find_log("resources", options.mission, options.instance);
  if (!found) return found.error();
  const auto newest = supervisor::read_log(found->path, {.last = 1});
  if (!newest || newest->records.empty()) {
    fmt::print(stderr, "hirosco resources: {}: {}\n", found->path.string(),
               newest ? "the log is empty" : newest.error().text);
    return exit_environment;
  }
  Hearing hearing{found->mission};
  supervisor::LogQuery query{.service = std::uint8_t{3}, .last = 1};
  if (!options.all) query.run = newest->records.back().run;
  // Heard as it is searched, and never found: a log may be larger than the memory of who reads it.
  query.text = "nothing is searched";
  query.words = [&](const supervisor::LogRecord& record) {
    hearing.hear(record.packet);
    return std::string{};
  };
  if (const auto page = supervisor::read_log(found->path, query); !page) {
    fmt::print(stderr, "hirosco resources: {}: {}\n", found->path.string(), page.error().text);
    return exit_environment;
  }
  if (!options.json)
    fmt::print("{:<20} {:<22} {:>10} {:>10} {:>7}\n", "subsystem", "in <Resources>", "declared", "most used", "share");
  bool all_heard = true;
  for (const auto* member : found->mission.everybody()) {
    const ResourceMarks& marks = hearing.of(member->id);
    if (marks.silent()) {
      all_heard = false;
      fmt::print(stderr, "hirosco resources: {}: none of its reports in the log has RESOURCE_STATS\n", member->name);
      continue;
    }
    for (const ResourceRow& row : marks.rows(*member))
      options.json ? print_json(member->name, row) : print_text(member->name, row);
  }
  return all_heard ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
