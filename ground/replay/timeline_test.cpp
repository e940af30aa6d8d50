// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "ground/replay/timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ground/testing/workshop.hpp"

namespace hirosco::ground {
namespace {

using ::testing::ElementsAre;
using testing::opening;

class ATimeline : public testing::ArchiveOfAWorkshop {
 protected:
  [[nodiscard]] static std::vector<std::string> of(const nlohmann::json& list, const char* what) {
    std::vector<std::string> all;
    for (const auto& one : list) all.push_back(one[what].get<std::string>());
    return all;
  }
  void said(OnboardTime t, const std::string& name, int severity = 1) {
    archive->add(StoredEvent{.t = t,
                             .apid = testing::drill_apid,
                             .subsystem = "DRILL",
                             .id = 7,
                             .name = name,
                             .severity = severity,
                             .text = "",
                             .values = "{}"});
  }
  const Span span{opening, opening + 10s};
};

TEST_F(ATimeline, BeginsWithWhatHeldThen) {
  archive->add(StoredChange{opening - 60s, "mode", "", "dark"});
  archive->add(StoredChange{opening + 5s, "mode", "", "work"});
  archive->add(StoredChange{opening - 30s, "state", "DRILL", "Operational"});
  archive->add(StoredChange{opening + 6s, "state", "DRILL", ""});
  archive->add(StoredChange{opening - 20s, "link", "1", "up"});
  archive->add(StoredChange{opening + 7s, "link", "1", "down"});
  archive->add(StoredChange{opening + 11s, "mode", "", "dark"});
  const auto told = timeline_json(*archive, span);
  EXPECT_EQ(told["modes"],
            (nlohmann::json{{{"t", 2'145'916'900}, {"mode", "dark"}}, {{"t", 2'145'916'905}, {"mode", "work"}}}));
  EXPECT_EQ(told["states"], (nlohmann::json{{{"t", 2'145'916'900}, {"subsystem", "DRILL"}, {"state", "Operational"}},
                                            {{"t", 2'145'916'906}, {"subsystem", "DRILL"}, {"state", nullptr}}}))
      << "who does not run has no state";
  EXPECT_EQ(told["links"], (nlohmann::json{{{"t", 2'145'916'900}, {"id", 1}, {"up", true}},
                                           {{"t", 2'145'916'907}, {"id", 1}, {"up", false}}}));
}

TEST_F(ATimeline, TellsWhatHappenedWithinIt) {
  for (const Duration after : {-1s, 0s, 10s, 11s}) {
    said(opening + after, "at " + std::to_string(after / 1s));
    static_cast<void>(commanded("AT " + std::to_string(after / 1s), opening + after));
    archive->add(StoredFault{opening + after, "spindle", "at " + std::to_string(after / 1s), "ok"});
  }
  archive->add(StoredGap{opening - 5s, opening + 1s});
  archive->add(StoredGap{opening - 5s, opening - 1s});
  const auto told = timeline_json(*archive, span);
  EXPECT_THAT(of(told["events"], "name"), ElementsAre("at 0", "at 10"));
  EXPECT_THAT(of(told["commands"], "function"), ElementsAre("AT 0", "AT 10"));
  EXPECT_THAT(of(told["faults"], "line"), ElementsAre("at 0", "at 10"));
  EXPECT_EQ(told["faults"][0]["device"], "spindle");
  EXPECT_EQ(told["faults"][0]["answer"], "ok");
  EXPECT_EQ(told["gaps"], (nlohmann::json::array({{{"from", 2'145'916'895}, {"to", 2'145'916'901}}})))
      << "one that reaches into the span is of it";
}

TEST_F(ATimeline, OfTooManyHasTheNewestOldestFirst) {
  for (std::size_t i = 0; i < most_rows + 2; ++i) said(opening, std::to_string(i));
  const auto events = timeline_json(*archive, span)["events"];
  ASSERT_EQ(events.size(), most_rows);
  EXPECT_EQ(events.front()["name"], "2");
  EXPECT_EQ(events.back()["name"], std::to_string(most_rows + 1));
}

TEST_F(ATimeline, EventsAloneAreListedNewestFirstAsFarAsTheyAreWanted) {
  said(opening, "A", 3);
  said(opening + 1s, "B", 2);
  said(opening + 2s, "C", 4);
  EXPECT_THAT(of(events_json(*archive, {.span = {}, .text = {}})["events"], "name"), ElementsAre("C", "B", "A"));
  EXPECT_THAT(of(events_json(*archive, {.span = {}, .severity = 3, .text = {}})["events"], "name"),
              ElementsAre("C", "A"));
  EXPECT_THAT(of(events_json(*archive, {.span = {}, .text = "drill b"})["events"], "name"), ElementsAre("B"));
  EXPECT_THAT(of(events_json(*archive, {.span = {}, .text = {}, .limit = 1})["events"], "name"), ElementsAre("C"));
}

TEST_F(ATimeline, TelecommandsAloneHaveTheirReports) {
  const auto bore = commanded("BORE", opening);
  static_cast<void>(commanded("WIPE", opening + 1s));
  reported(bore, opening + 2s, "accepted");
  reported(bore, opening + 3s, "failed", 10);
  const auto told = commands_json(*archive, {.span = {}, .text = {}})["commands"];
  EXPECT_THAT(of(told, "function"), ElementsAre("WIPE", "BORE"));
  EXPECT_EQ(told[0]["reports"], nlohmann::json::array());
  EXPECT_EQ(told[1]["stage"], "failed");
  EXPECT_EQ(told[1]["reports"],
            (nlohmann::json{{{"t", 2'145'916'902}, {"stage", "accepted"}, {"code", nullptr}, {"reason", nullptr}},
                            {{"t", 2'145'916'903}, {"stage", "failed"}, {"code", 10}, {"reason", "because"}}}));
}

}  // namespace
}  // namespace hirosco::ground
