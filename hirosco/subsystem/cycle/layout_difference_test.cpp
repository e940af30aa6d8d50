// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/subsystem/cycle/layout_difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// The lengths that a descriptor gives. What differs is told in device_slot_test.cpp.
namespace hirosco {
namespace {

struct SizedDrive {
  std::uint8_t lamp;
  Sized<double, 6> torque;
  Sized<float, 4> current;
};

struct DriveWithFields : private HasFields<SizedDrive> {
  SizedDrive value{};
  ObjectFields layout = fields();
  MutableOctets octets() { return std::as_writable_bytes(std::span{&value, 1}); }
};

TEST(AgreedLayout, HasTheLengthOfEachFieldThatTheDescriptorDeclares) {
  std::vector<descriptor::Field> declared(3);
  for (std::size_t i = 0; i < declared.size(); ++i) declared[i].count = static_cast<std::uint16_t>(i + 1);
  DriveWithFields drive;
  const auto agreed = agreed_layout(drive.layout, declared, drive.octets());
  ASSERT_EQ(agreed.size(), 3U);
  for (std::size_t i = 0; i < agreed.size(); ++i) EXPECT_EQ(agreed[i].count, i + 1) << i;
  EXPECT_EQ(drive.value.torque.size(), 2U) << "the object has it, too";
  EXPECT_EQ(drive.value.current.size(), 3U);
}

}  // namespace
}  // namespace hirosco
