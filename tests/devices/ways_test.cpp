// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/ways.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "hirosco/subsystem/cycle/device_slot.hpp"
#include "hirosco/utilities/allocation_guard.hpp"
#include "simulation/devices/simulated_device.hpp"

/// What a subsystem's cycle has of a device is the same by every way: one suite, run on each of them.
namespace hirosco::testing {
namespace {

struct Sensed {
  double value;
};
struct Driven {
  double wanted;
};
constexpr std::uint32_t silence_limit = 5;

descriptor::Field field(const char* name) {
  descriptor::Field made;
  made.name = name;
  made.type = Type::Double;
  return made;
}

class Ways : public ::testing::TestWithParam<Way> {
 protected:
  Ways() {
    device.name = "AXIS";
    device.actuator = true;
    device.input = {field("VALUE")};
    device.output = {{.field = field("WANTED"), .safe = {0}}};
    use.silence = {silence_limit, silence_limit};
    use.watchdog_us = use.watchdog_reduced_us = 100'000;
  }
  void open() {
    auto flow = flows->open(address, FlowSide::Subsystem);
    ASSERT_TRUE(flow) << flow.error().text << " " << flow.error().value;
    if (GetParam().framing == Framing::Raw) *flow = make_raw_flow(std::move(*flow), protocol);
    std::vector<DeviceSlot::Way> ways;
    ways.push_back({std::move(*flow), 0});
    slot = std::make_unique<DeviceSlot>(device, use, port, std::move(ways), 1ms, true);
  }
  void SetUp() override {
    played = play(GetParam(), *flows, address);
    ASSERT_NE(played, nullptr);
    open();
  }
  void command(double wanted = 1) {
    port.output().wanted = wanted;
    slot->write(epoch, true, false);
  }
  /// The device has the newest command: what the operating system has still on its way is waited for.
  void until_heard(double wanted) {
    for (;;) {
      if (played->hear() == wanted) return;
      command(wanted);
    }
  }
  /// Cycles until something new is there.
  void until_fresh() {
    do slot->read(false);
    while (!port.fresh());
  }
  /// One exchange, whatever it takes.
  void exchange(double value) {
    until_heard(value);
    played->say(value);
    until_fresh();
    ASSERT_EQ(port.input().value, value);
  }

  std::unique_ptr<FlowFactory> flows = GetParam().flows();
  FlowAddress address = GetParam().address();
  descriptor::Device device;
  descriptor::DeviceUse use;
  DevicePort<Sensed, Driven> port;
  LineProtocol protocol;
  std::unique_ptr<PlayedDevice> played;
  std::unique_ptr<DeviceSlot> slot;
  std::uint32_t epoch{1};
};

TEST_P(Ways, FramesComeWholeAndAsTheyWereSent) {
  for (int i = 1; i <= 300; ++i) {
    exchange(i % 2 == 0 ? -1.0 / i : 1e9 / i);
    if (HasFatalFailure()) return;
  }
  EXPECT_EQ(port.damaged_frames(), 0U);
  EXPECT_TRUE(port.alive());
}

TEST_P(Ways, OfSeveralThatWaitTheNewestCounts) {
  exchange(0.5);
  until_heard(7);
  for (int i = 1; i <= 5; ++i) played->say(i);
  until_fresh();
  // A system may pass them on one by one; what is never seen is an older one after a newer one.
  double before = 0;
  while (port.input().value != 5) {
    EXPECT_GT(port.input().value, before);
    before = port.input().value;
    slot->read(false);
  }
}

TEST_P(Ways, ADamagedFrameIsCountedAndIsNoNews) {
  exchange(1);
  until_heard(2);
  played->say(99, PlayedDevice::Harm::Damaged);
  while (port.damaged_frames() == 0) slot->read(false);
  EXPECT_EQ(port.damaged_frames(), 1U);
  EXPECT_FALSE(port.fresh());
  EXPECT_EQ(port.input().value, 1);
  exchange(3);
  // As a whole lost device says why: what came was damaged.
  while (port.alive()) {
    played->say(99, PlayedDevice::Harm::Damaged);
    slot->read(true);
  }
  EXPECT_EQ(slot->loss().reason, descriptor::DeviceLoss::Damaged);
}

TEST_P(Ways, AFrameOfAnotherSizeIsNoNewsAndSaysSo) {
  exchange(1);
  while (port.alive()) {
    played->say(99, PlayedDevice::Harm::WrongSize);
    slot->read(true);
  }
  EXPECT_EQ(port.input().value, 1);
  const auto reason = slot->loss().reason;
  EXPECT_EQ(reason,
            GetParam().framing == Framing::Raw ? descriptor::DeviceLoss::Damaged : descriptor::DeviceLoss::WrongSize);
}

TEST_P(Ways, ADeviceThatRepeatsItselfIsLostInItsLimit) {
  exchange(1);
  std::uint32_t cycles = 0;
  while (port.alive()) {
    played->say(2);
    slot->read(true);
    ++cycles;
    ASSERT_LE(cycles, silence_limit);
  }
  EXPECT_EQ(cycles, silence_limit);
}

TEST_P(Ways, SilenceIsNoticedInTheDeclaredNumberOfCycles) {
  exchange(1);
  for (std::uint32_t cycle = 1; cycle <= silence_limit; ++cycle) {
    EXPECT_TRUE(port.alive());
    command();
    slot->read(true);
    EXPECT_EQ(slot->just_lost(), cycle == silence_limit);
  }
  EXPECT_FALSE(port.alive());
  EXPECT_EQ(slot->loss().reason, descriptor::DeviceLoss::Silent);
  exchange(2);
  EXPECT_TRUE(port.alive());
}

TEST_P(Ways, PulledAndPutBackItIsLostInItsLimitAndFoundAgain) {
  for (int times = 0; times < 3; ++times) {
    exchange(1 + times);
    played.reset();
    std::uint32_t cycles = 0;
    while (port.alive()) {
      command();
      slot->read(true);
      ++cycles;
      ASSERT_LE(cycles, silence_limit);
    }
    const auto reason = slot->loss().reason;
    EXPECT_TRUE(reason == descriptor::DeviceLoss::HungUp || reason == descriptor::DeviceLoss::Silent);
    played = play(GetParam(), *flows, address);
    ASSERT_NE(played, nullptr);
  }
  exchange(9);
}

TEST_P(Ways, ASubsystemThatBeginsAnewFindsTheSameDevice) {
  exchange(1);
  slot.reset();
  open();
  ++epoch;
  exchange(2);
}

TEST_P(Ways, NothingIsAllocatedInACycleWhateverTheDeviceDoes) {
  ASSERT_TRUE(RealtimeScope::hook_present());
  exchange(1);
  const auto thousand = [&](const char* what, auto&& between) {
    for (int i = 0; i < 1000; ++i) {
      between(i);
      const RealtimeScope cycle{HeapUse::Count};
      command(i);
      slot->read(true);
      const RealtimeUses used = cycle.uses();
      ASSERT_EQ(used.heap, 0U) << what;
      ASSERT_EQ(used.locks, 0U) << what;
      ASSERT_EQ(used.outputs, 0U) << what;
    }
  };
  thousand("it answers", [&](int i) {
    static_cast<void>(played->hear());
    played->say(i);
  });
  thousand("it is damaged", [&](int) { played->say(1, PlayedDevice::Harm::Damaged); });
  thousand("it does not read", [](int) {});
  played.reset();
  thousand("it is gone", [](int) {});
  thousand("it comes and goes", [&](int i) {
    if (i % 50 == 0) played = play(GetParam(), *flows, address);
    if (i % 50 == 25) played.reset();
  });
}

TEST_P(Ways, AFloodOfValidFramesHoldsNoCycleUp) {
  if (GetParam().name == "OneProcess") return;  // of one thread
  exchange(1);
  std::atomic<bool> over{false};
  std::thread flood{[&] {
    for (double i = 0; !over; ++i) played->say(i);
  }};
  // Each read returns, however fast the other side is; and the flood is not taken for answers.
  for (int i = 0; i < 2000; ++i) slot->read(true);
  EXPECT_FALSE(port.alive());
  over = true;
  flood.join();
  // Behind the flood the device is found again.
  do {
    command(-1);
    static_cast<void>(played->hear());
    played->say(-1);
    slot->read(false);
  } while (!port.fresh() || port.input().value != -1);
}

INSTANTIATE_TEST_SUITE_P(All, Ways, ::testing::ValuesIn(all_ways()), [](const auto& way) { return way.param.name; });

/// What a device owes, by every way that carries device frames: the simulated one, in its own time.
class Axis final : public simulation::SimulatedDevice {
 public:
  Axis(FlowFactory& flows, const FlowAddress& address) : SimulatedDevice{flows, address, {}} {}
  double wanted{0};

