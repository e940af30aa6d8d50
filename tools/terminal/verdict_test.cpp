// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "supervisor/testing/pair_overview.hpp"

namespace hirosco::terminal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> texts(const Judgement& judged) {
  std::vector<std::string> all;
  for (const Finding& finding : judged.findings) all.push_back(finding.text);
  return all;
}

TEST(VerdictTest, IsWellWhereEverybodyIsWhereTheModeHasHim) {
  const Judgement judged = judge(supervisor::testing::pair());
  EXPECT_EQ(judged.verdict, Verdict::Well);
  EXPECT_EQ(judged.line, "well: mode coupled, 2 subsystems as it has them, 2 links up");
  EXPECT_THAT(judged.findings, IsEmpty());
}

TEST(VerdictTest, IsNotWellWithoutItsKeeperHoweverItDoesAndSaysHowItIsEnded) {
  constexpr const char* gone = "the keeper is gone: if the supervisor dies, nobody goes on";
  constexpr const char* end = "Ctrl-C reaches nobody: it ends by hirosco tc supervisor SHUTDOWN";
  Overview craft = supervisor::testing::pair();
  Judgement judged = judge(craft);
  miss_keeper(judged);
  EXPECT_EQ(judged.verdict, Verdict::NotWell);
  EXPECT_EQ(judged.line, "NOT WELL: the keeper of this flight is gone; all else is well");
  EXPECT_THAT(texts(judged), ElementsAre(gone, end));
  craft.waits_for = "ARM";
  judged = judge(craft);
  miss_keeper(judged);
  EXPECT_EQ(judged.verdict, Verdict::NotWell);
  EXPECT_EQ(judged.line, "NOT WELL: the keeper of this flight is gone; on the way: waits for ARM");
  craft = supervisor::testing::pair();
  craft.members[0].state = "Offline";
  judged = judge(craft);
  const std::string line = judged.line;
  miss_keeper(judged);
  EXPECT_EQ(judged.line, line) << "what is astray comes first";
  EXPECT_THAT(texts(judged), ElementsAre(gone, "ARM is Offline, the mode has it Operational", end));
}

TEST(VerdictTest, IsNotWellInAnyOtherState) {
  for (const auto& row : EnumTexts<descriptor::State>::table) {
    if (row.value == descriptor::State::Operational) continue;
    Overview craft = supervisor::testing::pair();
    craft.members[0].state = row.text;
    const Judgement judged = judge(craft);
    EXPECT_EQ(judged.verdict, Verdict::NotWell) << row.text;
    EXPECT_EQ(judged.line, "NOT WELL: 1 of 2 subsystems not as mode coupled has it");
    EXPECT_THAT(texts(judged), ElementsAre("ARM is " + state_words(row.text) + ", the mode has it Operational"));
  }
}

TEST(VerdictTest, EveryReasonOfAnInhibitionMakesItUnwellAndHasWords) {
  for (unsigned bit = 0; bit < 7; ++bit) {
    Overview craft = supervisor::testing::pair();
    craft.members[1].inhibited = 1U << bit;
    const Judgement judged = judge(craft);
    EXPECT_EQ(judged.verdict, Verdict::NotWell) << bit;
    EXPECT_THAT(texts(judged), ElementsAre("HAND: actuators inhibited: " + inhibition_words(1U << bit)));
    EXPECT_NE(inhibition_words(1U << bit), "");
  }
}

/// Who trips by itself is stopped by the plan for that a moment later: nobody has said SAFE ALL.
TEST(VerdictTest, SaysFirstWhatWasItsOwnAndOfTheSupervisorsStopThatItCameThen) {
  EXPECT_EQ(inhibition_words(1U | 8U), "its own protection tripped, stopped by the supervisor or SAFE ALL");
  EXPECT_EQ(inhibition_words(1U | 2U | 4U),
            "a link that it requires is missing, its device is lost, stopped by the supervisor or SAFE ALL");
  EXPECT_EQ(inhibition_words(1U), "stopped by the supervisor or SAFE ALL");
}

TEST(VerdictTest, SaysTheWordsThatThePageSays) {
  std::string page;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{HIROSCO_SOURCE_DIR "/ground/web/page"}) {
    if (entry.path().extension() != ".js") continue;
    std::ifstream file{entry.path()};
    page.append(std::istreambuf_iterator<char>{file}, {});
  }
  for (unsigned bit = 0; bit < 7; ++bit) EXPECT_THAT(page, HasSubstr("'" + inhibition_words(1U << bit) + "'"));
}

