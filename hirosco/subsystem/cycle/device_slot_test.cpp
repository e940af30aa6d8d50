// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/device_slot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "hirosco/data_transfer/device/testing/sealed.hpp"
#include "hirosco/subsystem/cycle/layout_difference.hpp"

/// One device: what counts as alive, and what is written, octet by octet.
namespace hirosco {
namespace {

struct Sensed {
  std::uint16_t angle;
};
struct Driven {
  std::array<std::uint16_t, 2> current;
};

descriptor::Field field(const char* name, Type type, std::uint16_t count = 1) {
  descriptor::Field made;
  made.name = name;
  made.type = type;
  made.count = count;
  return made;
}

/// A motor with an angle and two currents; three cycles of silence are too many, ten without real-time rights.
struct MotorSlot : ::testing::Test {
  LocalFlows flows;
  descriptor::Device device = [] {
    descriptor::Device made;
    made.name = "MOTOR";
    made.actuator = true;
    made.input = {field("ANGLE", Type::Uint16)};
    made.output = {{.field = field("CURRENT", Type::Uint16, 2), .safe = {0x0102}}};
    return made;
  }();
  descriptor::DeviceUse use = [] {
    descriptor::DeviceUse made;
    made.silence = {3, 10};
    made.watchdog_us = 1'000;
    made.watchdog_reduced_us = 9'000;
    return made;
  }();
  DevicePort<Sensed, Driven> port;
  std::unique_ptr<DataFlow> motor = open(FlowSide::Device);
  std::array<std::byte, max_device_frame_octets> frame{};

