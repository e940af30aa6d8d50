// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/keeper/inhibit_bridge.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "hirosco/data_transfer/device/enable_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/subsystem/pages/supervisor_silence.hpp"
#include "hirosco/utilities/os/life.hpp"

/// Between two guards: the second inhibits while no supervisor tells them anything (docs/adr/0093).
namespace hirosco::supervisor {
namespace {

using namespace std::chrono_literals;

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
  std::thread{[&] {
    static_cast<void>(hold_life(page.guard_life));
    page.guarded.store(page.starts.load());
  }}.join();
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

TEST_F(Bridged, AStartThatTheSystemRefusedLeavesTheEndnodeFreeForTheNextOne) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  page.starts.store(3);  // the second could not be made
  page.wants_inhibits.store(3);
  EXPECT_FALSE(bridge.step(now));
  EXPECT_EQ(page.left_inhibits.load(), 3u) << "it would wait for that, and its devices stop";
  EXPECT_TRUE(flows.open(address, FlowSide::Subsystem));
}

TEST_F(Bridged, AStopBeforeItBeginsHoldsWhenItDoes) {
  page.inhibits[0].note(true, 77, 500);
  bridge.stop();
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told()->enabled, 0);
}

TEST_F(Bridged, TheSupervisorThatHadTakenOverAndDiesLaterHasItsWholeTimeAnew) {
  page.inhibits[0].note(true, 77, 500);
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  page.starts.store(2);
  page.wants_inhibits.store(2);
  ASSERT_FALSE(bridge.step(now));
  page.inhibits[0].note(true, 78, 900);
  now += 2 * supervisor_silence_limit;
  bridge.begin_at(now);
  static_cast<void>(told());
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told()->enabled, 1);
}

TEST_F(Bridged, WhatTheDyingProcessStillHoldsIsToldNothingUntilItIsFree) {
  page.inhibits[0].note(true, 77, 500);
  auto dying = flows.open(address, FlowSide::Subsystem).value();
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  EXPECT_FALSE(told());
  EXPECT_EQ(page.inhibits[0].sequence.load(), 500u) << "nobody was told anything under that number";
  dying.reset();
  bridge.begin_at(now);
  ASSERT_TRUE(bridge.step(now));
  EXPECT_EQ(told().value().enabled, 1);
}

TEST(InhibitBridge, EachDeviceIsToldWhatItWasToldItselfAndBeyondTheMostNobodyIsToldAnything) {
  LocalFlows flows;
  KeeperPage page;
  page.starts.store(1);
  std::vector<FlowAddress> addresses;
  std::vector<std::unique_ptr<DataFlow>> devices;
  for (std::size_t i = 0; i <= most_inhibits; ++i) {
    addresses.push_back({Transfer::SharedMemory, "motor-" + std::to_string(i)});
    devices.push_back(flows.open(addresses.back(), FlowSide::Device).value());
    if (i < most_inhibits)
      page.inhibits[i].note(i % 3 == 0, static_cast<std::uint32_t>(100 + i), static_cast<std::uint32_t>(1000 * i));
  }
  InhibitBridge bridge{page, flows, addresses};
  bridge.begin_at(TimePoint{10s});
  ASSERT_TRUE(bridge.step(TimePoint{10s}));
  std::array<std::byte, enable_frame_octets> frame{};
  for (std::size_t i = 0; i < most_inhibits; ++i) {
    ASSERT_EQ(devices[i]->receive(frame).value().flow, Flow::New) << i;
    const auto command = read_enable_command(frame).value();
    EXPECT_EQ(command.enabled, i % 3 == 0 ? 1 : 0) << i;
    EXPECT_EQ(command.epoch, 100 + i);
    EXPECT_EQ(command.sequence, 1000 * i + 1);
  }
  EXPECT_EQ(devices.back()->receive(frame).value().flow, Flow::None);
  EXPECT_TRUE(flows.open(addresses.back(), FlowSide::Subsystem)) << "that endnode is left to others";
}

TEST(InhibitBridge, TellsNothingByAWayThatIsNotInUseUntilItInhibitsByAll) {
  LocalFlows flows;
  KeeperPage page;
  page.starts.store(1);
  const std::vector<FlowAddress> addresses{{Transfer::SharedMemory, "a"}, {Transfer::SharedMemory, "b"}};
  std::vector<std::unique_ptr<DataFlow>> ends;
  for (const auto& address : addresses) ends.push_back(flows.open(address, FlowSide::Device).value());
  page.inhibits[0].note_untold(77, 500);
  page.inhibits[1].note(true, 77, 500);
  InhibitBridge bridge{page, flows, addresses};
  const auto told = [&](std::size_t way) -> std::optional<EnableCommand> {
    std::array<std::byte, enable_frame_octets> frame;
    const auto received = ends[way]->receive(frame);
    if (!received || received->flow != Flow::New) return std::nullopt;
    return read_enable_command(frame).value();
  };
  bridge.begin_at(TimePoint{10s});
  ASSERT_TRUE(bridge.step(TimePoint{10s}));
  EXPECT_FALSE(told(0));
  EXPECT_EQ(told(1)->enabled, 1);
  bridge.stop();
  ASSERT_TRUE(bridge.step(TimePoint{10s} + InhibitBridge::pace));
  for (const std::size_t way : {std::size_t{0}, std::size_t{1}}) {
    const auto command = told(way);
    ASSERT_TRUE(command) << way;
    EXPECT_EQ(command->enabled, 0) << way;
    EXPECT_EQ(command->epoch, 77U) << way;
  }
}

