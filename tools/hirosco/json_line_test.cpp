// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/json_line.hpp"

#include <gtest/gtest.h>

namespace hirosco::tools {
namespace {

TEST(JsonLine, HasKeysInTheirOrderAndNoBlanksBetween) {
  EXPECT_EQ(json_line({{"url", "http://127.0.0.1:8080/"}, {"line", 3}, {"all", {true, false}}}),
            R"({"url":"http://127.0.0.1:8080/","line":3,"all":[true,false]})");
}

TEST(JsonLine, IsOneLineWhateverItsTextsAre) {
  EXPECT_EQ(json_line({{"text", "say \"no\\yes\"\nM\xC3\xBCnchen\x1F"}}),
            "{\"text\":\"say \\\"no\\\\yes\\\"\\nM\xC3\xBCnchen\\u001f\"}");
}

TEST(JsonLine, TellsWhatIsNoUtf8AndRefusesNothing) {
  EXPECT_EQ(json_line({{"lone \xBC", "cut short \xE2\x86"}}), "{\"lone \xEF\xBF\xBD\":\"cut short \xEF\xBF\xBD\"}");
}

}  // namespace
}  // namespace hirosco::tools