  std::unique_ptr<DataFlow> open(FlowSide side) {
    return std::move(flows.open({Transfer::SharedMemory, "motor"}, side)).value();
  }
  std::vector<DeviceSlot::Way> one_way() {
    std::vector<DeviceSlot::Way> ways;
    ways.push_back({open(FlowSide::Subsystem), 0});
    return ways;
  }
  DeviceSlot slot(bool realtime = true) { return DeviceSlot{device, use, port, one_way(), 1ms, realtime}; }
  void say(std::uint32_t sequence, std::uint16_t flags = 0, std::array<std::byte, 2> angle = {}) {
    std::array<std::byte, max_device_frame_octets> buffer{};
    static_cast<void>(motor->send(
        write_status(buffer, {.epoch = 1, .sequence = sequence, .flags = flags, .payload = angle}).value()));
  }
  DeviceCommand heard() {
    const auto received = motor->receive(frame).value();
    return read_command(Octets{frame}.first(received.octets)).value();
  }
};

std::vector<int> numbers_of(Octets octets) {
  std::vector<int> numbers;
  for (const std::byte octet : octets) numbers.push_back(std::to_integer<int>(octet));
  return numbers;
}

TEST_F(MotorSlot, SafeValuesAndOutputHaveTheByteOrderOfTheEndnodeAndWhatIsNotDeclaredIsZero) {
  for (const auto order : {descriptor::ByteOrder::Little, descriptor::ByteOrder::Big}) {
    use.endnode.byte_order = order;
    const bool big = order == descriptor::ByteOrder::Big;
    DeviceSlot made = slot();
    made.write(5, false, false);
    EXPECT_EQ(numbers_of(heard().payload), (big ? std::vector{1, 2, 0, 0} : std::vector{2, 1, 0, 0}));
    port.output().current[0] = 0x0304;
    port.output().current[1] = 0x0506;
    made.write(5, true, false);
    EXPECT_EQ(numbers_of(heard().payload), (big ? std::vector{3, 4, 5, 6} : std::vector{4, 3, 6, 5}));
    say(1, 0, {std::byte{7}, std::byte{8}});
    made.read(true);
    EXPECT_EQ(port.input().angle, big ? 0x0708 : 0x0807);
  }
}

TEST_F(MotorSlot, NoOutputLeavesItsDeclaredRange) {
  device.output.front().field.minimum = 10;
  device.output.front().field.maximum = 1'000;
  DeviceSlot made = slot();
  port.output().current[0] = 9;
  port.output().current[1] = 1'001;
  made.write(5, true, false);
  EXPECT_EQ(numbers_of(heard().payload), (std::vector{10, 0, 0xE8, 0x03}));
  port.output().current[0] = 10;
  port.output().current[1] = 1'000;
  made.write(5, true, false);
  EXPECT_EQ(numbers_of(heard().payload), (std::vector{10, 0, 0xE8, 0x03}));
}

/// A way that is harmed: by frames that no flow carries, or by octets between them.
struct Harmed final : DataFlow {
  bool too_long{false};
  bool harmed{false};  ///< after one whole frame
  Result<> do_send(Octets) noexcept override { return ok(); }
  Result<Received> do_receive(MutableOctets buffer) noexcept override {
    const std::array<std::byte, 2> angle{};
    if (!std::exchange(harmed, true))
      return Received{
          Flow::New, write_status(buffer, {.epoch = 0, .sequence = 1, .flags = 0, .payload = angle}).value().size(), 0};
    if (too_long) return fail(ErrorCode::Malformed, "frame is longer than expected", 2000);
    return Received{Flow::None, 0, 3};
  }
  bool do_wait(Duration) noexcept override { return false; }
};

TEST_F(MotorSlot, WhatIsHarmedOnItsWayIsCountedAndIsNoHangUp) {
  for (const bool too_long : {false, true}) {
    auto harmed = std::make_unique<Harmed>();
    harmed->too_long = too_long;
    std::vector<DeviceSlot::Way> ways;
    ways.push_back({std::move(harmed), 0});
    DeviceSlot made{device, use, port, std::move(ways), 1ms, true};
    made.read(true);
    ASSERT_TRUE(port.alive());
    for (int cycle = 1; cycle <= 3; ++cycle) {
      made.read(true);
      EXPECT_EQ(made.just_lost(), cycle == 3) << "in its limit, not at once";
    }
    EXPECT_EQ(port.damaged_frames(), too_long ? 3U : 9U);
    EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::Damaged);
  }
}

struct Pushed {
  std::array<double, 2> force{};
  float bias{};
};

TEST_F(MotorSlot, AnOutputThatIsNoNumberOrHasNoEndGoesOutAsItsSafeValueWithARangeAndWithout) {
  constexpr double no_number = std::numeric_limits<double>::quiet_NaN(),
                   no_end = std::numeric_limits<double>::infinity();
  for (const bool ranged : {false, true})
    for (const double wrong : {no_number, -no_number, no_end, -no_end}) {
      device.output = {{.field = field("FORCE", Type::Double, 2), .safe = {0.5, 0.25}},
                       {.field = field("BIAS", Type::Float), .safe = {}}};
      if (ranged)
        for (auto& output : device.output) output.field.maximum = 2;
      DevicePort<Sensed, Pushed> pushing;
      DeviceSlot made{device, use, pushing, one_way(), 1ms, true};
      pushing.output() = Pushed{.force = {wrong, 1}, .bias = static_cast<float>(wrong)};
      made.write(5, true, false);
      const DeviceCommand command = heard();
      OctetReader reader{command.payload, std::endian::little};
      EXPECT_EQ(reader.get<double>(), 0.5) << ranged << wrong;
      EXPECT_EQ(reader.get<double>(), 1) << ranged << wrong;
      EXPECT_EQ(reader.get<float>(), 0) << ranged << wrong;
    }
}

TEST_F(MotorSlot, AnOutputBeyondItsRangeGoesOutAsTheEndOfIt) {
  device.output = {{.field = field("FORCE", Type::Double, 2), .safe = {0.5, 0.25}},
                   {.field = field("BIAS", Type::Float), .safe = {}}};
  for (auto& output : device.output) output.field.maximum = 2;
  DevicePort<Sensed, Pushed> pushing;
  DeviceSlot made{device, use, pushing, one_way(), 1ms, true};
  pushing.output() = Pushed{.force = {1.5, 7}, .bias = 7};
  made.write(5, true, false);
  const DeviceCommand command = heard();
  OctetReader reader{command.payload, std::endian::little};
  EXPECT_EQ(reader.get<double>(), 1.5);
  EXPECT_EQ(reader.get<double>(), 2);
  EXPECT_EQ(reader.get<float>(), 2);
}

TEST_F(MotorSlot, WhatAConfigurationSetsForADeviceIsItsAuthorsToRead) {
  use.settings = {{"STIFFNESS", "4000", {}}, {"NAME", "left", {}}};
  constexpr std::array<std::string_view, 2> read{"STIFFNESS", "DAMPING"};
  port.will_read(read);
  const DeviceSlot made = slot();
  EXPECT_EQ(port.setting("STIFFNESS"), "4000");
  EXPECT_EQ(port.setting("DAMPING"), "") << "not given";
  EXPECT_EQ(port.setting("NAME"), "") << "its author has not said that it is read";
}

TEST_F(MotorSlot, EachCommandSaysModeEpochAndWatchdogAndHasASequenceOfItsOwn) {
  DeviceSlot made = slot();
  const auto written = [&](bool active, bool stopping) {
    made.write(7, active, stopping);
    return heard();
  };
  EXPECT_EQ(written(false, false).mode, DeviceMode::Off);
  EXPECT_EQ(written(false, true).mode, DeviceMode::Stop);
  const DeviceCommand command = written(true, false);
  EXPECT_EQ(command.mode, DeviceMode::Active);
  EXPECT_EQ(command.epoch, 7u);
  EXPECT_EQ(command.sequence, 3u);
  EXPECT_EQ(command.watchdog_us, 1'000u);
}

TEST_F(MotorSlot, AFirstAnswerToNoCommandAtAllIsNews) {
  DeviceSlot made = slot();
  say(0);
  made.read(false);
  EXPECT_TRUE(port.fresh());
  EXPECT_TRUE(made.alive());
  say(0);
  made.read(false);
  EXPECT_FALSE(port.fresh()) << "the same once more is not";
}

TEST_F(MotorSlot, WithoutRealtimeRightsTheSecondSilenceLimitAndWatchdogHold) {
  DeviceSlot made = slot(false);
  made.write(1, true, false);
  EXPECT_EQ(heard().watchdog_us, 9'000u);
  say(1);
  made.read(true);
  for (int i = 0; i < 9; ++i) {
    made.read(true);
    EXPECT_TRUE(made.alive()) << i;
  }
  made.read(true);
  EXPECT_FALSE(made.alive());
  EXPECT_TRUE(made.just_lost());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::Silent);
  EXPECT_EQ(made.loss().silent_cycles, 10u);
  made.read(true);
  EXPECT_FALSE(made.just_lost()) << "it is told once";
}

TEST_F(MotorSlot, ADeviceThatHangsUpIsLostAtOnceAndSaysSo) {
  DeviceSlot made = slot();
  say(1);
  made.read(true);
  ASSERT_TRUE(made.alive());
  motor.reset();
  made.read(true);
  EXPECT_TRUE(made.just_lost());
  EXPECT_FALSE(made.alive());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::HungUp);
  for (int i = 0; i < 5; ++i) {
    made.read(true);
    EXPECT_FALSE(made.just_lost()) << "not once more by its silence";
  }
  motor = open(FlowSide::Device);
  say(2);
  made.read(true);
  EXPECT_TRUE(made.alive()) << "it is plugged in again";
}

TEST_F(MotorSlot, ADeviceThatHungUpBeforeItSaidAnythingIsLostByItsSilence) {
  DeviceSlot made = slot();
  motor.reset();
  for (int i = 0; i < 2; ++i) {
    made.read(true);
    EXPECT_FALSE(made.just_lost());
  }
  made.read(true);
  EXPECT_TRUE(made.just_lost());
  EXPECT_TRUE(made.never_heard());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::NeverHeard);
}

