// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/screen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "supervisor/testing/pair_overview.hpp"
#include "tools/terminal/columns.hpp"

namespace hirosco::terminal {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* url = "http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef";

ScreenModel known(const Overview& craft) {
  ScreenModel model;
  model.take(supervisor::json_of(craft, 754.2, {{"tip", "(+0.010, -0.020) m"}, {"force", "(+1.50) N"}}));
  model.take(std::string{R"({"url":")"} + url + R"(","observer_url":")" + url + "\"}");
  model.take(R"({"at_s":0.0011,"told":"ARM Offline"})");
  model.take(R"({"at_s":12.25,"told":"ARM low TEMPERATURE JOINT=2 VALUE=61 degC"})");
  return model;
}

std::string whole(const Picture& picture) {
  std::string text;
  for (const std::string& line : words_of(picture)) text += line + "\n";
  return text;
}

Overview stopped() {
  Overview craft = supervisor::testing::pair();
  for (auto& member : craft.members) member.state = "Offline";
  for (auto& member : craft.members) member.cycling = false;
  craft.members[1].inhibited = 4;
  for (auto& link : craft.links) link.up = false;
  return craft;
}

TEST(ScreenTest, ShowsACraftThatIsWellIn80Columns) {
  EXPECT_EQ(whole(draw(known(supervisor::testing::pair()), {80, 24}, 0.1)),
            R"( PAIR  coupled                                                 ● well  0:12:34
 page     http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef
 to look  http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef

   SUBSYSTEM  STATE                CYCLE      LATE   MISSED
 ● ARM        Operational        2000 Hz     31 us        0
 ● HAND       Operational        2000 Hz     31 us        0
 links 2/2  ● ARM → HAND  ● HAND → ARM
  tip (+0.010, -0.020) m  force (+1.50) N

 EVENTS
     0.001 s · ARM Offline
    12.250 s ◆ ARM low TEMPERATURE JOINT=2 VALUE=61 degC










 q end   e low and up   ↑↓ scroll   S stop all actuators
)");
}

TEST(ScreenTest, UsesTheWidthThatItHas) {
  const auto lines = words_of(draw(known(supervisor::testing::pair()), {120, 40}, 0.1));
  EXPECT_EQ(lines[4], "   SUBSYSTEM  STATE                CYCLE      LATE   MISSED   OVERRAN    LOAD  ACTUATORS");
  EXPECT_EQ(lines[5], " ● ARM        Operational        2000 Hz     31 us        0         0   4.0 %  free");
  ASSERT_EQ(lines.size(), 40U);
}

TEST(ScreenTest, SaysWhatStoppedAboveTheEvents) {
  EXPECT_EQ(whole(draw(known(stopped()), {80, 24}, 0.1)),
            R"( PAIR  coupled                                             ■ NOT WELL  0:12:34
 page     http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef
 to look  http://127.0.0.1:8080/#token=0123456789abcdef0123456789abcdef

   SUBSYSTEM  STATE                CYCLE      LATE   MISSED
 ■ ARM        Offline
 ■ HAND       Offline

 ■ ARM is Offline, the mode has it Operational
 ■ HAND is Offline, the mode has it Operational: its device is lost
 ■ link 1, ARM → HAND, is down
 ■ link 2, HAND → ARM, is down
 links 0/2  ■ ARM → HAND  ■ HAND → ARM
  tip (+0.010, -0.020) m  force (+1.50) N

 EVENTS
     0.001 s · ARM Offline
    12.250 s ◆ ARM low TEMPERATURE JOINT=2 VALUE=61 degC





 q end   e low and up   ↑↓ scroll   S stop all actuators
)");
}

TEST(ScreenTest, SaysThatNothingIsToldAnyMoreRatherThanWhatWasLast) {
  const auto lines = words_of(draw(known(supervisor::testing::pair()), {80, 24}, 7.4));
  EXPECT_THAT(lines[0], HasSubstr("■ SUPERVISOR SILENT FOR 7 s"));
  EXPECT_THAT(lines[0], Not(HasSubstr("well")));
}

TEST(ScreenTest, StartsBeforeAnythingIsKnown) {
  const auto lines = words_of(draw(ScreenModel{}, {80, 24}, 0));
  EXPECT_THAT(lines[0], HasSubstr("starting"));
  EXPECT_EQ(lines.size(), 24U);
}

TEST(ScreenTest, AsksBeforeItEndsAFlightAndSaysThatItEnds) {
  ScreenModel model = known(supervisor::testing::pair());
  model.press(Key::End, 5);
  EXPECT_THAT(words_of(draw(model, {80, 24}, 0)).back(), HasSubstr("End the flight? q again"));
  model.press(Key::End, 5);
  EXPECT_THAT(words_of(draw(model, {80, 24}, 0)).back(), HasSubstr("ending in order"));
}

TEST(ScreenTest, ScrollsBackAndFiltersEvents) {
  ScreenModel model = known(supervisor::testing::pair());
  for (int i = 0; i < 100; ++i) model.take("{\"at_s\":20,\"told\":\"line " + std::to_string(i) + "\"}");
  const Picture newest = draw(model, {80, 24}, 0);
  EXPECT_THAT(whole(newest), HasSubstr("line 99\n"));
  model.press(Key::PageUp, newest.event_rows);
  const std::string back = whole(draw(model, {80, 24}, 0));
  ASSERT_EQ(newest.event_rows, 12U);
  EXPECT_THAT(back, HasSubstr(" EVENTS  12 newer below"));
  EXPECT_THAT(back, HasSubstr("line 87\n"));
  EXPECT_THAT(back, Not(HasSubstr("line 88\n")));
  model.press(Key::Filter, newest.event_rows);
  const std::string grave = whole(draw(model, {80, 24}, 0));
  EXPECT_THAT(grave, HasSubstr("TEMPERATURE"));
  EXPECT_THAT(grave, Not(HasSubstr("line")));
}

TEST(ScreenTest, CutsLongWordsButNoUrl) {
  Overview craft = supervisor::testing::pair();
  craft.members[0].name = "A_PROBE_OF_A_VERY_LONG_NAME_INDEED";
  craft.mode = std::string(100, 'm');
  ScreenModel model = known(craft);
  model.take("{\"at_s\":20,\"told\":\"" + std::string(300, 'y') + "\"}");
  const auto lines = words_of(draw(model, {80, 24}, 0));
  EXPECT_THAT(lines[5], HasSubstr(" A_PROBE_OF_A_VERY_L…  Operational"));
  EXPECT_THAT(whole(draw(model, {80, 24}, 0)), HasSubstr("yyy…\n"));
  const std::string narrow = whole(draw(model, {50, 40}, 0));
  std::string together = narrow;
  std::erase(together, '\n');
  EXPECT_THAT(together, HasSubstr(url));
}

TEST(ScreenTest, OfMoreSubsystemsThanThereIsRoomForThoseThatDeviateAreSeen) {
  Overview craft = supervisor::testing::pair();
  for (int i = 0; i < 40; ++i) {
    craft.members.push_back(craft.members[1]);
    craft.members.back().name = "PART_" + std::to_string(i);
  }
  craft.members[30].state = "ErrorOperational";
  const auto lines = words_of(draw(known(craft), {80, 24}, 0));
  ASSERT_EQ(lines.size(), 24U);
  const std::string text = whole(draw(known(craft), {80, 24}, 0));
  EXPECT_THAT(text, HasSubstr("■ PART_28"));
  EXPECT_THAT(text, HasSubstr(" more\n"));
  EXPECT_THAT(text, HasSubstr("12.250 s")) << "and the newest event is";
}

TEST(ScreenTest, NeverIsWiderOrHigherThanTheTerminalWhateverItShows) {
  std::mt19937 random{7};
  const auto any = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  const std::vector<std::string> words{
      "ARM", "\xe6\x89\x8b\xe6\x89\x8b", std::string(90, 'z'), "", "m\xc3\xa4\xc3\x9f", "\x1b[2J", "a\xcc\x88"};
  const auto word = [&] { return words[static_cast<std::size_t>(any(static_cast<int>(words.size())))]; };
  for (int i = 0; i < 1000; ++i) {
    Overview craft{.mission = word(),
                   .mode = word(),
                   .usual_mode = word(),
                   .waits_for = any(2) ? word() : "",
                   .members = {},
                   .links = {}};
    for (int n = any(20); n > 0; --n)
      craft.members.push_back({.name = word(),
                               .runs = any(2) != 0,
                               .state = any(2) ? "Operational" : word(),
                               .wanted = any(2) ? "Operational" : "",
                               .counted = any(2) != 0,
                               .cycling = any(2) != 0,
                               .inhibited = static_cast<std::uint32_t>(random() % 256),
                               .period_ns = random(),
                               .missed = random()});
    for (int n = any(20); n > 0; --n)
      craft.links.push_back({.id = 1, .from = word(), .to = word(), .up = any(2) != 0, .wanted = any(2) != 0});
    ScreenModel model;
    std::vector<std::pair<std::string, std::string>> values;
    for (int n = any(8); n > 0; --n) values.emplace_back(word(), word());
    if (any(8) != 0) model.take(supervisor::json_of(craft, any(1'000'000), values));
    if (any(2) != 0) model.take(std::string{R"({"url":")"} + url + "\"}");
    for (int n = any(30); n > 0; --n) model.take(word());
    for (int n = any(4); n > 0; --n) model.press(static_cast<Key>(any(11)), static_cast<std::size_t>(any(10)));
    const Size size{static_cast<std::size_t>(any(140)), static_cast<std::size_t>(any(50))};
    const Picture picture = draw(model, size, any(10));
    ASSERT_LE(picture.rows.size(), size.rows);
    const std::size_t expected = size.columns == 0 ? 0 : size.rows;
    ASSERT_EQ(picture.rows.size(), expected);
    ASSERT_LE(picture.event_rows, size.rows);
    for (const std::string& line : words_of(picture)) ASSERT_LE(width_of(line), size.columns) << line;
  }
}

TEST(PaintTest, SendsTheRowsThatDifferAndNoOthers) {
  ScreenModel model = known(supervisor::testing::pair());
  const Picture first = draw(model, {80, 24}, 0);
  EXPECT_EQ(paint(first, first, {80, 24}, {}), "");
  model.take(R"({"at_s":13,"told":"HAND Offline"})");
  const std::string sent = paint(draw(model, {80, 24}, 0), first, {80, 24}, {});
  EXPECT_THAT(sent, HasSubstr("HAND Offline"));
  EXPECT_THAT(sent, Not(HasSubstr("TEMPERATURE")));
}

TEST(PaintTest, WithoutColourThereIsNoneAndWithoutUnicodeNoneOfThat) {
  const Picture picture = draw(known(stopped()), {80, 24}, 0);
  EXPECT_THAT(paint(picture, {}, {80, 24}, {}), HasSubstr("\x1b[0;1;31m"));
  const std::string plain = paint(picture, {}, {80, 24}, {.colour = false, .unicode = false});
  for (const char* colour : {";3", "[3", ";4", "[4", ";9", "[9"})
    for (const char digit : std::string{"01234567"})
      EXPECT_THAT(plain, Not(HasSubstr(std::string{colour} + digit + "m")));
  for (const char letter : plain) EXPECT_TRUE(letter == '\x1b' || (letter >= ' ' && letter < 127));
}

TEST(FarewellTest, SaysHowItWasWhatWasGraveAndWhatToAskNext) {
  EXPECT_EQ(farewell(known(supervisor::testing::pair()), "log/pair.db"),
            (std::vector<std::string>{"PAIR flew 0:12:34, in mode coupled at the end. It was well.",
                                      "All of it: hirosco log (log/pair.db)"}));
  ScreenModel model = known(stopped());
  model.take(R"({"at_s":13.5,"told":"HAND high DEVICE_LOST"})");
  const auto lines = farewell(model, "");
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0], "PAIR flew 0:12:34, in mode coupled at the end. It was NOT WELL:");
  EXPECT_EQ(lines[2], "  HAND is Offline, the mode has it Operational: its device is lost");
  EXPECT_EQ(lines[5], "1 event of medium or high severity; 13.500 s: HAND high DEVICE_LOST");
  EXPECT_EQ(lines[6], "What stopped and why: hirosco why. All of it: hirosco log");
  EXPECT_TRUE(farewell(ScreenModel{}, "log").empty());
}

}  // namespace
}  // namespace hirosco::terminal
