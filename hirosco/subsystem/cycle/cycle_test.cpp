// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/cycle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// What a cycle does with a permission that ends, with sets that may be missing, and with rings that are full.
namespace hirosco {
namespace {

using pus::st128::Role;
using testing::hand_stale;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

std::string with(const std::string& from, const std::string& to) {
  std::string text = probe_descriptor;
  return text.replace(text.find(from), from.size(), to);
}

const std::vector<pus::st128::OfferedField> hand_set{{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}};

TEST(CyclePermission, ThatEndsUnderTheSameEpochEndsInTheSameCycle) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  rig.cycle();
  ASSERT_EQ(rig.inhibited(), 0u);
  rig.permit.go.store(0);
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_stop);
  EXPECT_FALSE(probe.last.active);
}

TEST(CyclePermission, IsToldAsTheEpochSeenAndTheCycleOfTheFirstInhibition) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  EXPECT_EQ(rig.vital.inhibited_at_cycle.load(), 0u);
  rig.permit.fence();
  const std::uint64_t before = rig.vital.cycles.load();
  rig.cycle(3);
  EXPECT_EQ(rig.vital.cycles.load(), before + 3);
  EXPECT_EQ(rig.vital.inhibited_at_cycle.load(), before + 1);
  EXPECT_EQ(rig.vital.seen_epoch.load(), rig.permit.epoch.load());
}

TEST(CyclePermission, EndsWithTheStopFlagInEveryStateAndThoughTheWordStillHolds) {
  for (const State state : {State::SafeOperational, State::Operational}) {
    Probe probe;
    Rig rig{probe, probe_descriptor};
    rig.bring_to(state);
    rig.permit.stop.store(1);
    rig.cycle();
    EXPECT_EQ(rig.inhibited(), inhibited_by_stop) << to_text(state);
  }
}

TEST(CycleStates, AreFirstOnceCountOnAndSayWhetherActuatorsMayMove) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::PreOperational);
  EXPECT_FALSE(probe.last.active);
  for (const State state :
       {State::SafeOperational, State::Operational, State::SafeOperational, State::ErrorOperational}) {
    const std::uint64_t before = probe.last.count;
    rig.set_state(state);
    rig.service();
    rig.cycle();
    EXPECT_EQ(probe.last.state, state);
    EXPECT_TRUE(probe.last.first) << to_text(state);
    EXPECT_EQ(probe.last.active, state == State::Operational) << to_text(state);
    EXPECT_EQ(probe.last.count, before + 1);
    EXPECT_EQ(probe.last.planned, rig.clock.now());
    EXPECT_EQ(probe.last.period, 500us);
    rig.cycle();
    EXPECT_FALSE(probe.last.first) << to_text(state);
    rig.service();
  }
}

TEST(CycleInputs, ThatMayBeHeldWhenMissingAreReportedAndInhibitNothing) {
  Probe probe;
  Rig rig{probe, with(R"(missing="inhibit")", R"(missing="hold")")};
  rig.bring_to(State::PreOperational, 2);
  auto hand = rig.attach(1, Role::Consumer, "HAND", hand_set);
  const std::array<std::byte, 9> payload{};
  hand.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
  EXPECT_EQ(rig.set_state_now(State::Operational), "1 3 7");
  rig.cycle(10);
  rig.service();
  EXPECT_EQ(rig.heard(hand_stale), 1);
  EXPECT_FALSE(probe.hand.valid());
  EXPECT_EQ(rig.inhibited(), 0u);
}

/// HAND at 100 Hz in a cycle of 1 ms: a sample may be 30 cycles old.
struct SlowerHand : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  std::optional<Rig::Partner> hand;
  const std::array<std::byte, 9> payload{};
  void SetUp() override {
    rig.bring_to(State::PreOperational, 2);
    hand.emplace(rig.attach(1, Role::Consumer, "HAND", hand_set, nullptr, 10ms));
  }
  void come_under_control() {
    ASSERT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
    ASSERT_EQ(rig.set_state_now(State::Operational), "1 3 7");
  }
};

TEST_F(SlowerHand, HasItsTurnBeforeItIsMissedAndUntilThenNothingActs) {
  come_under_control();
  rig.cycle(5);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_while_awaited);
  EXPECT_EQ(rig.heard(hand_stale), 0);
  hand->writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  rig.cycle(1);
  rig.service();
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(SlowerHand, IsAwaitedTooWhereItsLastSampleIsOfBeforeItWasToBeReliedOn) {
  hand->writer.write(payload, rig.clock.now(), LinkStatus::None);
  rig.cycle(1);
  come_under_control();
  rig.cycle(5);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_while_awaited);
  EXPECT_EQ(rig.heard(hand_stale), 0);
}

