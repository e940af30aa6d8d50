// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/output_payload.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

/// What a motor is told, octet by octet. How it gets there is in device_slot_test.cpp.
namespace hirosco {
namespace {

struct OutputOfAMotor : ::testing::Test {
  std::array<std::uint16_t, 2> current{};
  descriptor::SubsystemDescriptor subsystem = [] {
    descriptor::SubsystemDescriptor made;
    descriptor::Device& motor = made.devices.emplace_back();
    motor.name = "MOTOR";
    motor.actuator = true;
    auto& output = motor.output.emplace_back();
    output.field.name = "CURRENT";
    output.field.type = Type::Uint16;
    output.field.count = 2;
    output.safe = {0x0102};
    return made;
  }();
  std::array<NativeField, 1> native{NativeField{.type = Type::Uint16, .count = 2}};
  ObjectFields fields{native, {}};

  OutputPayload output(std::endian order = std::endian::big) {
    return {subsystem.devices[0], fields, std::as_writable_bytes(std::span{current}), order};
  }
  static std::vector<int> numbers(Octets octets) {
    std::vector<int> all;
    for (const std::byte octet : octets) all.push_back(std::to_integer<int>(octet));
    return all;
  }
};

TEST_F(OutputOfAMotor, IsTheAuthorsOrTheSafeValuesAndWhatOfTheseIsNotDeclaredIsZero) {
  current = {0x0304, 0x0506};
  OutputPayload made = output();
  EXPECT_EQ(numbers(made.put_out(true)), (std::vector{3, 4, 5, 6}));
  EXPECT_EQ(numbers(made.put_out(false)), (std::vector{1, 2, 0, 0}));
  EXPECT_EQ(numbers(made.safe()), (std::vector{1, 2, 0, 0}));
}

TEST_F(OutputOfAMotor, HasTheByteOrderOfItsEndnode) {
  current = {0x0304, 0x0506};
  OutputPayload made = output(std::endian::little);
  EXPECT_EQ(numbers(made.put_out(true)), (std::vector{4, 3, 6, 5}));
  EXPECT_EQ(numbers(made.safe()), (std::vector{2, 1, 0, 0}));
}

TEST_F(OutputOfAMotor, LeavesItsDeclaredRangeNowhere) {
  subsystem.devices[0].output[0].field.minimum = 10;
  subsystem.devices[0].output[0].field.maximum = 1'000;
  OutputPayload made = output();
  current = {9, 1'001};
  EXPECT_EQ(numbers(made.put_out(true)), (std::vector{0, 10, 0x03, 0xE8}));
  current = {10, 1'000};
  EXPECT_EQ(numbers(made.put_out(true)), (std::vector{0, 10, 0x03, 0xE8}));
}

TEST_F(OutputOfAMotor, JumpsWhereItIsFurtherFromWhatWasPutOutThanItsStep) {
  descriptor::Bumpless terms;
  terms.steps = {{.device = 0, .output = 0, .most = 5}};
  OutputPayload made = output();
  current = {100, 100};
  EXPECT_FALSE(made.would_jump(subsystem, terms)) << "nothing of the author's was put out";
  static_cast<void>(made.put_out(true));
  current = {105, 95};
  EXPECT_FALSE(made.would_jump(subsystem, terms));
  current = {100, 106};
  EXPECT_TRUE(made.would_jump(subsystem, terms));
  EXPECT_FALSE(made.would_jump(subsystem, {})) << "nobody says how wide a step may be";
  static_cast<void>(made.put_out(false));
  EXPECT_FALSE(made.would_jump(subsystem, terms)) << "the safe values are";
}

TEST_F(OutputOfAMotor, IsHeldToTheStepOfItsOwnDeviceAndOutputAlone) {
  descriptor::Bumpless terms;
  terms.steps = {{.device = 1, .output = 0, .most = 0},
                 {.device = 0, .output = 1, .most = 0},
                 {.device = 0, .output = 0, .most = 5}};
  OutputPayload made = output();
  current = {100, 100};
  static_cast<void>(made.put_out(true));
  current = {105, 95};
  EXPECT_FALSE(made.would_jump(subsystem, terms)) << "others may not move at all";
  current = {106, 100};
  EXPECT_TRUE(made.would_jump(subsystem, terms));
}

TEST_F(OutputOfAMotor, OfWhatIsNoActuatorJumpsNowhere) {
  subsystem.devices[0].actuator = false;
  descriptor::Bumpless terms;
  terms.steps = {{.device = 0, .output = 0, .most = 5}};
  OutputPayload made = output();
  current = {100, 100};
  static_cast<void>(made.put_out(true));
  current = {200, 200};
  EXPECT_FALSE(made.would_jump(subsystem, terms));
}

}  // namespace
}  // namespace hirosco