TEST_F(MotorSlot, ADeviceThatObeysAHigherEpochOfAnotherFlightHasHeardNobodyAndIsLostForThatReason) {
  DeviceSlot made = slot();
  for (int i = 0; i < 3; ++i) {
    say(70, device_flag::old_epoch_refused);
    made.read(true);
    EXPECT_FALSE(made.alive());
  }
  EXPECT_TRUE(made.just_lost());
  EXPECT_TRUE(made.never_heard());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::OldEpoch);
  say(1);
  made.read(true);
  EXPECT_TRUE(made.alive()) << "it obeys us by now";
}

TEST_F(MotorSlot, ThatItHasRefusedSomebodyElseIsNoReasonToLoseADeviceThatObeysUs) {
  DeviceSlot made = slot();
  for (std::uint32_t sequence = 1; sequence < 10; ++sequence) {
    say(sequence, sequence > 1 ? device_flag::old_epoch_refused : std::uint16_t{0});
    made.read(true);
    EXPECT_TRUE(made.alive());
  }
}

TEST_F(MotorSlot, AWatchdogThatHasLetGoThoughItIsCommandedCountsAsSilence) {
  DeviceSlot made = slot();
  std::uint32_t sequence = 0;
  const auto cycle = [&](bool active) {
    say(++sequence, device_flag::watchdog_tripped);
    made.read(true);
    made.write(1, active, false);
  };
  for (int i = 0; i < 10; ++i) cycle(false);
  EXPECT_TRUE(made.alive()) << "nobody commands it";
  for (int i = 0; i < 4; ++i) cycle(true);
  EXPECT_TRUE(port.fresh()) << "its answer to the first command is on its way";
  for (int i = 0; i < 2; ++i) cycle(true);
  EXPECT_TRUE(made.alive());
  cycle(true);
  EXPECT_TRUE(made.just_lost());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::LetGo);
  EXPECT_EQ(made.loss().let_go, 3u);
  EXPECT_NE(port.flags() & device_flag::watchdog_tripped, 0);
  --sequence;
  cycle(true);  // it repeats itself besides
  EXPECT_EQ(made.loss().repeated, 1u);
  EXPECT_EQ(made.loss().let_go, 3u);
}

