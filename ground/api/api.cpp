// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/api.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ranges>

#include "ground/api/views.hpp"
#include "ground/model/json.hpp"
#include "ground/replay/log_search.hpp"
#include "ground/replay/story.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr double default_span_s = 60.0;
constexpr double default_timeline_s = 600.0;
constexpr std::size_t most_rows = 10'000;
constexpr std::size_t fewest_points = 10, usual_points = 2000, most_points = 20'000;
/// Beyond it an answer says so by its last time: one question must not hold up the live view for seconds.
constexpr std::size_t most_samples = 1'000'000;
constexpr std::size_t most_csv_octets = std::size_t{64} << 20;
constexpr std::size_t most_csv_cells = 4'000'000;

/// No script but ours, nothing from anywhere else, in nobody's frame.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
    "connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

[[nodiscard]] HttpResponse with_headers(HttpResponse response) {
  response.headers.emplace_back("Content-Security-Policy", policy);
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  response.headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
  response.headers.emplace_back("Cross-Origin-Opener-Policy", "same-origin");
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

[[nodiscard]] HttpResponse answer(const json& content, unsigned status = 200) {
  return with_headers({.status = status, .body = to_string(content), .headers = {}});
}
[[nodiscard]] HttpResponse error(unsigned status, const std::string& text) { return answer({{"error", text}}, status); }

[[nodiscard]] HttpResponse outcome(const Answered<json>& result, unsigned status = 200) {
  return result ? answer(*result, status) : error(result.error().status, result.error().text);
}

/// In a time that does not tell how much of it was right.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view secret) {
  if (secret.empty() || given.size() != secret.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < given.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(secret[i]);
  return difference == 0;
}

[[nodiscard]] std::string header(const HttpRequest& request, const char* name) {
  const auto found = request.headers.find(name);
  return found != request.headers.end() ? found->second : std::string{};
}

[[nodiscard]] json gaps_json(const std::vector<StoredGap>& gaps) {
  json list = json::array();
  for (const auto& gap : gaps) list.push_back({{"from", json_time(gap.from)}, {"to", json_time(gap.to)}});
  return list;
}

[[nodiscard]] int severity_of(const std::string& text) {
  for (const auto& row : EnumTexts<descriptor::Severity>::table)
    if (row.text == text) return static_cast<int>(row.value);
  return 0;
}

/// What is wrong with the parameters that are numbers or severities; empty: nothing. An empty one is as good as none.
[[nodiscard]] std::string senseless(const Target& target) {
  for (const char* name : {"from", "to", "last", "points", "limit", "before", "housekeeping"})
    if (!target.text(name).value_or("").empty() && !target.number(name))
      return std::string{name} + ": a number is wanted";
  for (const auto& [name, value] : target.parameters)
    if (name != "parameter" && target.parameters.count(name) > 1) return name + ": once is enough";
  const std::string severity = target.text("severity").value_or("");
  return severity.empty() || severity_of(severity) != 0 ? "" : "severity: info, low, medium or high is wanted";
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

}  // namespace

// --- who may ---------------------------------------------------------------------------------------------------------

bool Api::from_here(const HttpRequest& request) const {
  const std::array<std::string, 3> hosts{fmt::format("127.0.0.1:{}", options_.port),
                                         fmt::format("localhost:{}", options_.port),
                                         fmt::format("[::1]:{}", options_.port)};
  const auto ours = [&](const std::string& host) { return std::ranges::find(hosts, host) != hosts.end(); };
  if (!ours(header(request, "host"))) return false;
  const std::string origin = header(request, "origin");
  constexpr std::string_view scheme = "http://";
  return origin.empty() || (origin.starts_with(scheme) && ours(origin.substr(scheme.size())));
}

Api::Role Api::role_of(const HttpRequest& request, const Target& target) const {
  constexpr std::string_view scheme = "Bearer ";
  const std::string authorization = header(request, "authorization");
  const std::string given =
      authorization.starts_with(scheme) ? authorization.substr(scheme.size()) : target.text("token").value_or("");
  if (same_secret(given, options_.token)) return Role::Operator;
  return same_secret(given, options_.observer_token) ? Role::Observer : Role::Nobody;
}

void Api::handle(const HttpRequest& request, std::function<void(HttpResponse)> respond) {
  const auto target = read_target(request.target);
  if (!target) return respond(error(400, "the address is not understood"));
  if (!from_here(request)) return respond(error(403, "Host or Origin is not this station"));
  const bool reading = request.method == "GET" || request.method == "HEAD";
  if (target->path == "/ws") {
    const auto refusal = refuse_socket(request);
    if (refusal && refusal->status == 401) return refuse_token(std::move(respond));
    return respond(refusal ? *refusal : error(426, "a WebSocket is at /ws"));
  }
  if (!target->path.starts_with("/api/")) {
    if (!reading) return respond(error(405, "only GET"));
    return respond(page_file(request, target->path));
  }
  const Role role = role_of(request, *target);
  if (role == Role::Nobody) return refuse_token(std::move(respond));
  if (reading) return respond(get(*target));
  if (request.method != "POST") return respond(error(405, "only GET and POST"));
  post(request, *target, role, respond);
}

void Api::refuse_token(std::function<void(HttpResponse)> respond) {
  constexpr unsigned free_tries = 5;
  constexpr std::size_t most_waiting = 16;
  const HttpResponse refusal = error(401, "the token is missing or wrong");
  calm_at_ = tick_ + ticks_to_forget;
  if (++wrong_tokens_ <= free_tries) return respond(refusal);
  // One after the other, whoever asks. More of them would take the connections that others need.
  if (late_.size() >= most_waiting) return respond(error(429, "too many wrong tokens"));
  const std::uint64_t after = late_.empty() ? tick_ : late_.back().tick;
  late_.push_back({after + ticks_of_delay, [respond = std::move(respond), refusal] { respond(refusal); }});
}

void Api::tick() {
  ++tick_;
  if (tick_ >= calm_at_) wrong_tokens_ = 0;
  while (!late_.empty() && late_.front().tick <= tick_) {
    const auto answer = std::move(late_.front().answer);
    late_.pop_front();
    answer();
  }
  session_.tick();
}

std::optional<HttpResponse> Api::refuse_socket(const HttpRequest& request) {
  const auto target = read_target(request.target);
  if (!target || target->path != "/ws") return error(404, "WebSockets are at /ws");
  if (!from_here(request)) return error(403, "Host or Origin is not this station");
  if (role_of(request, *target) == Role::Nobody) return error(401, "the token is missing or wrong");
  return std::nullopt;
}

void Api::opened(const HttpRequest& request, Peer& peer) {
  const auto target = read_target(request.target);
  static_cast<void>(session_.opened(peer, target && role_of(request, *target) == Role::Operator));
}

void Api::post(const HttpRequest& request, const Target& target, Role role,
               const std::function<void(HttpResponse)>& respond) {
  if (role != Role::Operator) return respond(error(403, "observers do not command"));
  if (session_.in_replay(header(request, "x-client"))) return respond(error(409, "this page replays the past"));
  const json body = parsed_request(request.body);
  if (!body.is_object()) return respond(error(400, "a JSON object is wanted, with each key once"));
  if (target.path == "/api/commands") return respond(outcome(session_.command(body), 202));
  const auto later = [respond](const Answered<json>& result) { respond(outcome(result)); };
  if (target.path == "/api/commands/preview") return session_.preview(body, later);
  if (target.path == "/api/faults") return session_.fault(body, later);
  respond(error(404, "nothing takes POSTs there"));
}

// --- reading ---------------------------------------------------------------------------------------------------------

Span Api::span_of(const Target& target, double last_s) const {
  Span span;
  span.to = target.number("to") ? onboard_time(*target.number("to")) : session_.now();
  const double last = target.number("last").value_or(last_s);
  span.from = target.number("from") ? onboard_time(*target.number("from")) : onboard_time(json_time(span.to) - last);
  return span;
}

HttpResponse Api::get(const Target& target) {
  const std::string& path = target.path;
  if (const std::string wrong = senseless(target); !wrong.empty()) return error(400, wrong);
  if (path == "/api/mission") return answer(mission_json(session_.catalogue(), options_.transitions, options_.faults));
  if (path == "/api/status") return answer(session_.status());
  if (path == "/api/history") return history(target);
  if (path == "/api/export.csv") return csv(target);
  if (path == "/api/timeline") return answer(timeline(target));
  if (path == "/api/why")
    return answer(newest_story(session_.catalogue(), session_.archive(),
                               target.number("to") ? onboard_time(*target.number("to")) : OnboardTime::max()));
  if (path == "/api/log") return answer(log(target));
  constexpr double usual_limit = 200;
  Archive::Filter filter{.span = {}, .text = target.text("text").value_or(""), .newest_first = true};
  if (const auto from = target.number("from")) filter.span.from = onboard_time(*from);
  if (const auto to = target.number("to")) filter.span.to = onboard_time(*to);
  filter.severity = severity_of(target.text("severity").value_or(""));
  const double limit = target.number("limit").value_or(usual_limit);
  filter.limit = static_cast<std::size_t>(std::clamp(limit, 0.0, static_cast<double>(most_rows)));
  json list = json::array();
  if (path == "/api/events") {
    for (const auto& event : session_.archive().events(filter)) list.push_back(event_json(event));
    return answer({{"events", std::move(list)}});
  }
  if (path == "/api/commands") {
    for (const auto& command : session_.archive().commands(filter)) {
      json one = command_json(command);
      one["reports"] = json::array();
      for (const auto& report : session_.archive().reports(command.number))
        one["reports"].push_back(report_json(report));
      list.push_back(std::move(one));
    }
    return answer({{"commands", std::move(list)}});
  }
  return error(404, "nothing is there");
}

bool samples(Session& session, std::size_t column, const Span& span, std::size_t most,
             const std::function<void(OnboardTime, double)>& take) {
  const Catalogue& catalogue = session.catalogue();
  const std::uint16_t apid = catalogue.columns()[column].apid;
  std::vector<std::uint16_t> sids;
  for (const Report& report : catalogue.reports())
    if (report.apid == apid && std::ranges::find(report.places, column, &Place::column) != report.places.end() &&
        std::ranges::find(sids, report.sid) == sids.end())
      sids.push_back(report.sid);
  std::vector<std::pair<OnboardTime, double>> found;
  for (const std::uint16_t sid : sids)
    session.archive().packets_of(apid, sid, span, [&](const StoredPacket& packet) {
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

HttpResponse Api::history(const Target& target) {
  const std::string name = target.text("parameter").value_or("");
  const auto column = session_.catalogue().find_column(name);
  if (!column) return error(404, "no parameter '" + name + "'");
  const Span span = span_of(target, default_span_s);
  const double wanted = target.number("points").value_or(static_cast<double>(usual_points));
  const auto points = static_cast<std::size_t>(
      std::clamp(wanted, static_cast<double>(fewest_points), static_cast<double>(most_points)));
  std::vector<std::pair<double, double>> found;
  const bool complete = samples(session_, *column, span, most_samples,
                                [&](OnboardTime t, double value) { found.emplace_back(json_time(t), value); });
  json result{{"parameter", name},
              {"unit", session_.catalogue().columns()[*column].unit},
              {"complete", complete},
              {"gaps", gaps_json(session_.archive().gaps(span))}};
  if (found.size() > points) {
    // From the first sample on: an open beginning must not put all of them into one bucket.
    Buckets buckets{{onboard_time(found.front().first), onboard_time(found.back().first)}, points};
    for (const auto& [t, value] : found) buckets.add(t, value);
    buckets.write(result);
    return answer(result);
  }
  json t = json::array(), v = json::array();
  for (const auto& [time, value] : found) {
    t.push_back(time);
    v.push_back(json_number(value));
  }
  result["t"] = std::move(t);
  result["v"] = std::move(v);
  return answer(result);
}

HttpResponse Api::csv(const Target& target) {
  const auto [first, last] = target.parameters.equal_range("parameter");
  std::vector<std::string> names;
  for (auto name = first; name != last; ++name) names.push_back(name->second);
  constexpr std::size_t most_columns = 64;
  if (names.empty() || names.size() > most_columns) return error(400, "parameter: 1 to 64 of them are wanted");
  const Span span = span_of(target, default_span_s);
  std::map<OnboardTime, std::vector<std::optional<double>>> rows;
  std::size_t samples_left = most_samples;
  std::string body = "t";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto column = session_.catalogue().find_column(names[i]);
    if (!column) return error(404, "no parameter '" + names[i] + "'");
    body += "," + names[i];
    bool fits = true;
    const bool whole = samples(session_, *column, span, samples_left, [&](OnboardTime t, double value) {
      --samples_left;
      fits = fits && rows.size() * names.size() < most_csv_cells;
      if (!fits) return;
      auto& row = rows[t];
      row.resize(names.size());
      row[i] = value;
    });
    if (!whole || !fits) return error(413, "more than 1,000,000 samples: ask for a shorter span or fewer parameters");
  }
  body += "\n";
  for (const auto& [t, row] : rows) {
    body += fmt::format("{:.6f}", json_time(t));
    for (const auto& value : row) body += value ? fmt::format(",{}", *value) : ",";
    body += "\n";
    if (body.size() > most_csv_octets) return error(413, "more than 64 MiB: ask for a shorter span");
  }
  HttpResponse response{.type = "text/csv; charset=utf-8", .body = std::move(body), .headers = {}};
  response.headers.emplace_back("Content-Disposition", "attachment; filename=\"telemetry.csv\"");
  return with_headers(std::move(response));
}

json Api::timeline(const Target& target) {
  const Span span = span_of(target, default_timeline_s);
  json modes = json::array(), states = json::array(), links = json::array();
  for (const auto& change : session_.archive().changes(span)) {
    const double t = json_time(change.t);
    if (change.kind == "mode") modes.push_back({{"t", t}, {"mode", change.value}});
    if (change.kind == "state")
      states.push_back(
          {{"t", t}, {"subsystem", change.name}, {"state", change.value.empty() ? json(nullptr) : json(change.value)}});
    if (change.kind == "link")
      links.push_back({{"t", t}, {"id", std::atoi(change.name.c_str())}, {"up", change.value == "up"}});
  }
  // Of too many the newest, like of all else.
  const Archive::Filter filter{.span = span, .text = {}, .limit = most_rows, .newest_first = true};
  json commands = json::array(), events = json::array(), faults = json::array();
  for (const auto& command : session_.archive().commands(filter) | std::views::reverse)
    commands.push_back(command_json(command));
  for (const auto& event : session_.archive().events(filter) | std::views::reverse) events.push_back(event_json(event));
  for (const auto& fault : session_.archive().faults(span))
    faults.push_back(
        {{"t", json_time(fault.t)}, {"device", fault.device}, {"line", fault.line}, {"answer", fault.answer}});
  return {{"modes", std::move(modes)},
          {"states", std::move(states)},
          {"links", std::move(links)},
          {"commands", std::move(commands)},
          {"events", std::move(events)},
          {"faults", std::move(faults)},
          {"gaps", gaps_json(session_.archive().gaps(span))}};
}

json Api::log(const Target& target) {
  constexpr double usual_lines = 200, most_lines = 2000, most_number = 9e15;
  LogQuery query{.text = target.text("text").value_or("")};
  if (const auto to = target.number("to")) query.to = onboard_time(*to);
  query.before = static_cast<std::int64_t>(std::clamp(target.number("before").value_or(0.0), 0.0, most_number));
  if (target.number("housekeeping").value_or(0.0) != 0.0) query.housekeeping = Archive::Housekeeping::Included;
  query.limit = static_cast<std::size_t>(std::clamp(target.number("limit").value_or(usual_lines), 1.0, most_lines));
  return search_log(session_.catalogue(), session_.archive(), query);
}

HttpResponse Api::page_file(const HttpRequest& request, const std::string& path) const {
  const bool zipped = header(request, "accept-encoding").find("gzip") != std::string::npos;
  auto file = page_.file(path, zipped);
  return file ? with_headers(std::move(*file)) : error(404, "nothing is there");
}

}  // namespace hirosco::ground
