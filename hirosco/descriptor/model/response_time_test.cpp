// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/response_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

namespace hirosco::descriptor {
namespace {

struct Declared {
  std::string name;
  int priority;
  Duration sampling;
  Duration budget;
  Duration spin{};
};

struct CycleResponses : ::testing::Test {
  void commission(const Declared& declared) {
    MissionSubsystem member;
    member.subsystem.name = declared.name;
    Configuration only;
    only.name = "ONLY";
    only.priority = declared.priority;
    only.sampling = declared.sampling;
    only.budget = declared.budget;
    only.spin = declared.spin;
    member.subsystem.configurations.push_back(std::move(only));
    mission.subsystems.push_back(std::move(member));
    CommissionStep step;
    step.subsystem = declared.name;
    step.configuration = "ONLY";
    mode.commission.push_back(std::move(step));
  }
  std::map<std::string, std::optional<Duration>> longest() const {
    std::map<std::string, std::optional<Duration>> all;
    for (const CycleResponse& cycle : cycle_responses(mission, mode)) all[std::string{cycle.subsystem}] = cycle.longest;
    return all;
  }
  Mission mission;
  Mode mode;
};

TEST_F(CycleResponses, OfOneAloneIsItsBudget) {
  commission({"A", 80, 500us, 120us});
  EXPECT_EQ(longest()["A"], 120us);
}

TEST_F(CycleResponses, CountLoopsOfServicesOfWhoIsNotCommissionedToo) {
  commission({"A", 30, 1ms, 400us});
  MissionSubsystem other;
  other.subsystem.name = "OTHER";
  other.subsystem.service_loops.push_back({.name = "ABOVE", .period = 2ms, .priority = 50, .budget = 300us});
  other.subsystem.service_loops.push_back({.name = "BELOW", .period = 1ms, .priority = 10, .budget = 400us});
  mission.subsystems.push_back(std::move(other));
  const auto all = cycle_responses(mission, mode);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].name(), "ABOVE");
  EXPECT_EQ(all[0].longest, 300us);
  EXPECT_EQ(all[1].name(), "ONLY");
  EXPECT_EQ(all[1].longest, 700us);
  EXPECT_EQ(all[2].name(), "BELOW");
  EXPECT_EQ(all[2].longest, std::nullopt) << "300 + 400 + 400 us are more than its period";
  EXPECT_DOUBLE_EQ(cycle_share(mission, mode), 0.4 + 0.15 + 0.4);
}

/// What a configuration says of a loop of services is reckoned where it is in force (docs/adr/0207).
TEST_F(CycleResponses, CountLoopsOfServicesAsTheConfigurationOfTheModeSaysThem) {
  commission({"A", 30, 1ms, 400us});
  commission({"B", 20, 4ms, 0us});
  SubsystemDescriptor& quick = mission.subsystems[1].subsystem;
  quick.service_loops.push_back({.name = "ABOVE", .period = 10ms, .priority = 50, .budget = 300us});
  quick.configurations[0].paces.push_back({.name = "ABOVE", .period = 2ms, .priority = 10, .budget = 200us});
  const auto all = cycle_responses(mission, mode);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].name(), "ONLY");
  EXPECT_EQ(all[0].longest, 400us) << "the loop goes behind it";
  EXPECT_EQ(all[2].name(), "ABOVE");
  EXPECT_EQ(all[2].period(), 2ms);
  EXPECT_EQ(all[2].longest, 600us);
  EXPECT_DOUBLE_EQ(cycle_share(mission, mode), 0.4 + 0.1);
  mode.commission.pop_back();
  EXPECT_EQ(cycle_responses(mission, mode)[0].name(), "ABOVE") << "of who is not commissioned as it says itself";
  EXPECT_DOUBLE_EQ(cycle_share(mission, mode), 0.4 + 0.03);
}

