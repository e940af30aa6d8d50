// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/kept.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <thread>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/subsystem/author/states.hpp"
#include "hirosco/utilities/os/life.hpp"
#include "supervisor/keeper/inhibit_bridge.hpp"
#include "supervisor/keeper/kept_store.hpp"

/// What the keeper holds so that it outlives the supervisor (docs/adr/0093).
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

// --- stops beside telecommands ---------------------------------------------------------------------------------------------

/// Whether a supervisor that came now would find a stop to carry out.
bool one_is_asked_for(KeeperPage& page) {
  return AskedStops{page}.carry_out([](bool any) { return any; });
}

TEST(AskedStops, OneIsAskedForUntilTheSupervisorHasNotedWhatItHeardOfIt) {
  KeeperPage page;
  AskedStops stops{page};
  EXPECT_FALSE(one_is_asked_for(page));
  stops.count();
  EXPECT_TRUE(one_is_asked_for(page)) << "counted, and its guard dies";
  const auto before = stops.carried_out();
  stops.carry_out([](bool any) { return any; });
  stops.taken(before);
  EXPECT_TRUE(one_is_asked_for(page)) << "that step had begun before the guard carried it out";
  stops.taken(stops.carried_out());
  EXPECT_FALSE(one_is_asked_for(page));
}

TEST(AskedStops, OneThatComesWhileAnotherIsCarriedOutStaysAskedFor) {
  KeeperPage page;
  AskedStops stops{page};
  stops.count();
  stops.carry_out([&](bool any) {
    stops.count();
    return any;
  });
  stops.taken(stops.carried_out());
  EXPECT_TRUE(one_is_asked_for(page)) << "whoever dies now, the next one stops all";
}

TEST(AskedStops, WhoFindsOneAndDiesBeforeItHasNotedThatLeavesItToTheNext) {
  KeeperPage page;
  AskedStops{page}.count();
  for (int death = 0; death < 3; ++death) EXPECT_TRUE(one_is_asked_for(page)) << death;
  AskedStops last{page};
  EXPECT_TRUE(last.carry_out([](bool any) { return any; }));
  last.taken(last.carried_out());
  EXPECT_FALSE(one_is_asked_for(page));
}

// --- another supervisor ---------------------------------------------------------------------------------------------------

TEST(Revivals, AtOnceTwiceAndThenAfterAPauseThatDoubles) {
  Revivals revivals;
  EXPECT_EQ(revivals.next(10s), 0s);
  EXPECT_EQ(revivals.next(100ms), 0s);
  EXPECT_EQ(revivals.next(100ms), 100ms);
  EXPECT_EQ(revivals.next(100ms), 200ms);
  EXPECT_EQ(revivals.next(100ms), 400ms);
  EXPECT_EQ(revivals.next(100ms), std::nullopt) << "a crash loop ends the flight";
}

TEST(Revivals, OneThatLivedLongEnoughBeginsTheCountAnew) {
  Revivals revivals;
  for (int i = 0; i < 300; ++i) EXPECT_EQ(revivals.next(Revivals::long_enough), 0s) << i;
}

// --- the second inhibit, noted ------------------------------------------------------------------------------------------

TEST(KeptInhibit, NoFlippedBitEnables) {
  KeptInhibit inhibit;
  inhibit.note(false, 0x1234, 5);
  ASSERT_FALSE(inhibit.enabled());
  for (unsigned bit = 0; bit < 64; ++bit) {
    inhibit.go.store(std::uint64_t{1} << bit);
    EXPECT_FALSE(inhibit.enabled()) << bit;
  }
  inhibit.note(true, 0x1234, 6);
  ASSERT_TRUE(inhibit.enabled());
  for (unsigned bit = 0; bit < 32; ++bit) {
    inhibit.epoch.store(0x1234U ^ (1U << bit));
    EXPECT_FALSE(inhibit.enabled()) << "under another epoch: " << bit;
  }
}

// --- the store ------------------------------------------------------------------------------------------------------------

