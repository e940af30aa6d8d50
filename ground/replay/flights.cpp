// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/flights.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <ranges>

#include "ground/model/json.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// Housekeeping comes late by a moment, and a cycle may be reduced for a while.
constexpr Duration tolerance = 2s;
constexpr double relative_tolerance = 0.1;
/// Before the supervisor counts its first cycle.
constexpr Duration way_up = 2s;
/// Further back, the on-board clock began again.
constexpr Duration clock_back = 5s;

struct Named {
  std::string name;
  std::string who;
};

[[nodiscard]] json note_json(const StoredMark& mark) {
  return {{"t", json_time(mark.t)}, {"who", mark.who}, {"text", mark.note}};
}

}  // namespace

Flights::Flights(const Catalogue& catalogue, Archive& archive) : catalogue_{catalogue}, archive_{archive} {
  for (const StoredMark& mark : archive_.marks("flight", {}))
    if (mark.action == "began") {
      began_ = mark.t;
      number_ = std::atoll(mark.name.c_str());
    }
  read_counts();
}

void Flights::read_counts() {
  const auto cycles = catalogue_.supervisor_column("SUBSYSTEMS.CYCLES");
  if (const auto extent = archive_.extent()) heard_ = extent->to;
  if (!cycles || number_ == 0) return;
  for (const Report& report : catalogue_.reports()) {
    const bool tells = report.apid == catalogue_.mission().supervisor.id &&
                       std::ranges::find(report.places, *cycles, &Place::column) != report.places.end();
    const auto last = tells ? archive_.last_of(report.apid, report.sid, OnboardTime::max()) : std::nullopt;
    if (!last) continue;
    const auto packet = pus::TelemetryView::parse(last->octets);
    if (!packet) continue;
    Model past{catalogue_};
    past.take(*packet);
    counts_ = counts_of(past);
  }
}

std::vector<Flights::Count> Flights::counts_of(const Model& model) const {
  std::vector<Count> counts;
  for (const SubsystemView& view : model.subsystems())
    counts.push_back({view.known ? view.t : OnboardTime{}, view.known ? view.cycles : 0});
  return counts;
}

Duration Flights::period_of(std::size_t subsystem, const Model& model) const {
  const auto* configuration =
      catalogue_.subsystems()[subsystem]->find_configuration(model.subsystems()[subsystem].configuration);
  return configuration != nullptr ? configuration->sampling : Duration{0};
}

bool Flights::goes_on(const std::vector<Count>& now, const Model& model) const {
  for (std::size_t i = 0; i < now.size() && i < counts_.size(); ++i) {
    const Duration period = period_of(i, model);
    if (counts_[i].cycles == 0 || now[i].cycles < counts_[i].cycles || period <= Duration{0}) continue;
    const double counted_s = seconds(period) * static_cast<double>(now[i].cycles - counts_[i].cycles);
    const double passed_s = seconds(now[i].t - counts_[i].t);
    if (std::abs(counted_s - passed_s) <= seconds(tolerance) + relative_tolerance * std::abs(passed_s)) return true;
  }
  return false;
}

bool Flights::hear(const Model& model) {
  const SubsystemView& supervisor = model.subsystems().front();
  if (!supervisor.known || supervisor.t == OnboardTime{}) return false;
  const bool newer = counts_.empty() || supervisor.t != counts_.front().t;
  if (!newer) return false;
  auto counts = counts_of(model);
  const bool back = model.newest() + clock_back < heard_;
  const bool same = number_ != 0 && !back && !counts_.empty() && goes_on(counts, model);
  const Duration flown = way_up + period_of(0, model) * static_cast<std::int64_t>(supervisor.cycles);
  const OnboardTime earliest = back ? OnboardTime{} : heard_;
  const bool fresh = number_ == 0;
  heard_ = model.newest();
  counts_ = std::move(counts);
  if (same) return false;
  begin(fresh ? supervisor.t - flown : std::max(earliest + Duration{1}, supervisor.t - flown));
  return true;
}

