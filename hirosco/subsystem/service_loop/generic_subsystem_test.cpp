// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// States, commands, configurations, functions, parameters and housekeeping of the generic subsystem.
namespace hirosco {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;
using ::testing::StartsWith;

struct GenericSubsystemTest : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
};

// --- figure 4 ----------------------------------------------------------------------------------------------------------

constexpr std::array steady{State::Offline,     State::PreOperational,   State::SafeOperational,
                            State::Operational, State::ErrorOperational, State::PostOperational};

/// Written by hand from figure 4: which steady states a command leads to, in the order of `steady`.
constexpr std::array<std::string_view, 6> legal_from{".P....", "O.S.ET", "OP.XET", "..S.E.", "OP...T", "OP...."};

TEST(StateCommands, EveryLegalOneArrivesAndEveryOtherIsRefusedWithTheStateAsData) {
  for (std::size_t from = 0; from < steady.size(); ++from)
    for (std::uint8_t to = 0; to < 10; ++to) {
      Probe probe;
      Rig rig{probe, probe_descriptor};
      rig.bring_to(steady[from]);
      const State target{to};
      const auto column = std::ranges::find(steady, target);
      const bool legal =
          column != steady.end() && legal_from[from][static_cast<std::size_t>(column - steady.begin())] != '.';
      const std::string refused = "1 4:000a0" + std::to_string(static_cast<int>(steady[from]));
      EXPECT_EQ(rig.set_state_now(target), legal ? "1 3 7" : refused)
          << to_text(steady[from]) << " commanded to " << to_text(target);
      EXPECT_EQ(rig.state(), legal ? target : steady[from]);
      EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(rig.state()));
    }
}

TEST_F(GenericSubsystemTest, EveryStateOnTheWayIsReported) {
  rig.set_state_now(State::PreOperational);
  rig.set_state_now(State::Offline);
  EXPECT_THAT(rig.reports(5, 1), ElementsAre("f00001", "f00002", "f00003", "f00007", "f00008", "f00009", "f00000"));
}

TEST_F(GenericSubsystemTest, WithoutAConfigurationNeitherSafeNorErrorOperationalIsEntered) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 4:000a03");
  EXPECT_EQ(rig.set_state_now(State::ErrorOperational), "1 4:000a03");
}

TEST_F(GenericSubsystemTest, OneTransitionAtATime) {
  probe.nodes[State::HardwareInit].again = 3;
  const auto first = rig.set_state(State::PreOperational);
  rig.service();
  EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(State::HardwareInit));
  const auto second = rig.set_state(State::Offline);
  rig.service();
  EXPECT_EQ(rig.outcome(second), "1 4:0108");
  rig.settle();
  EXPECT_EQ(rig.outcome(first), "1 3 7");
}

