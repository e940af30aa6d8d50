// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/api/routes.hpp"

#include <algorithm>
#include <array>
#include <ranges>
#include <utility>

#include "ground/api/openapi.hpp"
#include "ground/model/json.hpp"
#include "ground/model/views.hpp"
#include "ground/replay/history.hpp"
#include "ground/replay/log_search.hpp"
#include "ground/replay/story.hpp"
#include "ground/replay/timeline.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

constexpr double default_span_s = 60.0;
constexpr double default_timeline_s = 600.0;

[[nodiscard]] std::optional<descriptor::Severity> severity_of(std::string_view text) {
  for (const auto& row : EnumTexts<descriptor::Severity>::table)
    if (row.text == text) return row.value;
  return std::nullopt;
}

[[nodiscard]] double clamped(const Target& target, const char* name, double least, double usual, double most) {
  return std::clamp(target.number(name).value_or(usual), least, most);
}

/// "from" or "last" seconds before "to", which is now.
[[nodiscard]] Span span_of(const Question& asked, double last_s) {
  const Target& target = asked.target;
  Span span;
  span.to = target.number("to") ? onboard_time(*target.number("to")) : asked.session.now();
  const double last = target.number("last").value_or(last_s);
  span.from = target.number("from") ? onboard_time(*target.number("from")) : onboard_time(json_time(span.to) - last);
  return span;
}

/// The whole archive where nothing is said.
[[nodiscard]] Archive::Filter filter_of(const Target& target) {
  Archive::Filter filter{.span = {}, .text = target.text("text").value_or(""), .newest_first = true};
  if (const auto from = target.number("from")) filter.span.from = onboard_time(*from);
  if (const auto to = target.number("to")) filter.span.to = onboard_time(*to);
  if (const auto severity = severity_of(target.text("severity").value_or("")))
    filter.severity = static_cast<int>(*severity);
  constexpr double usual_limit = 200;
  filter.limit = static_cast<std::size_t>(clamped(target, "limit", 0.0, usual_limit, most_rows));
  return filter;
}

// --- answers ---------------------------------------------------------------------------------------------------------

void get_openapi(const Question&, const Respond& respond) { respond(answer(openapi_document())); }

void get_mission(const Question& asked, const Respond& respond) {
  respond(answer(mission_json(asked.session.catalogue(), asked.transitions, asked.faults)));
}

void get_status(const Question& asked, const Respond& respond) { respond(answer(asked.session.status())); }

void get_history(const Question& asked, const Respond& respond) {
  constexpr double fewest_points = 10, usual_points = 2000, most_points = 20'000;
  const auto points =
      static_cast<std::size_t>(clamped(asked.target, "points", fewest_points, usual_points, most_points));
  respond(outcome(history_json(asked.session.catalogue(), asked.session.archive(),
                               asked.target.text("parameter").value_or(""), span_of(asked, default_span_s), points)));
}

void get_csv(const Question& asked, const Respond& respond) {
  std::vector<std::string> names;
  const auto [first, last] = asked.target.parameters.equal_range("parameter");
  for (auto name = first; name != last; ++name) names.push_back(name->second);
  auto csv = history_csv(asked.session.catalogue(), asked.session.archive(), names, span_of(asked, default_span_s));
  if (!csv) return respond(error(csv.error().status, csv.error().text));
  HttpResponse response{.type = "text/csv; charset=utf-8", .body = std::move(*csv), .headers = {}};
  response.headers.emplace_back("Content-Disposition", "attachment; filename=\"telemetry.csv\"");
  respond(with_headers(std::move(response)));
}

void get_events(const Question& asked, const Respond& respond) {
  respond(answer(events_json(asked.session.archive(), filter_of(asked.target))));
}

void get_commands(const Question& asked, const Respond& respond) {
  respond(answer(commands_json(asked.session.archive(), filter_of(asked.target))));
}

void get_timeline(const Question& asked, const Respond& respond) {
  respond(answer(timeline_json(asked.session.archive(), span_of(asked, default_timeline_s))));
}

void get_why(const Question& asked, const Respond& respond) {
  const auto to = asked.target.number("to");
  respond(answer(
      newest_story(asked.session.catalogue(), asked.session.archive(), to ? onboard_time(*to) : OnboardTime::max())));
}

void get_log(const Question& asked, const Respond& respond) {
  constexpr double usual_lines = 200, most_lines = 2000, most_number = 9e15;
  const Target& target = asked.target;
  LogQuery query{.text = target.text("text").value_or("")};
  if (const auto to = target.number("to")) query.to = onboard_time(*to);
  query.before = static_cast<std::int64_t>(clamped(target, "before", 0.0, 0.0, most_number));
  if (target.number("housekeeping").value_or(0.0) != 0.0) query.housekeeping = Archive::Housekeeping::Included;
  query.limit = static_cast<std::size_t>(clamped(target, "limit", 1.0, usual_lines, most_lines));
  respond(answer(search_log(asked.session.catalogue(), asked.session.archive(), query)));
}

