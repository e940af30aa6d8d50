// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/craft_books.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace hirosco::tools {
namespace {

using ::testing::ElementsAre;

/// "power_W 60 60 40" of each row: declared, the most, now; "-" where nothing is.
std::vector<std::string> book_lines(const std::vector<ResourceRow>& rows) {
  std::vector<std::string> all;
  for (const ResourceRow& row : rows) {
    const auto text = [](const std::optional<std::uint64_t>& number) { return number ? std::to_string(*number) : "-"; };
    all.push_back(row.attribute + " " + text(row.declared) + " " + std::to_string(row.high) + " " + text(row.now));
  }
  return all;
}

/// A craft of ARM, which draws 7.5 W in its first configuration and 60 W in its second, and LAMP, of which no power is accounted.
struct CraftBooksTest : ::testing::Test {
  static constexpr double safe = 4, offline = 0, not_running = 255;
  descriptor::Mission mission = [] {
    descriptor::Mission made;
    made.supervisor.id = 1;
    for (const auto& [name, id] : {std::pair{"ARM", 10}, std::pair{"LAMP", 11}}) {
      auto& subsystem = made.subsystems.emplace_back().subsystem;
      subsystem.name = name;
      subsystem.id = static_cast<std::uint16_t>(id);
    }
    for (const auto& [id, watts] : {std::pair{1, 7.5}, std::pair{2, 60.0}}) {
      auto& configuration = made.subsystems[0].subsystem.configurations.emplace_back();
      configuration.id = static_cast<std::uint8_t>(id);
      configuration.power_w = watts;
    }
    return made;
  }();
  CraftBooks books{mission};
  OnboardTime at = OnboardTime{} + std::chrono::hours{1};

  void tell(double state_of_arm, double configuration_of_arm, OnboardTime when) {
    books.hear(std::vector<pus::HousekeepingValue>{{"MODE", "", {3}},
                                                   {"SUBSYSTEMS.APID", "", {1, 10, 11, 0}},
                                                   {"SUBSYSTEMS.STATE", "", {5, state_of_arm, offline, 0}},
                                                   {"SUBSYSTEMS.CONFIGURATION", "", {1, configuration_of_arm, 0, 0}}},
               when);
  }
  [[nodiscard]] std::vector<std::string> of(std::size_t place) const {
    return book_lines(books.rows(mission.subsystems[place].subsystem));
  }
};

TEST_F(CraftBooksTest, KnowNothingBeforeTheSupervisorHasToldIt) {
  EXPECT_FALSE(books.runs(10));
  EXPECT_THAT(of(0), ElementsAre("processes 1 0 -", "power_W 60 0 -"));
  EXPECT_THAT(book_lines(books.rows(mission.supervisor)), ElementsAre("processes 1 0 -"));
}

TEST_F(CraftBooksTest, TellOfEachWhetherItsProcessRunsAndThePowerThatIsPromisedToItsConfigurationInUse) {
  tell(safe, 2, at);
  EXPECT_TRUE(books.runs(10));
  EXPECT_TRUE(books.runs(1));
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "power_W 60 60 60"));
  EXPECT_THAT(of(1), ElementsAre("processes 1 1 1")) << "of whom no power is accounted";
  tell(safe, 1, at + 1s);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "power_W 60 60 8")) << "rounded up";
  tell(offline, 1, at + 2s);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "power_W 60 60 0"));
  tell(not_running, 0, at + 3s);
  EXPECT_FALSE(books.runs(10));
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 0", "power_W 60 60 0"));
}

TEST_F(CraftBooksTest, AreAsTheyWereToldLastWhateverWasHeardLast) {
  tell(safe, 1, at);
  tell(safe, 2, at - 1s);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "power_W 60 60 8"));
}

TEST_F(CraftBooksTest,
       TellWhatIsPromisedOfTheOneProcessorOfAllCyclesAndHowManyProcessesThereAreOfThoseThatTheMissionHas) {
  auto& arm = mission.subsystems[0].subsystem;
  arm.configurations[0].sampling = 1ms;
  arm.configurations[0].budget = 100us;
  arm.configurations[1].sampling = 1ms;
  arm.configurations[1].budget = 253us;
  mission.subsystems[1].subsystem.service_loops.push_back(
      {.name = "QUICK", .period = 10ms, .priority = 10, .budget = 1ms});
  mission.budget[static_cast<std::size_t>(descriptor::Resource::Processes)] = 2;
  tell(safe, 2, at);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "cycles_percent 26 26 26", "power_W 60 60 60"));
  EXPECT_THAT(of(1), ElementsAre("processes 1 1 1", "cycles_percent 10 10 10")) << "its loop goes in any state";
  const auto of_all = [&] { return book_lines(books.rows(mission.supervisor)); };
  EXPECT_THAT(of_all(), ElementsAre("processes 1 1 1", "processes of all 2 2 2", "cycles_percent 100 36 36"));
  tell(safe, 1, at + 1s);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "cycles_percent 26 26 10", "power_W 60 60 8"));
  tell(not_running, 0, at + 2s);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 0", "cycles_percent 26 26 0", "power_W 60 60 0"));
  EXPECT_THAT(of_all(), ElementsAre("processes 1 1 1", "processes of all 2 2 1", "cycles_percent 100 36 10"));
}

TEST_F(CraftBooksTest, TellOfEachCoreThatTheMissionNamesWhatIsPromisedOfIt) {
  auto& arm = mission.subsystems[0];
  arm.subsystem.configurations[1].sampling = 1ms;
  arm.subsystem.configurations[1].budget = 253us;
  arm.cores.cycle = 3;
  mission.subsystems[1].subsystem.service_loops.push_back(
      {.name = "QUICK", .period = 10ms, .priority = 10, .budget = 1ms});
  tell(safe, 2, at);
  EXPECT_THAT(of(0), ElementsAre("processes 1 1 1", "cycles_percent of core 3 26 26 26", "power_W 60 60 60"));
  EXPECT_THAT(of(1), ElementsAre("processes 1 1 1", "cycles_percent 10 10 10"));
  EXPECT_THAT(book_lines(books.rows(mission.supervisor)),
              ElementsAre("processes 1 1 1", "cycles_percent 100 10 10", "cycles_percent of core 3 100 26 26"));
}

TEST_F(CraftBooksTest, OfTheSupervisorAreThePowerOfTheCraft) {
  tell(safe, 2, at);
  const auto power = [&](double budget, double reserved, OnboardTime when) {
    books.hear(
        std::vector<pus::HousekeepingValue>{{"POWER.BUDGET", "W", {budget}}, {"POWER.RESERVED", "W", {reserved}}},
        when);
    return book_lines(books.rows(mission.supervisor));
  };
  EXPECT_THAT(power(120, 85.2, at), ElementsAre("processes 1 1 1", "power_W 120 86 86"));
  EXPECT_THAT(power(90, 60, at + 1s), ElementsAre("processes 1 1 1", "power_W 90 86 60"));
  EXPECT_THAT(power(0, 60, at + 2s), ElementsAre("processes 1 1 1", "power_W - 86 60")) << "0: it is not limited";
}

}  // namespace
}  // namespace hirosco::tools
