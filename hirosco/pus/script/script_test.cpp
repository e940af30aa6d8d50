// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/script/script.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hirosco::pus {
namespace {

using Kind = ScriptLine::Kind;

[[nodiscard]] std::string told(const ScriptProblem& problem) {
  return std::to_string(problem.line) + ":" + std::to_string(problem.column) + " " + problem.message;
}
[[nodiscard]] std::string first_problem(std::string_view text) {
  const auto reading = read_script("S", text);
  return reading.problems.empty() ? "" : told(reading.problems.front());
}

TEST(Script, IsReadLineByLineWithItsWaits) {
  const auto reading = read_script("OUT",
                                   "# out and back\n\n"
                                   "ARM MOVE_J 0,1 SPEED=0.4\n"
                                   "@2.5 wait 1\n"
                                   "until ARM STATE.MOVING == 0 within 10   # rests\n"
                                   "event ARM MOTION_DONE within 5\n"
                                   "limit 30\n"
                                   "@4 ARM HOLD");
  ASSERT_TRUE(reading.problems.empty()) << told(reading.problems.front());
  const auto& lines = reading.script.lines;
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[0].kind, Kind::Telecommand);
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_EQ(lines[0].words, (std::vector<std::string>{"0,1", "SPEED=0.4"}));
  EXPECT_EQ(lines[0].words_at[1], 16);
  EXPECT_EQ(lines[1].kind, Kind::Wait);
  EXPECT_EQ(lines[1].not_before_s, 2.5);
  EXPECT_EQ(lines[1].seconds, 1);
  EXPECT_EQ(lines[2].kind, Kind::Until);
  EXPECT_EQ(lines[2].name, "STATE.MOVING");
  EXPECT_EQ(lines[2].seconds, 10);
  EXPECT_EQ(lines[3].kind, Kind::Event);
  EXPECT_EQ(lines[4].kind, Kind::Limit);
  EXPECT_EQ(lines[5].not_before_s, 4);
}

TEST(Script, IsAlsoAStackThatGroundHasWritten) {
  const auto reading = read_script("S",
                                   "#!/bin/sh\n# A stack: ends at the first telecommand that fails\nset -e\n"
                                   "hirosco tc LAMP FADE 0.5\nbuild/bin/hirosco tc LAMP OFF\n");
  ASSERT_TRUE(reading.problems.empty());
  ASSERT_EQ(reading.script.lines.size(), 2U);
  EXPECT_EQ(reading.script.lines[0].subsystem, "LAMP");
  EXPECT_EQ(reading.script.lines[1].name, "OFF");
}

TEST(Script, TellsWhereALineIsNone) {
  EXPECT_EQ(first_problem("LAMP"), "1:1 'LAMP' is no line of a script");
  EXPECT_EQ(first_problem("\n wait"), "2:2 'wait' takes its seconds, and nothing else");
  EXPECT_EQ(first_problem("wait 0"), "1:6 '0' are no seconds");
  EXPECT_EQ(first_problem("wait 90000"), "1:6 '90000' are no seconds");
  EXPECT_EQ(first_problem("wait nan"), "1:6 'nan' are no seconds");
  EXPECT_EQ(first_problem("until LAMP X = 1 within 5"), "1:14 '=' compares nothing");
  EXPECT_EQ(first_problem("until LAMP X == one within 5"), "1:17 'one' is no number");
  EXPECT_EQ(first_problem("until LAMP X == 1"), "1:1 this 'until' is none");
  EXPECT_EQ(first_problem("event LAMP BURNT"), "1:1 this 'event' is none");
  EXPECT_EQ(first_problem("@-1 LAMP OFF"), "1:1 '@-1' is no time of the script");
  EXPECT_EQ(first_problem("@1"), "1:1 a time, and nothing to do then");
  EXPECT_EQ(first_problem("LAMP NAME 'x"), "1:1 a quote is not closed");
  EXPECT_EQ(first_problem("# nothing\n"), "1:1 the script does nothing");
}

