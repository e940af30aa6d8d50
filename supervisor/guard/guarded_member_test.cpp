// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/guard/guarded_member.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/utilities/crc16.hpp"
#include "supervisor/guard/testing/guard_rig.hpp"

/// One device and one member by themselves: what the guard concludes from what they say.
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t greatest_sequence = std::numeric_limits<std::uint32_t>::max();

struct WatchedDeviceTest : ::testing::Test {
  LocalFlows flows;
  std::unique_ptr<DataFlow> motor = flows.open({Transfer::SharedMemory, "motor-enable"}, FlowSide::Device).value();
  WatchedDevice device;
  TimePoint now{10s};
  WatchedDeviceTest() {
    device.ways.resize(1);
    device.ways[0].flow = flows.open({Transfer::SharedMemory, "motor-enable"}, FlowSide::Subsystem).value();
  }
  /// `kind` empty: of this version.
  void answer(std::uint32_t sequence, DeviceOutput output = DeviceOutput::Off,
              std::optional<std::uint8_t> kind = std::nullopt) {
    std::array<std::byte, enable_frame_octets> frame{};
    ASSERT_TRUE(write_enable_status(frame, {.output = output, .flags = 0, .epoch = 0, .sequence = sequence}));
    if (kind) frame[2] = std::byte{*kind};
    OctetWriter sum{MutableOctets{frame}.last(2), std::endian::little};
    sum.put(crc16(Octets{frame}.first(frame.size() - 2)));
    ASSERT_TRUE(motor->send(frame));
    device.hear(now);
  }
  [[nodiscard]] EnableCommand told() {
    std::array<std::byte, enable_frame_octets> frame{};
    EXPECT_EQ(motor->receive(frame).value().flow, Flow::New);
    return read_enable_command(frame).value();
  }
};

TEST_F(WatchedDeviceTest, KnowsOfAStopByAnAnswerToALaterCommandOnly) {
  device.fenced_at_sequence = 7;
  device.last.sequence = 8;
  EXPECT_FALSE(device.knows()) << "that it never said";
  answer(6);
  EXPECT_FALSE(device.knows());
  answer(7);
  EXPECT_FALSE(device.knows()) << "the newest command that came before the stop";
  answer(8);
  EXPECT_TRUE(device.knows());
}

TEST_F(WatchedDeviceTest, KnowsOfAStopAlikeWhereTheNumbersBeginAnew) {
  device.fenced_at_sequence = greatest_sequence - 1;
  answer(greatest_sequence - 1);
  EXPECT_FALSE(device.knows());
  for (const std::uint32_t later : {greatest_sequence, 0U, 1U}) {
    answer(later);
    EXPECT_TRUE(device.knows()) << later;
  }
  device.fenced_at_sequence = 1;
  answer(greatest_sequence);
  EXPECT_FALSE(device.knows()) << "an answer of before";
}

TEST_F(WatchedDeviceTest, RestsOnlyOffOrHoldingAndOnlyWhereItKnows) {
  device.fenced_at_sequence = 7;
  answer(7, DeviceOutput::Off);
  EXPECT_FALSE(device.rests()) << "it was off before, and may have been told to move since";
  const std::pair<DeviceOutput, bool> outputs[]{{DeviceOutput::Off, true},
                                                {DeviceOutput::Active, false},
                                                {DeviceOutput::Stopping, false},
                                                {DeviceOutput::Holding, true}};
  for (const auto& [output, rests] : outputs) {
    answer(8, output);
    EXPECT_EQ(device.rests(), rests) << static_cast<int>(output);
  }
}

