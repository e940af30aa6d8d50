// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/endnode_ways.hpp"

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/device/testing/flow_conformance.hpp"
#include "simulation/devices/simulated_inhibit.hpp"
#include "simulation/devices/simulated_switch.hpp"

/// The ways of an endnode are one flow, whichever of them is used; and the switch in front of a device.
namespace hirosco::simulation {
namespace {

constexpr std::array addresses{"a", "b", "c"};

/// The device's side has three ways, the subsystem's is the one with this number.
template <std::size_t way>
class WaysFactory final : public FlowFactory {
 private:
  Result<std::unique_ptr<DataFlow>> do_open(const FlowAddress&, FlowSide side) override {
    if (side == FlowSide::Subsystem) return flows_.open({Transfer::SharedMemory, addresses[way]}, side);
    std::vector<FlowAddress> all;
    for (const char* address : addresses) all.push_back({Transfer::SharedMemory, address});
    HIROSCO_TRY_LET(auto ways, EndnodeWays::open(flows_, std::move(all)));
    return ways;
  }
  LocalFlows flows_;
};

struct Ways : ::testing::Test {
  LocalFlows flows;
  std::unique_ptr<EndnodeWays> device = [&] {
    std::vector<FlowAddress> all;
    for (const char* address : addresses) all.push_back({Transfer::SharedMemory, address});
    return EndnodeWays::open(flows, std::move(all)).value();
  }();
  std::vector<std::unique_ptr<DataFlow>> subsystem = [&] {
    std::vector<std::unique_ptr<DataFlow>> all;
    for (const char* address : addresses)
      all.push_back(flows.open({Transfer::SharedMemory, address}, FlowSide::Subsystem).value());
    return all;
  }();
  std::array<std::byte, max_frame_octets> buffer{};

  void ask(std::size_t way) { ASSERT_TRUE(subsystem[way]->send(std::array{std::byte{1}, std::byte{2}})); }
  bool hears() {
    const auto received = device->receive(buffer);
    return received && received->flow == Flow::New;
  }
  /// What this way brings: the first octet, -1 for nothing.
  int answer(std::size_t way) {
    const auto received = subsystem[way]->receive(buffer);
    return received && received->flow == Flow::New ? std::to_integer<int>(buffer[0]) : -1;
  }
  void say(std::uint8_t number) { static_cast<void>(device->send(std::array{std::byte{number}})); }
};

TEST_F(Ways, AnswersGoByTheWayByWhichItWasAskedLast) {
  for (const std::size_t way : {1U, 0U, 2U}) {
    ask(way);
    EXPECT_TRUE(hears());
    say(7);
    for (std::size_t other = 0; other < 3; ++other) EXPECT_EQ(answer(other), other == way ? 7 : -1) << way << other;
  }
}

TEST_F(Ways, EachFailsAlone) {
  ASSERT_TRUE(device->fault(0, "deaf", 0));
  ask(0);
  EXPECT_FALSE(hears());
  ASSERT_TRUE(device->fault(1, "silent", 0));
  ask(1);
  EXPECT_TRUE(hears());
  say(7);
  EXPECT_EQ(answer(1), -1);
  ASSERT_TRUE(device->fault(2, "corrupt", 1));
  ask(2);
  EXPECT_TRUE(hears());
  say(7);
  EXPECT_EQ(answer(2), 7 ^ 0x40);
  say(7);
  EXPECT_EQ(answer(2), 7) << "so many frames and no more";
  device->heal();
  ask(0);
  EXPECT_TRUE(hears());
}

TEST_F(Ways, AnUnpluggedOneHangsUpAndTheOthersGoOnUntilItIsPluggedIn) {
  ask(0);
  EXPECT_TRUE(hears());
  ASSERT_TRUE(device->fault(0, "unplug", 0));
  EXPECT_FALSE(subsystem[0]->send(buffer));
  ask(1);
  EXPECT_TRUE(hears());
  ASSERT_TRUE(device->fault(0, "plug", 0));
  ask(0);
  EXPECT_TRUE(hears());
  for (std::size_t way = 0; way < 3; ++way) ASSERT_TRUE(device->fault(way, "unplug", 0));
  EXPECT_FALSE(device->receive(buffer));
  EXPECT_FALSE(device->send(buffer));
}

TEST_F(Ways, WhatIsNoFaultOrNoWayIsRefused) {
  EXPECT_EQ(device->fault(3, "silent", 0).error().code, ErrorCode::OutOfRange);
  EXPECT_EQ(device->fault(0, "mute", 0).error().code, ErrorCode::InvalidArgument);
}

struct Switch : ::testing::Test {
  LocalFlows flows;
  std::unique_ptr<DataFlow> guard = flows.open({Transfer::SharedMemory, "power"}, FlowSide::Subsystem).value();
  SimulatedSwitch made{FlowAddress{Transfer::SharedMemory, "power"}};
  TimePoint now{std::chrono::seconds{1}};
  std::uint32_t sequence{0};