TEST(VerdictTest, WhoDoesNotRunALinkThatIsDownAndWhoStaysInTheInitialModeAreUnwell) {
  Overview craft = supervisor::testing::pair();
  craft.members[0] = {.name = "ARM", .wanted = "Operational"};
  craft.links[1].up = false;
  EXPECT_EQ(judge(craft).line, "NOT WELL: 1 of 2 subsystems not as mode coupled has it, 1 link down");
  EXPECT_THAT(texts(judge(craft)),
              ElementsAre("ARM does not run, the mode has it Operational", "link 2, HAND → ARM, is down"));

  Overview initial = supervisor::testing::pair();
  initial.mode = "commissioning";
  for (auto& member : initial.members) member.wanted.clear();
  for (auto& link : initial.links) link.wanted = link.up = false;
  EXPECT_EQ(judge(initial).line, "NOT WELL: nobody is up in mode commissioning");
  initial.usual_mode.clear();  // a mission that commissions nobody
  EXPECT_EQ(judge(initial).verdict, Verdict::Well);
}

TEST(VerdictTest, TheWayUpStartsFirstWhoDoesNotRun) {
  descriptor::Mission mission;
  descriptor::Mode coupled;
  coupled.name = "coupled";
  coupled.commission.resize(2);
  coupled.commission[0].subsystem = "ARM";
  coupled.commission[1].subsystem = "HAND";
  mission.modes = {coupled};
  Overview craft = supervisor::testing::pair();
  EXPECT_THAT(way_up(craft, mission), ElementsAre("hirosco mode coupled"));
  craft.members[1] = {.name = "HAND", .wanted = "Operational"};
  EXPECT_THAT(way_up(craft, mission), ElementsAre("hirosco tc HAND SET_STATE 0", "hirosco mode coupled"));
  mission.initial_mode = craft.mode = craft.initial_mode = "commissioning";
  EXPECT_THAT(way_up(craft, mission), ElementsAre("hirosco tc HAND SET_STATE 0", "hirosco mode coupled"))
      << "the usual one";
  craft.mode = "safe";
  mission.modes.emplace_back().name = craft.mode;
  EXPECT_THAT(way_up(craft, mission), ElementsAre("hirosco tc HAND SET_STATE 0", "hirosco mode coupled"))
      << "this one commissions nobody";
  craft.usual_mode.clear();
  EXPECT_THAT(way_up(craft, mission), IsEmpty());
}

TEST(VerdictTest, WhatTheModeDoesNotWantIsNoFault) {
  Overview craft = supervisor::testing::pair();
  craft.members.push_back({.name = "LAMP"});
  craft.links.push_back({.id = 3, .from = "ARM", .to = "LAMP"});
  EXPECT_EQ(judge(craft).verdict, Verdict::Well);
}

TEST(VerdictTest, CountsAreSaidAndMakeNobodyUnwell) {
  Overview craft = supervisor::testing::pair();
  craft.members[0].missed = 3;
  craft.members[1].overruns = 2;
  craft.members[1].realtime = false;
  const Judgement judged = judge(craft);
  EXPECT_EQ(judged.verdict, Verdict::Well);
  EXPECT_THAT(texts(judged), ElementsAre("ARM missed 3 of 1000 cycles", "HAND: 2 cycles took longer than they may",
                                         "no real-time scheduling: the reduced limits hold"));
}

TEST(VerdictTest, ProgramsReadTheSameVerdictFindingsAndWayUp) {
  const auto well = verdict_json("PAIR", judge(supervisor::testing::pair()), {});
  EXPECT_EQ(well.dump(),
            R"({"mission":"PAIR","verdict":"well","line":"well: mode coupled, 2 subsystems as it has them, )"
            R"(2 links up","findings":[],"way_up":[]})");
  Overview craft = supervisor::testing::pair();
  craft.members[0].state = "Offline";
  const auto unwell = verdict_json("PAIR", judge(craft), {"hirosco mode coupled"});
  EXPECT_EQ(unwell["verdict"], "not well");
  EXPECT_EQ(unwell["line"], "NOT WELL: 1 of 2 subsystems not as mode coupled has it");
  EXPECT_EQ(unwell["findings"].dump(), R"([{"severity":"high","subject":"ARM","text":"ARM is Offline, the mode has it )"
                                       R"(Operational"}])");
  EXPECT_EQ(unwell["way_up"].dump(), R"(["hirosco mode coupled"])");
}

TEST(VerdictTest, OnTheWayNothingIsAFaultYet) {
  Overview craft = supervisor::testing::pair();
  craft.waits_for = "ARM: self test";
  craft.members[0].state = "SafeOperational";
  const Judgement judged = judge(craft);
  EXPECT_EQ(judged.verdict, Verdict::OnTheWay);
  EXPECT_EQ(judged.line, "on the way: waits for ARM: self test");
  for (const Finding& finding : judged.findings) EXPECT_EQ(finding.severity, Severity::Info);
}

}  // namespace
}  // namespace hirosco::terminal
