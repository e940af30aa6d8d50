// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/replay.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::opening;
using ::testing::SizeIs;

/// Ten minutes of the workshop, of which a page looks at some.
class AReplay : public testing::ArchiveOfAWorkshop {
 protected:
  [[nodiscard]] Replay from(OnboardTime at, double speed = 1.0) {
    return {catalogue, *archive, {opening, opening + 600s}, at, speed, TimePoint{passed}};
  }
  /// What is told when this time has passed.
  std::vector<std::string> pass(Replay& replay, Duration span) {
    passed += span;
    std::vector<std::string> types;
    replay.play(TimePoint{passed}, [&](const nlohmann::json& message) {
      types.push_back(message["type"].get<std::string>());
      messages.push_back(message);
    });
    return types;
  }
  void runs_at(OnboardTime t, double speed) {
    hears(testing::housekeeping(catalogue, testing::drill_apid, 71, {{"DRILL.SPEED", speed}}, t));
  }
  [[nodiscard]] double speed_in(const Replay& replay) const {
    return replay.model().values()[catalogue.find_column("DRILL.SPEED").value()].number;
  }
  void said(OnboardTime t, const std::string& name) {
    archive->add(StoredEvent{.t = t,
                             .apid = testing::drill_apid,
                             .subsystem = "DRILL",
                             .id = 7,
                             .name = name,
                             .severity = 1,
                             .text = "",
                             .values = "{}"});
  }
  Duration passed{1h};
  std::vector<nlohmann::json> messages;
};

TEST_F(AReplay, BeginsWithTheNewestReportsBefore) {
  runs_at(opening, 1);
  hears(testing::overview(catalogue, {.mode = 1}, opening + 1s));
  runs_at(opening + 4s, 2);
  runs_at(opening + 6s, 3);
  hears(testing::overview(catalogue, {.mode = 2}, opening + 7s));
  const Replay replay = from(opening + 5s);
  EXPECT_EQ(speed_in(replay), 2);
  EXPECT_EQ(replay.model().mode(), "dark");
  EXPECT_EQ(replay.at(), opening + 5s);
}

TEST_F(AReplay, IsBroughtWithinTheArchive) {
  EXPECT_EQ(from(opening - 1h).at(), opening);
  EXPECT_EQ(from(opening + 1h).at(), opening + 600s);
}

TEST_F(AReplay, GoesOnAtItsOwnSpeedAndTellsEachEventOnce) {
  said(opening, "before");
  said(opening + 1s, "first");
  said(opening + 2s, "second");
  Replay replay = from(opening, 10);
  EXPECT_THAT(pass(replay, 100ms), ElementsAre("event"));
  EXPECT_EQ(messages.back()["name"], "first");
  EXPECT_EQ(replay.at(), opening + 1s);
  EXPECT_THAT(pass(replay, 50ms), IsEmpty());
  EXPECT_THAT(pass(replay, 50ms), ElementsAre("event"));
  EXPECT_EQ(messages.back()["name"], "second");
}

TEST_F(AReplay, TakesThePacketsThatItPasses) {
  runs_at(opening, 1);
  runs_at(opening + 250ms, 2);
  runs_at(opening + 1s, 3);
  Replay replay = from(opening);
  static_cast<void>(pass(replay, 250ms));
  EXPECT_EQ(speed_in(replay), 2);
}

TEST_F(AReplay, DoesNotCatchUpALongPauseInOneLeap) {
  Replay replay = from(opening);
  static_cast<void>(pass(replay, 30s));
  EXPECT_EQ(replay.at(), opening + 500ms);
}

TEST_F(AReplay, PlaysAtMostAHundredTimesAsFastAndStandsAtZero) {
  EXPECT_EQ(from(opening, 1000).speed(), 100);
  EXPECT_EQ(from(opening, -1).speed(), 0);
  EXPECT_EQ(from(opening, std::numeric_limits<double>::quiet_NaN()).speed(), 1);
  Replay still = from(opening, 0);
  EXPECT_STREQ(still.state(), "paused");
  static_cast<void>(pass(still, 100ms));
  EXPECT_EQ(still.at(), opening);
  EXPECT_STREQ(from(opening).state(), "playing");
}

TEST_F(AReplay, EndsWithTheArchive) {
  said(opening + 600s, "last");
  Replay replay = from(opening + 599s, 10);
  EXPECT_THAT(pass(replay, 200ms), ElementsAre("event"));
  EXPECT_EQ(replay.at(), opening + 600s);
  EXPECT_TRUE(replay.ended());
  EXPECT_STREQ(replay.state(), "ended");
  EXPECT_THAT(pass(replay, 200ms), IsEmpty());
}

TEST_F(AReplay, WaitsWhileItsPageTakesNothing) {
  Replay replay = from(opening);
  passed += 400ms;
  replay.wait(TimePoint{passed});
  static_cast<void>(pass(replay, 100ms));
  EXPECT_EQ(replay.at(), opening + 100ms);
}

TEST_F(AReplay, TellsATelecommandAsItWasThenAndEachReportWhenItCame) {
  const auto number = commanded("BORE", opening + 100ms);
  reported(number, opening + 200ms, "accepted");
  reported(number, opening + 300ms, "failed", 10);
  Replay replay = from(opening);
  EXPECT_THAT(pass(replay, 150ms), ElementsAre("command"));
  EXPECT_EQ(messages[0]["stage"], "sent") << "nobody knew then that it would fail";
  EXPECT_TRUE(messages[0]["code"].is_null());
  EXPECT_TRUE(messages[0]["reason"].is_null());
  EXPECT_THAT(pass(replay, 200ms), ElementsAre("command", "command"));
  EXPECT_EQ(messages[1]["stage"], "accepted");
  EXPECT_EQ(messages[2]["stage"], "failed");
  EXPECT_EQ(messages[2]["code"], 10);
  EXPECT_EQ(messages[2]["function"], "BORE");
  EXPECT_GT(messages[2]["t"], messages[1]["t"]);
}

TEST_F(AReplay, TellsFaultsAndAGapWhenItIsOver) {
  archive->add(StoredFault{opening + 100ms, "spindle", "unplug", "ok"});
  archive->add(StoredGap{opening + 100ms, opening + 300ms});
  Replay replay = from(opening);
  EXPECT_THAT(pass(replay, 200ms), ElementsAre("fault"));
  EXPECT_EQ(messages[0]["line"], "unplug");
  EXPECT_THAT(pass(replay, 200ms), ElementsAre("gap"));
  EXPECT_LT(messages[1]["from"], messages[1]["to"]);
}

TEST_F(AReplay, TakesABurstInSeveralStepsAndLeavesNothingOut) {
  constexpr int burst = 2500;
  for (int i = 1; i <= burst; ++i) said(opening + i * 1ms, std::to_string(i));
  Replay replay = from(opening, 100);
  EXPECT_THAT(pass(replay, 100ms), SizeIs(1000)) << "no page is choked";
  EXPECT_LT(replay.at(), opening + 10s);
  for (int step = 0; step < 3; ++step) static_cast<void>(pass(replay, 100ms));
  ASSERT_THAT(messages, SizeIs(burst));
  for (int i = 1; i <= burst; ++i)
    ASSERT_EQ(messages[static_cast<std::size_t>(i - 1)]["name"], std::to_string(i)) << "in their order, each once";
}

}  // namespace
}  // namespace hirosco::ground