TEST_F(WatchedDeviceTest, ThatActedAndRestsOtherwiseThanItsDescriptorDeclaresIsTold) {
  using enum descriptor::StopKind;
  constexpr std::string_view off = "it is off, and its descriptor declares that it holds",
                             holds = "it holds, and its descriptor declares that it lets go";
  struct Rest {
    descriptor::StopKind declared;
    DeviceOutput output;
    std::string_view told;
  };
  device.fenced_at_sequence = 7;
  answer(6, DeviceOutput::Active);
  for (const Rest& rest : {Rest{Drop, DeviceOutput::Off, ""},
                           {Drop, DeviceOutput::Holding, holds},
                           {Drop, DeviceOutput::Stopping, ""},
                           {Hold, DeviceOutput::Off, off},
                           {Hold, DeviceOutput::Holding, ""},
                           {Hold, DeviceOutput::Active, ""},
                           {Controlled, DeviceOutput::Off, ""},
                           {Controlled, DeviceOutput::Holding, ""}}) {
    device.stop = rest.declared;
    answer(8, rest.output);
    EXPECT_EQ(device.rests_otherwise(), rest.told) << to_text(rest.declared) << static_cast<int>(rest.output);
  }
  device.stop = Hold;
  answer(7, DeviceOutput::Off);
  EXPECT_EQ(device.rests_otherwise(), "") << "it has not heard of the stop";
}

TEST_F(WatchedDeviceTest, ThatHasNotActedSinceItWasLetGoMayRestAsItLikes) {
  device.fenced_at_sequence = 7;
  device.stop = descriptor::StopKind::Hold;
  answer(8, DeviceOutput::Off);
  EXPECT_EQ(device.rests_otherwise(), "");
  answer(9, DeviceOutput::Active);
  answer(10, DeviceOutput::Off);
  EXPECT_NE(device.rests_otherwise(), "");
}

TEST_F(WatchedDeviceTest, FallsSilentOnceForEachSilenceAndNoSoonerThanItsTimeAfterItMayAct) {
  answer(1);
  EXPECT_FALSE(device.falls_silent(now - 5s, now + inhibit_silence - 1ns));
  const TimePoint released = now + 300ms;
  EXPECT_FALSE(device.falls_silent(released, now + inhibit_silence)) << "it may act since then only";
  EXPECT_TRUE(device.falls_silent(released, released + inhibit_silence));
  EXPECT_FALSE(device.falls_silent(released, released + 10 * inhibit_silence)) << "told";
  now += 60s;
  answer(2);
  EXPECT_FALSE(device.falls_silent(released, now + inhibit_silence - 1ns));
  EXPECT_TRUE(device.falls_silent(released, now + inhibit_silence)) << "another silence";
}

TEST_F(WatchedDeviceTest, AnAnswerOfAnotherVersionCountsAsNoneAndNamesTheSilence) {
  answer(1, DeviceOutput::Holding);
  const TimePoint heard = now;
  EXPECT_EQ(device.why_silent(), GuardFinding::Kind::InhibitSilent);
  now += 100ms;
  answer(2, DeviceOutput::Active, 0x5A);
  EXPECT_EQ(device.last.sequence, 1U);
  EXPECT_EQ(device.last.output, DeviceOutput::Holding);
  EXPECT_EQ(device.ways[0].heard_at, heard);
  EXPECT_EQ(device.why_silent(), GuardFinding::Kind::InhibitOfOtherVersion);
  ASSERT_TRUE(motor->send(std::array<std::byte, enable_frame_octets>{}));
  device.hear(now);
  EXPECT_EQ(device.why_silent(), GuardFinding::Kind::InhibitSilent) << "damage is of no version";
  answer(3, DeviceOutput::Active, 0x5A);
  answer(4);
  EXPECT_EQ(device.why_silent(), GuardFinding::Kind::InhibitSilent);
  EXPECT_EQ(device.ways[0].heard_at, now);
}

TEST_F(WatchedDeviceTest, EachCommandHasTheNextNumberAndIsNotedForWhoGoesOnTellingIt) {
  KeptInhibit note;
  device.ways[0].note = &note;
  device.sequence = greatest_sequence - 1;
  device.tell(true, 77);
  const EnableCommand enabled = told();
  EXPECT_EQ(enabled.enabled, 1);
  EXPECT_EQ(enabled.epoch, 77U);
  EXPECT_EQ(enabled.sequence, greatest_sequence);
  EXPECT_TRUE(note.enabled());
  EXPECT_EQ(note.epoch.load(), 77U);
  EXPECT_EQ(note.sequence.load(), greatest_sequence);
  device.tell(false, 78);
  EXPECT_EQ(told().enabled, 0);
  EXPECT_FALSE(note.enabled());
  EXPECT_EQ(note.sequence.load(), 0U) << "behind the last number comes the first";
}

