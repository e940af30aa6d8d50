// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// Cycles that take too long or begin too late, and how their times are told (decision 7, docs/adr/0007).
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

struct Slow final : Probe {
  ManualClock* clock{nullptr};
  Duration takes{0};  ///< by the clock
  Duration uses{0};   ///< of the processor
  Result<> work(const Cycle& cycle) noexcept override {
    if (clock != nullptr) clock->advance(takes), clock->use_processor(uses);
    return Probe::work(cycle);
  }
};

/// Cycles of 1 ms that begin and take as the test says.
struct CycleTime : ::testing::Test {
  Slow slow;
  Rig rig{slow, probe_descriptor};
  TimePoint planned{};

  void SetUp() override {
    rig.bring_to(State::PreOperational, 2);
    slow.clock = &rig.clock;
    planned = rig.clock.now();
  }
  void cycle(Duration takes, Duration late = 0us) {
    slow.takes = takes;
    rig.clock.set(planned + late);
    planned = rig.subsystem.cycle_step(planned);
  }
};

TEST_F(CycleTime, ThreeOverrunsInARowAreReportedOnceAndMissedCyclesAreSkipped) {
  for (int i = 0; i < 6; ++i) {
    const TimePoint before = planned;
    cycle(2500us);
    EXPECT_EQ(planned - before, 3ms);  // on the grid and in the future
  }
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("f00300000003"));
  EXPECT_EQ(rig.vital.overruns.load(), 6u);
  EXPECT_EQ(rig.vital.execution_max_ns.load(), 2'500'000u);
}

TEST_F(CycleTime, MoreProcessorThanTheBudgetIsToldAfterThreeCyclesInARow) {
  cycle(0us);
  slow.uses = 251us;
  for (int i = 0; i < 5; ++i) cycle(900us);
  slow.uses = 250us;
  cycle(999us);
  rig.service();
  const CycleBudget told = rig.subsystem.cycle().budget().load();
  EXPECT_EQ(told.budget_us, 250.0F);
  EXPECT_EQ(told.longest_us, 251.0F) << "of its own; what others take meanwhile is not in it";
  EXPECT_EQ(told.exceeded, 5U);
  EXPECT_THAT(rig.reports(5, 2), ElementsAre("f00600000003437b0000"));
}

TEST_F(CycleTime, LateStartsOfAStarvingMachineNeitherLengthenTheRowNorBreakIt) {
  cycle(2500us);
  cycle(2500us);
  for (int i = 0; i < 10; ++i) cycle(2500us, 1001us);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ::testing::IsEmpty());
  cycle(2500us, 1000us);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("f00300000003"));
  EXPECT_EQ(rig.vital.overruns.load(), 13u);
}

