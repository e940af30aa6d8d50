// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/screen_model.hpp"

#include <gtest/gtest.h>

#include "supervisor/testing/pair_overview.hpp"
#include "tools/terminal/lines.hpp"

namespace hirosco::terminal {
namespace {

std::string told(double at_s, const std::string& text) {
  return "{\"at_s\":" + std::to_string(at_s) + ",\"told\":\"" + text + "\"}";
}

TEST(ScreenModelTest, KnowsWhatTheSupervisorSaysOfTheCraft) {
  ScreenModel model;
  Overview craft = supervisor::testing::pair();
  craft.members[1].inhibited = 4;
  craft.members[1].missed = 7;
  craft.links[1].up = false;
  craft.waits_for = "HAND: Operational";
  model.take(supervisor::json_of(craft, 12.5, {{"tip", "(+0.1) m"}}));
  EXPECT_DOUBLE_EQ(model.up_s(), 12.5);
  const Overview& known = model.overview();
  EXPECT_EQ(known.mission, "PAIR");
  EXPECT_EQ(known.mode, "coupled");
  EXPECT_EQ(known.initial_mode, "commissioning");
  EXPECT_EQ(known.usual_mode, "coupled");
  EXPECT_EQ(known.waits_for, "HAND: Operational");
  ASSERT_EQ(known.members.size(), 2U);
  EXPECT_EQ(known.members[0].name, "ARM");
  EXPECT_EQ(known.members[0].period_ns, 500'000U);
  EXPECT_EQ(known.members[0].execution_mean_ns, 20'000U);
  EXPECT_TRUE(known.members[0].runs && known.members[0].cycling && known.members[0].realtime &&
              known.members[0].counted);
  EXPECT_EQ(known.members[1].inhibited, 4U);
  EXPECT_EQ(known.members[1].missed, 7U);
  ASSERT_EQ(known.links.size(), 2U);
  EXPECT_TRUE(known.links[0].up && known.links[0].wanted);
  EXPECT_FALSE(known.links[1].up);
  ASSERT_EQ(model.values().size(), 1U);
  EXPECT_EQ(model.values()[0].second, "(+0.1) m");
}

TEST(ScreenModelTest, TakesEventsWithTheirSeverityUrlsAndErrors) {
  ScreenModel model;
  model.take(told(1.5, "ARM high DEVICE_LOST REASON=silent"));
  model.take(told(1.6, "mode coupled"));
  model.take(R"({"url":"http://127.0.0.1:8080/#token=a","observer_url":"http://127.0.0.1:8080/#token=b"})");
  model.take("hirosco: the supervisor has died; another one goes on");
  ASSERT_EQ(model.events().size(), 3U);
  EXPECT_EQ(model.events()[0].severity, Severity::High);
  EXPECT_EQ(model.events()[0].at_s, 1.5);
  EXPECT_EQ(model.events()[1].severity, Severity::Info);
  EXPECT_EQ(model.events()[2].at_s, std::nullopt);
  EXPECT_EQ(model.errors().size(), 1U);
  EXPECT_EQ(model.grave_events(), 1U);
  EXPECT_EQ(model.gravest()->text, "ARM high DEVICE_LOST REASON=silent");
  EXPECT_EQ(model.url(), "http://127.0.0.1:8080/#token=a");
  EXPECT_EQ(model.observer_url(), "http://127.0.0.1:8080/#token=b");
}

TEST(ScreenModelTest, IsBoundedWhateverIsToldAndKeepsTheNewest) {
  ScreenModel model;
  for (std::size_t i = 0; i < 2 * ScreenModel::most_events; ++i) model.take(told(1, "line " + std::to_string(i)));
  model.take(std::string(100'000, 'x'));
  EXPECT_EQ(model.events().size(), ScreenModel::most_events);
  EXPECT_EQ(model.events().back().text.size(), ScreenModel::longest_text);
  EXPECT_EQ(model.events()[ScreenModel::most_events - 2].text,
            "line " + std::to_string(2 * ScreenModel::most_events - 1));
  for (int i = 0; i < 100; ++i) model.take("an error");
  EXPECT_EQ(model.errors().size(), ScreenModel::most_errors);
}

TEST(ScreenModelTest, WhatIsGarbledOrOfAnotherFormChangesNothingAndSteersNothing) {
  ScreenModel model;
  model.take(supervisor::json_of(supervisor::testing::pair(), 1, {}));
  for (const char* line : {"{", "{\"told\":", "{\"members\":[{\"na", "", "{}"}) model.take(line);
  EXPECT_EQ(model.events().size(), 0U);
  EXPECT_EQ(model.overview().members.size(), 2U);
  for (const char* line :
       {R"({"members":7,"links":"x","values":{}})", R"({"members":[1,null,"a"],"links":[[]],"values":[1,[2]]})",
        R"({"members":[{"name":7,"runs":"yes","inhibited":"a"}],"up_s":"x"})", R"({"told":7,"at_s":"x"})",
        R"({"url":null})"})
    model.take(line);
  model.take("\x1b[2J");
  EXPECT_EQ(model.events().back().text, "?[2J");
}

TEST(ScreenModelTest, AFlightIsEndedByTwoKeysAndByNoOther) {
  ScreenModel model;
  EXPECT_EQ(model.press(Key::End, 5), Wish::None);
  EXPECT_TRUE(model.asks_for_end());
  EXPECT_EQ(model.press(Key::Stop, 5), Wish::None) << "any other key takes it back, and does nothing else";
  EXPECT_FALSE(model.asks_for_end());
  EXPECT_EQ(model.press(Key::End, 5), Wish::None);
  EXPECT_EQ(model.press(Key::End, 5), Wish::EndFlight);
  EXPECT_TRUE(model.ending());
  EXPECT_EQ(model.press(Key::End, 5), Wish::None);
  EXPECT_FALSE(model.asks_for_end());
}

TEST(ScreenModelTest, StopsActuatorsByOneKey) {
  ScreenModel model;
  EXPECT_EQ(model.press(Key::Stop, 5), Wish::StopActuators);
}

TEST(ScreenModelTest, WhoHasScrolledStaysWhereHeLooks) {
  ScreenModel model;
  for (int i = 0; i < 30; ++i) model.take(told(i, "line"));
  model.press(Key::PageUp, 10);
  EXPECT_EQ(model.scrolled(), 10U);
  model.take(told(31, "line"));
  EXPECT_EQ(model.scrolled(), 11U);
  for (int i = 0; i < 10; ++i) model.press(Key::PageUp, 10);
  EXPECT_EQ(model.scrolled(), 21U) << "the oldest is the last";
  model.press(Key::Newest, 10);
  EXPECT_EQ(model.scrolled(), 0U);
  model.press(Key::Down, 10);
  EXPECT_EQ(model.scrolled(), 0U);
}

TEST(ScreenModelTest, ReadsKeysOneByOneAndPassesOverThoseThatAreNotItsOwn) {
  std::string_view octets{"q\x1b[A\x1b[6~\x1b[15~eS\x0c\x1b[1;5Dx\x1b"};
  std::vector<Key> keys;
  while (!octets.empty()) keys.push_back(take_key(octets));
  EXPECT_EQ(keys, (std::vector<Key>{Key::End, Key::Up, Key::PageDown, Key::Other, Key::Filter, Key::Stop, Key::Redraw,
                                    Key::Other, Key::Other, Key::Other}));
}

TEST(ScreenModelTest, HowItWasIsWhatItWasBeforeTheEndBegan) {
  ScreenModel model;
  model.take(supervisor::json_of(supervisor::testing::pair(), 5, {}));
  model.take(told(5.5, "shutdown, asked for by SIGINT (signal 2)"));
  Overview down = supervisor::testing::pair();
  for (auto& member : down.members) member.state = "Offline";
  model.take(supervisor::json_of(down, 6, {}));
  EXPECT_TRUE(model.ending());
  EXPECT_EQ(model.overview().members[0].state, "Offline");
  EXPECT_EQ(model.at_work().members[0].state, "Operational");
}

TEST(LinesTest, GivesLinesAsTheyAreWholeAndLeavesOutWhatIsTooLong) {
  Lines lines{8};
  std::vector<std::string> whole;
  const auto take = [&](std::string_view octets) {
    lines.take(octets, [&](std::string_view line) { whole.emplace_back(line); });
  };
  for (const char* octets :
       {"o", "ne\ntw", "o\n\n", "much too long", " really\nthree", "\n", "12345678\n", "123456789\n4\n5"})
    take(octets);
  EXPECT_EQ(whole, (std::vector<std::string>{"one", "two", "", "three", "12345678", "4"}));
}

}  // namespace
}  // namespace hirosco::terminal