struct GuardedMemberTest : ::testing::Test {
  descriptor::Mission mission = testing::small_mission();
  VitalPage vital;
  PermitPage permit;
  GuardedMember member;
  std::shared_ptr<testing::FakeProcess> process = std::make_shared<testing::FakeProcess>();
  TimePoint now{10s};
  GuardedMemberTest() {
    permit.epoch = member.epoch = 1000;
    member.described = &mission.subsystems[0];
    member.vital = &vital;
    member.permit = &permit;
    member.grip = process;
    vital.configuration = 2;
    vital.realtime = 1;
    vital.cycling = 1;
    in(State::Operational);
  }
  void in(State state) { vital.state = static_cast<std::uint32_t>(state); }
  [[nodiscard]] bool may_move() const { return permit.permits(permit.epoch.load()); }
};

TEST_F(GuardedMemberTest, IsDamagedByWhatNobodyWritesOnEitherPage) {
  ASSERT_FALSE(member.damaged());
  const auto damaged_by = [&](const std::function<void()>& change, const std::function<void()>& undo) {
    change();
    const bool seen = member.damaged();
    undo();
    EXPECT_FALSE(member.damaged());
    return seen;
  };
  EXPECT_TRUE(damaged_by([&] { ++vital.magic; }, [&] { --vital.magic; }));
  EXPECT_TRUE(damaged_by([&] { ++vital.version; }, [&] { --vital.version; }));
  EXPECT_TRUE(damaged_by([&] { vital.state = 10; }, [&] { vital.state = 9; })) << "no state has this number";
  EXPECT_TRUE(damaged_by([&] { vital.cycling = 2; }, [&] { vital.cycling = 0; }));
  EXPECT_TRUE(damaged_by([&] { vital.realtime = 2; }, [&] { vital.realtime = 0; }));
  EXPECT_TRUE(damaged_by([&] { vital.configuration = 3; }, [&] { vital.configuration = 0; })) << "not declared";
  EXPECT_TRUE(damaged_by([&] { vital.configuration = 0x102; }, [&] { vital.configuration = 2; }));
  EXPECT_TRUE(damaged_by([&] { ++permit.magic; }, [&] { --permit.magic; }));
  EXPECT_TRUE(damaged_by([&] { ++permit.version; }, [&] { --permit.version; }));
  EXPECT_TRUE(damaged_by([&] { ++permit.epoch; }, [&] { --permit.epoch; }));
}

TEST_F(GuardedMemberTest, IsDamagedByAPermissionThatTheGuardDidNotGive) {
  permit.go = permission_word(1000);
  EXPECT_TRUE(member.damaged());
  permit.go = 0;
  member.release(now);
  EXPECT_FALSE(member.damaged());
  permit.go ^= 1;
  EXPECT_TRUE(member.damaged());
  permit.go = 0;
  EXPECT_FALSE(member.damaged()) << "nobody moves by that";
}

TEST_F(GuardedMemberTest, MayStandStillAsLongAsItsPriorityAndItsPeriodAskFor) {
  auto& subsystem = mission.subsystems[0].subsystem;
  subsystem.hang = {20, 200};
  EXPECT_EQ(member.hang_limit(), 20U);
  member.take_realtime(GuardedMember::Taken::Loops);
  EXPECT_EQ(member.hang_limit(), 20U) << "its cycle keeps its own";
  member.take_realtime(GuardedMember::Taken::All);
  EXPECT_EQ(member.hang_limit(), 200U);
  member.take_realtime(GuardedMember::Taken::Loops);
  EXPECT_EQ(member.hang_limit(), 200U) << "what is taken stays so";
  member.release(now);
  EXPECT_EQ(member.hang_limit(), 20U);
  vital.realtime = 0;
  EXPECT_EQ(member.hang_limit(), 200U);
  subsystem.configurations[0].sampling = 1s;
  EXPECT_EQ(member.hang_limit(), 300U) << "three of its steps";
  vital.configuration = 0;
  EXPECT_EQ(member.hang_limit(), 200U);
}

TEST_F(GuardedMemberTest, UsesTheDevicesOfItsConfigurationInForceAndNoOthers) {
  mission.subsystems[0].subsystem.configurations[0].devices.resize(1);
  mission.subsystems[0].subsystem.configurations[0].devices[0].device = 1;
  EXPECT_TRUE(member.uses(1));
  EXPECT_FALSE(member.uses(0));
  vital.configuration = 0;
  EXPECT_FALSE(member.uses(1)) << "none is in force";
}

