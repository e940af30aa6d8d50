// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <type_traits>
#include <utility>

namespace hirosco {
namespace {

[[nodiscard]] Result<> limit(int value) {
  if (value > 3) return fail(ErrorCode::OutOfRange, "joint limit", value);
  return ok();
}
[[nodiscard]] Result<std::unique_ptr<int>> boxed(int value) {
  HIROSCO_TRY(limit(value));
  return std::make_unique<int>(value);
}
[[nodiscard]] Result<int> doubled(int value) {
  HIROSCO_TRY_LET(const std::unique_ptr<int> first, boxed(value));
  HIROSCO_TRY_LET(const std::unique_ptr<int> second, boxed(value));
  return *first + *second;
}

TEST(Result, PassesValuesThrough) { EXPECT_EQ(doubled(3), 6); }

TEST(Result, PassesTheErrorUpWithItsTextAndNumber) {
  const Result<int> refused = doubled(4);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::OutOfRange);
  EXPECT_STREQ(refused.error().text, "joint limit");
  EXPECT_EQ(refused.error().value, 4);
}

TEST(Result, ErrorIsTriviallyCopyableSoThatAControlLoopCanHandItOver) {
  static_assert(std::is_trivially_copyable_v<Error>);
  static_assert(std::is_nothrow_copy_constructible_v<Result<>>);
}

}  // namespace
}  // namespace hirosco