TEST_F(GenericSubsystemTest, AFailingSoftwareInitGoesDownThroughSoftwareDeinit) {
  probe.nodes[State::SoftwareInit].fails = true;
  EXPECT_THAT(rig.set_state_now(State::PreOperational), StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(probe.nodes[State::HardwareDeinit].calls, 0);
  EXPECT_EQ(probe.nodes[State::SoftwareDeinit].calls, 1);
  EXPECT_THAT(rig.reports(5, 4), ElementsAre("f00101050000000000000000706c616e746564" + std::string(2 * 57, '0')));
}

TEST_F(GenericSubsystemTest, AFailingHardwareInitGoesDownThroughHardwareDeinit) {
  probe.nodes[State::HardwareInit].fails = true;
  EXPECT_THAT(rig.set_state_now(State::PreOperational), StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(probe.nodes[State::HardwareDeinit].calls, 1);
  EXPECT_EQ(probe.nodes[State::SoftwareDeinit].calls, 1);
}

TEST_F(GenericSubsystemTest, AfterAFailedInitTheNextTryMaySucceed) {
  probe.nodes[State::HardwareInit].fails = true;
  rig.set_state_now(State::PreOperational);
  probe.nodes[State::HardwareInit].fails = false;
  EXPECT_EQ(rig.set_state_now(State::PreOperational), "1 3 7");
}

TEST_F(GenericSubsystemTest, AFailingDeinitDoesNotStopTheWayDown) {
  rig.bring_to(State::PreOperational);
  for (const State state : {State::PostOperational, State::HardwareDeinit, State::SoftwareDeinit})
    probe.nodes[state].fails = true;
  EXPECT_THAT(rig.set_state_now(State::Offline), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
}

TEST_F(GenericSubsystemTest, ATransientStateThatNeverEndsFailsAfterTenSeconds) {
  probe.nodes[State::HardwareInit].again = 1'000'000;
  const auto request = rig.set_state(State::PreOperational);
  rig.service();
  rig.advance(10s);
  rig.service();
  EXPECT_EQ(rig.outcome(request), "1 3");
  rig.advance(1ms);
  rig.settle();
  EXPECT_THAT(rig.outcome(request), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.state(), State::Offline);
}

TEST(NodeFailures, InEveryCyclicStateLeadToErrorOperational) {
  for (const State state : {State::PreOperational, State::SafeOperational, State::Operational}) {
    Probe probe;
    Rig rig{probe, probe_descriptor};
    rig.bring_to(state);
    probe.nodes[state].fails = true;
    rig.settle();
    EXPECT_EQ(rig.state(), State::ErrorOperational) << to_text(state);
    EXPECT_EQ(rig.events(descriptor::framework_event::state_failed), 1);
    EXPECT_NE(rig.inhibited() & inhibited_by_failure, 0u);
  }
}

TEST_F(GenericSubsystemTest, AFailureInErrorOperationalChangesNothing) {
  rig.bring_to(State::ErrorOperational);
  probe.nodes[State::ErrorOperational].fails = true;
  rig.settle();
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.events(descriptor::framework_event::state_failed), 0);
}

// It must not turn the way down into one to an Error-Operational without a cycle.
TEST_F(GenericSubsystemTest, ANodeThatFailsWhileTheCycleComesToRestIsReportedOnTheWayDown) {
  rig.bring_to(State::SafeOperational);
  const auto request = rig.set_state(State::Offline);
  rig.service();
  probe.nodes[State::SafeOperational].fails = true;
  static_cast<void>(rig.subsystem.cycle_step(rig.clock.now() + 500us));
  rig.settle();
  EXPECT_EQ(rig.state(), State::Offline);
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  EXPECT_EQ(rig.events(descriptor::framework_event::state_failed), 1);
}

// --- configurations ----------------------------------------------------------------------------------------------------

TEST_F(GenericSubsystemTest, AConfigurationIsChosenInPreOperationalOnly) {
  EXPECT_EQ(rig.configure_now(1), "1 4:000a00");
  rig.bring_to(State::SafeOperational);
  EXPECT_EQ(rig.configure_now(1), "1 4:000a04");
}

TEST_F(GenericSubsystemTest, AnUnknownConfigurationIsRefusedByItsId) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.configure_now(9), "1 4:01010000000009");
}

TEST_F(GenericSubsystemTest, TheSameConfigurationAgainIsFineAnotherIsNot) {
  rig.bring_to(State::PreOperational);
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
  EXPECT_EQ(rig.configure_now(2), "1 4:01030000000002");
  rig.set_state_now(State::PostOperational);
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(rig.configure_now(2), "1 3 7");
  EXPECT_EQ(rig.vital.configuration.load(), 2u);
}

