// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <optional>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// A delay of 5 ms on purpose, in what a cycle takes, before it begins and on the way of a sample: housekeeping, page and event tell it
/// within a cycle (requirement B7). The same in real time: tests/realtime/injected_delay_test.py.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using testing::hand_stale;
using testing::Probe;
using testing::Rig;

constexpr Duration injected = 5ms;
constexpr Duration injected_period = 1ms;
constexpr double injected_us = 5000, within_us = 1000;  ///< a cycle
constexpr std::size_t injected_bin = 13;  ///< of CYCLE_TIMES: from 4096 us to below 8192 us
constexpr std::uint16_t times_structure = 4720;

/// The probe's configuration of 1 ms, which has the times of its cycles in its housekeeping.
std::string descriptor_with_times() {
  std::string text = testing::probe_descriptor;
  const std::string before = "<RealTimeLinkService>";
  return text.insert(
      text.find(before),
      R"(<HKService id="4720" interval="2"><SampledOnce><ParamRef name="CYCLE_STATS"/><ParamRef name="CYCLE_TIMES"/></SampledOnce></HKService>)");
}

struct Lingering final : Probe {
  ManualClock* clock{nullptr};
  Duration lingers{0};
  Result<> work(const Cycle& cycle) noexcept override {
    if (clock != nullptr) clock->advance(lingers);
    return Probe::work(cycle);
  }
};

/// What housekeeping says of cycles.
struct ToldTimes {
  std::uint32_t overruns{};
  double max_us{};
  std::uint32_t executions{}, latencies{};  ///< in the bin of the injected delay
};

struct InjectedDelay : ::testing::Test {
  Lingering author;
  Rig rig{author, descriptor_with_times()};
  TimePoint due{};

  void SetUp() override {
    rig.bring_to(State::PreOperational, 2);
    author.clock = &rig.clock;
    due = rig.clock.now();
  }
  void cycle(Duration lingers = 0us, Duration late = 0us) {
    author.lingers = lingers;
    rig.clock.set(due + late);
    due = rig.subsystem.cycle_step(due);
    rig.service();
  }
  /// The newest structure, after as many cycles as it takes to come.
  ToldTimes told() {
    for (int i = 0; i < 4; ++i) cycle();
    std::optional<ToldTimes> newest;
    for (const auto& report : rig.telemetry) {
      OctetReader reader{report.data};
      if (report.service != 3 || report.subtype != 25 || reader.get<std::uint16_t>() != times_structure) continue;
      newest.emplace();
      newest->overruns = reader.get<std::uint32_t>();
      newest->max_us = std::bit_cast<float>(reader.get<std::uint32_t>());
      static_cast<void>(reader.get<std::uint32_t>());  // the mean
      for (std::uint32_t* const counted : {&newest->executions, &newest->latencies})
        for (std::size_t bin = 0; bin < CycleTimes{}.execution.size(); ++bin) {
          const auto count = reader.get<std::uint32_t>();
          if (bin == injected_bin) *counted = count;
        }
      EXPECT_TRUE(reader.exhausted());
    }
    EXPECT_TRUE(newest.has_value()) << "no housekeeping tells of cycles";
    return newest.value_or(ToldTimes{});
  }
};

TEST_F(InjectedDelay, InTheWorkOfOneCycleIsOneOverrunOfSoLongAndSoManyMissedCyclesAndNoEvent) {
  ASSERT_EQ(told().overruns, 0u);
  cycle(injected);
  const std::uint64_t missed = rig.vital.missed.load();
  const ToldTimes now = told();
  EXPECT_EQ(now.overruns, 1u);
  EXPECT_NEAR(now.max_us, injected_us, within_us);
  EXPECT_EQ(now.executions, 1u);
  EXPECT_EQ(now.latencies, 0u) << "it began in time";
  EXPECT_NEAR(static_cast<double>(missed), static_cast<double>(injected / injected_period), 1.0);
  EXPECT_EQ(rig.vital.missed.load(), missed) << "and none after it";
  EXPECT_THAT(rig.reports(5, 3), ::testing::IsEmpty()) << "one is no three in a row";
}

