// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hirosco/data_transfer/device_frame.hpp"
#include "hirosco/subsystem/generic_subsystem.hpp"
#include "hirosco/subsystem/testing/probe.hpp"
#include "hirosco/subsystem/testing/rig.hpp"

/// What the framework does for safety whatever the author does: actuator gate, links, devices, permit page, overruns,
/// and the loss of the supervisor (decisions 7, 20 to 22).
namespace hirosco {
namespace {

using pus::st128::Role;
using ::testing::ElementsAre;
using testing::Probe;
using testing::probe_descriptor;
using testing::Rig;

// --- devices -----------------------------------------------------------------------------------------------------------

/// The test plays arm and lamp.
struct Devices : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  std::unique_ptr<DataFlow> arm = open("arm");
  std::unique_ptr<DataFlow> lamp = open("lamp");
  std::array<std::byte, max_device_frame_octets> frame{};
  double angle{0.5};

  std::unique_ptr<DataFlow> open(const char* address) {
    return std::move(rig.flows.open({static_cast<std::uint8_t>(descriptor::Transfer::SharedMemory), address},
                                    FlowSide::Device))
        .value();
  }
  struct Command {
    DeviceMode mode{};
    std::uint32_t epoch{};
    std::uint32_t sequence{};
    std::uint32_t watchdog_us{};
    double value{};
  };
  template <class T>
  Command newest(DataFlow& flow) {
    const auto found = flow.receive(frame);
    if (!found || found->flow != Flow::New) return {};
    const auto command = read_command(Octets{frame}.first(found->octets)).value();
    OctetReader reader{command.payload, std::endian::little};
    return {command.mode, command.epoch, command.sequence, command.watchdog_us, static_cast<double>(reader.get<T>())};
  }
  void answer(DataFlow& flow, std::uint32_t sequence, Octets payload) {
    std::array<std::byte, max_device_frame_octets> buffer{};
    const auto status = write_status(
        buffer, {.epoch = 1, .sequence = sequence, .flags = device_flag::over_temperature, .payload = payload});
    static_cast<void>(flow.send(status.value()));
  }
  /// One cycle, answered by both devices; gives what the arm was told.
  Command exchange() {
    rig.service();
    rig.cycle();
    const Command told = newest<double>(*arm);
    lit = newest<std::uint8_t>(*lamp);
    answer(*arm, told.sequence, std::as_bytes(std::span{&angle, 1}));
    const std::byte on{1};
    answer(*lamp, lit.sequence, std::span{&on, 1});
    return told;
  }
  Command go(State state) {
    const auto request = rig.set_state(state);
    Command told;
    for (int i = 0; i < 3; ++i) told = exchange();
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
    return told;
  }
  void bring_up(State state) {
    rig.bring_to(State::PreOperational, 3);
    for (int i = 0; i < 3; ++i) exchange();
    if (state == State::PreOperational) return;
    go(State::SafeOperational);
    if (state == State::Operational) go(State::Operational);
  }
  Command lit;
};

TEST_F(Devices, AnActuatorGetsTheAuthorsOutputInOperationalOnly) {
  bring_up(State::PreOperational);
  const auto expect_safe = [&](const Command& told, DeviceMode mode) {
    EXPECT_EQ(told.value, -1.0);
    EXPECT_EQ(told.mode, mode);
    EXPECT_EQ(lit.value, 1.0);  // a lamp is no actuator: it shines in every state
  };
  expect_safe(exchange(), DeviceMode::Off);
  expect_safe(go(State::SafeOperational), DeviceMode::Off);
  const Command told = go(State::Operational);
  EXPECT_EQ(told.value, 5.0);
  EXPECT_EQ(told.mode, DeviceMode::Active);
  EXPECT_EQ(told.watchdog_us, 10'000u);
  expect_safe(go(State::SafeOperational), DeviceMode::Off);
  expect_safe(go(State::ErrorOperational), DeviceMode::Stop);
}

TEST_F(Devices, InTheTransientStatesNothingIsSentAtAll) {
  bring_up(State::SafeOperational);
  probe.nodes[State::HardwareDeinit].again = 5;
  probe.nodes[State::SoftwareDeinit].again = 5;
  rig.set_state(State::Offline);
  rig.service();
  rig.cycle();
  static_cast<void>(newest<double>(*arm));
  for (int i = 0; i < 15; ++i) {
    rig.service();
    rig.cycle();
    EXPECT_EQ(newest<double>(*arm).sequence, 0u);
  }
  EXPECT_EQ(rig.state(), State::Offline);
}

TEST_F(Devices, InputReachesTheAuthorInTheSameCycle) {
  bring_up(State::SafeOperational);
  angle = 0.75;
  exchange();
  rig.cycle();
  EXPECT_EQ(probe.arm.input().angle, 0.75);
  EXPECT_TRUE(probe.arm.fresh() && probe.arm.alive());
  EXPECT_EQ(probe.arm.flags(), device_flag::over_temperature);
}

TEST_F(Devices, TheStopFlagActsInTheSameCycleAndIsLatched) {
  bring_up(State::Operational);
  rig.permit.stop = 1;
  const Command stopped = exchange();
  EXPECT_EQ(stopped.value, -1.0);
  EXPECT_EQ(stopped.mode, DeviceMode::Off);
  EXPECT_FALSE(probe.last.active);
  EXPECT_EQ(rig.inhibited(), inhibited_by_stop);
  rig.permit.stop = 0;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(exchange().value, -1.0);
  go(State::SafeOperational);
  EXPECT_EQ(go(State::Operational).value, 5.0);
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(Devices, OperationalIsRefusedWhileTheStopFlagIsSet) {
  bring_up(State::SafeOperational);
  rig.permit.stop = 1;
  EXPECT_EQ(rig.set_state_now(State::Operational), "1 4:010700");
}

TEST_F(Devices, AnotherEpochActsInTheSameCycleAndIsLatched) {
  bring_up(State::Operational);
  rig.permit.epoch.fetch_add(1);
  const Command stopped = exchange();
  EXPECT_EQ(stopped.value, -1.0);
  EXPECT_EQ(stopped.epoch, 2u);
  EXPECT_EQ(exchange().value, -1.0);
  go(State::SafeOperational);
  EXPECT_EQ(go(State::Operational).value, 5.0);
}

TEST_F(Devices, AnAuthorsInhibitionActsInTheSameCycleAndIsLatched) {
  bring_up(State::Operational);
  probe.inhibits = true;
  EXPECT_EQ(exchange().value, -1.0);
  probe.inhibits = false;
  EXPECT_EQ(exchange().value, -1.0);
  EXPECT_EQ(rig.inhibited(), inhibited_by_author);
}

TEST_F(Devices, AFailingNodeInhibitsInTheSameCycle) {
  bring_up(State::Operational);
  probe.nodes[State::Operational].fails = true;
  EXPECT_EQ(exchange().value, -1.0);
}

TEST_F(Devices, ASilentDeviceInhibitsAndIsReportedOnce) {
  bring_up(State::Operational);
  exchange();
  for (int i = 0; i < 3; ++i) {  // the last answer is read in the first of them
    rig.cycle();
    EXPECT_EQ(newest<double>(*arm).value, 5.0);
  }
  rig.cycle();
  EXPECT_EQ(newest<double>(*arm).value, -1.0);
  EXPECT_EQ(rig.inhibited(), inhibited_by_device);
  rig.cycle(20);
  rig.service();
  EXPECT_EQ(rig.events(4), 1);
  exchange();
  rig.cycle();
  EXPECT_TRUE(probe.arm.alive());
  rig.cycle(5);
  rig.service();
  EXPECT_EQ(rig.events(4), 2);
}

TEST_F(Devices, ADeviceThatRepeatsItselfIsSilent) {
  bring_up(State::Operational);
  exchange();
  const auto frozen = newest<double>(*arm).sequence;
  for (int i = 0; i < 6; ++i) {
    answer(*arm, frozen, std::as_bytes(std::span{&angle, 1}));
    rig.cycle();
  }
  rig.service();
  EXPECT_FALSE(probe.arm.alive());
  EXPECT_EQ(rig.events(4), 1);
}

TEST_F(Devices, ADeviceThatNeverSpokeIsNoticedInSafeOperational) {
  rig.bring_to(State::PreOperational, 3);
  rig.cycle(50);
  rig.service();
  EXPECT_EQ(rig.events(4), 0);
  rig.set_state_now(State::SafeOperational);
  EXPECT_EQ(rig.events(4), 1);
}

TEST_F(Devices, DamagedFramesAreCountedAndNotBelieved) {
  bring_up(State::SafeOperational);
  exchange();
  rig.cycle();
  const std::array<std::byte, 30> noise{};
  static_cast<void>(arm->send(noise));
  rig.cycle();
  EXPECT_EQ(probe.arm.damaged_frames(), 1u);
  answer(*arm, 1'000, {});  // whole, but without the declared payload
  rig.cycle();
  EXPECT_EQ(probe.arm.damaged_frames(), 2u);
  EXPECT_EQ(probe.arm.input().angle, 0.5);
}

TEST(ReducedPromise, WithoutRealtimeRightsTheSecondSetOfLimitsHolds) {
  Probe probe;
  Rig rig{probe, probe_descriptor, false};
  rig.bring_to(State::PreOperational, 3);
  rig.set_state(State::SafeOperational);
  rig.service();
  rig.cycle(39);
  rig.service();
  EXPECT_EQ(rig.events(4), 0);
  rig.cycle(2);
  rig.service();
  EXPECT_EQ(rig.events(4), 1);
}

// --- links -------------------------------------------------------------------------------------------------------------

const std::vector<pus::st128::OfferedField> hand_fields{{"ANGLE", Type::Double, 1}, {"ENABLE", Type::Uint8, 1}};

/// The test is the producer of HAND.
struct Links : ::testing::Test {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  Rig::Partner hand;

  void SetUp() override { rig.bring_to(State::PreOperational, 2); }
  void couple() { hand = rig.attach(1, Role::Consumer, "HAND", hand_fields); }
  void sample(double angle, LinkStatus status = LinkStatus::Valid) {
    std::array<std::byte, 9> payload{};
    OctetWriter writer{payload, std::endian::little};
    writer.put(angle).put(std::uint8_t{1});
    hand.writer.write(payload, rig.clock.now(), status);
  }
  void go(State state) {
    const auto request = rig.set_state(state);
    for (int i = 0; i < 4; ++i) {
      sample(0.25);
      rig.service();
      rig.cycle();
    }
    rig.service();
    EXPECT_EQ(rig.outcome(request), "1 3 7") << to_text(state);
  }
  void operate() {
    couple();
    go(State::SafeOperational);
    go(State::Operational);
    EXPECT_EQ(rig.inhibited(), 0u);
  }
};

TEST_F(Links, SafeOperationalIsRefusedUntilTheRequiredLinkIsAttached) {
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 4:000e");
  couple();
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 3 7");
}

TEST_F(Links, ASampleReachesTheAuthorInTheNextCycle) {
  couple();
  sample(0.75);
  rig.cycle();
  EXPECT_EQ(probe.hand.value().angle, 0.75);
  EXPECT_EQ(probe.hand.value().enable, 1);
  EXPECT_TRUE(probe.hand.valid());
  EXPECT_EQ(probe.hand.age_cycles(), 0u);
  rig.cycle(2);
  EXPECT_EQ(probe.hand.age_cycles(), 2u);
}

TEST_F(Links, ASampleThatComesAndGoesBetweenTwoCyclesCountsAsLost) {
  couple();
  for (int samples : {1, 3, 0, 1}) {
    for (int i = 0; i < samples; ++i) sample(0.5);
    rig.cycle();
  }
  const LinkStatistics seen = rig.subsystem.cycle().link_statistics().load();
  EXPECT_EQ(seen.received, 3u);
  EXPECT_EQ(seen.lost, 2u);
}

TEST_F(Links, FieldsAreMatchedByNameWhereverTheProducerPutsThem) {
  hand = rig.attach(1, Role::Consumer, "HAND",
                    {{"MORE", Type::Int32, 2}, {"ENABLE", Type::Uint8, 1}, {"ANGLE", Type::Double, 1}});
  std::array<std::byte, 17> payload{};
  OctetWriter writer{payload, std::endian::little};
  writer.put(std::int32_t{1}).put(std::int32_t{2}).put(std::uint8_t{3}).put(0.5);
  hand.writer.write(payload, rig.clock.now(), LinkStatus::Valid);
  rig.cycle();
  EXPECT_EQ(probe.hand.value().angle, 0.5);
  EXPECT_EQ(probe.hand.value().enable, 3);
}

TEST_F(Links, AStaleRequiredLinkInhibitsAndIsReportedOnce) {
  operate();
  rig.cycle(3);
  EXPECT_EQ(rig.inhibited(), 0u);
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_FALSE(probe.last.active);
  rig.cycle(20);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("000500000004"));
  sample(0.5);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);  // latched
}

TEST_F(Links, ASlowerProducerMayTakeItsOwnPeriods) {
  hand = rig.attach(1, Role::Consumer, "HAND", hand_fields, nullptr, 4ms);
  go(State::SafeOperational);
  sample(0.5);
  rig.cycle();
  rig.cycle(12);
  EXPECT_TRUE(probe.hand.valid());
  rig.cycle();
  EXPECT_FALSE(probe.hand.valid());
}

TEST_F(Links, AProducersFaultInhibitsInTheSameCycle) {
  operate();
  sample(0.5, LinkStatus::Fault);
  rig.cycle();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  rig.service();
  EXPECT_EQ(rig.events(5), 1);
}

TEST_F(Links, AProducersOrderlyEndInhibitsWithoutAlarm) {
  operate();
  hand.writer.set_status(LinkStatus::Stopping);
  rig.cycle(10);
  rig.service();
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.events(5), 0);
}

TEST_F(Links, ADegradedProducerIsStillFollowed) {
  operate();
  sample(0.5, LinkStatus::Degraded);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(Links, ADetachedLinkIsReportedAndInhibitsWithoutAlarm) {
  operate();
  const auto request = rig.detach(1);
  rig.settle();
  EXPECT_EQ(rig.outcome(request), "1 3 7");
  EXPECT_THAT(rig.reports(128, 133), ElementsAre("0102"));
  EXPECT_EQ(rig.inhibited(), inhibited_by_link);
  EXPECT_EQ(rig.events(5), 0);
  const auto again = rig.detach(1);
  rig.settle();
  EXPECT_EQ(rig.outcome(again), "1 4:01010000000001");
}

TEST_F(Links, WhatAnEarlierLinkBroughtIsNoSampleOfTheNext) {
  couple();
  sample(0.5);
  rig.cycle();
  ASSERT_TRUE(probe.hand.valid());
  rig.detach(1);
  rig.settle();
  hand = rig.attach(2, Role::Consumer, "HAND", hand_fields);
  EXPECT_FALSE(probe.hand.valid());
  rig.cycle();
  EXPECT_FALSE(probe.hand.valid());
  sample(0.25);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
}

TEST_F(Links, AnAgreementThatLacksAFieldIsRefused) {
  std::string outcome;
  rig.attach(1, Role::Consumer, "HAND", {{"ANGLE", Type::Double, 1}}, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  ASSERT_EQ(rig.reports(128, 131).size(), 1u);
  EXPECT_EQ(rig.set_state_now(State::SafeOperational), "1 4:000e");
}

TEST_F(Links, AnUnknownSetASecondAttachAndMissingMemoryAreRefused) {
  std::string outcome;
  rig.attach(1, Role::Consumer, "FOOT", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  couple();
  rig.attach(1, Role::Consumer, "HAND", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
  EXPECT_EQ(rig.reports(128, 131).size(), 2u);
}

TEST_F(Links, APartnerThatLeftAndCameBackIsAttachedUnderItsLaterEpoch) {
  operate();
  hand.writer.set_status(LinkStatus::Stopping);
  rig.cycle();
  ++rig.link_epoch;
  std::string outcome;
  hand = rig.attach(1, Role::Consumer, "HAND", hand_fields, &outcome);
  EXPECT_EQ(outcome, "1 3 7");
  sample(0.25);
  rig.cycle();
  EXPECT_TRUE(probe.hand.valid());
  rig.settle();
  EXPECT_TRUE(rig.reports(128, 133).empty()) << "the supervisor has this link as up again";
}

TEST_F(Links, AFieldOfAnotherTypeUnderTheSameNameIsRefused) {
  auto fields = hand_fields;
  fields.front().count = static_cast<std::uint16_t>(fields.front().count + 1);
  std::string outcome;
  rig.attach(1, Role::Consumer, "HAND", fields, &outcome);
  EXPECT_EQ(outcome, "1 4:010700");
}

TEST_F(Links, ErrorOperationalOverridesAChangeThatTheCycleHasNotConfirmed) {
  operate();
  const auto to_safe = rig.set_state(State::SafeOperational);
  const auto to_error = rig.set_state(State::ErrorOperational);
  rig.settle();
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_EQ(rig.outcome(to_safe), "1 3 8:0204");
  EXPECT_EQ(rig.outcome(to_error), "1 3 7");
}

TEST_F(Links, ACycleThatHangsDoesNotKeepARequestOpen) {
  operate();
  const auto to_safe = rig.set_state(State::SafeOperational);
  for (int i = 0; i < 3; ++i) {
    rig.service();
    rig.advance(11s);
  }
  rig.service();
  EXPECT_EQ(rig.outcome(to_safe), "1 3 8:0202");
}

TEST_F(Links, MemoryWithAFutureWriterIsNotTrusted) {
  const pus::st128::AttachRequest request{.link = 1,
                                          .role = Role::Consumer,
                                          .epoch = 5,
                                          .set = "HAND",
                                          .agreement = {descriptor::Method::SharedMemory, descriptor::ByteOrder::Little,
                                                        descriptor::LinkKind::Latest, 1ms, 1ms, hand_fields}};
  const auto open = rig.memory.create("open", link_memory_octets(request.agreement.payload_octets())).value();
  std::vector<std::byte> buffer(max_packet_octets);
  const std::size_t octets = pus::st128::write_attach_request(buffer, request).value();
  const auto unsealed = rig.send(128, pus::st128::attach, Octets{buffer}.first(octets), open);
  const auto without = rig.send(128, pus::st128::attach, Octets{buffer}.first(octets));
  rig.settle();
  EXPECT_EQ(rig.outcome(unsealed), "1 4:010700");
  EXPECT_EQ(rig.outcome(without), "1 4:010700");
}

TEST_F(Links, AProvidedSetCarriesItsStatusBesideTheValues) {
  couple();
  const std::vector<pus::st128::OfferedField> fields{{"POSITION", Type::Double, 1}, {"SEEN", Type::Double, 1}};
  auto arm = rig.attach(2, Role::Producer, "ARM_STATE", fields);
  std::array<std::byte, 16> payload{};
  const auto status = [&] { return arm.reader.read(payload).status; };
  const auto follow = [&] {
    sample(0.25);
    rig.cycle();
    return status();
  };
  EXPECT_EQ(follow(), LinkStatus::Valid);
  OctetReader values{payload, std::endian::little};
  EXPECT_EQ(values.get<double>(), 0.25 * static_cast<double>(probe.last.count));
  go(State::SafeOperational);
  go(State::Operational);
  EXPECT_EQ(follow(), LinkStatus::Valid);
  rig.permit.stop = 1;
  EXPECT_EQ(follow(), LinkStatus::Degraded);
  rig.set_state_now(State::ErrorOperational);
  EXPECT_EQ(follow(), LinkStatus::Fault);
  rig.set_state_now(State::PostOperational);
  EXPECT_EQ(status(), LinkStatus::Stopping);
  EXPECT_THAT(rig.reports(128, 133), ElementsAre("0102", "0201"));
}

// --- overruns ----------------------------------------------------------------------------------------------------------

struct Slow final : Probe {
  ManualClock* clock{nullptr};
  Duration takes{0};
  Result<> work(const Cycle& cycle) noexcept override {
    if (clock != nullptr) clock->advance(takes);
    return Probe::work(cycle);
  }
};

TEST(Overruns, ThreeInARowAreReportedOnceAndMissedCyclesAreSkipped) {
  Slow slow;
  Rig rig{slow, probe_descriptor};
  rig.bring_to(State::PreOperational, 2);
  slow.clock = &rig.clock;
  slow.takes = 2500us;
  TimePoint planned = rig.clock.now();
  for (int i = 0; i < 6; ++i) {
    const TimePoint next = rig.subsystem.cycle_step(planned);
    EXPECT_EQ(next - planned, 3ms);  // on the grid and in the future
    planned = next;
    rig.clock.set(planned);
  }
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("000600000003"));
  EXPECT_EQ(rig.vital.overruns.load(), 6u);
  EXPECT_EQ(rig.vital.execution_max_ns.load(), 2'500'000u);
}

TEST(Overruns, LateStartsOfAStarvingMachineNeitherLengthenTheRowNorBreakIt) {
  Slow slow;
  Rig rig{slow, probe_descriptor};
  rig.bring_to(State::PreOperational, 2);
  slow.clock = &rig.clock;
  slow.takes = 2500us;
  TimePoint planned = rig.clock.now();
  const auto overrun = [&](Duration late) {
    rig.clock.set(planned + late);
    planned = rig.subsystem.cycle_step(planned);
  };
  overrun(0us);
  overrun(0us);
  for (int i = 0; i < 10; ++i) overrun(1001us);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ::testing::IsEmpty());
  overrun(1000us);
  rig.service();
  EXPECT_THAT(rig.reports(5, 3), ElementsAre("000600000003"));
  EXPECT_EQ(rig.vital.overruns.load(), 13u);
}

TEST(Overruns, LatencyIsTheDelayBehindThePlannedTime) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::PreOperational, 2);
  const TimePoint planned = rig.clock.now();
  rig.advance(40us);
  static_cast<void>(rig.subsystem.cycle_step(planned));
  EXPECT_EQ(rig.vital.latency_max_ns.load(), 40'000u);
  EXPECT_EQ(rig.vital.overruns.load(), 0u);
}

TEST(CycleTimes, FallIntoBinsOfPowersOfTwo) {
  Slow slow;
  Rig rig{slow, probe_descriptor};
  rig.bring_to(State::PreOperational, 2);
  slow.clock = &rig.clock;
  const CycleTimes before = rig.subsystem.cycle().times().load();
  for (const auto& [takes, late] : {std::pair{999ns, 0ns}, {1us, 40us}, {63us, 64us}, {10s, 1us}}) {
    slow.takes = takes;
    const TimePoint planned = rig.clock.now();
    rig.advance(late);
    static_cast<void>(rig.subsystem.cycle_step(planned));
  }
  CycleTimes times = rig.subsystem.cycle().times().load();
  for (std::size_t i = 0; i < times.execution.size(); ++i) times.execution[i] -= before.execution[i];
  for (std::size_t i = 0; i < times.latency.size(); ++i) times.latency[i] -= before.latency[i];
  EXPECT_THAT(times.execution, ElementsAre(1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1));
  EXPECT_THAT(times.latency, ElementsAre(1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0));
}

// --- the supervisor ----------------------------------------------------------------------------------------------------

TEST(SupervisorGone, LeadsThroughErrorOperationalToOfflineAndTheEnd) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  rig.channels.close_supervisor_end();
  std::vector<State> seen;
  for (int i = 0; i < 20; ++i) {
    rig.service();
    if (seen.empty() || seen.back() != rig.state()) seen.push_back(rig.state());
    rig.cycle();
  }
  EXPECT_EQ(seen.front(), State::Operational);
  EXPECT_THAT(seen, ::testing::Contains(State::ErrorOperational));
  EXPECT_EQ(seen.back(), State::Offline);
  EXPECT_TRUE(rig.subsystem.finished());
}

TEST(SupervisorGone, AtOfflineThereIsNothingLeftToDo) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.service();
  EXPECT_FALSE(rig.subsystem.finished());
  rig.channels.close_supervisor_end();
  rig.service();
  EXPECT_TRUE(rig.subsystem.finished());
}

TEST(SupervisorGone, ASilentOneMayComeBackSoErrorOperationalIsKept) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  rig.supervisor_silent = true;
  rig.advance(2s);
  rig.service();
  EXPECT_EQ(rig.state(), State::Operational);
  rig.advance(1ms);
  rig.settle();
  EXPECT_EQ(rig.state(), State::ErrorOperational);
  EXPECT_FALSE(rig.subsystem.finished());
  rig.supervisor_silent = false;
  EXPECT_EQ(rig.set_state_now(State::PostOperational), "1 3 7");
}

TEST(SupervisorGone, ASilentOneDoesNotDisturbASafeState) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::SafeOperational);
  rig.supervisor_silent = true;
  rig.advance(10s);
  rig.settle();
  EXPECT_EQ(rig.state(), State::SafeOperational);
}

}  // namespace
}  // namespace hirosco