TEST_F(GenericSubsystemTest, PeriodAndPriorityFollowTheConfiguration) {
  rig.bring_to(State::PreOperational, 1);
  EXPECT_TRUE(rig.subsystem.cycle_demand().wanted);
  EXPECT_EQ(rig.subsystem.cycle_demand().period, 500us);
  EXPECT_EQ(rig.subsystem.cycle_demand().priority, 80);
  EXPECT_EQ(rig.vital.period_ns.load(), 500'000u);
  rig.set_state_now(State::PostOperational);
  EXPECT_FALSE(rig.subsystem.cycle_demand().wanted);
  rig.set_state_now(State::PreOperational);
  rig.configure_now(2);
  EXPECT_EQ(rig.subsystem.cycle_demand().period, 1ms);
  EXPECT_EQ(rig.subsystem.cycle_demand().priority, 70);
}

TEST_F(GenericSubsystemTest, InitialValuesOfAConfigurationStandOverThoseOfTheDescriptor) {
  rig.set_state_now(State::PreOperational);
  EXPECT_EQ(probe.kp.load(), 3.0);
  rig.configure_now(2);
  EXPECT_EQ(probe.kp.load(), 30.0);
  EXPECT_EQ(probe.kd.load(), 4.0);
}

TEST_F(GenericSubsystemTest, AFailingConfigureLeavesPreOperationalWithoutConfiguration) {
  rig.set_state_now(State::PreOperational);
  probe.configure_fails = true;
  EXPECT_THAT(rig.configure_now(1), ::testing::StartsWith("1 3 8:0202"));
  EXPECT_EQ(rig.events(descriptor::framework_event::configuration_failed), 1);
  EXPECT_EQ(rig.state(), State::PreOperational);
  EXPECT_FALSE(rig.subsystem.cycle_demand().wanted);
  probe.configure_fails = false;
  EXPECT_EQ(rig.configure_now(1), "1 3 7");
}

// The thread may never have seen that a cycle was wanted: what it is asked for is a newer ticket.
TEST_F(GenericSubsystemTest, ACycleThatWasNeverSeenIsStillAskedToRest) {
  rig.set_state_now(State::PreOperational);
  const auto before = rig.subsystem.cycle_demand().ticket;
  const auto configured = rig.configure(1);
  const auto down = rig.set_state(State::PostOperational);
  rig.service();
  EXPECT_FALSE(rig.subsystem.cycle_demand().wanted);
  EXPECT_NE(rig.subsystem.cycle_demand().ticket, before);
  EXPECT_EQ(rig.outcome(configured), "1 3 7");
  EXPECT_EQ(rig.outcome(down), "1 3");
  EXPECT_EQ(rig.vital.cycling.load(), 1U) << "who does not rest is watched on";
  rig.settle();
  EXPECT_EQ(rig.vital.cycling.load(), 0U);
  EXPECT_EQ(rig.outcome(down), "1 3 7");
}

// --- functions ---------------------------------------------------------------------------------------------------------

TEST_F(GenericSubsystemTest, AFunctionIsDoneAtTheNextCycle) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("SET_GOAL", {0.5});
  rig.service();
  EXPECT_EQ(rig.outcome(request), "1");
  EXPECT_EQ(probe.goal.load(), 0.0);
  rig.cycle();
  EXPECT_EQ(probe.goal.load(), 0.5);
  rig.service();
  EXPECT_EQ(rig.outcome(request), "1 3 7");
}

TEST_F(GenericSubsystemTest, AHandlersRefusalIsAStartFailureWithItsCode) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("SET_GOAL", {1.75});
  rig.settle();
  EXPECT_TRUE(rig.outcome(request).starts_with("1 4:0105"));
}

TEST_F(GenericSubsystemTest, AFunctionOutsideItsStatesIsRefused) {
  rig.bring_to(State::PreOperational);
  const auto request = rig.call("SET_GOAL", {0.5});
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 4:000a03");
}

TEST_F(GenericSubsystemTest, ARunningFunctionReportsProgressAndCompletionLater) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("MOVE");
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3");
  const auto second = rig.call("MOVE");
  probe.step_due = 1;
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001");
  EXPECT_EQ(rig.outcome(second), "1 4:0108");
  probe.finish_due = true;
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3 5:0001 7");
}

TEST_F(GenericSubsystemTest, ReportsGoToTheSourceOfTheRequest) {
  rig.bring_to(State::Operational);
  rig.forget_telemetry();
  rig.call("SET_GOAL", {0.5});
  rig.settle();
  ASSERT_EQ(rig.telemetry.size(), 3u);
  for (const auto& report : rig.telemetry) EXPECT_EQ(report.destination, Rig::source);
}

TEST_F(GenericSubsystemTest, AFunctionThatItsAuthorForgetsIsAbortedWhenTheCycleEnds) {
  rig.bring_to(State::Operational);
  const auto request = rig.call("MOVE");
  rig.settle();
  rig.set_state_now(State::ErrorOperational);
  EXPECT_EQ(rig.outcome(request), "1 3");
  rig.set_state_now(State::PostOperational);
  EXPECT_EQ(rig.outcome(request), "1 3 8:0204");
}

