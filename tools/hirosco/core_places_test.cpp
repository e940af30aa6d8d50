// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/core_places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>

namespace hirosco::tools {
namespace {

using namespace std::chrono_literals;

const ProcessorSet four = ProcessorSet::of(std::array<std::uint16_t, 4>{0, 1, 2, 3});

struct CorePlaces : ::testing::Test {
  descriptor::Mission mission;
  descriptor::Mode mode;
  /// Takes so much of 1 ms.
  void commission(const std::string& name, Duration budget, descriptor::Cores cores = {}) {
    descriptor::MissionSubsystem member;
    member.subsystem.name = name;
    member.cores = std::move(cores);
    member.at = {static_cast<int>(mission.subsystems.size()) + 5, 3};
    descriptor::Configuration only;
    only.name = "ONLY";
    only.priority = 50;
    only.sampling = 1ms;
    only.budget = budget;
    member.subsystem.configurations.push_back(std::move(only));
    mission.subsystems.push_back(std::move(member));
    descriptor::CommissionStep step;
    step.subsystem = name;
    step.configuration = "ONLY";
    mode.commission.push_back(std::move(step));
    mode.name = "all";
    mission.modes = {mode};
  }
  [[nodiscard]] std::vector<std::string> problems(const ProcessorSet& here) const {
    std::vector<std::string> texts;
    for (const auto& each : core_problems(mission, here))
      texts.push_back(std::to_string(each.at.line) + " " + each.code + " " + each.message);
    return texts;
  }
};

TEST_F(CorePlaces, AreAllOfThemHereOrAreToldWithTheirPlace) {
  commission("ARM", 300us, {.cycle = 1, .services = {0, 9}});
  commission("HAND", 300us, {.cycle = 7});
  EXPECT_THAT(problems(four),
              ::testing::ElementsAre(
                  "5 E0423 the service loop of ARM is to have core 9, and this computer has none of this number for us",
                  "6 E0423 the cycle of HAND is to have core 7, and this computer has none of this number for us"));
}

TEST_F(CorePlaces, WhoNamesNoneIsReckonedWhereItIsOnThisComputer) {
  commission("ARM", 700us, {.cycle = 3});
  commission("HAND", 500us);
  EXPECT_THAT(problems(four), ::testing::ElementsAre("0 E0423 here the cycles of mode 'all' take 120 % of core 3"));
  const auto fewer = ProcessorSet::of(std::array<std::uint16_t, 3>{0, 2, 3});
  mission.subsystems[0].cores.cycle = 2;
  EXPECT_THAT(problems(fewer), ::testing::IsEmpty());
  mission.subsystems[0].cores = {.cycle = 3, .alone = true};
  EXPECT_THAT(problems(fewer), ::testing::IsEmpty()) << "who names none is at 2, the last that is left";
}

TEST_F(CorePlaces, LeaveOneForTheSupervisor) {
  commission("ARM", 300us, {.cycle = 0, .alone = true});
  EXPECT_THAT(problems(ProcessorSet::of(std::array<std::uint16_t, 1>{0})),
              ::testing::ElementsAre("5 E0423 each core that is here is some subsystem's alone"));
}

TEST_F(CorePlaces, AMissionThatNamesNoneIsNoMatter) {
  commission("ARM", 700us);
  commission("HAND", 700us);
  EXPECT_THAT(problems(four), ::testing::IsEmpty()) << "E0324 has told it";
}

std::string in_words(const std::vector<CoreUse>& uses) {
  std::string text;
  for (const CoreUse& use : uses)
    text += (use.core ? std::to_string(*use.core) : "?") + (use.alone ? "!" : "") + " " +
            std::to_string(static_cast<int>(use.load * 100 + 0.5)) + ", ";
  return text;
}

TEST_F(CorePlaces, OfAFlightAreThoseThatItNamesAndTheLastThatIsNobodysAlone) {
  commission("ARM", 300us, {.cycle = 3, .alone = true});
  commission("HAND", 200us, {.cycle = 0});
  commission("EYE", 100us);
  const FlightCores cores = flight_cores(mission, four);
  EXPECT_EQ(to_string(cores.processors), "0, 1, 2");
  EXPECT_EQ(in_words(cores.uses()), "0 20, 3! 30, 2 10, ");
  mission.devices.emplace_back().core = 1;
  EXPECT_EQ(in_words(flight_cores(mission, four).uses()), "0 20, 3! 30, 1 0, 2 10, ") << "somebody is there";
}

TEST_F(CorePlaces, OfSeveralFlightsAreJudgedCoreByCore) {
  commission("ARM", 600us, {.cycle = 0});
  commission("EYE", 300us);
  const FlightCores first = flight_cores(mission, four);
  const std::vector<OtherCores> others{{"first", first.uses()}};
  EXPECT_EQ(judge_cores({{.core = 1, .load = 1}}, others), "");
  EXPECT_EQ(judge_cores({{.core = 3, .load = 0.7}}, others), "");
  EXPECT_EQ(judge_cores({{.core = 3, .load = 0.8}}, others),
            "the cycles of all flights need 110 % of the processor that they share: this one 80 %, first 30 %");
  EXPECT_EQ(
      judge_cores({{.core = 0, .load = 0.5, .named = true}}, others),
      "the cycles of all flights need 110 % of the processor that they share (core 0): this one 50 %, first 60 %");
  EXPECT_EQ(judge_cores({{.core = 0, .alone = true}}, others),
            "core 0 is to be this flight's alone, and first is there");
}

TEST_F(CorePlaces, WhatIsAnotherFlightsAloneIsForNobodyElse) {
  commission("ARM", 600us, {.cycle = 3, .alone = true});
  const std::vector<OtherCores> others{{"first", flight_cores(mission, four).uses()}};
  descriptor::Mission second;
  FlightCores cores = flight_cores(second, four);
  EXPECT_EQ(judge_cores(cores.uses(), others), "core 3 is first's alone");
  keep_off(cores, others);
  EXPECT_EQ(to_string(cores.processors), "0, 1, 2");
  EXPECT_EQ(judge_cores(cores.uses(), others), "") << "who names none goes elsewhere";
  EXPECT_EQ(judge_cores({{.core = 3, .named = true}}, others), "core 3 is first's alone");
}

}  // namespace
}  // namespace hirosco::tools
