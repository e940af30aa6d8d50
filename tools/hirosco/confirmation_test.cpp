// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/confirmation.hpp"

#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

TEST(Confirmation, IsAskedOfAPersonAloneAndOnceOfWhatWantsIt) {
  int asked = 0;
  const auto answer = [&asked](const char* words) {
    return [&asked, words] {
      ++asked;
      return std::string{words};
    };
  };
  EXPECT_TRUE(may_be_sent(false, false, true, answer("no"))) << "nothing is to be confirmed";
  EXPECT_TRUE(may_be_sent(true, true, true, answer("no"))) << "--yes says it";
  EXPECT_TRUE(may_be_sent(true, false, false, answer("no"))) << "a script is no person";
  EXPECT_EQ(asked, 0);
  EXPECT_FALSE(may_be_sent(true, false, true, answer("no\n")));
  EXPECT_TRUE(may_be_sent(true, false, true, answer("yes\n")));
  EXPECT_EQ(asked, 2);
}

TEST(Confirmation, IsYesInWordsAndNothingElse) {
  for (const char* yes : {"y", "Y\n", "yes", "YES\r\n", "Yes "}) EXPECT_TRUE(is_yes(yes)) << yes;
  for (const char* no : {"", "\n", "n", "no", "yess", " yes", "ye", "1"}) EXPECT_FALSE(is_yes(no)) << no;
}

}  // namespace
}  // namespace hirosco::tools