void Flights::begin(OnboardTime t) {
  const auto marks = archive_.marks("flight", {});
  for (const StoredMark& mark : marks) number_ = std::max<std::int64_t>(number_, std::atoll(mark.name.c_str()));
  ++number_;
  began_ = std::max(t, OnboardTime{});
  archive_.add(StoredMark{
      .t = began_, .kind = "flight", .name = std::to_string(number_), .action = "began", .who = "", .note = ""});
}

json Flights::present() const { return {{"id", number_}, {"from", json_time(began_)}}; }

json Flights::list() const {
  const auto marks = archive_.marks("flight", {});
  std::map<std::string, Named> names;
  std::map<std::string, json> notes;
  std::vector<const StoredMark*> begun;
  for (const StoredMark& mark : marks) {
    if (mark.action == "began") begun.push_back(&mark);
    if (mark.action == "named") names[mark.name] = {mark.note, mark.who};
    if (mark.action == "noted") notes[mark.name].push_back(note_json(mark));
  }
  json flights = json::array();
  OnboardTime next = archive_.extent().value_or(Span{}).to;
  for (const StoredMark* mark : begun | std::views::reverse) {
    // A clock that went back: it ended when nobody knows.
    const Span span{.from = mark->t, .to = std::max(mark->t, next)};
    const Named& named = names[mark->name];
    constexpr int medium = 3, high = 4;
    const auto serious = archive_.count_events(span, high);
    flights.push_back({{"id", std::atoll(mark->name.c_str())},
                       {"from", json_time(span.from)},
                       {"to", json_time(span.to)},
                       {"name", named.name},
                       {"named_by", named.who},
                       {"notes", notes.contains(mark->name) ? notes[mark->name] : json::array()},
                       {"high", serious},
                       {"medium", archive_.count_events(span, medium) - serious},
                       {"commands", archive_.count_commands(span)}});
    next = mark->t;
  }
  return {{"flights", std::move(flights)}};
}

Answered<std::string> Flights::number_of(const json& body, const std::vector<StoredMark>& marks) const {
  const auto given = body.find("flight");
  const std::string number =
      given != body.end() && given->is_number_integer() ? std::to_string(given->get<std::int64_t>()) : "";
  const bool known =
      std::ranges::any_of(marks, [&](const StoredMark& mark) { return mark.action == "began" && mark.name == number; });
  if (!known) return refuse(404, "flight: there is none of this number");
  return number;
}

Answered<json> Flights::name(const json& body, const std::string& who, OnboardTime now) {
  const auto number = number_of(body, archive_.marks("flight", {}));
  if (!number) return std::unexpected{number.error()};
  const std::string words = text_of(body, "name");
  if (words.size() > longest_name) return refuse(400, "name: at most 80 characters are wanted");
  archive_.add(StoredMark{.t = now, .kind = "flight", .name = *number, .action = "named", .who = who, .note = words});
  archive_.commit();
  return json{{"flight", std::atoll(number->c_str())}, {"name", words}};
}

Answered<json> Flights::note(const json& body, const std::string& who, OnboardTime now) {
  const auto marks = archive_.marks("flight", {});
  const auto number = number_of(body, marks);
  if (!number) return std::unexpected{number.error()};
  const std::string words = text_of(body, "note");
  if (words.empty() || words.size() > longest_note) return refuse(400, "note: 1 to 1,000 octets are wanted");
  json notes = json::array();
  for (const StoredMark& mark : marks)
    if (mark.action == "noted" && mark.name == *number) notes.push_back(note_json(mark));
  if (notes.size() >= most_notes) return refuse(409, "this flight has 100 notes: no more is taken");
  const StoredMark mark{.t = now, .kind = "flight", .name = *number, .action = "noted", .who = who, .note = words};
  archive_.add(mark);
  archive_.commit();
  notes.push_back(note_json(mark));
  return json{{"flight", std::atoll(number->c_str())}, {"notes", std::move(notes)}};
}

}  // namespace hirosco::ground