TEST_F(SlowerHand, IsMissedWhenItsTurnHasPassed) {
  come_under_control();
  rig.cycle(31);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.heard(hand_stale), 1);
}

TEST_F(SlowerHand, IsMissedAtOnceWhenItWasThereAndSaysThatItFails) {
  hand->writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  rig.cycle(1);
  come_under_control();
  rig.cycle(1);
  hand->writer.write(payload, rig.clock.now(), LinkStatus::Fault);
  rig.cycle(1);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.heard(hand_stale), 1);
}

TEST(CycleInputs, ThatAreNotRequiredInhibitOnlyOnceTheyAreAttached) {
  Probe probe;
  Rig rig{probe, with(R"(<Requires name="HAND")", R"(<Requires name="HAND" required="no")")};
  rig.bring_to(State::Operational, 2);
  rig.cycle(10);
  rig.service();
  EXPECT_EQ(rig.inhibited(), 0u);
  EXPECT_EQ(rig.heard(hand_stale), 0);
  auto hand = rig.attach(1, Role::Consumer, "HAND", hand_set);
  rig.cycle(10);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.heard(hand_stale), 1);
}

TEST(CycleOutputs, OfAFailedNodeAreAFaultInTheSameCycle) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::PreOperational, 2);
  auto arm = rig.attach(2, Role::Producer, "ARM_STATE", {{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}});
  std::array<std::byte, 16> payload{};
  rig.cycle();
  EXPECT_EQ(arm.reader.read(payload).status, LinkStatus::Valid);
  probe.nodes[State::PreOperational].fails = true;
  rig.cycle();
  EXPECT_EQ(probe.last.state, State::PreOperational);
  EXPECT_EQ(arm.reader.read(payload).status, LinkStatus::Fault);
}

TEST(CycleOutputs, OfASetLieOneBehindTheOther) {
  Probe probe;
  Rig rig{probe, with(R"(<ParamRef name="SEEN"/></Provides>)",
                      R"(<ParamRef name="CUR_VALUES.STATE"/><ParamRef name="KP"/><ParamRef name="KD"/></Provides>)")};
  rig.bring_to(State::PreOperational, 2);
  auto arm = rig.attach(
      2, Role::Producer, "ARM_STATE",
      {{"POSITION", Type::Double, 1}, {"STATE", Type::Int32, 1}, {"KP", Type::Double, 1}, {"KD", Type::Double, 1}});
  rig.cycle();
  std::array<std::byte, 28> payload{};
  ASSERT_EQ(arm.reader.read(payload).flow, Flow::New);
  OctetReader values{payload, std::endian::little};
  EXPECT_EQ(values.get<double>(), 0.25 * static_cast<double>(probe.last.count));
  EXPECT_EQ(values.get<std::int32_t>(), static_cast<std::int32_t>(State::PreOperational));
  EXPECT_EQ(values.get<double>(), 30.0);
  EXPECT_EQ(values.get<double>(), 4.0);
}

TEST(CycleInputs, SaySoAtTheFirstCycleThatTheyAreStaleAndAgainOnceTheyHaveComeBack) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::PreOperational, 2);
  auto hand = rig.attach(1, Role::Consumer, "HAND", hand_set);
  const auto sample = [&] {
    hand.writer.write(std::array<std::byte, 9>{}, rig.clock.now(), LinkStatus::Valid);
    rig.cycle();
  };
  sample();
  rig.set_state(State::SafeOperational);
  rig.service();
  for (int times = 1; times <= 2; ++times) {
    sample();
    rig.cycle(3);
    rig.service();
    EXPECT_EQ(rig.heard(hand_stale), times - 1);
    rig.cycle();
    rig.service();
    EXPECT_EQ(rig.heard(hand_stale), times);
  }
}

