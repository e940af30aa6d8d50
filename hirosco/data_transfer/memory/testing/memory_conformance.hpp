// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "hirosco/data_transfer/memory/memory.hpp"

/// What every MemoryProvider must do: instantiate with INSTANTIATE_TYPED_TEST_SUITE_P(Name, MemoryConformance, Provider).
namespace hirosco::testing {

template <class Provider>
class MemoryConformance : public ::testing::Test {
 protected:
  Provider provider_;
  MemoryHandle handle_ = provider_.create("conformance", 384).value();
};

TYPED_TEST_SUITE_P(MemoryConformance);

TYPED_TEST_P(MemoryConformance, GivesZeroedMemoryOnALine) {
  const Mapping mapping = this->provider_.map(this->handle_, Access::ReadWrite).value();
  EXPECT_EQ(mapping.octets.size(), 384u);
  EXPECT_EQ(std::bit_cast<std::uintptr_t>(mapping.octets.data()) % 64, 0u);
  EXPECT_TRUE(std::ranges::all_of(mapping.octets, [](std::byte octet) { return octet == std::byte{0}; }));
}

TYPED_TEST_P(MemoryConformance, ShowsAWriteInEveryMappingAndAfterTheHandle) {
  const Mapping writer = this->provider_.map(this->handle_, Access::ReadWrite).value();
  const Mapping reader = this->provider_.map(MemoryHandle{this->handle_}, Access::ReadOnly).value();
  this->handle_ = {};
  writer.octets[383] = std::byte{7};
  EXPECT_EQ(reader.octets[383], std::byte{7});
}

TYPED_TEST_P(MemoryConformance, RefusesFurtherWritersAfterTheSealButKeepsTheFirst) {
  const Mapping writer = this->provider_.map(this->handle_, Access::ReadWrite).value();
  EXPECT_EQ(this->provider_.verify(this->handle_, 384, true).error().code, ErrorCode::Mismatch);
  ASSERT_TRUE(this->provider_.seal_writers(this->handle_));
  EXPECT_TRUE(this->provider_.verify(this->handle_, 384, true));
  EXPECT_EQ(this->provider_.map(this->handle_, Access::ReadWrite).error().code, ErrorCode::NotPermitted);
  const Mapping reader = this->provider_.map(this->handle_, Access::ReadOnly).value();
  writer.octets[0] = std::byte{9};
  EXPECT_EQ(reader.octets[0], std::byte{9});
}

TYPED_TEST_P(MemoryConformance, VerifiesTheExactSize) {
  EXPECT_TRUE(this->provider_.verify(this->handle_, 384, false));
  EXPECT_EQ(this->provider_.verify(this->handle_, 383, false).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(this->provider_.verify(this->handle_, 385, false).error().code, ErrorCode::Mismatch);
}

TYPED_TEST_P(MemoryConformance, RefusesHandlesThatAreNotItsOwn) {
  EXPECT_EQ(this->provider_.map({}, Access::ReadOnly).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(this->provider_.verify({}, 384, false).error().code, ErrorCode::Mismatch);
  EXPECT_EQ(this->provider_.create("none", 0).error().code, ErrorCode::InvalidArgument);
}

REGISTER_TYPED_TEST_SUITE_P(MemoryConformance, GivesZeroedMemoryOnALine, ShowsAWriteInEveryMappingAndAfterTheHandle,
                            RefusesFurtherWritersAfterTheSealButKeepsTheFirst, VerifiesTheExactSize,
                            RefusesHandlesThatAreNotItsOwn);

}  // namespace hirosco::testing