TEST_F(InjectedDelay, InAsManyCyclesInARowAsTheDescriptorBearsIsOneEventWithTheirNumber) {
  for (int i = 0; i < 2; ++i) cycle(injected);
  EXPECT_EQ(told().overruns, 2u);
  for (int i = 0; i < 3; ++i) cycle(injected);
  EXPECT_EQ(told().overruns, 5u);
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("f00300000003")) << "CYCLE_OVERRUNS IN_A_ROW=3";
  EXPECT_EQ(rig.heard(descriptor::framework_event::cycle_overruns), 1) << "the supervisor hears of it, too";
}

TEST_F(InjectedDelay, BeforeACycleBeginsIsLatencyAndNoOverrun) {
  ASSERT_EQ(told().latencies, 0u);
  const std::uint64_t missed = rig.vital.missed.load();
  cycle(0us, injected);
  EXPECT_NEAR(1e-3 * static_cast<double>(rig.vital.latency_max_ns.load()), injected_us, within_us);
  EXPECT_NEAR(static_cast<double>(rig.vital.missed.load() - missed), static_cast<double>(injected / injected_period),
              1.0);
  const ToldTimes now = told();
  EXPECT_EQ(now.latencies, 1u);
  EXPECT_EQ(now.overruns, 0u);
  EXPECT_EQ(now.executions, 0u);
}

TEST_F(InjectedDelay, OnTheWayOfASampleIsItsLatencyAndWhatStaysOutForSoLongIsAsOld) {
  auto hand =
      rig.attach(1, pus::st128::Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}});
  const IncomingLink& told_of_hand = rig.vital.incoming[0];
  due = rig.clock.now() + injected_period;
  const auto sample = [&](Duration delayed) {
    hand.writer.write(std::array<std::byte, 9>{}, due - delayed, LinkStatus::Valid);
    cycle();
  };
  for (int i = 0; i < 10; ++i) sample(0us);
  EXPECT_LT(told_of_hand.latency_max_ns.load(), static_cast<std::uint32_t>(injected_period.count()));
  sample(injected);
  EXPECT_NEAR(1e-3 * told_of_hand.latency_max_ns.load(), injected_us, within_us);
  EXPECT_NEAR(told_of_hand.age_us.load(), injected_us, within_us);
  EXPECT_NEAR(1e-3 * told_of_hand.jitter_ns.load(), injected_us / 16, within_us / 16) << "RFC 3550: a sixteenth of it";
  sample(0us);
  EXPECT_LT(told_of_hand.age_us.load(), within_us);
  for (int i = 0; i < injected / injected_period; ++i) cycle();
  EXPECT_NEAR(told_of_hand.age_us.load(), injected_us, within_us);
}

TEST_F(InjectedDelay, OfASampleThatAnActingSubsystemNeedsIsAnEventInTheCycleThatMayHaveItNoLonger) {
  auto hand =
      rig.attach(1, pus::st128::Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}});
  due = rig.clock.now() + injected_period;
  const auto sample = [&] {
    hand.writer.write(std::array<std::byte, 9>{}, due, LinkStatus::Valid);
    cycle();
  };
  for (const State state : {State::SafeOperational, State::Operational}) {
    rig.set_state(state);
    for (int i = 0; i < 10; ++i) sample();
  }
  ASSERT_EQ(rig.state(), State::Operational);
  ASSERT_EQ(rig.inhibited(), 0u);
  constexpr int age = 3;  // of the descriptor
  for (int late = 1; late <= injected / injected_period; ++late) {
    cycle();
    EXPECT_EQ(rig.heard(hand_stale), late > age ? 1 : 0) << late << " ms";
  }
}

}  // namespace
}  // namespace hirosco
