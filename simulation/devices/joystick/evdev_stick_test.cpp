// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/joystick/evdev_stick.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <unistd.h>

#include <cmath>

#include <gtest/gtest.h>

#include "hirosco/data_transfer/device/device_frame.hpp"
#include "hirosco/data_transfer/device/local_flows.hpp"
#include "simulation/devices/joystick/joystick_device.hpp"

namespace hirosco::simulation {
namespace {

/// Events as the kernel gives them, from a pipe.
struct EvdevStickTest : ::testing::Test {
  EvdevStickTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC), 0);
    events.reset(ends[0]);
    kernel.reset(ends[1]);
  }
  void moves(std::uint16_t axis, std::int32_t value) {
    const input_event event{.time = {}, .type = EV_ABS, .code = axis, .value = value};
    ASSERT_EQ(::write(kernel.get(), &event, sizeof event), static_cast<ssize_t>(sizeof event));
  }
  std::unique_ptr<Stick> stick() {
    return std::make_unique<EvdevStick>(std::move(events), std::array<EvdevStick::Range, 2>{{{-100, 100}, {0, 255}}},
                                        false);
  }
  FileDescriptor events, kernel;
};

TEST_F(EvdevStickTest, TellsTheDeflectionAsAShareOfItsRange) {
  const auto held = stick();
  EXPECT_EQ(held->deflection(), (Vec2{0, 0}));
  moves(ABS_X, 50);
  moves(ABS_Y, 255);
  EXPECT_EQ(held->deflection(), (Vec2{0.5, 1}));
  moves(ABS_Z, 77);
  moves(ABS_X, -1000);
  EXPECT_EQ(held->deflection(), (Vec2{-1, 1})) << "other axes do not matter, and no axis leaves its range";
}

TEST_F(EvdevStickTest, TellsThatItIsGone) {
  const auto held = stick();
  kernel.reset();
  EXPECT_EQ(held->deflection(), std::nullopt);
}

TEST_F(EvdevStickTest, IsNotFoundWhereTheMachineHasNone) {
  EXPECT_FALSE(EvdevStick::open("/dev/null"));
  EXPECT_FALSE(EvdevStick::open("/no/such/stick"));
}

/// The joystick device with a person's stick, and the subsystem's side of it.
struct PersonsHand : EvdevStickTest {
  void step(std::uint8_t hand, int cycles = 1) {
    for (int i = 0; i < cycles; ++i) {
      std::array<std::byte, JoystickDevice::command_octets> payload{};
      payload[16] = std::byte{hand};
      std::array<std::byte, max_device_frame_octets> buffer;
      const auto frame = write_command(buffer, {DeviceMode::Active, 1, ++sequence, 10'000, payload});
      static_cast<void>(flow->send(frame.value()));
      device.step(TimePoint{} + sequence * std::chrono::microseconds{500});
    }
  }
  std::uint8_t hands() {
    std::array<std::byte, max_device_frame_octets> buffer;
    const auto received = flow->receive(buffer);
    const auto status = read_status(Octets{buffer}.first(received->octets));
    return std::to_integer<std::uint8_t>(status->payload.back());
  }

  LocalFlows flows;
  const FlowAddress address{Transfer::SharedMemory, "joystick"};
  JoystickDevice device{
      flows, address, {}, {}, [this](std::string_view) -> Result<std::unique_ptr<Stick>> { return stick(); }};
  bool plugged = device.plug().has_value();
  std::unique_ptr<DataFlow> flow = std::move(flows.open(address, FlowSide::Subsystem).value());
  std::uint32_t sequence{0};
};

TEST_F(PersonsHand, MovesTheHandleOnceItIsThereAndAskedFor) {
  step(2);
  EXPECT_EQ(hands(), 0b011);
  ASSERT_TRUE(device.fault("stick auto"));
  moves(ABS_X, 50);
  moves(ABS_Y, 255);
  step(0, 1000);
  EXPECT_EQ(hands(), 0b111);
  EXPECT_NEAR(device.handle().angle_rad()[0], 0, 1e-9) << "nobody asked for it yet";
  step(2, 2000);
  EXPECT_NEAR(device.handle().angle_rad()[0], 0.20, 1e-3);
  EXPECT_NEAR(device.handle().angle_rad()[1], 0.40, 1e-3);
}

TEST_F(PersonsHand, TakesTheWholeDeviceAwayWhenItIsUnplugged) {
  ASSERT_TRUE(device.fault("stick auto"));
  step(2, 10);
  kernel.reset();
  step(2, 1);
  EXPECT_FALSE(device.plugged()) << "what the subsystem sees of it is FC3";
}

}  // namespace
}  // namespace hirosco::simulation