  Switch() { EXPECT_TRUE(made.open(flows)); }
  void tell(bool on, bool repeats = false) {
    std::array<std::byte, power_frame_octets> frame;
    if (!repeats) ++sequence;
    const PowerCommand command{on, std::chrono::milliseconds{100}, sequence};
    ASSERT_TRUE(guard->send(*write_power_command(frame, command)));
    const bool had = made.on();
    const bool changed = made.step(now);
    EXPECT_EQ(changed, made.on() != had);
  }
  std::optional<PowerStatus> said() {
    std::array<std::byte, max_frame_octets> frame;
    const auto received = guard->receive(frame);
    if (!received || received->flow != Flow::New) return std::nullopt;
    return read_power_status(Octets{frame}.first(received->octets)).value();
  }
};

TEST_F(Switch, IsOffUntilItIsToldAndAnswersEveryCommand) {
  EXPECT_FALSE(made.step(now));
  EXPECT_FALSE(made.on());
  for (const bool on : {true, false, true}) {
    tell(on);
    EXPECT_EQ(made.on(), on);
    const auto status = said();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->on, on);
    EXPECT_EQ(status->sequence, sequence);
  }
}

TEST_F(Switch, IsOffByItselfWhenNobodyTellsItAnyMore) {
  tell(true);
  EXPECT_EQ(made.off_at(), now + std::chrono::milliseconds{100});
  now += std::chrono::milliseconds{99};
  tell(true, true);
  EXPECT_TRUE(made.on());
  now += std::chrono::milliseconds{1};
  EXPECT_TRUE(made.step(now));
  EXPECT_FALSE(made.on()) << "a repetition is no sign of life";
  EXPECT_EQ(made.off_at(), TimePoint::max());
}

TEST_F(Switch, HearsNoGarbage) {
  tell(true);
  static_cast<void>(said());
  ASSERT_TRUE(guard->send(std::array<std::byte, power_frame_octets>{}));
  EXPECT_FALSE(made.step(now));
  EXPECT_TRUE(made.on());
  EXPECT_FALSE(said());
}

/// By two ways (docs/adr/0237).
struct TwoWays : ::testing::Test {
  const FlowAddress first{Transfer::SharedMemory, "first"}, second{Transfer::SharedMemory, "second"};
  LocalFlows flows;
  std::array<std::unique_ptr<DataFlow>, 2> guard{flows.open(first, FlowSide::Subsystem).value(),
                                                 flows.open(second, FlowSide::Subsystem).value()};
  TimePoint now{std::chrono::seconds{1}};
};

struct TwoWaysToASwitch : TwoWays {
  SimulatedSwitch made{first, {second}};
  TwoWaysToASwitch() { EXPECT_TRUE(made.open(flows)); }
  void tell(std::size_t way, bool on, std::uint32_t sequence) {
    std::array<std::byte, power_frame_octets> frame;
    ASSERT_TRUE(guard[way]->send(*write_power_command(frame, {on, std::chrono::milliseconds{100}, sequence})));
    static_cast<void>(made.step(now));
  }
};

TEST_F(TwoWaysToASwitch, TheNewestCommandCountsByWhicheverItComes) {
  tell(0, true, 10);
  EXPECT_TRUE(made.on());
  tell(1, false, 11);
  EXPECT_FALSE(made.on());
  tell(0, true, 10);
  EXPECT_FALSE(made.on()) << "late by the other way";
  tell(0, true, 12);
  EXPECT_TRUE(made.on());
}

TEST_F(TwoWaysToASwitch, TheSameCommandByBothIsOneAndEachIsAnswered) {
  tell(0, true, 10);
  now += std::chrono::milliseconds{90};
  tell(1, true, 10);
  EXPECT_EQ(made.off_at(), now + std::chrono::milliseconds{10}) << "no second sign of life";
  for (const auto& flow : guard) {
    std::array<std::byte, max_frame_octets> frame;
    const auto received = flow->receive(frame);
    ASSERT_TRUE(received && received->flow == Flow::New);
    EXPECT_EQ(read_power_status(Octets{frame}.first(received->octets))->sequence, 10U);
  }
}

TEST_F(TwoWaysToASwitch, WhoHeardNothingUntilItWasOffTakesWhateverNumberComes) {
  tell(0, true, 1000);
  now += std::chrono::milliseconds{200};
  static_cast<void>(made.step(now));
  ASSERT_FALSE(made.on());
  tell(1, true, 3);
  EXPECT_TRUE(made.on()) << "a computer that has begun anew counts from another number";
}

struct TwoWaysToAnInhibit : TwoWays {
  SimulatedInhibit made{first, std::chrono::milliseconds{50}, {second}};
  TwoWaysToAnInhibit() { EXPECT_TRUE(made.open(flows)); }
  void tell(std::size_t way, bool enabled, std::uint32_t epoch, std::uint32_t sequence) {
    std::array<std::byte, enable_frame_octets> frame;
    ASSERT_TRUE(
        guard[way]->send(*write_enable_command(frame, {static_cast<std::uint8_t>(enabled ? 1 : 0), epoch, sequence})));
    made.receive(now, true);
  }
};

TEST_F(TwoWaysToAnInhibit, GoesOnByTheOtherInTheSameEpoch) {
  tell(0, true, 5, 10);
  EXPECT_TRUE(made.enabled(5, now));
  now += std::chrono::milliseconds{40};
  tell(1, true, 5, 18);
  now += std::chrono::milliseconds{40};
  EXPECT_TRUE(made.enabled(5, now));
}

TEST_F(TwoWaysToAnInhibit, WhatOneHasInhibitedTheOtherEnablesInALaterEpochOnly) {
  for (const std::size_t one : {std::size_t{0}, std::size_t{1}}) {
    const std::uint32_t epoch = 10 * static_cast<std::uint32_t>(one + 1);
    tell(one, true, epoch, 10);
    tell(one, false, epoch, 11);
    tell(1 - one, true, epoch, 12);
    EXPECT_FALSE(made.enabled(epoch, now)) << one;
    tell(1 - one, true, epoch + 1, 13);
    EXPECT_TRUE(made.enabled(epoch + 1, now)) << one;
  }
}

TEST_F(TwoWaysToAnInhibit, IsInhibitedByEitherWhateverNumberThatBears) {
  for (const std::size_t by : {std::size_t{0}, std::size_t{1}})
    for (const std::uint32_t sequence : {5U, 11U, 900U}) {
      const std::uint32_t epoch = 1000 * static_cast<std::uint32_t>(by + 1) + sequence;
      tell(0, true, epoch, 10);
      ASSERT_TRUE(made.enabled(epoch, now));
      tell(by, false, epoch, sequence);
      EXPECT_FALSE(made.enabled(epoch, now)) << by << " " << sequence;
    }
}

TEST_F(TwoWaysToAnInhibit, ALateCommandOfAWayThatWasLeftEnablesNothing) {
  tell(0, true, 5, 10);
  tell(1, true, 5, 20);
  now += std::chrono::milliseconds{49};
  tell(0, true, 5, 15);
  now += std::chrono::milliseconds{2};
  EXPECT_FALSE(made.enabled(5, now)) << "that is no sign of life";
}

TEST_F(TwoWaysToAnInhibit, OneThatIsCutIsMissedAndTheOtherAnswers) {
  ASSERT_TRUE(made.ways()->fault(0, "unplug", 0));
  std::array<std::byte, enable_frame_octets> frame;
  static_cast<void>(guard[0]->send(*write_enable_command(frame, {1, 5, 10})));
  made.receive(now, true);
  EXPECT_FALSE(made.enabled(5, now));
  tell(1, true, 5, 11);
  EXPECT_TRUE(made.enabled(5, now));
  made.answer(true, {.output = DeviceOutput::Active});
  EXPECT_EQ(guard[1]->receive(frame).value().flow, Flow::New);
  EXPECT_EQ(read_enable_status(frame)->sequence, 11U);
}

}  // namespace
}  // namespace hirosco::simulation

namespace hirosco::testing {
namespace {

template <std::size_t way>
struct WayTraits {
  using Factory = simulation::WaysFactory<way>;
  static FlowAddress address() { return {Transfer::SharedMemory, "a"}; }
  static constexpr bool knows_its_peer = true;
};

INSTANTIATE_TYPED_TEST_SUITE_P(Preferred, FlowConformance, WayTraits<0>);

}  // namespace
}  // namespace hirosco::testing