void get_alarms(const Question& asked, const Respond& respond) { respond(answer(asked.session.alarms().list())); }

void post_alarm(const Question& asked, const Respond& respond) { respond(outcome(asked.session.alarm(asked.body))); }

void get_authority(const Question& asked, const Respond& respond) { respond(answer(asked.session.authority())); }

void post_authority(const Question& asked, const Respond& respond) {
  respond(outcome(asked.session.authority(asked.body)));
}

void get_present(const Question& asked, const Respond& respond) { respond(answer(asked.session.pages().present())); }

void get_flights(const Question& asked, const Respond& respond) { respond(answer(asked.session.flights().list())); }

void post_flight(const Question& asked, const Respond& respond) {
  respond(outcome(asked.session.tell_of_flight(asked.body)));
}

void get_stacks(const Question& asked, const Respond& respond) { respond(answer(asked.session.stacks().list())); }

void post_stack(const Question& asked, const Respond& respond) {
  respond(outcome(asked.session.keep_stack(asked.body)));
}

void get_marks(const Question& asked, const Respond& respond) {
  const auto filter = filter_of(asked.target);
  nlohmann::json marks = nlohmann::json::array();
  for (const auto& mark : asked.session.archive().marks("", filter.span, filter.limit) | std::views::reverse)
    marks.push_back(mark_json(mark));
  respond(answer({{"marks", std::move(marks)}}));
}

void post_command(const Question& asked, const Respond& respond) {
  constexpr unsigned accepted = 202;
  respond(outcome(asked.session.command(asked.body), accepted));
}

void post_preview(const Question& asked, const Respond& respond) {
  asked.session.preview(asked.body, [respond](const Answered<json>& result) { respond(outcome(result)); });
}

void post_mode_preview(const Question& asked, const Respond& respond) {
  asked.session.mode_preview(asked.body, [respond](const Answered<json>& result) { respond(outcome(result)); });
}

void post_fault(const Question& asked, const Respond& respond) {
  asked.session.faults().inject(asked.body, [respond](const Answered<json>& result) { respond(outcome(result)); });
}

// --- the table -------------------------------------------------------------------------------------------------------

using Kind = QueryParameter::Kind;
constexpr QueryParameter parameter{"parameter", Kind::Text, "name of a parameter", true};
constexpr QueryParameter parameters{"parameter", Kind::Texts, "1 to 64 names of parameters", true};
constexpr QueryParameter from{"from", Kind::Number, "seconds of on-board time"};
constexpr QueryParameter to{"to", Kind::Number, "seconds of on-board time"};
constexpr QueryParameter last{"last", Kind::Number, "seconds before `to`, instead of `from`"};
constexpr QueryParameter points{"points", Kind::Whole, "10 to 20,000; more samples come as min and max of buckets"};
constexpr QueryParameter severity{"severity", Kind::Severity, "the lowest"};
constexpr QueryParameter any_text{"text", Kind::Text, "anywhere in names and text, without regard to case"};
constexpr QueryParameter limit{"limit", Kind::Whole, "rows, 200 by default, 10,000 at most"};
constexpr QueryParameter words{"text", Kind::Text, "words, each anywhere in the line, without regard to case"};
constexpr QueryParameter before{"before", Kind::Whole, "number of a packet: where an earlier answer ended"};
constexpr QueryParameter housekeeping{"housekeeping", Kind::Whole, "1: TM[3,25] too"};
constexpr QueryParameter lines{"limit", Kind::Whole, "lines, 200 by default, 2000 at most"};

constexpr std::array of_history{parameter, from, to, last, points};
constexpr std::array of_csv{parameters, from, to, last};
constexpr std::array of_events{from, to, severity, any_text, limit};
constexpr std::array of_commands{from, to, any_text, limit};
constexpr std::array of_timeline{from, to, last};
constexpr std::array of_marks{from, to, limit};
constexpr std::array of_why{to};
constexpr std::array of_log{words, to, before, housekeeping, lines};

constexpr std::array<unsigned, 1> unknown{404};
constexpr std::array<unsigned, 2> unknown_or_much{404, 413};
constexpr std::array<unsigned, 2> not_this_one{409, 413};
constexpr std::array<unsigned, 3> unknown_or_not_this_one{404, 409, 413};
constexpr std::array<unsigned, 3> not_now{409, 413, 503};
constexpr std::array<unsigned, 4> unknown_or_not_now{404, 409, 413, 503};

