// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <ranges>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/subsystem/service_loop/generic_subsystem.hpp"
#include "hirosco/subsystem/testing/inside.hpp"
#include "hirosco/subsystem/testing/probe.hpp"

/// What the framework does for safety whatever the author does: actuator gate, devices, permit page, and the loss of the
/// supervisor (decisions 7, 21, 22).
namespace hirosco {
namespace {

using pus::st128::Role;
using testing::arm_lost;
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
  std::uint32_t heard_epoch{1};
  std::uint16_t flags{device_flag::over_temperature};

  std::unique_ptr<DataFlow> open(const char* address) {
    return std::move(rig.flows.open({Transfer::SharedMemory, address}, FlowSide::Device)).value();
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
    const auto status =
        write_status(buffer, {.epoch = heard_epoch, .sequence = sequence, .flags = flags, .payload = payload});
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
  rig.permit.fence();
  const Command stopped = exchange();
  EXPECT_EQ(stopped.value, -1.0);
  EXPECT_EQ(stopped.mode, DeviceMode::Off);
  EXPECT_FALSE(probe.last.active);
  EXPECT_EQ(rig.inhibited(), inhibited_by_stop);
  rig.permit.release();
  for (int i = 0; i < 5; ++i) EXPECT_EQ(exchange().value, -1.0);
  go(State::SafeOperational);
  EXPECT_EQ(go(State::Operational).value, 5.0);
  EXPECT_EQ(rig.inhibited(), 0u);
}

TEST_F(Devices, NoFlippedBitOfAFencedPermitPageReachesAnActuator) {
  bring_up(State::SafeOperational);
  for (const State state : {State::SafeOperational, State::Operational}) {
    if (state == State::Operational) {
      EXPECT_EQ(go(state).mode, DeviceMode::Active);
    }
    rig.permit.fence();
    exchange();
    for (std::size_t bit = 0; bit < sizeof(PermitPage) * 8; ++bit) {
      auto* octet = reinterpret_cast<unsigned char*>(&rig.permit) + bit / 8;
      const auto before = *octet;
      *octet ^= static_cast<unsigned char>(1U << bit % 8);
      EXPECT_NE(exchange().mode, DeviceMode::Active) << to_text(state) << " bit " << bit;
      *octet = before;
    }
    rig.permit.release();
  }
}

TEST_F(Devices, NoFlippedBitOfAFencedPermitPageLetsAnEntryIntoOperationalThatWasOnItsWayReachAnActuator) {
  bring_up(State::SafeOperational);
  for (std::size_t bit = 0; bit < sizeof(PermitPage) * 8; ++bit) {
    rig.permit.release();
    rig.set_state(State::Operational);
    rig.service();  // what it was permitted is before the cycle
    rig.permit.fence();
    auto* octet = reinterpret_cast<unsigned char*>(&rig.permit) + bit / 8;
    const auto before = *octet;
    *octet ^= static_cast<unsigned char>(1U << bit % 8);
    for (int i = 0; i < 2; ++i) EXPECT_NE(exchange().mode, DeviceMode::Active) << "bit " << bit;
    *octet = before;
    ASSERT_EQ(rig.state(), State::Operational);
    go(State::SafeOperational);
  }
}

TEST_F(Devices, OperationalIsRefusedWhileTheStopFlagIsSet) {
  bring_up(State::SafeOperational);
  rig.permit.fence();
  EXPECT_EQ(rig.set_state_now(State::Operational), "1 4:010700");
}

TEST_F(Devices, AnotherEpochActsInTheSameCycleAndIsLatched) {
  bring_up(State::Operational);
  rig.permit.release();
  const Command stopped = exchange();
  EXPECT_EQ(stopped.value, -1.0);
  EXPECT_EQ(stopped.epoch, 3u);
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
  EXPECT_EQ(rig.events(arm_lost), 1);
  exchange();
  rig.cycle();
  EXPECT_TRUE(probe.arm.alive());
  rig.cycle(5);
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 2);
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
  EXPECT_EQ(rig.events(arm_lost), 1);
}

TEST_F(Devices, ADeviceThatNeverSpokeIsNoticedInSafeOperational) {
  rig.bring_to(State::PreOperational, 3);
  rig.cycle(50);
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 0);
  rig.set_state_now(State::SafeOperational);
  EXPECT_EQ(rig.events(arm_lost), 1);
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

/// REASON, SILENT_CYCLES, DAMAGED and WRONG_SIZE of the newest ARM_LOST, as the supervisor hears them.
std::array<std::uint32_t, 4> loss_in(const Rig& rig) {
  for (const auto& event : rig.raised | std::views::reverse)
    if (event.id == arm_lost) {
      OctetReader reader{event.auxiliary};
      std::array<std::uint32_t, 4> loss{reader.get<std::uint8_t>()};
      for (std::size_t i = 1; i < loss.size(); ++i) loss[i] = reader.get<std::uint32_t>();
      return loss;
    }
  return {};
}

TEST_F(Devices, ALostDeviceSaysWhetherItWasSilentDamagedOfTheWrongSizeOrRepeatedItself) {
  using enum descriptor::DeviceLoss;
  const auto reason = [](descriptor::DeviceLoss loss) { return static_cast<std::uint32_t>(loss); };
  const std::array<std::byte, 30> noise{};
  std::uint32_t sequence = 1'000;
  const std::pair<std::function<void()>, std::array<std::uint32_t, 4>> cases[]{
      {[&] { static_cast<void>(angle); }, {reason(Silent), 3, 0, 0}},
      {[&] { static_cast<void>(arm->send(noise)); }, {reason(Damaged), 3, 3, 0}},
      {[&] { answer(*arm, ++sequence, {}); }, {reason(WrongSize), 3, 0, 3}},
      {[&] { answer(*arm, 7, std::as_bytes(std::span{&angle, 1})); }, {reason(Repeated), 3, 0, 0}}};
  bring_up(State::SafeOperational);
  for (const auto& [misbehave, wanted] : cases) {
    answer(*arm, 7, std::as_bytes(std::span{&angle, 1}));
    rig.cycle();
    ASSERT_TRUE(probe.arm.alive());
    for (int i = 0; i < 3; ++i) {
      misbehave();
      rig.cycle();
    }
    rig.service();
    EXPECT_EQ(loss_in(rig), wanted);
    rig.forget_telemetry();
    answer(*arm, ++sequence, std::as_bytes(std::span{&angle, 1}));
    rig.cycle();
  }
}

TEST_F(Devices, TheArmIsToldToLetGoBeforeTheNodeOfTheStateBelowRunsWhichMayHang) {
  for (const State below : {State::SafeOperational, State::ErrorOperational}) {
    bring_up(State::Operational);
    ASSERT_EQ(exchange().mode, DeviceMode::Active);
    Command in_node;
    probe.in_node = [&] { in_node = newest<double>(*arm); };
    rig.set_state(below);
    rig.service();
    rig.cycle();
    probe.in_node = nullptr;
    EXPECT_EQ(in_node.mode, below == State::ErrorOperational ? DeviceMode::Stop : DeviceMode::Off);
    EXPECT_EQ(rig.vital.state.load(), static_cast<std::uint32_t>(below));
    rig.set_state_now(State::Offline);
  }
}

/// On the way up from a stop that its watchdog saw: the guard names the new epoch to it some cycles after the entry.
TEST_F(Devices, WhatLetGoUnderAnEarlierEpochIsLostOnlyOnceItHasHeardOfThisOne) {
  flags = device_flag::watchdog_tripped;
  heard_epoch = 0;
  bring_up(State::Operational);
  Command told;
  for (int i = 0; i < 50; ++i) told = exchange();
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 0);
  EXPECT_EQ(told.mode, DeviceMode::Active);
  ASSERT_GT(told.epoch, heard_epoch);
  heard_epoch = told.epoch;
  for (int i = 0; i < 5; ++i) exchange();
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 1);
  EXPECT_EQ(loss_in(rig)[0], static_cast<std::uint32_t>(descriptor::DeviceLoss::LetGo));
}