TEST(Script, IsBounded) {
  EXPECT_EQ(first_problem(std::string(20'001, 'x')), "1:1 the script is too long");
  EXPECT_EQ(first_problem("LAMP FADE " + std::string(400, '1')), "1:1 the line is too long");
  std::string many;
  for (std::size_t i = 0; i < most_script_lines; ++i) many += "wait 1\n";
  EXPECT_EQ(first_problem(many), "");
  EXPECT_EQ(first_problem(many + "wait 1\n"), "201:1 the script has too many lines");
}

TEST(Script, ComparesAsItIsWritten) {
  const auto holds = [](const char* comparison, double is_now) {
    const std::string text = std::string{"until L X "} + comparison + " 2 within 1";
    return read_script("S", text).script.lines.at(0).holds(is_now);
  };
  for (const double is_now : {1.0, 2.0, 3.0}) {
    EXPECT_EQ(holds("<", is_now), is_now < 2);
    EXPECT_EQ(holds("<=", is_now), is_now <= 2);
    EXPECT_EQ(holds("==", is_now), is_now == 2);
    EXPECT_EQ(holds("!=", is_now), is_now != 2);
    EXPECT_EQ(holds(">=", is_now), is_now >= 2);
    EXPECT_EQ(holds(">", is_now), is_now > 2);
  }
  EXPECT_FALSE(holds("<", std::numeric_limits<double>::quiet_NaN()));
}

/// A player whose <Commands> and <Subscribes> a mission has resolved.
struct ScriptOfAPlayer : ::testing::Test {
  using Thing = descriptor::Thing;
  descriptor::SubsystemDescriptor asker;

  [[nodiscard]] static descriptor::Field field(const char* name, Type type) {
    descriptor::Field made;
    made.name = name;
    made.type = type;
    made.minimum = Number{0};
    made.maximum = Number{1};
    return made;
  }
  ScriptOfAPlayer() {
    asker.name = "PLAYER";
    descriptor::Function fade;
    fade.name = "FADE";
    fade.arguments.push_back({.field = field("GOAL", Type::Double), .of = {}, .fallback = {}});
    descriptor::Field colour = field("COLOUR", Type::Float);
    colour.count = 3;
    descriptor::Commands lamp;
    lamp.subsystem = "LAMP";
    lamp.functions = {"FADE"};
    lamp.requests = {fade};
    lamp.apid = 8;
    lamp.things = {Thing{Thing::Kind::Read, "BRIGHTNESS", 5, {field("BRIGHTNESS", Type::Float)}},
                   Thing{Thing::Kind::Read, "COLOUR", 6, {colour}},
                   Thing{Thing::Kind::Set, "GAIN", 7, {field("GAIN", Type::Double)}}};
    asker.commands = {lamp};
    descriptor::Subscribes heard;
    heard.subsystem = "LAMP";
    heard.things = {Thing{Thing::Kind::Event, "BURNT_OUT", 1, {}}};
    heard.apid = 8;
    asker.subscribes = {heard};
  }
  std::string wrong(std::string_view text) {
    const auto reading = read_script("S", text);
    EXPECT_TRUE(reading.problems.empty());
    const auto problems = check_script(reading.script, asker);
    return problems.empty() ? "" : told(problems.front()) + " | " + problems.front().hint;
  }
};

TEST_F(ScriptOfAPlayer, MayAskWhatItsDescriptorSaysAndInTheFormOfWhomItAsks) {
  EXPECT_EQ(
      wrong("lamp fade 0.5\nLAMP SET:GAIN 0.3\nuntil LAMP BRIGHTNESS >= 0.5 within 3\nevent LAMP BURNT_OUT within 3"),
      "");
  EXPECT_EQ(wrong("LAMB FADE 0.5"), "1:1 'PLAYER' commands no subsystem 'LAMB' | did you mean 'LAMP'?");
  EXPECT_EQ(wrong("LAMP FAD 0.5"), "1:6 'PLAYER' may not ask LAMP for 'FAD' | did you mean 'FADE'?");
  EXPECT_EQ(wrong("LAMP BREAK"),
            "1:6 'PLAYER' may not ask LAMP for 'BREAK' | <Commands subsystem=\"LAMP\" functions=\"... BREAK\"/> of its "
            "descriptor permits it");
  EXPECT_NE(wrong("LAMP SET_STATE 5").find("modes and plans"), std::string::npos);
  EXPECT_TRUE(wrong("LAMP FADE bright").starts_with("1:11 'bright' is no GOAL, which may be "))
      << wrong("LAMP FADE bright");
  EXPECT_TRUE(wrong("LAMP FADE 1.5").starts_with("1:6 its arguments: ")) << wrong("LAMP FADE 1.5");
  EXPECT_NE(wrong("LAMP FADE"), "");
  EXPECT_NE(wrong("LAMP SET:GAIN 10"), "");
  EXPECT_EQ(wrong("LAMP SET:GAIM 1"), "1:6 'PLAYER' may not set GAIM of LAMP | did you mean 'GAIN'?");
  EXPECT_EQ(wrong("until LAMP BRIGHT < 1 within 2"),
            "1:12 'PLAYER' may not read 'BRIGHT' of LAMP | <Commands subsystem=\"LAMP\" reads=\"... BRIGHT\"/> of its "
            "descriptor permits it");
  EXPECT_EQ(wrong("until LAMP COLOUR < 1 within 2"), "1:12 'COLOUR' is not a single number | name what is in it");
  EXPECT_EQ(wrong("event LAMP BURNT within 2"),
            "1:12 'PLAYER' may not hear 'BURNT' of LAMP | <Subscribes subsystem=\"LAMP\" events=\"... BURNT\"/> of its "
            "descriptor permits it");
}

TEST_F(ScriptOfAPlayer, IsCheckedByNamesAloneWhereNoMissionSaysWhoThatIs) {
  asker.commands.front().apid = 0;
  asker.commands.front().requests.clear();
  EXPECT_EQ(wrong("LAMP FADE bright"), "");
  EXPECT_NE(wrong("LAMP FAD bright"), "");
}

TEST_F(ScriptOfAPlayer, TakesTheNumberOfAParameterFromTheWire) {
  const auto& brightness = asker.commands.front().things[0];
  const std::array quarter{std::byte{0x3e}, std::byte{0x80}, std::byte{0}, std::byte{0}};
  EXPECT_EQ(number_of(brightness, quarter), 0.25);
  EXPECT_FALSE(number_of(brightness, Octets{quarter}.first(3)));
}

}  // namespace
}  // namespace hirosco::pus
