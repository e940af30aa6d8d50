// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/utilities/nearest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace hirosco {
namespace {

constexpr std::array<std::string_view, 4> names{"MOVE_TO", "HOLD", "HOME", "SET_STATE"};

TEST(Nearest, FindsAWordWithALetterChangedLeftOutAddedOrSwapped) {
  for (const char* text : {"MOVE_TU", "MOVETO", "MOVE_TOO", "MOEV_TO", "move_to"})
    EXPECT_EQ(nearest(text, names), "MOVE_TO") << text;
}

TEST(Nearest, TakesTheFirstOfTwoThatAreAsNear) {
  EXPECT_EQ(nearest("HOXE", std::array<std::string_view, 2>{"HOPE", "HOME"}), "HOPE");
}

TEST(Nearest, SaysNothingWhereMoreThanAThirdWouldHaveToChange) {
  EXPECT_EQ(nearest("FLY", names), "");
  EXPECT_EQ(nearest("", names), "");
  EXPECT_EQ(nearest("MOVE_TO", {}), "");
}

TEST(Nearest, LeavesOutWhatIsTooLongOrTooMuchToCompare) {
  const std::string longer(33, 'a');
  const std::vector<std::string_view> same{longer};
  EXPECT_EQ(nearest(longer, same), "");
  std::vector<std::string_view> many(2000, "b");
  many.push_back("aa");
  EXPECT_EQ(nearest("aa", many), "") << "the 2,001st";
  many[1999] = "aa";
  EXPECT_EQ(nearest("aa", many), "aa");
}

}  // namespace
}  // namespace hirosco
