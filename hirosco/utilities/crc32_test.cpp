// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/crc32.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string_view>

namespace hirosco {
namespace {

[[nodiscard]] std::uint32_t of(std::string_view text) { return crc32(std::as_bytes(std::span{text})); }

// By Python's zlib.crc32().
TEST(Crc32, IsThatOfZlib) {
  EXPECT_EQ(of(""), 0U);
  EXPECT_EQ(of("123456789"), 0xCBF43926U);
  EXPECT_EQ(of("<Subsystem name=\"LAMP\" id=\"9\"/>"), 0x1AF9C140U);
}

}  // namespace
}  // namespace hirosco
