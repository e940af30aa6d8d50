// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>

#include "hirosco/pus/script/script.hpp"
#include "tests/fuzz/fuzz.hpp"

/// A script from whatever text comes: each problem has a place in it and words, each line that is taken is within the bounds, and is read the
/// same when it is written again; who plays it is told of each line that is not permitted.
namespace {

using namespace hirosco;
using fuzz::expect;
using pus::ScriptLine;
using Kind = ScriptLine::Kind;

/// A word in quotes, as a shell has them.
[[nodiscard]] std::string quoted(const std::string& word) {
  std::string text = "\"";
  for (const char letter : word) {
    if (std::string_view{"\"\\$`"}.find(letter) != std::string_view::npos) text += '\\';
    text += letter;
  }
  return text + "\"";
}

[[nodiscard]] std::string digits(double number) {
  std::array<char, 40> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr};
}

[[nodiscard]] std::string written(const ScriptLine& line) {
  constexpr std::array comparisons{"<", "<=", "==", "!=", ">=", ">"};
  std::string text = "@" + digits(line.not_before_s) + " ";
  const std::string names = quoted(line.subsystem) + " " + quoted(line.name);
  const std::string within = " within " + digits(line.seconds);
  switch (line.kind) {
    case Kind::Wait: return text + "wait " + digits(line.seconds);
    case Kind::Limit: return text + "limit " + digits(line.seconds);
    case Kind::Event: return text + "event " + names + within;
    case Kind::Until:
      return text + "until " + names + " " + comparisons.at(static_cast<std::size_t>(line.is)) + " " +
             digits(line.value) + within;
    case Kind::Telecommand: break;
  }
  text += names;
  for (const std::string& word : line.words) text += " " + quoted(word);
  return text;
}

[[nodiscard]] bool same(const ScriptLine& one, const ScriptLine& other) {
  return one.kind == other.kind && one.not_before_s == other.not_before_s && one.subsystem == other.subsystem &&
         one.name == other.name && one.words == other.words && one.is == other.is && one.value == other.value &&
         one.seconds == other.seconds;
}

void check_problem(const pus::ScriptProblem& problem, std::size_t lines) {
  expect(problem.line >= 1 && problem.line <= lines && problem.column >= 1 && problem.length >= 1,
         "a problem has a place in the script");
  expect(!problem.message.empty(), "a problem says what");
}

void check_line(const ScriptLine& line) {
  fuzz::taken();
  const bool has_seconds = line.kind != Kind::Telecommand;
  expect(line.not_before_s >= 0 && line.not_before_s <= pus::longest_script_wait_s, "a time is within a day");
  expect(has_seconds == (line.seconds > 0) && line.seconds <= pus::longest_script_wait_s, "a wait is within a day");
  expect(line.words.size() == line.words_at.size(), "each word has its place");
  const std::string text = written(line);
  constexpr std::size_t shorter_than_any_limit = 400;
  if (text.size() > shorter_than_any_limit) return;
  const auto again = pus::read_script("AGAIN", text);
  expect(again.problems.empty() && again.script.lines.size() == 1 && same(again.script.lines.front(), line),
         "a line is written and read the same");
}

/// Commands ARM with a function, a setting and a value that it reads, and hears an event of it.
[[nodiscard]] descriptor::SubsystemDescriptor player() {
  using descriptor::Thing;
  descriptor::Field number;
  number.name = "SPEED";
  number.type = Type::Double;
  number.minimum = Number{0};
  number.maximum = Number{1};
  descriptor::Function move;
  move.name = "MOVE_J";
  move.arguments = {{.field = number, .of = {}, .fallback = Number{0.5}}};
  descriptor::Commands commands;
  commands.subsystem = "ARM";
  commands.apid = 10;
  commands.functions = {"MOVE_J"};
  commands.requests = {move};
  Thing set, read, event;
  set.kind = Thing::Kind::Set;
  set.name = "KP";
  set.fields = {number};
  read = set;
  read.kind = Thing::Kind::Read;
  read.name = "STATE.MOVING";
  event.kind = Thing::Kind::Event;
  event.name = "MOTION_DONE";
  commands.things = {set, read};
  descriptor::Subscribes hears;
  hears.subsystem = "ARM";
  hears.apid = 10;
  hears.things = {event};
  descriptor::SubsystemDescriptor made;
  made.name = "PLAYER";
  made.commands = {commands};
  made.subscribes = {hears};
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto who = player();
  const std::string_view text = fuzz::text_of(data, size);
  const auto lines = static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
  const auto reading = pus::read_script("FUZZED", text);
  expect(!reading.script.lines.empty() || !reading.problems.empty(), "a script does something, or is told why not");
  expect(reading.script.lines.size() <= pus::most_script_lines + 1, "the lines of a script are bounded");
  expect(reading.problems.size() <= lines + 1, "a line has one problem");
  for (const auto& problem : reading.problems) check_problem(problem, lines);
  for (const ScriptLine& line : reading.script.lines) check_line(line);
  const auto problems = pus::check_script(reading.script, who);
  expect(problems.size() <= reading.script.lines.size(), "who plays a line is told of it once");
  for (const auto& problem : problems) check_problem(problem, lines);
  return 0;
}
