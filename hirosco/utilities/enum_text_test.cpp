// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/enum_text.hpp"

#include <gtest/gtest.h>

#include <set>

#include "hirosco/utilities/result.hpp"

namespace hirosco {
namespace {

TEST(EnumText, LeadsFromEachEnumeratorToItsTextAndBack) {
  std::set<std::string_view> texts;
  for (const auto& row : EnumTexts<ErrorCode>::table) {
    EXPECT_EQ(from_text<ErrorCode>(to_text(row.value)), row.value);
    texts.insert(row.text);
  }
  EXPECT_EQ(texts.size(), EnumTexts<ErrorCode>::table.size()) << "no text is used twice";
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(ErrorCode::Internal) + 1) << "no enumerator is forgotten";
}

TEST(EnumText, KnowsNothingOutsideTheEnumeration) {
  EXPECT_EQ(to_text(static_cast<ErrorCode>(200)), "?");
  EXPECT_EQ(from_text<ErrorCode>("no such text"), std::nullopt);
  EXPECT_EQ(from_text<ErrorCode>(""), std::nullopt);
  EXPECT_EQ(from_text<ErrorCode>("Timeout"), std::nullopt) << "case counts";
}

TEST(EnumText, WorksAtCompileTime) {
  static_assert(to_text(ErrorCode::Timeout) == "timeout");
  static_assert(from_text<ErrorCode>("timeout") == ErrorCode::Timeout);
}

}  // namespace
}  // namespace hirosco