 private:
  void advance(Duration) noexcept override {}
  [[nodiscard]] Result<> take(OctetReader payload) noexcept override {
    wanted = payload.get<double>();
    return payload.exhausted() ? ok() : fail(ErrorCode::Malformed, "payload");
  }
  void write_sensors(OctetWriter& payload) noexcept override { payload.put(wanted); }
  [[nodiscard]] Result<> do_fault(const simulation::Words&) override {
    return fail(ErrorCode::InvalidArgument, "none");
  }
  [[nodiscard]] std::string do_truth() const override { return ""; }
};

class Duties : public Ways {
 protected:
  void SetUp() override {
    axis = std::make_unique<Axis>(*flows, address);
    ASSERT_TRUE(axis->plug());
    open();
  }
  /// The device has heard this command, and the slot its answer to it.
  void tell(double wanted) {
    for (;;) {
      command(wanted);
      axis->step(now += 500us);
      slot->read(false);
      if (axis->wanted == wanted && axis->active() && port.fresh()) return;
    }
  }
  std::unique_ptr<Axis> axis;
  TimePoint now{1s};
};

TEST_P(Duties, WhoWasFencedIsNotObeyed) {
  epoch = 5;
  tell(1);
  epoch = 4;
  while ((port.flags() & device_flag::old_epoch_refused) == 0) {
    command(2);
    axis->step(now += 500us);
    slot->read(false);
  }
  EXPECT_EQ(axis->wanted, 1);
}

TEST_P(Duties, ItsWatchdogTakesTheCommandAwayAndOnlyAHigherEpochGivesItBack) {
  tell(1);
  const TimePoint silent_since = now;
  while (axis->active()) {
    axis->step(now += 500us);
    ASSERT_LE(now - silent_since, 102ms);
  }
  EXPECT_GE(now - silent_since, 99ms);
  for (int i = 0; i < 100; ++i) {
    command(2);
    axis->step(now += 500us);
    slot->read(false);
    ASSERT_FALSE(axis->active()) << "of the same epoch";
  }
  ++epoch;
  tell(3);
}

std::vector<Way> frame_ways() {
  std::vector<Way> found = all_ways();
  std::erase_if(found, [](const Way& way) { return way.framing == Framing::Raw; });
  return found;
}
INSTANTIATE_TEST_SUITE_P(All, Duties, ::testing::ValuesIn(frame_ways()),
                         [](const auto& way) { return way.param.name; });

}  // namespace
}  // namespace hirosco::testing
