// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/cores.hpp"

#include <gtest/gtest.h>

#include "hirosco/descriptor/model/response_time.hpp"
#include "hirosco/descriptor/testing.hpp"

/// Which cores a mission gives whom (docs/adr/0234).
namespace hirosco::descriptor {
namespace {

using namespace testing;

constexpr const char* flywheel_element = R"(executable="hirosco-flywheel")";
constexpr const char* coronagraph_element = R"(executable="hirosco-coronagraph")";
constexpr const char* device_element = R"(device="PLATE" seed="7")";

/// The good mission where these say more.
std::string mission_with(const std::string& of_coronagraph, const std::string& of_flywheel,
                         const std::string& of_device = "") {
  std::string text = changed(coronagraph_element, coronagraph_element + (" " + of_coronagraph));
  text = changed(flywheel_element, flywheel_element + (" " + of_flywheel), text);
  return changed(device_element, device_element + (" " + of_device), text);
}

Reading<Mission> flown(const std::string& mission, std::map<std::string, std::string> more = {}) {
  more["mission.xml"] = mission;
  return read_mission(data / "mission.xml", overlay(std::move(more)));
}

std::string core_problem_of(const Reading<Mission>& reading) {
  if (reading.problems.size() != 1) return rendered(reading.problems, file_system());
  return reading.problems[0].code + " " + reading.problems[0].message;
}

void expect_core_problem_at_mark(const std::string& text, const std::string& code) {
  const Marked file = marked(text);
  const auto reading = flown(file.text);
  ASSERT_EQ(reading.problems.size(), 1U) << file.text << rendered(reading.problems, file_system());
  EXPECT_EQ(reading.problems[0].code, code);
  EXPECT_EQ(reading.problems[0].at, file.at) << rendered(reading.problems, file_system());
}

TEST(Cores, AreWhatTheMissionSaysAndWhoSaysNothingSharesOne) {
  const auto reading =
      flown(mission_with(R"(core="3" core_alone="yes" service_cores="0 1")", R"(core="2")", R"(core="3")"));
  ASSERT_TRUE(reading.value) << core_problem_of(reading);
  const Mission& mission = *reading.value;
  const Cores& own = mission.find_subsystem("CORONAGRAPH")->cores;
  EXPECT_EQ(own.cycle, 3);
  EXPECT_TRUE(own.alone);
  EXPECT_EQ(own.services, (std::vector<std::uint16_t>{0, 1}));
  EXPECT_FALSE(mission.find_subsystem("FLYWHEEL")->cores.alone);
  EXPECT_EQ(mission.devices[0].core, 3) << "what plays its hardware may be there";
  EXPECT_EQ(lone_cores(mission), (std::vector<std::uint16_t>{3}));
  const MissionSubsystem& silent = *mission.find_subsystem("GROUNDSTATION");
  EXPECT_EQ(silent.cores.cycle, std::nullopt);
  EXPECT_EQ(core_of(mission, silent), std::nullopt);
  Mission placed = mission;
  placed.shared_core = 1;
  EXPECT_EQ(core_of(placed, *placed.find_subsystem("GROUNDSTATION")), 1);
  EXPECT_EQ(core_of(placed, *placed.find_subsystem("FLYWHEEL")), 2);
  EXPECT_FALSE(names_cores(*flown(good_mission()).value));
  EXPECT_TRUE(names_cores(*flown(mission_with("", "", R"(core="0")")).value));
}

TEST(Cores, AreNumbersOfTheSystem) {
  expect_core_problem_at_mark(mission_with(R"(core="@1024")", ""), "E0112");
  expect_core_problem_at_mark(mission_with(R"(core="@last")", ""), "E0111");
  expect_core_problem_at_mark(mission_with(R"(core="0" service_cores="@1 1024")", ""), "E0112");
  expect_core_problem_at_mark(mission_with(R"(core="0" service_cores="@1 all")", ""), "E0111");
  expect_core_problem_at_mark(mission_with(R"(core="0" service_cores="@1 1")", ""), "E0113");
  expect_core_problem_at_mark(mission_with(R"(core="0" service_cores="@ ")", ""), "E0109");
}

TEST(Cores, WhoNamesNoneSaysNothingMoreOfThem) {
  expect_core_problem_at_mark(mission_with(R"(core_alone="@yes")", ""), "E0378");
  expect_core_problem_at_mark(mission_with(R"(service_cores="@0 1")", ""), "E0378");
  EXPECT_TRUE(flown(mission_with(R"(core_alone="no")", "")).value);
}

TEST(Cores, OneThatIsSomebodysAloneIsClaimedByNobodyElse) {
  expect_core_problem_at_mark(mission_with(R"(core="3" core_alone="yes")", R"(core="@3")"), "E0379");
  expect_core_problem_at_mark(mission_with(R"(core="@3")", R"(core="3" core_alone="yes")"), "E0379");
  expect_core_problem_at_mark(mission_with(R"(core="3" core_alone="yes")", R"(core="2" service_cores="@0 3")"),
                              "E0379");
  expect_core_problem_at_mark(mission_with("", R"(core="3" core_alone="yes")", R"(core="@3")"), "E0379");
  EXPECT_EQ(core_problem_of(flown(mission_with(R"(core="3" core_alone="yes")", R"(core="3")"))),
            "E0379 FLYWHEEL claims core 3, which is CORONAGRAPH's alone");
  EXPECT_TRUE(flown(mission_with(R"(core="3")", R"(core="3")")).value) << "who says nothing of alone shares it";
  EXPECT_TRUE(flown(mission_with(R"(core="3" core_alone="yes" service_cores="3")", "")).value) << "it is its own";
}

/// Both are due each 500 us.
Reading<Mission> flown_with_budgets(const std::string& mission, const std::string& robot_us,
                                    const std::string& flywheel_us) {
  const auto budget = [](const char* file, const std::string& us) {
    return changed(R"(<Configuration name="COUPLED")", R"(<Configuration name="COUPLED" budget_us=")" + us + "\"",
                   file_system()(data / file).value());
  };
  return flown(mission, {{"coronagraph.xml", budget("coronagraph.xml", robot_us)},
                         {"flywheel.xml", budget("flywheel.xml", flywheel_us)}});
}

TEST(Cores, EachHasItsOwnSumOfBudgets) {
  EXPECT_EQ(core_problem_of(flown_with_budgets(good_mission(), "300", "205")),
            "E0324 the cycles of mode 'telepresence' take 101 % of a processor");
  const auto apart = flown_with_budgets(mission_with(R"(core="1")", ""), "300", "205");
  ASSERT_TRUE(apart.value) << core_problem_of(apart);
  const auto shares = core_shares(*apart.value, *apart.value->find_mode("telepresence"));
  ASSERT_EQ(shares.size(), 2U);
  EXPECT_EQ(shares[0].core, std::nullopt);
  EXPECT_DOUBLE_EQ(shares[0].share, 205.0 / 500);
  EXPECT_EQ(shares[1].core, 1);
  EXPECT_DOUBLE_EQ(shares[1].share, 300.0 / 500);
  EXPECT_DOUBLE_EQ(cycle_share(*apart.value), 300.0 / 500) << "of the one with most to do";
  EXPECT_EQ(core_problem_of(flown_with_budgets(mission_with(R"(core="1")", R"(core="1")"), "300", "205")),
            "E0324 the cycles of mode 'telepresence' take 101 % of core 1");
}

TEST(Cores, ACycleWaitsForNobodyOfAnother) {
  const auto longest_of = [](const std::string& text, std::string_view subsystem) {
    const auto reading = flown_with_budgets(text, "300", "150");
    EXPECT_TRUE(reading.value) << core_problem_of(reading);
    const auto all = cycle_responses(*reading.value, *reading.value->find_mode("telepresence"));
    const auto found = std::ranges::find(all, subsystem, &CycleResponse::subsystem);
    return found != all.end() ? found->longest : std::nullopt;
  };
  EXPECT_EQ(longest_of(mission_with(R"(core="1")", R"(core="0")"), "CORONAGRAPH"), 300us);
  EXPECT_EQ(longest_of(mission_with(R"(core="1")", R"(core="0")"), "FLYWHEEL"), 150us);
  const auto together = std::max(longest_of(mission_with(R"(core="1")", R"(core="1")"), "CORONAGRAPH"),
                                 longest_of(mission_with(R"(core="1")", R"(core="1")"), "FLYWHEEL"));
  EXPECT_EQ(together, 450us) << "the one behind has waited for the other";
}

}  // namespace
}  // namespace hirosco::descriptor
