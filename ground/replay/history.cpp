// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "ground/model/json.hpp"
#include "ground/replay/timeline.hpp"
#include "hirosco/pus/packet/packet.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// Beyond it an answer says so by its last time: one question must not hold up the live view for seconds.
constexpr std::size_t most_samples = 1'000'000;
constexpr std::size_t most_csv_octets = std::size_t{64} << 20;
constexpr std::size_t most_csv_cells = 4'000'000;

/// "2026-11-24T13:20:47.123456Z"; "" before 1990, where missions on virtual time begin.
[[nodiscard]] std::string utc_text(OnboardTime t) {
  namespace chrono = std::chrono;
  constexpr OnboardTime calendar_from{chrono::seconds{1'000'000'000}};
  if (t < calendar_from) return {};
  const chrono::sys_time<Duration> utc{t.time_since_epoch() -
                                       chrono::seconds{onboard_epoch_to_unix_s + tai_minus_utc_s}};
  const auto day = chrono::floor<chrono::days>(utc);
  const chrono::year_month_day date{day};
  const chrono::hh_mm_ss time{chrono::floor<chrono::microseconds>(utc - day)};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), time.hours().count(),
                     time.minutes().count(), time.seconds().count(), time.subseconds().count());
}

/// Min and max of each of `points` equal parts of a span: long histories at the cost of short ones.
class Buckets {
 public:
  Buckets(const Span& span, std::size_t points)
      : from_s_{json_time(span.from)},
        width_s_{(json_time(span.to) - from_s_) / static_cast<double>(points)},
        parts_(points) {}
  void add(double t, double value) {
    const double place = width_s_ > 0 ? (t - from_s_) / width_s_ : 0.0;
    Part& part = parts_[std::min(parts_.size() - 1, static_cast<std::size_t>(std::max(0.0, place)))];
    const bool number = !std::isnan(value);
    if (part.count == 0 || (number && !(part.min <= value))) part.min = value;
    if (part.count == 0 || (number && !(part.max >= value))) part.max = value;
    ++part.count;
  }
  void write(json& into) const {
    json t = json::array(), min = json::array(), max = json::array();
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (parts_[i].count == 0) continue;
      t.push_back(from_s_ + (static_cast<double>(i) + 0.5) * width_s_);
      min.push_back(json_number(parts_[i].min));
      max.push_back(json_number(parts_[i].max));
    }
    into["t"] = std::move(t);
    into["min"] = std::move(min);
    into["max"] = std::move(max);
  }

 private:
  struct Part {
    std::size_t count{0};
    double min{}, max{};
  };
  double from_s_;
  double width_s_;
  std::vector<Part> parts_;
};

[[nodiscard]] bool is_words(const Catalogue& catalogue, std::size_t column) {
  return catalogue.columns()[column].type == Type::Text;
}

}  // namespace

bool samples(const Catalogue& catalogue, Archive& archive, std::size_t column, const Span& span, std::size_t most,
             const std::function<void(OnboardTime, double)>& take) {
  const std::uint16_t apid = catalogue.columns()[column].apid;
  std::vector<std::uint16_t> sids;
  for (const Report& report : catalogue.reports())
    if (report.apid == apid && std::ranges::find(report.places, column, &Place::column) != report.places.end() &&
        std::ranges::find(sids, report.sid) == sids.end())
      sids.push_back(report.sid);
  std::vector<std::pair<OnboardTime, double>> found;
  for (const std::uint16_t sid : sids)
    archive.packets_of(apid, sid, span, [&](const StoredPacket& packet) {
      const auto view = pus::TelemetryView::parse(packet.octets);
      const Report* report = view ? catalogue.report_of(apid, view->source_data()) : nullptr;
      if (report == nullptr) return true;
      const auto place = std::ranges::find(report->places, column, &Place::column);
      if (place != report->places.end()) found.emplace_back(packet.t, catalogue.read(*place, view->source_data()));
      return found.size() < most;
    });
  if (sids.size() > 1) std::ranges::stable_sort(found, {}, &std::pair<OnboardTime, double>::first);
  for (const auto& [t, value] : found) take(t, value);
  return found.size() < most;
}

Answered<json> history_json(const Catalogue& catalogue, Archive& archive, const std::string& parameter,
                            const Span& span, std::size_t points) {
  const auto column = catalogue.find_column(parameter);
  if (!column) return refuse(404, "no parameter '" + parameter + "'");
  if (is_words(catalogue, *column)) return refuse(400, "'" + parameter + "' is a text: only numbers have a history");
  std::vector<std::pair<double, double>> found;
  const bool complete = samples(catalogue, archive, *column, span, most_samples,
                                [&](OnboardTime t, double value) { found.emplace_back(json_time(t), value); });
  json result{{"parameter", parameter},
              {"unit", catalogue.columns()[*column].unit},
              {"complete", complete},
              {"gaps", gaps_json(archive.gaps(span))}};
  if (found.size() > points) {
    // From the first sample on: an open beginning must not put all of them into one bucket.
    Buckets buckets{{onboard_time(found.front().first), onboard_time(found.back().first)}, points};
    for (const auto& [t, value] : found) buckets.add(t, value);
    buckets.write(result);
    return result;
  }
  json t = json::array(), v = json::array();
  for (const auto& [time, value] : found) {
    t.push_back(time);
    v.push_back(json_number(value));
  }
  result["t"] = std::move(t);
  result["v"] = std::move(v);
  return result;
}

Answered<std::string> history_csv(const Catalogue& catalogue, Archive& archive,
                                  const std::vector<std::string>& parameters, const Span& span) {
  constexpr std::size_t most_columns = 64;
  if (parameters.empty() || parameters.size() > most_columns)
    return refuse(400, "parameter: 1 to 64 of them are wanted");
  std::map<OnboardTime, std::vector<std::optional<double>>> rows;
  std::size_t samples_left = most_samples;
  std::string body = "t,utc";
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto column = catalogue.find_column(parameters[i]);
    if (!column) return refuse(404, "no parameter '" + parameters[i] + "'");
    if (is_words(catalogue, *column))
      return refuse(400, "'" + parameters[i] + "' is a text: only numbers have a history");
    body += "," + parameters[i];
    bool fits = true;
    const bool whole = samples(catalogue, archive, *column, span, samples_left, [&](OnboardTime t, double value) {
      --samples_left;
      fits = fits && rows.size() * parameters.size() < most_csv_cells;
      if (!fits) return;
      auto& row = rows[t];
      row.resize(parameters.size());
      row[i] = value;
    });
    if (!whole || !fits) return refuse(413, "more than 1,000,000 samples: ask for a shorter span or fewer parameters");
  }
  body += "\n";
  for (const auto& [t, row] : rows) {
    body += fmt::format("{:.6f},{}", json_time(t), utc_text(t));
    for (const auto& value : row) body += value ? fmt::format(",{}", *value) : ",";
    body += "\n";
    if (body.size() > most_csv_octets) return refuse(413, "more than 64 MiB: ask for a shorter span");
  }
  return body;
}

}  // namespace hirosco::ground
