// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/ground/why.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace hirosco::ground {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

nlohmann::json story() {
  return {{"t", 2'173'999'550.7},
          {"title", "HAND lost its device: silent. ARM and HAND were stopped."},
          {"detail", "ARM and HAND went Offline within 3.1 ms, by plan network-down."},
          {"advice", "Mend or plug in the device HAND, then bring coupled up."},
          {"plan", "network-down"},
          {"mode", "coupled"},
          {"mode_up", "coupled"},
          {"severity", "high"},
          {"stopped", {"ARM", "HAND"}},
          {"causes",
           {{{"t", 1.0}, {"after_ms", nullptr}, {"severity", "info"}, {"text", "Fault injected: hand unplug"}},
            {{"t", 1.0}, {"after_ms", 0.0}, {"severity", "high"}, {"text", "HAND lost its device: silent"}},
            {{"t", 1.0}, {"after_ms", 3.14}, {"severity", "info"}, {"text", "ARM and HAND → Offline"}},
            {{"t", 1.0}, {"after_ms", 12'300.0}, {"severity", "medium"}, {"text", "a | b"}}}}};
}

// `date -u -d @1795528313.7`: 2026-11-24 13:51:53; TAI since 1958 is 378691200 + 37 s more.
TEST(WhyTest, TellsTheDateInUtc) {
  EXPECT_EQ(utc_text(1'795'528'313.7 + 378'691'200 + 37), "2026-11-24 13:51:53.700 UTC");
  EXPECT_EQ(utc_text(378'691'200 + 37), "1970-01-01 00:00:00.000 UTC");
}

TEST(WhyTest, TellsWhenWhatAndWhatToDoInLines) {
  EXPECT_EQ(why_text(story(), "PAIR", "log/pair-ground.db", WhyStyle::Lines, {}),
            "PAIR, 2026-11-22 00:45:13.700 UTC, mode coupled\n"
            "HAND lost its device: silent. ARM and HAND were stopped.\n"
            "ARM and HAND went Offline within 3.1 ms, by plan network-down.\n"
            "\n"
            "      before  info    Fault injected: hand unplug\n"
            "     +0.0 ms  high    HAND lost its device: silent\n"
            "     +3.1 ms  info    ARM and HAND → Offline\n"
            "     +12.3 s  medium  a | b\n"
            "\n"
            "What to do now: Mend or plug in the device HAND, then bring coupled up.\n"
            "  hirosco mode coupled              brings it up again (--preview: says what is against it)\n"
            "  hirosco log --last 60             is the story in the log\n");
}

TEST(WhyTest, SaysBeforeTheModeWhoHasToBeStartedAgain) {
  auto dead = story();
  dead["down"] = {"HAND"};
  EXPECT_THAT(why_text(dead, "PAIR", "a", WhyStyle::Lines, {}),
              HasSubstr("  hirosco tc HAND SET_STATE 0       starts its process again, before the next\n"
                        "  hirosco mode coupled              brings it up again"));
}

TEST(WhyTest, ProposesTheModeThatBringsItUpAndNoneWhereNoneDoes) {
  auto told = story();
  told["mode"] = "commissioning";
  EXPECT_THAT(why_text(told, "PAIR", "a", WhyStyle::Lines, {}), HasSubstr("  hirosco mode coupled  "));
  told["mode_up"] = nullptr;
  EXPECT_THAT(why_text(told, "PAIR", "a", WhyStyle::Lines, {}), Not(HasSubstr("hirosco mode")));
}

/// The flight of the story began five minutes before it; flights come newest first, a later one is not its own.
TEST(WhyTest, SaysFirstOfWhichFlightItIsAndThatTheMissionHasFlownSince) {
  const double began_s = 2'173'999'250.7, since_s = 2'173'999'670.7;
  const nlohmann::json flights{{"flights", {{{"from", 2'173'999'600.0}}, {{"from", began_s}}, {{"from", 5.0}}}}};
  ASSERT_EQ(flight_of(flights, story()), began_s);
  EXPECT_EQ(flight_of(flights, {{"causes", nlohmann::json::array()}}), std::nullopt);
  EXPECT_EQ(flight_of(nullptr, story()), std::nullopt);
  const std::string flight = "flight of PAIR that began 2026-11-22 00:40:13.700 UTC\n";
  const std::string when = "PAIR, 2026-11-22 00:45:13.700 UTC, mode coupled\n";
  EXPECT_THAT(why_text(story(), "PAIR", "a", WhyStyle::Lines, {.story_s = began_s}), StartsWith(flight + when));
  const WhichFlight older{.story_s = began_s, .since_s = since_s};
  const std::string since =
      "PAIR has flown since, from 2026-11-22 00:47:13.700 UTC on, and no ground station kept that flight: its story is "
      "`hirosco log --last 60`. What follows is of before.\n\n";
  EXPECT_THAT(why_text(story(), "PAIR", "a", WhyStyle::Lines, older),
              AllOf(StartsWith(since + flight + when), Not(HasSubstr("is the story in the log"))));
  EXPECT_THAT(why_text(story(), "PAIR", "a", WhyStyle::Markdown, older),
              AllOf(HasSubstr("# Why PAIR stopped\n\n" + since),
                    HasSubstr("| flight | began 2026-11-22 00:40:13.700 UTC |\n")));
  for (const auto style : {WhyStyle::Lines, WhyStyle::Markdown})
    EXPECT_THAT(why_text(nullptr, "PAIR", "a", style, older), HasSubstr(since)) << "nothing stopped before either";
}

TEST(WhyTest, IsAReportWithPlanAndTables) {
  const std::string text = why_text(story(), "PAIR", "log/pair-ground.db", WhyStyle::Markdown, {});
  EXPECT_THAT(text, HasSubstr("# Why PAIR stopped\n\n**HAND lost its device: silent. ARM and HAND were stopped.**"));
  EXPECT_THAT(text, HasSubstr("| when | 2026-11-22 00:45:13.700 UTC |\n"));
  EXPECT_THAT(text, HasSubstr("| plan | network-down |\n| stopped | ARM, HAND |\n"));
  EXPECT_THAT(text, HasSubstr("| +0.0 ms | high | HAND lost its device: silent |\n"));
  EXPECT_THAT(text, HasSubstr("| a \\| b |\n"));
  EXPECT_THAT(text, HasSubstr("**What to do now:** Mend or plug in"));
}

TEST(WhyTest, ColoursWhatIsGraveOnly) {
  const std::string text = why_text(story(), "PAIR", "a", WhyStyle::Coloured, {});
  EXPECT_THAT(text, HasSubstr("\x1b[1;31mhigh  \x1b[0m"));
  EXPECT_THAT(why_text(story(), "PAIR", "a", WhyStyle::Lines, {}), Not(HasSubstr("\x1b")));
  EXPECT_THAT(why_text(story(), "PAIR", "a", WhyStyle::Markdown, {}), Not(HasSubstr("\x1b")));
}

TEST(WhyTest, SaysSoWhereNothingHasStoppedAndTakesNoHarmFromAnyOtherForm) {
  for (const auto style : {WhyStyle::Lines, WhyStyle::Markdown}) {
    EXPECT_THAT(why_text({{"causes", nlohmann::json::array()}}, "PAIR", "a.db", style, {}), HasSubstr("a.db tells"));
    EXPECT_THAT(why_text(nullptr, "PAIR", "a.db", style, {}), HasSubstr("a.db tells"));
  }
  auto hostile = story();
  hostile["title"] = "\x1b[2J";
  hostile["causes"][0] = {{"text", 7}, {"after_ms", "x"}};
  hostile["stopped"] = 7;
  EXPECT_THAT(why_text(hostile, "PAIR", "a.db", WhyStyle::Lines, {}), Not(HasSubstr("\x1b")));
  EXPECT_THAT(why_text(hostile, "PAIR", "a.db", WhyStyle::Markdown, {}), Not(HasSubstr("\x1b")));
}

}  // namespace
}  // namespace hirosco::ground
