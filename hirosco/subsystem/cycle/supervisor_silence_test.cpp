// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "hirosco/subsystem/pages/supervisor_silence.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// What the cycle does by itself when nobody else can: the supervisor is silent, the service loop late, a node failed.
namespace hirosco {
namespace {

using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

TEST(SupervisorGone, TheCycleItselfInhibitsTheActuatorsInItsOwnCyclesThoughTheServiceLoopIsStuck) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  const auto limit = static_cast<int>(2s / rig.subsystem.cycle_demand().period);
  rig.supervisor_silent = true;
  rig.cycle(limit);
  EXPECT_EQ(rig.inhibited(), 0u);
  EXPECT_TRUE(probe.last.active);
  rig.cycle(5);
  EXPECT_EQ(rig.inhibited(), inhibited_by_supervisor);
  EXPECT_FALSE(probe.last.active);
  rig.supervisor_silent = false;
  rig.cycle(10);
  EXPECT_EQ(rig.inhibited(), inhibited_by_supervisor) << "until the next entry into Operational";
  rig.service();
  EXPECT_EQ(rig.heard(descriptor::framework_event::supervisor_silent), 1);
}

TEST(SupervisorGone, AnEntryIntoOperationalDoesNotHideItsSilence) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::SafeOperational);
  rig.supervisor_silent = true;
  rig.cycle(static_cast<int>(2s / rig.subsystem.cycle_demand().period) + 1);
  rig.set_state(State::Operational);
  rig.service();
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_supervisor);
  EXPECT_FALSE(probe.last.active);
}

TEST(SupervisorGone, AHeartbeatInEveryCycleOrOnceInTheLimitIsEnough) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  const auto limit = static_cast<int>(2s / rig.subsystem.cycle_demand().period);
  rig.supervisor_silent = true;
  for (int i = 0; i < 3; ++i) {
    rig.cycle(limit);
    rig.permit.heartbeat.fetch_add(1);
  }
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST(SupervisorGone, ItsLimitIsTwoSecondsRoundedUpToWholeCycles) {
  EXPECT_EQ(supervisor_silence_cycles(500us), 4000u);
  EXPECT_EQ(supervisor_silence_cycles(3ms), 667u);
  EXPECT_EQ(supervisor_silence_cycles(1h), 1u);
}

TEST(SupervisorLate, GetsEveryReportOnEveryTelecommandHoweverLateItReadsThem) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  std::vector<testing::Sent> pings(3000);
  for (testing::Sent& ping : pings) ping = rig.send(17, 1, {});
  // The processor is the subsystem's alone: it could answer all of them before the supervisor reads one answer.
  for (int i = 0; i < 100; ++i) static_cast<void>(rig.subsystem.service_step(rig.clock.now()));
  EXPECT_FALSE(rig.subsystem.reads());
  for (int i = 0; i < 100; ++i) rig.service();
  EXPECT_TRUE(rig.subsystem.reads());
  for (const testing::Sent& ping : pings) ASSERT_EQ(rig.outcome(ping), "1 3 7");
  EXPECT_EQ(rig.reports(17, 2).size(), pings.size());
  EXPECT_EQ(rig.heard(descriptor::framework_event::reports_lost), 0);
}

TEST(SupervisorLate, IsMissedThoughAnswersToItWaitWhenItIsGoneForGood) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  for (int i = 0; i < 3000; ++i) static_cast<void>(rig.send(17, 1, {}));
  for (int i = 0; i < 100; ++i) static_cast<void>(rig.subsystem.service_step(rig.clock.now()));
  ASSERT_FALSE(rig.subsystem.reads());
  rig.channels.close_supervisor_end();
  for (int i = 0; i < 100; ++i) static_cast<void>(rig.subsystem.service_step(rig.clock.now()));
  EXPECT_TRUE(rig.subsystem.finished());
}

/// Does something in the middle of a step of the service loop: reports of the cycle are taken, messages not yet.
struct Interrupted : Probe {
  std::function<void()> between;
  void telemetry(Octets) override { between(); }
};

TEST(FailedNode, StaysInhibitedAndRefusesAnEntryIntoOperationalThatWasOnItsWay) {
  Interrupted probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::SafeOperational);
  probe.nodes[State::SafeOperational].fails = true;
  probe.between = [&] { rig.cycle(); };
  std::array<std::byte, 64> buffer{};
  const auto any = pus::write_telemetry(buffer, {.apid = 1, .service = 17, .subtype = 2}, {});
  ASSERT_TRUE(rig.channels.supervisor_end().send({.packet = *any}));
  const auto up = rig.set_state(State::Operational);
  rig.service();  // the node fails, and then the command is taken
  for (int i = 0; i < 10; ++i) {
    rig.cycle();
    EXPECT_FALSE(probe.last.active);
    EXPECT_NE(rig.inhibited() & inhibited_by_failure, 0u);
    rig.service();
  }
  EXPECT_EQ(probe.nodes[State::Operational].calls, 0);
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_TRUE(rig.outcome(up).starts_with("1 3 8:0202")) << rig.outcome(up);
}

TEST(ServiceLoop, CountsAStepOnlyWhenAllOfItsWorkIsDone) {
  struct Slow : Probe {
    const VitalPage* vital{nullptr};
    std::uint64_t seen{0};
    void service(TimePoint) override { seen = vital != nullptr ? vital->service_steps.load() : 0; }
  } probe;
  Rig rig{probe, probe_descriptor};
  rig.service();
  probe.vital = &rig.vital;
  const std::uint64_t before = rig.vital.service_steps.load();
  rig.service();
  EXPECT_EQ(probe.seen, before) << "an author that never returns holds the count";
  EXPECT_EQ(rig.vital.service_steps.load(), before + 1);
}

}  // namespace
}  // namespace hirosco