TEST_F(CycleTime, LatencyIsTheDelayBehindThePlannedTime) {
  cycle(0us, 40us);
  EXPECT_EQ(rig.vital.latency_max_ns.load(), 40'000u);
  EXPECT_EQ(rig.vital.overruns.load(), 0u);
}

TEST_F(CycleTime, FallsIntoBinsOfPowersOfTwo) {
  const CycleTimes before = rig.subsystem.cycle().times().load();
  for (const auto& [takes, late] : {std::pair{999ns, 0ns}, {1us, 40us}, {63us, 64us}, {10s, 1us}}) cycle(takes, late);
  CycleTimes times = rig.subsystem.cycle().times().load();
  for (std::size_t i = 0; i < times.execution.size(); ++i) times.execution[i] -= before.execution[i];
  for (std::size_t i = 0; i < times.latency.size(); ++i) times.latency[i] -= before.latency[i];
  EXPECT_THAT(times.execution, ElementsAre(1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1));
  EXPECT_THAT(times.latency, ElementsAre(1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST_F(CycleTime, CyclesThatCameDueBeforeTheLastHadEndedAreCountedAsMissed) {
  cycle(1ms);
  EXPECT_EQ(rig.vital.missed.load(), 0u) << "it ends just as the next is due";
  cycle(1ms + 1ns);
  EXPECT_EQ(rig.vital.missed.load(), 1u);
  EXPECT_EQ(rig.vital.overruns.load(), 1u);
  cycle(4500us);
  EXPECT_EQ(rig.vital.missed.load(), 5u);
}

TEST_F(CycleTime, ACycleThatEndsInTimeBreaksTheRowAndOneOfExactlyItsPeriodEndsInTime) {
  for (const Duration takes : {1001us, 1001us, 1000us, 1001us, 1001us}) cycle(takes);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ::testing::IsEmpty());
  cycle(1001us);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("f00300000003"));
}

TEST_F(CycleTime, TheMeanFollowsByAThousandthOfTheDifferenceAndIsToldBesideTheLongest) {
  const auto mean = [&] { return rig.vital.execution_mean_ns.load(); };
  ASSERT_EQ(mean(), 0u);
  cycle(1s);
  EXPECT_EQ(mean(), 1'000'000u);
  cycle(2s);
  EXPECT_EQ(mean(), 2'999'000u);
  cycle(0us);
  EXPECT_EQ(mean(), 2'996'001u);
  const CycleStatistics told = rig.subsystem.cycle().statistics().load();
  EXPECT_EQ(told.overruns, 2u);
  EXPECT_FLOAT_EQ(told.max_us, 2e6F);
  EXPECT_FLOAT_EQ(told.avg_us, 2996.001F);
}

TEST_F(CycleTime, OfAnEarlierConfigurationIsForgottenInTheNext) {
  slow.inhibits = true;
  for (int i = 0; i < 2; ++i) cycle(2500us, 40us);
  slow.inhibits = false;
  slow.takes = 0us;
  rig.set_state_now(State::PostOperational);
  rig.set_state_now(State::PreOperational);
  const auto configured = rig.configure(2);
  rig.service();
  ASSERT_EQ(rig.outcome(configured), "1 3 7");
  const CycleStatistics statistics = rig.subsystem.cycle().statistics().load();
  EXPECT_EQ(statistics.overruns, 0u);
  EXPECT_EQ(statistics.max_us, 0.0F);
  EXPECT_EQ(statistics.avg_us, 0.0F);
  const CycleTimes times = rig.subsystem.cycle().times().load();
  EXPECT_THAT(times.execution, ::testing::Each(0));
  EXPECT_THAT(times.latency, ::testing::Each(0));
  planned = rig.clock.now();
  cycle(2500us);
  EXPECT_EQ(slow.last.count, 0u);
  EXPECT_TRUE(slow.last.first);
  EXPECT_EQ(rig.inhibited(), 0u);
  EXPECT_EQ(rig.vital.overruns.load(), 1u);
  EXPECT_EQ(rig.vital.latency_max_ns.load(), 0u);
  EXPECT_EQ(rig.vital.execution_max_ns.load(), 2'500'000u);
  EXPECT_EQ(rig.vital.execution_mean_ns.load(), 2'500u);
  EXPECT_EQ(rig.subsystem.cycle().times().load().execution[12], 1u);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ::testing::IsEmpty()) << "two and one are no three in a row";
}

TEST_F(CycleTime, WhatACycleHasSpunBeforeItBeganIsNoneOfItsWork) {
  cycle(0us);
  slow.takes = 0us;
  slow.uses = 100us;
  const Duration before = rig.clock.processor();
  rig.clock.use_processor(180us);
  rig.clock.set(planned);
  planned = rig.subsystem.cycle_step(planned, before);
  EXPECT_EQ(rig.subsystem.cycle().budget().load().longest_us, 100.0F);
  EXPECT_EQ(rig.subsystem.cycle().budget().load().exceeded, 0U) << "both together are more than its 250 us";
}

}  // namespace
}  // namespace hirosco