TEST_F(GenericSubsystemTest, AFunctionThatNeverReachedTheCycleStillEnds) {
  rig.bring_to(State::SafeOperational);
  const auto function = rig.call("SET_GOAL", {0.5});
  rig.set_state(State::PostOperational);
  rig.settle();
  EXPECT_EQ(rig.outcome(function), "1 4:0204");
  EXPECT_EQ(probe.goal.load(), 0.0);
}

TEST_F(GenericSubsystemTest, AFullQueueRefusesAndLosesNothing) {
  rig.bring_to(State::Operational);
  std::vector<testing::Sent> requests;
  for (int i = 0; i < 70; ++i) requests.push_back(rig.call("SET_GOAL", {0.5}));
  rig.service();
  rig.service();
  rig.settle();
  int refused = 0;
  for (const auto request : requests) {
    const std::string text = rig.outcome(request);
    if (text == "1 4:000b") ++refused;
    else EXPECT_EQ(text, "1 3 7");
  }
  EXPECT_EQ(refused, 6);
}

TEST_F(GenericSubsystemTest, AnotherModeEpochIsRefused) {
  rig.permit.mode_epoch = 4;
  const auto old = rig.send(17, 1, {}, {}, 3);
  const auto present = rig.send(17, 1, {}, {}, 4);
  const auto unbound = rig.send(17, 1, {});
  rig.settle();
  EXPECT_EQ(rig.outcome(old), "2:000d");
  EXPECT_EQ(rig.outcome(present), "1 3 7");
  EXPECT_EQ(rig.outcome(unbound), "1 3 7");
}

TEST_F(GenericSubsystemTest, UnknownServicesAreRefusedAndHousekeepingWaitsForItsConfiguration) {
  const auto unknown = rig.send(99, 1, {});
  const auto early = rig.send(3, 5, {});
  rig.settle();
  EXPECT_EQ(rig.outcome(unknown), "2:000663");
  EXPECT_EQ(rig.outcome(early), "2:000a00");
}

// --- parameters --------------------------------------------------------------------------------------------------------

/// TC[20,3] for KP and KD.
std::vector<std::byte> gains(double kp, double kd) {
  std::vector<std::byte> data(64);
  OctetWriter writer{data};
  const auto id = [](std::uint8_t number) { return ParameterId{10, Type::Double, number}.wire(); };
  writer.put(std::uint8_t{2}).put(id(2)).put(kp).put(id(3)).put(kd);
  data.resize(writer.size());
  return data;
}

TEST_F(GenericSubsystemTest, AllWritesOfARequestTakeEffectAtOneCycleBoundary) {
  rig.bring_to(State::Operational);
  probe.record_gains = true;
  const auto request = rig.send(20, 3, gains(11, 12));
  rig.cycle();
  rig.service();
  EXPECT_EQ(probe.kp.load(), 3.0);
  rig.cycle();
  EXPECT_THAT(probe.gains_seen, ElementsAre(std::pair{3.0, 4.0}, std::pair{11.0, 12.0}));
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3 7");
}

TEST_F(GenericSubsystemTest, NoCycleSeesHalfAGroupHoweverRequestsAndCyclesAlternate) {
  rig.bring_to(State::Operational);
  rig.send(20, 3, gains(0, 0));
  rig.service();
  rig.cycle();
  probe.record_gains = true;
  int sent = 0;
  for (int i = 1; i <= 60; ++i) {
    for (int burst = i % 4; burst > 0; --burst) {
      ++sent;
      rig.send(20, 3, gains(sent, sent));
    }
    if (i % 3 == 0) rig.send(20, 3, gains(sent, 1e6));  // refused as a whole
    if (i % 2 == 0) rig.service();
    rig.cycle();
  }
  rig.settle();
  ASSERT_EQ(probe.kp.load(), sent);
  EXPECT_GE(probe.gains_seen.size(), 60U);
  for (const auto& [kp, kd] : probe.gains_seen) EXPECT_EQ(kp, kd);
  EXPECT_TRUE(std::ranges::is_sorted(probe.gains_seen));
}

TEST_F(GenericSubsystemTest, AGroupThatIsLargerThanTheCycleEverTakesIsRefusedAsSuch) {
  rig.bring_to(State::Operational);
  std::vector<std::byte> data(1 + 255 * 12);
  OctetWriter writer{data};
  writer.put(std::uint8_t{255});
  for (int i = 0; i < 255; ++i) writer.put(ParameterId{10, Type::Double, 2}.wire()).put(1.0);
  const auto request = rig.send(20, 3, data);
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 4:0104fe");
  EXPECT_EQ(probe.kp.load(), 3.0);
}