TEST_F(CycleResponses, AroundAModeAreThoseBesideLoopsOfWhoIsNotConfiguredYetOrAnyMore) {
  commission({"A", 30, 1ms, 400us});
  commission({"B", 20, 4ms, 0us});
  SubsystemDescriptor& calms = mission.subsystems[1].subsystem;
  calms.service_loops.push_back({.name = "LOOP", .period = 2ms, .priority = 50, .budget = 600us});
  EXPECT_EQ(cycle_responses_around(mission, mode).size(), 3U) << "no configuration says anything of it";
  calms.configurations[0].paces.push_back({.name = "LOOP", .period = 10ms, .priority = 10, .budget = 900us});
  const auto around = cycle_responses_around(mission, mode);
  ASSERT_EQ(around.size(), 4U) << "the loop twice";
  EXPECT_EQ(around[0].longest, 600us) << "not beside itself";
  EXPECT_EQ(around[1].subsystem, "A");
  EXPECT_EQ(around[1].longest, 1ms);
  EXPECT_EQ(around[3].longest, 1700us) << "its own 900 us and twice 400";
  EXPECT_EQ(cycle_responses(mission, mode)[0].longest, 400us) << "in the mode the loop goes behind";
  calms.service_loops[0].budget = 601us;
  EXPECT_EQ(cycle_responses_around(mission, mode)[1].longest, std::nullopt);
}

TEST_F(CycleResponses, AroundAModeCountEachLoopOnceAsItTakesMost) {
  commission({"A", 30, 1ms, 400us});
  commission({"B", 20, 4ms, 0us});
  SubsystemDescriptor& other = mission.subsystems[1].subsystem;
  other.service_loops.push_back({.name = "LOOP", .period = 2ms, .priority = 50, .budget = 300us});
  other.configurations[0].paces.push_back({.name = "LOOP", .period = 1ms, .priority = 40, .budget = 200us});
  const auto around = cycle_responses_around(mission, mode);
  ASSERT_EQ(around.size(), 4U);
  EXPECT_EQ(around[2].subsystem, "A");
  EXPECT_EQ(around[2].longest, 700us) << "300 or 200 us before it, not both";
}

/// It has no cycle before its configuration is in force and behind it: neither waits for the other.
TEST_F(CycleResponses, AroundAModeAreNotThoseOfACycleBesideItsOwnLoopsAsTheyGoWithoutIt) {
  commission({"A", 30, 1ms, 600us});
  SubsystemDescriptor& own = mission.subsystems[0].subsystem;
  own.service_loops.push_back({.name = "LOOP", .period = 2ms, .priority = 50, .budget = 500us});
  own.configurations[0].paces.push_back({.name = "LOOP", .period = 2ms, .priority = 10, .budget = 300us});
  const auto around = cycle_responses_around(mission, mode);
  ASSERT_EQ(around.size(), 3U);
  EXPECT_EQ(around[0].longest, 500us);
  EXPECT_EQ(around[1].longest, 600us) << "1,100 us are more than its period";
  EXPECT_EQ(around[2].longest, 900us);
  own.configurations[0].paces[0].priority = 40;
  EXPECT_EQ(cycle_responses_around(mission, mode)[2].longest, 900us) << "but beside them as they go with it";
}

TEST_F(CycleResponses, OfTheClassicalExampleAreThoseOfTheBooks) {
  // Burns and Wellings, Real-Time Systems and Programming Languages: periods 7, 12, 20, times 3, 3, 5: 3, 6, 20.
  commission({"C", 1, 20us, 5us});
  commission({"A", 3, 7us, 3us});
  commission({"B", 2, 12us, 3us});
  EXPECT_EQ(longest()["A"], 3us);
  EXPECT_EQ(longest()["B"], 6us);
  EXPECT_EQ(longest()["C"], 20us);
}

TEST_F(CycleResponses, OfWhoCannotEndInTimeAreNone) {
  // The same book's set that does not fit: periods 80, 40, 20, times 40, 10, 5, the longest period first: it has to wait for nobody.
  commission({"C", 1, 20us, 5us});
  commission({"B", 2, 40us, 10us});
  commission({"A", 3, 80us, 40us});
  EXPECT_EQ(longest()["A"], 40us);
  EXPECT_EQ(longest()["B"], std::nullopt) << "50 us of 40";
  EXPECT_EQ(longest()["C"], std::nullopt);
}

TEST_F(CycleResponses, OfEqualPriorityWaitForEachOtherOnce) {
  commission({"A", 80, 500us, 100us});
  commission({"B", 80, 250us, 50us});
  EXPECT_EQ(longest()["A"], 150us);
  EXPECT_EQ(longest()["B"], 150us);
}