TEST_F(MotorSlot, AFrameLongerThanAnyIsNoNews) {
  DeviceSlot made = slot();
  say(1);
  made.read(true);
  const std::array<std::byte, max_frame_octets> noise{};
  for (int i = 0; i < 3; ++i) {
    static_cast<void>(motor->send(noise));
    made.read(true);
  }
  EXPECT_FALSE(made.alive());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::Damaged);
  EXPECT_EQ(port.damaged_frames(), 3u);
}

TEST_F(MotorSlot, WhoAnswersByFramesOfAnotherVersionIsLostByThatName) {
  DeviceSlot made = slot();
  say(1);
  made.read(true);
  std::array<std::byte, 40> answer{};
  const std::size_t octets =
      write_status(answer, {.epoch = 0, .sequence = 2, .flags = 0, .payload = {}}).value().size();
  for (int i = 0; i < 3; ++i) {
    static_cast<void>(motor->send(testing::sealed_as(0x22, MutableOctets{answer}.first(octets))));
    made.read(true);
  }
  EXPECT_FALSE(made.alive());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::OtherVersion);
}

TEST_F(MotorSlot, ANewConfigurationKnowsNothingOfWhatTheDeviceSaidInAnEarlierOne) {
  {
    DeviceSlot earlier = slot();
    static_cast<void>(motor->send(std::array<std::byte, 30>{}));
    earlier.read(true);
    say(1);
    earlier.read(true);
    ASSERT_TRUE(port.alive() && port.fresh());
    ASSERT_EQ(port.damaged_frames(), 1u);
  }
  const DeviceSlot made = slot();
  EXPECT_FALSE(port.alive());
  EXPECT_FALSE(port.fresh());
  EXPECT_EQ(port.damaged_frames(), 0u);
}

TEST_F(MotorSlot, TellsWhatItHeardMostOfAsTheReasonOfALossAndForgetsItWithAGoodFrame) {
  DeviceSlot made = slot();
  say(1);
  made.read(true);
  const auto noise = [&] {
    static_cast<void>(motor->send(std::array<std::byte, 30>{}));
    made.read(true);
  };
  noise();
  for (int i = 0; i < 2; ++i) {
    say(1);  // a repetition
    made.read(true);
  }
  EXPECT_TRUE(made.just_lost());
  const DeviceSlot::Loss loss = made.loss();
  EXPECT_EQ(loss.reason, descriptor::DeviceLoss::Repeated);
  EXPECT_EQ(loss.damaged, 1u);
  EXPECT_EQ(loss.repeated, 2u);
  EXPECT_EQ(loss.silent_cycles, 3u);
  noise();
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::Damaged) << "of two as frequent ones the graver one";
  say(2);
  made.read(true);
  EXPECT_EQ(made.loss().damaged, 0u);
  EXPECT_EQ(made.loss().repeated, 0u);
  EXPECT_EQ(made.loss().silent_cycles, 0u);
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::Silent);
}