TEST_F(GenericSubsystemTest, WhileTheCycleRestsAWriteTakesEffectAtOnce) {
  rig.set_state_now(State::PreOperational);
  rig.send(20, 3, gains(11, 12));
  rig.service();
  EXPECT_EQ(probe.kp.load(), 11.0);
  EXPECT_EQ(probe.kd.load(), 12.0);
}

TEST_F(GenericSubsystemTest, AValueOutOfItsDeclaredRangeIsNotTaken) {
  rig.set_state_now(State::PreOperational);
  const auto request = rig.send(20, 3, gains(11, 100.5));
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 4:010501000a0a03") << "KD, the second of the request";
  EXPECT_EQ(probe.kd.load(), 4.0);
  EXPECT_EQ(probe.kp.load(), 3.0) << "the gain that would fit does not go without the other";
}

// --- telemetry of listings 1 and 2 -------------------------------------------------------------------------------------

TEST_F(GenericSubsystemTest, HousekeepingOfThePapersListingsComesByteForByte) {
  rig.bring_to(State::PreOperational, 0);
  rig.configure(1);
  rig.service();
  rig.forget_telemetry();
  // 500 cycles are one report: DES_POSITION sampled every 100th, CUR_VALUES at the end.
  for (int i = 0; i < 5; ++i) {
    probe.goal.store(i + 1.0);
    rig.cycle(100);
  }
  rig.service();
  EXPECT_THAT(rig.reports(3, 25), ElementsAre("1267"  // structure 4711
                                              "00000003"  // STATE: Pre-Operational
                                              "405f300000000000"  // POSITION: 0.25 x cycle 499
                                              "3ff0000000000000"
                                              "4000000000000000"
                                              "4008000000000000"
                                              "4010000000000000"
                                              "4014000000000000"));
  rig.cycle(499);
  rig.service();
  EXPECT_EQ(rig.reports(3, 25).size(), 1u);
  rig.cycle();
  rig.service();
  EXPECT_EQ(rig.reports(3, 25).size(), 2u);
}

// --- who is woken does not look (adr 0071) -------------------------------------------------------------------------------

struct WokenTest : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor, true, true};
  Duration rests() {
    const TimePoint now = rig.clock.now();
    return rig.subsystem.service_step(now) - now;
  }
};

TEST_F(WokenTest, AServiceLoopWhoseCycleWakesItRestsLongBesideARunningCycle) {
  rig.bring_to(State::Operational);
  EXPECT_EQ(rests(), 10ms);
  Probe another;
  Rig looking{another, probe_descriptor};
  looking.bring_to(State::Operational);
  EXPECT_EQ(looking.subsystem.service_step(looking.clock.now()), looking.clock.now() + 1ms);
}

TEST_F(WokenTest, WhateverTheCycleReportsIsSomethingToWakeFor) {
  rig.bring_to(State::Operational);
  EXPECT_FALSE(rig.subsystem.has_reports());
  probe.raises = true;
  rig.cycle();
  EXPECT_TRUE(rig.subsystem.has_reports()) << "an event";
  probe.raises = false;
  rig.service();
  EXPECT_FALSE(rig.subsystem.has_reports());
  rig.call("SET_GOAL", {1.0});
  rig.service();
  rig.cycle();
  EXPECT_TRUE(rig.subsystem.has_reports()) << "how a function ended";
  rig.service();
  rig.cycle(1000);
  EXPECT_TRUE(rig.subsystem.has_reports()) << "housekeeping";
}

TEST_F(WokenTest, ATransitionIsStillLookedAtEveryMillisecond) {
  probe.nodes[State::SoftwareInit].again = 3;
  rig.set_state(State::PreOperational);
  EXPECT_EQ(rests(), 1ms);
}

TEST_F(GenericSubsystemTest, AnAuthorsEventCarriesItsArguments) {
  rig.bring_to(State::Operational);
  probe.raises = true;
  rig.cycle();
  probe.raises = false;
  rig.settle();
  EXPECT_THAT(rig.reports(5, 2), ElementsAre("00074004000000000000"));
}

}  // namespace
}  // namespace hirosco
