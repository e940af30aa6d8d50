// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>

#include "hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp"
#include "hirosco/pus/words/describe.hpp"
#include "hirosco/utilities/os/clock.hpp"
#include "supervisor/platform/storage/log_pieces.hpp"
#include "supervisor/platform/storage/postgresql_database.hpp"
#include "tools/hirosco/commands.hpp"
#include "tools/hirosco/instance.hpp"
#include "tools/hirosco/json_line.hpp"

namespace hirosco::tools {
namespace {

/// As people write it down, and as `hirosco why` does; the records themselves are in TAI.
[[nodiscard]] std::string utc_words(OnboardTime stored) {
  return supervisor::time_text(stored - SystemClock::default_tai_minus_utc) + "Z";
}

/// What housekeeping says, by the names of the descriptors.
class LogValues {
 public:
  explicit LogValues(const descriptor::Mission& mission) {
    for (const auto* member : mission.everybody()) decoders_.emplace(member->id, pus::HousekeepingDecoder{*member});
  }
  /// Empty: it is no housekeeping, or not of this mission.
  [[nodiscard]] std::vector<pus::HousekeepingValue> of(Octets packet) const {
    const auto report = pus::TelemetryView::parse(packet);
    if (!report || report->service() != 3 || report->subtype() != 25) return {};
    const auto decoder = decoders_.find(report->apid());
    if (decoder == decoders_.end()) return {};
    auto values = decoder->second.decode(report->source_data());
    return values ? std::move(*values) : std::vector<pus::HousekeepingValue>{};
  }

 private:
  std::map<std::uint16_t, pus::HousekeepingDecoder> decoders_;
};

/// " NAME=1,2 m NAME=on"
[[nodiscard]] std::string values_words(const std::vector<pus::HousekeepingValue>& values) {
  std::string text;
  for (const auto& value : values)
    text +=
        fmt::format(" {}={}{}{}", value.name, fmt::join(value.texts(), ","), value.unit.empty() ? "" : " ", value.unit);
  return text;
}

/// null: no number that JSON has. Whole ones stand without a point, as HousekeepingValue::json() has them.
[[nodiscard]] nlohmann::ordered_json number_json(double number) {
  constexpr double all_exact = 9'007'199'254'740'992.0;  // 2 to the power of 53
  if (!std::isfinite(number)) return nullptr;
  if (std::abs(number) < all_exact && std::trunc(number) == number) return static_cast<std::int64_t>(number);
  return number;
}

/// Its elements, of a text the one.
[[nodiscard]] nlohmann::ordered_json elements_json(const pus::HousekeepingValue& value) {
  auto elements = nlohmann::ordered_json::array();
  if (value.type == Type::Text) elements.push_back(value.words);
  else
    for (const double number : value.values)
      elements.push_back(value.type == Type::Bool ? nlohmann::ordered_json(number != 0.0) : number_json(number));
  return elements;
}

[[nodiscard]] nlohmann::ordered_json record_json(const supervisor::LogRecord& record, std::string text,
                                                 const std::vector<pus::HousekeepingValue>& values) {
  nlohmann::ordered_json object{{"number", record.number},      {"stored", utc_words(record.stored)},
                                {"kind", to_text(record.kind)}, {"source", record.source},
                                {"peer", record.peer},          {"text", std::move(text)}};
  for (const auto& value : values) object["values"][value.name] = elements_json(value);
  return object;
}

}  // namespace

int log(const LogOptions& options) {
  std::filesystem::path path = options.path;
  std::optional<descriptor::Mission> mission;
  if (path.empty()) {
    auto found = find_log("log", options.mission, options.instance);
    if (!found) return found.error();
    path = std::move(found->path);
    mission = std::move(found->mission);
  } else {
    std::string name = options.mission.empty() ? meant_mission() : options.mission;
    // Pieces of one log are NAME.db, NAME.2.db and so on.
    if (name.empty()) name = path.filename().string().substr(0, path.filename().string().find('.'));
    if (!find_mission(name).empty()) mission = load_mission(name);
    else fmt::print(stderr, "hirosco log: of no known mission, so without its names (--mission NAME or FILE)\n");
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
  const auto values = mission ? std::optional<LogValues>{*mission} : std::nullopt;
  const bool wants_values = options.housekeeping || options.service;
  const auto values_of = [&](const supervisor::LogRecord& record) {
    return values && wants_values ? values->of(record.packet) : std::vector<pus::HousekeepingValue>{};
  };
  const auto text_of = [&](const supervisor::LogRecord& record) {
    std::string text;
    if (!describer || record.packet.empty()) {
      text = supervisor::describe(record);
      const std::string tai = supervisor::time_text(record.stored);
      if (const auto at = text.find(tai); at != std::string::npos)
        text.replace(at, tai.size(), utc_words(record.stored));
      return text;
    }
    text = fmt::format("{} {} {} {}", record.number, utc_words(record.stored), to_text(record.kind),
                       describer->describe(record.packet));
    if (!options.json) text += values_words(values_of(record));
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
    const bool foreign = page.error().code == ErrorCode::Mismatch;
    fmt::print(stderr, "hirosco log: {}: {}{}\n", path.string(), page.error().text,
               foreign ? ": read it with what wrote it" : "");
    return exit_environment;
  }
  // Not among the lines that others read.
  if (!options.json && !page->records.empty())
    fmt::print(stderr, "{}: number, time in UTC (Z), kind, what\n", path.string());
  for (const auto& record : page->records) {
    if (options.json) fmt::print("{}\n", json_line(record_json(record, text_of(record), values_of(record))));
    else fmt::print("{}\n", text_of(record));
  }
  if (page->damaged != 0)
    fmt::print(stderr, "hirosco log: {} damaged records, or whole pieces that cannot be read, left out\n",
               page->damaged);
  return page->damaged == 0 ? exit_ok : exit_finding;
}

}  // namespace hirosco::tools