// --- by its own thread ---------------------------------------------------------------------------------------------

/// Endnodes whose devices listen from any thread.
class ListenedFlows final : public FlowFactory {
 public:
  [[nodiscard]] std::vector<EnableCommand> heard(const std::string& address) {
    const std::lock_guard lock{mutex_};
    return heard_[address];
  }
  [[nodiscard]] bool is_held(const std::string& address) {
    const std::lock_guard lock{mutex_};
    return held_.contains(address);
  }

 private:
  class Line final : public DataFlow {
   public:
    Line(ListenedFlows& all, std::string address) : all_{all}, address_{std::move(address)} {}
    ~Line() override {
      const std::lock_guard lock{all_.mutex_};
      all_.held_.erase(address_);
    }

   private:
    [[nodiscard]] Result<> do_send(Octets frame) noexcept override {
      const std::lock_guard lock{all_.mutex_};
      if (const auto command = read_enable_command(frame)) all_.heard_[address_].push_back(*command);
      return ok();
    }
    [[nodiscard]] Result<Received> do_receive(MutableOctets) noexcept override { return Received{}; }
    [[nodiscard]] bool do_wait(Duration) noexcept override { return false; }
    ListenedFlows& all_;
    std::string address_;
  };
  [[nodiscard]] Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress& address, FlowSide) override {
    const std::lock_guard lock{mutex_};
    if (!held_.insert(address.address).second) return fail(ErrorCode::AlreadyExists, "held");
    return std::make_unique<Line>(*this, address.address);
  }

  std::mutex mutex_;
  std::map<std::string, std::vector<EnableCommand>> heard_;
  std::set<std::string> held_;
};

struct BridgedByItsThread : ::testing::Test {
  /// Of no process: nobody's end is to be hurried.
  static constexpr int nobody = -1;
  ListenedFlows flows;
  KeeperPage page;
  std::optional<InhibitBridge> bridge{std::in_place, page, flows,
                                      std::vector{FlowAddress{Transfer::SharedMemory, "motor-enable"}}};
  void SetUp() override {
    page.starts.store(1);
    page.inhibits[0].note(true, 77, 500);
    bridge->watch(nobody);
  }
  [[nodiscard]] std::vector<EnableCommand> heard() { return flows.heard("motor-enable"); }
  /// It tells again and again: what is waited for ends the wait.
  void until_heard(std::size_t commands) {
    while (heard().size() < commands) std::this_thread::yield();
  }
  void until_left(std::uint32_t start) {
    while (page.left_inhibits.load() < start) std::this_thread::yield();
  }
};

TEST_F(BridgedByItsThread, TheEndOfTheGuardsThreadHasTheDevicesToldOnUntilTheNextGuardWantsThem) {
  EXPECT_FALSE(flows.is_held("motor-enable")) << "a guard has it";
  guard_ends(page);
  until_heard(3);
  page.starts.store(2);
  page.wants_inhibits.store(2);
  until_left(2);
  EXPECT_FALSE(flows.is_held("motor-enable"));
  std::uint32_t sequence = 500;
  for (const EnableCommand& command : heard()) {
    EXPECT_EQ(command.epoch, 77u);
    EXPECT_EQ(command.sequence, ++sequence);
  }
  EXPECT_EQ(heard().front().enabled, 1);
}

TEST_F(BridgedByItsThread, TheProcessHandleBeginsItWhereNoGuardEverHeldItsWord) {
  bridge->begin();
  until_heard(1);
  EXPECT_EQ(heard().front().epoch, 77u);
}

TEST_F(BridgedByItsThread, ASecondSupervisorThatDiesIsBridgedAsTheFirst) {
  guard_ends(page);
  until_heard(1);
  page.starts.store(2);
  page.wants_inhibits.store(2);
  until_left(2);
  page.inhibits[0].note(true, 78, 9000);
  const std::size_t before = heard().size();
  bridge->watch(nobody);
  guard_ends(page);
  until_heard(before + 1);
  EXPECT_EQ(heard()[before].epoch, 78u);
  EXPECT_EQ(heard()[before].sequence, 9001u);
}

TEST_F(BridgedByItsThread, ItsEndFreesTheEndnodesThoughNobodyHasTakenOver) {
  guard_ends(page);
  until_heard(1);
  bridge.reset();
  EXPECT_FALSE(flows.is_held("motor-enable"));
}

}  // namespace
}  // namespace hirosco::supervisor
