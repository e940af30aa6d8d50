// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// Cycles that take too long or begin too late, and how their times are told (decision 7, docs/adr/0007).
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

struct Slow final : Probe {
  ManualClock* clock{nullptr};
  Duration takes{0};
  Result<> work(const Cycle& cycle) noexcept override {
    if (clock != nullptr) clock->advance(takes);
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

}  // namespace
}  // namespace hirosco