TEST_F(GuardedMemberTest, APermissionIsForOneStayInOperational) {
  member.release(now);
  const std::uint32_t epoch = permit.epoch.load();
  member.end_permission(now + 60s);
  EXPECT_TRUE(may_move());
  in(State::SafeOperational);
  member.end_permission(now + 60s);
  EXPECT_FALSE(may_move());
  EXPECT_FALSE(member.released);
  EXPECT_EQ(permit.epoch.load(), epoch) << "it left by itself: that is no stop";
  EXPECT_EQ(permit.stop.load(), 0U);
  in(State::Operational);
  member.end_permission(now + 60s);
  EXPECT_FALSE(may_move()) << "it comes back without one";
}

TEST_F(GuardedMemberTest, APermissionThatIsNotUsedEndsWithItsTimeOrThreeStepsOfASlowCycle) {
  in(State::SafeOperational);
  for (const auto& [sampling, limit] : {std::pair<Duration, Duration>{1ms, permission_entry_limit}, {3s, 9s}}) {
    mission.subsystems[0].subsystem.configurations[0].sampling = sampling;
    member.release(now);
    member.end_permission(now + limit - 1ns);
    EXPECT_TRUE(may_move());
    member.end_permission(now + limit);
    EXPECT_FALSE(may_move());
  }
}

TEST_F(GuardedMemberTest, AFenceOfWhoStandsFencedCountsAndAsksForNoFurtherAnswer) {
  KeptInhibit note;
  member.devices.resize(1);
  member.devices[0].ways.resize(1);
  member.devices[0].ways[0].note = &note;
  member.devices[0].sequence = 5;
  vital.cycles = 70;
  member.release(now);
  member.fence();
  EXPECT_FALSE(may_move());
  EXPECT_EQ(permit.stopped_at_cycle.load(), 70U);
  EXPECT_EQ(member.devices[0].fenced_at_sequence, 5U);
  const std::uint32_t epoch = permit.epoch.load();
  EXPECT_EQ(epoch, member.epoch);
  vital.cycles = 80;
  member.devices[0].sequence = 6;
  note.note(true, 1, 1);
  member.fence();
  EXPECT_EQ(member.fences, 2U);
  EXPECT_EQ(permit.epoch.load(), epoch);
  EXPECT_EQ(permit.stopped_at_cycle.load(), 70U);
  EXPECT_EQ(member.devices[0].fenced_at_sequence, 5U);
  EXPECT_FALSE(note.enabled()) << "nobody goes on with it";
}

TEST_F(GuardedMemberTest, WhoIsLetMoveHasTheRealTimeThatWasTakenAndOnlyThen) {
  process->realtime = process->loops_realtime = false;
  member.release(now);
  EXPECT_FALSE(process->realtime) << "nobody took it";
  member.guarded_before = true;
  member.release(now);
  EXPECT_TRUE(process->realtime) << "the guard before may have taken it";
  member.take_realtime(GuardedMember::Taken::Loops);
  member.release(now);
  EXPECT_TRUE(process->loops_realtime);
}

TEST_F(GuardedMemberTest, ItsOwnWordCountsWhereItRestsOrKnowsTheFenceAndInhibits) {
  member.release(now);
  member.fence();
  EXPECT_FALSE(member.says_stopped());
  vital.inhibited = inhibited_by_stop;
  EXPECT_FALSE(member.says_stopped()) << "for another reason, as it has not seen the fence";
  vital.seen_epoch = member.epoch;
  EXPECT_TRUE(member.says_stopped());
  vital.inhibited = 0;
  EXPECT_FALSE(member.says_stopped());
  in(State::SafeOperational);
  EXPECT_TRUE(member.says_stopped()) << "only in Operational may it move";
  vital.state = 10;
  EXPECT_FALSE(member.says_stopped()) << "a damaged page says nothing";
  in(State::Operational);
  vital.cycling = 0;
  EXPECT_TRUE(member.says_stopped());
}

}  // namespace
}  // namespace hirosco::supervisor