TEST(CycleInputs, AreToldAllThatAConfigurationCanRequire) {
  struct Many final : Probe {
    std::array<LinkInput<Hand>, 31> sets;  // and HAND: as many as it can have of its own
    Result<Step> software_init() override {
      for (std::size_t i = 0; i < sets.size(); ++i) require_link("SET" + std::to_string(i), sets[i]);
      return Probe::software_init();
    }
  } many;
  std::string required;
  for (std::size_t i = 0; i < many.sets.size(); ++i)
    required += "<Requires name=\"SET" + std::to_string(i) +
                R"("><Field name="ANGLE" type="DOUBLE"/><Field name="ENABLE" type="UINT8"/></Requires>)";
  Rig rig{many, with(R"(<Requires name="HAND")", required + R"(<Requires name="HAND")")};
  rig.bring_to(State::PreOperational, 2);
  for (std::size_t i = 0; i < many.sets.size(); ++i) {
    auto partner = rig.attach(static_cast<std::uint8_t>(i + 1), Role::Consumer, "SET" + std::to_string(i), hand_set);
    partner.writer.write(std::array<std::byte, 9>{}, rig.clock.now(), LinkStatus::Valid);
    rig.cycle();
  }
  for (std::size_t i = 0; i < many.sets.size(); ++i) EXPECT_EQ(rig.vital.incoming[i].link.load(), i + 1);
  EXPECT_TRUE(many.sets.back().valid()) << "it is read all the same";
  EXPECT_EQ(rig.subsystem.cycle().link_statistics().load().received, many.sets.size());
}

TEST(CycleTimes, WithoutRealtimeRightsTheSecondLimitOfOverrunsHolds) {
  struct Slow final : Probe {
    ManualClock* clock{nullptr};
    Result<> work(const Cycle& cycle) noexcept override {
      if (clock != nullptr) clock->advance(2ms);
      return Probe::work(cycle);
    }
  } slow;
  Rig rig{slow, probe_descriptor, false};
  rig.bring_to(State::PreOperational, 2);
  slow.clock = &rig.clock;
  TimePoint planned = rig.clock.now();
  const auto told = [&] {
    rig.clock.set(planned);
    planned = rig.subsystem.cycle_step(planned);
    rig.service();
    return rig.heard(descriptor::framework_event::cycle_overruns);
  };
  for (int i = 1; i < 5; ++i) EXPECT_EQ(told(), 0) << i;
  EXPECT_EQ(told(), 1);
  EXPECT_EQ(told(), 1) << "once for a row";
}

/// Raises so many events in each cycle.
struct Raising final : Probe {
  int events{0};
  bool unknown{false};
  Event<double> nobodys{"NOBODYS"};
  Result<> work(const Cycle& cycle) noexcept override {
    for (int i = 0; i < events; ++i) raise(unknown ? nobodys : own, 1.0);
    return Probe::work(cycle);
  }
};

TEST(CycleEvents, OfMediumSeverityMayUseTheHalfOfTheRingThatRemarksLeaveFree) {
  int heard[2]{};
  for (const bool medium : {false, true}) {
    Raising author;
    Rig rig{author,
            with(R"(id="7" severity="low")", medium ? R"(id="7" severity="medium")" : R"(id="7" severity="low")")};
    rig.bring_to(State::PreOperational);
    author.events = 20'000;
    rig.cycle();
    author.events = 0;
    rig.settle();
    heard[medium ? 1 : 0] = rig.heard(7);
  }
  EXPECT_GT(heard[0], 0);
  EXPECT_GE(heard[1], 2 * heard[0] - 4);
  EXPECT_LE(heard[1], 2 * heard[0] + 4);
}

TEST(CycleEvents, ThatNobodyDeclaredAreNotRaised) {
  Raising author;
  Rig rig{author, probe_descriptor};
  rig.bring_to(State::PreOperational);
  rig.forget_telemetry();
  author.unknown = true;
  author.events = 3;
  rig.cycle();
  rig.service();
  EXPECT_TRUE(rig.raised.empty());
  EXPECT_TRUE(rig.reports(5, 1).empty());
}

TEST(CycleHousekeeping, ThatFindsNoRoomIsCountedAndComesAgainOnceThereIsSome) {
  Probe probe;
  Rig rig{probe, with(R"(interval="500")", R"(interval="5")")};
  rig.bring_to(State::PreOperational);
  rig.forget_telemetry();
  constexpr int cycles = 50'000;
  rig.cycle(cycles);
  EXPECT_GT(rig.vital.lost_reports.load(), 0u);
  for (int i = 0; i < 2'000; ++i) rig.service();
  const auto before = rig.reports(3, 25).size();
  EXPECT_LT(before, cycles / 5u);
  rig.cycle(5);
  rig.service();
  EXPECT_EQ(rig.reports(3, 25).size(), before + 1);
}

}  // namespace
}  // namespace hirosco
