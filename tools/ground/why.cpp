// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/ground/why.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hirosco/utilities/os/clock.hpp"
#include "hirosco/utilities/utf8.hpp"

namespace hirosco::ground {
namespace {

using nlohmann::json;

/// Words in the archive are of subsystems, devices and people: none steers a terminal.
[[nodiscard]] std::string words(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? printable_words(found->get<std::string>()) : std::string{};
}

[[nodiscard]] std::string after_words(const json& cause) {
  const auto found = cause.find("after_ms");
  if (found == cause.end() || !found->is_number()) return "before";
  const double ms = found->get<double>();
  return std::abs(ms) < 10'000 ? fmt::format("{:+.1f} ms", ms) : fmt::format("{:+.1f} s", ms * 1e-3);
}

[[nodiscard]] std::string listed(const json& story, const char* name) {
  std::string text;
  const auto found = story.find(name);
  if (found == story.end() || !found->is_array()) return text;
  for (const json& one : *found)
    if (one.is_string()) text += (text.empty() ? "" : ", ") + printable_words(one.get<std::string>());
  return text;
}

/// In a cell of a table, where a bar would end it.
[[nodiscard]] std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find_first_of("|\\", at)) != std::string::npos; at += 2) text.insert(at, "\\");
  return text;
}

/// Before everything else: what follows may be of another flight than one thinks.
[[nodiscard]] std::string paragraph(const std::string& mission, const WhichFlight& which) {
  const std::string since = flown_since(mission, which);
  return since.empty() ? since : since + "\n\n";
}

[[nodiscard]] std::string markdown(const json& story, const std::string& mission, const std::string& archive,
                                   const WhichFlight& which) {
  std::string text = fmt::format("# Why {} stopped\n\n{}**{}** {}\n\n", mission, paragraph(mission, which),
                                 words(story, "title"), words(story, "detail"));
  text +=
      fmt::format("| | |\n|---|---|\n| when | {} |\n| mission | {}, mode {} |\n| severity | {} |\n",
                  utc_text(story.value("t", 0.0)), cell(mission), cell(words(story, "mode")), words(story, "severity"));
  if (which.story_s) text += fmt::format("| flight | began {} |\n", utc_text(*which.story_s));
  if (const auto plan = words(story, "plan"); !plan.empty()) text += fmt::format("| plan | {} |\n", cell(plan));
  if (const auto stopped = listed(story, "stopped"); !stopped.empty())
    text += fmt::format("| stopped | {} |\n", cell(stopped));
  text += fmt::format("| archive | {} |\n\n| after | severity | what |\n|---:|---|---|\n", cell(archive));
  for (const json& cause : story["causes"])
    text += fmt::format("| {} | {} | {} |\n", after_words(cause), words(cause, "severity"), cell(words(cause, "text")));
  return text + fmt::format("\n**What to do now:** {}\n", words(story, "advice"));
}

[[nodiscard]] std::string lines(const json& story, const std::string& mission, bool coloured,
                                const WhichFlight& which) {
  const auto look = [&](const std::string& severity) {
    if (!coloured) return "";
    return severity == "high" ? "\x1b[1;31m" : severity == "medium" ? "\x1b[33m" : "";
  };
  const char* plain = coloured ? "\x1b[0m" : "";
  std::string text = paragraph(mission, which);
  if (which.story_s) text += fmt::format("flight of {} that began {}\n", mission, utc_text(*which.story_s));
  text += fmt::format("{}, {}, mode {}\n{}{}{}\n", mission, utc_text(story.value("t", 0.0)), words(story, "mode"),
                      look(words(story, "severity")), words(story, "title"), plain);
  if (const auto detail = words(story, "detail"); !detail.empty()) text += detail + "\n";
  text += "\n";
  for (const json& cause : story["causes"]) {
    const std::string severity = words(cause, "severity");
    text += fmt::format("{:>12}  {}{:6}{}  {}\n", after_words(cause), look(severity), severity, plain,
                        words(cause, "text"));
  }
  text += fmt::format("\nWhat to do now: {}\n", words(story, "advice"));
  if (const auto down = story.find("down"); down != story.end() && down->is_array())
    for (const json& one : *down)
      if (one.is_string())
        text += fmt::format("  {:<33} starts its process again, before the next\n",
                            "hirosco tc " + printable_words(one.get<std::string>()) + " SET_STATE 0");
  if (const auto mode = words(story, "mode_up"); !mode.empty())
    text += fmt::format("  hirosco mode {:<20} brings it up again (--preview: says what is against it)\n", mode);
  if (which.since_s) return text;  // the log ends with the other flight
  return text + fmt::format("  {:<33} is the story in the log\n", "hirosco log --last 60");
}

}  // namespace

std::string utc_text(double onboard_s) {
  const double unix_s =
      onboard_s - static_cast<double>(onboard_epoch_to_unix_s) - seconds(SystemClock::default_tai_minus_utc);
  const auto ms = static_cast<std::int64_t>(std::floor(unix_s * 1e3 + 0.5));
  const std::chrono::sys_time<std::chrono::milliseconds> instant{std::chrono::milliseconds{ms}};
  const auto day = std::chrono::floor<std::chrono::days>(instant);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss time{instant - day};
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}.{:03} UTC", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), time.hours().count(),
                     time.minutes().count(), time.seconds().count(), time.subseconds().count());
}

std::string flown_since(const std::string& mission, const WhichFlight& which) {
  if (!which.since_s) return {};
  return fmt::format(
      "{} has flown since, from {} on, and no ground station kept that flight: its story is `hirosco log --last 60`. "
      "What follows is of before.",
      mission, utc_text(*which.since_s));
}

std::optional<double> flight_of(const json& flights, const json& story) {
  const auto t = story.find("t");
  if (!story.is_object() || t == story.end() || !t->is_number() || !flights.is_object() || !flights.contains("flights"))
    return std::nullopt;
  for (const json& flight : flights["flights"])  // the newest first
    if (const double from_s = flight.value("from", 0.0); from_s <= t->get<double>()) return from_s;
  return std::nullopt;
}

std::string why_text(const json& story, const std::string& mission, const std::string& archive, WhyStyle style,
                     const WhichFlight& which) {
  if (!story.is_object() || !story.contains("causes") || !story["causes"].is_array() || story["causes"].empty())
    return style == WhyStyle::Markdown ? fmt::format("# Why {} stopped\n\n{}Nothing has stopped, as far as {} tells.\n",
                                                     mission, paragraph(mission, which), archive)
                                       : fmt::format("{}nothing has stopped, as far as the archive {} tells\n",
                                                     paragraph(mission, which), archive);
  return style == WhyStyle::Markdown ? markdown(story, mission, archive, which)
                                     : lines(story, mission, style == WhyStyle::Coloured, which);
}

}  // namespace hirosco::ground