struct Stored : ::testing::Test {
  std::pair<FileDescriptor, FileDescriptor> ends = std::move(*KeptStore::make_socket());
  int to_store = ends.second.get();
  KeptStore store{std::move(ends.first)};
  StoreClient client{to_store};

  [[nodiscard]] static FileDescriptor file() { return FileDescriptor{::open("/dev/null", O_RDONLY | O_CLOEXEC)}; }
  [[nodiscard]] static std::size_t open_descriptors() {
    std::size_t count = 0;
    for (int number = 0; number < 1024; ++number) count += ::fcntl(number, F_GETFD) >= 0 ? 1 : 0;
    return count;
  }
};

TEST_F(Stored, WhatWasHandedOverIsPassedOnAndOutlivesWhoHandedItOver) {
  {
    const FileDescriptor a = file(), b = file(), c = file(), d = file();
    ASSERT_TRUE(client.keep(3, {a.get(), b.get(), c.get(), d.get()}));
  }
  store.take();
  EXPECT_TRUE(store.holds(3));
  EXPECT_FALSE(store.holds(2));
  std::vector<ProcessStart::Inherited> inherited;
  store.pass_on(inherited);
  ASSERT_EQ(inherited.size(), kept_roles);
  for (std::size_t i = 0; i < kept_roles; ++i) {
    EXPECT_EQ(inherited[i].number, kept_descriptor(3, static_cast<KeptRole>(i)));
    EXPECT_GE(::fcntl(inherited[i].ours, F_GETFD), 0);
  }
}

TEST_F(Stored, WhatHasEndedIsGivenBackAndNothingLeaks) {
  const FileDescriptor one = file();
  const auto before = open_descriptors();
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(client.keep(0, {one.get(), one.get(), one.get(), one.get()}));
    store.take();
  }
  EXPECT_EQ(open_descriptors(), before + kept_roles);
  client.forget(0);
  store.take();
  EXPECT_FALSE(store.holds(0));
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Stored, WhatIsNoMessageOfOursIsClosedAndChangesNothing) {
  const FileDescriptor one = file();
  ASSERT_TRUE(client.keep(0, {one.get(), one.get(), one.get(), one.get()}));
  store.take();
  const auto before = open_descriptors();
  EXPECT_FALSE(client.keep(most_kept, {one.get(), one.get(), one.get(), one.get()}));
  const std::array<std::uint32_t, 2> long_text{};
  for (const std::size_t octets : {std::size_t{1}, std::size_t{3}, std::size_t{8}})
    ASSERT_GT(::send(to_store, long_text.data(), octets, MSG_DONTWAIT), 0);
  const std::uint32_t beyond = most_kept;
  ASSERT_GT(::send(to_store, &beyond, sizeof beyond, MSG_DONTWAIT), 0);
  store.take();
  EXPECT_TRUE(store.holds(0));
  EXPECT_EQ(open_descriptors(), before);
}

TEST_F(Stored, WithoutAKeeperNothingIsKeptAndNobodyMinds) {
  StoreClient nobody{-1};
  EXPECT_FALSE(nobody.keep(0, {0, 1, 2, 0}));
  nobody.forget(0);
}

// --- between two guards -----------------------------------------------------------------------------------------------------

struct Bridged : ::testing::Test {
  LocalFlows flows;
  KeeperPage page;
  FlowAddress address{Transfer::SharedMemory, "motor-enable"};
  InhibitBridge bridge{page, flows, {address}};
  std::unique_ptr<DataFlow> device = flows.open(address, FlowSide::Device).value();
  TimePoint now{10s};

  void SetUp() override { page.starts.store(1); }
  /// What the device was told; empty: nothing.
  [[nodiscard]] std::optional<EnableCommand> told() {
    std::array<std::byte, enable_frame_octets> frame;
    const auto received = device->receive(frame);
    if (!received || received->flow != Flow::New) return std::nullopt;
    return read_enable_command(frame).value();
  }
};