TEST_F(Devices, WhatLetGoAndNeverHearsOfThisEpochIsLostAfterAll) {
  flags = device_flag::watchdog_tripped;
  heard_epoch = 0;
  bring_up(State::Operational);
  constexpr int silence_limit = 3, introduction = 40 * silence_limit;
  for (int i = 0; i < introduction - silence_limit; ++i) exchange();
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 0);
  for (int i = 0; i < 3 * silence_limit; ++i) exchange();
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 1);
}

TEST(ReducedPromise, WithoutRealtimeRightsTheSecondSetOfLimitsHolds) {
  Probe probe;
  Rig rig{probe, probe_descriptor, false};
  rig.bring_to(State::PreOperational, 3);
  rig.set_state(State::SafeOperational);
  rig.service();
  rig.advance(first_answer_limit + 1ms);
  rig.service();
  rig.cycle(39);
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 0);
  rig.cycle(2);
  rig.service();
  EXPECT_EQ(rig.events(arm_lost), 1);
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

/// So many looks of the service loop, that far apart.
void look(Rig& rig, int count, Duration apart) {
  for (int i = 0; i < count; ++i) {
    rig.advance(apart);
    rig.service();
  }
}

TEST(SupervisorGone, ASilentOneMayComeBackSoErrorOperationalIsKept) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  rig.supervisor_silent = true;
  rig.service();  // its last heartbeat is seen
  look(rig, 20, 100ms);
  rig.cycle();
  EXPECT_EQ(probe.last.state, State::Operational) << "as long as the limit is not longer";
  look(rig, 1, 1ms);
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
  look(rig, 100, 100ms);
  rig.settle();
  EXPECT_EQ(rig.state(), State::SafeOperational);
}

