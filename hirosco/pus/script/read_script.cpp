// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

#include "hirosco/pus/script/script.hpp"
#include "hirosco/pus/words/given_words.hpp"

namespace hirosco::pus {
namespace {

constexpr std::size_t longest_line = 400;
constexpr std::string_view forms =
    "SUBSYSTEM FUNCTION ARGUMENT..., wait S, until SUBSYSTEM PARAMETER < VALUE within S, event SUBSYSTEM EVENT within "
    "S, "
    "limit S; @S in front of any: not before";

using LineWords = std::span<const LineWord>;
using Is = ScriptLine::Is;

[[nodiscard]] std::optional<double> number_in(std::string_view text) noexcept {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

[[nodiscard]] std::optional<Is> comparison_in(std::string_view text) noexcept {
  constexpr std::array known{std::pair{"<", Is::Below},  std::pair{"<=", Is::AtMost},  std::pair{"==", Is::Equal},
                             std::pair{"!=", Is::Other}, std::pair{">=", Is::AtLeast}, std::pair{">", Is::Above}};
  const auto found = std::ranges::find(known, text, [](const auto& each) { return std::string_view{each.first}; });
  return found == known.end() ? std::nullopt : std::optional{found->second};
}

/// One line, taken apart; what is wrong with it goes to `problems`.
class LineReader {
 public:
  LineReader(std::uint16_t number, std::vector<ScriptProblem>& problems) : problems_{problems} {
    line_.number = number;
  }

  [[nodiscard]] std::optional<ScriptLine> read(LineWords words) {
    if (words[0].text.starts_with('@')) {
      if (!take_time(words[0])) return std::nullopt;
      words = words.subspan(1);
      if (words.empty()) return wrong({}, "a time, and nothing to do then", forms);
    }
    const std::string& first = words[0].text;
    if (first == "wait") return of_time(words, ScriptLine::Kind::Wait);
    if (first == "limit") return of_time(words, ScriptLine::Kind::Limit);
    if (first == "until") return until(words);
    if (first == "event") return event(words);
    return telecommand(words);
  }

 private:
  std::nullopt_t wrong(const LineWord& word, std::string message, std::string_view hint) {
    problems_.push_back({.line = line_.number,
                         .column = static_cast<std::uint16_t>(word.at + 1),
                         .length = std::max<std::size_t>(word.text.size(), 1),
                         .message = std::move(message),
                         .hint = std::string{hint}});
    return std::nullopt;
  }
  [[nodiscard]] static std::uint16_t column(const LineWord& word) noexcept {
    return static_cast<std::uint16_t>(word.at + 1);
  }
  bool take_time(const LineWord& word) {
    const auto time_s = number_in(std::string_view{word.text}.substr(1));
    if (time_s && *time_s >= 0 && *time_s <= longest_script_wait_s) {
      line_.not_before_s = *time_s;
      return true;
    }
    wrong(word, "'" + word.text + "' is no time of the script", "@2.5: not before 2.5 s; at most 86400");
    return false;
  }
  bool take_seconds(const LineWord& word) {
    const auto seconds = number_in(word.text);
    if (seconds && *seconds > 0 && *seconds <= longest_script_wait_s) {
      line_.seconds = *seconds;
      return true;
    }
    wrong(word, "'" + word.text + "' are no seconds", "more than 0, at most 86400");
    return false;
  }
  void take_names(const LineWord& subsystem, const LineWord& name) {
    line_.subsystem = subsystem.text;
    line_.subsystem_at = column(subsystem);
    line_.name = name.text;
    line_.name_at = column(name);
  }
  std::optional<ScriptLine> of_time(LineWords words, ScriptLine::Kind kind) {
    line_.kind = kind;
    if (words.size() != 2) return wrong(words[0], "'" + words[0].text + "' takes its seconds, and nothing else", forms);
    if (!take_seconds(words[1])) return std::nullopt;
    return std::move(line_);
  }
  std::optional<ScriptLine> until(LineWords words) {
    line_.kind = ScriptLine::Kind::Until;
    constexpr std::size_t count = 7;
    if (words.size() != count || words[5].text != "within") return wrong(words[0], "this 'until' is none", forms);
    take_names(words[1], words[2]);
    const auto is = comparison_in(words[3].text);
    if (!is) return wrong(words[3], "'" + words[3].text + "' compares nothing", "< <= == != >= >");
    line_.is = *is;
    const auto value = words[4].text == "true" || words[4].text == "on"     ? std::optional{1.0}
                       : words[4].text == "false" || words[4].text == "off" ? std::optional{0.0}
                                                                            : number_in(words[4].text);
    if (!value) return wrong(words[4], "'" + words[4].text + "' is no number", "true and false, too");
    line_.value = *value;
    if (!take_seconds(words[6])) return std::nullopt;
    return std::move(line_);
  }
  std::optional<ScriptLine> event(LineWords words) {
    line_.kind = ScriptLine::Kind::Event;
    constexpr std::size_t count = 5;
    if (words.size() != count || words[3].text != "within") return wrong(words[0], "this 'event' is none", forms);
    take_names(words[1], words[2]);
    if (!take_seconds(words[4])) return std::nullopt;
    return std::move(line_);
  }
  std::optional<ScriptLine> telecommand(LineWords words) {
    if (words.size() < 2) return wrong(words[0], "'" + words[0].text + "' is no line of a script", forms);
    take_names(words[0], words[1]);
    for (const LineWord& word : words.subspan(2)) {
      line_.words.push_back(word.text);
      line_.words_at.push_back(column(word));
    }
    return std::move(line_);
  }

  ScriptLine line_;
  std::vector<ScriptProblem>& problems_;
};

/// What a stack of ground has in front of its telecommands.
[[nodiscard]] LineWords without_shell(LineWords words) {
  if (words.size() >= 2 && words[0].text == "set" && words[1].text == "-e") return {};
  const bool called =
      words.size() >= 2 && words[1].text == "tc" && (words[0].text == "hirosco" || words[0].text.ends_with("/hirosco"));
  return called ? words.subspan(2) : words;
}

}  // namespace

bool ScriptLine::holds(double is_now) const noexcept {
  switch (is) {
    case Is::Below: return is_now < value;
    case Is::AtMost: return is_now <= value;
    case Is::Equal: return is_now == value;
    case Is::Other: return is_now != value;
    case Is::AtLeast: return is_now >= value;
    case Is::Above: return is_now > value;
  }
  return false;
}

ScriptReading read_script(std::string name, std::string_view text) {
  ScriptReading reading{.script = {.name = std::move(name), .lines = {}}, .problems = {}};
  const auto wrong = [&](std::uint16_t number, const char* message, const char* hint) {
    reading.problems.push_back({.line = number, .column = 1, .length = 1, .message = message, .hint = hint});
  };
  if (text.size() > most_script_octets) {
    wrong(1, "the script is too long", "at most 20,000 octets");
    return reading;
  }
  std::uint16_t number = 0;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    ++number;
    const auto words = words_of_line(line);
    if (!words) wrong(number, "a quote is not closed", "");
    else if (line.size() > longest_line) wrong(number, "the line is too long", "at most 400 octets");
    if (!words || line.size() > longest_line) continue;
    const LineWords telling = without_shell(*words);
    if (telling.empty()) continue;
    if (auto read = LineReader{number, reading.problems}.read(telling))
      reading.script.lines.push_back(std::move(*read));
    if (reading.script.lines.size() <= most_script_lines) continue;
    wrong(number, "the script has too many lines", "at most 200 that do something");
    return reading;
  }
  if (reading.script.lines.empty() && reading.problems.empty()) wrong(1, "the script does nothing", forms.data());
  return reading;
}

}  // namespace hirosco::pus