TEST_F(CycleResponses, WithoutAPriorityGoAfterAllThatHaveOneAndKeepNoTurn) {
  commission({"A", 0, 1000us, 400us});
  commission({"B", 0, 300us, 50us});
  commission({"C", 1, 500us, 100us});
  EXPECT_EQ(longest()["C"], 100us);
  EXPECT_EQ(longest()["B"], std::nullopt) << "400 and 100 us go before";
  EXPECT_EQ(longest()["A"], 750us) << "its own 400, three times 50, and twice 100";
}

TEST_F(CycleResponses, OfWhoDeclaresNoBudgetAreWhatGoesBefore) {
  commission({"A", 80, 500us, 100us});
  commission({"B", 70, 500us, 0us});
  EXPECT_EQ(longest()["A"], 100us);
  EXPECT_EQ(longest()["B"], 100us);
}

TEST_F(CycleResponses, StandInTheOrderOfTheirPriority) {
  commission({"LOW", 10, 500us, 1us});
  commission({"HIGH", 80, 500us, 1us});
  EXPECT_EQ(cycle_responses(mission, mode).front().subsystem, "HIGH");
}

TEST_F(CycleResponses, OfAPreciseOneCountFromWhenItIsDueAndItsSpinIsLoadOfTheOthers) {
  commission({"A", 80, 500us, 100us, 60us});
  commission({"B", 70, 1000us, 200us});
  EXPECT_EQ(longest()["A"], 100us) << "spun away before";
  EXPECT_EQ(longest()["B"], 360us);
  EXPECT_DOUBLE_EQ(cycle_share(mission, mode), 0.32 + 0.2);
}

TEST_F(CycleResponses, OfAPreciseOneThatOthersKeepFromSpinningAreNoLonger) {
  commission({"A", 80, 500us, 100us});
  commission({"B", 70, 1000us, 200us, 60us});
  EXPECT_EQ(longest()["B"], 300us);
}

TEST_F(CycleResponses, FindNoRoomForASpinThatLeavesTheOthersTooLittle) {
  commission({"A", 80, 500us, 100us, 300us});
  commission({"B", 70, 500us, 100us});
  EXPECT_EQ(longest()["B"], 500us);
  mission.subsystems[0].subsystem.configurations[0].spin = 301us;
  EXPECT_EQ(longest()["B"], std::nullopt);
}

/// From the instant at which all are due, microsecond by microsecond; more than its period: not in time.
Duration played(const std::vector<Declared>& all, std::size_t of) {
  std::vector<Duration> left(all.size());
  for (std::int64_t now = 0; now < all[of].sampling / 1us; ++now) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (now % (all[i].sampling / 1us) == 0) left[i] += all[i].budget;
    std::size_t runs = all.size();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (left[i] > Duration{} && (runs == all.size() || all[i].priority > all[runs].priority)) runs = i;
    if (runs == all.size()) continue;
    left[runs] -= 1us;
    if (runs == of && left[of] == Duration{}) return (now + 1) * 1us;
  }
  return all[of].sampling + 1us;
}

TEST_F(CycleResponses, AreWhatASchedulerDoesThatIsPlayedFromTheWorstInstant) {
  std::mt19937 random{20261123};
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<>{low, high}(random); };
  int fit = 0, unfit = 0;
  for (int round = 0; round < 300; ++round) {
    mission = {};
    mode = {};
    std::vector<Declared> all;
    for (int i = 0; i < 4; ++i) {
      const Duration sampling = pick(10, 60) * 1us;
      all.push_back({std::string(1, static_cast<char>('A' + i)), 10 * (i + 1), sampling, pick(1, 12) * 1us});
      commission(all.back());
    }
    const auto told = longest();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Duration took = played(all, i);
      const auto& bound = told.at(all[i].name);
      if (bound) EXPECT_EQ(*bound, took) << round << ' ' << all[i].name;
      else EXPECT_GT(took, all[i].sampling) << round << ' ' << all[i].name;
      ++(bound ? fit : unfit);
    }
  }
  EXPECT_GT(fit, 100);
  EXPECT_GT(unfit, 50);
}

}  // namespace
}  // namespace hirosco::descriptor