constexpr auto get = Route::Method::Get;
constexpr auto post = Route::Method::Post;
constexpr std::array table{
    Route{"/api/openapi.json", get, "This document", {}, "", 200, "Document", {}, get_openapi},
    Route{"/api/mission", get, "What the descriptors say", {}, "", 200, "Mission", {}, get_mission},
    Route{"/api/status", get, "How it is now, with all values", {}, "", 200, "Status", {}, get_status},
    Route{"/api/history", get, "Samples of one parameter", of_history, "", 200, "History", unknown, get_history},
    Route{"/api/export.csv", get, "Samples of several parameters", of_csv, "", 200, "", unknown_or_much, get_csv},
    Route{"/api/events", get, "Events, newest first", of_events, "", 200, "Events", {}, get_events},
    Route{"/api/timeline",
          get,
          "What happened in a span, oldest first",
          of_timeline,
          "",
          200,
          "Timeline",
          {},
          get_timeline},
    Route{"/api/why", get, "The chain of causes of the last stop", of_why, "", 200, "Story", {}, get_why},
    Route{"/api/log",
          get,
          "Every packet of the archive in words, searched by words, newest first",
          of_log,
          "",
          200,
          "Log",
          {},
          get_log},
    Route{"/api/alarms", get, "What deviated in this flight, who has seen it", {}, "", 200, "Alarms", {}, get_alarms},
    Route{"/api/alarms",
          post,
          "Acknowledge an alarm, shelve it for a time, or take it off the shelf",
          {},
          "AlarmRequest",
          200,
          "Alarms",
          unknown_or_not_this_one,
          post_alarm},
    Route{"/api/authority", get, "Who commands, and who asks for it", {}, "", 200, "Authority", {}, get_authority},
    Route{"/api/authority",
          post,
          "Take the command, keep it from who asks, or hand it over",
          {},
          "AuthorityRequest",
          200,
          "Authority",
          not_this_one,
          post_authority},
    Route{"/api/present", get, "Who has a page open at this station", {}, "", 200, "Present", {}, get_present},
    Route{"/api/flights", get, "The flights of the archive, newest first", {}, "", 200, "Flights", {}, get_flights},
    Route{"/api/flights",
          post,
          "Give a flight a name, or one more note",
          {},
          "FlightRequest",
          200,
          "FlightName",
          unknown_or_not_this_one,
          post_flight},
    Route{"/api/stacks", get, "Lists of telecommands that are kept here", {}, "", 200, "Stacks", {}, get_stacks},
    Route{"/api/stacks",
          post,
          "Keep a list of telecommands for everybody, or forget it",
          {},
          "StackRequest",
          200,
          "Stacks",
          unknown_or_not_this_one,
          post_stack},
    Route{
        "/api/marks", get, "What people did at this station, newest first", of_marks, "", 200, "Marks", {}, get_marks},
    Route{"/api/commands",
          get,
          "Telecommands with their reports, newest first",
          of_commands,
          "",
          200,
          "Commands",
          {},
          get_commands},
    Route{"/api/commands",
          post,
          "Send a telecommand; its reports follow as messages",
          {},
          "CommandRequest",
          202,
          "Sent",
          not_now,
          post_command},
    Route{"/api/commands/preview",
          post,
          "What would be sent, and would the supervisor permit it now?",
          {},
          "CommandRequest",
          200,
          "Preview",
          not_now,
          post_preview},
    Route{"/api/modes/preview",
          post,
          "What would SET_MODE do now, and what is against it?",
          {},
          "ModeRequest",
          200,
          "ModePreview",
          not_now,
          post_mode_preview},
    Route{"/api/faults",
          post,
          "One line to a simulated device",
          {},
          "FaultRequest",
          200,
          "FaultAnswer",
          unknown_or_not_now,
          post_fault},
};

}  // namespace

std::span<const Route> routes() { return table; }

const Route* find_route(std::string_view path, Route::Method method) {
  const auto found =
      std::ranges::find_if(table, [&](const Route& route) { return route.path == path && route.method == method; });
  return found != table.end() ? &*found : nullptr;
}

std::string senseless(const Route& route, const Target& target) {
  for (const QueryParameter& known : route.parameters) {
    const std::string name{known.name};
    const std::string value = target.text(name).value_or("");
    if (value.empty()) continue;
    if ((known.kind == Kind::Number || known.kind == Kind::Whole) && !target.number(name))
      return name + ": a number is wanted";
    if (known.kind == Kind::Severity && !severity_of(value)) return name + ": info, low, medium or high is wanted";
  }
  const auto many = [&](const std::string& name) {
    return std::ranges::any_of(
        route.parameters, [&](const QueryParameter& known) { return known.name == name && known.kind == Kind::Texts; });
  };
  for (const auto& [name, value] : target.parameters)
    if (target.parameters.count(name) > 1 && !many(name)) return name + ": once is enough";
  return {};
}

}  // namespace hirosco::ground