TEST_F(Bridged, ADeviceIsToldOnWhatItWasToldLast) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  for (std::uint32_t i = 1; i <= 3; ++i, now += InhibitBridge::pace) {
    ASSERT_TRUE(bridge.step(now));
    const auto command = told();
    ASSERT_TRUE(command);
    EXPECT_EQ(command->enabled, 1);
    EXPECT_EQ(command->epoch, 77u);
    EXPECT_EQ(command->sequence, 500u + i) << "each is a sign of life";
  }
}

TEST_F(Bridged, WhoWasNotEnabledIsNotNow) {
  page.inhibits[0].note(false, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told()->enabled, 0);
}

TEST_F(Bridged, AStopThatNoGuardHasTakenWithdrawsWhateverWasToldAfterIt) {
  page.stops_asked = 1;
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told()->enabled, 0);
}

TEST_F(Bridged, NoLongerThanASubsystemGoesOnWithoutASupervisor) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  const TimePoint until = now + supervisor_silence_limit;
  for (; now <= until; now += InhibitBridge::pace) {
    ASSERT_TRUE(bridge.step(now));
    EXPECT_EQ(told()->enabled, 1);
  }
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told()->enabled, 0);
}

TEST_F(Bridged, SupervisorsThatDieBeforeTheirGuardToldAnythingPutNothingOff) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  now += supervisor_silence_limit / 2;
  page.starts.store(2);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  static_cast<void>(told());
  EXPECT_TRUE(bridge.step(now + supervisor_silence_limit / 2 + 1ms));
  EXPECT_EQ(told()->enabled, 0);
}

TEST_F(Bridged, AStopHoldsBeforeItBeginsAndAfter) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  bridge.stop();
  static_cast<void>(told());
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told()->enabled, 0);
}

/// A guard's thread that has held its life word and ended, as the system marked it.
void guard_ends(KeeperPage& page) {
  page.guarded.store(page.starts.load());
  std::thread{[&] { static_cast<void>(hold_life(page.guard_life)); }}.join();
}

TEST_F(Bridged, TheEndOfTheGuardsThreadBeginsItWhateverTheProcessStillHolds) {
  EXPECT_FALSE(bridge.lost());
  guard_ends(page);
  EXPECT_EQ(bridge.lost(), 1u);
}

TEST_F(Bridged, WhereNobodyGoesOnTheEndOfTheGuardsThreadBeginsNothing) {
  guard_ends(page);
  page.finished.store(1);
  EXPECT_FALSE(bridge.lost()) << "it ends in order";
  page.finished.store(0);
  page.alone.store(1);
  EXPECT_FALSE(bridge.lost()) << "all that it has started ends with it";
  page.alone.store(0);
  bridge.nobody_goes_on();
  EXPECT_FALSE(bridge.lost()) << "the flight was asked to end";
}

TEST_F(Bridged, EachSupervisorIsLostOnce) {
  guard_ends(page);
  bridge.begin();
  ASSERT_EQ(bridge.lost(), 1u);
  bridge.begin_at(now);
  page.starts.store(2);
  page.wants_inhibits.store(2);
  ASSERT_FALSE(bridge.step(now));
  EXPECT_FALSE(bridge.lost()) << "the word is still that of the first";
  guard_ends(page);
  EXPECT_EQ(bridge.lost(), 2u);
}

TEST_F(Bridged, OneWhoseGuardNeverBeganIsLostByItsProcessHandle) {
  guard_ends(page);
  bridge.begin_at(now);
  page.starts.store(2);
  page.wants_inhibits.store(2);
  ASSERT_FALSE(bridge.step(now));
  bridge.begin();
  EXPECT_EQ(bridge.lost(), 2u);
}

TEST_F(Bridged, TheNextGuardFindsTheEndnodeFree) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  EXPECT_FALSE(flows.open(address, FlowSide::Subsystem)) << "the bridge has it";
  page.wants_inhibits.store(2);
  EXPECT_FALSE(bridge.step(now));
  EXPECT_EQ(page.left_inhibits.load(), 2u);
  EXPECT_TRUE(flows.open(address, FlowSide::Subsystem));
}

}  // namespace
}  // namespace hirosco::supervisor