TEST(SupervisorGone, APauseOfTheWholeComputerTakesNobodyOutOfOperational) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  rig.supervisor_silent = true;  // it stood, too: its heartbeat is where it was
  look(rig, 1, 10s);
  rig.settle();
  EXPECT_EQ(rig.state(), State::Operational);
  rig.supervisor_silent = false;
  for (int pause = 0; pause < 20; ++pause) {
    look(rig, 1, 10s);
    EXPECT_EQ(rig.state(), State::Operational) << pause;
  }
}

/// However far apart its looks are, as many of them as the limit has find the silence, and not one fewer.
TEST(SupervisorGone, OfTheTimeBetweenTwoLooksNoMoreCountsThanTheBound) {
  for (const Duration apart : std::initializer_list<Duration>{50ms, 100ms, 200ms, 201ms, 1s, 3h}) {
    Probe probe;
    Rig rig{probe, probe_descriptor};
    rig.bring_to(State::Operational);
    rig.supervisor_silent = true;
    rig.service();  // its last heartbeat is seen
    const auto counted = std::min<Duration>(apart, 200ms);
    look(rig, static_cast<int>(Duration{2s} / counted), apart);
    EXPECT_EQ(rig.state(), State::Operational) << apart.count();
    look(rig, 1, apart);
    rig.settle();
    EXPECT_EQ(rig.state(), State::ErrorOperational) << apart.count();
  }
}

TEST(SupervisorGone, ASignOfItBeginsItsLimitAnew) {
  Probe probe;
  Rig rig{probe, probe_descriptor};
  rig.bring_to(State::Operational);
  for (int round = 0; round < 3; ++round) {
    rig.supervisor_silent = true;
    look(rig, 20, 100ms);
    rig.supervisor_silent = false;
    look(rig, 1, 100ms);
  }
  EXPECT_EQ(rig.state(), State::Operational);
}

}  // namespace
}  // namespace hirosco