TEST_F(MotorSlot, SilenceBeforeTheFirstFrameCountsOnlyOnceItIsMissed) {
  DeviceSlot made = slot();
  for (int i = 0; i < 10; ++i) made.read(false);
  EXPECT_EQ(made.loss().silent_cycles, 0u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(made.just_lost());
    made.read(true);
  }
  EXPECT_TRUE(made.just_lost());
}

TEST_F(MotorSlot, WhatIsNoActuatorIsCommandedWhoeverMayMove) {
  device.actuator = false;
  DeviceSlot made = slot();
  port.output().current = {0x0304, 0x0506};
  made.write(1, false, true);
  const DeviceCommand command = heard();
  EXPECT_EQ(command.mode, DeviceMode::Active);
  EXPECT_EQ(numbers_of(command.payload), (std::vector{4, 3, 6, 5}));
}

TEST_F(MotorSlot, ADeviceThatHangsUpInACycleInWhichNoLimitGoesOnIsLostAtOnceToo) {
  DeviceSlot made = slot();
  say(1);
  made.read(true);
  motor.reset();
  made.read(true, false);
  EXPECT_TRUE(made.just_lost());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::HungUp);
}

TEST_F(MotorSlot, ThatItHasRefusedAnOlderEpochThanOursIsNoReasonNotToTakeItsFirstAnswer) {
  DeviceSlot made = slot();
  made.write(1, false, false);
  say(1, device_flag::old_epoch_refused);
  made.read(true);
  EXPECT_TRUE(made.alive());
}

TEST_F(MotorSlot, AWatchdogThatIsYetToBeRearmedHasItsTimeInCyclesInWhichLimitsGoOnAlone) {
  DeviceSlot made = slot();
  std::uint32_t sequence = 0;
  const auto cycle = [&](bool counts) {
    say(++sequence, device_flag::watchdog_tripped);
    made.read(true, counts);
    made.write(1, true, false);
  };
  for (int i = 0; i < 20; ++i) cycle(false);
  EXPECT_TRUE(port.fresh()) << "a flood of samples makes it no shorter";
  for (int i = 0; i < 6; ++i) cycle(true);
  EXPECT_TRUE(made.alive());
  cycle(true);
  EXPECT_TRUE(made.just_lost());
  EXPECT_EQ(made.loss().reason, descriptor::DeviceLoss::LetGo);
}

TEST(LayoutDifference, NamesEachFieldThatDiffersInTypeOrCountAndTheNumberOfFields) {
  const DevicePort<Sensed, Driven> port;
  const auto difference = [&](Type type, std::uint16_t count) {
    return layout_difference(port.output_layout(), {field("CURRENT", type, count)});
  };
  EXPECT_EQ(difference(Type::Uint16, 2), "");
  EXPECT_EQ(difference(Type::Uint16, 3), "field CURRENT: C++ has UINT16[2], the descriptor declares UINT16[3]");
  EXPECT_EQ(difference(Type::Int16, 2), "field CURRENT: C++ has UINT16[2], the descriptor declares INT16[2]");
  EXPECT_EQ(layout_difference(port.output_layout(), {}),
            "the C++ type has 1 members, the descriptor declares 0 fields");
  struct Two {
    std::uint8_t level;
    double angle;
  };
  const DevicePort<Two, NoFields> two;
  EXPECT_EQ(layout_difference(two.input_layout(), {field("LEVEL", Type::Double), field("ANGLE", Type::Float)}),
            "field LEVEL: C++ has UINT8[1], the descriptor declares DOUBLE[1]; field ANGLE: C++ has DOUBLE[1], the "
            "descriptor declares FLOAT[1]");
  descriptor::Device device;
  device.input = {field("ANGLE", Type::Uint16)};
  EXPECT_TRUE(DeviceSlot::difference(device, port).starts_with("output, "));
  device.input.clear();
  EXPECT_EQ(DeviceSlot::difference(device, port),
            "input, the C++ type has 1 members, the descriptor declares 0 fields; output, the C++ type has 1 members, "
            "the descriptor declares 0 fields");
  device.output = {{.field = field("CURRENT", Type::Uint16, 2), .safe = {0x0102}}};
  EXPECT_TRUE(DeviceSlot::difference(device, port).ends_with("declares 0 fields"));
}

}  // namespace
}  // namespace hirosco
